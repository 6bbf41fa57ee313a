"""Second-order meshes of tetrahedra or hexahedra whose bodies and surfaces have names."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from thermal.errors import ThermalInputError
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.numbering import Numbering

if TYPE_CHECKING:
    from thermal.fe.reference_elements import CellElement

__all__ = [
    "FacetTable",
    "FloatArray",
    "IndexArray",
    "MeshError",
    "NamedMesh",
    "box_mesh",
    "cell_shape",
    "disjoint_union",
    "facet_keys",
    "facet_table",
    "named_mesh",
    "whole_surfaces",
]

CellName = Literal["tetra10", "hexahedron20", "hexahedron27"]


class MeshError(ThermalInputError):
    """A mesh that cannot be computed with; the message names body or surface, the fault and the remedy."""


@dataclass(frozen=True)
class NamedMesh:
    """A mesh of one kind of second-order cell (VTK node order) with named bodies and surfaces.

    points : (n_nodes, 3) coordinates [m]
    cells : (n_cells, 10, 20 or 27) node indices of tetrahedra or hexahedra, see reference_elements
    bodies : name -> (k,) cell indices; every cell belongs to exactly one body
    surfaces : name -> (k, 6, 8 or 9) node indices of second-order triangles or quadrilaterals, corners first,
        normal pointing out of the body they bound; every facet on the boundary of the mesh belongs to exactly
        one surface. An interface between two bodies that share nodes may be named too (it then has one side).
    numbering : numbers of nodes and cells where the mesh was read from; None where they are its own
    """

    points: FloatArray
    cells: IndexArray
    bodies: dict[str, IndexArray]
    surfaces: dict[str, IndexArray]
    numbering: Numbering | None = None

    @property
    def shape(self) -> "CellElement":
        """The kind of cell. Raises MeshError for a number of nodes that no cell has."""
        return cell_shape(self.cells)

    @cached_property
    def facets(self) -> "FacetTable":
        """All sides of all cells."""
        return facet_table(self.cells, len(self.points))


def cell_shape(cells: IndexArray) -> "CellElement":
    """The element with as many nodes as ``cells`` (n, n_local) has columns.

    scikit-fem is imported here, at the first mesh: a case that cannot be read answers without it.
    """
    from thermal.fe.reference_elements import CELLS

    if cells.ndim != 2 or cells.shape[1] not in CELLS:
        names = ", ".join(f"{n} ({shape.name})" for n, shape in CELLS.items())
        raise MeshError(f"cells of shape {cells.shape}: need (n_cells, n) with n of {names}")
    return CELLS[cells.shape[1]]


@dataclass(frozen=True)
class FacetTable:
    """All sides of all cells, sorted so that two cells' sides of one facet are neighbours; n = all sides.

    keys : (n,) one number per set of corners, ascending
    cells : (n,) cell that owns the side
    sides : (n,) number of the side in its cell
    mesh_cells : (n_cells, n_local) nodes of all cells
    """

    keys: NDArray[np.int64]
    cells: IndexArray
    sides: IndexArray
    mesh_cells: IndexArray

    def nodes_at(self, rows: NDArray[np.integer[Any]]) -> IndexArray:
        """(k, n_local) nodes of k rows of the table, normal out of the cell that owns the side."""
        local = cell_shape(self.mesh_cells).sides[self.sides[rows]]
        return np.take_along_axis(self.mesh_cells[self.cells[rows]], local, axis=1)

    @cached_property
    def nodes(self) -> IndexArray:
        """(n, n_local) nodes of every row; see `nodes_at`."""
        return self.nodes_at(np.arange(len(self.keys)))

    def find(self, keys: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """First row (k,) of each of ``keys`` (k,), and whether there is one; some row where there is none."""
        rows = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return rows, np.asarray(self.keys[rows] == keys)

    @property
    def on_boundary(self) -> NDArray[np.bool_]:
        """(n,) True where no second cell has the same facet."""
        same = self.keys[1:] == self.keys[:-1]
        return np.asarray(~(np.append(same, False) | np.append(False, same)))


def facet_keys(corners: IndexArray, n_nodes: int) -> NDArray[np.int64]:
    """One number per set of corner nodes, whatever their order: the three smallest name a side.

    corners : (n, 3 or 4); ``n_nodes`` below 2 million
    """
    a, b, c = np.sort(corners.astype(np.int64), axis=1).T[:3]
    return np.asarray((a * n_nodes + b) * n_nodes + c)


def facet_table(cells: IndexArray, n_nodes: int) -> FacetTable:
    """Collect the sides of (n, n_local) ``cells``; see FacetTable. ``n_nodes`` below 2 million."""
    shape = cell_shape(cells)
    corners = cells[:, shape.sides[:, : shape.side.n_corners]].reshape(-1, shape.side.n_corners)
    keys = facet_keys(corners, n_nodes)
    order = np.argsort(keys, kind="stable")
    owners, sides = np.divmod(order.astype(np.int32), len(shape.sides))
    return FacetTable(keys[order], owners, sides, cells)


def named_mesh(
    points: FloatArray,
    cells: IndexArray,
    bodies: Mapping[str, IndexArray],
    surface_corners: Mapping[str, IndexArray],
) -> NamedMesh:
    """Make a mesh from second-order cells and surfaces of which only corner nodes are known.

    points : (n_nodes, 3) [m]; cells : (n_cells, n_local) in NamedMesh order (see CellElement.gmsh_order)
    bodies : name -> (k,) cell indices
    surface_corners : name -> (k, >= n_corners) node indices, corners first, in any orientation

    Facets are found by their corners and take mid-side nodes and orientation from the cell they bound (the
    first one at an interface). Raises MeshError if a facet of a surface is no side of any cell.
    """
    as_index = {name: np.asarray(index, dtype=np.int32) for name, index in bodies.items()}
    mesh = NamedMesh(np.ascontiguousarray(points), cells.astype(np.int32), as_index, {})
    mesh.surfaces.update(whole_surfaces(mesh, surface_corners))
    return mesh


def whole_surfaces(mesh: NamedMesh, surface_corners: Mapping[str, IndexArray]) -> dict[str, IndexArray]:
    """Surfaces of a mesh with all their nodes, oriented, from their corner nodes; see `named_mesh`."""
    n_corners = mesh.shape.side.n_corners
    surfaces = {}
    for name, corners in surface_corners.items():
        at, found = mesh.facets.find(facet_keys(corners[:, :n_corners], len(mesh.points)))
        if lost := np.count_nonzero(~found):
            raise MeshError(
                f"surface {name!r}: {lost} of {len(at)} facets are no side of any cell; "
                "take surfaces and cells from the same mesh"
            )
        surfaces[name] = mesh.facets.nodes_at(at).astype(np.int32)
    return surfaces


def _named(cell: CellName) -> "CellElement":
    from thermal.fe.reference_elements import CELLS

    return next(shape for shape in CELLS.values() if shape.name == cell)


def box_mesh(
    size: tuple[float, float, float],
    divisions: tuple[int, int, int],
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
    name: str = "box",
    cell: CellName = "tetra10",
) -> NamedMesh:
    """Structured mesh of a box: every brick of ``divisions`` becomes six tetrahedra or one hexahedron.

    size, origin : edge lengths and lowest corner [m]. One body ``name``; surfaces ``x_min``, ``x_max``,
    ``y_min``, ``y_max``, ``z_min``, ``z_max``. Raises MeshError for an edge or division that is not positive.
    """
    if min(size) <= 0.0 or min(divisions) < 1:
        raise MeshError(f"box of size {size} m in {divisions} divisions: every entry must be positive")
    steps = 2 * np.array(divisions)
    axes = [origin[i] + np.linspace(0.0, size[i], steps[i] + 1) for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    on_grid = _brick_cells(divisions, cell)
    used, packed = np.unique(on_grid, return_inverse=True)
    cells: IndexArray = packed.reshape(on_grid.shape).astype(np.int32)
    table = facet_table(cells, len(used))
    outer = table.nodes_at(np.flatnonzero(table.on_boundary))
    grid = np.stack(np.unravel_index(used[outer], steps + 1), axis=-1)
    surfaces = {}
    for i, axis in enumerate("xyz"):
        surfaces[f"{axis}_min"] = outer[np.all(grid[:, :, i] == 0, axis=1)]
        surfaces[f"{axis}_max"] = outer[np.all(grid[:, :, i] == steps[i], axis=1)]
    return NamedMesh(points[used], cells, {name: np.arange(len(cells), dtype=np.int32)}, surfaces)


def _brick_cells(divisions: tuple[int, int, int], cell: CellName) -> IndexArray:
    """Cells as indices into the grid of corners and mid-points."""
    bricks = 2 * np.stack(np.meshgrid(*map(np.arange, divisions), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    shape = tuple(2 * np.array(divisions) + 1)
    parts = [np.ravel_multi_index(tuple((bricks + nodes).T), shape).T for nodes in _nodes_in_brick(cell)]
    return np.stack(parts, axis=1).reshape(-1, parts[0].shape[1])


def _nodes_in_brick(cell: CellName) -> list[IndexArray]:
    """Places (n_local, 3) of the nodes of every cell in a brick of edge 2; tetrahedra are Kuhn's six."""
    shape = _named(cell)
    if shape.n_corners == 8:
        return [(2.0 * shape.nodes).astype(np.int32)]
    places = []
    for order in permutations(range(3)):
        path = np.zeros((4, 3), dtype=np.int32)
        for i, axis in enumerate(order):
            path[i + 1 :, axis] = 2
        if np.linalg.det(path[1:] - path[0]) < 0.0:
            path = path[[0, 2, 1, 3]]
        places.append(np.vstack([path, *((path[a] + path[b]) // 2 for a, b in shape.edges)]))
    return places


def disjoint_union(*meshes: NamedMesh) -> NamedMesh:
    """Combine meshes of one kind of cell without joining nodes; names must differ.

    Raises MeshError naming a body or surface that occurs twice, or the kinds of cells that do not go together.
    """
    if len(kinds := {mesh.shape.name for mesh in meshes}) > 1:
        raise MeshError(f"meshes of {', '.join(sorted(kinds))} in one; mesh all parts with one kind of cell")
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
