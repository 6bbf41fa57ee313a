"""What single effects and sensor errors leave in the numbers, and which of them leave the same."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.detectability import ALIAS, REACHES, SEEN
from rigdesign.diagnosis.statistics.evidence import Evidence
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis

NAMED = frozenset({"physical", "sensor"})
"""Families of what has a name."""

SIZES = 13
"""Sizes over the bounds of a curve at which its answer is held against a trace."""


@dataclass(frozen=True, kw_only=True)
class Traces:
    """What single effects and sensor errors leave in the numbers they were sought in.

    space : of the first look; explanations : of that look; assembly : (n,) how the rig was put together at the point of
        each number
    contradicted : explanations that the other domain contradicts in that look; with a name in the model it may not
    """

    space: Whitened
    explanations: Sequence[Evidence]
    assembly: Sequence[object]
    contradicted: Sequence[Evidence] = ()

    def like(
        self, explanation: str, size: Sequence[float], families: frozenset[str] = NAMED
    ) -> list[tuple[str, float]]:
        """Causes of some families whose trace correlates with that of a name above `ALIAS`, those most alike first.

        The trace of a name is its whitened answer at its size. It is held against the answers of every other one over
        its bounds, of two parameters against the plane they span, under the covariance of the data. Where the rig was
        put together otherwise at some points, to tell such effects apart, they are alike only if they also are with the
        trace counting as much in each assembly: one may be read far more exactly than the other. What within its bounds
        leaves less than `REACHES` of the trace cannot stand for it; offset and scale of one sensor are one finding.
        """
        own = next(one for one in self._own if one.hypothesis.name == explanation)
        name = own.hypothesis.parts[0]
        trace = _answers(own.hypothesis, np.array([size]))[0]
        found: dict[str, float] = {}
        for one in self._single(families):
            other = one.hypothesis.parts[0]
            if other == name or _of_one_sensor(own, one):
                continue
            for plane in _planes(one.hypothesis, trace):
                correlation = _cosine(plane, trace)
                if correlation > ALIAS and _cosine(*self._by_assembly(plane, trace)) > ALIAS:
                    found[other] = max(found.get(other, 0.0), correlation)
        return sorted(found.items(), key=lambda pair: -pair[1])

    def of(self, name: str) -> Evidence:
        """The best explanation by a name alone."""
        return next(one for one in self._own if one.hypothesis.parts == (name,))

    @property
    def _own(self) -> list[Evidence]:
        return [*self._single(NAMED), *self.contradicted]

    def _single(self, families: frozenset[str]) -> list[Evidence]:
        return [one for one in self.explanations if one.hypothesis.family in families]

    def _by_assembly(self, plane: Array, trace: Array) -> tuple[Array, Array]:
        """Columns (n, k) and a trace (n,), scaled so that no assembly in which the trace is seen outweighs another."""
        states = list(dict.fromkeys(self.assembly))
        if len(states) == 1:
            return plane, trace
        lower, matrix = self.space.covariance.lower, self.space.covariance.matrix
        both = lower @ np.column_stack([plane, trace])
        for state in states:
            rows = np.array([row for row, one in enumerate(self.assembly) if one == state])
            factor = np.linalg.cholesky(matrix[np.ix_(rows, rows)])
            own = solve_triangular(factor, both[rows], lower=True, check_finite=False)
            both[rows] = own / max(1.0, float(np.linalg.norm(own[:, -1])) / SEEN)
        return both[:, :-1], both[:, -1]


def _answers(hypothesis: Hypothesis, sizes: Array) -> Array:
    """(m, n) whitened answers at sizes (m, k)."""
    if hypothesis.curve is not None:
        return hypothesis.curve.at(sizes[:, 0])
    assert hypothesis.columns is not None
    return np.asarray(sizes @ hypothesis.columns.T)


def _planes(hypothesis: Hypothesis, trace: Array) -> list[Array]:
    """Columns (n, k) of what may stand for a trace (n,): a curve at sizes over its bounds, a plane as it is."""
    least = REACHES * float(trace @ trace)
    if hypothesis.curve is None:
        assert hypothesis.columns is not None
        reach = hypothesis.half * float(np.linalg.norm(hypothesis.columns.T @ trace))
        return [hypothesis.columns] if reach >= least else []
    sizes = np.linspace(*hypothesis.curve.bounds, SIZES)[:, None]
    return [answer[:, None] for answer in _answers(hypothesis, sizes) if answer @ trace >= least]


def _of_one_sensor(first: Evidence, second: Evidence) -> bool:
    """Whether two explanations are errors of the same sensor or setting."""
    if {first.hypothesis.family, second.hypothesis.family} != {"sensor"}:
        return False
    kinds, places = zip(
        *(one.hypothesis.parts[0].partition(":")[::2] for one in (first, second)), strict=True
    )
    return len({kind.rpartition("_")[0] for kind in kinds}) == len(set(places)) == 1


def _cosine(plane: Array, trace: Array) -> float:
    """Between a trace (n,) and what columns (n, k) span."""
    return float(np.linalg.norm(np.linalg.qr(plane)[0].T @ trace) / np.linalg.norm(trace))
