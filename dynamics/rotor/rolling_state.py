"""Steady state of a rolling bearing and what of it lies outside the theory or the catalogue."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import BearingError, BearingState, LateralCoefficients, LateralOperation
from dynamics.rotor.rolling_catalogue import RPM, CatalogueBearing
from dynamics.rotor.rolling_row import RowOfElements
from dynamics.rotor.rolling_stiffness import BearingStiffness, bearing_stiffness, stiffness_at
from dynamics.standards import iso281_2007
from dynamics.standards import iso_tr_14179_2_2001 as palmgren
from dynamics.standards import skf_friction_2006 as skf

# Equivalent loads, rating life, static safety, least load and speed limits of a rolling bearing.
#
# Sources: ISO 281 and ISO 76 with the factors of the catalogues (SKF General Catalogue 6000, chapters of the four
# kinds; NSK for the same factors of angular contact ball bearings).

DEEP_GROOVE_FACTORS = (
    (0.172, 0.19, 2.30), (0.345, 0.22, 1.99), (0.689, 0.26, 1.71), (1.03, 0.28, 1.55), (1.38, 0.30, 1.45),
    (2.07, 0.34, 1.31), (3.45, 0.38, 1.15), (5.17, 0.42, 1.04), (6.89, 0.44, 1.00),
)  # fmt: skip
"""f_0 F_a / C_0, e, Y of deep groove ball bearings with normal clearance, X = 0.56 (SKF 6000 table 5 p. 299)."""
LARGEST_AXIAL_SHARE = 0.5
"""F_a / F_r that flanges of a cylindrical roller bearing, F_a / C_0 that a deep groove ball bearing should carry."""


@dataclass(frozen=True, kw_only=True)
class RatingLife:
    """Life and safety of a bearing at one load.

    equivalent_load, static_equivalent_load : P, P_0 [N]
    basic_life, modified_life : at the reliability asked for [h]; infinite at rest or without load
    life_modification : a_1 a_ISO [-]
    viscosity_ratio : kappa [-]; 0 at rest
    static_safety : C_0 / P_0 [-]
    """

    equivalent_load: float
    static_equivalent_load: float
    basic_life: float
    modified_life: float
    life_modification: float
    viscosity_ratio: float
    static_safety: float


def equivalent_load(bearing: CatalogueBearing, radial: float, axial: float) -> float:
    """Dynamic equivalent load P [N] of a single bearing; the axial force is the one inside it, the induced included.

    Raises BearingError for axial load on a bearing that carries none.
    """
    check_axial(bearing, axial)
    if bearing.kind == "deep_groove_ball":
        limit, factor = deep_groove_factors(bearing, axial)
        return radial if axial <= limit * radial else max(radial, 0.56 * radial + factor * axial)
    if bearing.kind == "cylindrical_roller":
        limit, factor = (0.2, 0.6) if bearing.series in ("10", "2", "3", "4") else (0.3, 0.4)
        return radial if axial <= limit * radial else 0.92 * radial + factor * axial
    share = 0.4 if bearing.kind == "tapered_roller" else 0.35
    return radial if axial <= bearing.axial_limit * radial else share * radial + bearing.axial_factor * axial


def deep_groove_factors(bearing: CatalogueBearing, axial: float) -> tuple[float, float]:
    """e and Y of a deep groove ball bearing, linear between the printed values and constant outside them."""
    f_0 = 14.0 if bearing.f_0 is None else bearing.f_0
    relative = f_0 * axial / bearing.static_rating
    first, last = DEEP_GROOVE_FACTORS[0], DEEP_GROOVE_FACTORS[-1]
    if relative <= first[0]:
        return first[1], first[2]
    for low, high in pairwise(DEEP_GROOVE_FACTORS):
        if relative <= high[0]:
            share = (relative - low[0]) / (high[0] - low[0])
            return low[1] + share * (high[1] - low[1]), low[2] + share * (high[2] - low[2])
    return last[1], last[2]


def static_equivalent_load(bearing: CatalogueBearing, radial: float, axial: float) -> float:
    """Static equivalent load P_0 [N] of a single bearing."""
    if bearing.kind == "deep_groove_ball":
        return max(radial, 0.6 * radial + 0.5 * axial)
    if bearing.kind == "cylindrical_roller":
        return radial
    return max(radial, 0.5 * radial + bearing.static_axial_factor * axial)


def check_axial(bearing: CatalogueBearing, axial: float) -> None:
    """Raises BearingError for axial load on a bearing that cannot carry it."""
    if axial > 0.0 and not bearing.locating:
        raise BearingError(
            f"rolling bearing {bearing.designation}: axial_load = {axial:.6g} N: its rings move past each other and "
            "carry none; take the axial load up in the other bearing or choose NJ, NUP or a locating kind"
        )


def induced_axial_load(bearing: CatalogueBearing, radial: float) -> float:
    """Axial force that the radial load of a tapered or angular contact bearing produces [N]; 0 for other kinds.

    F_r / (2 Y) for tapered roller bearings (SKF 6000 table 3 p. 613), e F_r for angular contact ball bearings of 40
    degrees (the value at high load; less below it).
    """
    if bearing.kind == "tapered_roller":
        return radial / (2.0 * bearing.axial_factor)
    return bearing.axial_limit * radial if bearing.kind == "angular_contact_ball" else 0.0


def minimum_load(bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
    """Radial load below which rolling elements may slide [N]; kinematic viscosity [m2/s], speed [rad/s].

    Balls k_r (nu n / 1000)^(2/3) (d_m / 100)^2, cylindrical rollers k_r (6 + 4 n / n_r) (d_m / 100)^2 in kN, tapered
    rollers 0.02 C (SKF General Catalogue 6000 pp. 299, 414, 518, 611).
    """
    if bearing.kind == "tapered_roller":
        return 0.02 * bearing.dynamic_rating
    size = (bearing.mean_diameter * 10.0) ** 2
    if bearing.kind == "cylindrical_roller":
        return 1e3 * bearing.minimum_load_factor * (6.0 + 4.0 * speed / bearing.reference_speed) * size
    product = viscosity * 1e6 * speed / RPM / 1000.0
    load: float = 1e3 * bearing.minimum_load_factor * product ** (2.0 / 3.0) * size
    return load


@dataclass(frozen=True, kw_only=True)
class LifeConditions:
    """What the life of a bearing depends on besides the bearing.

    radial, axial : load, not negative [N]
    speed : magnitude [rad/s]
    viscosity : kinematic, at the bearing temperature [m2/s]
    contamination : factor e_C of ISO 281, 0 to 1
    reliability : 0.90 to 0.99
    """

    radial: float
    axial: float
    speed: float
    viscosity: float
    contamination: float
    reliability: float


def rating_life(bearing: CatalogueBearing, conditions: LifeConditions) -> RatingLife:
    """Basic and modified rating life at constant load and speed (ISO 281)."""
    load = equivalent_load(bearing, conditions.radial, conditions.axial)
    static = static_equivalent_load(bearing, conditions.radial, conditions.axial)
    n = conditions.speed / RPM
    kappa = conditions.viscosity * 1e6 / iso281_2007.nu_1(n, bearing.elements.pitch_diameter * 1e3)
    modification = iso281_2007.a_1(conditions.reliability)
    if load > 0.0:
        modification *= iso281_2007.a_ISO(
            kappa, conditions.contamination * bearing.fatigue_load / load, bearing.contact
        )
    revolutions = iso281_2007.L_10(bearing.dynamic_rating, load, bearing.contact)
    hours = revolutions * 1e6 / (60.0 * n) if n > 0.0 else math.inf
    return RatingLife(
        equivalent_load=load,
        static_equivalent_load=static,
        basic_life=hours,
        modified_life=modification * hours,
        life_modification=modification,
        viscosity_ratio=kappa,
        static_safety=bearing.static_rating / static if static > 0.0 else math.inf,
    )


# Friction torque of a rolling bearing by one of two laws, in the four sources of the SKF model.
#
# ``iso_tr_14179_2`` (Palmgren) and ``skf`` (four sources) are written in the units of their documents under
# `dynamics.standards`; here a bearing and its operation become their arguments.

FrictionLaw = Literal["iso_tr_14179_2", "skf"]
LAWS: tuple[FrictionLaw, ...] = get_args(FrictionLaw)
Lubrication = Literal["oil_bath", "oil_jet", "oil_spot", "grease"]
LUBRICATIONS: tuple[Lubrication, ...] = get_args(Lubrication)
OilKind = Literal["mineral", "synthetic", "transmission"]
OIL_KINDS: tuple[OilKind, ...] = get_args(OilKind)

SOURCES: dict[FrictionLaw, str] = {
    "iso_tr_14179_2": "ISO/TR 14179-2 (Palmgren), f_0 and f_1 of DIN 732-2",
    "skf": "SKF General Catalogue 6000, four-source model",
}
JET_DRAG_FACTOR = 2.0
"""Jet oil: twice the drag of a bath up to the middle of the lowest rolling element (SKF General Catalogue p. 100)."""


@dataclass(frozen=True, kw_only=True)
class FrictionTorque:
    """Friction torque in its sources [N m].

    rolling : M_rr with shear heating and starvation; by the Palmgren law the load-dependent torque T_VL1
    sliding : M_sl; by the Palmgren law the flange torque T_VL2
    seals : of the bearing's own contact seals
    drag : of the oil it runs in; by the Palmgren law the load-independent torque T_VL0
    """

    rolling: float
    sliding: float
    seals: float
    drag: float

    @property
    def total(self) -> float:
        """Sum of the four [N m]."""
        return self.rolling + self.sliding + self.seals + self.drag

    def scaled(self, factor: float) -> "FrictionTorque":
        """Every source times ``factor``."""
        return FrictionTorque(
            rolling=factor * self.rolling,
            sliding=factor * self.sliding,
            seals=factor * self.seals,
            drag=factor * self.drag,
        )


@dataclass(frozen=True, kw_only=True)
class FrictionConditions:
    """What the friction of a bearing depends on besides the bearing.

    radial, axial : load, not negative [N]
    speed : magnitude [rad/s]
    viscosity : kinematic, of the oil or the base oil of the grease at the bearing temperature [m2/s]
    lubrication : how the oil comes
    oil_level : above the lowest point of the outer raceway at rest [m]; read for an oil bath
    oil_kind : decides the sliding friction in full film
    """

    radial: float
    axial: float
    speed: float
    viscosity: float
    lubrication: Lubrication
    oil_level: float
    oil_kind: OilKind


def friction_torque(
    law: FrictionLaw, bearing: CatalogueBearing, conditions: FrictionConditions
) -> FrictionTorque:
    """Friction torque of the open bearing by ``law``."""
    return _skf(bearing, conditions) if law == "skf" else _palmgren(bearing, conditions)


def _palmgren(bearing: CatalogueBearing, conditions: FrictionConditions) -> FrictionTorque:
    row = palmgren.COEFFICIENTS[bearing.kind][bearing.series]
    d_m, n, nu = bearing.mean_diameter * 1e3, conditions.speed / RPM, conditions.viscosity * 1e6
    radial, axial = conditions.radial, conditions.axial
    static = static_equivalent_load(bearing, radial, axial)
    f_1 = palmgren.f_1(row, static, bearing.static_rating)
    load = palmgren.P_1(bearing.kind, radial, axial, bearing.axial_factor)
    flange = 0.0
    if bearing.kind == "cylindrical_roller":
        f_2 = palmgren.F_2["grease" if conditions.lubrication == "grease" else "oil"]
        flange = palmgren.T_VL2(f_2, axial, d_m)
    f_0 = row.f_0 * palmgren.LUBRICATION_FACTOR[conditions.lubrication]
    return FrictionTorque(
        rolling=1e-3 * palmgren.T_VL1(f_1, load, d_m),
        sliding=1e-3 * flange,
        seals=0.0,
        drag=1e-3 * palmgren.T_VL0(f_0, nu, n, d_m),
    )


def _skf(bearing: CatalogueBearing, conditions: FrictionConditions) -> FrictionTorque:
    size = skf.Size(bearing.bore * 1e3, bearing.outside_diameter * 1e3, bearing.width * 1e3)
    n, nu = conditions.speed / RPM, conditions.viscosity * 1e6
    moments = skf_moments(bearing, conditions.radial, conditions.axial, n)
    mu_full_film = skf.MU_EHL_KIND.get(bearing.kind, skf.MU_EHL[conditions.oil_kind])
    sliding = moments.G_sl * skf.mu_sl(n, nu, size.d_m, mu_full_film)
    if n == 0.0:
        return FrictionTorque(rolling=0.0, sliding=1e-3 * sliding, seals=0.0, drag=0.0)
    starvation = 1.0
    if not flooded(bearing, conditions):
        starvation = skf.phi_rs(skf.K_RS[conditions.lubrication], skf.K_Z[bearing.kind], n, nu, size)
    rolling = skf.phi_ish(n, nu, size.d_m) * starvation * skf.M_rr(moments.G_rr, n, nu)
    return FrictionTorque(
        rolling=1e-3 * rolling, sliding=1e-3 * sliding, seals=0.0, drag=1e-3 * _skf_drag(bearing, conditions)
    )


def skf_moments(bearing: CatalogueBearing, radial: float, axial: float, n: float) -> skf.Moments:
    """G_rr and G_sl of the SKF model at loads [N] and a speed [1/min], in its units."""
    d_m = bearing.mean_diameter * 1e3
    if bearing.kind == "deep_groove_ball":
        return skf.deep_groove(skf.DEEP_GROOVE[bearing.series], d_m, radial, axial, bearing.static_rating)
    if bearing.kind == "angular_contact_ball":
        return skf.angular_contact(skf.ANGULAR_CONTACT, d_m, radial, axial, n)
    if bearing.kind == "cylindrical_roller":
        return skf.cylindrical(skf.CYLINDRICAL[bearing.series], d_m, radial, axial)
    return skf.tapered(skf.TAPERED[bearing.series], d_m, radial, axial, bearing.axial_factor)


def flooded(bearing: CatalogueBearing, conditions: FrictionConditions) -> bool:
    """Oil bath that reaches the centre of the lowest rolling element: its contacts do not starve."""
    return conditions.lubrication == "oil_bath" and conditions.oil_level >= 0.5 * bearing.elements.diameter


def _skf_drag(bearing: CatalogueBearing, conditions: FrictionConditions) -> float:
    """[N mm]; none with grease and oil in drops."""
    if conditions.lubrication not in ("oil_bath", "oil_jet"):
        return 0.0
    jet = conditions.lubrication == "oil_jet"
    size = skf.Size(bearing.bore * 1e3, bearing.outside_diameter * 1e3, bearing.width * 1e3)
    level = 0.5 * bearing.elements.diameter if jet else conditions.oil_level
    drag = skf.M_drag(bearing.kind, size, level * 1e3, conditions.speed / RPM)
    return JET_DRAG_FACTOR * drag if jet else drag


@dataclass(frozen=True, kw_only=True)
class RollingState(BearingState):
    """Steady state of a rolling bearing; beyond the common fields its own, SI units.

    Of the common fields, ``film_temperature`` is that of the node (rolling elements and lubricant);
    ``mean_inverse_gap`` is that of an oil gap of 0.13 W/(m K) on the bore that conducts as much as the path to the
    shaft seat;
    ``heat_from_bodies`` what the operation gives less what flows into the seats, so that
    power + heat_from_bodies = rho c Q (outlet - inlet); ``torsional_damping`` is 0 at rest.
    """

    axial_load: float
    """[N]"""
    friction: FrictionTorque
    """The drag torque in its four sources."""
    viscosity: float
    """Dynamic, at the bearing temperature [Pa s]."""
    capacity_rate: float
    """rho c Q of the oil that passes [W/K]."""
    shaft_conductance: float
    """G_s [W/K]; 0 without a shaft temperature."""
    housing_conductance: float
    """G_h [W/K]; 0 without a housing temperature."""
    heat_to_shaft: float
    """[W]"""
    heat_to_housing: float
    """[W]"""
    inner_ring_temperature: float
    """Middle of the ring [K]."""
    outer_ring_temperature: float
    """Middle of the ring [K]."""
    life: RatingLife
    load_utilisation: float
    """P / C [-]."""
    speed_utilisation: float
    """Speed over the limiting speed [-]."""
    reference_speed_utilisation: float
    """Speed over the thermal reference speed [-]."""
    minimum_load: float
    """Radial load below which rolling elements may slide [N]."""
    stiffness: BearingStiffness
    """Tangent stiffness at the load and its displacement."""
    row: RowOfElements
    """Rolling elements and clearance as it runs, about which the stiffness is taken."""

    def lateral_coefficients(self, operation: LateralOperation) -> LateralCoefficients:
        """Stiffness, structural damping and static position of its rings under the load of the operation.

        Raises BearingError without a load on a bearing without preload.
        """
        return rolling_lateral(self.row, operation)


def rolling_state(state: BearingState) -> RollingState | None:
    """The state with what only a rolling bearing has; None for another kind."""
    return state if isinstance(state, RollingState) else None


def limit_warnings(state: RollingState, data: CatalogueBearing, *, drag_in_bath: bool) -> Iterator[str]:
    """Sentences for what lies outside: name, value, limit, remedy.

    drag_in_bath : the drag was computed by the SKF model of an oil bath
    """
    omega, life, least = state.omega, state.life, state.minimum_load
    if omega > data.limiting_speed:
        yield (
            f"speed = {omega / RPM:.0f} rpm: above the limiting speed {data.limiting_speed / RPM:.0f} rpm; take a "
            "smaller or more precise bearing"
        )
    if drag_in_bath and omega > data.reference_speed:
        yield (
            f"speed = {omega / RPM:.0f} rpm: above the reference speed {data.reference_speed / RPM:.0f} rpm up to "
            "which the drag in an oil bath is described; lower the oil level or feed jet oil"
        )
    if omega > 0.0 and state.load < least:
        yield (
            f"radial load = {state.load:.0f} N: below the least load {least:.0f} N, rolling elements may slide; "
            "preload the bearing or take a smaller one"
        )
    if life.equivalent_load > 0.5 * data.dynamic_rating:
        yield (
            f"equivalent load = {life.equivalent_load:.0f} N: above half the dynamic rating "
            f"{0.5 * data.dynamic_rating:.0f} N, outside ISO 281; take a larger bearing"
        )
    if life.static_safety < 1.0:
        yield (
            f"static safety = {life.static_safety:.2f}: below 1, raceways are indented; take a larger bearing"
        )
    if omega > 0.0 and life.viscosity_ratio < iso281_2007.KAPPA_MINIMUM:
        yield (
            f"viscosity ratio = {life.viscosity_ratio:.3f}: below 0.1, the modified life is not described; use a "
            "thicker oil or cool the bearing"
        )
    if state.film_temperature > skf.STABILISED_TEMPERATURE:
        yield (
            f"bearing temperature = {state.film_temperature - 273.15:.0f} degC: above 120 degC, rings change their "
            "size; order stabilised rings or cool the bearing"
        )
    yield from _axial_warnings(state, data)


def _axial_warnings(state: RollingState, data: CatalogueBearing) -> Iterator[str]:
    axial, stiffness = state.axial_load, state.stiffness
    if data.kind == "cylindrical_roller" and axial > LARGEST_AXIAL_SHARE * state.load:
        yield (
            f"axial load = {axial:.0f} N: above half the radial load {state.load:.0f} N, flanges overload; take "
            "the axial load up elsewhere"
        )
    if data.kind == "deep_groove_ball" and axial > LARGEST_AXIAL_SHARE * data.static_rating:
        yield (
            f"axial load = {axial:.0f} N: above half the static rating {data.static_rating:.0f} N; take an angular "
            "contact bearing"
        )
    if stiffness.held_axially and state.load > 0.0:
        yield (
            f"axial load = {axial:.0f} N: below the {stiffness.axial_load:.0f} N the radial load induces; the "
            "stiffness is that of a bearing set without end play, give the axial load inside the bearing"
        )


# Stiffness, structural damping and static position of a rolling bearing under a load vector.
#
# The five-by-five tangent stiffness of the rolling elements as they stand with one of them under the load; their
# passing under it, centrifugal force and gyroscopic moment are not in it. The axis of the bearing is x of the rig, its
# first radial direction y. Metal contacts damp little: the share is the caller's, c = structural_damping times k.

ORDER = [2, 0, 1, 3, 4]
"""Places of u_x, u_y, u_z, theta_y, theta_z among x, y, z, rx, ry of the bearing, whose z is the axis."""


def rolling_lateral(row: RowOfElements, operation: LateralOperation) -> LateralCoefficients:
    """Coefficients of a row of rolling elements; axially and against tilting as well.

    A bearing with a contact angle takes axial force up in the direction of the operation's (along +x without one).
    Rollers without one leave it to their flanges, which have no stiffness here.

    Raises
    ------
    BearingError : no rolling element carries load: nothing holds the rings
    BearingNotConvergedError : no displacement carries the load
    """
    radial = math.hypot(*operation.force)
    straight_rollers = row.elements.roller and row.elements.contact_angle == 0.0
    axial = 0.0 if straight_rollers else abs(operation.axial_force)
    found = bearing_stiffness(replace(row, direction=1), radial, axial)
    if found.loaded_elements == 0:
        raise BearingError(
            f"rolling bearing: load = 0 N with a clearance of {1e6 * row.clearance:.3g} um: no element carries, "
            "nothing holds the rings; give the load with the weight of the shaft, or a preload"
        )
    direction = -1 if operation.axial_force < 0.0 else 1
    azimuth = math.atan2(operation.force[1], operation.force[0])
    whole = stiffness_at(replace(row, direction=direction), found, azimuth)[np.ix_(ORDER, ORDER)]
    damping = operation.structural_damping * whole
    towards: NDArray[np.float64] = np.array([math.cos(azimuth), math.sin(azimuth)])
    return LateralCoefficients(
        stiffness=whole[1:3, 1:3],
        damping=damping[1:3, 1:3],
        position=found.radial_displacement * towards,
        regime="elastic",
        all_stiffness=whole,
        all_damping=damping,
    )
