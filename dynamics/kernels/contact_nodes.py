"""Sums over the slices of tooth pairs at the nodes of a contact table, see ``dynamics.kernels.contact_table``."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

SUMS = 9
"""Sums at a node before those of friction."""
FRICTION = 4
"""Sums of friction for each sharpness of its reversal."""
MOST_SETS = 64
"""Sets of closed contacts that are tried behind a shared body; four are many."""


class SliceSprings(NamedTuple):
    """All slices that can touch at each place on the path, every array (n_places, n_slices)."""

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


class NodeLaw(NamedTuple):
    """What else the sums need of a mesh law."""

    damping_depth: float
    """[m]"""
    body: float
    """Compliance that all slices share [m/N]."""
    rolling_radii: tuple[float, float]
    """T1C and T2C [m]."""
    reversal: float
    """Path position where sliding reverses [m]."""
    damp_time: float
    """Damping of a contact over its stiffness [s]."""
    path_speed: float
    """Speed of the flank along its path at which its dampers act on the closing rate [m/s]; 0: on the rotation."""
    sharpness: Array
    """(n_sharpness,) of the reversals to sum for [1/m]."""


@njit(cache=True)
def _behind_body(
    stiffness: Array, gap: Array, body: float, approach: float, start: float
) -> tuple[float, float]:
    """Return the approach behind the body, and the share of a change that the teeth take; see ``shared_body``."""
    y, before = start, -1.0
    share = 1.0
    for _ in range(MOST_SETS):
        total, force = 0.0, 0.0
        for i in range(stiffness.shape[0]):
            if y > gap[i]:
                total += stiffness[i]
                force += stiffness[i] * (y - gap[i])
        share = 1.0 / (1.0 + body * total)
        if total == before:
            break
        before = total
        y -= (y + body * force - approach) * share
    return y, share


@njit(cache=True)
def slice_sums(springs: SliceSprings, law: NodeLaw, approach: Array, sums: Array) -> None:
    """Fill ``sums`` (n_places, n_depths, SUMS + FRICTION n_sharpness) at ``approach`` (n_places, n_depths), rising [m].

    Elastic energy, force, damper weight; tilting moment and its derivative over the approach. Of dampers on the closing
    rate, at no rate of the approach: force and its derivative over that rate, torque on the slope of the gap and its
    derivative; contacts do not pull. Then for each sharpness the force times direction of sliding, that times path
    position, and what both lose per advance of the reversal.
    """
    stiffness, gap, slope, path = springs.stiffness, springs.gap, springs.slope, springs.path
    face, sharpness = springs.face, law.sharpness
    n_slices, n_depths = stiffness.shape[1], approach.shape[1]
    direction, turning = np.empty((n_slices, sharpness.shape[0])), np.empty((n_slices, sharpness.shape[0]))
    sums[:] = 0.0
    for a in range(stiffness.shape[0]):
        for i in range(n_slices):
            for q in range(sharpness.shape[0]):
                ratio = min(1.0, max(-1.0, sharpness[q] * (path[a, i] - law.reversal)))
                direction[i, q] = ratio * (1.5 - 0.5 * ratio * ratio)
                turning[i, q] = 1.5 * sharpness[q] * (1.0 - ratio * ratio)
        y = approach[a, 0]
        for j in range(n_depths):
            share = 1.0
            if law.body > 0.0:
                y, share = _behind_body(stiffness[a], gap[a], law.body, approach[a, j], y)
            else:
                y = approach[a, j]
            at = sums[a, j]
            for i in range(n_slices):
                k, depth = stiffness[a, i], y - gap[a, i]
                if depth <= 0.0 or k == 0.0:
                    continue
                force = k * depth
                weight = k * min(1.0, depth / law.damping_depth)
                at[0] += 0.5 * force * depth
                at[1] += force
                at[2] += weight
                at[3] += force * face[i]
                at[4] += share * k * face[i]
                if law.path_speed != 0.0:
                    damping = law.damp_time * weight
                    closing = -damping * slope[a, i] * law.path_speed
                    if force + closing > 0.0:
                        at[5] += closing
                        at[6] += damping
                        at[7] -= closing * slope[a, i]
                        at[8] -= damping * slope[a, i]
                    else:
                        at[5] -= force
                        at[7] += force * slope[a, i]
                for q in range(sharpness.shape[0]):
                    first = SUMS + FRICTION * q
                    at[first] += force * direction[i, q]
                    at[first + 1] += force * direction[i, q] * path[a, i]
                    at[first + 2] -= force * turning[i, q]
                    at[first + 3] -= force * turning[i, q] * path[a, i]
            at[0] += 0.5 * law.body * at[1] * at[1]
