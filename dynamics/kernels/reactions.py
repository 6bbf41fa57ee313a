"""What gear meshes answer at given states: totals with tangents, and forces of single tooth pairs."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    BACKLASH,
    BODY,
    CLOSING,
    DAMP_TIME,
    DERIVATIVE,
    INDIVIDUAL,
    JAMMED,
    LEAST_GAP,
    LOOSE,
    MOST,
    MU_1,
    MU_2,
    N_PHASE,
    PER_DEPTH,
    PER_REVERSAL,
    POSITIVE,
    R1,
    R2,
    ROW_E,
    ROW_K,
    VECTOR,
    Flank,
    PackedMeshes,
    Pressing,
    contact_at,
    curvatures_at,
    flank_powers,
    inlined,
    press_flank,
    sliding_direction,
)
from dynamics.kernels.flank_contacts import (
    ContactState,
    ContactTable,
    flank_in_phase,
    flank_on_path,
    list_on_path,
)

Array = NDArray[np.float64]


Integers = NDArray[np.int64]


class MeshStates(NamedTuple):
    """States at which a mesh is evaluated."""

    theta_1: Array
    """(n,) rotation of the pinion [rad]."""
    reach: Array
    """(n,) approach, offset of the law included [m]."""
    omega_1: Array
    """(n,) speeds of pinion and wheel [rad/s]."""
    omega_2: Array


@inlined
def _path_slopes(
    table: Array, flank: Flank, law: Array, pressing: Pressing
) -> tuple[float, float, float, float, float]:
    """Return (da_1/ds, da_2/ds, dP/ds, elastic energy) of one flank at fixed reach, rate and speeds, and what of a_1 is
    friction."""
    sign, reach, rate, omega_1 = pressing.sign, pressing.reach, pressing.rate, pressing.omega_1
    slope_1, slope_2, slope, energy, rubbed = 0.0, 0.0, 0.0, 0.0, 0.0
    f = flank.place
    damp_time, per_depth, derivative = law[DAMP_TIME], law[PER_DEPTH], law[DERIVATIVE]
    path_speed = law[CLOSING] * sign * law[R1] * omega_1
    rotation = (1.0 - law[CLOSING]) * derivative
    mu_1, mu_2 = sign * law[MU_1], sign * law[MU_2]
    slip_slope = (flank.omega_1 + flank.omega_2) * law[PER_REVERSAL]
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    for i in range(flank.n):
        s, k, stiffness_slope, gap, gap_slope = contact_at(table, first + i, stride, f)
        stiffness_curvature, gap_curvature = curvatures_at(table, first + i, stride, f)
        depth = reach - gap
        depth = depth if depth > 0.0 else 0.0
        k = k if depth > 0.0 else 0.0
        gap_slope *= flank.per_metre
        gap_curvature *= flank.per_metre * flank.per_metre
        stiffness_slope *= flank.per_metre * derivative
        stiffness_curvature *= flank.per_metre * flank.per_metre * derivative
        rho_1, rho_2 = flank.roll_1 + s, flank.roll_2 - s
        ratio = (flank.omega_1 * rho_1 - flank.omega_2 * rho_2) * law[PER_REVERSAL]
        direction = sliding_direction(ratio)
        direction_slope = 1.5 * (1.0 - ratio * ratio) * slip_slope if abs(ratio) < 1.0 else 0.0
        m_1 = 1.0 - gap_slope * derivative + mu_1 * direction * rho_1
        m_2 = 1.0 + mu_2 * direction * rho_2
        m_1_s = mu_1 * (direction + direction_slope * rho_1) - gap_curvature * derivative
        m_2_s = mu_2 * (direction_slope * rho_2 - direction)
        closing = damp_time * (rate - gap_slope * path_speed)
        grown = depth * per_depth
        grown_slope = per_depth if grown < 1.0 else 0.0
        grown = grown if grown < 1.0 else 1.0
        pressed = depth + grown * closing
        touches = depth > 0.0 and pressed > 0.0
        force = k * pressed if touches else 0.0
        df = stiffness_slope * pressed - k * gap_slope * (1.0 + grown_slope * closing)
        df -= k * grown * damp_time * gap_curvature * path_speed
        df = df if touches else 0.0
        energy += 0.5 * k * depth * depth
        rubbed += force * mu_1 * direction * rho_1
        de = stiffness_slope * depth - k * gap_slope
        damped, damped_s = force - k * depth, df - de
        bent = (0.5 * stiffness_curvature * depth - stiffness_slope * gap_slope) * depth
        slope_1 += (
            df * m_1 + force * m_1_s + rotation * (damped_s * gap_slope + damped * gap_curvature) + bent
        )
        slope_2 += df * m_2 + force * m_2_s
        slope += de
    return slope_1, slope_2, slope, energy, rubbed


class MeshState(NamedTuple):
    """One of them."""

    theta_1: float
    reach: float
    omega_1: float
    omega_2: float


@inlined
def _listed_flank(
    meshes: PackedMeshes, state: MeshState, side: int, contacts: Array, pairs: Integers
) -> Flank:
    """List the contacts of a flank of the first mesh in its half of ``contacts``."""
    law, stride = meshes.values[0], meshes.counts[0, MOST]
    table = ContactTable(contacts, side * N_PHASE * stride, stride, pairs)
    found = list_on_path(law, 0, meshes, 0, 1.0 - 2.0 * side, state.theta_1, table)
    return flank_on_path(law, 0, table, found, state.omega_1, state.omega_2)


@inlined
def _flank_at(meshes: PackedMeshes, state: MeshState, side: int, contacts: Array, pairs: Integers) -> Flank:
    """Return the contacts of a flank of the first mesh; those of individual teeth are listed in ``contacts``."""
    law, counts, sign = meshes.values[0], meshes.counts, 1.0 - 2.0 * side
    within = sign * state.reach - side * law[BACKLASH] + law[JAMMED]
    flank = no_contacts()
    if within > law[LEAST_GAP]:
        if counts[0, INDIVIDUAL] == 0:
            chosen = ContactState(sign, within, state.theta_1, state.omega_1, state.omega_2)
            flank = flank_in_phase(law, 0, meshes, 0, chosen)
        else:
            flank = _listed_flank(meshes, state, side, contacts, pairs)
    return flank


def mesh_reactions(meshes: PackedMeshes, states: MeshStates, out: Array) -> None:
    """Evaluate the first mesh at many states; ``out`` (n, 17) in the order of ``MeshReaction``."""
    contacts = np.zeros(2 * int(meshes.counts[0, MOST]) * N_PHASE)
    _mesh_reactions(meshes, states, contacts, np.empty((2, 0), np.int64), out)


@inlined
def _add_flank(table: Array, flank: Flank, law: Array, side: int, pressing: Pressing, out: Array) -> float:
    """Add what one flank of the first mesh answers to the row ``out`` (17,); return its elastic force per path."""
    sign = pressing.sign
    r_1, r_2 = law[R1], law[R2]
    sums = press_flank(table, flank, law, 0, pressing, 0.0)
    friction_power, damping_power, _ = flank_powers(table, flank, law, 0, pressing)
    slope_1, slope_2, slope, energy, rubbed = _path_slopes(table, flank, law, pressing)
    out[0] -= sign * r_1 * sums.a_1
    out[1] += sign * r_2 * sums.a_2
    out[2 + side] += sums.force
    out[4] -= r_1 * sums.a_1_x
    out[5] += r_2 * sums.a_2_x
    out[6] -= r_1 * sums.a_1_v
    out[7] += r_2 * sums.a_2_v
    out[8] -= r_1 * r_1 * slope_1
    out[9] += r_1 * r_2 * slope_2
    out[10] += friction_power
    out[11] += damping_power
    out[12] += energy
    out[14] -= sign * r_1 * (sums.a_1 - sums.force - rubbed)
    out[15] += sums.force_x
    out[16] += sums.force_v
    return slope


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _mesh_reactions(
    meshes: PackedMeshes, states: MeshStates, contacts: Array, no_pairs: Integers, out: Array
) -> None:
    """Do what ``mesh_reactions`` says, ``contacts`` being room for the tables of both flanks."""
    theta_1, reach, omega_1, omega_2 = states.theta_1, states.reach, states.omega_1, states.omega_2
    law, counts = meshes.values[0], meshes.counts
    individual = counts[0, INDIVIDUAL] != 0
    table = contacts if individual else meshes.phase_data
    in_front, behind = int(np.int64(0)), int(np.int64(1))  # constants would compile the flanks twice
    for n in range(theta_1.shape[0]):
        out[n] = 0.0
        one = MeshState(theta_1[n], reach[n], omega_1[n], omega_2[n])
        front = _flank_at(meshes, one, in_front, contacts, no_pairs)
        back = _flank_at(meshes, one, behind, contacts, no_pairs)
        teeth, share = reach[n], 1.0
        if law[BODY] > 0.0:
            teeth, share = tooth_approach(table, Flanks(front, back), law, 0, teeth, teeth)
        rate = law[R1] * omega_1[n] - law[R2] * omega_2[n]
        per_path = 0.0
        if front.n:
            per_path += _add_flank(
                table, front, law, in_front, Pressing(1.0, teeth, rate, omega_1[n]), out[n]
            )
        if back.n:
            pressing = Pressing(-1.0, -teeth - law[BACKLASH], -rate, omega_1[n])
            per_path += _add_flank(table, back, law, behind, pressing, out[n])
        # at a fixed approach of the gears the path turns the body as well
        turned = -law[BODY] * share * law[R1] * per_path
        out[n, 8] += out[n, 4] * turned
        out[n, 9] += out[n, 5] * turned
        out[n, 4] *= share
        out[n, 5] *= share
        out[n, 15] *= share
        if law[BODY] > 0.0:
            out[n, 12] += 0.5 * (reach[n] - teeth) ** 2 / law[BODY]
        out[n, 13] = teeth


@njit(cache=True, fastmath=LOOSE)
def tooth_pair_forces(meshes: PackedMeshes, states: MeshStates, lowest: Integers, force: Array) -> None:
    """Fill ``force`` (n, n_pairs, n_slices, 2), front and back; ``lowest`` (n,) is the pair of column 0."""
    theta_1, reach, omega_1, omega_2 = states.theta_1, states.reach, states.omega_1, states.omega_2
    law, counts = meshes.values[0], meshes.counts
    stride = counts[0, MOST]
    contacts = np.empty(2 * stride * N_PHASE)
    pairs = np.empty((2, stride), np.int64)
    for n in range(theta_1.shape[0]):
        teeth = reach[n]
        if law[BODY] > 0.0:
            one = MeshState(theta_1[n], reach[n], omega_1[n], omega_2[n])
            front = _listed_flank(meshes, one, 0, contacts, pairs)
            back = _listed_flank(meshes, one, 1, contacts, pairs)
            teeth = tooth_approach(contacts, Flanks(front, back), law, 0, teeth, teeth).approach
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * teeth - side * law[BACKLASH]
            if pressed <= law[LEAST_GAP]:
                continue
            table = ContactTable(contacts, 0, stride, pairs)
            found = list_on_path(law, 0, meshes, 0, sign, theta_1[n], table)
            path_speed = law[CLOSING] * sign * law[R1] * omega_1[n]
            rate = sign * (law[R1] * omega_1[n] - law[R2] * omega_2[n])
            for i in range(found):
                depth = pressed - contacts[ROW_E * stride + i]
                closing = rate - contacts[(ROW_E + 1) * stride + i] * path_speed
                grown = min(max(depth, 0.0) * law[PER_DEPTH], 1.0)
                f = contacts[ROW_K * stride + i] * (depth + law[DAMP_TIME] * grown * closing)
                column = pairs[0, i] - lowest[n]
                if depth > 0.0 and f > 0.0 and 0 <= column < force.shape[1]:
                    force[n, column, pairs[1, i], side] = f


# Approach of the teeth behind the compliance of the gear bodies that all pairs of a mesh share.
#
# With the elastic force ``P = sum k d`` of the front less that of the back flank, the teeth see the approach
#
#     y = x - c_b P(y)
#
# ``P`` grows with ``y`` in straight pieces: for a given set of closed contacts
# ``y = (x + c_b sum k g) / (1 + c_b sum k)``, and the set is found by stepping from piece to piece (Newton, kept within
# the bounds found so far, which two flanks pressed at once may need). It ends when a step leaves the set as it is: then
# ``y`` is exact.

MOST_SETS = 64
"""Sets of closed contacts that are tried; four are many."""


class Flanks(NamedTuple):
    """Contacts of both flanks of a mesh in one table; none of a flank that cannot touch."""

    front: Flank
    back: Flank


class ToothApproach(NamedTuple):
    """What the teeth see of an approach of the gears."""

    approach: float
    """Approach behind the body [m]."""
    share: float
    """Its derivative over the approach of the gears: the share that the teeth take [-]."""


@inlined
def no_contacts() -> Flank:
    """Return a flank that cannot touch."""
    return Flank(0, 1, 0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def _contact(table: Array, c: int, stride: int, f: float, reach: float) -> tuple[float, float]:
    """Return stiffness and elastic force of the contact in column ``c``, none where it is open."""
    k_1, k_2, k_3 = table[c + stride], table[c + 2 * stride], table[c + 3 * stride]
    e_1, e_2, e_3 = table[c + 5 * stride], table[c + 6 * stride], table[c + 7 * stride]
    depth = reach - (table[c + ROW_E * stride] + f * (e_1 + f * (e_2 + f * e_3)))
    k = table[c] + f * (k_1 + f * (k_2 + f * k_3))
    k = k if depth > 0.0 else 0.0
    return k, k * depth


@inlined
def _carried(table: Array, flank: Flank, reach: float) -> tuple[float, float]:
    """Return stiffness and elastic force of the closed contacts of a flank."""
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    stiffness, force = 0.0, 0.0
    if flank.n == 1:
        stiffness, force = _contact(table, first, stride, flank.place, reach)
    else:
        for i in range(flank.n // VECTOR * VECTOR):
            k, more = _contact(table, first + i, stride, flank.place, reach)
            stiffness += k
            force += more
    return stiffness, force


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def tooth_approach(
    table: Array, flanks: Flanks, space: Array, at: int, approach: float, start: float
) -> ToothApproach:
    """Return what the teeth of a mesh see of an approach of the gears [m].

    ``space`` holds the numbers of the law, the columns of ``PackedMeshes.values``, from ``at`` on; ``start`` is a
    guess, best the answer at a state nearby.
    """
    body, backlash = space[at + BODY], space[at + BACKLASH]
    y, lowest, highest = start, -np.inf, np.inf
    before, share = -1.0, 1.0
    for _ in range(MOST_SETS):
        stiffness, force = _carried(table, flanks.front, y)
        on_back, pushed_back = _carried(table, flanks.back, -y - backlash)
        stiffness += on_back
        force -= pushed_back
        off = y + body * force - approach
        share = 1.0 / (1.0 + body * stiffness)
        if off > 0.0:
            highest = y
        else:
            lowest = y
        y -= off * share
        if stiffness == before:
            break
        before = stiffness
        if not lowest <= y <= highest:
            y = 0.5 * (lowest + highest)
            before = -1.0
    return ToothApproach(y, share)
