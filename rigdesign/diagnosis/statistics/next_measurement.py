"""The measurement that would tell rivals apart: the evidence it is expected to give, per cost.

Two rivals, each at its best fit, foresee different readings of a new sensor or point: normal distributions by the
covariance of those readings given the ones there are, each rival free to change its size within what the data leave it.
If one of them is true, the expected logarithm of its Bayes factor over the other is the divergence of the two
distributions (Kullback and Leibler, Ann. Math. Stat. 22, 1951, 79; as a criterion of design: Box and Hill,
Technometrics 9, 1967, 57).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from rigdesign.diagnosis.statistics.columns import Array

TELLS = 5.0
"""Expected logarithm of the Bayes factor of the true rival from which on a measurement decides: odds of 150 to 1."""


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """Something that could be measured next.

    rows : of the readings it would add, in the candidates' table; cost : as the set states costs, else relative to one
        thermocouple
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

    expected_evidence : logarithm of the Bayes factor of the true rival, of the two distinguished least
    """

    title: str
    expected_evidence: float
    cost: float
    decides: bool


@dataclass(frozen=True, kw_only=True)
class SmallestSet:
    """Measurements that decide together, the cheapest set that was found.

    expected_evidence : logarithm of the Bayes factor of the true rival, of the two distinguished least
    cost : of all; rows : of their readings
    """

    titles: tuple[str, ...]
    expected_evidence: float
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
            values=tuple(
                rival.answer[measured:] + gain @ (residual - rival.answer[:measured]) for rival in rivals
            ),
            free=tuple(_freedom(rival, gain, measured) for rival in rivals),
        )

    def expected_evidence(self, rows: Sequence[int]) -> float:
        """Expected logarithm of the Bayes factor by some readings, of the two rivals distinguished least."""
        readings = np.array(rows, dtype=np.intp)
        left = self.left[np.ix_(readings, readings)]
        means = [values[readings] for values in self.values]
        spreads = [left + free[readings] @ free[readings].T for free in self.free]
        return min(
            _divergence(means, spreads, true, false) for true, false in permutations(range(len(means)), 2)
        )


def ranked(foreseen: Foreseen, proposals: Sequence[Proposal]) -> tuple[Ranked, ...]:
    """Proposals by expected evidence per cost, best first; none with fewer than two rivals.

    Evidence beyond what decides counts among those alone that are worth the same without it.
    """
    if len(foreseen.values) < 2:
        return ()
    ranking = []
    for proposal in proposals:
        least = foreseen.expected_evidence(proposal.rows)
        ranking.append(
            Ranked(title=proposal.title, expected_evidence=least, cost=proposal.cost, decides=least >= TELLS)
        )
    worth = {
        measurement: (
            min(measurement.expected_evidence, TELLS) / measurement.cost,
            measurement.expected_evidence / measurement.cost,
        )
        for measurement in ranking
    }
    return tuple(sorted(ranking, key=lambda measurement: worth[measurement], reverse=True))


MOST_TOGETHER = 4
"""Measurements of a set at most."""


def smallest_set(foreseen: Foreseen, proposals: Sequence[Proposal]) -> SmallestSet | None:
    """The cheapest measurements found that decide together; None where no few of them do.

    Measurements are added one at a time, each the one expected to give most per cost with those before; then those
    that the others make superfluous are taken out, the most expensive first.
    """
    if len(foreseen.values) < 2:
        return None
    chosen: list[Proposal] = []
    reached = 0.0
    while reached < TELLS and len(chosen) < MOST_TOGETHER:
        left = [proposal for proposal in proposals if proposal not in chosen]
        if not left:
            return None
        evidence = [foreseen.expected_evidence(_rows([*chosen, proposal])) for proposal in left]
        worth = [
            (min(after, TELLS) - reached) / proposal.cost
            for proposal, after in zip(left, evidence, strict=True)
        ]
        best = int(np.argmax(worth))
        if worth[best] <= 0.0:
            return None
        chosen.append(left[best])
        reached = evidence[best]
    if reached < TELLS:
        return None
    for proposal in sorted(chosen, key=lambda item: -item.cost):
        fewer = [other for other in chosen if other is not proposal]
        if fewer and foreseen.expected_evidence(_rows(fewer)) >= TELLS:
            chosen = fewer
    return SmallestSet(
        titles=tuple(proposal.title for proposal in chosen),
        expected_evidence=foreseen.expected_evidence(_rows(chosen)),
        cost=sum(proposal.cost for proposal in chosen),
        rows=_rows(chosen),
    )


def _rows(proposals: Sequence[Proposal]) -> tuple[int, ...]:
    return tuple(row for proposal in proposals for row in proposal.rows)


def _freedom(rival: Rival, gain: Array, measured: int) -> Array:
    """(m, k) what the open size of a rival moves in the candidates beyond what the data would show."""
    moved = rival.slopes[measured:] - gain @ rival.slopes[:measured]
    return np.asarray(moved * rival.deviations)


def _divergence(means: Sequence[Array], spreads: Sequence[Array], true: int, false: int) -> float:
    """Of normal readings with the mean and spread of one rival from those of another."""
    factor = cho_factor(spreads[false], lower=True)
    apart = means[true] - means[false]
    ratio = np.asarray(cho_solve(factor, spreads[true]))
    _, logarithm = np.linalg.slogdet(ratio)
    square = float(apart @ cho_solve(factor, apart))
    return 0.5 * (square + float(np.trace(ratio)) - len(apart) - float(logarithm))
