"""Meshing by gmsh: one solid component at a time, in memory, single-threaded, with named faces.

A component is a set of volumes that share nodes (housing and field; a shaft and its gear). Components are
meshed in separate gmsh models, so that parts that overlap in space, as the tip discs of two meshing gears do,
never meet. gmsh is imported when a mesh is built; a machine that lacks one of its system libraries gets the
loader's own OSError.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thermal.fe.mesh import FloatArray, IndexArray
from thermal.housing_surfaces import NamedFace

GMSH_TO_VTK = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)
"""gmsh numbers the last two mid-side nodes of a tetrahedron 23, 13; VTK 13, 23."""
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
"""Corners of the edges on which nodes 4 to 9 of a tetrahedron lie."""
FACETS = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
"""Corners of the facets of a tetrahedron, normals outwards."""
FACET_MIDDLES = ((6, 5, 4), (4, 8, 7), (5, 9, 8), (6, 7, 9))
"""Mid-side nodes of the same facets, on their edges 01, 12, 20."""
LEAST_JACOBIAN = 0.1
"""Least ratio of the smallest to the mean Jacobian of an element before its edges are straightened."""
TOLERANCE = 1e-6
"""Distance [m] within which a node lies on a named patch."""

BendAxis = tuple[float, float, float]
"""y and z of an axis along x, and the radius within which elements follow its circles [m]."""
SizeLaw = Callable[[float, float, float], float]
"""Target element size [m] at a corner of the geometry (x, y, z)."""


class MeshError(RuntimeError):
    """gmsh made no usable mesh; the message names the component and what is wrong with it."""


@dataclass(frozen=True)
class Component:
    """The mesh of one component.

    points : (n_nodes, 3) [m]
    cells : (n_cells, 10) in VTK order
    bodies : name -> cell indices
    surfaces : name -> (k, 6) facets, normals outwards
    """

    points: FloatArray
    cells: IndexArray
    bodies: dict[str, IndexArray]
    surfaces: dict[str, IndexArray]


@contextmanager
def gmsh_session() -> Iterator[ModuleType]:
    """A quiet, single-threaded gmsh, finalised in any case.

    Raises OSError or ImportError, unchanged, where gmsh or a shared library it needs is missing.
    """
    import gmsh

    gmsh.initialize(argv=["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        for option, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.RandomSeed": 1,
            "Mesh.Algorithm": 6,
            "Mesh.Algorithm3D": 1,
            "Mesh.MeshSizeFromPoints": 1,
            "Mesh.MeshSizeExtendFromBoundary": 1,
            "Mesh.MeshSizeFromCurvature": 0,
            "Mesh.Optimize": 1,
        }.items():
            gmsh.option.setNumber(option, value)
        yield gmsh
    finally:
        gmsh.finalize()


def mesh_component(
    gmsh: ModuleType,
    name: str,
    draw: Callable[[Any], Mapping[str, Sequence[int]]],
    faces: Sequence[NamedFace],
    size: SizeLaw,
    circle: int,
    axes: Sequence[BendAxis],
) -> Component:
    """Draw, mesh and name one component.

    draw : makes the solids with the OCC kernel it is given and returns body name -> volume tags
    faces : every surface of the component; each face of the geometry must lie in exactly one of them
    size : element size at the corners of the geometry; between them gmsh interpolates
    circle : least number of elements round a full circle

    Raises MeshError if gmsh fails, a face has no name or two, or an element stays inverted.
    """
    gmsh.model.add(name)
    try:
        bodies = draw(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        for point in gmsh.model.getEntities(0):
            gmsh.model.mesh.setSize([point], size(*gmsh.model.getValue(0, point[1], [])))
        _divide_circles(gmsh, size, circle)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        return _collect(gmsh, name, bodies, faces, axes)
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

    Concentric circles start at the same angle, so their nodes line up: a narrow ring between two of them (the
    shoulder of a shaft) then holds curved elements that do not cross.
    """
    for dimension, tag in gmsh.model.getEntities(1):
        if gmsh.model.getType(dimension, tag) != "Circle" or gmsh.model.getBoundary([(dimension, tag)]):
            continue
        vertex = gmsh.model.getBoundary([(dimension, tag)], combined=False)[0]
        target = size(*gmsh.model.getValue(*vertex, [])) * (1.0 + 1e-9)
        length = gmsh.model.occ.getMass(dimension, tag)
        number = circle
        while length / number > target:
            number *= 2
        gmsh.model.mesh.setTransfiniteCurve(tag, number + 1)


