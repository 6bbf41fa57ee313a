"""The solids of a parametric gearbox, drawn with gmsh's OpenCASCADE kernel, and the element sizes on them."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import ModuleType
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from thermal.fe import reference_elements
from thermal.fe.mesh import (
    FloatArray,
    IndexArray,
    MeshError,
    NamedMesh,
    facet_keys,
    facet_table,
    named_mesh,
)
from thermal.housing.curving import BendAxis, bend_round_axes, straighten_inverted
from thermal.housing.geometry import ClampingField, HousingGeometry
from thermal.housing.shaft_geometry import SIDES, GeometryError, ShaftGeometry
from thermal.housing.shaft_surfaces import NamedFace, shaft_zones

# Meshing by gmsh: one solid component at a time, in memory, single-threaded, with named faces.
#
# A component is a set of volumes that share nodes (housing and field; a shaft and its gear). Components are
# meshed in separate gmsh models, so that parts that overlap in space, as the discs of two meshing gears may,
# never meet.

TETRAHEDRON_10, TRIANGLE_6 = 11, 9
"""gmsh's numbers of the two element types."""
TOLERANCE = 1e-6
"""Distance [m] within which a node lies on a named patch."""
LEAST_CIRCLE = 6
"""Elements round a bore or shaft at least."""

SizeLaw = Callable[[float, float, float], float]
"""Target element size [m] at a corner of the geometry (x, y, z)."""
Drawing = Callable[[Any], Mapping[str, Sequence[int]]]
"""Makes solids with the OCC kernel it is given; returns body name -> volume tags."""


@dataclass(frozen=True, kw_only=True)
class Component:
    """One component to be meshed by itself.

    draw : makes its bodies in a CAD kernel
    faces : every surface of the component; each face of the geometry must lie in exactly one of them
    size : element size at the corners of the geometry; between them gmsh interpolates
    axes : round which the elements follow the circles of the boundary
    """

    name: str
    draw: Drawing
    faces: Sequence[NamedFace]
    size: SizeLaw
    axes: Sequence[BendAxis] = ()


def mesh_component(gmsh: ModuleType, component: Component, circle: int) -> NamedMesh:
    """Draw, mesh and name one component.

    circle : least number of elements round a full circle

    Raises MeshError if gmsh fails, a face has no name or two, or an element stays inverted.
    """
    name, size = component.name, component.size
    gmsh.model.add(name)
    try:
        bodies = component.draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        for point in gmsh.model.getEntities(0):
            gmsh.model.mesh.setSize([point], size(*gmsh.model.getValue(*point, [])))
        _divide_circles(gmsh, size, circle)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        return _collect(gmsh, name, bodies, component.faces, component.axes)
    except MeshError:
        raise
    except Exception as error:  # gmsh raises bare Exception
        raise MeshError(
            f"gmsh could not mesh {name}: {error}; check for walls, gaps or steps much thinner than the "
            "rest, or choose another fidelity"
        ) from error
    finally:
        gmsh.model.remove()


def _divide_circles(gmsh: ModuleType, size: SizeLaw, circle: int) -> None:
    """Divide full circles evenly into ``circle`` elements, or twice, four times ... as many if size wants it.

    Concentric circles start at the same angle, so their nodes line up across the narrow ring between two.
    """
    for curve in gmsh.model.getEntities(1):
        if gmsh.model.getType(*curve) != "Circle" or gmsh.model.getBoundary([curve]):
            continue
        vertex = gmsh.model.getBoundary([curve], combined=False)[0]
        target = size(*gmsh.model.getValue(*vertex, [])) * (1.0 + 1e-9)
        length = gmsh.model.occ.getMass(*curve)
        number = circle
        while length / number > target:
            number *= 2
        gmsh.model.mesh.setTransfiniteCurve(curve[1], number + 1)


