"""The second-order finite-element space on a named mesh and its linear sub-space, ready to assemble."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import skfem
from numpy.typing import NDArray
from scipy import sparse
from skfem.assembly import Dofs
from skfem.generic_utils import OrientedBoundary
from skfem.mapping import MappingIsoparametric

from thermal.fe import assembly, kernels
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.mesh import NamedMesh, check_topology, check_volumes, facet_keys
from thermal.fe.reference_elements import CellElement, QuadratureRule

# One of the two nested finite-element spaces of a mesh, ready to assemble, and the way between them.

STRAIGHT = 1e-9
"""A node counts as centred if it is off the middle of its corners by less than this share of the cell."""

Cells = IndexArray | slice
ALL = slice(None)


@dataclass(frozen=True, eq=False)
class Level:
    """Nodes, cells, geometry at the quadrature points and matrix pattern of a space."""

    n_nodes: int
    cells: IndexArray
    """(n_cells, n_local)"""
    values: FloatArray
    """(n_q, n_local) shape functions at the quadrature points of a cell."""
    tables: assembly.CellTables
    """Gradients and geometry at the quadrature points."""
    pattern: assembly.RowPattern
    """Rows of the matrix and the cells they gather from."""
    indices: IndexArray
    """(nnz,) columns of the matrix."""

    @classmethod
    def of(cls, points: FloatArray, cells: IndexArray, shape: CellElement) -> "Level":
        """The second-order space on isoparametric cells; points : (n_nodes, 3) [m]."""
        rule = shape.stiffness_rule
        return cls._of(points, cells, shape.values(rule.points), shape.gradients(rule.points), rule.weights)

    @classmethod
    def linear(cls, points: FloatArray, cells: IndexArray, shape: CellElement) -> "Level":
        """The linear space on straight-sided cells; points : (n_corners, 3), cells : (n_cells, n_corners).

        A cell whose corners alone are inverted or flat carries nothing.
        """
        places, weights = shape.linear_rule
        level = cls._of(points, cells, shape.corner_values(places), shape.corner_gradients(places), weights)
        np.maximum(level.volumes, 0.0, out=level.volumes)
        return level

    @classmethod
    def _of(
        cls,
        points: FloatArray,
        cells: IndexArray,
        values: FloatArray,
        gradients: FloatArray,
        weights: FloatArray,
    ) -> "Level":
        cells = np.ascontiguousarray(cells)  # one signature of every kernel
        inverse, volumes = assembly.cell_geometry(points, cells, gradients, weights)
        start, around = kernels.cells_of_nodes(cells, len(points))
        indptr, indices, offsets = kernels.pattern(cells, start, around)
        slopes = np.ascontiguousarray(np.swapaxes(gradients, 1, 2))
        tables = assembly.CellTables(slopes, inverse, volumes)
        pattern = assembly.RowPattern(indptr, start, around, offsets)
        return cls(len(points), cells, values, tables, pattern, indices)

    @property
    def volumes(self) -> FloatArray:
        """(n_cells, n_q) volume weights [m3]."""
        return self.tables.volumes

    @property
    def inverse(self) -> FloatArray:
        """(n_cells, n_q, 3, 3) derivatives of reference by physical coordinates [1/m]."""
        return self.tables.inverse

    @property
    def indptr(self) -> IndexArray:
        """(n_nodes + 1,) start of every row in the matrix values."""
        return self.pattern.indptr

    def matrix(self, values: FloatArray) -> sparse.csr_array:
        """Sparse matrix from its (nnz,) values."""
        return sparse.csr_array((values, self.indices, self.indptr), shape=(self.n_nodes, self.n_nodes))

    def row_sizes(self, values: FloatArray) -> FloatArray:
        """(n_nodes,) sum of the sizes of each row's entries, from matrix values (nnz,)."""
        return kernels.row_sizes(self.indptr, values)

    def block_matrix(self, blocks: FloatArray) -> sparse.bsr_array:
        """Sparse matrix from its (nnz, 3, 3) blocks; degree of freedom = 3 node + direction."""
        size = 3 * self.n_nodes
        return sparse.bsr_array((blocks, self.indices, self.indptr), shape=(size, size))

    def add_local(self, values: FloatArray, cells: Cells, local: FloatArray) -> None:
        """Add cell matrices (k, n_local, n_local) of k ``cells``, rows first, to matrix values (nnz,)."""
        rows = self.indptr[self.cells[cells]]
        np.add.at(values, rows[:, :, None] + self.pattern.offsets[cells], local)

    def at_points(self, field: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(k, n_q, ...) values of a nodal ``field`` (n_nodes, ...) at the quadrature points of ``cells``."""
        return np.asarray(np.einsum("qb,eb...->eq...", self.values, field[self.cells[cells]]))

    def gradient(self, field: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(k, n_q, 3) physical gradient of a nodal ``field`` (n_nodes,) at the points of ``cells``."""
        reference = np.einsum("qjb,eb->eqj", self.tables.slopes, field[self.cells[cells]], optimize=True)
        return np.asarray(np.einsum("eqj,eqji->eqi", reference, self.inverse[cells], optimize=True))

    def flux_load(self, flux: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(n_nodes,) integral over ``cells`` of grad N_a . flux; flux : (k, n_q, 3) at their points."""
        scaled = self.volumes[cells][:, :, None] * flux
        reference = np.einsum("eqji,eqi->eqj", self.inverse[cells], scaled, optimize=True)
        parts = np.einsum("qjb,eqj->eb", self.tables.slopes, reference, optimize=True)
        nodes = self.cells[cells].ravel()
        return np.asarray(np.bincount(nodes, parts.ravel(), minlength=self.n_nodes), dtype=np.float64)

    def conduction(self, conductivity: FloatArray) -> FloatArray:
        """Matrix values (nnz,) [W/K] of the integral of k grad u . grad v.

        conductivity : (n_cells,) or, at the quadrature points, (n_cells, n_q) [W/(m K)]
        """
        at_points = conductivity if conductivity.ndim == 2 else conductivity[:, None]
        at_points = np.array(np.broadcast_to(at_points, self.volumes.shape))
        return assembly.conduction_rows(self.pattern, self.tables, at_points)

    def elasticity(self, young: FloatArray, poisson: FloatArray) -> FloatArray:
        """Matrix blocks (nnz, 3, 3) [N/m]; young [Pa] and poisson [-] : (n_cells,)."""
        lame = np.column_stack(
            [young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson)]
        )
        return assembly.elasticity_rows(self.pattern, self.tables, lame)

    def expansion_load(self, factor: FloatArray, excess: FloatArray) -> FloatArray:
        """Load (n_nodes, 3) [N] of free expansion, by the rule of the stiffness: a free body has no stress.

        factor : (n_cells,) alpha E / (1 - 2 nu) [Pa/K]
        excess : (n_nodes,) temperature above the reference [K]
        """
        return assembly.expansion_load(self.cells, self.values, self.tables, factor, excess)


def prolongation(
    points: FloatArray, cells: IndexArray, corners: IndexArray, coarse: Level, shape: CellElement
) -> sparse.csr_array:
    """(n_nodes, n_corners) matrix that takes a linear field to the nodes of the second-order space.

    points : (n_nodes, 3); cells : (n_cells, n_local); corners : (n_corners,) nodes of the ``coarse`` space

    A node off the middle of its straight edge takes value plus slope of the linear field, in the largest cell
    around it: a field that is linear in space stays so, and a rigid rotation stays rigid on curved cells.
    """
    nodes, cell, local = _largest_cell_around(cells, coarse.volumes.sum(axis=1), shape)
    weights = shape.corner_values(shape.nodes)[local]
    ends = points[corners].T.copy()[:, coarse.cells[cell].T]  # (3, n_corners of a cell, n)
    off = points[nodes].T - np.einsum("nc,icn->in", weights, ends)
    reach = np.max([np.abs(end - ends[:, 0]).max(axis=0) for end in ends.swapaxes(0, 1)[1:]], axis=0)
    curved = np.abs(off).max(axis=0) > STRAIGHT * reach
    slopes = shape.corner_gradients(shape.nodes)[local[curved]]
    jacobian = np.einsum("ncj,icn->nij", slopes, ends[:, :, curved])
    sound = np.linalg.det(jacobian) > 0.0
    moved = np.linalg.solve(jacobian[sound], off[:, curved][:, sound].T[:, :, None])[:, :, 0]
    weights[np.flatnonzero(curved)[sound]] += np.einsum("ncj,nj->nc", slopes[sound], moved)
    kept = weights != 0.0
    rows = np.concatenate([corners, np.repeat(nodes, kept.sum(axis=1))])
    columns = np.concatenate([np.arange(len(corners)), coarse.cells[cell][kept]])
    values = np.concatenate([np.ones(len(corners)), weights[kept]])
    entries = sparse.coo_array((values, (rows, columns)), shape=(len(points), len(corners)))
    return sparse.csr_array(entries)


def _largest_cell_around(
    cells: IndexArray, volumes: FloatArray, shape: CellElement
) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Nodes that are no corners, the largest cell around each, and their local number in it."""
    order = np.argsort(volumes, kind="stable")
    inner = cells[order, shape.n_corners :]
    largest = np.full(int(cells.max()) + 1, -1)
    local = np.zeros(len(largest), dtype=np.int32)
    rank = np.arange(len(cells))
    for column in inner.T:
        np.maximum.at(largest, column, rank)
    for number, column in enumerate(inner.T, start=shape.n_corners):
        local[column[largest[column] == rank]] = number
    nodes = np.flatnonzero(largest >= 0).astype(np.int32)
    return nodes, order[largest[nodes]].astype(np.int32), local[nodes]


# scikit-fem on a named mesh: bases on which any weak form is assembled in our numbering.
#
# Unknowns are our nodes, 3 node + direction for vectors, corners for the linear space, so that what scikit-fem
# assembles adds to what the compiled assembly makes. A basis over all cells keeps the gradients of every shape
# function at every point, up to 0.6 kB each: `in_blocks` goes through a large mesh in parts.

BLOCK = 1000
"""Cells of a block: their gradients stay in the processor's cache."""


@dataclass(repr=False)
class MeshHexS2(skfem.MeshHex1):  # type: ignore[misc]
    """Isoparametric mesh of 20-node bricks, the one kind of ours that scikit-fem has as an element only."""

    elem: type[Any] = skfem.ElementHexS2


MESHES = {"tetra10": skfem.MeshTet2, "hexahedron20": MeshHexS2, "hexahedron27": skfem.MeshHex2}
"""Name of a cell -> scikit-fem's mesh of it."""


class NodeNumbers(Dofs):  # type: ignore[misc]
    """Degrees of freedom that carry the numbers of nodes.

    nodes : (n_local, n_cells) in scikit-fem's order of local nodes; size : number of unknowns
    """

    def __init__(self, topo: Any, element: Any, nodes: IndexArray, size: int) -> None:
        self.topo, self.element, self.element_dofs, self.N = topo, element, nodes, size


class SurfaceMapping(MappingIsoparametric):  # type: ignore[misc]
    """The cells behind a surface, its quadrature points those of `SurfaceElements`.

    The places of the points in the cells follow from the corners of the facets. scikit-fem searches them by Newton's
    method to 1e-12, which small cells far from the origin do not reach.

    facets : (n_f, n_local) nodes; cells : (n_f, n_local) nodes of the cell behind each
    """

    def __init__(self, mesh: Any, shape: CellElement, facets: IndexArray, cells: IndexArray) -> None:
        super().__init__(mesh, shape.element)
        side = shape.side
        points, _ = side.load_rule
        corners = facets[:, : side.n_corners]
        local = np.argmax(cells[:, None, : shape.n_corners] == corners[:, :, None], axis=2)
        self._inside = np.einsum("qc,fcd->dfq", side.corner_values(points), shape.corners[local])
        tangents = np.einsum("qak,ifa->kfqi", side.gradients(points), mesh.p[:, facets])
        self._places = np.einsum("qa,ifa->ifq", side.values(points), mesh.p[:, facets])
        self._stretched = np.cross(*tangents)

    def invF(self, x: FloatArray, tind: IndexArray) -> FloatArray:  # noqa: N802
        """(3, n_f, n_q) reference coordinates of the quadrature points in their cells."""
        return np.asarray(self._inside)

    def G(self, X: FloatArray, find: IndexArray) -> FloatArray:  # noqa: N802
        """(3, n_f, n_q) quadrature points."""
        return np.asarray(self._places)

    def detDG(self, X: FloatArray, find: IndexArray) -> FloatArray:  # noqa: N802
        """(n_f, n_q) area per area of the reference side."""
        return np.asarray(np.linalg.norm(self._stretched, axis=2))

    def normals(self, X: FloatArray, tind: IndexArray, find: IndexArray, t2f: IndexArray) -> FloatArray:
        """(3, n_f, n_q) unit normals out of the body that the surface bounds."""
        return np.moveaxis(self._stretched / self.detDG(X, find)[:, :, None], 2, 0)


@dataclass(frozen=True)
class Space:
    """What a basis is made of.

    linear : the linear sub-space, on the same curved cells
    vector : three components
    """

    linear: bool = False
    vector: bool = False


SCALAR, VECTOR, LINEAR = Space(), Space(vector=True), Space(linear=True)


class Bases:
    """Bases of a mesh; corners : (n_corners,) nodes of the linear space."""

    def __init__(self, mesh: NamedMesh, corners: IndexArray) -> None:
        self._named, self._corners, self._shape = mesh, corners, mesh.shape
        self._elements: dict[Space, tuple[Any, NodeNumbers]] = {}

    @cached_property
    def mesh(self) -> Any:
        """The mesh in scikit-fem, with our nodes and the bodies as its subdomains."""
        cells = self._theirs(self._named.cells, self._shape.n_nodes)
        bodies = {name: np.sort(members) for name, members in self._named.bodies.items()}
        points, n_corners = np.ascontiguousarray(self._named.points.T), self._shape.n_corners
        mesh = MESHES[self._shape.name](points, cells[:n_corners], _subdomains=bodies)
        mesh._dofs = NodeNumbers(mesh, self._shape.element, cells, points.shape[1])
        return mesh

    def cells(
        self, cells: IndexArray | str | None = None, space: Space = SCALAR, rule: QuadratureRule | None = None
    ) -> Any:
        """Basis over ``cells`` (k,), the cells of a body by its name, or all.

        rule : quadrature; that of loads if None
        """
        element, dofs = self._element(space)
        points, weights = self._shape.load_rule if rule is None else rule
        # a mapping keeps all it computes; one for each basis goes with it
        mapping = MappingIsoparametric(self.mesh, self._shape.element)
        return skfem.CellBasis(
            self.mesh, element, mapping, elements=cells, quadrature=(points.T, weights), dofs=dofs,
            disable_doflocs=True,
        )  # fmt: skip

    def in_blocks(self, space: Space = SCALAR, rule: QuadratureRule | None = None) -> Iterator[Any]:
        """Bases over all cells, one block after the other."""
        n_cells = len(self._named.cells)
        for start in range(0, n_cells, BLOCK):
            yield self.cells(np.arange(start, min(start + BLOCK, n_cells), dtype=np.int32), space, rule)

    def surface(self, name: str, space: Space = SCALAR) -> Any:
        """Basis over a named surface at the points of its `SurfaceElements`, normals out of the body it bounds."""
        element, dofs = self._element(space)
        points, weights = self._shape.side.load_rule
        boundary, facets = self._boundary(name), self._named.surfaces[name]
        cells = self._named.cells[self.mesh.f2t[boundary.ori, boundary]]
        return skfem.FacetBasis(
            self.mesh, element, SurfaceMapping(self.mesh, self._shape, facets, cells), facets=boundary,
            quadrature=(points.T, weights), dofs=dofs, disable_doflocs=True,
        )  # fmt: skip

    def _theirs(self, cells: IndexArray, n_local: int) -> IndexArray:
        """(n_local, n_cells) nodes in scikit-fem's order of local nodes."""
        return np.ascontiguousarray(cells[:, np.argsort(self._shape.order[:n_local])].T)

    def _element(self, space: Space) -> tuple[Any, NodeNumbers]:
        """scikit-fem's element with the numbers of its unknowns, made once."""
        if space not in self._elements:
            self._elements[space] = self._made(space)
        return self._elements[space]

    def _made(self, space: Space) -> tuple[Any, NodeNumbers]:
        if space.linear:
            element, size, n_local = self._shape.linear, len(self._corners), self._shape.n_corners
            corners = np.searchsorted(self._corners, self._named.cells[:, :n_local])
            nodes = self._theirs(corners.astype(np.int32), n_local)
        else:
            element, size = self._shape.element, len(self._named.points)
            nodes = self.mesh.dofs.element_dofs
        if space.vector:
            element, size = skfem.ElementVector(element), 3 * size
            nodes = (3 * nodes[:, None] + np.arange(3, dtype=np.int32)[:, None]).reshape(-1, nodes.shape[1])
        return element, NodeNumbers(self.mesh, element, nodes, size)

    @cached_property
    def _facets(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Keys of scikit-fem's facets in ascending order, and the numbers of the facets."""
        keys = facet_keys(self.mesh.facets.T, len(self._named.points))
        order = np.argsort(keys)
        return keys[order], order

    def _boundary(self, name: str) -> OrientedBoundary:
        """scikit-fem's numbers of the facets of a surface, and on which side the body lies that it bounds."""
        n_corners, n_nodes = self._shape.side.n_corners, len(self._named.points)
        wanted = self._named.surfaces[name]
        keys, order = self._facets
        facets = order[np.searchsorted(keys, facet_keys(wanted[:, :n_corners], n_nodes))]
        body = self.mesh.f2t[0, facets]
        middle = self._named.points[self._named.cells[body, : self._shape.n_corners]].mean(axis=1)
        a, b, c = self._named.points[wanted[:, :3]].swapaxes(0, 1)
        behind = np.einsum("ni,ni->n", np.cross(b - a, c - a), middle - a) > 0.0
        return OrientedBoundary(facets, behind.astype(np.int32))


# Quadrature, loads and boundary matrices on one named surface.


class SurfaceElements:
    """Quadrature on the second-order triangles or quadrilaterals of one named surface.

    points : (n_nodes, 3) [m]; facets : (n_f, n_local) nodes; shape : of the cells
    fine, coarse : second-order and linear space; corners : nodes of the linear space
    pieces : (n_nodes,) number of the connected piece of each node
    """

    def __init__(
        self,
        points: FloatArray,
        facets: IndexArray,
        shape: CellElement,
        spaces: tuple[Level, Level],
        corners: IndexArray,
        pieces: IndexArray,
    ) -> None:
        self.facets = np.ascontiguousarray(facets)
        """(n_f, n_local) nodes."""
        self.shape = shape.side
        self._spaces, self._corners = spaces, corners
        rule = self.shape.load_rule
        self.weights, self.normals = assembly.facet_geometry(
            points, self.facets, self.shape.gradients(rule.points), rule.weights
        )
        """(n_f, n_q) area weights [m2] and (n_f, n_q, 3) unit normals out of the body."""
        self.values = self.shape.values(rule.points)
        self.corner_values = self.shape.corner_values(rule.points)
        self.nodes = np.unique(self.facets)
        self.area = float(self.weights.sum())
        """[m2]"""
        self.piece = int(pieces[self.facets[0, 0]])
        """Number of the connected piece the surface bounds."""
        self.shares = self.load(np.ones_like(self.weights))
        """(n_nodes,) integral of each shape function over the surface [m2]; sums to the area."""

    @cached_property
    def slots(self) -> IndexArray:
        """(n_f, n_local, n_local) positions in the values of the second-order matrix."""
        fine = self._spaces[0]
        return assembly.facet_slots(self.facets, fine.indptr, fine.indices)

    @cached_property
    def corner_slots(self) -> IndexArray:
        """(n_f, n_corners, n_corners) positions in the values of the linear matrix."""
        coarse = self._spaces[1]
        corners = np.searchsorted(self._corners, self.facets[:, : self.shape.n_corners]).astype(np.int32)
        return assembly.facet_slots(corners, coarse.indptr, coarse.indices)

    def at_points(self, field: FloatArray) -> FloatArray:
        """(n_f, n_q, ...) values of a nodal ``field`` (n_nodes, ...) at the quadrature points."""
        return np.asarray(np.einsum("qa,fa...->fq...", self.values, field[self.facets]))

    def integral(self, values: FloatArray) -> float:
        """Integral over the surface of ``values`` (n_f, n_q) given at the quadrature points."""
        return float(np.sum(values * self.weights))

    def mean(self, field: FloatArray) -> float:
        """Area mean of a nodal ``field`` (n_nodes,)."""
        return float(self.shares[self.nodes] @ field[self.nodes]) / self.area

    def load(self, values: FloatArray) -> FloatArray:
        """(n_nodes,) integral of ``values`` (n_f, n_q) times each shape function."""
        return gather(self.facets, (values * self.weights) @ self.values, self._spaces[0].n_nodes)

    def add_mass(self, values: FloatArray, coefficient: FloatArray) -> None:
        """Add the integral of c u v to second-order matrix values; coefficient : (n_f, n_q) [W/(m2 K)]."""
        assembly.add_facet_mass(values, self.slots, self.values, coefficient * self.weights)

    def add_coarse_mass(self, values: FloatArray, coefficient: FloatArray) -> None:
        """Add the integral of c u v to the values of the linear matrix."""
        assembly.add_facet_mass(values, self.corner_slots, self.corner_values, coefficient * self.weights)


def gather(nodes: IndexArray, parts: FloatArray, n_nodes: int) -> FloatArray:
    """(n_nodes,) sum of ``parts`` over equal ``nodes``, two arrays of one shape."""
    return np.asarray(np.bincount(nodes.ravel(), parts.ravel(), minlength=n_nodes), dtype=np.float64)


__all__ = ["FiniteElements", "Level", "SurfaceElements"]


class FiniteElements:
    """Quadrature, matrix patterns and prolongation of one mesh: built once, used for every field on it.

    Geometry is isoparametric; reference_elements says which rule serves stiffness, loads and surfaces. The
    linear sub-space stands on the straight-sided cells between the corners.
    Raises MeshError for a mesh that thermal.fe.mesh refuses.
    """

    def __init__(self, mesh: NamedMesh) -> None:
        self.mesh = mesh
        self.interfaces = check_topology(mesh)
        """Names of the surfaces that lie inside, between two cells."""
        self.shape = mesh.shape
        self.fine = Level.of(mesh.points, mesh.cells, self.shape)
        places, weights = self.shape.load_rule
        self._load_values = self.shape.values(places)
        self._load_volumes = assembly.cell_volumes(
            mesh.points, mesh.cells, self.shape.gradients(places), weights
        )
        check_volumes(mesh, np.minimum(self.fine.volumes.min(axis=1), self._load_volumes.min(axis=1)))
        corner_cells = mesh.cells[:, : self.shape.n_corners]
        is_corner = np.zeros(len(mesh.points), dtype=np.bool_)
        is_corner[corner_cells] = True
        self.corners = np.flatnonzero(is_corner).astype(np.int32)
        """(n_corners,) nodes of the linear space."""
        number = (np.cumsum(is_corner) - 1).astype(np.int32)
        self.coarse = Level.linear(
            mesh.points[self.corners], np.ascontiguousarray(number[corner_cells]), self.shape
        )
        self.prolongation = prolongation(mesh.points, mesh.cells, self.corners, self.coarse, self.shape)
        """(n_nodes, n_corners): a linear field at the nodes of the second-order space."""

    @cached_property
    def bases(self) -> Bases:
        """scikit-fem's bases in our numbering, for any weak form."""
        return Bases(self.mesh, self.corners)

    @cached_property
    def surfaces(self) -> dict[str, SurfaceElements]:
        """Quadrature on every named surface."""
        return {
            name: SurfaceElements(
                self.mesh.points, facets, self.shape, (self.fine, self.coarse), self.corners,
                self.piece_of_node,
            )
            for name, facets in self.mesh.surfaces.items()
        }  # fmt: skip

    @cached_property
    def components(self) -> IndexArray:
        """(n_cells,) number of the connected piece each cell belongs to: pieces share no nodes."""
        _, label = sparse.csgraph.connected_components(
            self.coarse.matrix(np.ones(len(self.coarse.indices))), directed=False
        )
        return np.asarray(label[self.coarse.cells[:, 0]], dtype=np.int32)

    @cached_property
    def piece_of_node(self) -> IndexArray:
        """(n_nodes,) number of the connected piece each node belongs to."""
        pieces = np.empty(len(self.mesh.points), dtype=np.int32)
        pieces[self.mesh.cells] = self.components[:, None]
        return pieces

    def per_cell(self, values: dict[str, float]) -> FloatArray:
        """(n_cells,) value of each cell from one value per body."""
        result = np.empty(len(self.mesh.cells))
        for name, cells in self.mesh.bodies.items():
            result[cells] = values[name]
        return result

    def assemble(self, form: Any, level: Level, **by_cell: FloatArray) -> FloatArray:
        """Matrix values (nnz,) of a bilinear form of scikit-fem on curved cells, by the rule of loads.

        by_cell : parameters of the form, (n_cells,) each
        """
        values = np.zeros(len(level.indices))
        local_order = np.array(self.shape.order[: level.cells.shape[1]])
        for basis in self.bases.in_blocks(LINEAR if level is self.coarse else SCALAR):
            parameters = {name: value[basis.tind, None] for name, value in by_cell.items()}
            local = form.elemental(basis, **parameters).tolocal()  # (k, n_local of u, n_local of v)
            level.add_local(values, basis.tind, local[:, local_order[None, :], local_order[:, None]])
        return values

    def at_points(self, field: FloatArray, cells: IndexArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Values (k, ...) of a nodal ``field`` (n_nodes, ...) and volume weights (k,) [m3].

        At the points of the load rule, those of one cell after those of another, in ascending ``cells``.
        """
        chosen = slice(None) if cells is None else np.unique(cells)
        nodal = field[self.mesh.cells[chosen]]
        values = np.einsum("qb,eb...->eq...", self._load_values, nodal)
        return values.reshape(-1, *field.shape[1:]), self._load_volumes[chosen].ravel()

    def volume(self, body: str) -> float:
        """Volume of a body [m3]."""
        return float(self._load_volumes[self.mesh.bodies[body]].sum())

    def body_mean(self, field: FloatArray, body: str) -> float:
        """Volume mean of a nodal ``field`` (n_nodes,) over a body."""
        values, volumes = self.at_points(field, self.mesh.bodies[body])
        return float(values @ volumes / volumes.sum())

    def body_load(self, body: str) -> FloatArray:
        """(n_nodes,) integral of each shape function over a body [m3]."""
        cells = np.unique(self.mesh.bodies[body])
        parts = self._load_volumes[cells] @ self._load_values
        return gather(self.mesh.cells[cells], parts, len(self.mesh.points))
