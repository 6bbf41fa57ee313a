"""Load distribution, displacement and linearised stiffness of a rolling bearing.

Rings stay round; they move against each other by a radial and an axial displacement. Every rolling element is pressed
by what the displacement takes off its space and gives its force back along its contact angle; the sum over the
elements (the sum that Sjoevall's integral stands for) balances the load. The elastic energy is a convex function of
the displacement, so a damped Newton iteration finds it from anywhere; its second derivative is the stiffness, also
against tilting. The bearing is found without tilting; a program whose shaft bends asks `ring_load`.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import BearingError, BearingNotConvergedError
from dynamics.rotor.rolling_row import FloatArray, RowOfElements, contacts, ring_load

MOST_ITERATIONS = 100
ACCURACY = 1e-9
"""Residual force over the load at which the iteration ends."""


@dataclass(frozen=True, kw_only=True)
class BearingStiffness:
    """Displacement and tangent stiffness at a load.

    radial_displacement, axial_displacement : inner against outer ring, clearance included [m]
    radial, axial : d(force) / d(displacement), the other displacement held [N/m]
    lateral : across the load in the radial plane [N/m]
    coupling : d(radial force) / d(axial displacement) [N/m]
    tilting, tilting_lateral : d(moment) / d(tilt) in the plane of load and axis, and across it, the other
        displacements held [N m/rad]
    radial_load, axial_load : carried [N]; the axial one is above what was asked where the bearing is held axially
    largest_element_load : [N]
    loaded_elements : number that carry load
    held_axially : the axial load is less than the radial one induces; the bearing was taken as held by its partner
        with no end play
    """

    radial_displacement: float
    axial_displacement: float
    radial: float
    axial: float
    lateral: float
    coupling: float
    tilting: float
    tilting_lateral: float
    radial_load: float
    axial_load: float
    largest_element_load: float
    loaded_elements: int
    held_axially: bool


def bearing_stiffness(row: RowOfElements, radial: float, axial: float) -> BearingStiffness:
    """Stiffness of a single bearing under a radial and an axial load, not negative [N].

    Raises
    ------
    BearingError : axial load on a bearing of cylindrical rollers, whose flanges have no stiffness here
    BearingNotConvergedError : no displacement carries the load
    """
    if row.elements.straight and axial > 0.0:
        raise BearingError(
            f"bearing stiffness: axial load = {axial:.6g} N: rollers without contact angle carry it by their flanges; "
            "give the radial load alone"
        )
    angled = row.elements.contact_angle > 0.0
    if angled:
        held = _solve((row,), radial, 0.0, free_axially=False)
        if held.axial_load > axial:
            return held
    free = axial > 0.0 or row.clearance < 0.0
    return _solve((row,), radial, axial, free_axially=free and not row.elements.straight)


def stiffness_at(row: RowOfElements, found: BearingStiffness, azimuth: float = 0.0) -> FloatArray:
    """Tangent stiffness of a single bearing, untilted; (5, 5) in the order x, y, z, rx, ry.

    z is the axis, rx and ry are rotations about x and y; forces in N, moments in N m, displacements in m and rad, of
    the inner ring against the outer one at the middle of the bearing. Symmetric and positive semidefinite: rows of a
    direction without stiffness (z of cylindrical rollers, whose flanges are not counted) are 0.

    found : displacement that `bearing_stiffness` found for the row in direction 1
    azimuth : of the radial load from x towards y [rad]; the most loaded element stands there
    """
    along = row.direction * found.axial_displacement
    matrix = ring_load((row,), np.array([found.radial_displacement, 0.0, along, 0.0, 0.0])).stiffness
    cosine, sine = math.cos(azimuth), math.sin(azimuth)
    turn = np.eye(5)
    turn[:2, :2] = turn[3:, 3:] = [[cosine, -sine], [sine, cosine]]
    return np.asarray(turn @ matrix @ turn.T)


@dataclass(frozen=True)
class _Balance:
    """Energy, force (radial, axial) and its derivative at a displacement, with what the elements carry."""

    energy: float
    force: FloatArray
    tangent: FloatArray
    lateral: float
    element_loads: FloatArray


def _balance(rows: tuple[RowOfElements, ...], radial: float, axial: float) -> _Balance:
    energy, lateral = 0.0, 0.0
    force, tangent = np.zeros(2), np.zeros((2, 2))
    loads = []
    for row in rows:
        count = row.elements.count
        azimuth = 2.0 * math.pi / count * np.arange(count)
        cosine = np.cos(azimuth)
        pressed = contacts(row, radial * cosine, row.direction * axial)
        energy += pressed.energy
        force += (float(pressed.radial @ cosine), row.direction * float(np.sum(pressed.axial)))
        tangent[0, 0] += float(pressed.k_rr @ cosine**2)
        tangent[0, 1] += row.direction * float(pressed.k_ra @ cosine)
        tangent[1, 1] += float(np.sum(pressed.k_aa))
        lateral += float(pressed.k_rr @ np.sin(azimuth) ** 2)
        loads.append(pressed.load)
    tangent[1, 0] = tangent[0, 1]
    return _Balance(energy, force, tangent, lateral, np.concatenate(loads))


def _solve(
    rows: tuple[RowOfElements, ...], radial: float, axial: float, *, free_axially: bool
) -> BearingStiffness:
    """Damped Newton iteration on the energy less the work of the load."""
    target = np.array([radial, axial if free_axially else 0.0])
    scale = float(np.linalg.norm(target))
    place = _start(rows[0], radial, axial, free_axially)
    state = _balance(rows, *place)
    active = np.array([True, free_axially])
    for _ in range(MOST_ITERATIONS):
        residual = np.where(active, target - state.force, 0.0)
        if float(np.linalg.norm(residual)) <= ACCURACY * scale + _round_off(rows, state, place):
            return _result(rows, state, place, held=not free_axially and _angled(rows))
        place, state = _step(rows, place, state, residual, target, active)
    raise BearingNotConvergedError(
        f"bearing stiffness: no displacement carries {radial:.6g} N radial and {axial:.6g} N axial, residual "
        f"{float(np.linalg.norm(residual)):.3g} N; correct load, clearance or the rolling elements"
    )


def _round_off(rows: tuple[RowOfElements, ...], state: _Balance, place: FloatArray) -> float:
    """Force that the last digits of displacements, of the clearance and of the groove's width make [N]."""
    lengths = sum(abs(row.clearance) + abs(row.axial_offset) + row.law.groove_distance for row in rows)
    size = float(np.trace(state.tangent)) * (float(np.abs(place).sum()) + lengths)
    return 16.0 * float(np.finfo(float).eps) * (size + float(state.element_loads.sum()))


