"""The solids of a parametric gearbox, drawn with gmsh's OpenCASCADE kernel, and the element sizes on them."""

import math
from dataclasses import dataclass
from typing import Any, Literal

from thermal.housing.curving import BendAxis
from thermal.housing.geometry import ClampingField, HousingGeometry
from thermal.housing.meshing import SizeLaw
from thermal.housing.shaft_geometry import SIDES, GeometryError, ShaftGeometry
from thermal.housing.shaft_surfaces import shaft_zones

SAME = 1e-6
"""Two lengths are one if they differ by less [m]."""


@dataclass(frozen=True, kw_only=True)
class MeshSizes:
    """Target element sizes of a gearbox mesh [m]; second-order elements, so one covers a wall's thickness."""

    wall: float
    field: float
    """At the outer edges of the clamping field; under the foot the size of the walls holds."""
    shaft: float
    circle: int
    """Least number of elements round a bore or shaft."""
    seal: float = math.inf
    """At most, on the bores and shafts of seals."""
    bearing: float = math.inf
    """At most, on bearing bores, bosses and journals."""
    gear: float = math.inf
    """At most, on gears and their seats."""

    def __post_init__(self) -> None:
        for name in ("wall", "field", "shaft", "seal", "bearing", "gear"):
            value = getattr(self, name)
            bounded = math.isfinite(value) or name in ("seal", "bearing", "gear")
            if not (bounded and value > 0.0):
                raise GeometryError(f"mesh size {name} = {value} m must be greater than 0; give a length")
        if self.circle < 6:
            raise GeometryError(
                f"mesh size circle = {self.circle} is below 6; give 6 elements a turn or more"
            )


def draw_housing(g: HousingGeometry, occ: Any) -> dict[str, list[int]]:
    """Box on a field that shares its nodes, chambers and bores cut out, warm/cold lines imprinted outside."""
    half, wide = g.width / 2.0, 2.0 * g.inner_half_width
    solid = [(3, occ.addBox(0.0, -half, 0.0, g.length, g.width, g.height))]
    chambers = [(g.partition_front[1], g.chamber_length)]
    if not g.one_chamber:
        chambers += [
            (g.end_wall_thickness, g.cold_length_front),
            (g.partition_rear[1], g.cold_length_rear),
        ]
    hollow = [
        (3, occ.addBox(x, -g.inner_half_width, g.floor_thickness, length, wide, g.inner_height))
        for x, length in chambers
    ]
    solid, _ = occ.cut(solid, hollow)
    bosses, bores = [], []
    for shaft in g.shafts:
        axis = (shaft.y, g.shaft_height)
        for side in SIDES:
            bearing = shaft.bearing(side)
            outer, inner = g.bearing_depths(bearing)
            reach = sorted((g.mirrored(side, outer), g.mirrored(side, inner)))
            bores.append(_cylinder(occ, axis, bearing.bore_radius, *reach))
            if not g.one_chamber:
                partition = g.partition_front if side == "front" else g.partition_rear
                bores.append(_cylinder(occ, axis, g.seal_radius(shaft), *partition))
            if shaft.overhang(side) > 0.0:
                land = sorted((g.mirrored(side, 0.0), g.mirrored(side, outer)))
                bores.append(_cylinder(occ, axis, g.end_seal_radius(shaft), *land))
            if g.protrusion(bearing) > 0.0:
                wall = g.mirrored(side, g.end_wall_thickness)
                boss = sorted((wall, g.mirrored(side, inner)))
                bosses.append(_cylinder(occ, axis, g.boss_radius(bearing), *boss))
    if bosses:
        solid, _ = occ.fuse(solid, bosses)
    solid, _ = occ.cut(solid, bores)
    tools = [] if g.field is None or g.foot_joint else [_plate(g, g.field, occ)]
    limits = () if g.one_chamber else g.warm_limits
    lines = [(1, line) for x in limits for line in _portal(occ, x, half, g.height)]
    added = tools + lines
    origin = occ.fragment(solid, added)[1] if added else [solid]
    bodies = {"housing": [tag for _, tag in origin[0]]}
    if tools:
        bodies["field"] = [tag for _, tag in origin[1]]
    return bodies


def draw_field(g: HousingGeometry, occ: Any) -> dict[str, list[int]]:
    """The field as a body of its own, the seat of the foot imprinted on its top."""
    assert g.field is not None
    seat = occ.addRectangle(0.0, -g.width / 2.0, 0.0, g.length, g.width)
    _, origin = occ.fragment([_plate(g, g.field, occ)], [(2, seat)])
    return {"field": [tag for _, tag in origin[0]]}


def _plate(g: HousingGeometry, field: ClampingField, occ: Any) -> tuple[int, int]:
    corner = (g.length / 2.0 - field.length / 2.0, -field.width / 2.0, -field.thickness)
    return 3, occ.addBox(*corner, field.length, field.width, field.thickness)


