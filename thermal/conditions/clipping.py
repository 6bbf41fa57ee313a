"""Convex polygons by the thousand: cut at half-spaces, split into triangles.

A batch of n polygons is an array (n, m, d) of vertices in order. Polygons with fewer than m corners repeat
their last vertex, so that every edge beyond the last has no length and every triangle no area.
"""

import numpy as np

from thermal.fe.mesh import FloatArray


def clip(vertices: FloatArray, heights: FloatArray) -> FloatArray:
    """Keep the part of every polygon where ``heights`` is not negative.

    vertices : (n, m, d); heights : (n, m), linear over each polygon
    Return (n, m + 1, d). A polygon that lies below shrinks to its first vertex.

    Source: Sutherland, Hodgman, Reentrant polygon clipping, Comm. ACM 17 (1974) 32.
    """
    n, m, d = vertices.shape
    following = np.roll(vertices, -1, axis=1)
    after = np.roll(heights, -1, axis=1)
    inside = heights >= 0.0
    crossing = inside != (after >= 0.0)
    share = np.where(crossing, heights, 0.0) / np.where(crossing, heights - after, 1.0)
    cuts = vertices + share[:, :, None] * (following - vertices)
    listed = np.stack([vertices, cuts], axis=2).reshape(n, 2 * m, d)
    kept = np.stack([inside, crossing], axis=2).reshape(n, 2 * m)
    order = np.argsort(~kept, axis=1, kind="stable")
    last = np.maximum(kept.sum(axis=1) - 1, 0)
    chosen = np.take_along_axis(order, np.minimum(np.arange(m + 1), last[:, None]), axis=1)
    chosen[~kept.any(axis=1)] = 0
    return np.take_along_axis(listed, chosen[:, :, None], axis=1)


def intersect(subjects: FloatArray, windows: FloatArray) -> FloatArray:
    """Common part of pairs of convex polygons in the plane.

    subjects : (n, m, 2); windows : (n, k, 2), counter-clockwise. Return (n, m + k, 2).
    """
    for corner in range(windows.shape[1]):
        start = windows[:, corner, None]
        edge = windows[:, (corner + 1) % windows.shape[1], None] - start
        subjects = clip(subjects, cross(edge, subjects - start))
    return subjects


def fan(polygons: FloatArray) -> FloatArray:
    """Triangles (n, m - 2, 3, d) from the first vertex of every polygon (n, m, d)."""
    m = polygons.shape[1]
    corners = [[0, k, k + 1] for k in range(1, m - 1)]
    return polygons[:, corners]


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Component of a x b normal to the plane, for vectors (..., 2)."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
