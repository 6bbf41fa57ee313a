"""One flank of a contact table: sums over its slices, as cubics over the depth and splines over the path.

The knots of the splines are uniform, a whole number of cells in a base pitch, so that all pairs of a flank stand at the
same place within their cells. Layout: ``dynamics.kernels.contact_table``.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import spline_filter1d

from dynamics.kernels.contact_nodes import FRICTION, SUMS, NodeLaw, SliceSprings
from dynamics.mesh.contact_samples import PADDING, FlankGrid, flank_samples
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]

USUAL_DEPTH = 10e-6
"""Depth at which the share of a slice in the force weighs the deviations of its teeth [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FlankTable:
    """Spline coefficients over the path of one flank.

    start : path position of the first cell [m]; pairs : base pitches that the path takes
    gaps : (n_knots,) of the least gap [m]; cells : (n_planes, n_cells, n_knots, CELL)
    moments : (n_planes, n_cells, n_knots, LINES); closing : (n_planes, n_cells, n_knots, 2 LINES)
    friction : (n_planes, n_levels, n_cells, n_knots, 2 LINES)
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
    samples = flank_samples(law, node_law, grid)
    energy, force, weight, moment, moment_x, *damper = (samples.sums[..., i] for i in range(SUMS))
    depths, none = grid.depths, np.zeros(0)

    def lines(*tables: Array) -> Array:
        """Cells (..., n_cells, n_knots, 2 n_tables): values and slopes of all tables over the depth."""
        return _along(np.concatenate([_lines(table, depths) for table in tables], axis=-1), grid.pairs)

    cells = (_cubics(energy, force, depths), _lines(weight, depths), _lines(samples.force - force, depths))
    sums_at = range(SUMS, samples.sums.shape[-1], FRICTION)
    friction = [lines(*_levers(node_law, force, samples.sums[..., i : i + FRICTION])) for i in sums_at]
    return FlankTable(
        start=samples.start,
        pairs=samples.pitches if grid.pairs else 1,
        gaps=splines(samples.gap, grid.pairs),
        cells=_along(np.concatenate(cells, axis=-1), grid.pairs),
        moments=_along(_cubics(moment, moment_x, depths), grid.pairs) if len(grid.tilts) > 1 else none,
        friction=np.stack(friction, axis=1) if friction else none,
        closing=lines(*damper) if node_law.path_speed else none,
        path=samples.springs.path,
        share=_shares(samples.springs, samples.gap),
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


def _along(cells: Array, pairs: bool) -> Array:
    """Splines over the path of cells (n_planes, n_places, n_cells, n), returned as (n_planes, n_cells, n_knots, n).

    What is next on the path stands next in memory.
    """
    return np.ascontiguousarray(np.stack([splines(plane, pairs).swapaxes(0, 1) for plane in cells]))


def _shares(springs: SliceSprings, gap: Array) -> Array:
    """Share of each slice in the force at a usual depth (n_places, n_slices)."""
    force = springs.stiffness * np.maximum(gap[:, None] + USUAL_DEPTH - springs.gap, 0.0)
    total = force.sum(axis=1, keepdims=True)
    return np.where(total > 0.0, force / np.where(total > 0.0, total, 1.0), 1.0 / force.shape[1])


def _levers(law: NodeLaw, force: Array, moments: Array) -> list[Array]:
    """Lever of friction on both gears, of the force over its direction of sliding (..., n_depths) [m].

    moments : (..., n_depths, FRICTION) sums of ``slice_sums``. Then what the levers gain per advance of the reversal
    [-]. Where nothing is pressed they are those of the least depth at which something is.
    """
    pressed = force > 1e-6 * force.max()
    first = np.argmax(pressed, axis=-1)[..., None]
    at = np.maximum(np.arange(force.shape[-1]), first)
    found = []
    for k in (0, 2):
        share, place = (
            np.take_along_axis(
                np.where(pressed, moments[..., k + i] / np.where(pressed, force, 1.0), 0.0), at, axis=-1
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
    """Cells (..., n_cells, 4) from energy and force at the depths: W, F, slope and square term of F."""
    width = np.diff(depths)
    rise, first, last = np.diff(energy) / width, force[..., :-1], force[..., 1:]
    square = (3.0 * rise - 2.0 * first - last) / width
    cube = (first + last - 2.0 * rise) / width**2
    return np.stack((energy[..., :-1], first, 2.0 * square, 3.0 * cube), axis=-1)


def _lines(values: Array, depths: Array) -> Array:
    """Cells (..., n_cells, 2): value and slope over the depth."""
    return np.stack((values[..., :-1], np.diff(values) / np.diff(depths)), axis=-1)
