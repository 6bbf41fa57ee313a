"""Tip corners that touch ahead of and behind the path of contact: gap, direction of the force, place on both flanks.

Before A the tip corner of the wheel meets the flank of the pinion, beyond E that of the pinion the flank of the wheel.
A corner may be rounded: its centre is a point, the mating flank is replaced by its offset, again an involute of the
same base circle, so that the gap starts smoothly where flank and rounding join. The contact normal is that of the
mating flank, hence a tangent to the base circle of its gear; it leaves the line of action, and its lever to the
gear of the corner is another than the base radius.
Source: geometry of the involute; the same gap as `dynamics.mesh.tip_contact` for a sharp corner.
"""

from dataclasses import dataclass
from math import atan, hypot

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.pair import GearPair
from dynamics.mesh.tip_contact import CornerMesh

Array = NDArray[np.float64]
CLOSED = 1e-14
"""Change at which the iteration of a gap ends [m]."""


@dataclass(frozen=True, kw_only=True)
class TipEnd:
    """Where the flank of a gear ends at its tip edge; lengths [m].

    roll : roll length of the end of the flank
    rounding : radius of the edge beyond it; 0: sharp
    """

    roll: float
    rounding: float = 0.0


def tip_ends(pair: GearPair) -> tuple[TipEnd, TipEnd]:
    """Ends of the flanks of pinion and wheel: sharp on the tip circle, or where a rounding or chamfer begins."""
    first, second = (
        TipEnd(
            roll=gear.roll_length(flank.tip_radius),
            rounding=details.tip_edge.rounding * (1.0 + expansion),
        )
        for gear, flank, details, expansion in zip(
            pair.gears, pair.flanks, pair.details, pair.expansion, strict=True
        )
    )
    return first, second


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactPlace:
    """Where a tooth pair touches and how its force acts; arrays of one shape, lengths in the transverse plane [m].

    gap : approach at which an unmodified pair touches; 0 on the path
    roll : on the flanks of pinion and wheel, from the base tangent point; that of a corner is the end of its flank
    lever : of the normal force about the axes of pinion and wheel
    reach : lever of the friction force about the axes of pinion and wheel; the sliding speed is
        omega_1 reach[0] - omega_2 reach[1]
    pressure_angle : direction of the force, against the tangent to the pitch circles [rad]
    beyond : how far the flank, carried on, would touch beyond its end; 0 on the path
    corner : 0 flank on flank, 1 corner of the pinion beyond the path, 2 corner of the wheel ahead of it
    bend : relative curvature that modifications add to that of the involutes [1/m]
    """

    gap: Array
    roll: tuple[Array, Array]
    lever: tuple[Array, Array]
    reach: tuple[Array, Array]
    pressure_angle: Array
    beyond: Array
    corner: NDArray[np.int8]
    bend: Array


@dataclass(frozen=True, kw_only=True)
class RoundedCorner:
    """Tip corner of one gear on the flank of the other."""

    mesh: CornerMesh
    tip: TipEnd

    def _centre(self, path: Array) -> tuple[Array, Array]:
        """Distance from the centre of the flank's gear and angle against the line of centres, shape of ``path``."""
        mesh, inner = self.mesh, self.tip.roll - self.tip.rounding
        radius = hypot(mesh.base, inner)
        working = mesh.reach / mesh.base
        turned = working - atan(working) + (path - self.tip.roll) / mesh.base + atan(inner / mesh.base)
        x, y = mesh.centre_distance - radius * np.cos(turned), radius * np.sin(turned)
        return np.maximum(np.hypot(x, y), mesh.flank_base), np.arctan2(y, x)

    def touched(self, path: Array) -> tuple[Array, Array]:
        """Return roll length on the flank [m] and direction of its normal there [rad], shape of ``path``."""
        radius, angle = self._centre(path)
        reach = np.sqrt(np.maximum(radius**2 - self.mesh.flank_base**2, 0.0))
        return reach - self.tip.rounding, angle + np.arctan(reach / self.mesh.flank_base)

    def opening(self, path: Array) -> Array:
        """Gap [m], shape of ``path``, at the path position of the corner's gear, growing to its tip [m]."""
        roll, normal = self.touched(path)
        working = self.mesh.reach / self.mesh.base
        return np.asarray(path + roll - self.mesh.flank_base * (working - atan(working) + normal))

    def opening_from_flank(self, path: Array) -> Array:
        """The same gap at the path position of the flank's gear [m]; that of the corner's gear is ahead by the gap."""
        gap = self.opening(path)
        for _ in range(100):
            change = self.opening(path + gap) - gap
            gap = gap + change
            if float(np.max(np.abs(change), initial=0.0)) < CLOSED:
                break
        return gap


