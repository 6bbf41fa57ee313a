"""One of the two nested finite-element spaces of a mesh, ready to assemble, and the way between them."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from thermal.fe import assembly, kernels
from thermal.fe.reference import QuadratureRule
from thermal.fe.shapes import CellShape, FloatArray, IndexArray

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
    slopes: FloatArray
    """(n_q, 3, n_local) their reference gradients."""
    inverse: FloatArray
    """(n_cells, n_q, 3, 3) derivatives of reference by physical coordinates [1/m]."""
    volumes: FloatArray
    """(n_cells, n_q) volume weights [m3]."""
    start: IndexArray
    around: IndexArray
    offsets: kernels.Offsets
    indptr: IndexArray
    indices: IndexArray

    @classmethod
    def of(
        cls,
        points: FloatArray,
        cells: IndexArray,
        values: FloatArray,
        gradients: FloatArray,
        rule: QuadratureRule,
    ) -> "Level":
        """Work out geometry and which nodes are coupled.

        points : (n_nodes, 3) [m]; values, gradients : (n_q, n_local) and (n_q, n_local, 3) of ``rule``
        """
        inverse, volumes = assembly.cell_geometry(points, cells, gradients, rule.weights)
        start, around = kernels.cells_of_nodes(cells, len(points))
        indptr, indices, offsets = kernels.pattern(cells, start, around)
        slopes = np.ascontiguousarray(np.swapaxes(gradients, 1, 2))
        return cls(
            len(points), cells, values, slopes, inverse, volumes, start, around, offsets, indptr, indices
        )

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

    def gradients(self, cells: Cells = ALL) -> FloatArray:
        """(k, n_q, n_local, 3) physical gradients [1/m] of the shape functions of k ``cells``."""
        return np.asarray(np.einsum("qjb,eqji->eqbi", self.slopes, self.inverse[cells], optimize=True))

    def at_points(self, field: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(k, n_q, ...) values of a nodal ``field`` (n_nodes, ...) at the quadrature points of ``cells``."""
        return np.asarray(np.einsum("qb,eb...->eq...", self.values, field[self.cells[cells]]))

    def gradient(self, field: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(k, n_q, 3) physical gradient of a nodal ``field`` (n_nodes,) at the points of ``cells``."""
        reference = np.einsum("qjb,eb->eqj", self.slopes, field[self.cells[cells]], optimize=True)
        return np.asarray(np.einsum("eqj,eqji->eqi", reference, self.inverse[cells], optimize=True))

    def flux_load(self, flux: FloatArray, cells: Cells = ALL) -> FloatArray:
        """(n_nodes,) integral over ``cells`` of grad N_a . flux; flux : (k, n_q, 3) at their points."""
        scaled = self.volumes[cells][:, :, None] * flux
        reference = np.einsum("eqji,eqi->eqj", self.inverse[cells], scaled, optimize=True)
        parts = np.einsum("qjb,eqj->eb", self.slopes, reference, optimize=True)
        nodes = self.cells[cells].ravel()
        return np.asarray(np.bincount(nodes, parts.ravel(), minlength=self.n_nodes), dtype=np.float64)

    def conduction(self, conductivity: FloatArray) -> FloatArray:
        """Matrix values (nnz,) [W/K] of the integral of k grad u . grad v.

        conductivity : (n_cells,) or, at the quadrature points, (n_cells, n_q) [W/(m K)]
        """
        at_points = conductivity if conductivity.ndim == 2 else conductivity[:, None]
        at_points = np.array(np.broadcast_to(at_points, self.volumes.shape))
        return assembly.conduction_rows(
            self.indptr, self.start, self.around, self.offsets,
            self.slopes, self.inverse, self.volumes, at_points,
        )  # fmt: skip

    def elasticity(self, young: FloatArray, poisson: FloatArray) -> FloatArray:
        """Matrix blocks (nnz, 3, 3) [N/m]; young [Pa] and poisson [-] : (n_cells,)."""
        lame = np.column_stack(
            [young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson)]
        )
        return assembly.elasticity_rows(
            self.indptr, self.start, self.around, self.offsets,
            self.slopes, self.inverse, self.volumes, lame,
        )  # fmt: skip

    def expansion_load(self, factor: FloatArray, excess: FloatArray) -> FloatArray:
        """Load (n_nodes, 3) [N] of free expansion; see FiniteElements.expansion_load."""
        return assembly.expansion_load(
            self.cells, self.values, self.slopes, self.inverse, self.volumes, factor, excess
        )


def linear_level(points: FloatArray, cells: IndexArray, shape: CellShape, rule: QuadratureRule) -> Level:
    """The linear space on straight-sided cells; points : (n_corners, 3), cells : (n_cells, n_corners).

    A cell whose corners alone are inverted or flat carries nothing.
    """
    level = Level.of(
        points, cells, shape.corner_values(rule.points), shape.corner_gradients(rule.points), rule
    )
    np.maximum(level.volumes, 0.0, out=level.volumes)
    return level


def prolongation(
    points: FloatArray, cells: IndexArray, corners: IndexArray, coarse: Level, shape: CellShape
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
    cells: IndexArray, volumes: FloatArray, shape: CellShape
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
