"""Quadrature, loads and boundary matrices on one named surface."""

from functools import cached_property

import numpy as np

from thermal.fe import assembly
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.levels import Level
from thermal.fe.reference_elements import CellElement


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
