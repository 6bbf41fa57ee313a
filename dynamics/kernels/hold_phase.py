"""The front flank of a mesh with equal teeth held on its path: what ``kernels.hold_path`` does, for the usual case.

One row, no single teeth, no tilt: everything is known but the cell.
"""

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.contact import inlined
from dynamics.kernels.contact_table import (
    C_CELL_OF_AT,
    C_CELLS,
    C_CELLS_AT,
    C_CLOSING_AT,
    C_DEPTHS_AT,
    C_FINEST,
    C_FRICTION_AT,
    C_GAPS_AT,
    C_KNOTS,
    C_LEVELS,
    C_PER_PITCH,
    CELL,
    LINES,
    R_CLOSING,
    R_FRICTION,
    R_GAP_SLOPE,
    R_START,
    V_CLOSING,
    V_FRICTION,
    V_ORIGIN,
    V_PER_FINEST,
    V_PER_KNOT,
    V_PER_PITCH,
    V_R1,
    ContactTables,
)
from dynamics.kernels.hold_path import Held, Sliding, share_of, spline_weights
from dynamics.kernels.knots import add_lines, contract_cell, contract_two
from dynamics.kernels.mesh_tables import POSITIVE

# compiled from sources da586b04
Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@inlined
def hold_phase(
    tables: ContactTables, m: int, theta_1: float, sliding: Sliding, reach: float, rows: Array, row: int
) -> Held:
    """Write the row of the front flank of a mesh with equal teeth at the approach ``reach``."""
    values, counts = tables.values, tables.counts
    n_cells, per_pitch = counts[m, C_CELLS], counts[m, C_PER_PITCH]
    turned = (values[m, V_ORIGIN] + values[m, V_R1] * theta_1) * values[m, V_PER_PITCH]
    place = (turned - np.floor(turned)) * per_pitch
    knot = max(0, min(int(place), per_pitch - 1))  # also for a run that left the finite numbers
    weights = spline_weights(place - knot, values[m, V_PER_KNOT])
    at = (counts[m, C_GAPS_AT] + knot) & POSITIVE
    g_0, g_1, g_2, g_3 = tables.gaps[at], tables.gaps[at + 1], tables.gaps[at + 2], tables.gaps[at + 3]
    gap = (weights[0] * g_0 + weights[1] * g_1) + (weights[2] * g_2 + weights[3] * g_3)
    slope = (weights[4] * g_0 + weights[5] * g_1) + (weights[6] * g_2 + weights[7] * g_3)
    depth = reach - gap
    if depth <= 0.0:
        return Held(0, -np.inf, gap)
    finest = min(int(depth * values[m, V_PER_FINEST]), counts[m, C_FINEST] - 1)
    cell = tables.cell_of[(counts[m, C_CELL_OF_AT] + finest) & POSITIVE]
    depths_at = (counts[m, C_DEPTHS_AT] + cell) & POSITIVE
    start, end = gap + tables.depths[depths_at], gap + tables.depths[depths_at + 1]
    one = cell * counts[m, C_KNOTS] + knot
    contract_cell(
        tables.cells, (counts[m, C_CELLS_AT] + one * CELL) & POSITIVE, n_cells * CELL, weights, rows, row
    )
    if values[m, V_FRICTION] > 0.0:
        level = counts[m, C_KNOTS] * n_cells
        first = (counts[m, C_FRICTION_AT] + 2 * LINES * (one + sliding.level * level)) & POSITIVE
        step, at = 2 * LINES, row + R_FRICTION
        still, moved = share_of(weights, sliding.lower), share_of(weights, sliding.lower * sliding.advance)
        contract_two(tables.friction, first, first + LINES, step, still, moved, rows, at)
        if counts[m, C_LEVELS] > 1:
            first += 2 * LINES * level
            add_lines(tables.friction, first, step, share_of(weights, sliding.upper), rows, at)
            moved = share_of(weights, sliding.upper * sliding.advance)
            add_lines(tables.friction, first + LINES, step, moved, rows, at)
    if values[m, V_CLOSING] > 0.0:
        for i in range(LINES):
            rows[row + R_CLOSING + i] = 0.0
        first = (counts[m, C_CLOSING_AT] + one * LINES) & POSITIVE
        add_lines(tables.closing, first, LINES, share_of(weights, 1.0), rows, row + R_CLOSING)
    rows[row + R_START], rows[row + R_GAP_SLOPE] = start, slope
    return Held(1, start, end if cell < n_cells - 1 else np.inf)
