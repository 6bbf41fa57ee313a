"""One flank of a contact table: sums over its slices, as cubics over the depth and splines over the path.

The knots of the splines are uniform, a whole number of cells in a base pitch, so that all pairs of a flank stand at the
same place within their cells. Layout: ``dynamics.kernels.contact_table``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import spline_filter1d

from dynamics.kernels.contact_nodes import SUMS, SliceSprings, Sliding, slice_sums
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

PADDING = 8
"""Cells beyond the ends of the path of a pair, which keep its splines free of them."""
USUAL_DEPTH = 10e-6
"""Depth at which the share of a slice in the force weighs the deviations of its teeth [m]."""


@dataclass(frozen=True, kw_only=True)
class FlankGrid:
    """Where a flank is tabulated.

    sign : +1 in front, -1 on the back; pairs : True for the potential of single pairs, False for that of the mesh
    per_pitch : cells in a base pitch; depths : (n_cells + 1,) first depth of each cell, and the last [m]
    sharpness : (n_levels,) of the reversal of sliding [1/m]; reversal : path position where it stands [m]
    tilts : (n_planes,) [rad]
    """

    sign: float
    pairs: bool
    per_pitch: int
    depths: Array
    sharpness: Array
    reversal: float
    tilts: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class FlankTable:
    """Spline coefficients over the path of one flank.

    start : path position of the first cell [m]; pairs : base pitches that the path takes
    gaps : (n_knots,) of the least gap [m]; cells : (n_planes, n_knots, n_cells, CELL)
    weights, closing : (n_planes, n_knots, n_cells, PAIR); friction : (n_planes, n_levels, n_knots, n_cells, PAIR)
    path, share : (n_places, n_slices) path position of each slice at the knots [m], and its share in the force
    """

    start: float
    pairs: int
    gaps: Array
    cells: Array
    weights: Array
    friction: Array
    closing: Array
    path: Array
    share: Array


def flank_table(law: MeshLaw, grid: FlankGrid) -> FlankTable:
    """Tabulate one flank of a law."""
    lag = grid.sign * law.slice_shift
    length = law.path_step * (law.stiffness.shape[1] - 1)
    start = law.path_start + float(lag.min())
    pairs = int(np.ceil((length + float(np.ptp(lag))) / law.base_pitch - 1e-9))
    width = law.base_pitch / grid.per_pitch
    slices = np.arange(len(lag))
    if grid.pairs:
        path = start + width * np.arange(-PADDING, pairs * grid.per_pitch + PADDING + 1)
        springs = slice_springs(law, path[:, None] - lag, slices, beyond=not np.any(lag))
    else:
        path = start + width * np.arange(grid.per_pitch)
        behind = law.base_pitch * np.repeat(np.arange(pairs), len(lag))
        springs = slice_springs(
            law, path[:, None] - np.tile(lag, pairs) + behind, np.tile(slices, pairs), beyond=False
        )
    gap = _least_gap(springs)
    planes = [
        _plane(springs._replace(gap=springs.gap - tilt * springs.face), law, gap, grid) for tilt in grid.tilts
    ]
    cells, weights, closing, friction = (np.array(kind) for kind in zip(*planes))
    return FlankTable(
        start=start,
        pairs=pairs if grid.pairs else 1,
        gaps=splines(gap, grid.pairs),
        cells=cells,
        weights=weights,
        friction=friction,
        closing=closing,
        path=springs.path,
        share=_shares(springs, gap),
    )


def _plane(
    springs: SliceSprings, law: MeshLaw, gap: Array, grid: FlankGrid
) -> tuple[Array, Array, Array, Array]:
    """Cells, damper weights, closing weights and friction of slices at one tilt, as in ``FlankTable``."""
    sums = np.empty((len(gap), len(grid.depths), SUMS + 2 * len(grid.sharpness)))
    sliding = Sliding(grid.reversal, grid.sharpness)
    slice_sums(springs, gap[:, None] + grid.depths, law.damping_depth, sliding, sums)
    energy, force, weight, moment, moment_x = (sums[..., i] for i in range(5))
    cells = np.concatenate(
        (_cubics(energy, force, grid.depths), _cubics(moment, moment_x, grid.depths)), axis=-1
    )
    lines = [
        np.concatenate([_lines(one, grid.depths) for one in pair], axis=-1)
        for pair in (
            (weight, 0.0 * weight),
            *((sums[..., i], sums[..., i + 1]) for i in range(5, sums.shape[2], 2)),
        )
    ]
    weights, closing, *friction = (splines(one, grid.pairs) for one in lines)
    return splines(cells, grid.pairs), weights, closing, np.array(friction)


def slice_springs(law: MeshLaw, path: Array, slices: Integers, *, beyond: bool) -> SliceSprings:
    """Slices of a law at path positions (n_places, n_slices) [m], ``slices`` (n_slices,) naming their rows.

    beyond : whether they go on beyond the ends of the path, opening as there, or carry nothing
    """
    n_slices, n_path = law.stiffness.shape
    grid = law.path_start + law.path_step * np.arange(n_path)
    inside = np.clip(path, grid[0], grid[-1])
    out = path - inside
    shape = path.shape
    stiffness, gap, slope = np.empty(shape), np.empty(shape), np.empty(shape)
    for row in np.unique(slices):
        own = slices == row
        opening = PchipInterpolator(grid, law.gap[row])
        at = inside[:, own]
        stiffness[:, own] = PchipInterpolator(grid, law.stiffness[row])(at)
        slope[:, own] = opening(at, 1)
        gap[:, own] = opening(at) + np.abs(out[:, own] * slope[:, own])
    if not beyond:
        stiffness[np.abs(out) > 1e-9 * law.path_step] = 0.0
    face = (np.zeros(n_slices) if law.slice_face is None else np.asarray(law.slice_face, float))[slices]
    return SliceSprings(stiffness=stiffness, gap=gap, slope=slope, path=path, face=face)


def splines(samples: Array, pairs: bool) -> Array:
    """Coefficients (n_knots, ...) of uniform cubic B-splines through samples (n_places, ...) at the starts of cells.

    Of a mesh they are periodic; those of a pair have PADDING cells before and behind.
    """
    if pairs:
        found = spline_filter1d(samples, 3, axis=0, mode="mirror")
        return np.asarray(found[PADDING - 1 : len(found) - PADDING + 1])
    found = spline_filter1d(samples, 3, axis=0, mode="grid-wrap") if len(samples) > 1 else samples
    return np.asarray(found[np.arange(-1, len(found) + 2) % len(found)])


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
