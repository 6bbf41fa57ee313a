"""What a model may answer wrongly to a right cause, admitted to every explanation alike.

A cause in the model never leaves exactly the trace it leaves on the rig. An explanation with the answer a is
therefore evaluated under C + E E': every series of numbers (one channel, one order) may be off by a share of its own
answer, the same over all points and along the speed, and orders by themselves
(`rigdesign.diagnosis.statistics.model_error`). With no cause there is no answer and no such error, so that a small
effect is not hidden by it; rivals that differ by less than the model error are separated by their priors
alone.

C^-1 is known; E is of low rank, so that all products follow from block sums (Woodbury's identity).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve, solve_triangular
from scipy.sparse import csr_array

from rigdesign.diagnosis.residual.healthy import TREND
from rigdesign.diagnosis.statistics.columns import Array, Column, series_numbers
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import (
    Evidence,
    Hypothesis,
    deviations_of,
    inverse_of,
    mixed,
    release_of,
)
from rigdesign.diagnosis.statistics.model_error import ModelError
from rigdesign.prediction.model import Feature

EXACT = ("sensor", "input")
"""Families whose trace is known exactly."""

CONTENDERS = 60
"""Explanations, best first, whose own error is admitted; the others are too far behind."""


SLIGHT = 0.1
"""Error of one number by itself that is left out [standard deviations of its residual on a healthy rig]."""

MOST_ALONE = 400
"""Numbers whose model error counts, those with the largest."""


@dataclass(frozen=True, kw_only=True)
class Signature:
    """Series of the numbers of a comparison, and how wrong answers may be.

    order : (n,) places of the numbers sorted by series; starts : (s,) where each begins in it
    trend : (n,) logarithm of the relative speed; errors : kind of effect -> relative error, "" for the others
    own : error of every number by itself, if there is one
    circuit : effects that change what goes through the circuit
    """

    order: NDArray[np.intp]
    starts: NDArray[np.intp]
    trend: Array
    errors: Mapping[str, float]
    own: ModelError | None
    circuit: frozenset[str]

    @classmethod
    def of(
        cls,
        features: Sequence[Feature],
        trend: Array,
        errors: Mapping[str, float],
        own: ModelError | None = None,
        circuit: frozenset[str] = frozenset(),
    ) -> "Signature":
        """Of the numbers of a comparison."""
        series = series_numbers(features)
        order = np.argsort(series, kind="stable")
        starts = np.searchsorted(series[order], np.arange(series.max(initial=-1) + 1))
        return cls(order=order, starts=starts, trend=trend, errors=errors, own=own, circuit=circuit)

    def error_of(self, hypothesis: Hypothesis) -> float:
        """Relative error of the answer of an explanation; the largest of its parts."""
        if hypothesis.family in EXACT:
            return 0.0
        kinds = [part.split(":")[0].split("/")[0] for part in hypothesis.parts]
        return max(self.errors.get(kind, self.errors.get("", 0.0)) for kind in kinds)

    def rows(self, hypothesis: Hypothesis, answer: Array, precision: Array) -> csr_array:
        """(m, n) rows of E' for an answer (n,): series alike at all points, along the speed, numbers by themselves.

        precision : (n,) diagonal of the inverse covariance of a healthy rig
        """
        alike = self.error_of(hypothesis) * answer
        along = TREND * alike * self.trend
        places, alone = self._alone(hypothesis, answer, precision)
        values = np.concatenate([alike[self.order], along[self.order], alone])
        count = len(answer)
        ends = np.concatenate([self.starts, count + self.starts, 2 * count + np.arange(len(places) + 1)])
        across = np.concatenate([self.order, self.order, places])
        return csr_array((values, across, ends), shape=(len(ends) - 1, count))

    def _alone(
        self, hypothesis: Hypothesis, answer: Array, precision: Array
    ) -> tuple[NDArray[np.intp], Array]:
        """Places (k,) of numbers whose model error adds to the residual of a healthy rig, and the errors (k,)."""
        if self.own is None:
            return np.zeros(0, dtype=np.intp), np.zeros(0)
        errors = self.own.at(answer, circuit=not self.circuit.isdisjoint(hypothesis.parts))
        seen = errors * np.sqrt(precision)
        largest = np.argsort(-seen, kind="stable")[:MOST_ALONE]
        places = np.sort(largest[seen[largest] > SLIGHT])
        return places, errors[places]

    def columns(self, hypothesis: Hypothesis, answer: Array, precision: Array) -> list[Column]:
        """The error of an answer (n,) as columns of a covariance; none where it is exact."""
        if self.error_of(hypothesis) == 0.0:
            return []
        rows = self.rows(hypothesis, answer, precision).toarray()
        return [
            Column(name=f"answer to {hypothesis.name}, {number}", kind="signature", values=row, spread=1.0)
            for number, row in enumerate(rows)
            if row.any()
        ]


@dataclass(frozen=True)
class Contest:
    """Explanations of one residual, each under the covariance that belongs to its own answer."""

    space: Whitened
    signature: Signature

    def evaluated(self, evidence: Sequence[Evidence]) -> list[Evidence]:
        """The best of them evaluated again, the others as they were."""
        ordered = sorted(evidence, key=lambda one: -one.log_bayes)
        return [self.again(one) for one in ordered[:CONTENDERS]] + ordered[CONTENDERS:]

    def again(self, one: Evidence) -> Evidence:
        """One explanation, linear about its best fit, with the error of its answer there."""
        if (
            self.signature.error_of(one.hypothesis) == 0.0
            or not one.columns.shape[1]
            or not np.any(one.answer)
        ):
            return one
        space, count = self.space, one.columns.shape[1]
        own = release_of(space, one.hypothesis.own).directions
        base = one.answer - one.columns @ np.array(one.coordinates)
        left = space.freed(one.hypothesis.own) - base
        inner = _Inner.of(self, one, own, np.column_stack([one.columns, left]))
        gram, load = inner.products[:count, :count], inner.products[:count, count]
        square = float(inner.products[count, count])
        log_bayes = mixed(gram, load, one.spreads) + 0.5 * (space.chi_square - square) - 0.5 * inner.logarithm
        inverse = inverse_of(gram)
        best = np.clip(inverse @ load, *_limits(one))
        return replace(
            one,
            log_bayes=log_bayes,
            coordinates=tuple(float(value) for value in best),
            deviations=deviations_of(inverse),
            gain=space.chi_square - square + float(2.0 * best @ load - best @ gram @ best),
            answer=base + one.columns @ best,
        )


@dataclass(frozen=True, kw_only=True)
class _Inner:
    """Products (m, m) of columns under C - U U' + E E', and the logarithm of its determinant over that of C."""

    products: Array
    logarithm: float

    @classmethod
    def of(cls, contest: Contest, one: Evidence, own: Array, columns: Array) -> "_Inner":
        signature, lower = contest.signature, contest.space.covariance.lower
        precision = contest.space.precision
        rows = signature.rows(one.hypothesis, lower @ one.answer, np.diagonal(precision))
        white = np.hstack([own, columns])
        solved = solve_triangular(lower, white, lower=True, trans="T", check_finite=False)
        reached = rows @ solved
        errors = rows @ (rows @ precision).T
        taken = own.shape[1]
        inside = np.block([[own.T @ own, reached[:, :taken].T], [reached[:, :taken], errors]])
        diagonal = np.arange(len(inside))
        inside[diagonal, diagonal] += np.where(diagonal < taken, -1.0, 1.0)
        through = np.vstack([own.T @ columns, reached[:, taken:]])
        factors = lu_factor(inside, overwrite_a=True, check_finite=False)
        products = columns.T @ columns - through.T @ lu_solve(factors, through, check_finite=False)
        logarithm = float(np.log(np.abs(np.diagonal(factors[0]))).sum())
        return cls(products=products, logarithm=logarithm)


def _limits(one: Evidence) -> tuple[Array, Array]:
    """Bounds of the coordinates of an explanation; of a pair as wide as its priors."""
    curve = one.hypothesis.curve
    if curve is not None:
        return np.array([curve.bounds[0]]), np.array([curve.bounds[1]])
    half = np.inf if one.hypothesis.family == "pair" else one.hypothesis.half
    bound = np.full(one.columns.shape[1], half)
    return -bound, bound
