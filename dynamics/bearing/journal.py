"""Steady state of an oil-fed plain journal bearing: film, temperature, drag, transition to fluid friction.

The load number So = F psi^2 / (B D eta omega) gives the eccentricity, the eccentricity the friction

    f / psi = pi / (So sqrt(1 - eps^2)) + (eps / 2) sin(beta) ,     power = f F omega D / 2 ,

and the heat balance of the oil gives the film temperature, whose viscosity enters So again
(ISO 7902-1 / DIN 31652-1; film solved in `dynamics.bearing.journal_film`). Shear acts all round the gap, the broken
film included, as those documents assume: the drag is an upper value.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from scipy.optimize import brentq

from dynamics.bearing.journal_characteristic import Characteristic, characteristic
from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.kernels.journal import HIGHEST_ECCENTRICITY

TAYLOR_LIMIT = 41.3
"""Onset of vortices: Re = rho omega R c / eta above 41.3 sqrt(R / c) (G. I. Taylor 1923; ISO 7902-1)."""
VOGELPOHL_CONSTANT = 1e-7
"""n [1/min] = 1e-7 F / (C eta V), SI units (G. Vogelpohl, Betriebssichere Gleitlager)."""
MAXIMUM_FILM_RISE = 400.0
"""Film temperature above the inlet at which the oil would be destroyed and the balance is given up [K]."""
MAXIMUM_FILM_DROP = 60.0
"""Film temperature below the inlet at which cold bodies would have stiffened the oil [K]."""


class BearingError(DynamicsInputError):
    """An impossible journal bearing; the message names value, limit and remedy."""


class BearingNotConvergedError(DynamicsNotConverged):
    """No film temperature balances friction and oil flow."""


@dataclass(frozen=True, kw_only=True)
class JournalBearing:
    """Plain cylindrical bearing, fed with oil at its widest gap.

    diameter, width : journal diameter D and supporting width B [m]
    diametral_clearance : bore minus journal at running temperature and speed [m]; thermal and centrifugal
        growth are taken off by the caller
    transition_constant : C in Vogelpohl's transition speed, 1 to 2 [-]
    feed_share : share of the fed oil that cools the film, 0 to 1 [-]; the rest leaves past it. 1 is the
        assumption of ISO 7902-1, 0 leaves only the oil that the film itself drives out of its ends. Not less
        than that ever flows through the film as long as it is fed. Assumed, look at its range: it decides the
        film temperature of a bearing fed far beyond its own demand
    """

    diameter: float
    width: float
    diametral_clearance: float
    transition_constant: float = 1.0
    feed_share: float = 1.0

    def __post_init__(self) -> None:
        for name in ("diameter", "width", "diametral_clearance", "transition_constant"):
            value = getattr(self, name)
            if not value > 0.0:
                remedy = (
                    "the hot bearing has seized: enlarge the cold clearance"
                    if "clear" in name
                    else "enlarge it"
                )
                raise BearingError(f"journal bearing: {name} = {value:.6g}: must be above 0; {remedy}")
        if not 0.0 <= self.feed_share <= 1.0:
            raise BearingError(
                f"journal bearing: feed_share = {self.feed_share:.6g}: must lie within 0 to 1; it is a share"
            )
        if not 1e-4 <= self.relative_clearance <= 1e-2:
            raise BearingError(
                f"journal bearing: relative clearance psi = {self.relative_clearance:.3g}: must lie within "
                "1e-4 to 1e-2 (film theory of a plain bearing); check diametral_clearance and diameter"
            )

    @property
    def relative_clearance(self) -> float:
        """psi = diametral clearance / diameter [-]."""
        return self.diametral_clearance / self.diameter

    @property
    def volume(self) -> float:
        """Journal volume inside the bearing pi D^2 B / 4 [m3]."""
        return 0.25 * math.pi * self.diameter**2 * self.width


@dataclass(frozen=True, kw_only=True)
class BearingState:
    """Steady state of one bearing; SI units."""

    regime: str
    """``hydrodynamic``, ``mixed`` (film thinner than the solved range) or ``standstill``."""
    load: float
    omega: float
    specific_load: float
    """F / (B D) [Pa]."""
    sommerfeld: float
    """So; infinite at standstill."""
    eccentricity: float
    attitude_angle: float
    """Load to line of centres [rad]."""
    minimum_film: float
    """[m]"""
    friction_coefficient: float
    """Drag force / load [-]; infinite without load."""
    drag_torque: float
    """[N m]"""
    power: float
    """Friction heat of the film [W]."""
    torsional_damping: float
    """drag_torque / omega [N m s/rad]."""
    petroff_torque: float
    """Drag of the concentric journal 2 pi eta omega B R^3 / c, a lower bound [N m]."""
    film_temperature: float
    """Mean of the inlet and of the oil that has passed the film [K]."""
    outlet_temperature: float
    """All oil fed, mixed behind the bearing [K]."""
    viscosity: float
    """At the film temperature [Pa s]."""
    flow: float
    """Oil fed [m3/s]."""
    side_flow: float
    """Oil the film drives out of the ends [m3/s]; more than is fed means starving."""
    transition_speed: float
    """Vogelpohl: fluid friction above this speed at this load and viscosity [rad/s]."""
    reynolds_number: float
    reynolds_limit: float
    mean_inverse_gap: float
    """Mean of 1/h round the film [1/m]; times the oil conductivity a heat transfer coefficient."""
    heat_from_bodies: float
    """Heat conducted into the film from shaft and shell [W]."""
    warnings: tuple[str, ...]


def solve_bearing(
    bearing: JournalBearing,
    load: float,
    omega: float,
    oil_inlet_temperature: float,
    flow: float,
    viscosity: Callable[[float], float],
    density: float,
    heat_capacity: float,
    heat_from_bodies: float = 0.0,
    friction_heat: float | None = None,
    friction_factor: float = 1.0,
) -> BearingState:
    """Solve film and heat balance together.

    Parameters
    ----------
    bearing : geometry with the hot clearance
    load : radial force, not negative [N]
    omega : shaft speed; its sign does not matter [rad/s]
    oil_inlet_temperature : [K]
    flow : oil fed to this bearing, above 0 [m3/s]
    viscosity : dynamic viscosity [Pa s] of a temperature [K], falling with it
    density, heat_capacity : of the oil [kg/m3], [J/(kg K)]
    heat_from_bodies : heat that shaft and shell give to the film; negative if they cool it [W]
    friction_heat : measured or assumed heat of the film, not negative [W]; it takes the place of the friction
        of the film in the heat balance, the drag is that of the film all the same
    friction_factor : multiplies the drag of the film, and with it its heat; not negative [-]

    Returns
    -------
    BearingState

    Raises
    ------
    BearingError : impossible input
    BearingNotConvergedError : the film would have to be more than 400 K above the inlet

    Source: ISO 7902-1 / DIN 31652-1: heat carried by the oil alone, effective film temperature the mean of
    inlet and outlet. Heat exchanged with the bodies is an input here instead of an assumed housing film.
    """
    _check_operation(
        load, flow, density, heat_capacity, oil_inlet_temperature, friction_heat, friction_factor
    )
    speed = abs(omega)
    curve = characteristic(bearing.width / bearing.diameter)
    heat_per_flow = density * heat_capacity

    def heat_into(film: _Film) -> float:
        own = film.torque * speed if friction_heat is None else friction_heat
        return own + heat_from_bodies

    def film_excess(temperature: float) -> float:
        film = _film(bearing, curve, load, speed, viscosity(temperature), friction_factor)
        cooling_flow = _cooling_flow(bearing, flow, film.side_flow)
        if cooling_flow == 0.0:
            return math.inf
        rise = heat_into(film) / (heat_per_flow * cooling_flow)
        return oil_inlet_temperature + 0.5 * rise - temperature

    temperature = _balance(film_excess, oil_inlet_temperature)
    film = _film(bearing, curve, load, speed, viscosity(temperature), friction_factor)
    return _state(
        bearing,
        film,
        viscosity=viscosity(temperature),
        film_temperature=temperature,
        outlet_temperature=oil_inlet_temperature + heat_into(film) / (heat_per_flow * flow),
        flow=flow,
        density=density,
        heat_from_bodies=heat_from_bodies,
        friction_factor=friction_factor,
    )


def sommerfeld_number(bearing: JournalBearing, load: float, omega: float, viscosity: float) -> float:
    """So = F psi^2 / (B D eta omega) [-]; infinite at standstill under load (ISO 7902-1)."""
    shear = bearing.width * bearing.diameter * viscosity * omega
    if shear == 0.0:
        return math.inf if load > 0.0 else 0.0
    return load * bearing.relative_clearance**2 / shear


def petroff_torque(bearing: JournalBearing, omega: float, viscosity: float) -> float:
    """Drag torque of the concentric, unloaded journal M = 2 pi eta omega B R^3 / c [N m] (Petroff 1883)."""
    radius = 0.5 * bearing.diameter
    return 2.0 * math.pi * viscosity * omega * bearing.width * radius**3 / (0.5 * bearing.diametral_clearance)


def transition_speed(bearing: JournalBearing, load: float, viscosity: float) -> float:
    """Speed at which fluid friction takes over [rad/s]: n = 1e-7 F / (C eta V) [1/min] (Vogelpohl)."""
    per_minute = VOGELPOHL_CONSTANT * load / (bearing.transition_constant * viscosity * bearing.volume)
    return per_minute * math.pi / 30.0


def largest_starting_load(bearing: JournalBearing, omega: float, viscosity: float) -> float:
    """Load whose transition speed is ``omega`` [N]: Vogelpohl's formula turned round."""
    per_minute = omega * 30.0 / math.pi
    return per_minute * bearing.transition_constant * viscosity * bearing.volume / VOGELPOHL_CONSTANT


