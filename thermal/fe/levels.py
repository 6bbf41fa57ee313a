"""One of the two nested finite-element spaces of a mesh, ready to assemble, and the way between them."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from thermal.fe import assembly, kernels
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.reference_elements import CellElement

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