@dataclass(frozen=True, kw_only=True)
class PathEnd:
    """End of the path of contact at ``place`` [m]; the corner that touches beyond it belongs to gear ``owner``."""

    place: float
    corner: RoundedCorner
    owner: int

    def touch(self, path: Array) -> tuple[Array, Array]:
        """Gap [m] beyond the end and path position of the corner's gear, growing to its tip [m], shape of ``path``."""
        if self.owner == 0:
            return self.corner.opening(path), path
        gap = self.corner.opening_from_flank(-path)
        return gap, gap - path


def path_ends(pair: GearPair, tips: tuple[TipEnd, TipEnd]) -> tuple[PathEnd, PathEnd]:
    """Ends of the path, A and E, with their corners; an undercut flank ends in a corner at its form circle."""
    (reach_1, reach_2), (pinion, wheel) = pair.rolling_radii, pair.gears
    start, end = reach_2 - tips[1].roll, tips[0].roll - reach_1
    first, last = _end(pair, start, 1, tips[1]), _end(pair, end, 0, tips[0])
    if pinion.undercut and pair.path.start > start:
        first = _end(pair, pair.path.start, 0, TipEnd(roll=reach_1 + pair.path.start))
    if wheel.undercut and pair.path.end < end:
        last = _end(pair, pair.path.end, 1, TipEnd(roll=reach_2 - pair.path.end))
    return first, last


def _end(pair: GearPair, place: float, owner: int, tip: TipEnd) -> PathEnd:
    mesh = CornerMesh(
        corner_radius=hypot(pair.base_radii[owner], tip.roll),
        base=pair.base_radii[owner],
        reach=pair.rolling_radii[owner],
        flank_base=pair.base_radii[1 - owner],
        centre_distance=pair.centre_distance,
    )
    return PathEnd(place=place, corner=RoundedCorner(mesh=mesh, tip=tip), owner=owner)


def contact_places(pair: GearPair, path: Array, tips: tuple[TipEnd, TipEnd] | None = None) -> ContactPlace:
    """Where tooth pairs at positions ``path`` [m] touch or would touch, in the transverse plane.

    path : any shape, of the pinion, from the pitch point to its tip; between the base tangent points
    tips : ends of both flanks; None: those of the pair
    """
    ends = path_ends(pair, tip_ends(pair) if tips is None else tips)
    (reach_1, reach_2), (base_1, base_2) = pair.rolling_radii, pair.base_radii
    zero = np.zeros_like(path)
    roll_1, roll_2 = np.maximum(reach_1 + path, 0.0), np.maximum(reach_2 - path, 0.0)
    rolls, reaches = (roll_1.copy(), roll_2.copy()), (roll_1, roll_2)
    levers = (zero + base_1, zero + base_2)
    gap, angle, beyond = zero.copy(), zero + pair.working_pressure_angle, zero.copy()
    corner = np.zeros(path.shape, dtype=np.int8)
    for end, outside in zip(ends, (path < ends[0].place, path > ends[1].place), strict=True):
        if not np.any(outside):
            continue
        gap[outside], own = end.touch(path[outside])
        roll, normal = end.corner.touched(own)
        owner, flank, mesh, tip = end.owner, 1 - end.owner, end.corner.mesh, end.corner.tip
        rolls[owner][outside], rolls[flank][outside] = tip.roll, roll
        levers[owner][outside] = mesh.centre_distance * np.cos(normal) - mesh.flank_base
        reaches[owner][outside] = mesh.centre_distance * np.sin(normal) - roll
        reaches[flank][outside] = roll
        angle[outside], corner[outside] = normal, 1 + owner
        carried_on = np.abs(mesh.reach + own - tip.roll)
        beyond[outside] = carried_on * (tip.roll + 0.5 * carried_on) / mesh.base
    return ContactPlace(
        gap=gap,
        roll=rolls,
        lever=levers,
        reach=reaches,
        pressure_angle=angle,
        beyond=beyond,
        corner=corner,
        bend=zero,
    )
