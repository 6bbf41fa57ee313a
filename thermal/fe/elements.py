"""The second-order finite-element space on a named mesh and its linear sub-space, ready to assemble."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from thermal.fe import assembly
from thermal.fe.mesh import CELL_EDGES, FloatArray, IndexArray, NamedMesh
from thermal.fe.mesh_checks import check_topology, check_volumes
from thermal.fe.reference import (
    TETRAHEDRON_4,
    TETRAHEDRON_14,
    TRIANGLE_7,
    tetrahedron_gradients,
    tetrahedron_values,
    triangle_corner_values,
    triangle_gradients,
    triangle_values,
)

STRAIGHT = 1e-9
"""A cell is straight if no mid-side node leaves the middle by more than this share of its edge."""

CORNERS_OF_QUADRATIC = np.vstack([np.eye(4), [[0.5 * (c in edge) for c in range(4)] for edge in CELL_EDGES]])
"""(10, 4) nodal values of the four linear shape functions."""


@dataclass(frozen=True)
class Level:
    """Nodes, cells and matrix pattern of one of the two nested spaces (second order or linear)."""

    n_nodes: int
    cells: IndexArray
    """(n_cells, 10) or (n_cells, 4)"""
    start: IndexArray
    around: IndexArray
    indptr: IndexArray
    indices: IndexArray
    gradients: FloatArray
    """(n_q, n_local, 3) [1/m]"""

    @classmethod
    def of(cls, cells: IndexArray, n_nodes: int, gradients: FloatArray) -> "Level":
        """Work out which nodes are coupled."""
        start, around = assembly.cells_of_nodes(cells, n_nodes)
        indptr, indices = assembly.pattern(cells, start, around)
        return cls(n_nodes, cells, start, around, indptr, indices, gradients)

    def matrix(self, values: FloatArray) -> sparse.csr_array:
        """Sparse matrix from its (nnz,) values."""
        return sparse.csr_array((values, self.indices, self.indptr), shape=(self.n_nodes, self.n_nodes))

    def block_matrix(self, blocks: FloatArray) -> sparse.bsr_array:
        """Sparse matrix from its (nnz, 3, 3) blocks; degree of freedom = 3 node + direction."""
        size = 3 * self.n_nodes
        return sparse.bsr_array((blocks, self.indices, self.indptr), shape=(size, size))


class FiniteElements:
    """Quadrature, matrix patterns and prolongation of one mesh: built once, used for every field on it.

    Straight cells take a 4-point rule for stiffness, curved ones 14 points; expansion loads always 14 points,
    facets 7 points. Curved geometry is isoparametric.
    Raises MeshError for a mesh that thermal.fe.mesh_checks refuses.
    """

    def __init__(self, mesh: NamedMesh) -> None:
        self.mesh = mesh
        self.interfaces = check_topology(mesh)
        """Names of the surfaces that lie inside, between two cells."""
        curved = _curved_cells(mesh)
        counts = np.where(curved, len(TETRAHEDRON_14.weights), len(TETRAHEDRON_4.weights))
        self.first = np.append(0, np.cumsum(counts)).astype(np.int32)
        """(n_cells + 1,) first quadrature point of each cell."""
        rule_start = np.where(curved, len(TETRAHEDRON_4.weights), 0).astype(np.int32)
        table = np.vstack([TETRAHEDRON_4.points, TETRAHEDRON_14.points])
        gradients, self.volumes = assembly.quadrature_geometry(
            mesh.points,
            mesh.cells,
            self.first,
            rule_start,
            tetrahedron_gradients(table),
            np.append(TETRAHEDRON_4.weights, TETRAHEDRON_14.weights),
        )
        check_volumes(mesh, self.first, self.volumes)
        self.cell_of_point = np.repeat(np.arange(len(mesh.cells), dtype=np.int32), counts)
        """(n_q,) cell of each quadrature point."""
        self._shape_row = np.arange(self.first[-1]) - (self.first[:-1] - rule_start)[self.cell_of_point]
        self._shape_table = tetrahedron_values(table)
        self.fine = Level.of(mesh.cells, len(mesh.points), gradients)
        self.corners = np.unique(mesh.cells[:, :4]).astype(np.int32)
        """(n_corners,) nodes of the linear space."""
        self.coarse = self._linear_level(gradients)
        self.prolongation = self._prolongation()

    def _linear_level(self, gradients: FloatArray) -> Level:
        number = np.full(len(self.mesh.points), -1, dtype=np.int32)
        number[self.corners] = np.arange(len(self.corners), dtype=np.int32)
        slopes = np.ascontiguousarray(
            np.moveaxis(np.tensordot(gradients, CORNERS_OF_QUADRATIC, (1, 0)), 2, 1)
        )
        return Level.of(np.ascontiguousarray(number[self.mesh.cells[:, :4]]), len(self.corners), slopes)

    def _prolongation(self) -> sparse.csr_array:
        """(n_nodes, n_corners): a linear field as a second-order one."""
        parents = np.empty((len(self.mesh.points), 2), dtype=np.int32)
        for local, (a, b) in enumerate(CELL_EDGES):
            parents[self.mesh.cells[:, 4 + local]] = self.coarse.cells[:, [a, b]]
        parents[self.corners] = np.arange(len(self.corners), dtype=np.int32)[:, None]
        rows = np.repeat(np.arange(len(parents)), 2)
        halves = sparse.coo_array(
            (np.full(parents.size, 0.5), (rows, parents.ravel())), shape=(len(parents), len(self.corners))
        )
        return sparse.csr_array(halves)

    @cached_property
    def surfaces(self) -> dict[str, "SurfaceElements"]:
        """Quadrature on every named surface."""
        return {name: SurfaceElements(self, facets) for name, facets in self.mesh.surfaces.items()}

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

    def conduction(self, conductivity: FloatArray, level: Level) -> FloatArray:
        """Matrix values (nnz,) [W/K] of the integral of k grad u . grad v; conductivity : (n_cells,)."""
        pattern = (level.indptr, level.indices, level.start, level.around, level.cells)
        return assembly.conduction_rows(*pattern, self.first, level.gradients, self.volumes, conductivity)

    def elasticity(self, young: FloatArray, poisson: FloatArray, level: Level) -> FloatArray:
        """Matrix blocks (nnz, 3, 3) [N/m]; young [Pa] and poisson [-] : (n_cells,)."""
        lame = np.column_stack(
            [young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), 0.5 * young / (1.0 + poisson)]
        )
        pattern = (level.indptr, level.indices, level.start, level.around, level.cells)
        return assembly.elasticity_rows(*pattern, self.first, level.gradients, self.volumes, lame)

    def expansion_load(self, factor: FloatArray, excess: FloatArray) -> FloatArray:
        """Load (n_nodes, 3) [N] of free expansion.

        factor : (n_cells,) alpha E / (1 - 2 nu) [Pa/K]
        excess : (n_nodes,) temperature above the cold one [K]
        """
        points = TETRAHEDRON_14.points
        return assembly.expansion_load(
            self.mesh.points,
            self.mesh.cells,
            tetrahedron_values(points),
            tetrahedron_gradients(points),
            TETRAHEDRON_14.weights,
            factor,
            excess,
        )

    def at_points(self, field: FloatArray, cells: IndexArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Values of a nodal ``field`` (n_nodes, ...) and volume weights [m3] at the points of ``cells``."""
        chosen = np.ones(len(self.mesh.cells), dtype=np.bool_)
        if cells is not None:
            chosen[:] = False
            chosen[cells] = True
        at = np.flatnonzero(chosen[self.cell_of_point])
        shapes = self._shape_table[self._shape_row[at]]
        nodal = field[self.mesh.cells[self.cell_of_point[at]]]
        return np.einsum("qa,qa...->q...", shapes, nodal), self.volumes[at]

    def volume(self, body: str) -> float:
        """Volume of a body [m3]."""
        return float(np.add.reduceat(self.volumes, self.first[:-1])[self.mesh.bodies[body]].sum())

    def body_mean(self, field: FloatArray, body: str) -> float:
        """Volume mean of a nodal ``field`` (n_nodes,) over a body."""
        values, volumes = self.at_points(field, self.mesh.bodies[body])
        return float(values @ volumes / volumes.sum())

    def body_load(self, body: str) -> FloatArray:
        """(n_nodes,) integral of each shape function over a body [m3]."""
        cells = np.zeros(len(self.mesh.cells), dtype=np.bool_)
        cells[self.mesh.bodies[body]] = True
        at = np.flatnonzero(cells[self.cell_of_point])
        parts = self._shape_table[self._shape_row[at]] * self.volumes[at, None]
        nodes = self.mesh.cells[self.cell_of_point[at]]
        return _gather(nodes, parts, len(self.mesh.points))


