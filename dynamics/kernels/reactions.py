"""What gear meshes answer at given states: totals with tangents, and forces of single tooth pairs."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    LOOSE,
    Flank,
    Pressing,
    contact_at,
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
from dynamics.kernels.mesh_tables import (
    BACKLASH,
    CLOSING,
    DAMP_TIME,
    DERIVATIVE,
    INDIVIDUAL,
    LEAST_GAP,
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
    PackedMeshes,
)

# compiled from sources c4c1687b
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
def _path_slopes(table: Array, flank: Flank, law: Array, pressing: Pressing) -> tuple[float, float, float]:
    """Return (da_1/ds, da_2/ds, elastic energy) of one flank at fixed reach, rate and friction levers."""
    sign, reach, rate, omega_1 = pressing.sign, pressing.reach, pressing.rate, pressing.omega_1
    slope_1, slope_2, energy = 0.0, 0.0, 0.0
    f = flank.place
    damp_time, per_depth = law[DAMP_TIME], law[PER_DEPTH]
    path_speed = law[CLOSING] * sign * law[R1] * omega_1
    rotation = (1.0 - law[CLOSING]) * law[DERIVATIVE]
    mu_1, mu_2 = sign * law[MU_1], sign * law[MU_2]
    first, stride = flank.first & POSITIVE, flank.stride & POSITIVE
    for i in range(flank.n):
        s, k, stiffness_slope, gap, gap_slope = contact_at(table, first + i, stride, f)
        depth = reach - gap
        depth = depth if depth > 0.0 else 0.0
        k = k if depth > 0.0 else 0.0
        gap_slope *= flank.per_metre
        stiffness_slope *= flank.per_metre
        stiffness_slope *= law[DERIVATIVE]
        rho_1, rho_2 = flank.roll_1 + s, flank.roll_2 - s
        sliding = flank.omega_1 * rho_1 - flank.omega_2 * rho_2
        direction = sliding_direction(sliding * law[PER_REVERSAL])
        m_1 = 1.0 - gap_slope * law[DERIVATIVE] + mu_1 * direction * rho_1
        m_2 = 1.0 + mu_2 * direction * rho_2
        closing = damp_time * (rate - gap_slope * path_speed)
        grown = depth * per_depth
        grown_slope = per_depth if grown < 1.0 else 0.0
        grown = grown if grown < 1.0 else 1.0
        pressed = depth + grown * closing
        df = stiffness_slope * pressed - k * gap_slope * (1.0 + grown_slope * closing)
        df = df if (depth > 0.0 and pressed > 0.0) else 0.0
        energy += 0.5 * k * depth * depth
        de = stiffness_slope * depth - k * gap_slope
        slope_1 += df * m_1 + (df - de) * rotation * gap_slope - stiffness_slope * depth * gap_slope
        slope_2 += df * m_2
    return slope_1, slope_2, energy


def mesh_reactions(meshes: PackedMeshes, states: MeshStates, out: Array) -> None:
    """Evaluate the first mesh at many states; ``out`` (n, 13) in the order of ``MeshReaction``."""
    contacts = np.zeros(int(meshes.counts[0, MOST]) * N_PHASE)
    _mesh_reactions(meshes, states, contacts, np.empty((2, 0), np.int64), out)


@inlined
def _add_flank(table: Array, flank: Flank, law: Array, side: int, pressing: Pressing, out: Array) -> None:
    """Add what one flank of the first mesh answers to the row ``out`` (13,)."""
    sign = pressing.sign
    r_1, r_2 = law[R1], law[R2]
    sums = press_flank(table, flank, law, 0, pressing, 0.0)
    friction_power, damping_power, _ = flank_powers(table, flank, law, 0, pressing)
    slope_1, slope_2, energy = _path_slopes(table, flank, law, pressing)
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


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _mesh_reactions(
    meshes: PackedMeshes, states: MeshStates, contacts: Array, no_pairs: Integers, out: Array
) -> None:
    """Do what ``mesh_reactions`` says, ``contacts`` being room for a table."""
    theta_1, reach, omega_1, omega_2 = states.theta_1, states.reach, states.omega_1, states.omega_2
    law, counts = meshes.values[0], meshes.counts
    stride = counts[0, MOST]
    for n in range(theta_1.shape[0]):
        out[n] = 0.0
        for side in range(2):
            sign = 1.0 - 2.0 * side
            within = sign * reach[n] - side * law[BACKLASH]
            if within <= law[LEAST_GAP]:
                continue
            rate = sign * (law[R1] * omega_1[n] - law[R2] * omega_2[n])
            pressing = Pressing(sign, within, rate, omega_1[n])
            if counts[0, INDIVIDUAL] == 0:
                state = ContactState(sign, within, theta_1[n], omega_1[n], omega_2[n])
                alike = flank_in_phase(law, 0, meshes, 0, state)
                _add_flank(meshes.phase_data, alike, law, side, pressing, out[n])
            else:
                table = ContactTable(contacts, 0, stride, no_pairs)
                found = list_on_path(law, 0, meshes, 0, sign, theta_1[n], table)
                single = flank_on_path(law, 0, table, found, omega_1[n], omega_2[n])
                _add_flank(contacts, single, law, side, pressing, out[n])


@njit(cache=True, fastmath=LOOSE)
def tooth_pair_forces(meshes: PackedMeshes, states: MeshStates, lowest: Integers, force: Array) -> None:
    """Fill ``force`` (n, n_pairs, n_slices, 2), front and back; ``lowest`` (n,) is the pair of column 0."""
    theta_1, reach, omega_1, omega_2 = states.theta_1, states.reach, states.omega_1, states.omega_2
    law, counts = meshes.values[0], meshes.counts
    stride = counts[0, MOST]
    contacts = np.empty(stride * N_PHASE)
    pairs = np.empty((2, stride), np.int64)
    for n in range(theta_1.shape[0]):
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * reach[n] - side * law[BACKLASH]
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
