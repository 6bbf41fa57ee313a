"""Zones and named surfaces of the shafts of a parametric gearbox and of their gears.

Shoulders of a shaft belong to its warm or cold zone, never to a journal or seal, so that every journal is a pure
cylinder.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermal.fe.mesh import FloatArray
from thermal.housing.geometry import HousingGeometry
from thermal.housing.shaft_geometry import SIDES, ShaftGeometry

# Patches that named surfaces are made of: where their points lie, and closed-form areas.
#
# A patch is a box, flat in one direction, or a piece of cylinder or ring about a shaft axis, so that a face of the mesh
# is recognised by its own nodes.

Range = tuple[float, float]


@dataclass(frozen=True)
class BoxPatch:
    """All points with x, y and z in these closed ranges."""

    x: Range
    y: Range
    z: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        lower = np.array([self.x[0], self.y[0], self.z[0]]) - tolerance
        upper = np.array([self.x[1], self.y[1], self.z[1]]) + tolerance
        return bool(np.all((points >= lower) & (points <= upper)))


@dataclass(frozen=True)
class AxialPatch:
    """All points with x and the distance from an axis along x in these closed ranges."""

    axis: tuple[float, float]
    """y and z of the axis."""
    radius: Range
    x: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        radius = np.hypot(points[:, 1] - self.axis[0], points[:, 2] - self.axis[1])
        return bool(
            radius.min() >= self.radius[0] - tolerance
            and radius.max() <= self.radius[1] + tolerance
            and points[:, 0].min() >= self.x[0] - tolerance
            and points[:, 0].max() <= self.x[1] + tolerance
        )


@dataclass(frozen=True)
class FramePatch:
    """All points of a box patch that are not inside a rectangle of x and y."""

    box: BoxPatch
    x: Range
    y: Range

    def holds(self, points: FloatArray, tolerance: float) -> bool:
        """Whether all ``points`` (n, 3) lie in the patch."""
        inside = (points[:, 0] > self.x[0] + tolerance) & (points[:, 0] < self.x[1] - tolerance)
        inside &= (points[:, 1] > self.y[0] + tolerance) & (points[:, 1] < self.y[1] - tolerance)
        return self.box.holds(points, tolerance) and not bool(inside.any())


Patch = BoxPatch | AxialPatch | FramePatch


@dataclass(frozen=True)
class NamedFace:
    """A named surface: where its points lie, and its exact area [m2]."""

    name: str
    patches: tuple[Patch, ...]
    area: float


def box_mantle(x: Range, half: float, z: Range) -> list[Patch]:
    """Left, right and top of a box section."""
    return [
        BoxPatch(x, (-half, -half), z),
        BoxPatch(x, (half, half), z),
        BoxPatch(x, (-half, half), (z[1], z[1])),
    ]


def ring_area(inner: float, outer: float) -> float:
    """Area between two concentric circles [m2]."""
    return math.pi * (outer**2 - inner**2)


@dataclass(frozen=True)
class ShaftZone:
    """A cylindrical length of a shaft and the surface its mantle belongs to."""

    surface: str
    radius: float
    start: float
    end: float

    @property
    def mantle(self) -> float:
        """Area of the mantle [m2]."""
        return 2.0 * math.pi * self.radius * (self.end - self.start)


def shaft_zones(geometry: HousingGeometry, shaft: ShaftGeometry) -> tuple[ShaftZone, ...]:
    """The cylinders a shaft is stacked of, from front to rear; neighbours share their end plane."""
    prefix = f"shaft_{shaft.name}"
    zones: list[ShaftZone] = []
    for side in SIDES:
        bearing = shaft.bearing(side)
        outer, inner = geometry.bearing_depths(bearing)
        half = [
            (f"{prefix}_outside_{side}", shaft.overhang_diameter, -shaft.overhang(side), 0.0),
            (f"{prefix}_seal_{side}_end", shaft.overhang_diameter, 0.0, outer),
            (f"{prefix}_journal_{side}", bearing.journal_diameter, outer, inner),
        ]
        if not geometry.one_chamber:
            face = (
                geometry.partition_front[0]
                if side == "front"
                else geometry.length - geometry.partition_rear[1]
            )
            half += [
                (f"{prefix}_cold_{side}", shaft.seal_diameter, inner, face),
                (f"{prefix}_seal_{side}", shaft.seal_diameter, face, face + geometry.partition_thickness),
            ]
        for name, diameter, start, end in half if shaft.overhang(side) > 0.0 else half[2:]:
            low, high = sorted((geometry.mirrored(side, start), geometry.mirrored(side, end)))
            zones.append(ShaftZone(name, diameter / 2.0, low, high))
    cuts = [geometry.partition_front[1], geometry.partition_rear[0]]
    if geometry.one_chamber:
        cuts = [geometry.mirrored(side, geometry.bearing_depths(shaft.bearing(side))[1]) for side in SIDES]
    if shaft.gear is not None:
        cuts[1:1] = geometry.gear_limits(shaft)
    zones += [ShaftZone(f"{prefix}_warm", shaft.seat_diameter / 2.0, *cut) for cut in pairwise(cuts)]
    return tuple(sorted(zones, key=lambda zone: zone.start))


def shaft_faces(geometry: HousingGeometry, shaft: ShaftGeometry) -> list[NamedFace]:
    """The named surfaces of one shaft and its gear."""
    axis = (shaft.y, geometry.shaft_height)
    bore = shaft.bore_diameter / 2.0
    zones = shaft_zones(geometry, shaft)
    seat = geometry.gear_limits(shaft) if shaft.gear is not None else None
    patches: dict[str, list[Patch]] = {}
    areas: dict[str, float] = {}

    def add(name: str, patch: Patch, area: float) -> None:
        patches.setdefault(name, []).append(patch)
        areas[name] = areas.get(name, 0.0) + area

    for zone in zones:
        if (zone.start, zone.end) != seat:
            add(
                zone.surface,
                AxialPatch(axis, (zone.radius, zone.radius), (zone.start, zone.end)),
                zone.mantle,
            )
    for first, second in pairwise(zones):
        low, high = sorted((first.radius, second.radius))
        if high > low:
            owner = _shoulder_owner(geometry, shaft, first.surface, second.surface)
            add(owner, AxialPatch(axis, (low, high), (first.end, first.end)), ring_area(low, high))
    for side, zone, x in (("front", zones[0], zones[0].start), ("rear", zones[-1], zones[-1].end)):
        name = f"shaft_{shaft.name}_end_{side}"
        add(name, AxialPatch(axis, (bore, zone.radius), (x, x)), ring_area(bore, zone.radius))
    if bore > 0.0:
        reach = (zones[0].start, zones[-1].end)
        length = reach[1] - reach[0]
        add(f"shaft_{shaft.name}_bore", AxialPatch(axis, (bore, bore), reach), 2.0 * math.pi * bore * length)
    if shaft.gear is not None and seat is not None:
        inner, outer = shaft.seat_diameter / 2.0, shaft.gear.outer_diameter / 2.0
        rim = 2.0 * math.pi * outer * shaft.gear.width
        add(f"gear_{shaft.name}_rim", AxialPatch(axis, (outer, outer), seat), rim)
        for side, x in zip(SIDES, seat):
            name = f"gear_{shaft.name}_side_{side}"
            add(name, AxialPatch(axis, (inner, outer), (x, x)), ring_area(inner, outer))
    return [NamedFace(name, tuple(group), areas[name]) for name, group in patches.items()]


def _shoulder_owner(geometry: HousingGeometry, shaft: ShaftGeometry, first: str, second: str) -> str:
    """The warm or cold zone a step of the shaft belongs to; outside a bearing, the zone inside it."""
    for name in (first, second):
        if name.endswith("_warm"):
            return name
    for name in (first, second):
        if "_cold_" in name:
            return name
    if geometry.one_chamber:
        return f"shaft_{shaft.name}_warm"
    journal = first if "_journal_" in first else second
    return journal.replace("_journal_", "_cold_")
