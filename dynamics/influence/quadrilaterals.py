"""Quadrilaterals of eight nodes in the plane: their sense and whether they fold."""

import numpy as np
from numpy.typing import NDArray

from thermal.fe.reference_elements import QUAD_8

Array = NDArray[np.float64]
IndexArray = NDArray[np.int32]


def anticlockwise(points: Array, cells: IndexArray) -> IndexArray:
    """Cells (n, 8) on points (n_points, 2) with their corners anticlockwise."""
    a, b, c = (points[cells[:, k]] for k in range(3))
    turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    cells = cells.copy()
    cells[turned] = cells[turned][:, [0, 3, 2, 1, 7, 6, 5, 4]]
    return cells


def on_circles(points: Array, cells: IndexArray) -> Array:
    """Points with the middles of the sides of cells (n, 8) on circles about the origin instead of on chords.

    gmsh leaves sides inside of a plane surface straight; wide and thin cells on an arc would fold.
    """
    points = points.copy()
    for side in range(4):
        first, last = points[cells[:, side]], points[cells[:, (side + 1) % 4]]
        middle = 0.5 * (first + last)
        radius = 0.5 * (np.hypot(*first.T) + np.hypot(*last.T))
        points[cells[:, 4 + side]] = middle * (radius / np.hypot(*middle.T))[:, None]
    return points


def least_jacobian(points: Array, cells: IndexArray) -> float:
    """Smallest determinant of the Jacobian at nodes of anticlockwise cells, over the area of the cell about it [-].

    Not positive: the cell folds.
    """
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    places = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=0))])
    gradients = QUAD_8.gradients(places)
    jacobian = np.einsum("nka,qkb->nqab", points[cells], gradients)
    found = jacobian[..., 0, 0] * jacobian[..., 1, 1] - jacobian[..., 0, 1] * jacobian[..., 1, 0]
    return float((found / np.abs(found).mean(axis=1, keepdims=True)).min())
