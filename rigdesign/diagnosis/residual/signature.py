"""What a model may answer wrongly to a right cause, admitted to every explanation alike.

A cause in the model never leaves exactly the trace it leaves on the rig. An explanation with the answer a is
therefore evaluated under C + E E': every series of numbers (one channel, one order) may be off by a share of its own
answer, the same over all points and along the speed, and orders by themselves
(`rigdesign.diagnosis.statistics.columns`). Natural frequencies that lie close together may divide a change
between them in another way (`rigdesign.diagnosis.statistics.resonance`). With no cause there is no answer and no
such error, so that a small effect is not hidden by it; rivals that differ by less than the model error are separated
by their priors alone.

C^-1 is known; E is of low rank, so that all products follow from block sums (Woodbury's identity).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lu_factor, lu_solve, solve_triangular
from scipy.sparse import csr_array
from scipy.special import logsumexp

from rigdesign.diagnosis.residual.healthy import TREND
from rigdesign.diagnosis.statistics.columns import Array, Column, ModelError, series_numbers
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.evidence import (
    Evidence,
    best_within,
    deviations_of,
    inverse_of,
    mixed,
    release_of,
)
from rigdesign.diagnosis.statistics.hypothesis import Hypothesis
from rigdesign.diagnosis.statistics.resonance import CloseModes
from rigdesign.prediction.model import Feature

EXACT = ("sensor", "input")
"""Families whose trace is known exactly."""

CONTENDERS = 60
"""Explanations, best first, whose own error is admitted; the others are too far behind."""


SLIGHT = 0.1
"""Error of one number by itself that is left out [standard deviations of its residual on a healthy rig]."""

SHARES = (1.0, 0.3, 0.1)
"""Of the error of every number by itself: how far an answer is off is not known, and numbers that follow it closely are
no sign of an answer that is off by all that is admitted."""

MOST_ALONE = 400
"""Numbers whose model error counts, those with the largest."""


@dataclass(frozen=True, kw_only=True)
class Signature:
    """Series of the numbers of a comparison, and how wrong answers may be.

    order : (n,) places of the numbers sorted by series; starts : (s,) where each begins in it
    trend : (n,) logarithm of the relative speed; errors : kind of effect -> relative error, "" for the others
    own : error of every number by itself, if there is one; modes : natural frequencies among the numbers
    circuit : effects that change what goes through the circuit
    """

    order: NDArray[np.intp]
    starts: NDArray[np.intp]
    trend: Array
    errors: Mapping[str, float]
    own: ModelError | None
    modes: CloseModes
    circuit: frozenset[str]

    @classmethod
    def of(
        cls,
        features: Sequence[Feature],
        trend: Array,
        errors: Mapping[str, float],
        own: ModelError | None = None,
        modes: CloseModes | None = None,
        circuit: frozenset[str] = frozenset(),
    ) -> "Signature":
        """Of the numbers of a comparison."""
        series = series_numbers(features)
        order = np.argsort(series, kind="stable")
        starts = np.searchsorted(series[order], np.arange(series.max(initial=-1) + 1))
        none = CloseModes.of(np.zeros(len(features)), 0.0)
        return cls(
            order=order,
            starts=starts,
            trend=trend,
            errors=errors,
            own=own,
            modes=modes or none,
            circuit=circuit,
        )

    def error_of(self, hypothesis: Hypothesis) -> float:
        """Relative error of the answer of an explanation; the largest of its parts."""
        if hypothesis.family in EXACT:
            return 0.0
        kinds = [part.split(":")[0].split("/")[0] for part in hypothesis.parts]
        return max(self.errors.get(kind, self.errors.get("", 0.0)) for kind in kinds)

    def rows(
        self, hypothesis: Hypothesis, answer: Array, precision: Array
    ) -> tuple[csr_array, NDArray[np.bool_]]:
        """(m, n) rows of E' for an answer (n,): series alike at all points, along the speed, numbers by themselves, and
        pairs of natural frequencies.

        precision : (n,) diagonal of the inverse covariance of a healthy rig

        Beside them (m,) whether a row is of a number by itself.
        """
        alike = self.error_of(hypothesis) * answer
        along = TREND * alike * self.trend
        places, alone = self._alone(hypothesis, answer, precision)
        pairs = np.stack([self.modes.first, self.modes.second], axis=1)
        exchanged = np.stack(self.modes.errors(answer), axis=1)
        values = np.concatenate([alike[self.order], along[self.order], alone, exchanged.ravel()])
        count, by_number = len(answer), 2 * len(answer) + np.arange(len(places) + 1)
        by_pair = by_number[-1] + 2 * np.arange(1, len(pairs) + 1)
        ends = np.concatenate([self.starts, count + self.starts, by_number, by_pair])
        across = np.concatenate([self.order, self.order, places, pairs.ravel()])
        alone_rows = np.repeat([False, True, False], [2 * len(self.starts), len(places), len(pairs)])
        return csr_array((values, across, ends), shape=(len(ends) - 1, count)), alone_rows

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
        rows = self.rows(hypothesis, answer, precision)[0].toarray()
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
        base = one.answer - one.columns @ np.array(one.coordinates)
        products = _Products.of(self, one, base)
        shares = SHARES if products.alone.any() else SHARES[:1]
        found = [self._at(products, one, base, share) for share in shares]
        log_bayes = float(logsumexp([other.log_bayes for other in found])) - float(np.log(len(shares)))
        return replace(max(found, key=lambda other: other.log_bayes), log_bayes=log_bayes)

    def _at(self, products: "_Products", one: Evidence, base: Array, share: float) -> Evidence:
        """One explanation with a share of the error of every number by itself."""
        inner, logarithm = products.inside(share)
        count = one.columns.shape[1]
        gram, load, square = inner[:count, :count], inner[:count, count], float(inner[count, count])
        fall = self.space.chi_square - square
        inverse = inverse_of(gram)
        best = best_within(gram, load, inverse @ load, one.hypothesis.bounds)
        gain = fall + float(2.0 * best @ load - best @ gram @ best)
        return replace(
            one,
            log_bayes=min(mixed(gram, load, one.spreads) + 0.5 * fall, 0.5 * gain) - 0.5 * logarithm,
            coordinates=tuple(float(value) for value in best),
            deviations=deviations_of(inverse),
            gain=gain,
            answer=base + one.columns @ best,
        )


@dataclass(frozen=True, kw_only=True)
class _Products:
    """What products of columns (m, m) under C - U U' + s E s E' are made of, for any share s of the errors by number.

    own, errors, columns : products with themselves: of what is released, of the errors of the answer, of the columns
    reached : of the errors with what is released; through_own, through_errors : of these with the columns
    alone : (k,) whether an error is of a number by itself
    """

    own: Array
    reached: Array
    errors: Array
    through_own: Array
    through_errors: Array
    columns: Array
    alone: NDArray[np.bool_]

    @classmethod
    def of(cls, contest: Contest, one: Evidence, base: Array) -> "_Products":
        space, lower = contest.space, contest.space.covariance.lower
        own = release_of(space, one.hypothesis.own).directions
        columns = np.column_stack([one.columns, space.freed(one.hypothesis.own) - base])
        rows, alone = contest.signature.rows(one.hypothesis, lower @ one.answer, np.diagonal(space.precision))
        solved = solve_triangular(lower, np.hstack([own, columns]), lower=True, trans="T", check_finite=False)
        reached = rows @ solved
        taken = own.shape[1]
        return cls(
            own=own.T @ own,
            reached=reached[:, :taken],
            errors=rows @ (rows @ space.precision).T,
            through_own=own.T @ columns,
            through_errors=reached[:, taken:],
            columns=columns.T @ columns,
            alone=alone,
        )

    def inside(self, share: float) -> tuple[Array, float]:
        """Products of the columns (m, m), and the logarithm of the determinant over that of C."""
        scale = np.where(self.alone, share, 1.0)[:, None]
        across = scale * self.reached
        inside = np.block([[self.own, across.T], [across, scale * self.errors * scale.T]])
        diagonal = np.arange(len(inside))
        inside[diagonal, diagonal] += np.where(diagonal < len(self.own), -1.0, 1.0)
        through = np.vstack([self.through_own, scale * self.through_errors])
        factors = lu_factor(inside, overwrite_a=True, check_finite=False)
        products = self.columns - through.T @ lu_solve(factors, through, check_finite=False)
        return products, float(np.log(np.abs(np.diagonal(factors[0]))).sum())
