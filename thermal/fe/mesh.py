"""Second-order meshes of tetrahedra or hexahedra whose bodies and surfaces have names."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from thermal.errors import ThermalInputError
from thermal.fe.arrays import FloatArray, IndexArray

if TYPE_CHECKING:
    from thermal.fe.reference_elements import CellElement

# Nodes and cells numbered along a space-filling curve, so that neighbours in space are neighbours in memory.
#
# A mesher numbers nodes and cells in the order in which it made them, and assembly and products then wait for
# entries from all over the memory. Along Morton's curve the conduction matrices of a box of 386,000 nodes take
# 0.2 s instead of 0.8 s, a product in single precision 9 ms instead of 15 ms; reverse Cuthill-McKee gives the same
# for twice the time of numbering.
# Source: Bader, Space-Filling Curves, Springer 2013, ch. 7 and 10.

T = TypeVar("T", bound=np.generic)

BITS = 10
"""Halvings of every edge of the bounding cube: a thousand places along each."""


@dataclass(frozen=True)
class Numbering:
    """What the numbers of nodes and cells of a mesh were where it came from.

    nodes : (n_nodes,) number there of every node
    cells : (n_cells,) number there of every cell
    """

    nodes: IndexArray
    cells: IndexArray

    def given_nodes(self, values: NDArray[T]) -> NDArray[T]:
        """Nodal ``values`` (n_nodes, ...) in the order in which the nodes were given."""
        return values[inverse(self.nodes)]

    def given_cells(self, values: NDArray[T]) -> NDArray[T]:
        """``values`` (n_cells, ...) in the order in which the cells were given."""
        return values[inverse(self.cells)]


def along_curve(points: FloatArray, cells: IndexArray, bodies: Mapping[str, IndexArray]) -> Numbering:
    """Number nodes along the curve, and the cells of each body by their first node; bodies keep their places.

    points : (n_nodes, 3) [m]; cells : (n_cells, n_local); bodies : name -> (k,) cells
    """
    nodes = np.argsort(_places(points), kind="stable").astype(np.int32)
    first = inverse(nodes)[cells].min(axis=1)
    order = np.arange(len(cells), dtype=np.int32)
    for members in bodies.values():
        order[members] = members[np.argsort(first[members], kind="stable")]
    return Numbering(nodes, order)


def inverse(order: IndexArray) -> IndexArray:
    """(n,) place of 0, 1, ... in a permutation (n,)."""
    places = np.empty_like(order)
    places[order] = np.arange(len(order), dtype=order.dtype)
    return places


def _places(points: FloatArray) -> NDArray[np.int64]:
    """(n,) place of every point on Morton's curve: the bits of its three coordinates in turn."""
    low = points.min(axis=0)
    reach = max(float((points.max(axis=0) - low).max()), np.finfo(np.float64).tiny)
    cube = ((points - low) * ((2**BITS - 1) / reach)).astype(np.int64)
    spread = np.zeros(2**BITS, dtype=np.int64)
    for bit in range(BITS):
        spread |= ((np.arange(2**BITS) >> bit) & 1) << (3 * bit)
    x, y, z = spread[cube].T
    return np.asarray(x | y << 1 | z << 2)


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
        index, known = mesh.facets.find(facet_keys(corners[:, :n_corners], len(mesh.points)))
        if lost := np.count_nonzero(~known):
            raise MeshError(
                f"surface {name!r}: {lost} of {len(index)} facets are no side of any cell; "
                "take surfaces and cells from the same mesh"
            )
        surfaces[name] = mesh.facets.nodes_at(index).astype(np.int32)
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


# What a mesh must satisfy before anything is computed on it.

NODE_ORDER = 0.5
"""Share of inverted cells from which on the order of their nodes is at fault."""
MAX_NODES = 2_000_000
"""Facets are recognised by one 64-bit number made of three node numbers."""


def check_topology(mesh: NamedMesh) -> frozenset[str]:
    """Check numbering, bodies and surfaces of ``mesh``; return the surfaces that lie between two cells.

    Raises MeshError naming body or surface, the fault and what to do, if
    - an array has the wrong shape, a node number is out of range or a coordinate is no finite number,
    - a cell belongs to no body or to two, or a node to no cell,
    - a facet of a surface is no side of a cell or looks into its cell,
    - a facet on the boundary belongs to no surface or to two.
    """
    _check_arrays(mesh)
    _check_bodies(mesh)
    return _check_surfaces(mesh)


