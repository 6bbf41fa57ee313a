"""Flanks of a mesh that are held at their place on the path within one step of the march."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, inlined
from dynamics.kernels.contact_table import (
    C_GENERAL,
    V_BACKLASH,
    V_LEAST_GAP,
    V_PER_KNOT,
    V_R1,
    ContactTables,
)
from dynamics.kernels.hold_path import FlankState, Sliding, hold_path
from dynamics.kernels.hold_phase import Place, hold_phase, place_of
from dynamics.kernels.mesh_tables import POSITIVE
from dynamics.kernels.mesh_workspace import (
    ANGLE,
    APART,
    FRACTION,
    HELD_ANGLE,
    HIGH,
    LEAN,
    LOW,
    LOWER,
    OTHER_BACK,
    OTHER_FRONT,
    TEETH,
    TURN,
    UPPER,
)

# compiled from sources 815a2749
Array = NDArray[np.float64]
Integers = NDArray[np.int64]


NEAR = 0.2
"""Share of a cell by which the path may be off the place at which rows are held."""


class HeldRows(NamedTuple):
    """Rows of the flanks that are held on their path."""

    rows: Array
    """Flat, per mesh and flank room for all of its pairs, then room that tilt needs."""
    counts: Integers
    """(n_meshes, 2) rows that are in use."""
    first: Integers
    """(n_meshes, 2) first entry."""
    levels: Integers
    """(n_meshes,) level of friction in this sample, see ``hold_path.Sliding``."""
    cells: Integers
    """(n_meshes, 2) cells of the last rows."""
    sides: Integers
    """(n_meshes,) flank that is held first: 0 in front, 1 on the back, 2 none."""
    knots: Integers
    """(n_meshes,) knot of its place on the path."""


@inlined
def _front_begins(space: Array, at: int, values: Array, m: int) -> float:
    """Return the approach of the teeth above which flanks in front may touch."""
    return float(values[m, V_LEAST_GAP] - space[at + OTHER_FRONT] * space[at + APART])


@inlined
def _back_begins(space: Array, at: int, values: Array, m: int) -> float:
    """Return the approach of the teeth below which flanks on the back may touch."""
    return float(space[at + OTHER_BACK] * space[at + APART] - values[m, V_BACKLASH] - values[m, V_LEAST_GAP])


@inlined
def find_place(
    tables: ContactTables, space: Array, at: int, m: int, held: HeldRows, angle: float, teeth: float
) -> None:
    """Find the flank of a mesh that touches at an angle of the pinion and an approach of the teeth, and its place."""
    values = tables.values
    front = teeth > _front_begins(space, at, values, m)
    back = teeth < _back_begins(space, at, values, m)
    side = 0 if front else 1
    space[at + HELD_ANGLE], space[at + TEETH] = angle, teeth
    held.sides[m] = side if front or back else 2
    place = place_of(tables, m, side, angle)
    held.knots[m], space[at + FRACTION] = place.knot, place.fraction


@inlined
def hold_mesh(tables: ContactTables, space: Array, at: int, m: int, held: HeldRows) -> None:
    """Hold the flanks of a mesh that touch at the place that was found."""
    values = tables.values
    least, turning = _front_begins(space, at, values, m), _back_begins(space, at, values, m)
    closer = space[at + OTHER_FRONT] * space[at + APART]
    back = space[at + OTHER_BACK] * space[at + APART] - values[m, V_BACKLASH]
    side, teeth = held.sides[m], space[at + TEETH]
    held.counts[m, 0], held.counts[m, 1] = 0, 0
    low, high = turning, least
    if side < 2:
        sliding = Sliding(held.levels[m], space[at + LOWER], space[at + UPPER])
        first = held.first[m, side] & POSITIVE
        reach = teeth + closer if side == 0 else back - teeth
        if tables.counts[m, C_GENERAL] == 0:
            place = Place(held.knots[m], space[at + FRACTION])
            rows = hold_phase(tables, m, side, place, sliding, reach, held.cells, held.rows, first)
        else:
            state = FlankState(side, space[at + HELD_ANGLE], 0.0)
            rows = hold_path(tables, m, state, sliding, reach, held.rows, first)
        held.counts[m, side] = rows.n
        if side == 0:
            low, high = rows.low - closer, rows.high - closer
            low = low if teeth < turning or low > turning else turning
        else:
            low, high = back - rows.high, back - rows.low
            high = high if high < least else least
    space[at + LOW], space[at + HIGH] = low, high
    if side == 0 and teeth < turning:
        _hold_back(tables, space, at, m, held, teeth)


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _hold_back(tables: ContactTables, space: Array, at: int, m: int, held: HeldRows, teeth: float) -> None:
    """Hold the back flank of a mesh whose front flank is held."""
    back = space[at + OTHER_BACK] * space[at + APART] - tables.values[m, V_BACKLASH]
    sliding = Sliding(held.levels[m], space[at + LOWER], space[at + UPPER])
    state = FlankState(1, space[at + HELD_ANGLE], 0.0)
    rows = hold_path(tables, m, state, sliding, back - teeth, held.rows, held.first[m, 1] & POSITIVE)
    held.counts[m, 1] = rows.n
    # no longer from where the back flank begins to touch on
    space[at + LOW] = max(space[at + LOW] if space[at + LOW] > teeth - 1.0 else -np.inf, back - rows.high)
    space[at + HIGH] = min(space[at + HIGH], back - rows.low)


@inlined
def is_held(space: Array, at: int, values: Array, m: int) -> bool:
    """Return whether the held rows of a mesh are good at the approach and the angle that it reaches."""
    beside = values[m, V_R1] * (
        space[at + ANGLE] + space[at + TURN] + space[at + LEAN] - space[at + HELD_ANGLE]
    )
    near = abs(beside) * values[m, V_PER_KNOT] < NEAR
    return bool(near and space[at + LOW] <= space[at + TEETH] <= space[at + HIGH])
