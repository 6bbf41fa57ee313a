"""Sums over the slices of a flank at places on its path and depths, filtered over the path where a march asks for it.

The sums are kept: a march asks for the same ones with another filter whenever its speed has changed.
"""

from dataclasses import dataclass
from math import ceil
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from dynamics.kernels.contact_table import FRICTION, SUMS, NodeLaw, SliceSprings, slice_sums
from dynamics.tooth.law import MeshLaw, law_content
from thermal.fe.kept_results import kept_as

Array = NDArray[np.float64]


# Low-pass over the path that keeps a march free of aliasing.
#
# A march sees a mesh at the ends of its steps only. Teeth that come in and out excite far above half the step rate: at
# 12,000 rpm and eight steps in 25 us, every sixteenth of their harmonics stands just beside the step rate and would act
# as a slow force. Here the potential of a mesh loses what the steps do not resolve before it is tabulated; it stays a
# potential. The force of the unfiltered law is kept beside it, to be recorded.
#
# The march holds the torque within a step by Numerov's method (`dynamics.vibration.propagator`). The table anticipates
# what that makes of each of its harmonics (``hold_response``).
#
# Source: Shannon 1949; Numerov's method as in Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I,
# III.10.

KEPT, LOST = 0.3, 0.7
"""Cycles in a step up to which all is kept, and from which all is lost."""
RESOLVED = 128
"""Steps in a base pitch with which a march needs no filter: what is left of the next harmonics does not matter."""
LEAST_CELLS = 128
"""Cells of a filtered base pitch, for the force that is recorded."""
TAIL = 4.0
"""Steps that a filtered pair reaches beyond its path."""


@dataclass(frozen=True, kw_only=True)
class PathFilter:
    """Low-pass of a flank that moves along its path.

    step : path that the flank takes in a step of the march, with its direction [m]
    """

    step: float

    def response(self, cycles: NDArray[np.floating[Any]]) -> Array:
        """Factor of parts of the potential that have so many cycles per path [1/m]."""
        per_step = cycles * self.step
        kept = np.clip((np.abs(per_step) - KEPT) / (LOST - KEPT), 0.0, 1.0)
        shares = np.cos(0.5 * np.pi * kept) ** 2
        return np.asarray(shares / hold_response(np.clip(per_step, -0.5, 0.5)))

    def acts_on(self, pitch: float) -> bool:
        """Whether teeth with this base pitch come in and out faster than the steps resolve [m]."""
        return abs(self.step) * RESOLVED > pitch

    def cells(self, pitch: float, most: int) -> int:
        """Cells of a base pitch [m] that hold what is left, three to its shortest wave, at ``most``."""
        wanted = 8 * ceil(3.0 * LOST * pitch / abs(self.step) / 8.0)
        return min(max(wanted, LEAST_CELLS), most)


def hold_response(cycles: Array) -> Array:
    """What the hold of the march makes of an oscillation with so many cycles in a step: displacement of a free mass
    over the exact one, 1 for slow ones.

    Numerov's x_1 - 2 x_0 + x_-1 = h^2 / 12 (f_1 + 10 f_0 + f_-1) with f = cos(theta n), exact -f / omega^2.
    """
    angle = np.maximum(2.0 * np.pi * np.abs(cycles), 1e-3)
    return np.asarray(angle**2 * (10.0 + 2.0 * np.cos(angle)) / (24.0 * (1.0 - np.cos(angle))))


# Slices of a mesh law as springs at any place on the path, by the cubics of ``dynamics.tooth.packed_laws``.


def slice_springs(law: MeshLaw, path: Array, sign: float, pitches: int = 1, *, beyond: bool) -> SliceSprings:
    """Slices of a pair, and of those that follow it within so many base pitches, at its path positions (n,) [m].

    sign : +1 in front, -1 on the back
    beyond : whether slices go on beyond the ends of the path, opening as there, or carry nothing
    """
    n_slices, n_path = law.stiffness.shape
    lag = sign * law.slice_shift
    grid = law.path_start + law.path_step * np.arange(n_path)
    place = path[:, None] - np.tile(lag, pitches) + law.base_pitch * np.repeat(np.arange(pitches), n_slices)
    inside = np.clip(place, grid[0], grid[-1])
    out = place - inside
    stiffness, gap, slope = np.empty(place.shape), np.empty(place.shape), np.empty(place.shape)
    for row in range(n_slices):
        opening = PchipInterpolator(grid, law.gap[row])
        positions = inside[:, row::n_slices]
        stiffness[:, row::n_slices] = PchipInterpolator(grid, law.stiffness[row])(positions)
        slope[:, row::n_slices] = opening(positions, 1)
        gap[:, row::n_slices] = opening(positions) + np.abs(out[:, row::n_slices] * slope[:, row::n_slices])
    if not beyond:
        stiffness[np.abs(out) > 1e-9 * law.path_step] = 0.0
    face = np.zeros(n_slices) if law.slice_face is None else np.asarray(law.slice_face, float)
    return SliceSprings(stiffness=stiffness, gap=gap, slope=slope, path=place, face=np.tile(face, pitches))


ComplexArray = NDArray[np.complex128]

