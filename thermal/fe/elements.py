"""The second-order finite-element space on a named mesh and its linear sub-space, ready to assemble."""

from functools import cached_property

import numpy as np
from scipy import sparse

from thermal.fe import assembly
from thermal.fe.levels import Level, linear_level, prolongation
from thermal.fe.mesh import NamedMesh
from thermal.fe.mesh_checks import check_topology, check_volumes
from thermal.fe.reference import rules_of
from thermal.fe.shapes import FloatArray, IndexArray
from thermal.fe.surfaces import SurfaceElements, gather

__all__ = ["FiniteElements", "Level", "SurfaceElements"]


class FiniteElements:
    """Quadrature, matrix patterns and prolongation of one mesh: built once, used for every field on it.

    Geometry is isoparametric; thermal.fe.reference says which rule serves stiffness, loads and surfaces. The
    linear sub-space stands on the straight-sided cells between the corners.
    Raises MeshError for a mesh that thermal.fe.mesh_checks refuses.
    """

    def __init__(self, mesh: NamedMesh) -> None:
        self.mesh = mesh
        self.interfaces = check_topology(mesh)
        """Names of the surfaces that lie inside, between two cells."""
        self.shape = mesh.shape
        rules = rules_of(self.shape)
        self._load_rule = rules.load
        rule = rules.stiffness
        self.fine = Level.of(
            mesh.points,
            mesh.cells,
            self.shape.values(rule.points),
            self.shape.gradients(rule.points),
            rule,
        )
        self._load_volumes = assembly.cell_volumes(
            mesh.points, mesh.cells, self.shape.gradients(rules.load.points), rules.load.weights
        )
        check_volumes(mesh, np.minimum(self.fine.volumes.min(axis=1), self._load_volumes.min(axis=1)))
        corner_cells = mesh.cells[:, : self.shape.n_corners]
        is_corner = np.zeros(len(mesh.points), dtype=np.bool_)
        is_corner[corner_cells] = True
        self.corners = np.flatnonzero(is_corner).astype(np.int32)
        """(n_corners,) nodes of the linear space."""
        number = (np.cumsum(is_corner) - 1).astype(np.int32)
        self.coarse = linear_level(
            mesh.points[self.corners], np.ascontiguousarray(number[corner_cells]), self.shape, rules.linear
        )
        self.prolongation = prolongation(mesh.points, mesh.cells, self.corners, self.coarse, self.shape)
        """(n_nodes, n_corners): a linear field at the nodes of the second-order space."""

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

    def conduction(self, conductivity: FloatArray, level: Level) -> FloatArray:
        """Matrix values (nnz,) [W/K] of the integral of k grad u . grad v; see Level.conduction."""
        return level.conduction(conductivity)

    def elasticity(self, young: FloatArray, poisson: FloatArray, level: Level) -> FloatArray:
        """Matrix blocks (nnz, 3, 3) [N/m]; young [Pa] and poisson [-] : (n_cells,)."""
        return level.elasticity(young, poisson)

    def expansion_load(self, factor: FloatArray, excess: FloatArray) -> FloatArray:
        """Load (n_nodes, 3) [N] of free expansion, by the rule of the stiffness: a free body has no stress.

        factor : (n_cells,) alpha E / (1 - 2 nu) [Pa/K]
        excess : (n_nodes,) temperature above the cold one [K]
        """
        return self.fine.expansion_load(factor, excess)

    def at_points(self, field: FloatArray, cells: IndexArray | None = None) -> tuple[FloatArray, FloatArray]:
        """Values (k, ...) of a nodal ``field`` (n_nodes, ...) and volume weights (k,) [m3].

        At the points of the load rule, those of one cell after those of another, in ascending ``cells``.
        """
        chosen = slice(None) if cells is None else np.unique(cells)
        nodal = field[self.mesh.cells[chosen]]
        values = np.einsum("qb,eb...->eq...", self.shape.values(self._load_rule.points), nodal)
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
        parts = self._load_volumes[cells] @ self.shape.values(self._load_rule.points)
        return gather(self.mesh.cells[cells], parts, len(self.mesh.points))
