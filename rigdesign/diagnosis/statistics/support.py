"""On how many operating points an explanation rests: what is left of it without the one that speaks for it most.

A resonance that moved by a per cent changes one point by more than any noise; what a rig has changed shows at several.
"""

from collections.abc import Sequence

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import Evidence, release_of


def support(space: Whitened, points: Sequence[str], one: Evidence, part: str) -> tuple[float, str]:
    """Least fall of the whitened square by one part of an explanation when a single operating point is left out.

    points : (n,) operating point of each number, empty at rest; numbers at rest always stay

    Returns the fall and the point without which it is so small, empty where there is none. Of a Gaussian with
    precision P the numbers of a point are left out by x'Py - (Px)_p' P_pp^-1 (Py)_p.
    """
    lower = space.covariance.lower
    precision = _released(space, one.hypothesis.own)
    own = lower @ one.share_of(part)
    left = lower @ (space.freed(one.hypothesis.own) - one.answer) + own
    seen, change = precision @ (left - 0.5 * own), precision @ own
    whole = 2.0 * float(own @ seen)
    least, where = whole, ""
    for point in sorted(set(points) - {""}):
        rows = np.array([row for row, name in enumerate(points) if name == point])
        block = precision[np.ix_(rows, rows)]
        fall = whole - 2.0 * float(change[rows] @ np.linalg.solve(block, seen[rows]))
        if fall < least:
            least, where = fall, point
    return least, where


def _released(space: Whitened, own: Sequence[str]) -> Array:
    """(n, n) precision without the spreads of these effects."""
    release = release_of(space, own)
    if not release.directions.shape[1]:
        return space.precision
    reached = np.linalg.solve(space.covariance.lower.T, release.directions)
    return np.asarray(space.precision + reached @ release.weights @ reached.T)