def _collect(
    gmsh: ModuleType,
    name: str,
    bodies: Mapping[str, Sequence[int]],
    faces: Sequence[NamedFace],
    axes: Sequence[BendAxis],
) -> NamedMesh:
    """The current gmsh model as arrays, curved safely, with every boundary facet named."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int32)
    index[tags] = np.arange(len(tags), dtype=np.int32)
    points = np.ascontiguousarray(coordinates.reshape(-1, 3))

    blocks: list[IndexArray] = []
    named_bodies: dict[str, IndexArray] = {}
    start = 0
    for body, volumes in bodies.items():
        block = np.concatenate([_elements(gmsh, TETRAHEDRON_10, volume, index) for volume in volumes])
        blocks.append(block[:, reference_elements.TETRAHEDRON_10.gmsh_order])
        named_bodies[body] = np.arange(start, start + len(block), dtype=np.int32)
        start += len(block)
    cells = np.concatenate(blocks)

    triangles = {tag: _elements(gmsh, TRIANGLE_6, tag, index) for _, tag in gmsh.model.getEntities(2)}
    surfaces = _name_triangles(name, points, cells, triangles, faces)
    points = bend_round_axes(points, cells, _free_nodes(gmsh, index, points), axes)
    points = straighten_inverted(points, cells, name)
    used = _distinct(cells, len(points))
    index = np.zeros(len(points), dtype=np.int32)
    index[used] = np.arange(len(used), dtype=np.int32)
    surfaces = {face: index[corners] for face, corners in surfaces.items()}
    return named_mesh(points[used], index[cells], named_bodies, surfaces)


def _distinct(nodes: IndexArray, n_nodes: int) -> IndexArray:
    """Nodes that occur in an array, in their order."""
    met = np.zeros(n_nodes, dtype=bool)
    met[nodes] = True
    return np.flatnonzero(met).astype(np.int32)


def _elements(gmsh: ModuleType, kind: int, tag: int, index: IndexArray) -> IndexArray:
    """Nodes of the elements of one type on one entity, in gmsh's order."""
    nodes = {TETRAHEDRON_10: 10, TRIANGLE_6: 6}[kind]
    _, node_tags = gmsh.model.mesh.getElementsByType(kind, tag)
    return np.asarray(index[node_tags.astype(np.int64).reshape(-1, nodes)])


def _free_nodes(gmsh: ModuleType, index: IndexArray, points: FloatArray) -> NDArray[np.bool_]:
    """Nodes that may move across x: those inside volumes and inside flat faces of constant x."""
    free = np.zeros(len(points), dtype=bool)
    for entity in gmsh.model.getEntities(2) + gmsh.model.getEntities(3):
        nodes = index[gmsh.model.mesh.getNodes(*entity)[0]]
        if entity[0] == 3 or (len(nodes) and np.ptp(points[nodes, 0]) < TOLERANCE):
            free[nodes] = True
    return free


def _name_triangles(
    name: str,
    points: FloatArray,
    cells: IndexArray,
    triangles: Mapping[int, IndexArray],
    faces: Sequence[NamedFace],
) -> dict[str, IndexArray]:
    """Corners (k, 3) of the facets of every named surface, from the triangles of every face of the geometry.

    Interfaces between two bodies are left out. Raises MeshError unless every facet on the boundary of the
    cells gets exactly one name and every surface gets a facet.
    """
    table = facet_table(cells, len(points))
    boundary = table.keys[table.on_boundary]
    parts: dict[str, list[IndexArray]] = {face.name: [] for face in faces}
    for tag, nodes in triangles.items():
        corners = nodes[:, :3]
        keys = facet_keys(corners, len(points))
        place = np.minimum(np.searchsorted(boundary, keys), len(boundary) - 1)
        outside = boundary[place] == keys
        if not outside.any():
            continue
        on_face = points[_distinct(corners, len(points))]
        names = [
            face.name for face in faces if any(patch.holds(on_face, TOLERANCE) for patch in face.patches)
        ]
        if len(names) != 1 or not outside.all():
            raise MeshError(
                f"{name}: face {tag} about {on_face.mean(axis=0).round(4).tolist()} m, "
                f"{np.count_nonzero(outside)} of {len(outside)} facets on the boundary, lies on "
                f"{names or 'no named surface'}; check for parts that touch or overlap"
            )
        parts[names[0]].append(corners)
    empty = [face for face, named in parts.items() if not named]
    total = sum(len(corners) for named in parts.values() for corners in named)
    if empty or total != len(boundary):
        raise MeshError(
            f"{name}: {total} of {len(boundary)} boundary facets are named, surfaces without any: "
            f"{', '.join(empty) or 'none'}; check for parts that touch or overlap"
        )
    return {face: np.concatenate(named) for face, named in parts.items()}


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
        if self.circle < LEAST_CIRCLE:
            raise GeometryError(
                f"mesh size circle = {self.circle} is below {LEAST_CIRCLE}; give {LEAST_CIRCLE} elements a turn or more"
            )

    def times(self, factor: float) -> Self:
        """So many times these sizes, elements a turn no fewer than possible."""
        if factor == 1.0:
            return self
        sizes = {
            name: factor * getattr(self, name)
            for name in ("wall", "field", "shaft", "seal", "bearing", "gear")
        }
        return replace(self, circle=max(LEAST_CIRCLE, round(self.circle / factor)), **sizes)


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
            for surface_radius, start, end, most in limits
            if abs(radius - surface_radius) < SAME and start - SAME < x < end + SAME
        ]
        if shaft.gear is not None:
            first, last = g.gear_limits(shaft)
            if radius > 0.5 * shaft.seat_diameter - SAME and first - SAME < x < last + SAME:
                on.append(sizes.gear)
        return min(sizes.shaft, 2.0 * math.pi * around / sizes.circle, *on)

    return size
