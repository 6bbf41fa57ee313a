"""Oil-fed plain journal bearing in steady state: film, temperature, drag torque, transition to fluid friction.

The load number So = F psi^2 / (B D eta omega) gives the eccentricity, the eccentricity the friction

    f / psi = pi / (So sqrt(1 - eps^2)) + (eps / 2) sin(beta) ,     power = f F omega D / 2 ,

and the heat balance of the oil gives the film temperature, whose viscosity enters So again
(ISO 7902-1 / DIN 31652-1; film solved in `dynamics.rotor.journal_film`). Shear acts all round the gap, the broken
film included, as those documents assume: the drag torque is an upper value.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from scipy.optimize import brentq

from dynamics.kernels.journal import HIGHEST_ECCENTRICITY
from dynamics.rotor.bearing import (
    BearingError,
    BearingNotConvergedError,
    BearingOperation,
    BearingState,
    LateralCoefficients,
    LateralOperation,
)
from dynamics.rotor.journal_feed import FEEDS, Feed
from dynamics.rotor.journal_film import Characteristic, characteristic
from dynamics.rotor.journal_lateral import RunningFilm, journal_lateral

# Steady state of a journal bearing and what of it lies outside the theory.


@dataclass(frozen=True, kw_only=True)
class JournalState(BearingState):
    """Steady state of a journal bearing; beyond the common fields those of its film, SI units."""

    specific_load: float
    minimum_film: float
    transition_speed: float
    """Vogelpohl: fluid friction above this speed at this load and viscosity [rad/s]."""
    regime: str
    """``hydrodynamic``, ``mixed`` (film thinner than the solved range) or ``standstill``."""
    sommerfeld: float
    """So; infinite at standstill."""
    eccentricity: float
    attitude_angle: float
    """Load to line of centres [rad]."""
    friction_coefficient: float
    """Drag force / load [-]; infinite without load."""
    petroff_torque: float
    """Drag torque of the concentric journal 2 pi eta omega B R^3 / c, a lower bound [N m]."""
    viscosity: float
    """At the film temperature [Pa s]."""
    side_flow: float
    """Oil the film drives out of the ends [m3/s]; more than is fed means starving."""
    reynolds_number: float
    reynolds_limit: float
    film: RunningFilm
    """Its film, about which stiffness and damping are taken."""

    def lateral_coefficients(self, operation: LateralOperation) -> LateralCoefficients:
        """Stiffness, damping and static position, at the viscosity of the film and the load of the operation.

        Raises BearingError at standstill without load.
        """
        return journal_lateral(self.film, operation)


def limit_warnings(state: JournalState) -> tuple[str, ...]:
    """Sentences for what lies outside the theory: name, value, limit, remedy."""
    found = []
    if state.regime == "mixed":
        found.append(
            f"eccentricity >= {HIGHEST_ECCENTRICITY}: mixed friction, drag torque and film thickness are bounds; "
            "raise speed or viscosity or lower the load"
        )
    if 0.0 < state.omega < state.transition_speed:
        found.append(
            f"speed = {state.omega * 30.0 / math.pi:.0f} rpm: below the transition speed "
            f"{state.transition_speed * 30.0 / math.pi:.0f} rpm of this load; lower the load until it is passed"
        )
    if state.reynolds_number > state.reynolds_limit:
        found.append(
            f"Reynolds number = {state.reynolds_number:.0f}: above {state.reynolds_limit:.0f}, the film is not "
            "laminar and its drag torque is higher; reduce the clearance or use a thicker oil"
        )
    if state.side_flow > state.flow:
        found.append(
            f"oil flow = {state.flow * 6e4:.3g} l/min: below the {state.side_flow * 6e4:.3g} l/min the film drives "
            "out, the bearing starves; feed more oil"
        )
    return tuple(found)


TAYLOR_LIMIT = 41.3
"""Onset of vortices: Re = rho omega R c / eta above 41.3 sqrt(R / c) (G. I. Taylor 1923; ISO 7902-1)."""
VOGELPOHL_CONSTANT = 1e-7
"""n [1/min] = 1e-7 F / (C eta V), SI units (G. Vogelpohl, Betriebssichere Gleitlager)."""
MAXIMUM_FILM_RISE = 400.0
"""Film temperature above the inlet at which the oil would be destroyed and the balance is given up [K]."""
MAXIMUM_FILM_DROP = 60.0
"""Film temperature below the inlet at which the balance is given up: bodies that much cooler than the oil [K]."""
SOURCE = "ISO 7902-1 / DIN 31652-1, film solved"


@dataclass(frozen=True, kw_only=True)
class JournalBearing:
    """Plain cylindrical bearing.

    diameter, width : journal diameter D and supporting width B [m]
    diametral_clearance : bore minus journal at running temperature and speed [m]; thermal and centrifugal
        expansion are taken off by the caller
    transition_constant : C in Vogelpohl's transition speed, 1 to 2 [-]
    feed_share : share of the fed oil that cools the film, 0 to 1 [-]; the rest leaves past it. 1 is the
        assumption of ISO 7902-1, 0 leaves only the oil that the film itself drives out of its ends. Not less
        than that ever flows through the film as long as it is fed. Assumed, look at its range: it decides the
        film temperature of a bearing fed far beyond its own demand
    feed : where oil enters: ``widest_gap`` (ISO 7902-1) or ``two_axial_grooves`` of 20 degrees across the load

    Raises BearingError for a size that is not above 0, a relative clearance outside 1e-4 to 1e-2, a feed share
    outside 0 to 1 or an unknown feed.
    """

    diameter: float
    width: float
    diametral_clearance: float
    transition_constant: float = 1.0
    feed_share: float = 1.0
    feed: Feed = "widest_gap"

    def __post_init__(self) -> None:
        for name in ("diameter", "width", "diametral_clearance", "transition_constant"):
            value = getattr(self, name)
            if not value > 0.0:
                remedy = (
                    "the bearing has seized at temperature: enlarge its clearance at assembly"
                    if "clear" in name
                    else "enlarge it"
                )
                raise BearingError(f"journal bearing: {name} = {value:.6g}: must be above 0; {remedy}")
        if not 0.0 <= self.feed_share <= 1.0:
            raise BearingError(
                f"journal bearing: feed_share = {self.feed_share:.6g}: must lie within 0 to 1; it is a share"
            )
        if self.feed not in FEEDS:
            raise BearingError(
                f"journal bearing: feed = {self.feed!r}: must be one of {', '.join(FEEDS)}; choose where oil enters"
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

    def operating_state(self, operation: BearingOperation) -> JournalState:
        """Solve film and heat balance together.

        Raises
        ------
        BearingError : no oil flow, or an axial load, which a plain bearing does not carry
        BearingNotConvergedError : the film would have to be more than 400 K above or 60 K below the inlet

        Source: ISO 7902-1 / DIN 31652-1: heat carried by the oil alone, effective film temperature the mean of
        inlet and outlet. Heat exchanged with the bodies is an input here instead of an assumed housing film.
        """
        curve = characteristic(self.width / self.diameter, self.feed)
        oil = operation.oil
        if not oil.flow > 0.0:
            raise BearingError(
                f"bearing: oil flow = {oil.flow} m3/s: must be above 0; correct the oil supply"
            )
        if operation.axial_load > 0.0:
            raise BearingError(
                f"journal bearing: axial_load = {operation.axial_load:.6g} N: a plain cylindrical bearing carries "
                "none; give it to the thrust bearing"
            )

        def heat_into(film: _Film) -> float:
            given = operation.friction_heat
            own = film.torque * film.omega if given is None else given
            return own + operation.heat_from_bodies

        def film_excess(temperature: float) -> float:
            film = _film(self, curve, operation, oil.viscosity(temperature))
            cooling_flow = _cooling_flow(self, oil.flow, film.side_flow)
            if cooling_flow == 0.0:
                return math.inf
            rise = oil.temperature_rise(heat_into(film), cooling_flow)
            return oil.inlet_temperature + 0.5 * rise - temperature

        temperature = _balance(film_excess, oil.inlet_temperature)
        film = _film(self, curve, operation, oil.viscosity(temperature))
        outlet = oil.inlet_temperature + oil.temperature_rise(heat_into(film), oil.flow)
        return _state(self, operation, film, temperature, outlet)


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


@dataclass(frozen=True)
class _Film:
    """Mechanical state of the film at one viscosity [Pa s]."""

    viscosity: float
    load: float
    omega: float
    sommerfeld: float
    eccentricity: float
    attitude_angle: float
    torque: float
    side_flow: float


def _film(
    bearing: JournalBearing, curve: Characteristic, operation: BearingOperation, viscosity: float
) -> _Film:
    """Drag = Petroff's torque / sqrt(1 - eps^2) plus the pressure part F (C/4) eps sin(beta), times the factor."""
    load, omega = operation.load, abs(operation.speed)
    sommerfeld = sommerfeld_number(bearing, load, omega, viscosity)
    eps = curve.eccentricity(sommerfeld)
    attitude = curve.attitude_angle(eps)
    couette = petroff_torque(bearing, omega, viscosity) / math.sqrt(1.0 - eps**2)
    pressure = 0.25 * bearing.diametral_clearance * load * eps * math.sin(attitude) if omega > 0.0 else 0.0
    side_flow = bearing.diameter**3 * bearing.relative_clearance * omega * curve.side_flow(eps)
    torque = operation.friction_factor * (couette + pressure)
    return _Film(viscosity, load, omega, sommerfeld, eps, attitude, torque, side_flow)


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
    bearing: JournalBearing, operation: BearingOperation, film: _Film, temperature: float, outlet: float
) -> JournalState:
    load, omega, eps, oil = film.load, film.omega, film.eccentricity, operation.oil
    standstill = omega == 0.0 and load > 0.0
    clearance = 0.5 * bearing.diametral_clearance
    state = JournalState(
        regime="standstill" if standstill else "mixed" if eps >= HIGHEST_ECCENTRICITY else "hydrodynamic",
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
        else operation.friction_factor * petroff_torque(bearing, 1.0, film.viscosity),
        petroff_torque=petroff_torque(bearing, omega, film.viscosity),
        film_temperature=temperature,
        outlet_temperature=outlet,
        viscosity=film.viscosity,
        flow=oil.flow,
        cooling_flow=_cooling_flow(bearing, oil.flow, film.side_flow),
        side_flow=film.side_flow,
        transition_speed=transition_speed(bearing, load, film.viscosity),
        reynolds_number=oil.density * omega * 0.5 * bearing.diameter * clearance / film.viscosity,
        reynolds_limit=TAYLOR_LIMIT * math.sqrt(bearing.diameter / bearing.diametral_clearance),
        mean_inverse_gap=1.0 / (clearance * math.sqrt(1.0 - eps**2)),
        heat_from_bodies=operation.heat_from_bodies,
        source=SOURCE,
        warnings=(),
        film=RunningFilm(
            diameter=bearing.diameter,
            width=bearing.width,
            diametral_clearance=bearing.diametral_clearance,
            viscosity=film.viscosity,
            omega=omega,
            feed=bearing.feed,
        ),
    )
    return replace(state, warnings=limit_warnings(state))
