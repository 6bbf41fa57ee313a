"""The elements as data: nodes of the reference cell, the polynomials they carry, sides, names elsewhere.

A cell is recognised by its number of nodes, a side by its own. Node order is VTK's (CalculiX and Abaqus number
C3D10 and C3D20 the same way): corners first, then the middles of edges, of sides and of the cell.
Sources: Zienkiewicz, Taylor, The Finite Element Method, vol. 1, ch. 8 for the serendipity family; Arnold,
Awanou, Found. Comput. Math. 11 (2011) 337 for its polynomials.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]
Parents = tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class Shape:
    """Shape functions on a reference cell of d dimensions.

    name : as meshio calls it
    corners : (n_corners, d) reference coordinates
    parents : for every further node the corners whose middle it is; pairs are edges
    exponents : (n_nodes, d) of the monomials that span the shape functions
    linear : (n_corners, d) of the monomials of the linear sub-space, fixed by the corners alone
    """

    name: str
    corners: FloatArray
    parents: Parents
    exponents: IndexArray
    linear: IndexArray

    @property
    def n_corners(self) -> int:
        """Number of corner nodes."""
        return len(self.corners)

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return len(self.exponents)

    @cached_property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """Corner pairs of the nodes in the middle of edges, which follow the corners."""
        return tuple((pair[0], pair[1]) for pair in self.parents if len(pair) == 2)

    @cached_property
    def nodes(self) -> FloatArray:
        """(n_nodes, d) reference coordinates."""
        return np.vstack([self.corners, *(self.corners[list(c)].mean(axis=0) for c in self.parents)])

    @cached_property
    def _coefficients(self) -> FloatArray:
        return _inverse(_monomials(self.nodes, self.exponents))

    @cached_property
    def _corner_coefficients(self) -> FloatArray:
        return _inverse(_monomials(self.corners, self.linear))

    def values(self, points: FloatArray) -> FloatArray:
        """(n, n_nodes) shape functions at (n, d) reference points."""
        return np.ascontiguousarray(_monomials(points, self.exponents) @ self._coefficients)

    def gradients(self, points: FloatArray) -> FloatArray:
        """(n, n_nodes, d) reference gradients of the shape functions."""
        return _slopes(points, self.exponents, self._coefficients)

    def corner_values(self, points: FloatArray) -> FloatArray:
        """(n, n_corners) shape functions of the linear sub-space."""
        return np.ascontiguousarray(_monomials(points, self.linear) @ self._corner_coefficients)

    def corner_gradients(self, points: FloatArray) -> FloatArray:
        """(n, n_corners, d) reference gradients of the linear sub-space."""
        return _slopes(points, self.linear, self._corner_coefficients)


@dataclass(frozen=True, eq=False)
class CellShape(Shape):
    """A volume element.

    side : shape of its sides
    sides : (n_sides, side.n_nodes) local nodes, normals outwards
    gmsh_order : ``gmsh_cells[:, gmsh_order]`` has our node order
    mirror : local nodes in the order that turns a left-handed cell into a right-handed one
    """

    side: Shape
    sides: IndexArray
    gmsh_order: tuple[int, ...]
    mirror: tuple[int, ...]


def _monomials(points: FloatArray, exponents: IndexArray) -> FloatArray:
    """(n, n_monomials)"""
    return np.asarray(np.prod(points[:, None, :] ** exponents, axis=2))


def _inverse(vandermonde: FloatArray) -> FloatArray:
    """Coefficients of nodal functions; on these reference cells they are multiples of an eighth."""
    return np.asarray(np.round(8.0 * np.linalg.inv(vandermonde)) / 8.0)


def _slopes(points: FloatArray, exponents: IndexArray, coefficients: FloatArray) -> FloatArray:
    parts = []
    for axis in range(points.shape[1]):
        lowered = exponents.copy()
        lowered[:, axis] = np.maximum(lowered[:, axis] - 1, 0)
        parts.append((_monomials(points, lowered) * exponents[:, axis]) @ coefficients)
    return np.ascontiguousarray(np.stack(parts, axis=2))


def _exponents(dimension: int, highest: int, total: int | None = None, squares: int = 3) -> IndexArray:
    """Exponents up to ``highest`` each, of total degree ``total``, at most ``squares`` of them above 1."""
    found = [
        e
        for e in product(range(highest + 1), repeat=dimension)
        if (total is None or sum(e) <= total) and sum(power > 1 for power in e) <= squares
    ]
    return np.array(found, dtype=np.int32)


def _square(middle: bool) -> Shape:
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    parents: Parents = ((0, 1), (1, 2), (2, 3), (3, 0)) + (((0, 1, 2, 3),) if middle else ())
    return Shape(
        "quad9" if middle else "quad8", corners, parents,
        _exponents(2, 2, squares=2 if middle else 1), _exponents(2, 1),
    )  # fmt: skip


_SIMPLEX_EDGES: Parents = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_BRICK_CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
    dtype=np.float64,
)
_BRICK_EDGES: Parents = (
    (0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7),
)  # fmt: skip
_BRICK_SIDES: Parents = (
    (0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (2, 3, 7, 6), (0, 3, 2, 1), (4, 5, 6, 7),
)  # fmt: skip
_GMSH_BRICK_PARENTS: Parents = (
    (0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7),
    (0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6), (4, 5, 6, 7), tuple(range(8)),
)  # fmt: skip

TRIANGLE_6 = Shape(
    "triangle6", np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), _SIMPLEX_EDGES[:3],
    _exponents(2, 2, 2), _exponents(2, 1, 1),
)  # fmt: skip
QUAD_8 = _square(middle=False)
QUAD_9 = _square(middle=True)


def _cell(
    name: str,
    corners: FloatArray,
    parents: Parents,
    exponents: tuple[IndexArray, IndexArray],
    side: Shape,
    side_corners: Parents,
    gmsh_parents: Parents,
    mirrored: tuple[int, ...],
) -> CellShape:
    """Work the node lists out from corners: every further node is known by the corners it lies between."""
    n = len(corners)
    number = {frozenset(c): n + k for k, c in enumerate(parents)}
    gmsh = {frozenset(c): n + k for k, c in enumerate(gmsh_parents)}
    sides = [
        [*c, *(number[frozenset(c[k] for k in between)] for between in side.parents)] for c in side_corners
    ]
    return CellShape(
        name, corners, parents, *exponents, side, np.array(sides, dtype=np.int32),
        (*range(n), *(gmsh[frozenset(c)] for c in parents)),
        (*mirrored, *(number[frozenset(mirrored[k] for k in c)] for c in parents)),
    )  # fmt: skip


def _brick(name: str, parents: Parents, squares: int, side: Shape) -> CellShape:
    return _cell(
        name, _BRICK_CORNERS, parents, (_exponents(3, 2, squares=squares), _exponents(3, 1)), side,
        _BRICK_SIDES, _GMSH_BRICK_PARENTS[: len(parents)], (3, 2, 1, 0, 7, 6, 5, 4),
    )  # fmt: skip


TETRAHEDRON_10 = _cell(
    "tetra10",
    np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    _SIMPLEX_EDGES,
    (_exponents(3, 2, 2), _exponents(3, 1, 1)),
    TRIANGLE_6,
    ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    ((0, 1), (1, 2), (2, 0), (0, 3), (2, 3), (1, 3)),
    (0, 2, 1, 3),
)
HEXAHEDRON_20 = _brick("hexahedron20", _BRICK_EDGES, 1, QUAD_8)
HEXAHEDRON_27 = _brick("hexahedron27", (*_BRICK_EDGES, *_BRICK_SIDES, tuple(range(8))), 3, QUAD_9)

CELLS = {shape.n_nodes: shape for shape in (TETRAHEDRON_10, HEXAHEDRON_20, HEXAHEDRON_27)}
"""Number of nodes -> element."""