def _collect(
    gmsh: ModuleType,
    name: str,
    bodies: Mapping[str, Sequence[int]],
    faces: Sequence[NamedFace],
    axes: Sequence[BendAxis],
) -> Component:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int32)
    index[tags] = np.arange(len(tags), dtype=np.int32)

    blocks, named_bodies, start = [], {}, 0
    for body, volumes in bodies.items():
        block = np.concatenate([_elements(gmsh, 3, volume, 10, index) for volume in volumes])
        blocks.append(block[:, GMSH_TO_VTK])
        named_bodies[body] = np.arange(start, start + len(block), dtype=np.int32)
        start += len(block)
    cells = np.ascontiguousarray(np.concatenate(blocks), dtype=np.int32)
    points = np.ascontiguousarray(coordinates.reshape(-1, 3))
    points = _bend_round_axes(points, cells, _free_nodes(gmsh, index, points), axes)
    points = straighten_inverted(points, cells, name)

    facets = boundary_facets(cells)
    owner = _name_facets(gmsh, name, points, index, facets, faces)
    surfaces = {face.name: facets[owner == number] for number, face in enumerate(faces)}
    return _without_orphans(Component(points, cells, named_bodies, surfaces))


def _free_nodes(gmsh: ModuleType, index: IndexArray, points: FloatArray) -> NDArray[np.bool_]:
    """Nodes that may move across x: those inside volumes and inside flat faces of constant x."""
    free = np.zeros(len(points), dtype=bool)
    for dimension in (2, 3):
        for _, tag in gmsh.model.getEntities(dimension):
            nodes = index[gmsh.model.mesh.getNodes(dimension, tag)[0]]
            if dimension == 3 or (len(nodes) and np.ptp(points[nodes, 0]) < TOLERANCE):
                free[nodes] = True
    return free


def _bend_round_axes(
    points: FloatArray, cells: IndexArray, free: NDArray[np.bool_], axes: Sequence[BendAxis]
) -> FloatArray:
    """Let the inside of a mesh follow the circles on its boundary, so that no element turns inside out.

    The middle of a free edge moves radially to the mean radius of its ends, as it does by itself on a circle.
    The shift fades out between one and two times ``reach``; chords longer than a quarter turn stay straight.
    """
    points = points.copy()
    for middle, (first, second) in enumerate(EDGES, start=4):
        nodes, where = np.unique(cells[:, middle], return_index=True)
        where, nodes = where[free[nodes]], nodes[free[nodes]]
        start, end = points[cells[where, first]], points[cells[where, second]]
        for y, z, reach in axes:
            axis = np.array([y, z])
            chord = 0.5 * (start + end)[:, 1:] - axis
            radius = np.linalg.norm(chord, axis=1)
            ends = [np.linalg.norm(end_point[:, 1:] - axis, axis=1) for end_point in (start, end)]
            mean = 0.5 * (ends[0] + ends[1])
            weight = np.clip(2.0 - mean / reach, 0.0, 1.0) * (radius > np.sqrt(0.5) * mean)
            scale = np.ones_like(mean)
            np.divide(mean, radius, out=scale, where=weight > 0.0)
            chosen = weight > 0.0
            points[nodes[chosen], 1:] = (axis + chord * (1.0 + weight * (scale - 1.0))[:, None])[chosen]
    return points


def _elements(gmsh: ModuleType, dimension: int, tag: int, nodes: int, index: IndexArray) -> IndexArray:
    kind = {10: 11, 6: 9}[nodes]
    _, found = gmsh.model.mesh.getElementsByType(kind, tag)
    numbers: IndexArray = index[found.reshape(-1, nodes).astype(np.int64)]
    return numbers


