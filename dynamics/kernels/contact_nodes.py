"""Sums over the slices of tooth pairs at the nodes of a contact table, see ``dynamics.kernels.contact_table``."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

# compiled from sources 6fc6ce05
Array = NDArray[np.float64]

SUMS = 7
"""Sums at a node before those of friction."""


class SliceSprings(NamedTuple):
    """All slices that can touch at each place on the path, every array (n_knots, n_slices)."""

    stiffness: Array
    """0 where a slice is off the path [N/m]."""
    gap: Array
    """[m]"""
    slope: Array
    """Of the gap over the path [-]."""
    path: Array
    """Path position of the slice [m]."""
    face: Array
    """(n_slices,) face position [m]."""


class Sliding(NamedTuple):
    """Where sliding reverses."""

    reversal: float
    """Path position [m]."""
    sharpness: Array
    """(n_sharpness,) of the reversals to sum for [1/m]."""


@njit(cache=True)
def slice_sums(
    springs: SliceSprings, approach: Array, damping_depth: float, sliding: Sliding, sums: Array
) -> None:
    """Fill ``sums`` (n_knots, n_depths, SUMS + 2 n_sharpness) at ``approach`` (n_knots, n_depths) [m].

    Elastic energy, force, damper weight; force and stiffness times face position; damper weight times slope of the
    gap, times its square; then for each sharpness the force times direction of sliding, and that times path position.
    """
    stiffness, gap, slope, path = springs.stiffness, springs.gap, springs.slope, springs.path
    face, sharpness = springs.face, sliding.sharpness
    direction = np.empty(sharpness.shape[0])
    sums[:] = 0.0
    for a in range(stiffness.shape[0]):
        for i in range(stiffness.shape[1]):
            k, g, e, s, z = stiffness[a, i], gap[a, i], slope[a, i], path[a, i], face[i]
            if k == 0.0:
                continue
            for q in range(sharpness.shape[0]):
                ratio = min(1.0, max(-1.0, sharpness[q] * (s - sliding.reversal)))
                direction[q] = ratio * (1.5 - 0.5 * ratio * ratio)
            for j in range(approach.shape[1]):
                depth = approach[a, j] - g
                if depth <= 0.0:
                    continue
                force = k * depth
                weight = k * min(1.0, depth / damping_depth)
                sums[a, j, 0] += 0.5 * force * depth
                sums[a, j, 1] += force
                sums[a, j, 2] += weight
                sums[a, j, 3] += force * z
                sums[a, j, 4] += k * z
                sums[a, j, 5] += weight * e
                sums[a, j, 6] += weight * e * e
                for q in range(sharpness.shape[0]):
                    sums[a, j, SUMS + 2 * q] += force * direction[q]
                    sums[a, j, SUMS + 1 + 2 * q] += force * direction[q] * s
