"""Contact of one gear mesh, flank by flank, on the packed tables ``PackedMeshes``.

With ``sign`` +1 in front and -1 on the back, ``play`` 0 in front and the backlash behind, the penetration is
``d = sign x - play - e(s)`` and the path position moves with ``ds/dt = sign r_b1 omega_1``. From the
potential ``k(s) d^2 / 2``

    tau_1 = -sign r_b1 [ F (1 - e') + k' d^2 / 2 ],   tau_2 = sign r_b2 F,   F = max(0, k d + c g (d/dt) d)

where the damping grows with ``g = min(1, d / damping depth)``, and friction adds ``-mu F sgn(v_g) rho_1``
and ``+mu F sgn(v_g) rho_2`` with the sliding speed ``v_g = omega_1 rho_1 - omega_2 rho_2``, ``rho_1 = T1C +
s``, ``rho_2 = T2C - s``.

A mesh whose teeth are all alike is tabulated over its phase within one base pitch, all contacts of a phase
beside each other; a mesh with individual teeth looks every contact up on the path. Either way the contacts
of a flank are listed in groups of LANES, row after row, which the compiler turns into vector instructions.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class PackedMeshes(NamedTuple):
    """Tables of all meshes of a drivetrain; packed by ``dynamics.mesh_force.pack_meshes``."""

    values: Array
    """(n_meshes, N_VALUES) plain numbers."""
    counts: Integers
    """(n_meshes, N_COUNTS) sizes and first rows in the tables below."""
    cells: Array
    """(n_cells, 8) cubic coefficients of stiffness and gap over the fraction of a path cell."""
    shifts: Array
    """Slice shifts of all meshes [m]."""
    deviations: Array
    """(n_cells, 4) cubic coefficients of the deviation of single teeth."""
    scales: Array
    """Stiffness scales of single teeth [-]."""
    phase_starts: Integers
    """First group of every phase cell, front and back of each mesh."""
    phase_counts: Integers
    """Contacts in every phase cell."""
    phase_least: Array
    """Lower bound of the gap of every contact within its phase cell, in increasing order; LANES per group."""
    phase_data: Array
    """Groups (N_PHASE, LANES), flat: cubic of stiffness, cubic of gap, path position at the start of the cell."""
    offsets: Array
    """(n_meshes,) imposed approach [m]."""


# columns of PackedMeshes.values
R1, R2, PITCH, PHASE, BACK_PHASE, BACKLASH, START, PER_STEP = 0, 1, 2, 3, 4, 5, 6, 7
DAMP_TIME, FRICTION, ROLL_1, ROLL_2, PER_REVERSAL, LEAST_GAP, DERIVATIVE, FLOOR = 8, 9, 10, 11, 12, 13, 14, 15
PER_PITCH, PER_R1, PER_R2, PHASE_STEP, PER_DEPTH = 16, 17, 18, 19, 20
N_VALUES = 21
# columns of PackedMeshes.counts
N_SLICES, N_CELLS, CELLS_AT, SHIFTS_AT, INDIVIDUAL, TEETH_1, TEETH_2, OFFSET_2 = 0, 1, 2, 3, 4, 5, 6, 7
ROWS_1, DEVIATION_1_AT, ROWS_2, DEVIATION_2_AT = 8, 9, 10, 11
SCALES_1, SCALES_1_AT, SCALES_2, SCALES_2_AT, GROUPS = 12, 13, 14, 15, 16
N_PHASES, FRONT_AT, BACK_AT = 17, 18, 19
N_COUNTS = 20
N_PHASE = 9
LANES = 16
VECTOR = 4
"""Numbers in a vector register. More than two contacts are filled up to whole registers with some of no stiffness."""
POSITIVE = (
    1 << 40
) - 1  # masks a first index, so that the compiler knows it and what is added to be positive
# rows of a group of listed contacts: stiffness, gap and its slope, lever factors, half the stiffness slope,
# friction power per force
LIST_K, LIST_E, LIST_DE, LIST_M1, LIST_M2, LIST_HK, LIST_POWER = 0, 1, 2, 3, 4, 5, 6
N_LIST = 7

# NaN and infinity keep their meaning; only the order of sums is free
LOOSE = {"reassoc", "contract", "nsz", "arcp"}


@njit(cache=True, fastmath=LOOSE, inline="always")
def sliding_direction(ratio: float) -> float:
    """Return the smooth sign of ``ratio``: a cubic inside +-1, exactly +-1 outside."""
    ratio = ratio if ratio < 1.0 else 1.0
    ratio = ratio if ratio > -1.0 else -1.0
    return ratio * (1.5 - 0.5 * ratio * ratio)


@njit(cache=True, fastmath=LOOSE, inline="always")
def list_by_phase(
    values: Array, counts: Integers, starts: Integers, contacts_in: Integers, least: Array, data: Array, m: int,
    sign: float, pressed: float, theta_1: float, omega_1: float, omega_2: float, out: Array, at: int,
) -> int:  # fmt: skip
    """List the contacts of one flank of mesh ``m``, all teeth alike, at the angle ``theta_1``.

    Contacts whose gap stays above ``pressed`` in this phase cell are left out (the last ones of the cell).
    ``out`` receives groups of (N_LIST, LANES), flat, from ``at`` on; returns their number, filled up to whole
    vectors.
    """
    n_phases = counts[m, N_PHASES]
    origin = values[m, PHASE] if sign > 0.0 else values[m, BACK_PHASE]
    turned = (origin + sign * values[m, R1] * theta_1) * values[m, PER_PITCH]
    place = (turned - math.floor(turned)) * n_phases
    j = max(0, min(int(place), n_phases - 1))  # also where a run that left the finite numbers asks
    f = place - j
    row = (counts[m, FRONT_AT] if sign > 0.0 else counts[m, BACK_AT]) + j
    low = LANES * starts[row]
    n = int(contacts_in[row])
    if n > 2:
        near = 0
        while near < n and least[low + near] < pressed:
            near += VECTOR
        n = near
    first = (N_PHASE * LANES * starts[row]) & POSITIVE
    first_out = at & POSITIVE
    per_step = n_phases * values[m, PER_PITCH]
    derivative = values[m, DERIVATIVE]
    half = 0.5 * per_step * derivative
    friction = values[m, FRICTION]
    mu_1 = sign * friction * values[m, PER_R1]
    mu_2 = sign * friction * values[m, PER_R2]
    roll_1 = values[m, ROLL_1] + f * values[m, PHASE_STEP]
    roll_2 = values[m, ROLL_2] - f * values[m, PHASE_STEP]
    per_reversal = values[m, PER_REVERSAL]
    for group in range((n + LANES - 1) // LANES):
        a = first + N_PHASE * LANES * group
        b = first_out + N_LIST * LANES * group
        for i in range(min(n - LANES * group, LANES)):
            k_1, k_2, k_3 = data[a + LANES + i], data[a + 2 * LANES + i], data[a + 3 * LANES + i]
            e_1, e_2, e_3 = data[a + 5 * LANES + i], data[a + 6 * LANES + i], data[a + 7 * LANES + i]
            slope = (e_1 + f * (2.0 * e_2 + 3.0 * f * e_3)) * per_step
            rho_1 = roll_1 + data[a + 8 * LANES + i]
            rho_2 = roll_2 - data[a + 8 * LANES + i]
            sliding = omega_1 * rho_1 - omega_2 * rho_2
            direction = sliding_direction(sliding * per_reversal)
            out[b + LIST_K * LANES + i] = data[a + i] + f * (k_1 + f * (k_2 + f * k_3))
            out[b + LIST_E * LANES + i] = data[a + 4 * LANES + i] + f * (e_1 + f * (e_2 + f * e_3))
            out[b + LIST_DE * LANES + i] = slope
            out[b + LIST_M1 * LANES + i] = 1.0 - slope * derivative + mu_1 * direction * rho_1
            out[b + LIST_M2 * LANES + i] = 1.0 + mu_2 * direction * rho_2
            out[b + LIST_HK * LANES + i] = half * (k_1 + f * (2.0 * k_2 + 3.0 * f * k_3))
            out[b + LIST_POWER * LANES + i] = friction * direction * sliding
    return n


@njit(cache=True, fastmath=LOOSE)
def list_on_path(
    values: Array, counts: Integers, cells: Array, shifts: Array, deviations: Array, scales: Array, m: int,
    sign: float, theta_1: float, omega_1: float, omega_2: float, out: Array, at: int, pairs: Integers,
) -> int:  # fmt: skip
    """List the contacts of a flank with individual teeth like ``list_by_phase``.

    ``pairs`` (2, capacity, or 0) receives tooth pair and slice of each.
    """
    n_cells = counts[m, N_CELLS]
    per_step = values[m, PER_STEP]
    derivative = values[m, DERIVATIVE]
    pitch = values[m, PITCH] * per_step
    origin = (values[m, PHASE] if sign > 0.0 else values[m, BACK_PHASE]) - values[m, START]
    travel = origin + sign * values[m, R1] * theta_1
    friction = values[m, FRICTION]
    column = 0
    for i in range(counts[m, N_SLICES]):
        whole = (travel - sign * shifts[counts[m, SHIFTS_AT] + i]) * per_step
        turn = math.floor(whole / pitch)
        place = whole - turn * pitch
        row = counts[m, CELLS_AT] + i * n_cells
        while place < n_cells:
            j = min(max(int(place), 0), n_cells - 1)
            f = place - j
            c = row + j
            k = cells[c, 0] + f * (cells[c, 1] + f * (cells[c, 2] + f * cells[c, 3]))
            dk = cells[c, 1] + f * (2.0 * cells[c, 2] + 3.0 * f * cells[c, 3])
            e = cells[c, 4] + f * (cells[c, 5] + f * (cells[c, 6] + f * cells[c, 7]))
            de = cells[c, 5] + f * (2.0 * cells[c, 6] + 3.0 * f * cells[c, 7])
            pair = int(turn) if sign > 0.0 else -int(turn)
            mate = pair + counts[m, OFFSET_2]
            a = counts[m, DEVIATION_1_AT] + (pair % counts[m, ROWS_1]) * n_cells + j
            b = counts[m, DEVIATION_2_AT] + (mate % counts[m, ROWS_2]) * n_cells + j
            d_1 = deviations[a, 1] + deviations[b, 1]
            d_2 = deviations[a, 2] + deviations[b, 2]
            d_3 = deviations[a, 3] + deviations[b, 3]
            e += deviations[a, 0] + deviations[b, 0] + f * (d_1 + f * (d_2 + f * d_3))
            de = (de + d_1 + f * (2.0 * d_2 + 3.0 * f * d_3)) * per_step
            scale = scales[counts[m, SCALES_1_AT] + pair % counts[m, SCALES_1]]
            scale *= scales[counts[m, SCALES_2_AT] + mate % counts[m, SCALES_2]]
            s = values[m, START] + place / per_step
            rho_1 = values[m, ROLL_1] + s
            rho_2 = values[m, ROLL_2] - s
            sliding = omega_1 * rho_1 - omega_2 * rho_2
            direction = sliding_direction(sliding * values[m, PER_REVERSAL])
            lane = at + (column // LANES) * N_LIST * LANES + column % LANES
            out[lane + LIST_K * LANES] = k * scale
            out[lane + LIST_E * LANES] = e
            out[lane + LIST_DE * LANES] = de
            out[lane + LIST_M1 * LANES] = (
                1.0 - de * derivative + sign * friction * values[m, PER_R1] * direction * rho_1
            )
            out[lane + LIST_M2 * LANES] = 1.0 + sign * friction * values[m, PER_R2] * direction * rho_2
            out[lane + LIST_HK * LANES] = 0.5 * dk * scale * per_step * derivative
            out[lane + LIST_POWER * LANES] = friction * direction * sliding
            if pairs.shape[1] > 0:
                pairs[0, column] = pair
                pairs[1, column] = i
            column += 1
            turn -= 1.0
            place += pitch
    for blank in range(column, VECTOR * ((column + VECTOR - 1) // VECTOR)):
        lane = at + (blank // LANES) * N_LIST * LANES + blank % LANES
        for row in range(N_LIST):
            out[lane + row * LANES] = 0.0
    return column


class Pressed(NamedTuple):
    """What the contacts of one flank do together, and how far that is from linear."""

    force: float
    a_1: float
    """sum F m_1 + k' d^2 / 2: torque on the pinion per base radius"""
    a_2: float
    """sum F m_2"""
    force_x: float
    """Slopes over the reach"""
    a_1_x: float
    a_2_x: float
    force_v: float
    """Slopes over the rate"""
    a_1_v: float
    a_2_v: float
    kinked: float
    """Stiffness that could switch on, off or to full damping within ``guard`` of depth"""
    curved: float
    """Mixed second derivative of the force over reach and rate"""


