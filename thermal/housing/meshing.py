"""Meshing by gmsh: one solid component at a time, in memory, single-threaded, with named faces.

A component is a set of volumes that share nodes (housing and field; a shaft and its gear). Components are
meshed in separate gmsh models, so that parts that overlap in space, as the discs of two meshing gears may,
never meet.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any

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
from thermal.housing.shaft_surfaces import NamedFace

TETRAHEDRON_10, TRIANGLE_6 = 11, 9
"""gmsh's numbers of the two element types."""
TOLERANCE = 1e-6
"""Distance [m] within which a node lies on a named patch."""

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
    _, found = gmsh.model.mesh.getElementsByType(kind, tag)
    return np.asarray(index[found.astype(np.int64).reshape(-1, nodes)])


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
        found = [
            face.name for face in faces if any(patch.holds(on_face, TOLERANCE) for patch in face.patches)
        ]
        if len(found) != 1 or not outside.all():
            raise MeshError(
                f"{name}: face {tag} about {on_face.mean(axis=0).round(4).tolist()} m, "
                f"{np.count_nonzero(outside)} of {len(outside)} facets on the boundary, lies on "
                f"{found or 'no named surface'}; check for parts that touch or overlap"
            )
        parts[found[0]].append(corners)
    empty = [face for face, found in parts.items() if not found]
    total = sum(len(corners) for found in parts.values() for corners in found)
    if empty or total != len(boundary):
        raise MeshError(
            f"{name}: {total} of {len(boundary)} boundary facets are named, surfaces without any: "
            f"{', '.join(empty) or 'none'}; check for parts that touch or overlap"
        )
    return {face: np.concatenate(found) for face, found in parts.items()}