def check_volumes(mesh: NamedMesh, smallest: FloatArray) -> None:
    """Check that no cell is inverted.

    smallest : (n_cells,) smallest volume weight of each cell [m3]
    Raises MeshError with the number of inverted cells by body.
    """
    bad = smallest <= 0.0
    if not bad.any():
        return
    counts = {name: int(np.count_nonzero(bad[cells])) for name, cells in mesh.bodies.items()}
    where = ", ".join(f"{count} in body {name!r}" for name, count in counts.items() if count)
    remedy = "refine the mesh at curved faces, or optimise its high-order nodes"
    if bad.mean() > NODE_ORDER:
        remedy = (
            "so many stand for another order of nodes: write a .msh in gmsh's order, in which the last two nodes of a "
            "ten-node tetrahedron are exchanged against VTK's, or put them into NamedMesh order"
        )
    raise MeshError(f"inverted cells: {where} of {len(bad)}; {remedy}")


def _check_arrays(mesh: NamedMesh) -> None:
    if mesh.points.ndim != 2 or mesh.points.shape[1] != 3 or not np.isfinite(mesh.points).all():
        raise MeshError(f"points of shape {mesh.points.shape}: need (n_nodes, 3) finite coordinates [m]")
    if not len(mesh.cells):
        raise MeshError("the mesh has no cells; mesh at least one body")
    columns = mesh.shape.side.n_nodes
    if len(mesh.points) > MAX_NODES:
        raise MeshError(f"{len(mesh.points)} nodes are above the limit of {MAX_NODES}; use larger cells")
    for name, nodes in {"cells": mesh.cells, **mesh.surfaces}.items():
        if nodes.size and (nodes.min() < 0 or nodes.max() >= len(mesh.points)):
            raise MeshError(f"{name}: node number outside of 0 to {len(mesh.points) - 1}")
    for name, nodes in mesh.surfaces.items():
        if nodes.ndim != 2 or nodes.shape[1] != columns or not len(nodes):
            raise MeshError(
                f"surface {name!r} of shape {nodes.shape}: need (k, {columns}) nodes, k at least 1"
            )


def _check_bodies(mesh: NamedMesh) -> None:
    owners = np.zeros(len(mesh.cells), dtype=np.int64)
    for name, cells in mesh.bodies.items():
        if not len(cells) or cells.min() < 0 or cells.max() >= len(mesh.cells):
            raise MeshError(f"body {name!r}: empty, or a cell number outside of 0 to {len(mesh.cells) - 1}")
        np.add.at(owners, cells, 1)
    if (owners != 1).any():
        raise MeshError(
            f"{np.count_nonzero(owners == 0)} cells are in no body and {np.count_nonzero(owners > 1)} in "
            "several; give every cell exactly one"
        )
    loose = np.count_nonzero(np.bincount(mesh.cells.ravel(), minlength=len(mesh.points)) == 0)
    if loose:
        raise MeshError(f"{loose} nodes belong to no cell; remove them and renumber")


def _check_surfaces(mesh: NamedMesh) -> frozenset[str]:
    table = mesh.facets
    n_corners = mesh.shape.side.n_corners
    on_boundary = table.on_boundary
    covered = np.zeros(len(table.keys), dtype=np.int64)
    interfaces = set()
    for name, nodes in mesh.surfaces.items():
        index, _ = table.find(facet_keys(nodes[:, :n_corners], len(mesh.points)))
        outward = _same_side(nodes, table.nodes_at(index), n_corners)
        inner = ~on_boundary[index]
        second = np.minimum(index + 1, len(table.keys) - 1)
        outward |= inner & _same_side(nodes, table.nodes_at(second), n_corners)
        if not outward.all():
            raise MeshError(
                f"surface {name!r}: {np.count_nonzero(~outward)} of {len(nodes)} facets are no side of a cell"
                " or look into their cell; build surfaces with thermal.fe.mesh.named_mesh"
            )
        if inner.any() and not inner.all():
            raise MeshError(f"surface {name!r} lies partly on the boundary, partly inside; split it in two")
        if inner.any():
            interfaces.add(name)
        np.add.at(covered, index, 1)
    if (covered > 1).any():
        raise MeshError(f"{np.count_nonzero(covered > 1)} facets belong to two surfaces; assign each once")
    open_facets = table.nodes_at(np.flatnonzero(on_boundary & (covered == 0)))
    if len(open_facets):
        centre = mesh.points[open_facets[0, :n_corners]].mean(axis=0)
        raise MeshError(
            f"{len(open_facets)} boundary facets belong to no surface, one at x, y, z = "
            f"{centre[0]:.6g}, {centre[1]:.6g}, {centre[2]:.6g} m; name them"
        )
    return frozenset(interfaces)


def _same_side(
    nodes: IndexArray, reference: IndexArray, n_corners: int
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether facets have the same nodes as the reference, corners and mid-sides up to a cyclic shift."""
    same = np.zeros(len(nodes), dtype=np.bool_)
    for shift in range(n_corners):
        turn = [(k + shift) % n_corners for k in range(n_corners)]
        order = [*turn, *(n_corners + k for k in turn), *range(2 * n_corners, nodes.shape[1])]
        same |= np.all(nodes == reference[:, order], axis=1)
    return same
