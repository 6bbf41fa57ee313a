"""The measurement that would tell rivals apart: separation by what is already known, per cost.

Two rivals, each at its best fit, foresee different readings of a new sensor or point. What they disagree on is
evaluated by the covariance of those readings given the ones there are, each rival free to change its size within what
the data leave it (T-optimal design for rival models, Atkinson and Fedorov, Biometrika 62, 1975, 57).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Covariance

TELLS = 10.0
"""Separation [variances] from which on a measurement decides between two rivals."""


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """Something that could be measured next.

    rows : of the readings it would add, in the candidates' table; cost : relative to one thermocouple
    """

    title: str
    rows: tuple[int, ...]
    cost: float


@dataclass(frozen=True, kw_only=True)
class Rival:
    """An explanation at its best fit, at the numbers measured and at those that could be.

    answer : (n + m,); slopes : (n + m, k); deviations : (k,) what the data leave of its sizes
    """

    name: str
    answer: Array
    slopes: Array
    deviations: Array


@dataclass(frozen=True, kw_only=True)
class Ranked:
    """A proposal with what it would bring.

    separation : of the two rivals that it separates least, in variances
    """

    title: str
    separation: float
    cost: float
    decides: bool


def ranked(
    covariance: Covariance,
    measured: int,
    residual: Array,
    rivals: Sequence[Rival],
    proposals: Sequence[Proposal],
) -> tuple[Ranked, ...]:
    """Proposals by separation per cost, best first.

    Parameters
    ----------
    covariance : of a healthy rig at the measured numbers, then at the candidates
    measured : how many of its numbers are measured; residual : (measured,) of those
    """
    if len(rivals) < 2:
        return ()
    matrix = covariance.matrix
    known = matrix[:measured, :measured]
    gain = np.asarray(np.linalg.solve(known, matrix[:measured, measured:])).T
    left = matrix[measured:, measured:] - gain @ matrix[:measured, measured:]
    foreseen = [one.answer[measured:] + gain @ (residual - one.answer[:measured]) for one in rivals]
    free = [_freedom(one, gain, measured) for one in rivals]
    found = []
    for proposal in proposals:
        rows = np.array(proposal.rows, dtype=np.intp)
        least = min(
            _separation(
                foreseen[i][rows] - foreseen[j][rows], left[np.ix_(rows, rows)], free[i][rows], free[j][rows]
            )
            for i in range(len(rivals))
            for j in range(i + 1, len(rivals))
        )
        found.append(
            Ranked(title=proposal.title, separation=least, cost=proposal.cost, decides=least >= TELLS)
        )
    return tuple(sorted(found, key=lambda one: -one.separation / one.cost))


def _freedom(rival: Rival, gain: Array, measured: int) -> Array:
    """(m, k) what the open size of a rival moves in the candidates beyond what the data would show."""
    moved = rival.slopes[measured:] - gain @ rival.slopes[:measured]
    return np.asarray(moved * rival.deviations)


def _separation(apart: Array, left: Array, first: Array, second: Array) -> float:
    spread = left + first @ first.T + second @ second.T
    return float(apart @ np.linalg.solve(spread, apart))
