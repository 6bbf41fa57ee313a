"""Contact of one gear mesh, flank by flank, on the packed tables of ``dynamics.mesh_force.PackedMeshes``.

With ``sign`` +1 in front and -1 on the back, ``play`` 0 in front and the backlash
behind, the penetration is ``d = sign x - play - e(s)`` and the path position moves with
``ds/dt = sign r_b1 omega_1``. From the potential ``k(s) d^2 / 2``

    tau_1 = -sign r_b1 [ F (1 - e') + k' d^2 / 2 ],   tau_2 = sign r_b2 F,   F = max(0, k d + c (d/dt) d)

and friction adds ``-mu F g rho_1`` and ``+mu F g rho_2`` with the direction ``g`` of the sliding speed
``v_g = omega_1 rho_1 - omega_2 rho_2``, ``rho_1 = T1C + s``, ``rho_2 = T2C - s``.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# columns of PackedMeshes.values
R1, R2, PITCH, PHASE, BACK_PHASE, BACKLASH, START, PER_STEP = 0, 1, 2, 3, 4, 5, 6, 7
DAMP_TIME, FRICTION, ROLL_1, ROLL_2, PER_REVERSAL, LEAST_GAP, DERIVATIVE = 8, 9, 10, 11, 12, 13, 14
N_VALUES = 15
# columns of PackedMeshes.counts
N_SLICES, N_CELLS, CELLS_AT, SHIFTS_AT, INDIVIDUAL, TEETH_1, TEETH_2, OFFSET_2 = 0, 1, 2, 3, 4, 5, 6, 7
ROWS_1, DEVIATION_1_AT, ROWS_2, DEVIATION_2_AT = 8, 9, 10, 11
SCALES_1, SCALES_1_AT, SCALES_2, SCALES_2_AT, CAPACITY = 12, 13, 14, 15, 16
N_COUNTS = 17
# rows of the contact list: stiffness, gap, gap slope, lever factors, half stiffness slope, friction power
LIST_K, LIST_E, LIST_DE, LIST_M1, LIST_M2, LIST_HK, LIST_POWER = 0, 1, 2, 3, 4, 5, 6
N_LIST = 7

Tables = tuple[Array, Array, Array, Array]
"""``cells``, ``shifts``, ``deviations``, ``scales`` of ``PackedMeshes``."""

# NaN and infinity keep their meaning; only the order of sums is free
LOOSE = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=LOOSE, inline="always")
def sliding_direction(ratio: float) -> float:
    """Return the smooth sign of ``ratio``: a cubic inside +-1, exactly +-1 outside."""
    if ratio >= 1.0:
        return 1.0
    if ratio <= -1.0:
        return -1.0
    return ratio * (1.5 - 0.5 * ratio * ratio)


@njit(cache=True, fastmath=LOOSE)
def list_contacts(
    values: Array,
    counts: Integers,
    tables: Tables,
    sign: float,
    theta_1: float,
    omega_1: float,
    omega_2: float,
    at: int,
    out: Array,
    pairs: Integers,
) -> int:
    """Write what every (pair, slice) on the path of one flank offers at the angle ``theta_1`` into ``out``.

    ``values``, ``counts``: one row of the packed tables; ``out``: (N_LIST, capacity) list that is filled from
    column ``at``; ``pairs``: (2, capacity) pair and slice of each entry, or of zero length if unwanted.
    Returns the column after the last entry.
    """
    cells, shifts, deviations, scales = tables
    n_slices = counts[N_SLICES]
    n_cells = counts[N_CELLS]
    individual = counts[INDIVIDUAL]
    per_step = values[PER_STEP]
    r_1 = values[R1]
    friction = values[FRICTION]
    derivative = values[DERIVATIVE]
    pitch = values[PITCH] * per_step
    per_pitch = 1.0 / pitch
    step = 1.0 / per_step
    travel = (values[PHASE] if sign > 0.0 else values[BACK_PHASE]) + sign * r_1 * theta_1 - values[START]
    mu_1 = sign * friction / r_1
    mu_2 = sign * friction / values[R2]
    column = at
    error = np.empty(4)
    for i in range(n_slices):
        whole = (travel - sign * shifts[counts[SHIFTS_AT] + i]) * per_step
        turn = math.floor(whole * per_pitch)
        place = whole - turn * pitch
        row = counts[CELLS_AT] + i * n_cells
        while place < n_cells:
            j = min(max(int(place), 0), n_cells - 1)
            f = place - j
            cell = cells[row + j]
            k = cell[0] + f * (cell[1] + f * (cell[2] + f * cell[3]))
            dk = cell[1] + f * (2.0 * cell[2] + 3.0 * f * cell[3])
            e = cell[4] + f * (cell[5] + f * (cell[6] + f * cell[7]))
            de = cell[5] + f * (2.0 * cell[6] + 3.0 * f * cell[7])
            pair = int(turn) if sign > 0.0 else -int(turn)
            if individual != 0:
                row_1 = counts[DEVIATION_1_AT] + (pair % counts[ROWS_1]) * n_cells + j
                row_2 = counts[DEVIATION_2_AT] + ((pair + counts[OFFSET_2]) % counts[ROWS_2]) * n_cells + j
                for part in range(4):
                    error[part] = deviations[row_1, part] + deviations[row_2, part]
                e += error[0] + f * (error[1] + f * (error[2] + f * error[3]))
                de += error[1] + f * (2.0 * error[2] + 3.0 * f * error[3])
                scale = scales[counts[SCALES_1_AT] + pair % counts[SCALES_1]]
                scale *= scales[counts[SCALES_2_AT] + (pair + counts[OFFSET_2]) % counts[SCALES_2]]
                k *= scale
                dk *= scale
            out[LIST_K, column] = k
            out[LIST_E, column] = e
            out[LIST_DE, column] = de * per_step
            out[LIST_HK, column] = 0.5 * dk * per_step * derivative
            lever_1 = 1.0 - de * per_step * derivative
            if friction != 0.0:
                s = values[START] + place * step
                rho_1 = values[ROLL_1] + s
                rho_2 = values[ROLL_2] - s
                sliding = omega_1 * rho_1 - omega_2 * rho_2
                direction = sliding_direction(sliding * values[PER_REVERSAL])
                out[LIST_M1, column] = lever_1 + mu_1 * direction * rho_1
                out[LIST_M2, column] = 1.0 + mu_2 * direction * rho_2
                out[LIST_POWER, column] = friction * direction * sliding
            else:
                out[LIST_M1, column] = lever_1
                out[LIST_M2, column] = 1.0
                out[LIST_POWER, column] = 0.0
            if pairs.shape[1] > 0:
                pairs[0, column] = pair
                pairs[1, column] = i
            column += 1
            turn -= 1.0
            place += pitch
    return column


@njit(cache=True, fastmath=LOOSE)
def sum_flank(
    contacts: Array,
    first: int,
    last: int,
    reach: float,
    rate: float,
    path_speed: float,
    damp_time: float,
) -> tuple[float, float, float, float, float, float, float, float]:
    """Sum the contacts ``first`` to ``last`` of one flank pressed by ``reach`` and closing with ``rate``.

    ``damp_time`` = damping / mean stiffness [s]. Returns (force, a_1, a_2, k_1, k_2, k_d, friction power,
    damping power): ``a_1 = sum F m_1 + k' d^2 / 2``, ``a_2 = sum F m_2`` are the torques per base radius,
    ``k_1 = sum k m_1``, ``k_2 = sum k m_2`` their slopes over ``reach``; ``a_1`` has ``k_d = sum k' d`` more.
    """
    force = 0.0
    a_1 = 0.0
    a_2 = 0.0
    k_1 = 0.0
    k_2 = 0.0
    k_d = 0.0
    friction_power = 0.0
    damping_power = 0.0
    for i in range(first, last):
        depth = reach - contacts[LIST_E, i]
        closing = rate - contacts[LIST_DE, i] * path_speed
        k = contacts[LIST_K, i]
        depth = depth if depth > 0.0 else 0.0
        f = k * (depth + damp_time * closing)
        f = f if (depth > 0.0 and f > 0.0) else 0.0
        k_p = k if f > 0.0 else 0.0
        m_1 = contacts[LIST_M1, i]
        m_2 = contacts[LIST_M2, i]
        slope = contacts[LIST_HK, i] * depth
        force += f
        a_1 += f * m_1 + slope * depth
        a_2 += f * m_2
        k_1 += k_p * m_1
        k_2 += k_p * m_2
        k_d += 2.0 * slope
        friction_power += f * contacts[LIST_POWER, i]
        damping_power += (f - k * depth) * closing
    return (force, a_1, a_2, k_1, k_2, k_d, friction_power, damping_power)


@njit(cache=True, fastmath=LOOSE)
def path_slopes(
    contacts: Array,
    first: int,
    last: int,
    reach: float,
    rate: float,
    path_speed: float,
    damp_time: float,
) -> tuple[float, float, float]:
    """Return (da_1/ds, da_2/ds, elastic energy) of one flank at fixed reach, rate and friction levers."""
    slope_1 = 0.0
    slope_2 = 0.0
    energy = 0.0
    for i in range(first, last):
        depth = reach - contacts[LIST_E, i]
        if depth <= 0.0:
            continue
        k = contacts[LIST_K, i]
        gap_slope = contacts[LIST_DE, i]
        stiffness_slope = 2.0 * contacts[LIST_HK, i]
        pressed = depth + damp_time * (rate - gap_slope * path_speed)
        energy += 0.5 * k * depth * depth
        slope_1 -= stiffness_slope * depth * gap_slope
        if pressed > 0.0:
            df = stiffness_slope * pressed - k * gap_slope
            slope_1 += df * contacts[LIST_M1, i]
            slope_2 += df * contacts[LIST_M2, i]
    return slope_1, slope_2, energy


@njit(cache=True, fastmath=LOOSE)
def mesh_reactions(
    values: Array,
    counts: Integers,
    tables: Tables,
    theta_1: Array,
    reach: Array,
    omega_1: Array,
    omega_2: Array,
    out: Array,
) -> None:
    """Evaluate one mesh at many states; ``out`` (n, 13) in the order of ``dynamics.mesh_force.MeshReaction``.

    ``reach`` is the approach including the offset of the law, shape (n,).
    """
    contacts = np.empty((N_LIST, counts[CAPACITY]))
    no_pairs = np.empty((2, 0), np.int64)
    r_1 = values[R1]
    r_2 = values[R2]
    damp_time = values[DAMP_TIME]
    for n in range(theta_1.shape[0]):
        w_1 = omega_1[n]
        w_2 = omega_2[n]
        for column in range(13):
            out[n, column] = 0.0
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * reach[n] - side * values[BACKLASH]
            if pressed <= values[LEAST_GAP]:
                continue
            count = list_contacts(values, counts, tables, sign, theta_1[n], w_1, w_2, 0, contacts, no_pairs)
            rate = sign * (r_1 * w_1 - r_2 * w_2)
            path_speed = sign * r_1 * w_1
            force, a_1, a_2, k_1, k_2, k_d, friction_power, damping_power = sum_flank(
                contacts, 0, count, pressed, rate, path_speed, damp_time
            )
            slope_1, slope_2, energy = path_slopes(contacts, 0, count, pressed, rate, path_speed, damp_time)
            out[n, 0] -= sign * r_1 * a_1
            out[n, 1] += sign * r_2 * a_2
            out[n, 2 + side] += force
            out[n, 4] -= r_1 * (k_1 + k_d)
            out[n, 5] += r_2 * k_2
            out[n, 6] -= r_1 * k_1 * damp_time
            out[n, 7] += r_2 * k_2 * damp_time
            out[n, 8] -= r_1 * r_1 * slope_1
            out[n, 9] += r_1 * r_2 * slope_2
            out[n, 10] += friction_power
            out[n, 11] += damping_power
            out[n, 12] += energy


@njit(cache=True, fastmath=LOOSE)
def tooth_pair_forces(
    values: Array,
    counts: Integers,
    tables: Tables,
    theta_1: Array,
    reach: Array,
    omega_1: Array,
    omega_2: Array,
    lowest: Integers,
    force: Array,
) -> None:
    """Fill ``force`` (n, n_pairs, n_slices, 2), front and back; ``lowest`` (n,) is the pair of column 0."""
    contacts = np.empty((N_LIST, counts[CAPACITY]))
    pairs = np.empty((2, counts[CAPACITY]), np.int64)
    damp_time = values[DAMP_TIME]
    for n in range(theta_1.shape[0]):
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressed = sign * reach[n] - side * values[BACKLASH]
            if pressed <= values[LEAST_GAP]:
                continue
            count = list_contacts(values, counts, tables, sign, theta_1[n], 0.0, 0.0, 0, contacts, pairs)
            path_speed = sign * values[R1] * omega_1[n]
            rate = sign * (values[R1] * omega_1[n] - values[R2] * omega_2[n])
            for i in range(count):
                depth = pressed - contacts[LIST_E, i]
                closing = rate - contacts[LIST_DE, i] * path_speed
                f = contacts[LIST_K, i] * (depth + damp_time * closing)
                column = pairs[0, i] - lowest[n]
                if depth > 0.0 and f > 0.0 and 0 <= column < force.shape[1]:
                    force[n, column, pairs[1, i], side] = f
