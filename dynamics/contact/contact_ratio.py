"""Contact ratio: mean number of tooth pairs that touch, in the limit of no load and under load."""

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.points import ContactPoints

Array = NDArray[np.float64]
TOUCHING = 1e-12
"""Gap that counts as contact without load [m]: the rounding of the geometry."""


def contact_ratio_of(closing: Array) -> float:
    """Mean number of pairs in contact over a mesh cycle [-].

    closing : (n_positions, n_pairs) of each tooth pair, contact where positive; the last pair came into mesh last, so
        that the columns follow each other. Entering and leaving are interpolated between the positions.
    """
    course = closing.T[::-1].ravel()
    touching = course > 0.0
    part = np.where(touching, 1.0, 0.0)
    before, after = course[:-1], course[1:]
    cross = (touching[:-1] != touching[1:]) & np.isfinite(before) & np.isfinite(after)
    # trapezium over the steps, each counted by the part of it that is in contact
    steps = 0.5 * (part[:-1] + part[1:])
    inside = np.maximum(before[cross], after[cross])
    steps[cross] = inside / (inside - np.minimum(before[cross], after[cross]))
    return float(steps.sum() / closing.shape[0])


def unloaded_contact_ratio(points: ContactPoints, separation: float = TOUCHING) -> float:
    """Contact ratio in the limit of no load, modifications and deviations of the flanks included [-].

    points : over a mesh cycle, a thousand positions or more
    separation : gap that counts as contact [m]

    Pairs touch whose gap is the smallest of all at their position; unmodified flanks do so all over their path.
    Flanks with crowning hand over from pair to pair, which is a contact ratio of 1.
    """
    gap = points.gap.min(axis=2)
    nearest, second = np.partition(gap, 1, axis=1)[:, :2].T[:, :, None]
    # against the nearest other pair: a hand-over crosses zero for both at one place
    return contact_ratio_of(separation + np.where(gap > nearest, nearest, second) - gap)
