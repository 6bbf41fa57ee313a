"""One flank of a contact table: sums over its slices, as cubics over the depth and splines over the path.

The knots of the splines are uniform, a whole number of cells in a base pitch, so that all pairs of a flank stand at the
same place within their cells. Layout: ``dynamics.kernels.contact_table``.
"""

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import spline_filter1d

from dynamics.kernels.contact_nodes import FRICTION, SUMS, NodeLaw, SliceSprings, slice_sums
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.path_filter import TAIL, PathFilter
from dynamics.mesh.slice_springs import slice_springs

Array = NDArray[np.float64]

PADDING = 8
"""Cells beyond the ends of the path of a pair, which keep its splines free of them."""
FINER = 4
"""Samples of a cell before a filter."""
USUAL_DEPTH = 10e-6
"""Depth at which the share of a slice in the force weighs the deviations of its teeth [m]."""


@dataclass(frozen=True, kw_only=True)
class FlankGrid:
    """Where a flank is tabulated.

    sign : +1 in front, -1 on the back; pairs : True for the potential of single pairs, False for that of the mesh
    per_pitch : cells in a base pitch; depths : (n_cells + 1,) first depth of each cell, and the last [m]
    tilts : (n_planes,) [rad]; path_filter : None where the march resolves all of the path
    """

    sign: float
    pairs: bool
    per_pitch: int
    depths: Array
    tilts: Array
    path_filter: PathFilter | None


@dataclass(frozen=True, kw_only=True, eq=False)
class FlankTable:
    """Spline coefficients over the path of one flank.

    start : path position of the first cell [m]; pairs : base pitches that the path takes
    gaps : (n_knots,) of the least gap [m]; cells : (n_planes, n_cells, n_knots, CELL)
    moments, closing : (n_planes, n_cells, n_knots, LINES); friction : (n_planes, n_levels, n_cells, n_knots, 2 LINES)
    path, share : (n_places, n_slices) path position of each slice at the knots [m], and its share in the force
    """

    start: float
    pairs: int
    gaps: Array
    cells: Array
    moments: Array
    friction: Array
    closing: Array
    path: Array
    share: Array


def flank_table(law: MeshLaw, node_law: NodeLaw, grid: FlankGrid) -> FlankTable:
    """Tabulate one flank of a law."""
    filtered = grid.path_filter is not None
    beyond = _beyond(law, grid) if grid.pairs else 0
    lag = grid.sign * law.slice_shift
    length = law.path_step * (law.stiffness.shape[1] - 1) + float(np.ptp(lag))
    width = law.base_pitch / grid.per_pitch
    start = law.path_start + float(lag.min()) - beyond * width
    pitches = ceil((length + 2.0 * beyond * width) / law.base_pitch - 1e-9)
    finer = FINER if filtered else 1
    if grid.pairs:
        cells = np.arange(-PADDING * finer, (pitches * grid.per_pitch + PADDING) * finer + 1) / finer
    else:
        cells = np.arange(grid.per_pitch * finer) / finer
    # the splines of a pair that touches at the ends of its path go on there
    goes_on = grid.pairs and not filtered and not np.any(lag)
    springs = slice_springs(
        law, start + width * cells, grid.sign, 1 if grid.pairs else pitches, beyond=goes_on
    )
    gap = _least_gap(springs)
    if filtered:
        gap = np.full(len(gap), gap.min())
    # cell by cell: what is next along the path stands next in memory
    kinds = [
        _plane(springs._replace(gap=springs.gap - tilt * springs.face), node_law, gap, grid, width)
        for tilt in grid.tilts
    ]
    tables = (np.array(kind) for kind in zip(*kinds))
    cells, moments, closing, friction = (
        np.ascontiguousarray(table.swapaxes(-3, -2)) if table.ndim > 2 else table for table in tables
    )
    return FlankTable(
        start=start,
        pairs=pitches if grid.pairs else 1,
        gaps=splines(gap[::finer], grid.pairs),
        cells=cells,
        moments=moments,
        friction=friction,
        closing=closing,
        path=springs.path[::finer],
        share=_shares(springs, gap)[::finer],
    )


def splines(samples: Array, pairs: bool) -> Array:
    """Coefficients (n_knots, ...) of uniform cubic B-splines through samples (n_places, ...) at the starts of cells.

    Of a mesh they are periodic; those of a pair have PADDING cells before and behind.
    """
    if pairs:
        found = spline_filter1d(samples, 3, axis=0, mode="mirror")
        return np.asarray(found[PADDING - 1 : len(found) - PADDING + 1])
    found = spline_filter1d(samples, 3, axis=0, mode="grid-wrap") if len(samples) > 1 else samples
    return np.asarray(found[np.arange(-1, len(found) + 2) % len(found)])


