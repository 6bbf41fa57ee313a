"""Oil-fed plain journal bearing in steady state: film, temperature, drag torque, transition to fluid friction.

The load number So = F psi^2 / (B D eta omega) gives the eccentricity, the eccentricity the friction

    f / psi = pi / (So sqrt(1 - eps^2)) + (eps / 2) sin(beta) ,     power = f F omega D / 2 ,

and the heat balance of the oil gives the film temperature, whose viscosity enters So again
(ISO 7902-1 / DIN 31652-1; film solved in `dynamics.rotor.journal_film`). Shear acts all round the gap, the broken
film included, as those documents assume: the drag torque is an upper value.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from dynamics.kernels.journal import HIGHEST_ECCENTRICITY, node_of
from dynamics.rotor.bearing import (
    BearingError,
    BearingNotConvergedError,
    BearingOperation,
    BearingState,
    LateralCoefficients,
    LateralOperation,
    Regime,
    load_axes,
)
from dynamics.rotor.journal_feed import FEEDS, Feed
from dynamics.rotor.journal_film import (
    NODES,
    WIDTH_RATIO_STEP,
    Characteristic,
    FilmArc,
    FilmGrid,
    FilmSolution,
    Mask,
    characteristic,
    solve_active,
    solved_films,
    width_steps,
)

# Stiffness, damping and static position of a journal bearing under a load vector.
#
# Film: coefficients of the perturbed film (`_film_coefficients`) times B eta / psi^3; the journal stands at the
# eccentricity that carries the load, the attitude angle ahead of it in the direction of rotation.
#
# No load: no direction is marked, so the limit of the vanishing load is taken in the mean over all directions: skew
# stiffness and isotropic damping, with half the speed between them (the half-frequency whirl).
#
# Mixed friction and standstill: the film carries what it does at the thinnest gap of its theory and asperities the
# rest, W_c, straight against the line of centres. They are taken to share the load by an exponential law whose decay
# length is that gap, 1 % of the clearance and so of the order of the roughness (J. A. Greenwood, J. B. P. Williamson
# 1966: load falls nearly exponentially with separation): W_c / (0.01 c) along the line of centres, W_c / e across it by
# its turning, without friction. At standstill the asperities carry all; what is left of the film is the damping of the
# oil squeezed out of that gap. Shell and housing behind it are the caller's: they are softer.

Array = NDArray[np.float64]


# Stiffness and damping of a bearing film: Reynolds' equation linearised about a static position.
#
# A displacement u and a velocity v of the journal (in units of the clearance c and of c omega) change the gap by
# -u . n, n = (cos theta, sin theta), and with it the pressure by P_1,
#
#     div (H^3 grad P_1) = -6 d(u . n)/dtheta - 12 v . n + div (3 H^2 (u . n) grad P_0)
#
# on the film that carries pressure, P_1 = 0 on all its edges: feed, bearing end and, because P_0 leaves it with no
# gradient, the break-up (J. W. Lund, K. K. Thomsen 1978). The places of feed stand still in the bearing. The operator
# is symmetric, so the damping is; motion round the centre is to the film another speed: C (0, eps) = 2 F, F its static
# force.
#
# The break-up lies between nodes. Ahead of it the static solution is the parabola P'' s^2 / 2 of the distance s from
# it, which the difference equation also solves: a last node with pressure P, the grid step d before the first dry one,
# has s = d/2 + P / (P'' d). With the link from that node to P_1 = 0 set to this distance the coefficients converge at
# second order; with the edge on the dry node they jitter at first order.


@dataclass(frozen=True, eq=False)
class FilmCoefficients:
    """Dimensionless stiffness and damping of a film, force on the journal = -stiffness u - damping v.

    Axes r (from the centre of the bearing to that of the journal) and t (r turned a right angle in the direction of
    rotation); u in clearances c, v in c omega, forces in B D eta omega / psi^2 as the Sommerfeld number.

    stiffness, damping : (2, 2) [-]
    """

    stiffness: Array
    damping: Array

    def turned(self, attitude: float) -> "FilmCoefficients":
        """The same in axes along the load and across it, the line of centres at ``attitude`` [rad] from the load."""
        cosine, sine = math.cos(attitude), math.sin(attitude)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        return FilmCoefficients(turn @ self.stiffness @ turn.T, turn @ self.damping @ turn.T)


def film_coefficients(film: FilmSolution) -> FilmCoefficients:
    """Stiffness and damping of a solved film."""
    return _sum([arc_coefficients(arc) for arc in film.arcs])


def arc_coefficients(arc: FilmArc) -> FilmCoefficients:
    """Part of one arc of film; in axes along the widest gap and across it, which are -r and -t."""
    grid, active = arc.grid, arc.carries
    theta, middles = grid.theta[1:-1], grid.middles
    normals, middle_normals = _normals(theta), _normals(middles)
    bands = grid.bands()
    bands[0] += np.where(active, _edges(arc), 0.0).ravel()
    displaced = [_displaced(arc, normals[i], middle_normals[i]) for i in range(2)]
    moved = [12.0 * normals[i][:, None] * grid.areas for i in range(2)]
    sources = np.stack([source.ravel() for source in (*displaced, *moved)], axis=1)
    changes = solve_active(bands, sources, active.ravel())
    changes[~active.ravel()] = 0.0
    weights = np.stack([(normal[:, None] * grid.areas).ravel() for normal in normals])
    coefficients = 0.5 * weights @ changes
    return FilmCoefficients(coefficients[:, :2], coefficients[:, 2:])


def _sum(parts: Sequence[FilmCoefficients]) -> FilmCoefficients:
    return FilmCoefficients(
        np.sum([part.stiffness for part in parts], axis=0), np.sum([part.damping for part in parts], axis=0)
    )


def _normals(angles: Array) -> tuple[Array, Array]:
    return np.cos(angles), np.sin(angles)


def _displaced(arc: FilmArc, normal: Array, middle_normal: Array) -> Array:
    """(n - 1, m) sources of a unit displacement: the wedge of the changed gap and the changed flow of P_0."""
    grid, pressure = arc.grid, arc.pressure
    source = grid.wedge(-middle_normal)
    round_change = -3.0 * middle_normal / grid.middle_gap
    round_flow = round_change[:, None] * grid.round_links * np.diff(pressure[:, :-1], axis=0)
    source += round_flow[1:] - round_flow[:-1]
    axial_change = -3.0 * normal / grid.gap
    axial_flow = axial_change[:, None] * grid.axial_links * np.diff(pressure[1:-1], axis=1)
    source += axial_flow
    source[:, 1:] -= axial_flow[:, :-1]
    return source


def _edges(arc: FilmArc) -> Array:
    """(n - 1, m) what moving the edge of the film to its place adds to the diagonal of the nodes before it."""
    grid, active = arc.grid, arc.carries
    here = arc.pressure[1:-1, :-1]
    steps = grid.angular_steps[:, None]
    extra = np.zeros(grid.shape)
    dry = np.zeros(grid.shape, dtype=bool)
    dry[:-1] = ~active[1:]
    extra += _stretch(here, arc.pressure[:-2, :-1], steps[1:], steps[:-1], dry) * grid.round_links[1:]
    dry = np.zeros(grid.shape, dtype=bool)
    dry[1:] = ~active[:-1]
    extra += _stretch(here, arc.pressure[2:, :-1], steps[:-1], steps[1:], dry) * grid.round_links[:-1]
    return extra + _axial_edges(grid, arc.pressure[1:-1], active)


def _axial_edges(grid: FilmGrid, pressure: Array, active: Mask) -> Array:
    """The same for edges across the width, seen from the plane of symmetry and from the bearing end."""
    steps, extra = grid.axial_steps[None, :], np.zeros(grid.shape)
    inner = active[:, 1:-1]
    outwards = _stretch(pressure[:, 1:-2], pressure[:, :-3], steps[:, 1:-1], steps[:, :-2], ~active[:, 2:])
    extra[:, 1:-1] += np.where(inner, outwards, 0.0) * grid.axial_links[:, 1:-1]
    inwards = _stretch(pressure[:, 1:-1], pressure[:, 2:], steps[:, :-1], steps[:, 1:], ~active[:, :-1])
    extra[:, 1:] += np.where(active[:, 1:], inwards, 0.0) * grid.axial_links[:, :-1]
    return extra


def _stretch(here: Array, behind: Array, ahead_step: Array, behind_step: Array, dry: Mask) -> Array:
    """d / s - 1 where the next node ahead is dry, else 0.

    here, behind : static pressure of the node and of the one on its other side
    """
    curvature = 2.0 * ((behind - here) / behind_step - here / ahead_step) / (ahead_step + behind_step)
    bent = dry & (curvature > 0.0) & (here > 0.0)
    share = 0.5 + np.where(bent, here, 0.0) / np.where(bent, curvature * ahead_step**2, 1.0)
    stretch: Array = np.where(bent, 1.0 / np.clip(share, 0.5, 1.5) - 1.0, 0.0)
    return stretch


# Stiffness and damping of a journal film over eccentricity, for one width ratio and feed.
#
# The film is perturbed at the eccentricities at which the characteristic is solved, when a width ratio is first met,
# and kept. Between them the coefficients over So / eps, freed of their growth towards contact, are interpolated: smooth
# from the centred journal, where K = (omega / 2) C J with J = [[0, 1], [-1, 0]] because moving with half the speed of
# rotation round the centre is the same to the film as standing off it, to the thinnest film.


CENTRED = 1e-6
"""Eccentricity at which the film of the centred journal is perturbed; closer in, rounding shows."""
CLOSE_IN: Array = np.array([CENTRED, 0.005, 0.015, 0.03])
"""Where the film is perturbed besides the nodes of the characteristic: the break-up of a narrow film moves quickly."""
GROWTH: Array = np.array([1.0, -0.5, 0.5, 0.0, 0.5, 0.0, 0.0, -0.5])
"""Powers of 1 / (1 - eps) with which the entries of stiffness and damping grow over So towards contact, those of the
short bearing."""


@dataclass(frozen=True, eq=False)
class CoefficientTable:
    """Coefficients of a bearing of one width ratio and feed; make it with `coefficient_table`."""

    characteristic: Characteristic
    _scaled: CubicSpline

    def at(self, eccentricity: float) -> FilmCoefficients:
        """Dimensionless stiffness and damping at eps in [0, HIGHEST_ECCENTRICITY], axes r and t."""
        eps = max(eccentricity, CENTRED)
        scale = self.characteristic.sommerfeld(eps) / eps * (1.0 - eps) ** -GROWTH
        values = scale * self._scaled(node_of(eps))
        return FilmCoefficients(values[:4].reshape(2, 2), values[4:].reshape(2, 2))


def coefficient_table(width_ratio: float, feed: Feed = "widest_gap") -> CoefficientTable:
    """Table of a width ratio B/D and a feed, solved once and kept.

    Raises
    ------
    DynamicsInputError : B/D outside 0.1 to 2, where a plain bearing of this kind is not built
    """
    return _solved(width_steps(width_ratio), feed)


@lru_cache(maxsize=64)
def _solved(steps: int, feed: Feed) -> CoefficientTable:
    width_ratio = steps * WIDTH_RATIO_STEP
    rows, nodes = [], np.sort(np.concatenate([CLOSE_IN, NODES]))
    for film in solved_films(width_ratio, feed, nodes):
        coefficients = film_coefficients(film)
        values = np.concatenate([coefficients.stiffness.ravel(), coefficients.damping.ravel()])
        rows.append(values * film.eccentricity / film.sommerfeld * (1.0 - film.eccentricity) ** GROWTH)
    return CoefficientTable(characteristic(width_ratio, feed), CubicSpline(nodes, np.array(rows)))


@dataclass(frozen=True, kw_only=True)
class RunningFilm:
    """What a film is at a speed and a temperature.

    diameter, width, diametral_clearance : [m]
    viscosity : dynamic, of the film [Pa s]
    omega : magnitude of the shaft speed [rad/s]
    feed : where its oil enters
    """

    diameter: float
    width: float
    diametral_clearance: float
    viscosity: float
    omega: float
    feed: Feed = "widest_gap"

    @property
    def clearance(self) -> float:
        """Radial c [m]."""
        return 0.5 * self.diametral_clearance

    @property
    def force_scale(self) -> float:
        """B D eta omega / psi^2 [N], force of a Sommerfeld number of 1."""
        psi = self.diametral_clearance / self.diameter
        return self.width * self.diameter * self.viscosity * self.omega / psi**2

    @property
    def damping_scale(self) -> float:
        """2 B eta / psi^3 [N s/m]; times omega the scale of the stiffness."""
        psi = self.diametral_clearance / self.diameter
        return 2.0 * self.width * self.viscosity / psi**3

    @property
    def table(self) -> CoefficientTable:
        """Coefficients over eccentricity."""
        return coefficient_table(self.width / self.diameter, self.feed)


@dataclass(frozen=True, eq=False)
class _Place:
    """Coefficients in SI, axes r and t, where the journal stands; attitude from the load [rad]."""

    eccentricity: float
    attitude: float
    coefficients: FilmCoefficients
    regime: Regime


@lru_cache(maxsize=4096)
def journal_lateral(film: RunningFilm, operation: LateralOperation) -> LateralCoefficients:
    """Stiffness, damping and static position of a plain bearing.

    Raises
    ------
    BearingError : standstill without load, where nothing holds the journal
    DynamicsInputError : B/D outside 0.1 to 2
    """
    load = math.hypot(*operation.force)
    if load == 0.0:
        return _unloaded(film, operation.sense)
    limit = film.table.characteristic.sommerfeld(HIGHEST_ECCENTRICITY) * film.force_scale
    place = _carried_by_film(film, load) if load <= limit else _in_contact(film, load, limit, operation)
    turned = place.coefficients.turned(place.attitude)
    axes = load_axes(operation.force, operation.sense)
    towards = np.array([math.cos(place.attitude), math.sin(place.attitude)])
    return LateralCoefficients(
        stiffness=axes @ turned.stiffness @ axes.T,
        damping=axes @ turned.damping @ axes.T,
        position=film.clearance * place.eccentricity * axes @ towards,
        regime=place.regime,
        eccentricity=place.eccentricity,
    )


def _film_coefficients(film: RunningFilm, eccentricity: float) -> FilmCoefficients:
    coefficients = film.table.at(eccentricity)
    return FilmCoefficients(
        film.omega * film.damping_scale * coefficients.stiffness, film.damping_scale * coefficients.damping
    )


def _carried_by_film(film: RunningFilm, load: float) -> _Place:
    curve = film.table.characteristic
    eccentricity = curve.eccentricity(load / film.force_scale)
    attitude = curve.attitude_angle(eccentricity)
    return _Place(eccentricity, attitude, _film_coefficients(film, eccentricity), "hydrodynamic")


def _in_contact(film: RunningFilm, load: float, limit: float, operation: LateralOperation) -> _Place:
    """Film at its thinnest, which carries ``limit`` [N], and asperities beside it."""
    film_attitude = film.table.characteristic.attitude_angle(HIGHEST_ECCENTRICITY)
    attitude = math.asin(limit * math.sin(film_attitude) / load)
    contact = load * math.cos(attitude) - limit * math.cos(film_attitude)
    gap = 1.0 - HIGHEST_ECCENTRICITY
    eccentricity = HIGHEST_ECCENTRICITY + gap * contact / load
    asperities = np.diag([contact / gap, contact / eccentricity]) / film.clearance
    thinnest = _film_coefficients(film, HIGHEST_ECCENTRICITY)
    together = FilmCoefficients(
        thinnest.stiffness + asperities, thinnest.damping + operation.structural_damping * asperities
    )
    return _Place(eccentricity, attitude, together, "mixed" if film.omega > 0.0 else "standstill")


def _unloaded(film: RunningFilm, sense: int) -> LateralCoefficients:
    if film.omega == 0.0:
        raise BearingError(
            "journal bearing: load = 0 N at standstill: neither film nor contact holds the journal; give the load with "
            "the weight of the shaft, or a speed"
        )
    damping = 0.5 * film.damping_scale * float(np.trace(film.table.at(0.0).damping))
    skew = 0.5 * film.omega * damping * sense
    return LateralCoefficients(
        stiffness=np.array([[0.0, skew], [-skew, 0.0]]),
        damping=damping * np.eye(2),
        position=np.zeros(2),
        regime="hydrodynamic",
        eccentricity=0.0,
    )


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
    warnings = []
    if state.regime == "mixed":
        warnings.append(
            f"eccentricity >= {HIGHEST_ECCENTRICITY}: mixed friction, drag torque and film thickness are bounds; "
            "raise speed or viscosity or lower the load"
        )
    if 0.0 < state.omega < state.transition_speed:
        warnings.append(
            f"speed = {state.omega * 30.0 / math.pi:.0f} rpm: below the transition speed "
            f"{state.transition_speed * 30.0 / math.pi:.0f} rpm of this load; lower the load until it is passed"
        )
    if state.reynolds_number > state.reynolds_limit:
        warnings.append(
            f"Reynolds number = {state.reynolds_number:.0f}: above {state.reynolds_limit:.0f}, the film is not "
            "laminar and its drag torque is higher; reduce the clearance or use a thicker oil"
        )
    if state.side_flow > state.flow:
        warnings.append(
            f"oil flow = {state.flow * 6e4:.3g} l/min: below the {state.side_flow * 6e4:.3g} l/min the film drives "
            "out, the bearing starves; feed more oil"
        )
    return tuple(warnings)


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
            friction_heat = film.torque * film.omega if given is None else given
            return friction_heat + operation.heat_from_bodies

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
