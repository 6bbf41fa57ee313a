"""Contact tables of mesh laws: smooth potentials that replace the sums over slices.

A mesh whose teeth are all alike has one potential over its phase, shared bodies included; with single teeth every pair
has one over its path, and the deviations of its two teeth move it: by a constant exactly, by what varies over the path
in the mean of the slices that carry, by a run-out as that stands at the rotation of its gear. Layout and use:
``dynamics.kernels.contact_table``.

The tables take the law as it is: cubics of Fritsch and Carlson over the path, slices that touch one by one. For a march
whose steps do not resolve all of the path they are filtered (``dynamics.tooth.contact_samples``).
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import spline_filter1d

from dynamics.errors import DynamicsInputError
from dynamics.kernels import contact_table as layout
from dynamics.kernels.contact_table import FRICTION, SUMS, ContactTables, NodeLaw, SliceSprings
from dynamics.kernels.integrator_state import aligned
from dynamics.tooth.contact_samples import PADDING, RESOLVED, FlankGrid, PathFilter, flank_samples
from dynamics.tooth.law import MeshLaw, back_deviations, check_mesh_law, law_content
from dynamics.tooth.packed_laws import has_individual_teeth
from thermal.fe.kept_results import kept_as

# One flank of a contact table: sums over its slices, as cubics over the depth and splines over the path.
#
# The knots of the splines are uniform, a whole number of cells in a base pitch, so that all pairs of a flank stand at
# the same place within their cells. Layout: ``dynamics.kernels.contact_table``.

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


Integers = NDArray[np.int64]

LEAST_REACH = 20e-6
"""Least depth of a table [m]."""
MOST_REACH = 200e-6
"""Greatest depth of a table; beyond it the last cell goes on [m]."""
LEVELS = 8
"""Sharpnesses of the reversal of sliding at which friction is tabulated."""
SHARPEST, BLUNTER = 1.5, 2.2
"""Cells over which friction reverses at the highest of them, and their ratio."""


@dataclass(frozen=True, kw_only=True)
class TableGrid:
    """Steps of contact tables.

    per_pitch : cells in a base pitch
    finest : first step over the depth [m]; growth : of the steps per depth
    tilts : least and greatest tilt of the faces, gap that closes per face width [rad]; None: they stay as they are
    planes : tilts that are tabulated between them, at least 2
    """

    per_pitch: int = 128
    finest: float = 0.125e-6
    growth: float = 0.02
    tilts: tuple[float, float] | None = None
    planes: int = 5

    def __post_init__(self) -> None:
        if self.per_pitch < 8 or not self.finest > 0.0 or not self.growth >= 0.0:
            raise DynamicsInputError(
                f"contact table: per_pitch = {self.per_pitch} must be at least 8, finest = {self.finest} m above 0, "
                f"growth = {self.growth} not negative"
            )
        if self.tilts is not None and not (self.tilts[0] < self.tilts[1] and self.planes >= 2):
            raise DynamicsInputError(
                f"contact table: tilts = {self.tilts} rad must rise and planes = {self.planes} be at least 2"
            )

    @property
    def planes_at(self) -> Array:
        """Tilts that are tabulated (n_planes,) [rad]."""
        return np.zeros(1) if self.tilts is None else np.linspace(*self.tilts, self.planes)


@dataclass(frozen=True, kw_only=True)
class MarchStep:
    """March that tables are made for: step [s], speed of each pinion [rad/s].

    What the steps do not resolve is filtered out; dampers on the closing rate of contacts are those of this speed.
    """

    step: float
    speeds: tuple[float, ...]


DEFAULT_GRID = TableGrid()


@dataclass(frozen=True, kw_only=True, eq=False)
class _MeshTables:
    """Arrays of one mesh, as in ``ContactTables`` of the same names."""

    gaps: Array
    cells: Array
    moments: Array
    depths: Array
    cell_of: Integers
    friction: Array
    levels: Array
    closing: Array
    deviations: Array
    scales: Array


FIRST_ENTRIES = {
    "gaps": layout.C_GAPS_AT, "cells": layout.C_CELLS_AT, "moments": layout.C_MOMENTS_AT,
    "depths": layout.C_DEPTHS_AT, "cell_of": layout.C_CELL_OF_AT, "friction": layout.C_FRICTION_AT,
    "levels": layout.C_LEVELS_AT, "closing": layout.C_CLOSING_AT, "deviations": layout.C_DEVIATIONS_AT,
    "scales": layout.C_SCALES_AT,
}  # fmt: skip


def contact_tables(
    laws: Sequence[MeshLaw],
    grid: TableGrid = DEFAULT_GRID,
    march: MarchStep | None = None,
    *,
    derivative_torques: bool = True,
) -> ContactTables:
    """Return the contact tables of all ``laws``.

    march : filters what its steps do not resolve; None keeps all
    derivative_torques : False leaves out the torques from the change of the potential over the path: the negative
        control of the energy test, of no other use

    Tables met before are handed out again: nobody may write into them.

    Raises
    ------
    ValueError
        If a law is impossible (see ``check_mesh_law``), as DynamicsInputError if it knows no face positions for tilt.
    """
    key = (_tables, tuple(map(law_content, laws)), grid, march, derivative_torques)
    return kept_as(key, lambda: _tables(laws, grid, march, derivative_torques))


def _tables(
    laws: Sequence[MeshLaw], grid: TableGrid, march: MarchStep | None, derivative_torques: bool
) -> ContactTables:
    counts = np.zeros((len(laws), layout.N_TABLE_COUNTS), np.int64)
    values = np.zeros((len(laws), layout.N_TABLE_VALUES))
    parts: list[_MeshTables] = []
    for mesh, law in enumerate(laws):
        check_mesh_law(law)
        depths = _depths(law, grid)
        path_speed = 0.0 if march is None else law.base_radius_1 * march.speeds[mesh]
        along = PathFilter(step=path_speed * march.step) if march else None
        if along is not None and not along.acts_on(law.base_pitch):
            along = None
        own = grid if along is None else replace(grid, per_pitch=along.cells(law.base_pitch, grid.per_pitch))
        levels = _levels(law, own, march if along else None)
        closes = law.damping_acts_on == "contact_closing_rate"
        # a helical flank lags the other way on the back, and what moves along its path moves backwards there
        signs = (1.0, -1.0) if np.any(law.slice_shift) or along or (closes and path_speed) else (1.0,)
        flanks = [
            flank_table(
                law,
                _node_law(law, levels, sign * path_speed if closes else 0.0),
                FlankGrid(
                    sign=sign,
                    pairs=has_individual_teeth(law),
                    per_pitch=own.per_pitch,
                    depths=depths,
                    tilts=grid.planes_at,
                    path_filter=PathFilter(step=sign * along.step) if along else None,
                ),
            )
            for sign in signs
        ]
        part = _mesh_tables(law, flanks, depths, levels, grid)
        for name, column in FIRST_ENTRIES.items():
            counts[mesh, column] = sum(getattr(before, name).size for before in parts)
        _fill_counts(counts[mesh], law, flanks, own, part)
        _fill_values(values[mesh], law, flanks, own, depths)
        parts.append(part)
    values[:, layout.V_DERIVATIVE] = derivative_torques
    return ContactTables(
        values=values,
        counts=counts,
        offsets=np.array([law.offset for law in laws], float),
        **{
            field.name: _joined([getattr(part, field.name) for part in parts])
            for field in fields(_MeshTables)
        },
    )


def _joined(tables: list[Any]) -> Any:
    whole = np.concatenate(tables)
    return aligned(whole) if whole.dtype == np.float64 else whole


def _node_law(law: MeshLaw, levels: Array, path_speed: float) -> NodeLaw:
    return NodeLaw(
        damping_depth=law.damping_depth,
        body=_tabulated_body(law),
        rolling_radii=(law.rolling_radius_1, law.rolling_radius_2),
        reversal=_reversal(law),
        damp_time=_damp_time(law),
        path_speed=path_speed,
        sharpness=levels if law.friction > 0.0 and not _is_spur(law) else np.zeros(0),
    )


def _levels(law: MeshLaw, grid: TableGrid, march: MarchStep | None) -> Array:
    """Slopes of the direction of sliding over the path at which friction is tabulated (n_levels,) [1/m].

    Tables that are filtered for a march are of high speeds, and leave out what is for lower ones.
    """
    sharpest = grid.per_pitch / (SHARPEST * law.base_pitch)
    found = sharpest / BLUNTER ** np.arange(LEVELS, dtype=float)[::-1]
    if march is None:
        return np.asarray(found)
    slowest = law.base_pitch / (RESOLVED * march.step)
    both = slowest * (1.0 / law.base_radius_1 + 1.0 / law.base_radius_2)
    least = both / max(law.friction_reversal_speed, 1e-9)
    return np.asarray(found[max(0, min(int(np.searchsorted(found, least)), LEVELS - 1) - 1) :])


def _is_spur(law: MeshLaw) -> bool:
    """Whether the law has single teeth whose slices all stand at the same place on the path."""
    return has_individual_teeth(law) and not np.any(law.slice_shift)


def _damp_time(law: MeshLaw) -> float:
    """Damping of the teeth over their stiffness, shared bodies left out [s]."""
    return law.damping * (1.0 - law.body_compliance * law.mean_stiffness) / law.mean_stiffness


def _tabulated_body(law: MeshLaw) -> float:
    """Compliance of the shared bodies that the tables take in [m/N].

    Not that of single teeth, whose pairs have tables each, nor where the body may press both flanks at once.
    """
    front, back = (law.deviation_1, law.deviation_2), back_deviations(law)
    least = float(law.gap.min()) + min(float(one.min() + two.min()) for one, two in (front, back))
    jammed = law.backlash + 2.0 * least < 0.0
    return 0.0 if has_individual_teeth(law) or jammed else law.body_compliance


def _reversal(law: MeshLaw) -> float:
    """Path position where flanks that roll off steadily do not slide [m]: the pitch point of consistent radii."""
    ratio = law.base_radius_1 / law.base_radius_2
    return (ratio * law.rolling_radius_2 - law.rolling_radius_1) / (1.0 + ratio)


def _depths(law: MeshLaw, grid: TableGrid) -> Array:
    """First depth of every cell, and the last depth, in multiples of the finest step [m].

    Tilted faces touch before their least gap is closed.
    """
    reach = float(np.minimum(law.gap[:, 0], law.gap[:, -1]).min() - law.gap.min())
    last = min(max(reach, LEAST_REACH), MOST_REACH)
    ahead = 0.0
    if grid.tilts is not None:
        if law.slice_face is None:
            raise DynamicsInputError(
                "contact table: a law without slice_face knows no tilt; give the face positions"
            )
        ahead = float(np.abs(np.outer(grid.planes_at, law.slice_face)).max())
    steps = [0]
    while steps[-1] * grid.finest < last:
        steps.append(steps[-1] + max(1, round(1.0 + grid.growth * steps[-1])))
    before = -np.cumsum(np.diff(steps))
    before = before[: int(np.searchsorted(-before * grid.finest, ahead)) + 1] if ahead > 0.0 else before[:0]
    return np.concatenate((before[::-1], steps)) * grid.finest


def _mesh_tables(
    law: MeshLaw, flanks: list[FlankTable], depths: Array, levels: Array, grid: TableGrid
) -> _MeshTables:
    finest = depths[0] + np.arange(round((depths[-1] - depths[0]) / grid.finest)) * grid.finest
    none = np.zeros(0)
    return _MeshTables(
        gaps=np.concatenate([flank.gaps for flank in flanks]),
        cells=np.concatenate([flank.cells.ravel() for flank in flanks]),
        moments=np.concatenate([flank.moments.ravel() for flank in flanks]),
        depths=depths,
        cell_of=(np.searchsorted(depths, finest + 0.5 * grid.finest) - 1).astype(np.int64),
        friction=np.concatenate([flank.friction.ravel() for flank in flanks]),
        levels=levels,
        closing=np.concatenate([flank.closing.ravel() for flank in flanks]),
        deviations=_deviations(law, flanks).ravel() if has_individual_teeth(law) else none,
        scales=np.concatenate((law.scale_1, law.scale_2)).astype(float),
    )


def _deviations(law: MeshLaw, flanks: list[FlankTable]) -> Array:
    """Gap that every tooth adds (2, teeth_1 + teeth_2, n_knots) [m], front and back; (..., 1) if it never varies."""
    sides = ((law.deviation_1, law.deviation_2), back_deviations(law))
    teeth = law.teeth_1, law.teeth_2
    every = [
        np.concatenate([np.broadcast_to(table, (z, table.shape[1])) for table, z in zip(side, teeth)])
        for side in sides
    ]
    if all(np.ptp(table, axis=1).max() == 0.0 for table in every):
        return np.array(every)[..., :1]
    grid = law.path_start + law.path_step * np.arange(law.stiffness.shape[1])
    turning = np.zeros((2, *every[0].shape)) if law.turning_deviation is None else law.turning_deviation
    found = []
    for table, turned, flank, sign in zip(every, turning, (flanks[0], flanks[-1]), (1.0, -1.0)):
        at = np.clip(flank.path, grid[0], grid[-1])
        of_slices = PchipInterpolator(grid, table - turned, axis=1)(at)
        own = np.einsum("tki,ki->kt", of_slices, flank.share)
        if np.any(turned):
            # every slice stands at the rotation of the gear, that of the middle of the face
            middle = flank.path[:, 0] + sign * law.slice_shift[0]
            own += CubicSpline(grid, turned, axis=1)(middle).T
        found.append(splines(own, pairs=True).T)
    return np.array(found)


def _fill_counts(
    counts: Integers, law: MeshLaw, flanks: list[FlankTable], grid: TableGrid, part: _MeshTables
) -> None:
    individual = has_individual_teeth(law)
    teeth = law.teeth_1 + law.teeth_2
    for column, count in (
        (layout.C_PER_PITCH, grid.per_pitch), (layout.C_PAIRS, flanks[0].pairs),
        (layout.C_KNOTS, flanks[0].cells.shape[2]), (layout.C_CELLS, len(part.depths) - 1),
        (layout.C_FINEST, len(part.cell_of)), (layout.C_BACK, len(flanks) - 1), (layout.C_INDIVIDUAL, individual),
        (layout.C_OFFSET_2, law.tooth_offset_2), (layout.C_TEETH_1, law.teeth_1), (layout.C_TEETH_2, law.teeth_2),
        (layout.C_PER_TOOTH, part.deviations.size // (2 * teeth)), (layout.C_SCALED_1, len(law.scale_1)),
        (layout.C_SCALED_2, len(law.scale_2)), (layout.C_PLANES, len(flanks[0].cells)),
        (layout.C_LEVELS, len(part.levels)), (layout.C_GENERAL, individual or len(flanks[0].cells) > 1),
    ):  # fmt: skip
        counts[column] = count


def _fill_values(
    values: Array, law: MeshLaw, flanks: list[FlankTable], grid: TableGrid, depths: Array
) -> None:
    front, back = (law.deviation_1, law.deviation_2), back_deviations(law)
    least = float(law.gap.min()) + min(float(one.min() + two.min()) for one, two in (front, back))
    body = law.body_compliance - _tabulated_body(law)
    for column, value in (
        (layout.V_R1, law.base_radius_1), (layout.V_R2, law.base_radius_2), (layout.V_PER_PITCH, 1.0 / law.base_pitch),
        (layout.V_ORIGIN, law.phase - flanks[0].start), (layout.V_BACK_ORIGIN, law.back_phase - flanks[-1].start),
        (layout.V_BACKLASH, law.backlash), (layout.V_DAMP_TIME, _damp_time(law)), (layout.V_BODY, body),
        (layout.V_PER_FINEST, 1.0 / grid.finest), (layout.V_LOWEST, depths[0]),
        # a body can bring both flanks into contact at once
        (layout.V_LEAST_GAP, -np.inf if body > 0.0 else least + depths[0]),
        (layout.V_PER_KNOT, grid.per_pitch / law.base_pitch), (layout.V_FRICTION, law.friction),
        (layout.V_ROLL_1, law.rolling_radius_1), (layout.V_ROLL_2, law.rolling_radius_2),
        (layout.V_PER_REVERSAL, 1.0 / max(law.friction_reversal_speed, 1e-9)),
        (layout.V_CLOSING, float(flanks[0].closing.size > 0)),
        (layout.V_FLOOR, 1e-12 * law.mean_stiffness * law.base_radius_1),
        (layout.V_TILT, 0.0 if grid.tilts is None else grid.tilts[0]),
        (layout.V_MU_1, law.friction / law.base_radius_1), (layout.V_MU_2, law.friction / law.base_radius_2),
        (layout.V_HALF_PITCH, 0.5 * law.base_pitch), (layout.V_REVERSAL, _reversal(law)),
        (layout.V_START, flanks[0].start), (layout.V_BACK_START, flanks[-1].start),
        (layout.V_SPUR, float(_is_spur(law))), (layout.V_TABULATED_BODY, law.body_compliance - body),
        (layout.V_PER_TILT, 0.0 if grid.tilts is None else (grid.planes - 1) / (grid.tilts[1] - grid.tilts[0])),
    ):  # fmt: skip
        values[column] = value
