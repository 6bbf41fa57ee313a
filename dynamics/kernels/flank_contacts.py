"""Which contacts a flank has at a motion of the gears, as columns of a table.

Equal teeth are tabulated over the phase within one base pitch: the contacts are those of a phase cell. With individual
teeth every contact is looked up on the path and its column is written.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    BACK_AT,
    BACK_DEVIATION_1_AT,
    BACK_DEVIATION_2_AT,
    BACK_PHASE,
    CELLS_AT,
    DEVIATION_1_AT,
    DEVIATION_2_AT,
    FRONT_AT,
    LOOSE,
    N_CELLS,
    N_PHASE,
    N_PHASES,
    N_SLICES,
    OFFSET_2,
    PER_PHASE_STEP,
    PER_PITCH,
    PER_STEP,
    PHASE,
    PHASE_STEP,
    PITCH,
    POSITIVE,
    R1,
    ROLL_1,
    ROLL_2,
    ROW_E,
    ROW_K,
    ROW_S,
    ROWS_1,
    ROWS_2,
    SCALES_1,
    SCALES_1_AT,
    SCALES_2,
    SCALES_2_AT,
    SHIFTS_AT,
    START,
    VECTOR,
    Flank,
    PackedMeshes,
    inlined,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class ContactState(NamedTuple):
    """Motion at which the contacts of a flank are chosen."""

    sign: float
    """+1 in front, -1 on the back."""
    within: float
    """Contacts whose gap stays above it in the phase cell are left out [m]."""
    theta_1: float
    """Angle of the pinion [rad]."""
    omega_1: float
    """Speeds that decide on the direction of sliding [rad/s]."""
    omega_2: float


class ContactTable(NamedTuple):
    """Room for the contacts of one flank with individual teeth."""

    data: Array
    first: int
    """First number of the table in it."""
    stride: int
    """Length of a row."""
    pairs: Integers
    """(2, capacity, or 0) tooth pair and slice of each contact."""


@inlined
def flank_in_phase(space: Array, at: int, meshes: PackedMeshes, m: int, state: ContactState) -> Flank:
    """Return the contacts of one flank of mesh ``m`` with equal teeth.

    ``space`` holds the numbers of the law, the columns of ``PackedMeshes.values``, from ``at`` on.

    Contacts whose gap stays above ``state.within`` in this phase cell are left out (the last ones of the cell).
    """
    counts, starts, least, sign = meshes.counts, meshes.phase_starts, meshes.phase_least, state.sign
    n_phases = counts[m, N_PHASES]
    origin = space[at + PHASE] if sign > 0.0 else space[at + BACK_PHASE]
    turned = (origin + sign * space[at + R1] * state.theta_1) * space[at + PER_PITCH]
    place = (turned - np.floor(turned)) * n_phases
    j = max(0, min(int(place), n_phases - 1))  # also for a run that left the finite numbers
    place -= j
    row = ((counts[m, FRONT_AT] if sign > 0.0 else counts[m, BACK_AT]) + j) & POSITIVE
    start = starts[row] & POSITIVE
    n = starts[row + 1] - start
    stride = n
    if n > 1:
        near = 0
        while near < n and least[start + near] < state.within:
            near += VECTOR
        n = near
    along = place * space[at + PHASE_STEP]
    return Flank(
        N_PHASE * start, stride, n, place, space[at + PER_PHASE_STEP], space[at + ROLL_1] + along,
        space[at + ROLL_2] - along, state.omega_1, state.omega_2,
    )  # fmt: skip


@njit(cache=True, fastmath=LOOSE)
def list_on_path(
    space: Array, at: int, meshes: PackedMeshes, m: int, sign: float, theta_1: float, table: ContactTable
) -> int:
    """Write the contacts of a flank with individual teeth into a table.

    The polynomials are those of place 0 in cells of one metre. Returns the number of contacts; the table goes on with
    zeros to a whole turn of the compiled loop.
    """
    counts, cells, shifts = meshes.counts, meshes.cells, meshes.shifts
    deviations, scales = meshes.deviations, meshes.scales
    out, first, stride, pairs = table.data, table.first, table.stride, table.pairs
    n_cells = counts[m, N_CELLS]
    per_step = space[at + PER_STEP]
    pitch = space[at + PITCH] * per_step
    origin = (space[at + PHASE] if sign > 0.0 else space[at + BACK_PHASE]) - space[at + START]
    travel = origin + sign * space[at + R1] * theta_1
    deviation_1 = counts[m, DEVIATION_1_AT] if sign > 0.0 else counts[m, BACK_DEVIATION_1_AT]
    deviation_2 = counts[m, DEVIATION_2_AT] if sign > 0.0 else counts[m, BACK_DEVIATION_2_AT]
    offset_2 = counts[m, OFFSET_2] if sign > 0.0 else counts[m, OFFSET_2] + 1
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
            k_2, e_2 = cells[c, 2] + 3.0 * f * cells[c, 3], cells[c, 6] + 3.0 * f * cells[c, 7]
            pair = int(turn) if sign > 0.0 else -int(turn)
            mate = pair + offset_2
            a = deviation_1 + (pair % counts[m, ROWS_1]) * n_cells + j
            b = deviation_2 + (mate % counts[m, ROWS_2]) * n_cells + j
            d_1 = deviations[a, 1] + deviations[b, 1]
            d_2 = deviations[a, 2] + deviations[b, 2]
            d_3 = deviations[a, 3] + deviations[b, 3]
            e += deviations[a, 0] + deviations[b, 0] + f * (d_1 + f * (d_2 + f * d_3))
            de += d_1 + f * (2.0 * d_2 + 3.0 * f * d_3)
            e_2 += d_2 + 3.0 * f * d_3
            scale = scales[counts[m, SCALES_1_AT] + pair % counts[m, SCALES_1]]
            scale *= scales[counts[m, SCALES_2_AT] + mate % counts[m, SCALES_2]]
            to = first + column
            for blank in range(N_PHASE):
                out[to + blank * stride] = 0.0
            out[to + ROW_K * stride] = k * scale
            out[to + (ROW_K + 1) * stride] = dk * scale * per_step
            out[to + (ROW_K + 2) * stride] = k_2 * scale * per_step * per_step
            out[to + ROW_E * stride] = e
            out[to + (ROW_E + 1) * stride] = de * per_step
            out[to + (ROW_E + 2) * stride] = e_2 * per_step * per_step
            out[to + ROW_S * stride] = space[at + START] + place / per_step
            if pairs.shape[1] > 0:
                pairs[0, column] = pair
                pairs[1, column] = i
            column += 1
            turn -= 1.0
            place += pitch
    for rest in range(column, VECTOR * ((column + VECTOR - 1) // VECTOR)):
        for blank in range(N_PHASE):
            out[first + rest + blank * stride] = 0.0
    return column


@inlined
def flank_on_path(
    space: Array, at: int, table: ContactTable, found: int, omega_1: float, omega_2: float
) -> Flank:
    """Return the contacts that ``list_on_path`` has written, filled up to whole turns."""
    n = VECTOR * ((found + VECTOR - 1) // VECTOR)
    return Flank(
        table.first, table.stride, n, 0.0, 1.0, space[at + ROLL_1], space[at + ROLL_2], omega_1, omega_2
    )