def _step(
    rows: tuple[RowOfElements, ...],
    place: FloatArray,
    state: _Balance,
    residual: FloatArray,
    target: FloatArray,
    active: NDArray[np.bool_],
) -> tuple[FloatArray, _Balance]:
    tangent = state.tangent + 1e-9 * max(float(np.trace(state.tangent)), 1.0) * np.eye(2)
    step = np.zeros(2)
    chosen = np.ix_(active, active)
    step[active] = np.linalg.solve(tangent[chosen], residual[active])
    longest = 0.02 * rows[0].elements.diameter
    share = min(1.0, longest / max(float(np.max(np.abs(step))), 1e-30))
    value = state.energy - float(target @ place)
    descent = float(residual @ step)
    rounding = 1e-13 * (state.energy + abs(float(target @ place)))
    for _ in range(30):
        trial = place + share * step
        there = _balance(rows, *trial)
        left = np.where(active, target - there.force, 0.0)
        # the energy of light loads is lost in its round-off before their forces are
        if there.energy - float(target @ trial) <= value - 1e-4 * share * descent + rounding or (
            float(np.linalg.norm(left)) <= 0.5 * float(np.linalg.norm(residual))
        ):
            break
        share *= 0.5
    return trial, there


def _start(row: RowOfElements, radial: float, axial: float, free_axially: bool) -> FloatArray:
    """Displacements at which the most loaded elements carry about the load."""
    law, count = row.law, row.elements.count
    angle = row.elements.contact_angle
    needed = (max(5.0 * radial / (count * math.cos(angle)), 0.0) / law.stiffness) ** (1.0 / law.exponent)
    start = 0.5 * max(row.clearance, 0.0) + needed if radial > 0.0 else 0.0
    along = 0.0
    if free_axially and axial > 0.0:
        sine = max(math.sin(angle), 0.2)
        along = (axial / (count * sine) / law.stiffness) ** (1.0 / law.exponent) / sine
        if angle == 0.0 and law.groove_distance > 0.0:
            gap = max(row.clearance, 0.0)
            along += math.sqrt(max(gap * law.groove_distance, 0.0))
    return np.array([start, along])


