"""What a model may answer wrongly to a right cause, admitted to every explanation alike.

A cause in the model never leaves exactly the trace it leaves on the rig. An explanation with the answer a is therefore
weighed under C + E E': every series of numbers (one channel, one order) may be off by a share of its own answer, the
same over all points and along the speed. With no cause there is no answer and no such error, so that a small effect
is not hidden by it; rivals that differ by less than the model's own error are told apart by their priors alone.

C^-1 is known; E is of low rank, so that all products follow from block sums (Woodbury's identity).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

from rigdesign.diagnosis.columns import Array, Column, series_numbers
from rigdesign.diagnosis.covariance import Whitened
from rigdesign.diagnosis.evidence import Evidence, Hypothesis, deviations_of, inverse_of, mixed, release_of
from rigdesign.diagnosis.healthy import TREND
from rigdesign.prediction.model import Feature

EXACT = ("sensor", "input")
"""Families whose trace is known exactly."""

CONTENDERS = 60
"""Explanations, best first, whose own error is admitted; the others are too far behind."""


@dataclass(frozen=True, kw_only=True)
class Signature:
    """Series of the numbers of a comparison, and how wrong answers may be.

    order : (n,) places of the numbers sorted by series; starts : (s,) where each begins in it
    trend : (n,) logarithm of the relative speed; errors : kind of effect -> relative error, "" for the others
    """

    order: NDArray[np.intp]
    starts: NDArray[np.intp]
    trend: Array
    errors: Mapping[str, float]

    @classmethod
    def of(cls, features: Sequence[Feature], trend: Array, errors: Mapping[str, float]) -> "Signature":
        """Of the numbers of a comparison."""
        series = series_numbers(features)
        order = np.argsort(series, kind="stable")
        starts = np.searchsorted(series[order], np.arange(series.max(initial=-1) + 1))
        return cls(order=order, starts=starts, trend=trend, errors=errors)

    def error_of(self, hypothesis: Hypothesis) -> float:
        """Relative error of the answer of an explanation; the largest of its parts."""
        if hypothesis.family in EXACT:
            return 0.0
        kinds = [part.split(":")[0].split("/")[0] for part in hypothesis.parts]
        return max(self.errors.get(kind, self.errors.get("", 0.0)) for kind in kinds)

    def weights(self, answer: Array, error: float) -> tuple[Array, Array]:
        """(n,) the error of every number, alike at all points and along the speed; sorted by series."""
        alike = error * answer[self.order]
        return alike, TREND * alike * self.trend[self.order]

    def sums(self, weights: Sequence[Array]) -> csr_array:
        """(m s, n) weighted sums over every series, for each of m weights."""
        count = len(self.order)
        starts = [number * count + self.starts for number in range(len(weights))]
        ends = np.concatenate([*starts, [count * len(weights)]])
        places = np.tile(np.arange(count), len(weights))
        return csr_array((np.concatenate(weights), places, ends), shape=(len(ends) - 1, count))

    def columns(self, name: str, answer: Array, error: float) -> list[Column]:
        """The error of an answer (n,) as columns of a covariance."""
        found = []
        ends = [*self.starts[1:], len(self.order)]
        for kind, values in zip(("", " by speed"), self.weights(answer, error), strict=True):
            for number, (start, end) in enumerate(zip(self.starts, ends, strict=True)):
                own = np.zeros(len(answer))
                own[self.order[start:end]] = values[start:end]
                if own.any():
                    label = f"answer to {name}, series {number}{kind}"
                    found.append(Column(name=label, kind="signature", values=own, spread=1.0))
        return found


@dataclass(frozen=True)
class Contest:
    """Explanations of one residual, each under the covariance that its own answer asks for."""

    space: Whitened
    signature: Signature

    def judged(self, evidence: Sequence[Evidence]) -> list[Evidence]:
        """The best of them weighed again, the others as they were."""
        ordered = sorted(evidence, key=lambda one: -one.log_bayes)
        return [self.again(one) for one in ordered[:CONTENDERS]] + ordered[CONTENDERS:]

    def again(self, one: Evidence) -> Evidence:
        """One explanation, linear about its best fit, with the error of its answer there."""
        error = self.signature.error_of(one.hypothesis)
        if error == 0.0 or not one.columns.shape[1] or not np.any(one.answer):
            return one
        space, count = self.space, one.columns.shape[1]
        own = release_of(space, one.hypothesis.own).directions
        base = one.answer - one.columns @ np.array(one.coordinates)
        left = space.freed(one.hypothesis.own) - base
        inner = _Inner.of(self, one, error, own, np.column_stack([one.columns, left]))
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

    @cached_property
    def precision(self) -> Array:
        """(n, n) inverse covariance, sorted by series."""
        order = self.signature.order
        return np.asarray(self.space.precision[np.ix_(order, order)])


@dataclass(frozen=True, kw_only=True)
class _Inner:
    """Products (m, m) of columns under C - U U' + E E', and the logarithm of its determinant over that of C."""

    products: Array
    logarithm: float

    @classmethod
    def of(cls, contest: Contest, one: Evidence, error: float, own: Array, columns: Array) -> "_Inner":
        signature, lower = contest.signature, contest.space.covariance.lower
        weights = signature.weights(lower @ one.answer, error)
        white = np.hstack([own, columns])
        solved = solve_triangular(lower, white, lower=True, trans="T", check_finite=False)[signature.order]
        sums = signature.sums(weights)
        reached = sums @ solved
        errors = sums @ (sums @ contest.precision).T
        taken = own.shape[1]
        inside = np.block([[own.T @ own, reached[:, :taken].T], [reached[:, :taken], errors]])
        signs = np.diag(np.concatenate([-np.ones(taken), np.ones(len(errors))]))
        through = np.vstack([own.T @ columns, reached[:, taken:]])
        products = columns.T @ columns - through.T @ np.linalg.solve(signs + inside, through)
        _, logarithm = np.linalg.slogdet(np.eye(len(inside)) + signs @ inside)
        return cls(products=products, logarithm=float(logarithm))


def _limits(one: Evidence) -> tuple[Array, Array]:
    """Bounds of the coordinates of an explanation; of a pair as wide as its priors."""
    curve = one.hypothesis.curve
    if curve is not None:
        return np.array([curve.bounds[0]]), np.array([curve.bounds[1]])
    half = np.inf if one.hypothesis.family == "pair" else one.hypothesis.half
    bound = np.full(one.columns.shape[1], half)
    return -bound, bound