def _name_facets(
    gmsh: ModuleType,
    name: str,
    points: FloatArray,
    index: IndexArray,
    facets: IndexArray,
    faces: Sequence[NamedFace],
) -> NDArray[np.int64]:
    """Number in ``faces`` of every boundary facet of the cells, by the geometric face it lies on."""
    place = {key: number for number, key in enumerate(map(tuple, np.sort(facets[:, :3], axis=1).tolist()))}
    owner = np.full(len(facets), -1, dtype=np.int64)
    for _, tag in gmsh.model.getEntities(2):
        triangles = _elements(gmsh, 2, tag, 6, index)
        numbers = [place.get(key, -1) for key in map(tuple, np.sort(triangles[:, :3], axis=1).tolist())]
        if -1 in numbers:
            if any(number >= 0 for number in numbers):
                raise MeshError(f"{name}: face {tag} lies partly inside the component")
            continue  # an interface between two bodies
        corners = points[np.unique(triangles[:, :3])]
        found = [k for k, face in enumerate(faces) if any(p.holds(corners, TOLERANCE) for p in face.patches)]
        if len(found) != 1:
            raise MeshError(
                f"{name}: face {tag} about {corners.mean(axis=0).round(4).tolist()} m lies in "
                f"{[faces[k].name for k in found] or 'no named surface'}"
            )
        owner[numbers] = found[0]
    if np.any(owner < 0):
        raise MeshError(f"{name}: {int(np.sum(owner < 0))} boundary facets lie on no face of the geometry")
    empty = [face.name for k, face in enumerate(faces) if not np.any(owner == k)]
    if empty:
        raise MeshError(f"{name}: no facet lies on the surfaces {', '.join(empty)}")
    return owner


def boundary_facets(cells: IndexArray) -> IndexArray:
    """Facets (k, 6) that belong to one cell only, corners first, normals out of the cells (n, 10)."""
    facets = np.concatenate([cells[:, list(c + m)] for c, m in zip(FACETS, FACET_MIDDLES)])
    _, first, count = np.unique(np.sort(facets[:, :3], axis=1), axis=0, return_index=True, return_counts=True)
    boundary: IndexArray = facets[np.sort(first[count == 1])]
    return boundary


def jacobian_ratio(points: FloatArray, cells: IndexArray) -> FloatArray:
    """Smallest over mean Jacobian of each ten-node tetrahedron (n_cells,), sampled at its ten nodes.

    1 for straight edges with mid-side nodes in the middle; 0 or less for an inverted element.
    """
    corners = points[cells[:, :4]]
    mean = np.linalg.det(corners[:, 1:] - corners[:, :1])
    nodes = points[cells]
    least = np.full(len(cells), np.inf)
    for local in _NODE_GRADIENTS:
        jacobian = np.einsum("eni,nj->eij", nodes, local)
        least = np.minimum(least, np.linalg.det(jacobian))
    ratio = np.full(len(cells), -np.inf)
    np.divide(least, mean, out=ratio, where=mean > 0.0)
    return ratio


def straighten_inverted(points: FloatArray, cells: IndexArray, name: str = "mesh") -> FloatArray:
    """Points with the mid-side nodes of badly curved elements moved back onto the chord of their edge.

    Coarse second-order elements on a tight cylinder may turn inside out; a straight-sided element cannot.
    Raises MeshError if an element is inverted although its edges are straight.
    """
    points = points.copy()
    straight = np.zeros(len(cells), dtype=bool)
    while True:
        bad = jacobian_ratio(points, cells) < LEAST_JACOBIAN
        if not bad.any():
            return points
        if np.any(bad & straight):
            raise MeshError(
                f"{name}: {int(np.sum(bad & straight))} elements are inverted; choose a finer mesh"
            )
        straight |= bad
        for middle, (first, second) in enumerate(EDGES, start=4):
            chosen = cells[bad]
            points[chosen[:, middle]] = 0.5 * (points[chosen[:, first]] + points[chosen[:, second]])


def _without_orphans(component: Component) -> Component:
    """Drop nodes that no cell uses (vertices of construction lines)."""
    used = np.unique(component.cells)
    if len(used) == len(component.points):
        return component
    renumber = np.full(len(component.points), -1, dtype=np.int32)
    renumber[used] = np.arange(len(used), dtype=np.int32)
    return Component(
        component.points[used],
        renumber[component.cells],
        component.bodies,
        {name: renumber[facets] for name, facets in component.surfaces.items()},
    )


def _node_gradients() -> FloatArray:
    """Gradients of the ten shape functions at the ten nodes: (10 nodes, 10 functions, 3) in r, s, t."""
    corner = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    nodes = np.concatenate([corner, [(corner[a] + corner[b]) / 2.0 for a, b in EDGES]])
    slope = np.array([[-1.0, -1.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    barycentric = np.column_stack([1.0 - nodes.sum(axis=1), nodes])
    gradients = np.empty((10, 10, 3))
    for i in range(4):
        gradients[:, i] = (4.0 * barycentric[:, i, None] - 1.0) * slope[i]
    for k, (a, b) in enumerate(EDGES, start=4):
        gradients[:, k] = 4.0 * (barycentric[:, a, None] * slope[b] + barycentric[:, b, None] * slope[a])
    return gradients


_NODE_GRADIENTS = _node_gradients()