PADDING = 8
"""Cells beyond the ends of the path of a pair, which keep its splines free of them."""
FINER = 4
"""Samples of a cell before a filter."""


@dataclass(frozen=True, kw_only=True, eq=False)
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


class FlankSamples(NamedTuple):
    """A flank at the starts of the cells of its path.

    start : path position of the first cell [m]; pitches : base pitches that the path takes
    gap : (n_places,) least gap [m]; sums : (n_planes, n_places, n_depths, n_sums) of ``slice_sums``
    force : (n_planes, n_places, n_depths) of the unfiltered law [N]; springs : the slices there
    """

    start: float
    pitches: int
    gap: Array
    sums: Array
    force: Array
    springs: SliceSprings


class _Sums(NamedTuple):
    """The same, FINER in a cell, with the sums over cycles per path instead of places."""

    unfiltered: FlankSamples
    spectrum: ComplexArray
    places: int


def flank_samples(law: MeshLaw, node_law: NodeLaw, grid: FlankGrid) -> FlankSamples:
    """Sum the slices of one flank of a law."""
    if grid.path_filter is None:
        return _sample(law, node_law, grid, 1, 0)
    # quarters of a pitch, so that the sums of one speed serve others
    pitch = law.base_pitch
    beyond = ceil(4.0 * TAIL * abs(grid.path_filter.step) / pitch) * grid.per_pitch // 4 if grid.pairs else 0
    key = (
        _sums, law_content(law),
        grid.sign, grid.pairs, grid.per_pitch, grid.depths.tobytes(), grid.tilts.tobytes(), beyond, node_law.path_speed,
        node_law.sharpness.tobytes(),
    )  # fmt: skip
    unfiltered, spectrum, places = kept_as(key, lambda: _sums(law, node_law, grid, beyond))
    cycles = np.fft.rfftfreq(places, pitch / grid.per_pitch / FINER)
    response = grid.path_filter.response(cycles)
    known = np.flatnonzero(response)[-1] + 1
    response = response[:known, None, None]
    used = _used(grid, node_law, spectrum.shape[-1])
    sums = np.zeros((len(spectrum), len(range(0, places, FINER)), *spectrum.shape[2:]))
    sums[..., used] = np.fft.irfft(spectrum[:, :known][..., used] * response, places, axis=1)[:, ::FINER]
    return unfiltered._replace(sums=sums)


def _sums(law: MeshLaw, node_law: NodeLaw, grid: FlankGrid, beyond: int) -> _Sums:
    samples = _sample(law, node_law, grid, FINER, beyond)
    return _Sums(samples._replace(sums=np.zeros(0)), np.fft.rfft(samples.sums, axis=1), samples.sums.shape[1])


def _used(grid: FlankGrid, node_law: NodeLaw, count: int) -> NDArray[np.int64]:
    """Which of the sums of ``slice_sums`` a table takes: those of tilt and of closing dampers only where there are
    such."""
    used = np.ones(count, bool)
    used[3:5] = len(grid.tilts) > 1
    used[5:SUMS] = node_law.path_speed != 0.0
    return np.flatnonzero(used)


def _sample(law: MeshLaw, node_law: NodeLaw, grid: FlankGrid, finer: int, beyond: int) -> FlankSamples:
    """Sum the slices at ``finer`` places in a cell, as many cells beyond the ends of the path of a pair."""
    lag = grid.sign * law.slice_shift
    length = law.path_step * (law.stiffness.shape[1] - 1) + float(np.ptp(lag))
    width = law.base_pitch / grid.per_pitch
    start = law.path_start + float(lag.min()) - beyond * width
    pitches = ceil((length + 2.0 * beyond * width) / law.base_pitch - 1e-9)
    if grid.pairs:
        cells = np.arange(-PADDING * finer, (pitches * grid.per_pitch + PADDING) * finer + 1) / finer
    else:
        cells = np.arange(grid.per_pitch * finer) / finer
    # the splines of a pair that touches at the ends of its path go on there
    goes_on = grid.pairs and finer == 1 and not np.any(lag)
    springs = slice_springs(
        law, start + width * cells, grid.sign, 1 if grid.pairs else pitches, beyond=goes_on
    )
    gap = _least_gap(springs)
    if finer > 1:
        gap = np.full(len(gap), gap.min())
    sums = np.empty((len(grid.tilts), len(gap), len(grid.depths), SUMS + FRICTION * len(node_law.sharpness)))
    for tilt, plane in zip(grid.tilts, sums):
        slice_sums(
            springs._replace(gap=springs.gap - tilt * springs.face),
            node_law,
            gap[:, None] + grid.depths,
            plane,
        )
    coarse = springs._replace(**{name: getattr(springs, name)[::finer] for name in springs._fields[:-1]})
    return FlankSamples(start, pitches, gap[::finer], sums, sums[:, ::finer, :, 1].copy(), coarse)


def _least_gap(springs: SliceSprings) -> Array:
    """Least gap of the slices that carry (n_places,) [m]; where there are none that of the nearest place."""
    gap = np.where(springs.stiffness > 0.0, springs.gap, np.inf).min(axis=1)
    known = np.flatnonzero(np.isfinite(gap))
    return np.asarray(np.interp(np.arange(len(gap)), known, gap[known]))
