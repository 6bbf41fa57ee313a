"""Quadrature on the reference cells and sides, and which rule serves what.

Tetrahedron and triangle: positive rules with points inside, 4 points of degree 2 and 14 of degree 5
(Walkington, Quadrature on simplices of arbitrary dimension, 2000), 7 points of degree 5 (Radon 1948; Strang
and Fix 1973). Hexahedron and quadrilateral: products of Gauss's 3-point rule, degree 5 in each coordinate.
The test integrates every monomial up to the degree.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from thermal.fe.shapes import TETRAHEDRON_10, TRIANGLE_6, FloatArray, Shape


@dataclass(frozen=True)
class QuadratureRule:
    """Quadrature points (n, d) and weights (n,) [-]; the weights sum to the reference volume."""

    points: FloatArray
    weights: FloatArray


def _orbit(a: float, corners: int) -> list[list[float]]:
    """Barycentric points with all coordinates ``a`` but one, without the first coordinate."""
    rest = 1.0 - (corners - 1) * a
    full = [[rest if i == j else a for i in range(corners)] for j in range(corners)]
    return [point[1:] for point in full]


def _tetrahedron_4() -> QuadratureRule:
    return QuadratureRule(np.array(_orbit((5.0 - np.sqrt(5.0)) / 20.0, 4)), np.full(4, 1.0 / 24.0))


def _tetrahedron_14() -> QuadratureRule:
    c = 0.045503704125649649492
    pairs = [[c if k in pair else 0.5 - c for k in range(4)][1:] for pair in TETRAHEDRON_10.edges]
    points = _orbit(0.31088591926330060980, 4) + _orbit(0.092735250310891226402, 4) + pairs
    weights = [0.11268792571801585080] * 4 + [0.073493043116361949544] * 4 + [0.042546020777081466438] * 6
    return QuadratureRule(np.array(points), np.array(weights) / 6.0)


def _triangle_7() -> QuadratureRule:
    root = np.sqrt(15.0)
    a, b = (6.0 - root) / 21.0, (6.0 + root) / 21.0
    points = [[1.0 / 3.0, 1.0 / 3.0], *_orbit(a, 3), *_orbit(b, 3)]
    weights = [9.0 / 40.0] + [(155.0 - root) / 1200.0] * 3 + [(155.0 + root) / 1200.0] * 3
    return QuadratureRule(np.array(points), np.array(weights) / 2.0)


def _gauss(per_axis: int, dimension: int) -> QuadratureRule:
    points, weights = np.polynomial.legendre.leggauss(per_axis)
    return QuadratureRule(
        np.array(list(product(points, repeat=dimension))),
        np.array([np.prod(w) for w in product(weights, repeat=dimension)]),
    )


CENTRE_OF_TETRAHEDRON = QuadratureRule(np.full((1, 3), 0.25), np.full(1, 1.0 / 6.0))
TETRAHEDRON_4 = _tetrahedron_4()
TETRAHEDRON_14 = _tetrahedron_14()
TRIANGLE_7 = _triangle_7()
GAUSS_8 = _gauss(2, 3)
GAUSS_27 = _gauss(3, 3)
GAUSS_9 = _gauss(3, 2)


@dataclass(frozen=True)
class Rules:
    """Rules of one cell: for stiffness, for loads and means, for the linear sub-space, for its sides."""

    stiffness: QuadratureRule
    load: QuadratureRule
    linear: QuadratureRule
    side: QuadratureRule


_OF_TETRAHEDRA = Rules(TETRAHEDRON_4, TETRAHEDRON_14, CENTRE_OF_TETRAHEDRON, TRIANGLE_7)
_OF_HEXAHEDRA = Rules(GAUSS_27, GAUSS_27, GAUSS_8, GAUSS_9)


def rules_of(shape: Shape) -> Rules:
    """Rules of a cell; second order needs degree 2 for the stiffness of tetrahedra, curved ones too.

    Source: Ciarlet, The Finite Element Method for Elliptic Problems, theorems 4.1.6 and 4.4.6.
    """
    return _OF_TETRAHEDRA if shape.n_corners == 4 else _OF_HEXAHEDRA


def triangle_values(points: FloatArray) -> FloatArray:
    """(n, 6) values of the quadratic shape functions of a triangle at (n, 2) reference points."""
    return TRIANGLE_6.values(points)


def triangle_gradients(points: FloatArray) -> FloatArray:
    """(n, 6, 2) reference gradients of the quadratic shape functions of a triangle at (n, 2) points."""
    return TRIANGLE_6.gradients(points)


def tetrahedron_values(points: FloatArray) -> FloatArray:
    """(n, 10) values of the quadratic shape functions of a tetrahedron at (n, 3) reference points."""
    return TETRAHEDRON_10.values(points)


def tetrahedron_gradients(points: FloatArray) -> FloatArray:
    """(n, 10, 3) reference gradients of the quadratic shape functions of a tetrahedron at (n, 3) points."""
    return TETRAHEDRON_10.gradients(points)