class SurfaceElements:
    """Quadrature on the 6-node triangles of one named surface."""

    def __init__(self, elements: FiniteElements, facets: IndexArray) -> None:
        self.facets = np.ascontiguousarray(facets)
        """(n_f, 6) nodes."""
        self._elements = elements
        rule = TRIANGLE_7
        points = elements.mesh.points
        self.weights, self.normals = assembly.facet_geometry(
            points, self.facets, triangle_gradients(rule.points), rule.weights
        )
        """(n_f, n_q) area weights [m2] and (n_f, n_q, 3) unit normals out of the body."""
        self.values = triangle_values(rule.points)
        self.corner_values = triangle_corner_values(rule.points)
        self.nodes = np.unique(self.facets)
        self.area = float(self.weights.sum())
        """[m2]"""
        self.shares = self.load(np.ones_like(self.weights))
        """(n_nodes,) integral of each shape function over the surface [m2]; sums to the area."""

    @property
    def piece(self) -> int:
        """Number of the connected piece the surface bounds."""
        return int(self._elements.piece_of_node[self.facets[0, 0]])

    @cached_property
    def slots(self) -> IndexArray:
        """(n_f, 6, 6) positions in the values of the second-order matrix."""
        fine = self._elements.fine
        return assembly.facet_slots(self.facets, fine.indptr, fine.indices)

    @cached_property
    def corner_slots(self) -> IndexArray:
        """(n_f, 3, 3) positions in the values of the linear matrix."""
        coarse = self._elements.coarse
        corners = np.searchsorted(self._elements.corners, self.facets[:, :3]).astype(np.int32)
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
        parts = (values * self.weights) @ self.values
        return _gather(self.facets, parts, len(self._elements.mesh.points))

    def add_mass(self, values: FloatArray, coefficient: FloatArray) -> None:
        """Add the integral of c u v to second-order matrix values; coefficient : (n_f, n_q) [W/(m2 K)]."""
        assembly.add_facet_mass(values, self.slots, self.values, coefficient * self.weights)

    def add_coarse_mass(self, values: FloatArray, coefficient: FloatArray) -> None:
        """Add the integral of c u v to the values of the linear matrix."""
        assembly.add_facet_mass(values, self.corner_slots, self.corner_values, coefficient * self.weights)


def _gather(nodes: IndexArray, parts: FloatArray, n_nodes: int) -> FloatArray:
    """(n_nodes,) sum of ``parts`` over equal ``nodes``, two arrays of one shape."""
    return np.asarray(np.bincount(nodes.ravel(), parts.ravel(), minlength=n_nodes), dtype=np.float64)


def _curved_cells(mesh: NamedMesh) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """(n_cells,) True for cells whose edges are not straight with centred mid-side nodes."""
    edges = np.array(CELL_EDGES)
    ends = mesh.points[mesh.cells[:, edges]]
    off = np.linalg.norm(mesh.points[mesh.cells[:, 4:]] - ends.mean(axis=2), axis=2)
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    return np.asarray(np.any(off > STRAIGHT * length, axis=1))
