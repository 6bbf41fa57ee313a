"""The measurement that would tell rivals apart: separation by what is already known, per cost.

Two rivals, each at its best fit, foresee different readings of a new sensor or point. What they disagree on is
evaluated by the covariance of those readings given the ones there are, each rival free to change its size within what
the data leave it (T-optimal design for rival models, Atkinson and Fedorov, Biometrika 62, 1975, 57).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array

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


@dataclass(frozen=True, kw_only=True)
class SmallestSet:
    """Measurements that decide together, the cheapest set that was found.

    separation : of the two rivals that they separate least [variances]; cost : of all; rows : of their readings
    """

    titles: tuple[str, ...]
    separation: float
    cost: float
    rows: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Foreseen:
    """What every rival foresees of the readings that could be taken, given those there are.

    left : (m, m) their covariance; values : by rival (m,); free : by rival (m, k) what its open size moves
    """

    left: Array
    values: tuple[Array, ...]
    free: tuple[Array, ...]

    @classmethod
    def of(cls, matrix: Array, residual: Array, rivals: Sequence[Rival]) -> "Foreseen":
        """By the covariance (n + m, n + m) of a healthy rig and the residual (n,) of the measured numbers."""
        measured = len(residual)
        known = matrix[:measured, :measured]
        gain = np.asarray(np.linalg.solve(known, matrix[:measured, measured:])).T
        return cls(
            left=matrix[measured:, measured:] - gain @ matrix[:measured, measured:],
            values=tuple(one.answer[measured:] + gain @ (residual - one.answer[:measured]) for one in rivals),
            free=tuple(_freedom(one, gain, measured) for one in rivals),
        )

    def separation(self, rows: Sequence[int]) -> float:
        """Of the two rivals that some readings separate least [variances]."""
        at = np.array(rows, dtype=np.intp)
        left = self.left[np.ix_(at, at)]
        return min(
            _separation(self.values[i][at] - self.values[j][at], left, self.free[i][at], self.free[j][at])
            for i in range(len(self.values))
            for j in range(i + 1, len(self.values))
        )


def ranked(foreseen: Foreseen, proposals: Sequence[Proposal]) -> tuple[Ranked, ...]:
    """Proposals by separation per cost, best first; none with fewer than two rivals."""
    if len(foreseen.values) < 2:
        return ()
    found = []
    for proposal in proposals:
        least = foreseen.separation(proposal.rows)
        found.append(
            Ranked(title=proposal.title, separation=least, cost=proposal.cost, decides=least >= TELLS)
        )
    return tuple(sorted(found, key=lambda one: -one.separation / one.cost))


MOST_TOGETHER = 4
"""Measurements of a set at most."""


def smallest_set(foreseen: Foreseen, proposals: Sequence[Proposal]) -> SmallestSet | None:
    """The cheapest measurements found that decide together; None where no few of them do.

    Measurements are added one at a time, each the one that separates most per cost with those before; then those that
    the others make superfluous are taken out, the dearest first.
    """
    if len(foreseen.values) < 2:
        return None
    chosen: list[Proposal] = []
    reached = 0.0
    while reached < TELLS and len(chosen) < MOST_TOGETHER:
        left = [one for one in proposals if one not in chosen]
        if not left:
            return None
        separations = [foreseen.separation(_rows([*chosen, one])) for one in left]
        worth = [
            (min(s, TELLS) - min(reached, TELLS)) / one.cost for one, s in zip(left, separations, strict=True)
        ]
        best = int(np.argmax(worth))
        if worth[best] <= 0.0:
            return None
        chosen.append(left[best])
        reached = separations[best]
    if reached < TELLS:
        return None
    for one in sorted(chosen, key=lambda item: -item.cost):
        fewer = [other for other in chosen if other is not one]
        if fewer and foreseen.separation(_rows(fewer)) >= TELLS:
            chosen = fewer
    return SmallestSet(
        titles=tuple(one.title for one in chosen),
        separation=foreseen.separation(_rows(chosen)),
        cost=sum(one.cost for one in chosen),
        rows=_rows(chosen),
    )


def _rows(proposals: Sequence[Proposal]) -> tuple[int, ...]:
    return tuple(row for one in proposals for row in one.rows)


def _freedom(rival: Rival, gain: Array, measured: int) -> Array:
    """(m, k) what the open size of a rival moves in the candidates beyond what the data would show."""
    moved = rival.slopes[measured:] - gain @ rival.slopes[:measured]
    return np.asarray(moved * rival.deviations)


def _separation(apart: Array, left: Array, first: Array, second: Array) -> float:
    spread = left + first @ first.T + second @ second.T
    return float(apart @ np.linalg.solve(spread, apart))
