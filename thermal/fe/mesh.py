"""Second-order tetrahedral meshes whose bodies and surfaces have names."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

CELL_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
"""Corner pairs of the mid-side nodes 4 to 9 of a cell."""

CELL_FACETS = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])
"""The four 6-node triangles of a cell, corners first, normals outwards."""

GMSH_NODE_ORDER = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)
"""``gmsh_cells[:, GMSH_NODE_ORDER]`` is the node order of NamedMesh (gmsh numbers edge 23 before edge 13)."""


class MeshError(ValueError):
    """A mesh that cannot be computed with; the message names body or surface, the fault and the remedy."""


@dataclass(frozen=True)
class NamedMesh:
    """A mesh of 10-node tetrahedra (VTK node order) with named bodies and surfaces.

    points : (n_nodes, 3) coordinates [m]
    cells : (n_cells, 10) node indices, corners first, mid-side nodes 01 12 20 03 13 23
    bodies : name -> (k,) cell indices; every cell belongs to exactly one body
    surfaces : name -> (k, 6) node indices of 6-node triangles, corners first, mid-sides 01 12 20, normal
        pointing out of the body they bound; every facet on the boundary of the mesh belongs to exactly one
        surface. An interface between two bodies that share nodes may be named too (it then has one side).
    """

    points: FloatArray
    cells: IndexArray
    bodies: dict[str, IndexArray]
    surfaces: dict[str, IndexArray]


@dataclass(frozen=True)
class FacetTable:
    """All facets of all cells, sorted so that two cells' sides of one facet are neighbours.

    keys : (4 n_cells,) one number per set of three corners, ascending
    cells : (4 n_cells,) cell that owns the side
    nodes : (4 n_cells, 6) nodes, normal out of that cell
    """

    keys: NDArray[np.int64]
    cells: IndexArray
    nodes: IndexArray

    @property
    def on_boundary(self) -> NDArray[np.bool_]:
        """(4 n_cells,) True where no second cell has the same facet."""
        same = self.keys[1:] == self.keys[:-1]
        return np.asarray(~(np.append(same, False) | np.append(False, same)))


def facet_keys(corners: IndexArray, n_nodes: int) -> NDArray[np.int64]:
    """One number per set of three corner nodes, whatever their order. corners : (n, 3)."""
    a, b, c = np.sort(corners.astype(np.int64), axis=1).T
    return np.asarray((a * n_nodes + b) * n_nodes + c)


def facet_table(cells: IndexArray, n_nodes: int) -> FacetTable:
    """Collect the facets of (n, 10) ``cells``; see FacetTable. ``n_nodes`` below 2 million."""
    nodes = cells[:, CELL_FACETS].reshape(-1, 6)
    keys = facet_keys(nodes[:, :3], n_nodes)
    order = np.argsort(keys, kind="stable")
    return FacetTable(keys[order], (order // 4).astype(np.int32), nodes[order].astype(np.int32))


def named_mesh(
    points: FloatArray,
    cells: IndexArray,
    bodies: Mapping[str, IndexArray],
    surface_corners: Mapping[str, IndexArray],
) -> NamedMesh:
    """Make a mesh from second-order cells and surfaces of which only corner nodes are known.

    points : (n_nodes, 3) [m]; cells : (n_cells, 10) in NamedMesh order (see GMSH_NODE_ORDER)
    bodies : name -> (k,) cell indices
    surface_corners : name -> (k, >= 3) node indices, corners first, in any orientation

    Facets are found by their corners and take mid-side nodes and orientation from the cell they bound (the
    first one at an interface). Raises MeshError if a facet of a surface is no side of any cell.
    """
    table = facet_table(cells, len(points))
    surfaces = {}
    for name, corners in surface_corners.items():
        keys = facet_keys(corners[:, :3], len(points))
        at = np.minimum(np.searchsorted(table.keys, keys), len(table.keys) - 1)
        lost = int(np.count_nonzero(table.keys[at] != keys))
        if lost:
            raise MeshError(
                f"surface {name!r}: {lost} of {len(keys)} facets are no side of any cell; "
                "take surfaces and cells from the same mesh"
            )
        surfaces[name] = table.nodes[at]
    as_index = {name: np.asarray(index, dtype=np.int32) for name, index in bodies.items()}
    return NamedMesh(np.ascontiguousarray(points), cells.astype(np.int32), as_index, surfaces)


def second_order(
    points: FloatArray,
    tetrahedra: IndexArray,
    bodies: Mapping[str, IndexArray],
    surface_corners: Mapping[str, IndexArray],
) -> NamedMesh:
    """Raise a mesh of 4-node tetrahedra to second order with straight edges.

    points : (n, 3) [m]; tetrahedra : (n_cells, 4) in any orientation; bodies and surface_corners as in
    named_mesh. The corner nodes keep their numbers, mid-side nodes follow.
    """
    tetrahedra = _turned(points, tetrahedra, (0, 2, 1, 3))
    edges = np.sort(tetrahedra[:, np.array(CELL_EDGES)].reshape(-1, 2), axis=1)
    unique, which = np.unique(edges, axis=0, return_inverse=True)
    mids = 0.5 * (points[unique[:, 0]] + points[unique[:, 1]])
    cells = np.hstack([tetrahedra, len(points) + which.reshape(-1, 6)]).astype(np.int32)
    return named_mesh(np.vstack([points, mids]), cells, bodies, surface_corners)


def from_scikit_fem(mesh: Any) -> NamedMesh:
    """Convert a scikit-fem ``MeshTet1`` or ``MeshTet2`` with its subdomains and boundaries.

    Cells outside of every subdomain form the body ``rest``, boundary facets outside of every named boundary
    the surface ``rest``.
    """
    bodies = {name: np.asarray(ix, dtype=np.int32) for name, ix in (mesh.subdomains or {}).items()}
    named = np.concatenate([*bodies.values(), np.empty(0, dtype=np.int32)])
    if len(rest := np.setdiff1d(np.arange(mesh.t.shape[1]), named)):
        bodies["rest"] = rest.astype(np.int32)
    facets = {name: np.asarray(ix) for name, ix in (mesh.boundaries or {}).items()}
    if len(rest := np.setdiff1d(mesh.boundary_facets(), np.concatenate([*facets.values(), []]))):
        facets["rest"] = rest
    corners = {name: mesh.facets[:, ix].T for name, ix in facets.items()}
    if len(mesh.dofs.element_dofs) == 4:
        return second_order(mesh.p.T, mesh.t.T, bodies, corners)
    cells = _turned(mesh.doflocs.T, mesh.dofs.element_dofs.T, (0, 2, 1, 3, 6, 5, 4, 7, 9, 8))
    return named_mesh(mesh.doflocs.T, cells, bodies, corners)


def _turned(points: FloatArray, cells: IndexArray, order: tuple[int, ...]) -> IndexArray:
    """Cells with the nodes of left-handed ones put into ``order``."""
    edges = points[cells[:, 1:4]] - points[cells[:, :1]]
    left_handed = np.linalg.det(edges) < 0.0
    return np.where(left_handed[:, None], cells[:, list(order)], cells)


def box_mesh(
    size: tuple[float, float, float],
    divisions: tuple[int, int, int],
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
    name: str = "box",
) -> NamedMesh:
    """Structured mesh of a box: every brick of ``divisions`` becomes six tetrahedra.

    size, origin : edge lengths and lowest corner [m]. One body ``name``; surfaces ``x_min``, ``x_max``,
    ``y_min``, ``y_max``, ``z_min``, ``z_max``. Raises MeshError for an edge or division that is not positive.
    """
    if min(size) <= 0.0 or min(divisions) < 1:
        raise MeshError(f"box of size {size} m in {divisions} divisions: every entry must be positive")
    steps = 2 * np.array(divisions)
    axes = [origin[i] + np.linspace(0.0, size[i], steps[i] + 1) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    cells = _brick_cells(divisions)
    table = facet_table(cells, len(points))
    outer = table.nodes[table.on_boundary]
    grid = np.stack(np.unravel_index(outer, steps + 1), axis=-1)
    surfaces = {}
    for i, axis in enumerate("xyz"):
        surfaces[f"{axis}_min"] = outer[np.all(grid[:, :, i] == 0, axis=1)]
        surfaces[f"{axis}_max"] = outer[np.all(grid[:, :, i] == steps[i], axis=1)]
    return NamedMesh(points, cells, {name: np.arange(len(cells), dtype=np.int32)}, surfaces)


def _brick_cells(divisions: tuple[int, int, int]) -> IndexArray:
    """Kuhn's six tetrahedra in every brick, as indices into the grid of corners and mid-points."""
    bricks = 2 * np.stack(np.meshgrid(*map(np.arange, divisions), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    shape = tuple(2 * np.array(divisions) + 1)
    cells = []
    for order in permutations(range(3)):
        path = np.zeros((4, 3), dtype=np.int64)
        for i, axis in enumerate(order):
            path[i + 1 :, axis] = 2
        if np.linalg.det(path[1:] - path[0]) < 0.0:
            path = path[[0, 2, 1, 3]]
        mids = np.array([(path[a] + path[b]) // 2 for a, b in CELL_EDGES])
        cells.append(np.ravel_multi_index(tuple((bricks + np.vstack([path, mids])).T), shape).T)
    return np.stack(cells, axis=1).reshape(-1, 10).astype(np.int32)


def disjoint_union(*meshes: NamedMesh) -> NamedMesh:
    """Put meshes beside each other without joining nodes; body and surface names must differ.

    Raises MeshError naming a body or surface that occurs twice.
    """
    bodies: dict[str, IndexArray] = {}
    surfaces: dict[str, IndexArray] = {}
    n_nodes = n_cells = 0
    cells = []
    for mesh in meshes:
        twice = sorted((bodies.keys() & mesh.bodies.keys()) | (surfaces.keys() & mesh.surfaces.keys()))
        if twice:
            raise MeshError(f"{', '.join(twice)}: name occurs in more than one mesh; rename before joining")
        bodies |= {name: (index + n_cells).astype(np.int32) for name, index in mesh.bodies.items()}
        surfaces |= {name: (nodes + n_nodes).astype(np.int32) for name, nodes in mesh.surfaces.items()}
        cells.append(mesh.cells + n_nodes)
        n_nodes += len(mesh.points)
        n_cells += len(mesh.cells)
    points = np.vstack([mesh.points for mesh in meshes])
    return NamedMesh(points, np.vstack(cells).astype(np.int32), bodies, surfaces)
