"""Second-order elements on tight circles, kept from turning inside out.

A mesher puts mid-side nodes on the geometry of the boundary and in the middle of every other edge. Where an
element is thin against the sagitta of a coarse arc (the shoulder of a shaft), the arc then crosses the
straight edge behind it. Bending the inside along with the circles cures nearly all of it, the rest loses its
curvature. gmsh's own high-order optimiser does the same work, but not to the same bits from run to run.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from thermal.fe.mesh import FloatArray, IndexArray, MeshError
from thermal.fe.reference_elements import TETRAHEDRON_10

LEAST_JACOBIAN = 0.1
"""Least ratio of the smallest to the mean Jacobian of an element before its edges are straightened."""

BendAxis = tuple[float, float, float]
"""y and z of an axis along x, and the radius within which elements follow its circles [m]."""


def bend_round_axes(
    points: FloatArray, cells: IndexArray, free: NDArray[np.bool_], axes: Sequence[BendAxis]
) -> FloatArray:
    """Let the inside of a mesh follow the circles on its boundary.

    points : (n_nodes, 3) [m]; cells : (n_cells, 10); free : (n_nodes,) nodes that may move across x

    The middle of a free edge moves radially to the mean radius of its ends, as it does by itself on a circle.
    The shift fades out between one and two times the reach of an axis; chords over more than a quarter turn
    stay straight.
    """
    points = points.copy()
    for middle, (first, second) in enumerate(TETRAHEDRON_10.edges, start=4):
        nodes, where = np.unique(cells[:, middle], return_index=True)
        where, nodes = where[free[nodes]], nodes[free[nodes]]
        start, end = points[cells[where, first], 1:], points[cells[where, second], 1:]
        shift = np.zeros_like(start)
        for y, z, reach in axes:
            chord = 0.5 * (start + end) - (y, z)
            radius = np.hypot(*chord.T)
            mean = 0.5 * (np.hypot(*(start - (y, z)).T) + np.hypot(*(end - (y, z)).T))
            weight = np.clip(2.0 - mean / reach, 0.0, 1.0) * (radius > np.sqrt(0.5) * mean)
            outwards = np.divide(mean - radius, radius, out=np.zeros_like(radius), where=radius > 0.0)
            shift += (weight * outwards)[:, None] * chord
        points[nodes, 1:] = 0.5 * (start + end) + shift
    return points


def straighten_inverted(points: FloatArray, cells: IndexArray, name: str = "mesh") -> FloatArray:
    """Points with the mid-side nodes of badly curved elements moved onto the chord of their edge.

    points : (n_nodes, 3) [m]; cells : (n_cells, 10). A straight-sided element cannot be inverted by its
    mid-side nodes, so this ends. Raises MeshError if an element is inverted although its edges are straight.
    """
    points = points.copy()
    straight = np.zeros(len(cells), dtype=bool)
    changed = np.arange(len(cells))
    while True:
        bad = changed[jacobian_ratio(points, cells[changed]) < LEAST_JACOBIAN]
        if not len(bad):
            return points
        if straight[bad].any():
            raise MeshError(
                f"{name}: {np.count_nonzero(straight[bad])} of {len(cells)} elements are inverted; choose a "
                "finer mesh or avoid walls and steps much thinner than the rest"
            )
        straight[bad] = True
        chosen = cells[bad]
        for middle, (first, second) in enumerate(TETRAHEDRON_10.edges, start=4):
            points[chosen[:, middle]] = 0.5 * (points[chosen[:, first]] + points[chosen[:, second]])
        moved = np.zeros(len(points), dtype=bool)
        moved[chosen[:, 4:]] = True
        changed = np.flatnonzero(moved[cells[:, 4:]].any(axis=1))


def jacobian_ratio(points: FloatArray, cells: IndexArray) -> FloatArray:
    """Smallest over mean Jacobian of each ten-node tetrahedron (n_cells,), sampled at its ten nodes.

    1 for straight edges with mid-side nodes in the middle; 0 or less for an inverted element.
    """
    nodes = points[cells]
    mean = _determinants(nodes[:, 1:4] - nodes[:, :1])
    least = np.full(len(cells), np.inf)
    for gradients in TETRAHEDRON_10.gradients(TETRAHEDRON_10.nodes):
        least = np.minimum(least, _determinants(gradients.T @ nodes))
    ratio = np.full(len(cells), -np.inf)
    np.divide(least, mean, out=ratio, where=mean > 0.0)
    return ratio


def _determinants(matrices: FloatArray) -> FloatArray:
    """Determinants of (n, 3, 3) by the triple product."""
    (a, b, c), (d, e, f), (g, h, i) = matrices.transpose(1, 2, 0)
    return np.asarray(a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g))
