"""Potential contact points of a gear pair over one mesh cycle: tooth pairs x face positions, gaps and directions."""

from dataclasses import dataclass
from math import ceil, cos, floor, tan
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.corner import ContactPlace, TipEnd, contact_places, tip_ends
from dynamics.contact.face import FaceGrid
from dynamics.contact.touching import Profiles, settled
from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.mesh.tip_contact import path_reach

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


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
