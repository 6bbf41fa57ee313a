"""What gear meshes answer at given states: totals with tangents, and forces of single tooth pairs."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    BACKLASH,
    DAMP_TIME,
    GROUPS,
    LANES,
    LEAST_GAP,
    LIST_DE,
    LIST_E,
    LIST_HK,
    LIST_K,
    LIST_M1,
    LIST_M2,
    LOOSE,
    N_LIST,
    PER_DEPTH,
    R1,
    R2,
    PackedMeshes,
    flank_powers,
    list_flank,
    list_on_path,
    press_flank,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@njit(cache=True, fastmath=LOOSE, inline="always")
def _path_slopes(
    contacts: Array,
    n: int,
    reach: float,
    rate: float,
    path_speed: float,
    damp_time: float,
    per_depth: float,
) -> tuple[float, float, float]:
    """Return (da_1/ds, da_2/ds, elastic energy) of one flank at fixed reach, rate and friction levers."""
    slope_1 = 0.0
    slope_2 = 0.0
    energy = 0.0
    for group in range((n + LANES - 1) // LANES):
        at = N_LIST * LANES * group
        for i in range(min(n - LANES * group, LANES)):
            depth = reach - contacts[at + LIST_E * LANES + i]
            depth = depth if depth > 0.0 else 0.0
            k = contacts[at + LIST_K * LANES + i]
            k = k if depth > 0.0 else 0.0
            gap_slope = contacts[at + LIST_DE * LANES + i]
            stiffness_slope = 2.0 * contacts[at + LIST_HK * LANES + i]
            closing = damp_time * (rate - gap_slope * path_speed)
            grown = depth * per_depth
            grown_slope = per_depth if grown < 1.0 else 0.0
            grown = grown if grown < 1.0 else 1.0
            pressed = depth + grown * closing
            df = stiffness_slope * pressed - k * gap_slope * (1.0 + grown_slope * closing)
            df = df if (depth > 0.0 and pressed > 0.0) else 0.0
            energy += 0.5 * k * depth * depth
            slope_1 += df * contacts[at + LIST_M1 * LANES + i] - stiffness_slope * depth * gap_slope
            slope_2 += df * contacts[at + LIST_M2 * LANES + i]
    return slope_1, slope_2, energy


def mesh_reactions(
    meshes: PackedMeshes, theta_1: Array, reach: Array, omega_1: Array, omega_2: Array, out: Array
) -> None:
    """Evaluate the first mesh at many states; ``out`` (n, 13) in the order of ``MeshReaction``.

    ``reach`` (n,) is the approach including the offset of the law.
    """
    contacts = np.zeros(int(meshes.counts[0, GROUPS]) * N_LIST * LANES)
    _mesh_reactions(meshes, theta_1, reach, omega_1, omega_2, contacts, np.empty((2, 0), np.int64), out)


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _mesh_reactions(
    meshes: PackedMeshes, theta_1: Array, reach: Array, omega_1: Array, omega_2: Array, contacts: Array,
    no_pairs: Integers, out: Array,
) -> None:  # fmt: skip
    values, counts = meshes.values, meshes.counts
    cells, shifts, deviations, scales = meshes.cells, meshes.shifts, meshes.deviations, meshes.scales
    starts, contacts_in = meshes.phase_starts, meshes.phase_counts
    least, data = meshes.phase_least, meshes.phase_data
    r_1 = values[0, R1]
    r_2 = values[0, R2]
    damp_time, per_depth = values[0, DAMP_TIME], values[0, PER_DEPTH]
    for n in range(theta_1.shape[0]):
        w_1 = omega_1[n]
        w_2 = omega_2[n]
        for column in range(out.shape[1]):
            out[n, column] = 0.0
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * reach[n] - side * values[0, BACKLASH]
            if pressed <= values[0, LEAST_GAP]:
                continue
            found = list_flank(
                values, counts, starts, contacts_in, least, data, cells, shifts, deviations, scales, 0, sign,
                pressed, theta_1[n], w_1, w_2, contacts, 0, no_pairs,
            )  # fmt: skip
            rate = sign * (r_1 * w_1 - r_2 * w_2)
            path_speed = sign * r_1 * w_1
            sums = press_flank(contacts, 0, found, pressed, rate, path_speed, damp_time, per_depth, 0.0)
            friction_power, damping_power, _ = flank_powers(
                contacts, 0, found, pressed, rate, path_speed, damp_time, per_depth
            )
            slope_1, slope_2, energy = _path_slopes(
                contacts, found, pressed, rate, path_speed, damp_time, per_depth
            )
            out[n, 0] -= sign * r_1 * sums.a_1
            out[n, 1] += sign * r_2 * sums.a_2
            out[n, 2 + side] += sums.force
            out[n, 4] -= r_1 * sums.a_1_x
            out[n, 5] += r_2 * sums.a_2_x
            out[n, 6] -= r_1 * sums.a_1_v
            out[n, 7] += r_2 * sums.a_2_v
            out[n, 8] -= r_1 * r_1 * slope_1
            out[n, 9] += r_1 * r_2 * slope_2
            out[n, 10] += friction_power
            out[n, 11] += damping_power
            out[n, 12] += energy


@njit(cache=True, fastmath=LOOSE)
def tooth_pair_forces(
    meshes: PackedMeshes,
    theta_1: Array,
    reach: Array,
    omega_1: Array,
    omega_2: Array,
    lowest: Integers,
    force: Array,
) -> None:
    """Fill ``force`` (n, n_pairs, n_slices, 2), front and back; ``lowest`` (n,) is the pair of column 0."""
    values, counts = meshes.values, meshes.counts
    cells, shifts, deviations, scales = meshes.cells, meshes.shifts, meshes.deviations, meshes.scales
    contacts = np.empty(counts[0, GROUPS] * N_LIST * LANES)
    pairs = np.empty((2, counts[0, GROUPS] * LANES), np.int64)
    for n in range(theta_1.shape[0]):
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * reach[n] - side * values[0, BACKLASH]
            if pressed <= values[0, LEAST_GAP]:
                continue
            found = list_on_path(
                values, counts, cells, shifts, deviations, scales, 0, sign, theta_1[n], omega_1[n], omega_2[n],
                contacts, 0, pairs,
            )  # fmt: skip
            path_speed = sign * values[0, R1] * omega_1[n]
            rate = sign * (values[0, R1] * omega_1[n] - values[0, R2] * omega_2[n])
            for i in range(found):
                at = (i // LANES) * N_LIST * LANES + i % LANES
                depth = pressed - contacts[at + LIST_E * LANES]
                closing = rate - contacts[at + LIST_DE * LANES] * path_speed
                grown = min(max(depth, 0.0) * values[0, PER_DEPTH], 1.0)
                f = contacts[at + LIST_K * LANES] * (depth + values[0, DAMP_TIME] * grown * closing)
                column = pairs[0, i] - lowest[n]
                if depth > 0.0 and f > 0.0 and 0 <= column < force.shape[1]:
                    force[n, column, pairs[1, i], side] = f
