"""Potential contact points of a gear pair over one mesh cycle: tooth pairs x face positions, gaps and directions."""

from dataclasses import dataclass
from math import ceil, cos, floor, tan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.flank import Flank
from dynamics.gear.pair import GearPair
from dynamics.tooth.corner import ContactPlace, Profiles, TipEnd, contact_places, settled, tip_ends
from dynamics.tooth.pair_gap import PairGap, path_reach

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


# Positions over the common face width at which the teeth may touch, and how many of them are enough.

LEAST_POSITIONS = 11
"""Positions over a face whose gap or place on the path varies."""
PER_OVERLAP = 12
"""Positions for every base pitch by which a helical face lags from end to end, the overlap ratio."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FaceGrid:
    """Positions over the face and the width that each stands for; lengths [m].

    position : (n,) from mid-face, growing
    width : (n,) of its share of the face, the integral of its hat function
    """

    position: Array
    width: Array

    def __post_init__(self) -> None:
        if self.position.shape != self.width.shape or self.position.ndim != 1 or not len(self.position):
            raise DynamicsInputError(
                f"face grid: position {self.position.shape} and width {self.width.shape} must be of one length, "
                "at least 1"
            )
        if not (np.all(np.diff(self.position) > 0.0) and np.all(self.width > 0.0)):
            raise DynamicsInputError(
                "face grid: positions must grow and widths be positive; sort the positions"
            )

    @classmethod
    def over(cls, face_width: float, n: int) -> "FaceGrid":
        """Return n even positions from end to end of the face, the ends standing for half a step; 1: its middle."""
        if n < 1 or not face_width > 0.0:
            raise DynamicsInputError(f"n = {n} positions over {face_width} m of face: both must be positive")
        if n == 1:
            return cls(position=np.zeros(1), width=np.array([face_width]))
        return cls.at(np.linspace(-0.5 * face_width, 0.5 * face_width, n))

    @classmethod
    def at(cls, position: Array) -> "FaceGrid":
        """Return the grid of at least two given positions (n,), the outer ones on the ends of the face [m]."""
        steps = np.diff(position)
        return cls(position=position, width=0.5 * (np.append(steps, 0.0) + np.insert(steps, 0, 0.0)))

    @property
    def face_width(self) -> float:
        """Width of the face [m]."""
        return float(self.width.sum())


def default_positions(pair: GearPair, *, gap_varies: bool) -> int:
    """Positions over the face after which largest line load and transmission error change by less than 1 %.

    gap_varies : the gap or the compliance changes over the face. One position is exact for a spur gear of which
    neither does; see ``tests/unit/dynamics_package/tooth/test_face.py`` for the rule.
    """
    if pair.helix_angle == 0.0 and not gap_varies:
        return 1
    return max(LEAST_POSITIONS, ceil(PER_OVERLAP * abs(pair.overlap_ratio)) + 1)


class FlankGap(Protocol):
    """Gap that the flanks add at potential contact points, along the transverse line of action.

    Tooth pair p follows pair p - 1 into mesh; it joins pinion tooth p and wheel tooth p, as they come into mesh.
    """

    def __call__(self, pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        """Return the gap, growing with metal removed [m]; all arrays of one shape.

        pair, face, path : tooth pair, position from mid-face and path position, which goes beyond the path [m]
        rolls : where the point lies on the flanks of pinion and wheel [m]; beyond the path not on the line of action
        """


def no_gap(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
    """Gap of ideal flanks of equal base pitch."""
    return np.zeros_like(path)


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactPoints:
    """Potential contact points; arrays (n_positions, n_pairs, n_face) unless said otherwise.

    position : (n_positions,) path position of tooth pair 0 at mid-face [m]
    pairs : (n_pairs,) numbers of the tooth pairs
    path : path position that each point sees [m]
    place : where and in which direction it touches
    gap : approach at which it touches, flanks included; inf for points out of reach [m]
    weight : closing of the gap along the normal per approach [-]
    tips : ends of both flanks
    reach : approach up to which no point is missing [m]
    """

    pair: GearPair
    grid: FaceGrid
    position: Array
    pairs: Integers
    path: Array
    place: ContactPlace
    gap: Array
    weight: Array
    tips: tuple[TipEnd, TipEnd]
    reach: float

    @property
    def sliding(self) -> Array:
        """Speed of the pinion flank over the wheel's, towards the pinion tip, per speed of the pinion [m].

        Friction on the pinion acts against it, along the tangent of the flanks, normal to the force, with the levers
        ``place.reach``; at a corner this is the tangent of the mating flank.
        """
        first, second = self.place.reach
        return np.asarray(first - second / self.pair.gear_ratio)


def contact_points(
    pair: GearPair,
    grid: FaceGrid,
    *,
    gap: FlankGap = no_gap,
    tips: tuple[TipEnd, TipEnd] | None = None,
    n_positions: int = 64,
    beyond: int = 0,
    reach: float,
) -> ContactPoints:
    """Points of all tooth pairs that touch under an approach up to ``reach`` [m], over one base pitch.

    gap : of the flanks, see ``FlankGap``; tips : ends of the flanks, None: those of the pair
    beyond : further positions ahead of the pitch and behind it, at the same distance

    Raises DynamicsInputError for a reach or number of positions that is not positive, or a gap that is not finite.
    """
    if n_positions < 1 or not reach > 0.0:
        raise DynamicsInputError(f"n_positions = {n_positions} and reach = {reach} m must be positive")
    first, last = path_reach(pair, reach)
    pitch, lag = pair.base_pitch, grid.position * tan(pair.base_helix_angle)
    position = pair.path.start + pitch * np.arange(-beyond, n_positions + beyond) / n_positions
    lowest = floor((position[0] - lag.max() - last) / pitch)
    highest = ceil((position[-1] - lag.min() - first) / pitch)
    pairs = np.arange(lowest, highest + 1)
    path = position[:, None, None] - pitch * pairs[:, None] - lag
    inside = (path >= first) & (path <= last)
    used = np.any(inside, axis=(0, 2))
    pairs, path, inside = pairs[used], path[:, used], inside[:, used]
    ends = tip_ends(pair) if tips is None else tips
    place = contact_places(pair, np.clip(path, first, last), ends)
    numbers = np.broadcast_to(pairs[:, None], path.shape)
    face = np.broadcast_to(grid.position, path.shape)

    def removed(rolls: tuple[Array, Array]) -> Array:
        return gap(numbers, face, path, rolls)

    added = np.zeros_like(path)
    if gap is not no_gap:
        place, added = settled(Profiles(pair=pair, place=place, tips=ends), removed)
    if not np.all(np.isfinite(added[inside])):
        raise DynamicsInputError("gap of the flanks is not finite within reach; let it go on beyond the path")
    total = place.gap + added
    weight = cos(pair.base_helix_angle) * place.lever[1] / pair.base_radii[1]
    return ContactPoints(
        pair=pair,
        grid=grid,
        position=position,
        pairs=pairs,
        path=path,
        place=place,
        gap=np.where(inside, total, np.inf),
        weight=weight,
        tips=ends,
        reach=reach,
    )


# Gap of flanks with modifications, deviations and misalignment, as the contact asks for it.
#
# Beyond the path a tip corner touches the mating flank away from the line of action; the metal removed there is that of
# the places that touch.


def modified_gap(gap: PairGap, flank: Flank = "front") -> FlankGap:
    """What modifications, axes and unequal base pitches of a pair leave between its flanks, all teeth alike.

    flank : on which the pair runs. A gear turned about a tooth axis by half a turn is the same gear with its back
        flanks in front and its face turned round: the face positions of the contact then count against z.
    """
    sense = face_sense(flank)

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        pinion, wheel = gap.flanks
        place = sense * face
        return (
            gap.of_axes(path, place, flank)
            + pinion.modification(rolls[0], place, flank)
            + wheel.modification(rolls[1], place, flank)
        )

    return of_points


def face_sense(flank: Flank) -> float:
    """Face position z of the gears per face position of the contact: 1 on the front flanks, -1 on the back flanks."""
    return 1.0 if flank == "front" else -1.0


def flank_gap(gap: PairGap) -> FlankGap:
    """The same with the deviations of single teeth."""
    modified = modified_gap(gap)

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        pinion, wheel = gap.flanks
        return (
            modified(pair, face, path, rolls)
            + pinion.deviation(rolls[0], face, pair)
            + wheel.deviation(rolls[1], face, pair + wheel.count.tooth_offset_2)
        )

    return of_points