def _angled(rows: tuple[RowOfElements, ...]) -> bool:
    return len(rows) == 1 and rows[0].elements.contact_angle > 0.0


def _result(
    rows: tuple[RowOfElements, ...], state: _Balance, place: FloatArray, *, held: bool
) -> BearingStiffness:
    tilted = ring_load(rows, np.array([place[0], 0.0, place[1], 0.0, 0.0])).stiffness
    return BearingStiffness(
        radial_displacement=float(place[0]),
        axial_displacement=float(place[1]),
        radial=float(state.tangent[0, 0]),
        axial=float(state.tangent[1, 1]),
        lateral=state.lateral,
        coupling=float(state.tangent[0, 1]),
        tilting=float(tilted[4, 4]),
        tilting_lateral=float(tilted[3, 3]),
        radial_load=float(state.force[0]),
        axial_load=max(float(state.force[1]), 0.0),
        largest_element_load=float(np.max(state.element_loads)),
        loaded_elements=int(np.count_nonzero(state.element_loads > 0.0)),
        held_axially=held,
    )


# Axial forces of two angular contact or tapered roller bearings that are set against each other.
#
# A radial load on a bearing with a contact angle induces an axial force, which only its partner can take up. The shaft
# is in balance: the axial forces of both bearings differ by the external force. Of all pairs of forces that do, the
# smallest counts that gives either bearing at least what its own radial load induces,
#
#     F_aA = max(F_iA, F_iB + K_a) ,  F_aB = max(F_iB, F_iA - K_a) ,  F_aA - F_aB = K_a
#
# with K_a positive where it presses A. These are the six load cases of the catalogues in one (SKF General Catalogue
# 6000, tables on single row angular contact and tapered roller bearings), for bearings set to no play without preload.
# A bearing that induces nothing but holds the shaft axially (deep groove ball bearing, thrust face) is a partner with
# F_i = 0.

Arrangement = Literal["back_to_back", "face_to_face"]
"""Back to back (O): pressure lines meet the axis outside of the pair; face to face (X): between the bearings."""


def pair_axial_loads(induced: tuple[float, float], external: float) -> tuple[float, float]:
    """Axial forces [N] inside bearings A and B of a shaft.

    induced : by the radial loads of A and B, not negative [N]
    external : axial force on the shaft [N], positive where it presses A, negative where it presses B
    """
    first, second = induced
    return max(first, second + external), max(second, first - external)


def force_on_first(arrangement: Arrangement, force: float) -> float:
    """External force as `pair_axial_loads` counts it [N], A the bearing at the lower end of the axis.

    force : on the shaft along the axis from A to B [N]

    Back to back the shaft pulls the inner ring of A against its outer ring, face to face it pushes that of B.
    """
    return force if arrangement == "back_to_back" else -force
