"""A flank of a mesh with equal teeth held on its path: what ``kernels.hold_path`` does, for the usual case.

One row, no single teeth, no tilt: everything is known but the cell.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.contact import inlined
from dynamics.kernels.contact_table import (
    C_BACK,
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
    R_CURVES,
    R_FRICTION,
    R_GAIN,
    R_GAP_CURVE,
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
from dynamics.kernels.hold_path import Held, Sliding, share_of, spline_curves, spline_weights
from dynamics.kernels.knots import add_lines, contract_cell, contract_first
from dynamics.kernels.mesh_tables import POSITIVE

# compiled from sources 815a2749
Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Place(NamedTuple):
    """Place of a flank on the knots of its table."""

    knot: int
    fraction: float
    """Of the cell between this knot and the next."""


@inlined
def place_of(tables: ContactTables, m: int, side: int, theta_1: float) -> Place:
    """Return the place of a flank of a mesh with equal teeth, 0 in front and 1 on the back."""
    values, per_pitch = tables.values, tables.counts[m, C_PER_PITCH]
    turned = (values[m, V_ORIGIN + side] + (1.0 - 2.0 * side) * values[m, V_R1] * theta_1) * values[
        m, V_PER_PITCH
    ]
    place = (turned - np.floor(turned)) * per_pitch
    knot = max(0, min(int(place), per_pitch - 1))  # also for a run that left the finite numbers
    return Place(knot, place - np.floor(place))


@inlined
def hold_phase(
    tables: ContactTables, m: int, side: int, place: Place, sliding: Sliding, reach: float, cells: Integers,
    rows: Array, row: int,
) -> Held:  # fmt: skip
    """Write the row of a flank of a mesh with equal teeth at the approach ``reach``.

    ``cells`` (n_meshes, 2) holds the cell of the last row, mostly that of this one: what is read there waits for no
    search.
    """
    values, counts = tables.values, tables.counts
    knots, cell, knot = counts[m, C_KNOTS], cells[m, side] & POSITIVE, place.knot
    size, back = knots * counts[m, C_CELLS], side * counts[m, C_BACK]
    weights = spline_weights(place.fraction, values[m, V_PER_KNOT])
    curves = spline_curves(place.fraction, values[m, V_PER_KNOT])
    at = (counts[m, C_GAPS_AT] + back * knots + knot) & POSITIVE
    g_0, g_1, g_2, g_3 = tables.gaps[at], tables.gaps[at + 1], tables.gaps[at + 2], tables.gaps[at + 3]
    gap = (weights[0] * g_0 + weights[1] * g_1) + (weights[2] * g_2 + weights[3] * g_3)
    slope = (weights[4] * g_0 + weights[5] * g_1) + (weights[6] * g_2 + weights[7] * g_3)
    curve = (curves[0] * g_0 + curves[1] * g_1) + (curves[2] * g_2 + curves[3] * g_3)
    depths_at = (counts[m, C_DEPTHS_AT] + cell) & POSITIVE
    start, end = gap + tables.depths[depths_at], gap + tables.depths[depths_at + 1]
    if not start <= reach < end:
        if reach <= gap:
            return Held(0, -np.inf, gap)
        finest = min(int((reach - gap) * values[m, V_PER_FINEST]), counts[m, C_FINEST] - 1)
        cell = tables.cell_of[(counts[m, C_CELL_OF_AT] + finest) & POSITIVE]
        cells[m, side] = cell
        depths_at = (counts[m, C_DEPTHS_AT] + cell) & POSITIVE
        start, end = gap + tables.depths[depths_at], gap + tables.depths[depths_at + 1]
    one = cell * knots + knot
    first = (counts[m, C_CELLS_AT] + (back * size + one) * CELL) & POSITIVE
    contract_cell(tables.cells, first, CELL, weights, rows, row)
    contract_first(tables.cells, first, CELL, curves, rows, row + R_CURVES)
    if values[m, V_FRICTION] > 0.0:
        levels = counts[m, C_LEVELS]
        first = counts[m, C_FRICTION_AT] + 2 * LINES * (one + (back * levels + sliding.level) * size)
        first, step, lower = first & POSITIVE, 2 * LINES, share_of(weights, sliding.lower)
        contract_first(tables.friction, first, step, lower, rows, row + R_FRICTION)
        contract_first(tables.friction, first + LINES, step, lower, rows, row + R_GAIN)
        if sliding.upper != 0.0:
            first += 2 * LINES * size
            upper = share_of(weights, sliding.upper)
            add_lines(tables.friction, first, step, upper, rows, row + R_FRICTION)
            add_lines(tables.friction, first + LINES, step, upper, rows, row + R_GAIN)
    if values[m, V_CLOSING] > 0.0:
        first = (counts[m, C_CLOSING_AT] + 2 * (back * size + one) * LINES) & POSITIVE
        own = share_of(weights, 1.0)
        contract_first(tables.closing, first, 2 * LINES, own, rows, row + R_CLOSING)
        contract_first(tables.closing, first + LINES, 2 * LINES, own, rows, row + R_CLOSING + LINES)
    rows[row + R_START], rows[row + R_GAP_SLOPE], rows[row + R_GAP_CURVE] = start, slope, curve
    return Held(1, start, end if cell < counts[m, C_CELLS] - 1 else np.inf)