def draw_shaft(g: HousingGeometry, shaft: ShaftGeometry, occ: Any) -> dict[str, list[int]]:
    """The zones of a shaft stacked, its gear on the seat, and the bore cut through."""
    axis = (shaft.y, g.shaft_height)
    zones = shaft_zones(g, shaft)
    solids = [_cylinder(occ, axis, zone.radius, zone.start, zone.end) for zone in zones]
    if shaft.gear is not None:
        limits = g.gear_limits(shaft)
        disc = _cylinder(occ, axis, shaft.gear.outer_diameter / 2.0, *limits)
        seat = _cylinder(occ, axis, shaft.seat_diameter / 2.0, *limits)
        ring, _ = occ.cut([disc], [seat])
        solids += ring
    if shaft.bore_diameter > 0.0:
        bore = _cylinder(occ, axis, shaft.bore_diameter / 2.0, zones[0].start, zones[-1].end)
        solids[: len(zones)], _ = occ.cut(solids[: len(zones)], [bore])
    _, origin = occ.fragment(solids, [])
    bodies = {f"shaft_{shaft.name}": [tag for part in origin[: len(zones)] for _, tag in part]}
    if shaft.gear is not None:
        bodies[f"gear_{shaft.name}"] = [tag for part in origin[len(zones) :] for _, tag in part]
    return bodies


def _cylinder(
    occ: Any, axis: tuple[float, float], radius: float, start: float, end: float
) -> tuple[int, int]:
    return 3, occ.addCylinder(start, *axis, end - start, 0.0, 0.0, radius)


def _portal(occ: Any, x: float, half_width: float, height: float) -> list[int]:
    """Lines up one side, over the top and down the other at ``x``."""
    corners = ((-half_width, 0.0), (-half_width, height), (half_width, height), (half_width, 0.0))
    points = [occ.addPoint(x, *corner) for corner in corners]
    return [occ.addLine(points[i], points[i + 1]) for i in range(3)]


def bend_axes(g: HousingGeometry) -> list[BendAxis]:
    """The axes of the bores, and the radius of the largest bore or boss round each."""
    return [(shaft.y, g.shaft_height, max(radius for radius, _ in _circles(g, shaft))) for shaft in g.shafts]


def _circles(g: HousingGeometry, shaft: ShaftGeometry) -> list[tuple[float, Literal["seal", "bearing"]]]:
    """Radius and zone of every bore and boss of a shaft in the housing."""
    bearings = (shaft.front, shaft.rear)
    circles: list[tuple[float, Literal["seal", "bearing"]]] = [
        (each.bore_radius, "bearing") for each in bearings
    ]
    if not g.one_chamber:
        circles.append((g.seal_radius(shaft), "seal"))
    if shaft.overhang_front or shaft.overhang_rear:
        circles.append((g.end_seal_radius(shaft), "seal"))
    circles += [(g.boss_radius(each), "bearing") for each in bearings if g.protrusion(each) > 0.0]
    return circles


def housing_size(g: HousingGeometry, sizes: MeshSizes) -> SizeLaw:
    """Element size at the corners of housing and field: field, walls, and finer round the bores."""
    circles = [(shaft.y, *circle) for shaft in g.shafts for circle in _circles(g, shaft)]
    most = {"seal": sizes.seal, "bearing": sizes.bearing}

    def size(x: float, y: float, z: float) -> float:
        if z < -1e-9 or x < -1e-9 or x > g.length + 1e-9 or abs(y) > g.width / 2.0 + 1e-9:
            return sizes.field
        on = [
            min(most[zone], 2.0 * math.pi * radius / sizes.circle)
            for axis, radius, zone in circles
            if abs(math.hypot(y - axis, z - g.shaft_height) - radius) < SAME
        ]
        return min([sizes.wall, *on])

    return size


def shaft_size(g: HousingGeometry, shaft: ShaftGeometry, sizes: MeshSizes) -> SizeLaw:
    """Element size at the vertices of one shaft; in its bore they are up to three times longer than wide."""
    zones = shaft_zones(g, shaft)
    thinnest = min(zone.radius for zone in zones)
    finest = {"_seal_": sizes.seal, "_journal_": sizes.bearing}
    limits = [
        (zone.radius, zone.start, zone.end, size)
        for zone in zones
        for part, size in finest.items()
        if part in zone.surface.removeprefix(f"shaft_{shaft.name}")
    ]

    def size(x: float, y: float, z: float) -> float:
        radius = math.hypot(y - shaft.y, z - g.shaft_height)
        around = max(radius, min(3.0 * radius, thinnest))
        on = [
            most
            for own, start, end, most in limits
            if abs(radius - own) < SAME and start - SAME < x < end + SAME
        ]
        if shaft.gear is not None:
            first, last = g.gear_limits(shaft)
            if radius > 0.5 * shaft.seat_diameter - SAME and first - SAME < x < last + SAME:
                on.append(sizes.gear)
        return min(sizes.shaft, 2.0 * math.pi * around / sizes.circle, *on)

    return size
