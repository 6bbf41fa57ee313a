"""Table look-up of the flanks of a mesh at their place on the path, within one step of the time integration."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
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
    C_GENERAL,
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
    V_BACKLASH,
    V_CLOSING,
    V_FRICTION,
    V_LEAST_GAP,
    V_ORIGIN,
    V_PER_FINEST,
    V_PER_KNOT,
    V_PER_PITCH,
    V_R1,
    ContactTables,
)
from dynamics.kernels.integrator_state import MeshStep
from dynamics.kernels.table_lookup import (
    FlankState,
    LookUp,
    Sliding,
    add_lines,
    contract_cell,
    contract_first,
    look_up_flank,
    share_of,
    spline_curves,
    spline_weights,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


NEAR = 0.2
"""Share of a cell by which the path may be off the place at which rows were looked up."""


class FlankRows(NamedTuple):
    """Rows of the flanks of all meshes at their places on the path."""

    rows: Array
    """Flat, per mesh and flank room for all of its pairs, then room that tilt needs."""
    counts: Integers
    """(n_meshes, 2) rows that are in use."""
    first: Integers
    """(n_meshes, 2) first entry."""
    levels: Integers
    """(n_meshes,) level of friction in this sample, see ``table_lookup.Sliding``."""
    cells: Integers
    """(n_meshes, 2) cells of the last rows."""
    sides: Integers
    """(n_meshes,) flank that is looked up first: 0 in front, 1 on the back, 2 none."""
    knots: Integers
    """(n_meshes,) knot of its place on the path."""


@inlined
def _front_begins(mesh: MeshStep, values: Array, m: int) -> float:
    """Return the approach of the teeth above which flanks in front may touch."""
    return float(values[m, V_LEAST_GAP] - mesh.other_front * mesh.apart)


@inlined
def _back_begins(mesh: MeshStep, values: Array, m: int) -> float:
    """Return the approach of the teeth below which flanks on the back may touch."""
    return float(mesh.other_back * mesh.apart - values[m, V_BACKLASH] - values[m, V_LEAST_GAP])


@inlined
def find_place(
    tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows, angle: float, teeth: float
) -> None:
    """Find the flank of a mesh that touches at an angle of the pinion and an approach of the teeth, and its place."""
    values = tables.values
    front = teeth > _front_begins(mesh, values, m)
    back = teeth < _back_begins(mesh, values, m)
    side = 0 if front else 1
    mesh.table_angle, mesh.teeth = angle, teeth
    flanks.sides[m] = side if front or back else 2
    place = place_of(tables, m, side, angle)
    flanks.knots[m], mesh.fraction = place.knot, place.fraction


@inlined
def look_up_mesh(tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows) -> None:
    """Look up the flanks of a mesh that touch at the place that was found."""
    values = tables.values
    least, turning = _front_begins(mesh, values, m), _back_begins(mesh, values, m)
    closer = mesh.other_front * mesh.apart
    back = mesh.other_back * mesh.apart - values[m, V_BACKLASH]
    side, teeth = flanks.sides[m], mesh.teeth
    flanks.counts[m, 0], flanks.counts[m, 1] = 0, 0
    low, high = turning, least
    if side < 2:
        sliding = Sliding(flanks.levels[m], mesh.lower, mesh.upper)
        first = flanks.first[m, side] & POSITIVE
        reach = teeth + closer if side == 0 else back - teeth
        if tables.counts[m, C_GENERAL] == 0:
            place = Place(flanks.knots[m], mesh.fraction)
            rows = look_up_equal_teeth(
                tables, m, side, place, sliding, reach, flanks.cells, flanks.rows, first
            )
        else:
            state = FlankState(side, mesh.table_angle, 0.0)
            rows = look_up_flank(tables, m, state, sliding, reach, flanks.rows, first)
        flanks.counts[m, side] = rows.n
        if side == 0:
            low, high = rows.low - closer, rows.high - closer
            low = low if teeth < turning or low > turning else turning
        else:
            low, high = back - rows.high, back - rows.low
            high = high if high < least else least
    mesh.low, mesh.high = low, high
    if side == 0 and teeth < turning:
        _look_up_back(tables, mesh, m, flanks, teeth)


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _look_up_back(tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows, teeth: float) -> None:
    """Look up the back flank of a mesh whose front flank was."""
    back = mesh.other_back * mesh.apart - tables.values[m, V_BACKLASH]
    sliding = Sliding(flanks.levels[m], mesh.lower, mesh.upper)
    state = FlankState(1, mesh.table_angle, 0.0)
    rows = look_up_flank(tables, m, state, sliding, back - teeth, flanks.rows, flanks.first[m, 1] & POSITIVE)
    flanks.counts[m, 1] = rows.n
    # no longer from where the back flank begins to touch on
    mesh.low = max(mesh.low if mesh.low > teeth - 1.0 else -np.inf, back - rows.high)
    mesh.high = min(mesh.high, back - rows.low)


@inlined
def within_rows(mesh: MeshStep, values: Array, m: int) -> bool:
    """Return whether the rows of a mesh are good at the approach and the angle that it reaches."""
    beside = values[m, V_R1] * (mesh.angle + mesh.pinion.turn + mesh.lean - mesh.table_angle)
    near = abs(beside) * values[m, V_PER_KNOT] < NEAR
    return bool(near and mesh.low <= mesh.teeth <= mesh.high)


# A flank of a mesh with equal teeth: what ``kernels.table_lookup`` does, for the usual case.
#
# One row, no single teeth, no tilt: everything is known but the cell.


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
def look_up_equal_teeth(
    tables: ContactTables, m: int, side: int, place: Place, sliding: Sliding, reach: float, cells: Integers,
    rows: Array, row: int,
) -> LookUp:  # fmt: skip
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
            return LookUp(0, -np.inf, gap)
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
    return LookUp(1, start, end if cell < counts[m, C_CELLS] - 1 else np.inf)