def _beyond(law: MeshLaw, grid: FlankGrid) -> int:
    """Cells that a filtered pair reaches beyond the ends of its path."""
    if grid.path_filter is None:
        return 0
    return ceil(TAIL * abs(grid.path_filter.step) * grid.per_pitch / law.base_pitch)


def _plane(
    springs: SliceSprings, law: NodeLaw, gap: Array, grid: FlankGrid, cell: float
) -> tuple[Array, Array, Array, Array]:
    """Cells, moments, closing weights and friction of slices at one tilt, as in ``FlankTable``; ``cell`` in metres."""
    sums = np.empty((len(gap), len(grid.depths), SUMS + FRICTION * len(law.sharpness)))
    slice_sums(springs, law, gap[:, None] + grid.depths, sums)
    recorded = sums[..., 1]
    if grid.path_filter is not None:
        recorded = recorded[::FINER]
        sums = _low_pass(sums, grid, cell)
    energy, force, weight, moment, moment_x = (sums[..., i] for i in range(5))
    depths = grid.depths
    cells = (_cubics(energy, force, depths), _lines(weight, depths), _lines(recorded - force, depths))
    linear = [[sums[..., 5], sums[..., 6]]]
    linear += [_levers(law, force, sums[..., i : i + FRICTION]) for i in range(SUMS, sums.shape[2], FRICTION)]
    closing, *friction = (
        splines(np.concatenate([_lines(one, depths) for one in kind], axis=-1), grid.pairs) for kind in linear
    )
    moments = splines(_cubics(moment, moment_x, depths), grid.pairs) if len(grid.tilts) > 1 else np.zeros(0)
    return splines(np.concatenate(cells, axis=-1), grid.pairs), moments, closing, np.array(friction)


def _low_pass(samples: Array, grid: FlankGrid, cell: float) -> Array:
    """Filter samples (n_places, ...), FINER in a ``cell`` [m], over the path and keep those at the starts of cells."""
    assert grid.path_filter is not None
    n = len(samples)
    cycles = np.fft.rfftfreq(n, cell / FINER)
    kept = grid.path_filter.response(cycles).reshape(-1, *(1,) * (samples.ndim - 1))
    return np.fft.irfft(np.fft.rfft(samples, axis=0) * kept, n, axis=0)[::FINER]


def _least_gap(springs: SliceSprings) -> Array:
    """Least gap of the slices that carry (n_places,) [m]; where there are none that of the nearest place."""
    gap = np.where(springs.stiffness > 0.0, springs.gap, np.inf).min(axis=1)
    known = np.flatnonzero(np.isfinite(gap))
    return np.asarray(np.interp(np.arange(len(gap)), known, gap[known]))


def _shares(springs: SliceSprings, gap: Array) -> Array:
    """Share of each slice in the force at a usual depth (n_places, n_slices)."""
    force = springs.stiffness * np.maximum(gap[:, None] + USUAL_DEPTH - springs.gap, 0.0)
    total = force.sum(axis=1, keepdims=True)
    return np.where(total > 0.0, force / np.where(total > 0.0, total, 1.0), 1.0 / force.shape[1])


def _levers(law: NodeLaw, force: Array, moments: Array) -> list[Array]:
    """Lever of friction on both gears, of the force over its direction of sliding (n_places, n_depths) [m].

    moments : (n_places, n_depths, FRICTION) sums of ``slice_sums``. Then what the levers gain per advance of the
    reversal [-]. Where nothing is pressed they are those of the least depth at which something is.
    """
    pressed = force > 1e-6 * force.max()
    first = np.argmax(pressed, axis=1)[:, None]
    at = np.maximum(np.arange(force.shape[1]), first)
    found = []
    for k in (0, 2):
        share, place = (
            np.take_along_axis(
                np.where(pressed, moments[..., k + i] / np.where(pressed, force, 1.0), 0.0), at, axis=1
            )
            for i in (0, 1)
        )
        for radius, sign in zip(law.rolling_radii, (1.0, -1.0)):
            lever = radius * share + sign * place
            # a trace of force that a filter leaves beside the path has no lever of its own
            most = 2.0 * np.quantile(np.abs(lever), 0.99)
            found.append(np.clip(lever, -most, most))
    return found


def _cubics(energy: Array, force: Array, depths: Array) -> Array:
    """Cells (n_places, n_cells, 4) from energy and force at the depths: W, F, slope and square term of F."""
    width = np.diff(depths)
    rise, first, last = np.diff(energy) / width, force[:, :-1], force[:, 1:]
    square = (3.0 * rise - 2.0 * first - last) / width
    cube = (first + last - 2.0 * rise) / width**2
    return np.stack((energy[:, :-1], first, 2.0 * square, 3.0 * cube), axis=-1)


def _lines(values: Array, depths: Array) -> Array:
    """Cells (n_places, n_cells, 2): value and slope over the depth."""
    return np.stack((values[:, :-1], np.diff(values) / np.diff(depths)), axis=-1)
