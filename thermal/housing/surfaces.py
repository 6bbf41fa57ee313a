"""The named bodies and surfaces of a parametric gearbox: one catalogue for names, recognition and areas.

Every surface is a union of patches. A patch says where its points lie (a box, flat in one direction, or a
piece of cylinder or ring about a shaft axis), so that a face of the mesh is recognised by its own nodes. The
closed-form area next to it is what the mesh is checked against.

Shoulders of a shaft belong to its warm or cold zone, never to a journal or seal; shoulders and covers next to
a bearing belong to ``cold_wall_<side>`` (``end_wall_<side>`` without partitions), so that every bore and journal is a
pure cylinder.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thermal.fe.mesh import FloatArray
from thermal.housing.geometry import SIDES, HousingGeometry, ShaftGeometry, Side

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

FOOT, SEAT = "housing_foot", "field_seat"
"""The two sides of the joint between a housing and its field."""


@dataclass(frozen=True)
class NamedFace:
    """A named surface: where its points lie, and its exact area [m2]."""

    name: str
    patches: tuple[Patch, ...]
    area: float


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


def surface_names(geometry: HousingGeometry) -> tuple[str, ...]:
    """Names of all surfaces `build_gearbox` makes of ``geometry``, without meshing (gmsh is not imported).

    The two sides of a foot joint are left out: they have each other.
    """
    joined = joined_surfaces(geometry)
    return tuple(name for name in exact_areas(geometry) if name not in joined)


def joined_surfaces(geometry: HousingGeometry) -> tuple[str, ...]:
    """The two sides of a foot joint, which take no boundary condition; none where foot and field share their nodes."""
    return (FOOT, SEAT) if geometry.foot_joint else ()


def body_names(geometry: HousingGeometry) -> tuple[str, ...]:
    """Names of all bodies `build_gearbox` makes of ``geometry``: housing, field, shafts and gears."""
    return tuple(exact_volumes(geometry))


def exact_areas(geometry: HousingGeometry) -> dict[str, float]:
    """Closed-form area of every named surface [m2]."""
    faces = housing_faces(geometry)
    if geometry.foot_joint:
        faces += field_faces(geometry)
    for shaft in geometry.shafts:
        faces += shaft_faces(geometry, shaft)
    return {face.name: face.area for face in faces}


def exact_volumes(geometry: HousingGeometry) -> dict[str, float]:
    """Closed-form volume of every body [m3]."""
    volumes = {"housing": _housing_volume(geometry)}
    if geometry.field is not None:
        volumes["field"] = geometry.field.length * geometry.field.width * geometry.field.thickness
    for shaft in geometry.shafts:
        bore = shaft.bore_diameter / 2.0
        zones = shaft_zones(geometry, shaft)
        volumes[f"shaft_{shaft.name}"] = sum(_ring(bore, z.radius) * (z.end - z.start) for z in zones)
        if shaft.gear is not None:
            ring = _ring(shaft.seat_diameter / 2.0, shaft.gear.outer_diameter / 2.0)
            volumes[f"gear_{shaft.name}"] = ring * shaft.gear.width
    return volumes


def shaft_zones(geometry: HousingGeometry, shaft: ShaftGeometry) -> tuple[ShaftZone, ...]:
    """The cylinders a shaft is stacked of, from front to rear; neighbours share their end plane."""
    prefix = f"shaft_{shaft.name}"
    zones: list[ShaftZone] = []
    for side in SIDES:
        outer, inner = geometry.bearing_depths(shaft)
        half = [
            (f"{prefix}_outside_{side}", shaft.overhang_diameter, -shaft.overhang(side), 0.0),
            (f"{prefix}_seal_{side}_end", shaft.overhang_diameter, 0.0, outer),
            (f"{prefix}_journal_{side}", shaft.journal_diameter, outer, inner),
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
    inner = geometry.bearing_depths(shaft)[1]
    cuts = [geometry.partition_front[1], geometry.partition_rear[0]]
    if geometry.one_chamber:
        cuts = [inner, geometry.length - inner]
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
            add(owner, AxialPatch(axis, (low, high), (first.end, first.end)), _ring(low, high))
    for side, zone, x in (("front", zones[0], zones[0].start), ("rear", zones[-1], zones[-1].end)):
        name = f"shaft_{shaft.name}_end_{side}"
        add(name, AxialPatch(axis, (bore, zone.radius), (x, x)), _ring(bore, zone.radius))
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
            add(name, AxialPatch(axis, (inner, outer), (x, x)), _ring(inner, outer))
    return [NamedFace(name, tuple(found), areas[name]) for name, found in patches.items()]


def housing_faces(geometry: HousingGeometry) -> list[NamedFace]:
    """The named surfaces of the housing, and of the field that shares its nodes."""
    if geometry.one_chamber:
        faces = _plain_outer_faces(geometry) + _chamber_faces(geometry)
    else:
        faces = _outer_faces(geometry) + _chamber_faces(geometry) + _partition_faces(geometry)
    for side in SIDES:
        faces += [_end_wall_face(geometry, side)] if geometry.one_chamber else _cold_faces(geometry, side)
        faces += [face for shaft in geometry.shafts for face in _bore_faces(geometry, shaft, side)]
    if geometry.field is None or geometry.foot_joint:
        return [*faces, NamedFace(FOOT, (_foot(geometry),), geometry.length * geometry.width)]
    return faces + field_faces(geometry)


def _outer_faces(g: HousingGeometry) -> list[NamedFace]:
    girth = 2.0 * g.height + g.width
    limits = (0.0, *g.warm_limits, g.length)
    faces = []
    for name, (start, end) in zip(("outer_cold_front", "outer_warm", "outer_cold_rear"), pairwise(limits)):
        patches: list[Patch] = _mantle((start, end), g.width / 2.0, (0.0, g.height))
        area = girth * (end - start)
        if name != "outer_warm":
            patch, extra = _end_face(g, "front" if name.endswith("front") else "rear")
            patches.append(patch)
            area += extra
        faces.append(NamedFace(name, tuple(patches), area))
    return faces


def _plain_outer_faces(g: HousingGeometry) -> list[NamedFace]:
    """Outside of one chamber: side walls and top in one, and each end face by itself."""
    mantle = tuple(_mantle((0.0, g.length), g.width / 2.0, (0.0, g.height)))
    faces = [NamedFace("outer_warm", mantle, (2.0 * g.height + g.width) * g.length)]
    for side in SIDES:
        patch, area = _end_face(g, side)
        faces.append(NamedFace(f"outer_end_{side}", (patch,), area))
    return faces


def _end_face(g: HousingGeometry, side: Side) -> tuple[Patch, float]:
    """One end of the box outside, and its area less the bores of the shafts that leave there."""
    x = g.mirrored(side, 0.0)
    through = [shaft for shaft in g.shafts if shaft.overhang(side) > 0.0]
    area = g.width * g.height - sum(_ring(0.0, g.end_seal_radius(shaft)) for shaft in through)
    return BoxPatch((x, x), (-g.width / 2.0, g.width / 2.0), (0.0, g.height)), area


def _chamber_faces(g: HousingGeometry) -> list[NamedFace]:
    half, floor, ceiling = g.inner_half_width, g.floor_thickness, g.height - g.top_thickness
    reach = (g.partition_front[1], g.partition_rear[0])
    left, right, top = _mantle(reach, half, (floor, ceiling))
    bottom = BoxPatch(reach, (-half, half), (floor, floor))
    side_area, flat_area = g.chamber_length * g.inner_height, g.chamber_length * 2.0 * half
    return [
        NamedFace("chamber_wall", (left, right), 2.0 * side_area),
        NamedFace("chamber_floor", (bottom,), flat_area),
        NamedFace("chamber_top", (top,), flat_area),
    ]


def _partition_faces(g: HousingGeometry) -> list[NamedFace]:
    """The sides of the partitions that face the warm chamber."""
    half, height = g.inner_half_width, (g.floor_thickness, g.height - g.top_thickness)
    return [
        NamedFace(f"partition_warm_{side}", (BoxPatch((x, x), (-half, half), height),), _partition_area(g))
        for side, x in zip(SIDES, (g.partition_front[1], g.partition_rear[0]))
    ]


def _end_wall_face(g: HousingGeometry, side: Side) -> NamedFace:
    """Inside of an end wall of one chamber, with bosses, shoulders and covers of its bearings."""
    half, wall = g.inner_half_width, g.mirrored(side, g.end_wall_thickness)
    patches: list[Patch] = [
        BoxPatch((wall, wall), (-half, half), (g.floor_thickness, g.height - g.top_thickness))
    ]
    area = 2.0 * half * g.inner_height
    for shaft in g.shafts:
        more, extra = _bearing_surroundings(g, shaft, side)
        patches += more
        area += extra
    return NamedFace(f"end_wall_{side}", tuple(patches), area)


def _cold_faces(g: HousingGeometry, side: Side) -> list[NamedFace]:
    half, floor, ceiling = g.inner_half_width, g.floor_thickness, g.height - g.top_thickness
    wall = g.mirrored(side, g.end_wall_thickness)
    partition = g.partition_front[0] if side == "front" else g.partition_rear[1]
    reach = (min(wall, partition), max(wall, partition))
    length = g.cold_length(side)
    patches: list[Patch] = [
        *_mantle(reach, half, (floor, ceiling)),
        BoxPatch((wall, wall), (-half, half), (floor, ceiling)),
    ]
    area = length * (2.0 * g.inner_height + 2.0 * half) + 2.0 * half * g.inner_height
    for shaft in g.shafts:
        more, extra = _bearing_surroundings(g, shaft, side)
        patches += more
        area += extra
    return [
        NamedFace(f"cold_wall_{side}", tuple(patches), area),
        NamedFace(
            f"cold_floor_{side}", (BoxPatch(reach, (-half, half), (floor, floor)),), length * 2.0 * half
        ),
        NamedFace(
            f"partition_cold_{side}",
            (BoxPatch((partition, partition), (-half, half), (floor, ceiling)),),
            _partition_area(g),
        ),
    ]


def _bearing_surroundings(g: HousingGeometry, shaft: ShaftGeometry, side: Side) -> tuple[list[Patch], float]:
    """Boss, shoulder or cover beside one bearing, and what they add to the area of the flat cold wall."""
    axis = (shaft.y, g.shaft_height)
    outer, inner = (g.mirrored(side, depth) for depth in g.bearing_depths(shaft))
    bore, seal = g.bearing_radius(shaft), g.end_seal_radius(shaft)
    patches: list[Patch] = []
    area = -_ring(0.0, bore)
    if g.protrusion(shaft) > 0.0:
        boss = g.boss_radius(shaft)
        wall = g.mirrored(side, g.end_wall_thickness)
        patches.append(AxialPatch(axis, (boss, boss), (min(wall, inner), max(wall, inner))))
        patches.append(AxialPatch(axis, (bore, boss), (inner, inner)))
        area += 2.0 * math.pi * boss * g.protrusion(shaft)
    if shaft.overhang(side) > 0.0:
        low, high = sorted((bore, seal))
        if high > low:
            patches.append(AxialPatch(axis, (low, high), (outer, outer)))
            area += _ring(low, high)
    else:
        patches.append(AxialPatch(axis, (0.0, bore), (outer, outer)))
        area += _ring(0.0, bore)
    return patches, area


def _bore_faces(g: HousingGeometry, shaft: ShaftGeometry, side: Side) -> list[NamedFace]:
    axis = (shaft.y, g.shaft_height)
    partition = g.partition_front if side == "front" else g.partition_rear
    face, outer, inner = (g.mirrored(side, depth) for depth in (0.0, *g.bearing_depths(shaft)))
    bores = [
        (f"bearing_bore_{shaft.name}_{side}", g.bearing_radius(shaft), outer, inner),
    ]
    if not g.one_chamber:
        bores.append((f"seal_bore_{shaft.name}_{side}", g.seal_radius(shaft), *partition))
    if shaft.overhang(side) > 0.0:
        bores.append((f"seal_bore_{shaft.name}_{side}_end", g.end_seal_radius(shaft), face, outer))
    return [
        NamedFace(
            name,
            (AxialPatch(axis, (radius, radius), (min(start, end), max(start, end))),),
            2.0 * math.pi * radius * abs(end - start),
        )
        for name, radius, start, end in bores
    ]


def _foot(g: HousingGeometry) -> BoxPatch:
    return BoxPatch((0.0, g.length), (-g.width / 2.0, g.width / 2.0), (0.0, 0.0))


def field_faces(g: HousingGeometry) -> list[NamedFace]:
    """Top, sides and bottom of the field, and its seat where the foot shares no nodes with it."""
    assert g.field is not None
    foot, under = g.length * g.width, _foot(g)
    length, width, thickness = g.field.length, g.field.width, g.field.thickness
    x = (g.length / 2.0 - length / 2.0, g.length / 2.0 + length / 2.0)
    y, z = (-width / 2.0, width / 2.0), (-thickness, 0.0)
    sides = (
        *(BoxPatch((value, value), y, z) for value in x),
        *(BoxPatch(x, (value, value), z) for value in y),
    )
    top = FramePatch(BoxPatch(x, y, (0.0, 0.0)), under.x, under.y)
    return [
        NamedFace("field_top", (top,), length * width - foot),
        NamedFace("field_sides", sides, 2.0 * (length + width) * thickness),
        NamedFace("field_bottom", (BoxPatch(x, y, (-thickness, -thickness)),), length * width),
        *([NamedFace(SEAT, (under,), foot)] if g.foot_joint else []),
    ]


def _housing_volume(g: HousingGeometry) -> float:
    clear = (g.chamber_length + g.cold_length_front + g.cold_length_rear) * 2.0 * g.inner_half_width
    volume = g.length * g.width * g.height - clear * g.inner_height
    for shaft in g.shafts:
        outer, inner = g.bearing_depths(shaft)
        for side in SIDES:
            if not g.one_chamber:
                volume -= _ring(0.0, g.seal_radius(shaft)) * g.partition_thickness
            volume -= _ring(0.0, g.bearing_radius(shaft)) * (inner - outer)
            volume += _ring(0.0, g.boss_radius(shaft)) * g.protrusion(shaft)
            if shaft.overhang(side) > 0.0:
                volume -= _ring(0.0, g.end_seal_radius(shaft)) * outer
    return volume


def _partition_area(g: HousingGeometry) -> float:
    bores = sum(_ring(0.0, g.seal_radius(shaft)) for shaft in g.shafts)
    return 2.0 * g.inner_half_width * g.inner_height - bores


def _mantle(x: Range, half: float, z: Range) -> list[Patch]:
    """Left, right and top of a box section."""
    return [
        BoxPatch(x, (-half, -half), z),
        BoxPatch(x, (half, half), z),
        BoxPatch(x, (-half, half), (z[1], z[1])),
    ]


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


def _ring(inner: float, outer: float) -> float:
    """Area between two concentric circles [m2]."""
    return math.pi * (outer**2 - inner**2)