@dataclass(frozen=True)
class _Film:
    """Mechanical state of the film at one viscosity."""

    load: float
    omega: float
    sommerfeld: float
    eccentricity: float
    attitude_angle: float
    torque: float
    side_flow: float


def _film(
    bearing: JournalBearing, curve: Characteristic, load: float, omega: float, viscosity: float, factor: float
) -> _Film:
    """Drag = Petroff's torque / sqrt(1 - eps^2) plus the pressure part F (C/4) eps sin(beta), times the factor."""
    sommerfeld = sommerfeld_number(bearing, load, omega, viscosity)
    eps = curve.eccentricity(sommerfeld)
    attitude = curve.attitude_angle(eps)
    couette = petroff_torque(bearing, omega, viscosity) / math.sqrt(1.0 - eps**2)
    pressure = 0.25 * bearing.diametral_clearance * load * eps * math.sin(attitude) if omega > 0.0 else 0.0
    side_flow = bearing.diameter**3 * bearing.relative_clearance * omega * curve.side_flow(eps)
    return _Film(load, omega, sommerfeld, eps, attitude, factor * (couette + pressure), side_flow)


def _cooling_flow(bearing: JournalBearing, flow: float, side_flow: float) -> float:
    """Oil that takes part in the heat balance of the film [m3/s]."""
    return min(flow, max(bearing.feed_share * flow, side_flow))


