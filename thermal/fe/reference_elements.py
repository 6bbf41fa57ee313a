"""Reference elements and their quadrature, taken from scikit-fem and put into the node order of our meshes.

Node order is VTK's (CalculiX and Abaqus number C3D10 and C3D20 the same way): corners first, then the middles of
edges, of sides and of the cell. Reference cells are scikit-fem's: the simplex and the cube between 0 and 1. Only
the node order of bricks in VTK and gmsh is stated here; sides and mirrored cells follow from where nodes lie.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np
import skfem
from skfem.quadrature import get_quadrature

from thermal.fe.arrays import FloatArray, IndexArray

__all__ = [
    "CELLS",
    "HEXAHEDRON_20",
    "HEXAHEDRON_27",
    "QUAD_8",
    "QUAD_9",
    "SIDES",
    "TETRAHEDRON_10",
    "TRIANGLE_6",
    "CellElement",
    "QuadratureRule",
    "ReferenceElement",
]


class QuadratureRule(NamedTuple):
    """Quadrature points (n, d) and weights (n,) [-]; the weights sum to the reference volume."""

    points: FloatArray
    weights: FloatArray


@dataclass(frozen=True, eq=False)
class ReferenceElement:
    """A second-order element of scikit-fem with the linear one on its corners.

    name : as meshio calls it
    element, linear : of scikit-fem
    order : scikit-fem's number of each of our local nodes
    load_rule : quadrature of loads and means, on sides of everything; exact to degree 5
    """

    name: str
    element: Any
    linear: Any
    order: tuple[int, ...]
    load_rule: QuadratureRule

    @property
    def n_corners(self) -> int:
        """Number of corner nodes."""
        return len(self.linear.doflocs)

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return len(self.order)

    @cached_property
    def nodes(self) -> FloatArray:
        """(n_nodes, d) reference coordinates."""
        return np.asarray(self.element.doflocs[list(self.order)], dtype=np.float64)

    @cached_property
    def corners(self) -> FloatArray:
        """(n_corners, d) reference coordinates."""
        return self.nodes[: self.n_corners]

    @cached_property
    def parents(self) -> tuple[tuple[int, ...], ...]:
        """For every further node the corners whose middle it is; pairs are edges."""
        shares = self.corner_values(self.nodes)[self.n_corners :]
        return tuple(tuple(np.flatnonzero(row).tolist()) for row in shares)

    @cached_property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """Corner pairs of the nodes in the middle of edges, which follow the corners."""
        return tuple((pair[0], pair[1]) for pair in self.parents if len(pair) == 2)

    def values(self, points: FloatArray) -> FloatArray:
        """(n, n_nodes) shape functions at (n, d) reference points."""
        return _tables(self.element, self.order, points)[0]

    def gradients(self, points: FloatArray) -> FloatArray:
        """(n, n_nodes, d) reference gradients of the shape functions."""
        return _tables(self.element, self.order, points)[1]

    def corner_values(self, points: FloatArray) -> FloatArray:
        """(n, n_corners) shape functions of the linear sub-space."""
        return _tables(self.linear, self.order[: self.n_corners], points)[0]

    def corner_gradients(self, points: FloatArray) -> FloatArray:
        """(n, n_corners, d) reference gradients of the linear sub-space."""
        return _tables(self.linear, self.order[: self.n_corners], points)[1]

    def numbers_at(self, places: FloatArray) -> list[int]:
        """Local nodes that lie at (n, d) reference ``places``."""
        return [_nearest(self.nodes, place) for place in places]


@dataclass(frozen=True, eq=False)
class CellElement(ReferenceElement):
    """A volume element.

    side : element of its sides
    gmsh_parents : corners between which gmsh's further nodes lie
    stiffness_rule, linear_rule : quadrature of the stiffness and of the linear sub-space. Second order needs
        degree 2 for the stiffness of tetrahedra, curved ones too.

    Source: Ciarlet, The Finite Element Method for Elliptic Problems, theorems 4.1.6 and 4.4.6.
    """

    side: ReferenceElement
    gmsh_parents: tuple[tuple[int, ...], ...]
    stiffness_rule: QuadratureRule
    linear_rule: QuadratureRule

    @cached_property
    def sides(self) -> IndexArray:
        """(n_sides, side.n_nodes) local nodes, normals outwards, the lowest corner first."""
        between = self.side.corner_values(self.side.nodes)
        return np.array(
            [
                self.numbers_at(between @ self.corners[self._outwards(facet)])
                for facet in self.element.refdom.facets
            ],
            dtype=np.int32,
        )

    @cached_property
    def mirror(self) -> tuple[int, ...]:
        """Local nodes in the order that turns a left-handed cell into a right-handed one."""
        return tuple(self.numbers_at(self.nodes[:, [1, 0, 2]]))

    @cached_property
    def gmsh_order(self) -> tuple[int, ...]:
        """``gmsh_cells[:, gmsh_order]`` has our node order."""
        theirs = [self.corners[list(parents)].mean(axis=0) for parents in self.gmsh_parents]
        return (*range(self.n_corners), *np.argsort(self.numbers_at(np.array(theirs))) + self.n_corners)

    def _outwards(self, facet: Sequence[int]) -> list[int]:
        """Our corners of a facet of scikit-fem's reference cell, in turn, seen from outside."""
        corners = [self.order.index(k) for k in facet]
        a, b, c = self.corners[corners[:3]]
        if np.cross(b - a, c - a) @ (a - self.corners.mean(axis=0)) < 0.0:
            corners.reverse()
        first = corners.index(min(corners))
        return corners[first:] + corners[:first]


