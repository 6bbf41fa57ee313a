"""A study over two inputs as a map: which check limits where, and where one fails.

Between computed points every margin is taken as linear in both inputs, in the unit of its check; names on an axis are
cells of their own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.margins.table import MarginTable, StudyAxis
from rigdesign.studies.result import StudyPoint

FINE = 320
"""Places along each axis at which the map is evaluated."""


@dataclass(frozen=True, kw_only=True)
class GridPoint:
    """A computed combination of both inputs; ``fails`` at any value of the other inputs."""

    x: float
    y: float
    fails: bool
    failed: bool
    """No result at some value of the other inputs."""


@dataclass(frozen=True, kw_only=True)
class RegionMap:
    """What limits where, on a fine grid.

    x, y : fine positions, shapes (nx,) and (ny,)
    limiting : column of the limiting check, -1 where there is no result, shape (ny, nx)
    fails : whether it fails there, shape (ny, nx)
    margin : smallest margin [%], NaN without a result, shape (ny, nx)
    distance : smallest margin of the checks that fail anywhere, each over its own largest; zero at the border of the
        pass region, shape (ny, nx); all NaN where no check fails
    points : the computed combinations
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    limiting: NDArray[np.intp]
    fails: NDArray[np.bool_]
    margin: NDArray[np.float64]
    distance: NDArray[np.float64]
    points: tuple[GridPoint, ...]


def region_map(
    axes: tuple[StudyAxis, StudyAxis], points: Sequence[StudyPoint], table: MarginTable
) -> RegionMap | None:
    """The map over two inputs at the worst of all others; None where the points are no grid over them."""
    across, up = axes
    if min(len(across.texts), len(up.texts)) < 2 or len(across.texts) * len(up.texts) > len(points):
        return None
    rows = _rows(across, up, points)
    if any(len(found) == 0 for found in rows.values()):
        return None
    grid = _OnGrid(across, up, rows, table)
    x, weights_x = _fine(across)
    y, weights_y = _fine(up)
    shape = len(y), len(x)
    fails, limiting = np.zeros(shape, dtype=bool), np.full(shape, -1)
    smallest, distance = np.full(shape, np.inf), np.full(shape, np.inf)

    def spread(values: NDArray[np.float64]) -> NDArray[np.float64]:
        """From the grid to the fine grid; NaN where a value that counts is missing."""
        known = np.isfinite(values)
        found = weights_y @ np.where(known, values, 0.0).T @ weights_x.T
        return np.where(weights_y @ known.T.astype(float) @ weights_x.T > 1.0 - 1e-9, found, np.nan)

    for column in range(len(table.checks)):
        own, margin = spread(grid.own[:, :, column]), spread(grid.margin[:, :, column])
        may_fail = bool(grid.fails[:, :, column].any())
        broken = (own < 0.0) & may_fail
        margin = np.where(broken, np.minimum(margin, 0.0), np.maximum(margin, 0.0) if may_fail else margin)
        with np.errstate(invalid="ignore"):
            nearer = np.where(broken == fails, margin < smallest, broken)
        smallest, limiting = np.where(nearer, margin, smallest), np.where(nearer, column, limiting)
        fails = fails | broken
        if may_fail:
            largest = float(np.nanmax(np.abs(grid.own[:, :, column]))) or 1.0
            distance = np.fmin(distance, own / largest)
    known = weights_y @ grid.computed.T.astype(float) @ weights_x.T > 1.0 - 1e-9
    return RegionMap(
        x=x,
        y=y,
        limiting=np.where(known, limiting, -1),
        fails=fails & known,
        margin=np.where(known & np.isfinite(smallest), smallest, np.nan),
        distance=np.where(known & np.isfinite(distance), distance, np.nan),
        points=grid.points,
    )


def _rows(across: StudyAxis, up: StudyAxis, points: Sequence[StudyPoint]) -> dict[tuple[int, int], list[int]]:
    """Numbers of the points at every combination of both inputs."""
    place_x = {text: place for place, text in enumerate(across.texts)}
    place_y = {text: place for place, text in enumerate(up.texts)}
    rows: dict[tuple[int, int], list[int]] = {(i, j): [] for i in place_x.values() for j in place_y.values()}
    for number, point in enumerate(points):
        rows[place_x[point.values[across.path]], place_y[point.values[up.path]]].append(number)
    return rows


class _OnGrid:
    """Margins at the worst of the other inputs, shapes (x, y, checks)."""

    def __init__(
        self, across: StudyAxis, up: StudyAxis, rows: dict[tuple[int, int], list[int]], table: MarginTable
    ) -> None:
        shape = len(across.texts), len(up.texts), len(table.checks)
        self.own, self.margin = np.full(shape, np.nan), np.full(shape, np.nan)
        self.fails, self.computed = np.zeros(shape, dtype=bool), np.zeros(shape[:2], dtype=bool)
        points = []
        for (i, j), numbers in rows.items():
            self.own[i, j] = np.fmin.reduce(table.own[numbers], axis=0)
            self.margin[i, j] = np.fmin.reduce(table.margin[numbers], axis=0)
            self.fails[i, j] = table.fails[numbers].any(axis=0)
            self.computed[i, j] = table.computed[numbers].any()
            points.append(
                GridPoint(
                    x=across.positions[i],
                    y=up.positions[j],
                    fails=bool(self.fails[i, j].any()),
                    failed=not bool(table.computed[numbers].all()),
                )
            )
        self.points = tuple(points)


def _fine(axis: StudyAxis) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Fine positions and the weights of the values at each, shape (fine, values)."""
    count = len(axis.positions)
    if not axis.numeric:
        x = np.linspace(-0.5, count - 0.5, FINE + 1)
        x = 0.5 * (x[1:] + x[:-1])
        return x, (np.abs(x[:, None] - np.arange(count)) < 0.5).astype(float)
    at = np.asarray(axis.positions)
    x = np.linspace(at[0], at[-1], FINE)
    return x, np.column_stack([np.interp(x, at, unit) for unit in np.eye(count)])
