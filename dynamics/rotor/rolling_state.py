"""Steady state of a rolling bearing and what of it lies outside the theory or the catalogue."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import BearingError, BearingState, LateralCoefficients, LateralOperation
from dynamics.rotor.rolling_friction import RPM, FrictionTorque
from dynamics.rotor.rolling_kinds import CatalogueBearing
from dynamics.rotor.rolling_row import RowOfElements
from dynamics.rotor.rolling_stiffness import BearingStiffness, bearing_stiffness, stiffness_at
from dynamics.standards import iso281_2007
from dynamics.standards.skf_friction_2006 import STABILISED_TEMPERATURE


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
    rules = bearing.rules
    bearing.check_axial(conditions.axial)
    load = rules.equivalent_load(bearing, conditions.radial, conditions.axial)
    static = rules.static_equivalent_load(bearing, conditions.radial, conditions.axial)
    n = conditions.speed / RPM
    kappa = conditions.viscosity * 1e6 / iso281_2007.nu_1(n, bearing.elements.pitch_diameter * 1e3)
    modification = iso281_2007.a_1(conditions.reliability)
    if load > 0.0:
        modification *= iso281_2007.a_ISO(
            kappa, conditions.contamination * bearing.fatigue_load / load, rules.contact
        )
    revolutions = iso281_2007.L_10(bearing.dynamic_rating, load, rules.contact)
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
    if state.film_temperature > STABILISED_TEMPERATURE:
        yield (
            f"bearing temperature = {state.film_temperature - 273.15:.0f} degC: above 120 degC, rings change their "
            "size; order stabilised rings or cool the bearing"
        )
    yield from _axial_warnings(state, data)


def _axial_warnings(state: RollingState, data: CatalogueBearing) -> Iterator[str]:
    axial, stiffness = state.axial_load, state.stiffness
    yield from data.rules.load_warnings(data, state.load, axial)
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
    axial = 0.0 if row.elements.straight else abs(operation.axial_force)
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
