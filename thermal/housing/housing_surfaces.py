"""Named surfaces of the housing of a parametric gearbox and of its field, and the volume of the housing.

Shoulders and covers next to a bearing belong to ``cold_wall_<side>`` (``end_wall_<side>`` without partitions), so that
every bore is a pure cylinder.
"""

import math
from itertools import pairwise

from thermal.housing.geometry import HousingGeometry
from thermal.housing.shaft_geometry import SIDES, ShaftGeometry, Side
from thermal.housing.shaft_surfaces import (
    AxialPatch,
    BoxPatch,
    FramePatch,
    NamedFace,
    Patch,
    box_mantle,
    ring_area,
    shaft_faces,
    shaft_zones,
)

FOOT, SEAT = "housing_foot", "field_seat"
"""The two sides of the joint between a housing and its field."""


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
        patches: list[Patch] = box_mantle((start, end), g.width / 2.0, (0.0, g.height))
        area = girth * (end - start)
        if name != "outer_warm":
            patch, extra = _end_face(g, "front" if name.endswith("front") else "rear")
            patches.append(patch)
            area += extra
        faces.append(NamedFace(name, tuple(patches), area))
    return faces


def _plain_outer_faces(g: HousingGeometry) -> list[NamedFace]:
    """Outside of one chamber: side walls and top in one, and each end face by itself."""
    mantle = tuple(box_mantle((0.0, g.length), g.width / 2.0, (0.0, g.height)))
    faces = [NamedFace("outer_warm", mantle, (2.0 * g.height + g.width) * g.length)]
    for side in SIDES:
        patch, area = _end_face(g, side)
        faces.append(NamedFace(f"outer_end_{side}", (patch,), area))
    return faces


def _end_face(g: HousingGeometry, side: Side) -> tuple[Patch, float]:
    """One end of the box outside, and its area less the bores of the shafts that leave there."""
    x = g.mirrored(side, 0.0)
    through = [shaft for shaft in g.shafts if shaft.overhang(side) > 0.0]
    area = g.width * g.height - sum(ring_area(0.0, g.end_seal_radius(shaft)) for shaft in through)
    return BoxPatch((x, x), (-g.width / 2.0, g.width / 2.0), (0.0, g.height)), area


def _chamber_faces(g: HousingGeometry) -> list[NamedFace]:
    half, floor, ceiling = g.inner_half_width, g.floor_thickness, g.height - g.top_thickness
    reach = (g.partition_front[1], g.partition_rear[0])
    left, right, top = box_mantle(reach, half, (floor, ceiling))
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
        *box_mantle(reach, half, (floor, ceiling)),
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
    bearing = shaft.bearing(side)
    outer, inner = (g.mirrored(side, depth) for depth in g.bearing_depths(bearing))
    bore, seal = bearing.bore_radius, g.end_seal_radius(shaft)
    patches: list[Patch] = []
    area = -ring_area(0.0, bore)
    if g.protrusion(bearing) > 0.0:
        boss = g.boss_radius(bearing)
        wall = g.mirrored(side, g.end_wall_thickness)
        patches.append(AxialPatch(axis, (boss, boss), (min(wall, inner), max(wall, inner))))
        patches.append(AxialPatch(axis, (bore, boss), (inner, inner)))
        area += 2.0 * math.pi * boss * g.protrusion(bearing)
    if shaft.overhang(side) > 0.0:
        low, high = sorted((bore, seal))
        if high > low:
            patches.append(AxialPatch(axis, (low, high), (outer, outer)))
            area += ring_area(low, high)
    else:
        patches.append(AxialPatch(axis, (0.0, bore), (outer, outer)))
        area += ring_area(0.0, bore)
    return patches, area


def _bore_faces(g: HousingGeometry, shaft: ShaftGeometry, side: Side) -> list[NamedFace]:
    axis, bearing = (shaft.y, g.shaft_height), shaft.bearing(side)
    partition = g.partition_front if side == "front" else g.partition_rear
    face, outer, inner = (g.mirrored(side, depth) for depth in (0.0, *g.bearing_depths(bearing)))
    bores = [
        (f"bearing_bore_{shaft.name}_{side}", bearing.bore_radius, outer, inner),
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


def housing_volume(g: HousingGeometry) -> float:
    """Closed-form volume of the housing without its field [m3]."""
    clear = (g.chamber_length + g.cold_length_front + g.cold_length_rear) * 2.0 * g.inner_half_width
    volume = g.length * g.width * g.height - clear * g.inner_height
    for shaft in g.shafts:
        for side in SIDES:
            bearing = shaft.bearing(side)
            outer, inner = g.bearing_depths(bearing)
            if not g.one_chamber:
                volume -= ring_area(0.0, g.seal_radius(shaft)) * g.partition_thickness
            volume -= ring_area(0.0, bearing.bore_radius) * (inner - outer)
            volume += ring_area(0.0, g.boss_radius(bearing)) * g.protrusion(bearing)
            if shaft.overhang(side) > 0.0:
                volume -= ring_area(0.0, g.end_seal_radius(shaft)) * outer
    return volume


def _partition_area(g: HousingGeometry) -> float:
    bores = sum(ring_area(0.0, g.seal_radius(shaft)) for shaft in g.shafts)
    return 2.0 * g.inner_half_width * g.inner_height - bores


# The named bodies and surfaces of a parametric gearbox: one catalogue for names, recognition and areas.
#
# Every surface is a union of patches (`thermal.housing.shaft_surfaces`); the closed-form area next to them is what the
# mesh is checked against.


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
    volumes = {"housing": housing_volume(geometry)}
    if geometry.field is not None:
        volumes["field"] = geometry.field.length * geometry.field.width * geometry.field.thickness
    for shaft in geometry.shafts:
        bore = shaft.bore_diameter / 2.0
        zones = shaft_zones(geometry, shaft)
        volumes[f"shaft_{shaft.name}"] = sum(ring_area(bore, z.radius) * (z.end - z.start) for z in zones)
        if shaft.gear is not None:
            ring = ring_area(shaft.seat_diameter / 2.0, shaft.gear.outer_diameter / 2.0)
            volumes[f"gear_{shaft.name}"] = ring * shaft.gear.width
    return volumes