def _balance(film_excess: Callable[[float], float], inlet: float) -> float:
    """Film temperature at which the oil carries away what it takes up."""
    start = film_excess(inlet)
    if start == 0.0:
        return inlet
    limit = MAXIMUM_FILM_RISE if start > 0.0 else -MAXIMUM_FILM_DROP
    step = math.copysign(10.0, start)
    other = inlet + step
    while film_excess(other) * start > 0.0:
        if step == limit:
            raise BearingNotConvergedError(
                f"journal bearing: film temperature leaves the inlet {inlet:.0f} K by more than "
                f"{limit:+.0f} K; feed more oil or correct the heat from the bodies"
            )
        step = math.copysign(min(2.0 * abs(step), abs(limit)), limit)
        other = inlet + step
    low, high = min(inlet, other), max(inlet, other)
    root: float = brentq(film_excess, low, high, xtol=1e-9, rtol=1e-13)
    return root


def _state(
    bearing: JournalBearing,
    film: _Film,
    *,
    viscosity: float,
    film_temperature: float,
    outlet_temperature: float,
    flow: float,
    density: float,
    heat_from_bodies: float,
    friction_factor: float,
) -> BearingState:
    load, omega, eps = film.load, film.omega, film.eccentricity
    standstill = omega == 0.0 and load > 0.0
    clearance = 0.5 * bearing.diametral_clearance
    reynolds = density * omega * 0.5 * bearing.diameter * clearance / viscosity
    limit = TAYLOR_LIMIT * math.sqrt(bearing.diameter / bearing.diametral_clearance)
    regime = "standstill" if standstill else "mixed" if eps >= HIGHEST_ECCENTRICITY else "hydrodynamic"
    transition = transition_speed(bearing, load, viscosity)
    return BearingState(
        regime=regime,
        load=load,
        omega=omega,
        specific_load=load / (bearing.width * bearing.diameter),
        sommerfeld=film.sommerfeld,
        eccentricity=1.0 if standstill else eps,
        attitude_angle=0.0 if standstill else film.attitude_angle,
        minimum_film=0.0 if standstill else clearance * (1.0 - eps),
        friction_coefficient=film.torque / (0.5 * bearing.diameter * load) if load > 0.0 else math.inf,
        drag_torque=film.torque,
        power=film.torque * omega,
        torsional_damping=film.torque / omega
        if omega > 0.0
        else friction_factor * petroff_torque(bearing, 1.0, viscosity),
        petroff_torque=petroff_torque(bearing, omega, viscosity),
        film_temperature=film_temperature,
        outlet_temperature=outlet_temperature,
        viscosity=viscosity,
        flow=flow,
        side_flow=film.side_flow,
        transition_speed=transition,
        reynolds_number=reynolds,
        reynolds_limit=limit,
        mean_inverse_gap=1.0 / (clearance * math.sqrt(1.0 - eps**2)),
        heat_from_bodies=heat_from_bodies,
        warnings=_warnings(regime, omega, transition, reynolds, limit, flow, film.side_flow),
    )