@njit(cache=True, fastmath=LOOSE, inline="always")
def press_flank(
    contacts: Array, start: int, n: int, reach: float, rate: float, path_speed: float, damp_time: float,
    per_depth: float, guard: float,
) -> Pressed:  # fmt: skip
    """Sum the contacts of one flank listed from ``start`` on, pressed by ``reach`` and closing with ``rate``.

    ``damp_time`` = damping / mean stiffness [s], ``per_depth`` = 1 / damping depth, ``n`` as listed.
    """
    force, a_1, a_2 = 0.0, 0.0, 0.0
    force_x, a_1_x, a_2_x = 0.0, 0.0, 0.0
    force_v, a_1_v, a_2_v = 0.0, 0.0, 0.0
    kinked, curved = 0.0, 0.0
    full = 1.0 / per_depth
    first = start & POSITIVE
    for group in range((n + LANES - 1) // LANES):
        at = first + N_LIST * LANES * group
        for i in range(min(n - LANES * group, LANES)):
            closing = damp_time * (rate - contacts[at + LIST_DE * LANES + i] * path_speed)
            over = reach - contacts[at + LIST_E * LANES + i]
            depth = over if over > 0.0 else 0.0
            stiffness = contacts[at + LIST_K * LANES + i]
            k = stiffness if over > 0.0 else 0.0
            grown = depth * per_depth
            per = per_depth if grown < 1.0 else 0.0
            grown = grown if grown < 1.0 else 1.0
            pressed = depth + grown * closing
            k = k if pressed > 0.0 else 0.0
            f = k * pressed
            k_x = k * (1.0 + per * closing)
            k_v = k * grown
            m_1 = contacts[at + LIST_M1 * LANES + i]
            m_2 = contacts[at + LIST_M2 * LANES + i]
            slope = contacts[at + LIST_HK * LANES + i] * depth
            force += f
            a_1 += f * m_1 + slope * depth
            a_2 += f * m_2
            force_x += k_x
            a_1_x += k_x * m_1 + 2.0 * slope
            a_2_x += k_x * m_2
            force_v += k_v
            a_1_v += k_v * m_1
            a_2_v += k_v * m_2
            margin = abs(pressed) if abs(pressed) < abs(depth - full) else abs(depth - full)
            margin = margin if over > 0.0 else guard
            margin = margin if margin < abs(over) else abs(over)
            kinked += stiffness if margin < guard else 0.0
            curved += k * per
    return Pressed(
        force, a_1, a_2, force_x, a_1_x, a_2_x, force_v * damp_time, a_1_v * damp_time, a_2_v * damp_time,
        kinked, curved * damp_time,
    )  # fmt: skip


@njit(cache=True, fastmath=LOOSE, inline="always")
def flank_powers(
    contacts: Array, start: int, n: int, reach: float, rate: float, path_speed: float, damp_time: float,
    per_depth: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return friction power, damping power and damping force of one flank, arguments as in ``press_flank``."""
    friction_power, damping_power, damping_force = 0.0, 0.0, 0.0
    for group in range((n + LANES - 1) // LANES):
        at = (start & POSITIVE) + N_LIST * LANES * group
        for i in range(min(n - LANES * group, LANES)):
            closing = rate - contacts[at + LIST_DE * LANES + i] * path_speed
            depth = reach - contacts[at + LIST_E * LANES + i]
            depth = depth if depth > 0.0 else 0.0
            k = contacts[at + LIST_K * LANES + i]
            grown = depth * per_depth
            grown = grown if grown < 1.0 else 1.0
            f = k * (depth + damp_time * grown * closing)
            f = f if (depth > 0.0 and f > 0.0) else 0.0
            damped = f - k * depth
            friction_power += f * contacts[at + LIST_POWER * LANES + i]
            damping_power += damped * closing
            damping_force += damped
    return friction_power, damping_power, damping_force


@njit(cache=True, fastmath=LOOSE, inline="always")
def list_flank(
    values: Array, counts: Integers, starts: Integers, contacts_in: Integers, least: Array, data: Array,
    cells: Array, shifts: Array, deviations: Array, scales: Array, m: int, sign: float, pressed: float,
    theta_1: float, omega_1: float, omega_2: float, out: Array, at: int, no_pairs: Integers,
) -> int:  # fmt: skip
    """List the contacts of one flank by phase or on the path; return their number, filled up to whole vectors."""
    if counts[m, INDIVIDUAL] == 0:
        return list_by_phase(
            values, counts, starts, contacts_in, least, data, m, sign, pressed, theta_1, omega_1, omega_2, out, at
        )  # fmt: skip
    found = list_on_path(
        values,
        counts,
        cells,
        shifts,
        deviations,
        scales,
        m,
        sign,
        theta_1,
        omega_1,
        omega_2,
        out,
        at,
        no_pairs,
    )
    return VECTOR * ((found + VECTOR - 1) // VECTOR)