def _rule(element: Any, order: int) -> QuadratureRule:
    points, weights = get_quadrature(element.refdom, order)
    return QuadratureRule(np.ascontiguousarray(points.T), weights)


def _nearest(nodes: FloatArray, place: FloatArray) -> int:
    """Which of (n, d) ``nodes`` lies at a place (d,)."""
    return int(np.abs(nodes - place).sum(axis=1).argmin())


def _tables(element: Any, order: Sequence[int], points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shape functions (n, n_nodes) and their gradients (n, n_nodes, d) at (n, d) points, in our order."""
    values = np.empty((len(points), len(order)))
    gradients = np.empty((*values.shape, points.shape[1]))
    for ours, theirs in enumerate(order):
        value, gradient = element.lbasis(points.T, theirs)
        values[:, ours], gradients[:, ours] = value, np.transpose(gradient)
    return values, gradients


_GMSH_TETRAHEDRON = ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3))
_GMSH_BRICK = (
    (0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7),
    (0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7), tuple(range(8)),
)  # fmt: skip


def _vtk_order(brick: Any) -> tuple[int, ...]:
    """scikit-fem's number of VTK's nodes of a brick: quadrilaterals below, above and between, then its sides."""
    square = skfem.ElementQuad2.doflocs
    corners, edges, middle = square[:4], square[4:8], square[8:]
    layers = (
        (corners, 0.0), (corners, 1.0), (edges, 0.0), (edges, 1.0), (corners, 0.5),
        (edges[[3, 1, 0, 2]], 0.5), (middle, 0.0), (middle, 1.0), (middle, 0.5),
    )  # fmt: skip
    places = np.concatenate([np.insert(places, 2, height, axis=1) for places, height in layers])
    return tuple(_nearest(brick.doflocs, place) for place in places[: len(brick.doflocs)])


def _fourteen_points() -> QuadratureRule:
    """The one rule that scikit-fem lacks: degree 5 on the tetrahedron with positive weights and all points inside.

    Its own 14 points integrate degree 4 (its rules of tetrahedra from order 5 on fall short by one), its 15 points
    of degree 5 lie partly on the sides. Source: Walkington, Quadrature on simplices of arbitrary dimension, 2000.
    """
    a, b, c = 0.31088591926330060980, 0.092735250310891226402, 0.045503704125649649492
    orbits = ((a, a, a, 1.0 - 3.0 * a), (b, b, b, 1.0 - 3.0 * b), (c, c, 0.5 - c, 0.5 - c))
    weights = (0.11268792571801585080, 0.073493043116361949544, 0.042546020777081466438)
    places = [sorted(set(permutations(orbit))) for orbit in orbits]
    return QuadratureRule(
        np.concatenate(places)[:, 1:], np.repeat(weights, [len(orbit) for orbit in places]) / 6.0
    )


def _flat(name: str, element: Any, linear: Any) -> ReferenceElement:
    return ReferenceElement(name, element, linear, tuple(range(len(element.doflocs))), _rule(element, 5))


def _brick(name: str, element: Any, side: ReferenceElement) -> CellElement:
    order, rule = _vtk_order(element), _rule(element, 5)
    return CellElement(
        name, element, skfem.ElementHex1(), order, rule, side=side, gmsh_parents=_GMSH_BRICK[: len(order) - 8],
        stiffness_rule=rule, linear_rule=_rule(element, 3),
    )  # fmt: skip


def _tetrahedron() -> CellElement:
    element = skfem.ElementTetP2()
    return CellElement(
        "tetra10", element, skfem.ElementTetP1(), tuple(range(10)), _fourteen_points(), side=TRIANGLE_6,
        gmsh_parents=_GMSH_TETRAHEDRON, stiffness_rule=_rule(element, 2), linear_rule=_rule(element, 1),
    )  # fmt: skip


TRIANGLE_6 = _flat("triangle6", skfem.ElementTriP2(), skfem.ElementTriP1())
QUAD_8 = _flat("quad8", skfem.ElementQuadS2(), skfem.ElementQuad1())
QUAD_9 = _flat("quad9", skfem.ElementQuad2(), skfem.ElementQuad1())
TETRAHEDRON_10 = _tetrahedron()
HEXAHEDRON_20 = _brick("hexahedron20", skfem.ElementHexS2(), QUAD_8)
HEXAHEDRON_27 = _brick("hexahedron27", skfem.ElementHex2(), QUAD_9)

CELLS = {cell.n_nodes: cell for cell in (TETRAHEDRON_10, HEXAHEDRON_20, HEXAHEDRON_27)}
"""Number of nodes -> cell."""

SIDES = {cell.side.n_nodes: cell.side for cell in CELLS.values()}
"""Number of nodes -> side of a cell."""
