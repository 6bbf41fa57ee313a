"""Gap of every place of every tooth pair: flanks of both gears, axes, expansion, corners beyond the path."""

from dataclasses import dataclass
from functools import lru_cache
from math import cos

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.flank import (
    AT_PITCH_POINT,
    PARALLEL,
    AxisMisalignment,
    Flank,
    FlankField,
    TeethInMesh,
    require_whole_flanks,
)
from dynamics.gear.microgeometry import Microgeometry
from dynamics.gear.pair import GearPair

Array = NDArray[np.float64]


FLAWLESS = (Microgeometry(), Microgeometry())


@dataclass(frozen=True, kw_only=True)
class PairGap:
    """Gap of the unloaded teeth of a pair along the transverse line of action, from pinion and wheel [m].

    flanks : of pinion and wheel; axes : how far these are from parallel

    Pair p, path position and teeth are those of ``dynamics.tooth.law``: on the front flanks pair p joins pinion tooth p
    with wheel tooth p + tooth_offset_2, on the back with the one after it; a path position on the back flanks is that
    of the mirrored path. A helical face position z sees its own path position, s - z tan(beta_b) of the pair's in
    front and s + z tan(beta_b) on the back.
    """

    pair: GearPair
    flanks: tuple[FlankField, FlankField]
    axes: AxisMisalignment = PARALLEL

    @classmethod
    def of_pair(
        cls,
        pair: GearPair,
        micro: tuple[Microgeometry, Microgeometry] = FLAWLESS,
        axes: AxisMisalignment = PARALLEL,
        count: TeethInMesh = AT_PITCH_POINT,
    ) -> "PairGap":
        """Gap of a pair with whole flanks.

        Raises GearGeometryError for pointed teeth and undercut within the path, DynamicsInputError for a
        micro-geometry that does not fit.
        """
        require_whole_flanks(pair)
        return cls(pair=pair, flanks=flank_fields(pair, micro, count), axes=axes)

    def at(self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front") -> Array:
        """Gap along the transverse line of action [m]; the shapes of the arguments are broadcast.

        path : position on the path from the pitch point, also beyond its ends [m]; face : from mid-face [m];
        pair_number : any integer
        """
        places = np.atleast_1d(np.asarray(path, dtype=np.float64))
        corner = tip_separation(self.pair, places.ravel()).reshape(np.shape(path))
        return (
            corner + self.modifications(path, face, flank) + self.deviations(path, face, pair_number, flank)
        )

    def normal(
        self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front"
    ) -> Array:
        """Gap along the normal of the flanks [m], cos(beta_b) of that along the transverse line of action."""
        return cos(self.pair.base_helix_angle) * self.at(path, face, pair_number, flank)

    def modifications(self, path: ArrayLike, face: ArrayLike, flank: Flank = "front") -> Array:
        """What every tooth pair has on the active path: modifications, misalignment, difference of base pitches [m].

        Gears of unequal thermal expansion keep the ratio of their tooth numbers; the difference of their base pitches
        becomes a gap along the path.
        """
        gap = self.of_axes(path, face, flank)
        for gear in self.flanks:
            gap = gap + gear.modification(gear.roll(path), face, flank)
        return np.asarray(gap)

    def of_axes(self, path: ArrayLike, face: ArrayLike, flank: Flank = "front") -> Array:
        """Misalignment and difference of base pitches [m]."""
        front, back = self.axes.gap_slope(self.pair)
        gap = np.asarray(path) * self.pair.base_pitch_difference / self.pair.base_pitch
        return np.asarray(gap + (front if flank == "front" else back) * np.asarray(face))

    def deviations(
        self, path: ArrayLike, face: ArrayLike, pair_number: ArrayLike, flank: Flank = "front"
    ) -> Array:
        """What the two teeth of a pair have beyond the others [m]."""
        pinion, wheel = self.flanks
        first = np.asarray(pair_number, dtype=np.int64)
        second = first + wheel.count.tooth_offset_2 + (flank == "back")
        return pinion.deviation(pinion.roll(path), face, first, flank) + wheel.deviation(
            wheel.roll(path), face, second, flank
        )


def flank_fields(
    pair: GearPair, micro: tuple[Microgeometry, Microgeometry], count: TeethInMesh = AT_PITCH_POINT
) -> tuple[FlankField, FlankField]:
    """Flanks of pinion and wheel; raises DynamicsInputError for a micro-geometry that does not fit."""
    return (
        FlankField(pair=pair, index=0, micro=micro[0], count=count),
        FlankField(pair=pair, index=1, micro=micro[1], count=count),
    )


# Separation of a tooth pair beyond the ends of its path, where only a tip corner could touch.
#
# Before A the wheel's tip corner faces the pinion flank, beyond E the pinion's tip corner the wheel flank. The
# gap is the approach along the line of action at which they would meet; it grows from zero with the square
# of the distance to the end of the path, so that loaded, deflected teeth enter and leave the mesh smoothly
# (premature engagement). Derived from the involutes of both gears, no small-angle approximation; an undercut
# flank ends in a corner too, which is treated alike. A tip edge is taken as the sharp corner at which it begins.


@dataclass(frozen=True, kw_only=True)
class CornerMesh:
    """A corner of one gear and the flank of the other; lengths [m].

    base, reach : base radius of the corner's gear, distance of its base tangent point from the pitch point
    flank_base : base radius of the gear that owns the flank
    """

    corner_radius: float
    base: float
    reach: float
    flank_base: float
    centre_distance: float

    def opening(self, path: Array) -> Array:
        """Gap [m], shape of ``path``, at the path position of the corner's gear, growing to its tip [m].

        The corner's gear stands still, the flank turns towards it: arc on the base circle of the flank.
        """
        base_angle = _involute_roll(self.reach / self.base)
        corner = base_angle + path / self.base - _involute_at(self.corner_radius, self.base)
        x = self.centre_distance - self.corner_radius * np.cos(corner)
        y = self.corner_radius * np.sin(corner)
        radius = np.maximum(np.hypot(x, y), self.flank_base)
        flank = path / self.flank_base - base_angle + _involute_at(radius, self.flank_base)
        return np.asarray(self.flank_base * (flank - np.arctan2(y, x)))

    def opening_seen_from_flank(self, path: Array) -> Array:
        """The same gap at the path position of the flank's gear.

        Closing the gap x turns the corner's gear against the flank's by x, so that its own position is
        ``path`` + x; solved by iteration to 1e-12 m.
        """
        gap = self.opening(path)
        for _ in range(100):
            change = self.opening(path + gap) - gap
            gap = gap + change
            if float(np.max(np.abs(change), initial=0.0)) < 1e-12:
                break
        return gap


def _involute_roll(roll: Array | float) -> Array:
    """Involute function of the flank point with the roll angle tan(alpha) = ``roll`` [rad]."""
    return np.asarray(roll - np.arctan(roll))


def _involute_at(radius: Array | float, base: float) -> Array:
    """Involute function of the flank point at ``radius`` [m]."""
    return _involute_roll(np.sqrt(np.maximum(np.asarray(radius) ** 2 - base**2, 0.0)) / base)


@dataclass(frozen=True, kw_only=True)
class _End:
    """One end of the path: where it is [m], the corner that could touch beyond it, and whether the wheel owns it."""

    place: float
    corner: CornerMesh
    of_wheel: bool

    def gap(self, path: Array) -> Array:
        """Gap [m] beyond the end, shape of ``path``, which follows the rotation of the pinion."""
        return self.corner.opening_seen_from_flank(-path) if self.of_wheel else self.corner.opening(path)

    def open_by(self, path: Array, gap: float) -> NDArray[np.bool_]:
        """Whether `gap` has grown to a gap [m]: the corner stays clear of the flank until it is closed by as much."""
        position = gap - path if self.of_wheel else path
        return np.asarray(self.corner.opening(position) >= gap)


def _before(pair: GearPair) -> _End:
    limits, pinion = pair.path, pair.gears[0]
    if pinion.undercut and limits.start > limits.tip_start:
        return _End(place=limits.start, corner=_corner(pair, 0, pinion.form_radius), of_wheel=False)
    return _End(place=limits.tip_start, corner=_corner(pair, 1, pair.flanks[1].tip_radius), of_wheel=True)


def _after(pair: GearPair) -> _End:
    limits, wheel = pair.path, pair.gears[1]
    if wheel.undercut and limits.end < limits.tip_end:
        return _End(place=limits.end, corner=_corner(pair, 1, wheel.form_radius), of_wheel=True)
    return _End(place=limits.tip_end, corner=_corner(pair, 0, pair.flanks[0].tip_radius), of_wheel=False)


def tip_separation(pair: GearPair, path: Array) -> Array:
    """Gap [m], shape of ``path``, of an unmodified tooth pair: zero on its active path, growing outside.

    ``path`` [m] counts from the pitch point to the pinion tip and follows the rotation of the pinion.
    """
    start, end = _before(pair), _after(pair)
    gap = np.zeros_like(path)
    before, after = path < start.place, path > end.place
    gap[before], gap[after] = start.gap(path[before]), end.gap(path[after])
    return gap


def _corner(pair: GearPair, owner: int, radius: float) -> CornerMesh:
    return CornerMesh(
        corner_radius=radius,
        base=pair.base_radii[owner],
        reach=pair.rolling_radii[owner],
        flank_base=pair.base_radii[1 - owner],
        centre_distance=pair.centre_distance,
    )


@lru_cache(maxsize=4096)
def path_reach(pair: GearPair, gap: float) -> tuple[float, float]:
    """Path positions [m] before and beyond the active path where the tip separation has grown to ``gap`` [m].

    At most two base pitches beyond each end, and short of the base tangent points. A rounded tip edge touches before
    the corner where it begins, by a tenth of the gap for a radius of a ninth of the module: the path is longer by it.
    """
    if not gap > 0.0:
        raise DynamicsInputError(
            f"gap = {gap} m must be positive; give the largest approach that the teeth may see"
        )
    rounding = max(details.tip_edge.rounding for details in pair.details)
    gap = gap * (1.0 + 3.0 * rounding / pair.normal_module)
    path, steps = pair.path, np.linspace(0.0, 2.0 * pair.base_pitch, 801)[1:]
    inner = path.tangent_1 * 0.999 - path.start
    before = _before(pair).open_by(path.start + np.maximum(-steps, inner), gap)
    outer = path.tangent_2 * 0.999 - path.end
    after = _after(pair).open_by(path.end + np.minimum(steps, outer), gap)
    return (
        max(path.start - _first(steps, before), path.tangent_1 * 0.999),
        min(path.end + _first(steps, after), path.tangent_2 * 0.999),
    )


def _first(steps: Array, enough: NDArray[np.bool_]) -> float:
    places = np.flatnonzero(enough)
    return float(steps[places[0]] if len(places) else steps[-1])
