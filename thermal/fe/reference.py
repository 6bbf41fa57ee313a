"""Shape functions and quadrature on the reference tetrahedron and triangle.

Rules are positive and lie inside: 4 points of degree 2 and 14 points of degree 5 on the tetrahedron
(Walkington, Quadrature on simplices of arbitrary dimension, 2000), 7 points of degree 5 on the triangle
(Radon 1948; Strang and Fix 1973). The test integrates every monomial up to the degree.
"""

from dataclasses import dataclass

import numpy as np

from thermal.fe.mesh import CELL_EDGES, FloatArray


@dataclass(frozen=True)
class Rule:
    """Quadrature points (n, d) and weights (n,) [-]; the weights sum to the reference volume."""

    points: FloatArray
    weights: FloatArray


def _orbit(a: float, corners: int) -> list[list[float]]:
    """Barycentric points with all coordinates ``a`` but one, without the first coordinate."""
    rest = 1.0 - (corners - 1) * a
    full = [[rest if i == j else a for i in range(corners)] for j in range(corners)]
    return [point[1:] for point in full]


def _tetrahedron_4() -> Rule:
    return Rule(np.array(_orbit((5.0 - np.sqrt(5.0)) / 20.0, 4)), np.full(4, 1.0 / 24.0))


def _tetrahedron_14() -> Rule:
    c = 0.045503704125649649492
    pairs = [[c if k in pair else 0.5 - c for k in range(4)][1:] for pair in CELL_EDGES]
    points = _orbit(0.31088591926330060980, 4) + _orbit(0.092735250310891226402, 4) + pairs
    weights = [0.11268792571801585080] * 4 + [0.073493043116361949544] * 4 + [0.042546020777081466438] * 6
    return Rule(np.array(points), np.array(weights) / 6.0)


def _triangle_7() -> Rule:
    root = np.sqrt(15.0)
    a, b = (6.0 - root) / 21.0, (6.0 + root) / 21.0
    points = [[1.0 / 3.0, 1.0 / 3.0], *_orbit(a, 3), *_orbit(b, 3)]
    weights = [9.0 / 40.0] + [(155.0 - root) / 1200.0] * 3 + [(155.0 + root) / 1200.0] * 3
    return Rule(np.array(points), np.array(weights) / 2.0)


TETRAHEDRON_4 = _tetrahedron_4()
TETRAHEDRON_14 = _tetrahedron_14()
TRIANGLE_7 = _triangle_7()


def tetrahedron_values(points: FloatArray) -> FloatArray:
    """(n, 10) values of the quadratic shape functions at (n, 3) reference points."""
    corner = _barycentric(points)
    edge = [4.0 * corner[:, a] * corner[:, b] for a, b in CELL_EDGES]
    return np.column_stack([*(corner * (2.0 * corner - 1.0)).T, *edge])


def tetrahedron_gradients(points: FloatArray) -> FloatArray:
    """(n, 10, 3) reference gradients of the quadratic shape functions at (n, 3) points."""
    return _quadratic_gradients(points, CELL_EDGES)


def triangle_values(points: FloatArray) -> FloatArray:
    """(n, 6) values of the quadratic shape functions at (n, 2) reference points."""
    corner = _barycentric(points)
    edge = [4.0 * corner[:, a] * corner[:, b] for a, b in CELL_EDGES[:3]]
    return np.column_stack([*(corner * (2.0 * corner - 1.0)).T, *edge])


def triangle_gradients(points: FloatArray) -> FloatArray:
    """(n, 6, 2) reference gradients of the quadratic shape functions at (n, 2) points."""
    return _quadratic_gradients(points, CELL_EDGES[:3])


def triangle_corner_values(points: FloatArray) -> FloatArray:
    """(n, 3) values of the linear shape functions at (n, 2) reference points."""
    return _barycentric(points)


def _barycentric(points: FloatArray) -> FloatArray:
    return np.column_stack([1.0 - points.sum(axis=1), points])


def _quadratic_gradients(points: FloatArray, edges: tuple[tuple[int, int], ...]) -> FloatArray:
    corner = _barycentric(points)
    slope = np.vstack([-np.ones(points.shape[1]), np.eye(points.shape[1])])
    corners = (4.0 * corner - 1.0)[:, :, None] * slope
    mids = [4.0 * (corner[:, a, None] * slope[b] + corner[:, b, None] * slope[a]) for a, b in edges]
    return np.ascontiguousarray(np.concatenate([corners, np.stack(mids, axis=1)], axis=1))