def _warnings(
    regime: str, omega: float, transition: float, reynolds: float, limit: float, flow: float, side_flow: float
) -> tuple[str, ...]:
    """Sentences for what lies outside the theory: name, value, limit, remedy."""
    found = []
    if regime == "mixed":
        found.append(
            f"eccentricity >= {HIGHEST_ECCENTRICITY}: mixed friction, drag and film thickness are bounds; "
            "raise speed or viscosity or lower the load"
        )
    if 0.0 < omega < transition:
        found.append(
            f"speed = {omega * 30.0 / math.pi:.0f} rpm: below the transition speed "
            f"{transition * 30.0 / math.pi:.0f} rpm of this load; lower the load until it is passed"
        )
    if reynolds > limit:
        found.append(
            f"Reynolds number = {reynolds:.0f}: above {limit:.0f}, the film is not laminar and drags more; "
            "reduce the clearance or use a thicker oil"
        )
    if side_flow > flow:
        found.append(
            f"oil flow = {flow * 6e4:.3g} l/min: below the {side_flow * 6e4:.3g} l/min the film drives out, "
            "the bearing starves; feed more oil"
        )
    return tuple(found)


def _check_operation(
    load: float,
    flow: float,
    density: float,
    heat_capacity: float,
    inlet: float,
    friction_heat: float | None,
    friction_factor: float,
) -> None:
    if not (load >= 0.0 and math.isfinite(load)):
        raise BearingError(
            f"journal bearing: load = {load} N: must be finite and not negative; give its magnitude"
        )
    if friction_heat is not None and not (friction_heat >= 0.0 and math.isfinite(friction_heat)):
        raise BearingError(
            f"journal bearing: friction_heat = {friction_heat} W: must be finite and not negative; give the "
            "measured loss, or none to let the film make its own"
        )
    if not (friction_factor >= 0.0 and math.isfinite(friction_factor)):
        raise BearingError(
            f"journal bearing: friction_factor = {friction_factor}: must be finite and not negative; give 1 for "
            "the friction of the film itself"
        )
    for name, value, unit in (
        ("oil flow", flow, "m3/s"),
        ("oil density", density, "kg/m3"),
        ("oil heat capacity", heat_capacity, "J/(kg K)"),
        ("oil inlet temperature", inlet, "K"),
    ):
        if not value > 0.0:
            raise BearingError(
                f"journal bearing: {name} = {value} {unit}: must be above 0; correct the oil supply"
            )
