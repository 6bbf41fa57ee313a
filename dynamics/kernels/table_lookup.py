"""Table look-up of a flank at a place on its path: from its contact table a row of numbers for each pair that touches.

The splines over the path are contracted to cubics over the approach of the teeth, so that a Newton iteration at a
known angle needs no table.
"""

from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.contact_table import (
    C_BACK,
    C_CELL_OF_AT,
    C_CELLS,
    C_CELLS_AT,
    C_CLOSING_AT,
    C_DEPTHS_AT,
    C_DEVIATIONS_AT,
    C_FINEST,
    C_FRICTION_AT,
    C_GAPS_AT,
    C_INDIVIDUAL,
    C_KNOTS,
    C_LEVELS,
    C_LEVELS_AT,
    C_MOMENTS_AT,
    C_OFFSET_2,
    C_PAIRS,
    C_PER_PITCH,
    C_PER_TOOTH,
    C_PLANES,
    C_SCALED_1,
    C_SCALED_2,
    C_SCALES_AT,
    C_TEETH_1,
    C_TEETH_2,
    CELL,
    LINES,
    N_ROW,
    N_SCALED,
    R_CLOSING,
    R_CURVES,
    R_FRICTION,
    R_GAIN,
    R_GAP_CURVE,
    R_GAP_SLOPE,
    R_MOMENT,
    R_SLOPES,
    R_START,
    SCRATCH,
    V_CLOSING,
    V_FRICTION,
    V_LOWEST,
    V_ORIGIN,
    V_PER_FINEST,
    V_PER_KNOT,
    V_PER_PITCH,
    V_PER_REVERSAL,
    V_PER_TILT,
    V_R1,
    V_SPUR,
    V_START,
    V_TILT,
    ContactTables,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class FlankState(NamedTuple):
    """Where a flank is on its path."""

    side: int
    """0 in front, 1 on the back."""
    theta_1: float
    """Angle of the pinion [rad]."""
    tilt: float
    """Gap that closes per face width from mid-face [rad]; of no effect on tables without tilt."""


class Sliding(NamedTuple):
    """Which friction a mesh has at a motion."""

    level: int
    """First of two sharpnesses of the reversal at which friction is tabulated."""
    lower: float
    """Share of this and of the next, negative where the gears turn backwards."""
    upper: float


class LookUp(NamedTuple):
    """Rows of a flank at a place on its path."""

    n: int
    """Rows, one for each pair that touches."""
    low: float
    """Range of the approach that they are good for [m]."""
    high: float


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def sliding_at(tables: ContactTables, m: int, omega_1: float, omega_2: float) -> Sliding:
    """Return the friction of a mesh at speeds of pinion and wheel."""
    values = tables.values
    both = omega_1 + omega_2
    first, count = tables.counts[m, C_LEVELS_AT], tables.counts[m, C_LEVELS]
    sign = 1.0 if both >= 0.0 else -1.0
    level, lower, upper = 0, sign, 0.0
    if count > 1:
        wanted = abs(both) * values[m, V_PER_REVERSAL]
        if wanted <= tables.levels[first]:
            lower = sign * wanted / tables.levels[first]
        else:
            while level < count - 2 and wanted > tables.levels[first + level + 1]:
                level += 1
            begin, end = tables.levels[first + level], tables.levels[first + level + 1]
            share = (wanted - begin) / (end - begin)
            if share < 1.0:
                lower, upper = sign * (1.0 - share), sign * share
            else:
                level += 1
    return Sliding(level, lower, upper)


@inlined
def spline_weights(f: float, per_knot: float) -> tuple[float, ...]:
    """Return the cubic B-splines of four knots at a fraction of a cell, then their slopes over the path."""
    e = 1.0 - f
    half = 0.5 * per_knot
    return (
        e * e * e * (1.0 / 6.0), 2.0 / 3.0 + f * f * (0.5 * f - 1.0), 2.0 / 3.0 + e * e * (0.5 * e - 1.0),
        f * f * f * (1.0 / 6.0), -half * e * e, half * f * (3.0 * f - 4.0), -half * e * (3.0 * e - 4.0), half * f * f,
    )  # fmt: skip


@inlined
def spline_curves(f: float, per_knot: float) -> tuple[float, float, float, float]:
    """Return the second derivatives of these splines over the path."""
    twice = per_knot * per_knot
    return twice * (1.0 - f), twice * (3.0 * f - 2.0), twice * (1.0 - 3.0 * f), twice * f


@inlined
def _tooth(number: float, teeth: int) -> int:
    """Return the tooth, 0 to ``teeth`` - 1, that a whole number counts."""
    turned = number - teeth * np.floor(number / teeth)
    return max(0, min(int(turned), teeth - 1))  # also for a run that left the finite numbers


@inlined
def _next_tooth(tooth: int, step: int, teeth: int) -> int:
    """Return the tooth before (-1) or after (+1) one."""
    tooth += step
    tooth = tooth if tooth >= 0 else tooth + teeth
    return tooth if tooth < teeth else tooth - teeth


@inlined
def _of_teeth(
    tables: ContactTables, m: int, first: int, second: int, knot: int, weights: tuple[float, ...]
) -> tuple[float, float]:
    """Return gap and its slope over the path of two teeth, whose numbers begin at ``first`` and ``second``."""
    table = tables.deviations
    first, second = first & POSITIVE, second & POSITIVE
    if tables.counts[m, C_PER_TOOTH] == 1:
        return table[first] + table[second], 0.0
    gap, slope = 0.0, 0.0
    for i in range(4):
        at = knot + i
        value = table[(first + at) & POSITIVE] + table[(second + at) & POSITIVE]
        gap += weights[i] * value
        slope += weights[4 + i] * value
    return gap, slope


class _Plane(NamedTuple):
    """Place of a tilt between two of those that are tabulated, the weights of a cubic by value and derivative."""

    first: int
    share: float
    values: tuple[float, float, float, float]
    """Of W and moment at both tilts."""
    slopes: tuple[float, float, float, float]


@inlined
def _plane(values: Array, counts: Integers, m: int, tilt: float) -> _Plane:
    if counts[m, C_PLANES] == 1:
        return _Plane(0, 0.0, (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
    per = values[m, V_PER_TILT]
    place = (tilt - values[m, V_TILT]) * per
    first = max(0, min(int(place), counts[m, C_PLANES] - 2))
    f = place - first
    e, d = 1.0 - f, 1.0 / per
    return _Plane(
        first, f,
        (e * e * (1.0 + 2.0 * f), d * f * e * e, f * f * (3.0 - 2.0 * f), -d * f * f * e),
        (-6.0 * per * f * e, e * (1.0 - 3.0 * f), 6.0 * per * f * e, f * (3.0 * f - 2.0)),
    )  # fmt: skip


class _CellTables(NamedTuple):
    """First entries of the tables of a flank at one tilt."""

    cells: int
    moments: int
    friction: int
    closing: int
    plane: int
    """Cells of all knots."""
    levels: int


@inlined
def _cell_tables(tables: ContactTables, m: int, back: int, plane: int, level: int) -> _CellTables:
    counts = tables.counts
    size, levels = counts[m, C_KNOTS] * counts[m, C_CELLS], counts[m, C_LEVELS]
    before = back * counts[m, C_PLANES] + plane
    return _CellTables(
        counts[m, C_CELLS_AT] + before * size * CELL,
        counts[m, C_MOMENTS_AT] + before * size * LINES,
        counts[m, C_FRICTION_AT] + 2 * (before * levels + level) * size * LINES,
        counts[m, C_CLOSING_AT] + 2 * before * size * LINES,
        size,
        levels,
    )


@inlined
def share_of(weights: tuple[float, ...], share: float) -> tuple[float, float, float, float]:
    """Return the weights of four knots times a share."""
    return share * weights[0], share * weights[1], share * weights[2], share * weights[3]


@inlined
def _add_friction(
    tables: ContactTables, m: int, kinds: _CellTables, plane: int, share: float, cell: int,
    weights: tuple[float, ...], sliding: Sliding, rows: Array, row: int,
) -> None:  # fmt: skip
    """Add ``share`` of the levers of friction to a row."""
    if tables.values[m, V_FRICTION] > 0.0 and tables.values[m, V_SPUR] == 0.0:
        first = kinds.friction + 2 * LINES * (cell + kinds.levels * plane * kinds.plane)
        for level in range(2 if sliding.upper != 0.0 else 1):
            own = share_of(weights, share * (sliding.lower if level == 0 else sliding.upper))
            add_lines(tables.friction, first & POSITIVE, 2 * LINES, own, rows, row + R_FRICTION)
            add_lines(tables.friction, (first + LINES) & POSITIVE, 2 * LINES, own, rows, row + R_GAIN)
            first += 2 * kinds.plane * LINES


@inlined
def _add_closing(
    tables: ContactTables, m: int, kinds: _CellTables, plane: int, share: float, cell: int,
    weights: tuple[float, ...], rows: Array, row: int,
) -> None:  # fmt: skip
    """Add ``share`` of the closing weights to a row."""
    if tables.values[m, V_CLOSING] > 0.0:
        first = (kinds.closing + 2 * (cell + plane * kinds.plane) * LINES) & POSITIVE
        own = share_of(weights, share)
        add_lines(tables.closing, first, 2 * LINES, own, rows, row + R_CLOSING)
        add_lines(tables.closing, first + LINES, 2 * LINES, own, rows, row + R_CLOSING + LINES)


@inlined
def _fill_row(
    tables: ContactTables, m: int, kinds: _CellTables, plane: _Plane, cell: int, weights: tuple[float, ...],
    curves: tuple[float, ...], sliding: Sliding, rows: Array, row: int,
) -> None:  # fmt: skip
    """Write the numbers of a cell into a row."""
    contract_cell(tables.cells, (kinds.cells + cell * CELL) & POSITIVE, CELL, weights, rows, row)
    for i in range(R_CLOSING, R_START):
        rows[row + i] = 0.0
    contract_first(tables.cells, (kinds.cells + cell * CELL) & POSITIVE, CELL, curves, rows, row + R_CURVES)
    tilts = tables.counts[m, C_PLANES] > 1
    for side in range(2 if tilts else 1):
        share = 1.0 if not tilts else plane.share if side == 1 else 1.0 - plane.share
        _add_friction(tables, m, kinds, side, share, cell, weights, sliding, rows, row)
        _add_closing(tables, m, kinds, side, share, cell, weights, rows, row)
    if tilts:
        _tilt_row(tables, kinds, plane, cell, weights, rows, row)


@inlined
def _tilt_row(
    tables: ContactTables, kinds: _CellTables, plane: _Plane, cell: int, weights: tuple[float, ...], rows: Array,
    row: int,
) -> None:  # fmt: skip
    """Take a row with the first of two tilts to the place between them."""
    other = rows.shape[0] - SCRATCH
    moments = other + 2 * CELL
    first = (kinds.cells + (cell + kinds.plane) * CELL) & POSITIVE
    contract_cell(tables.cells, first, CELL, weights, rows, other)
    for side in range(2):
        first = (kinds.moments + (cell + side * kinds.plane) * LINES) & POSITIVE
        at = moments + 2 * LINES * side
        contract_lines(tables.moments, first, LINES, weights, rows, at)
    for i in range(LINES):
        a, b, c, d = rows[row + i], rows[moments + i], rows[other + i], rows[moments + 2 * LINES + i]
        at, to = row + R_SLOPES + i, moments + LINES + i
        rows[at] = (
            plane.values[0] * rows[at]
            + plane.values[1] * rows[to]
            + plane.values[2] * rows[other + CELL + i]
            + plane.values[3] * rows[to + 2 * LINES]
        )
        rows[row + i] = plane.values[0] * a + plane.values[1] * b + plane.values[2] * c + plane.values[3] * d
        rows[row + R_MOMENT + i] = (
            plane.slopes[0] * a + plane.slopes[1] * b + plane.slopes[2] * c + plane.slopes[3] * d
        )
        at = row + LINES + i
        rows[at] = (1.0 - plane.share) * rows[at] + plane.share * rows[other + LINES + i]


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def look_up_flank(
    tables: ContactTables, m: int, state: FlankState, sliding: Sliding, reach: float, rows: Array, first: int
) -> LookUp:
    """Write a row for every pair of a flank that touches at the approach ``reach`` into ``rows`` from ``first`` on."""
    values, counts = tables.values, tables.counts
    side = state.side
    sign = 1.0 - 2.0 * side
    knots, n_cells, per_pitch = counts[m, C_KNOTS], counts[m, C_CELLS], counts[m, C_PER_PITCH]
    back = side * counts[m, C_BACK]
    turned = (values[m, V_ORIGIN + side] + sign * values[m, V_R1] * state.theta_1) * values[m, V_PER_PITCH]
    turn = np.floor(turned)
    place = (turned - turn) * per_pitch
    knot = max(0, min(int(place), per_pitch - 1))  # also for a run that left the finite numbers
    weights = spline_weights(place - knot, values[m, V_PER_KNOT])
    curves = spline_curves(place - knot, values[m, V_PER_KNOT])
    gaps_at = counts[m, C_GAPS_AT] + back * knots
    plane = _plane(values, counts, m, state.tilt)
    kinds = _cell_tables(tables, m, back, plane.first, sliding.level)
    lowest, per_finest = values[m, V_LOWEST], values[m, V_PER_FINEST]
    individual, per_tooth = counts[m, C_INDIVIDUAL] != 0, counts[m, C_PER_TOOTH]
    teeth_1, teeth_2, tooth_1, tooth_2, step = counts[m, C_TEETH_1], counts[m, C_TEETH_2], 0, 0, 2 * side - 1
    deviations = counts[m, C_DEVIATIONS_AT] + side * (teeth_1 + teeth_2) * per_tooth
    scales = counts[m, C_SCALES_AT]
    if individual:
        tooth_1 = _tooth(sign * turn, teeth_1)
        tooth_2 = _tooth(sign * turn + counts[m, C_OFFSET_2] + side, teeth_2)
    n, low, high = 0, -np.inf, np.inf
    for _ in range(counts[m, C_PAIRS]):
        at_knot = gaps_at + knot
        g_0, g_1, g_2, g_3 = (
            tables.gaps[at_knot & POSITIVE], tables.gaps[(at_knot + 1) & POSITIVE],
            tables.gaps[(at_knot + 2) & POSITIVE], tables.gaps[(at_knot + 3) & POSITIVE],
        )  # fmt: skip
        gap = weights[0] * g_0 + weights[1] * g_1 + weights[2] * g_2 + weights[3] * g_3
        slope = weights[4] * g_0 + weights[5] * g_1 + weights[6] * g_2 + weights[7] * g_3
        curve = curves[0] * g_0 + curves[1] * g_1 + curves[2] * g_2 + curves[3] * g_3
        scale = 1.0
        if individual:
            one, other = deviations + tooth_1 * per_tooth, deviations + (teeth_1 + tooth_2) * per_tooth
            more, steeper = _of_teeth(tables, m, one, other, knot, weights)
            gap += more
            slope += steeper
            one = tooth_1 if counts[m, C_SCALED_1] > 1 else 0
            other = tooth_2 if counts[m, C_SCALED_2] > 1 else 0
            scale = tables.scales[scales + one] * tables.scales[scales + counts[m, C_SCALED_1] + other]
            tooth_1, tooth_2 = _next_tooth(tooth_1, step, teeth_1), _next_tooth(tooth_2, step, teeth_2)
        depth = reach - gap - lowest
        if depth <= 0.0:
            high = min(high, gap + lowest)
        else:
            finest = min(int(depth * per_finest), counts[m, C_FINEST] - 1)
            cell = tables.cell_of[(counts[m, C_CELL_OF_AT] + finest) & POSITIVE]
            depths_at = (counts[m, C_DEPTHS_AT] + cell) & POSITIVE
            start = gap + tables.depths[depths_at]
            low = max(low, start)
            if cell < n_cells - 1:
                high = min(high, gap + tables.depths[depths_at + 1])
            row = (first + N_ROW * n) & POSITIVE
            _fill_row(tables, m, kinds, plane, cell * knots + knot, weights, curves, sliding, rows, row)
            rows[row + R_START], rows[row + R_GAP_SLOPE], rows[row + R_GAP_CURVE] = start, slope, curve
            if values[m, V_SPUR] > 0.0:
                rows[row + R_FRICTION] = (
                    values[m, V_START + side] + (knot + place - np.floor(place)) / values[m, V_PER_KNOT]
                )
            if scale != 1.0:
                for i in range(N_SCALED):
                    rows[row + i] *= scale
            n += 1
        knot += per_pitch
    return LookUp(n, low, high)


# Contraction of four rows of a table with four weights, and with four more, as vector instructions.
#
# The compiler unrolls loops as short as these and then leaves them scalar; here the rows are vectors from the start.

FAST = ("contract", "reassoc")


def _vector_at(context: Any, builder: Any, kind: Any, array: Any, place: Any, width: int) -> Any:
    """Pointer to ``width`` numbers of a contiguous array from a place on."""
    data = context.make_array(kind)(context, builder, array).data
    start = builder.gep(data, [place])
    return builder.bitcast(start, ir.VectorType(ir.DoubleType(), width).as_pointer())


def _spread(builder: Any, value: Any, width: int) -> Any:
    """A number in every element of a vector."""
    kind = ir.VectorType(ir.DoubleType(), width)
    one = builder.insert_element(ir.Constant(kind, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    mask = ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    return builder.shuffle_vector(one, ir.Constant(kind, ir.Undefined), mask)


def _contraction(width: int, sums: int, add: bool) -> Any:
    """Make the intrinsic of ``sums`` contractions of rows of ``width`` numbers."""

    def contract(typing: Any, data: Any, first: Any, stride: Any, weights: Any, out: Any, at: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            table, start, step, factors, target, place = args
            rows = []
            for row in range(4):
                where = (
                    start if row == 0 else builder.add(start, builder.mul(step, ir.Constant(step.type, row)))
                )
                rows.append(
                    builder.load(
                        _vector_at(context, builder, signature.args[0], table, where, width), align=8
                    )
                )
            for part in range(sums):
                total = None
                for row in range(4):
                    factor = _spread(builder, builder.extract_value(factors, 4 * part + row), width)
                    product = builder.fmul(rows[row], factor, flags=FAST)
                    total = product if total is None else builder.fadd(total, product, flags=FAST)
                to = builder.add(place, ir.Constant(place.type, part * width))
                pointer = _vector_at(context, builder, signature.args[4], target, to, width)
                if add:
                    total = builder.fadd(total, builder.load(pointer, align=8), flags=FAST)
                builder.store(total, pointer, align=8)
            return context.get_dummy_value()

        return types.void(data, first, stride, weights, out, at), codegen

    return intrinsic(contract)


contract_cell: Any = _contraction(8, 2, add=False)
"""contract_cell(data, first, stride, weights, out, at): write 8 values and behind them 8 slopes of a cell."""
contract_lines: Any = _contraction(4, 2, add=False)
"""The same of 4 values and 4 slopes."""
contract_first: Any = _contraction(4, 1, add=False)
"""contract_first(data, first, stride, weights, out, at): write 4 values."""
add_lines: Any = _contraction(4, 1, add=True)
"""add_lines(data, first, stride, weights, out, at): add 4 values."""
