"""The second-order finite-element space on a named mesh and its linear sub-space, ready to assemble."""

from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from thermal.fe import assembly
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.bases import LINEAR, SCALAR, Bases
from thermal.fe.levels import Level, prolongation
from thermal.fe.mesh import NamedMesh, check_topology, check_volumes
from thermal.fe.reference_elements import CellElement

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
