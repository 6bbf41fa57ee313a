"""The covariance of what is not an effect, and the space in which it is the unit matrix.

    C = R + L L'            R: noise and what is not put into columns, L: columns times their standard deviations

Source: design of the workflow, step 3 (covariance by links, constants, laws, sensors and inputs); the algebra is
that of the linear Gaussian model, e.g. Rasmussen, Williams, Gaussian Processes, 2006, ch. 2.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dpotri

from rigdesign.diagnosis.statistics.columns import Array, Column, stacked


@dataclass(frozen=True, kw_only=True)
class Covariance:
    """Noise and columns of one comparison.

    base : (n, n) covariance of the noise; columns : causes with their spreads; amplitudes : by kind
    """

    base: Array
    columns: tuple[Column, ...]
    amplitudes: Mapping[str, float]

    @classmethod
    def of_noise(
        cls, noise: Array, columns: Sequence[Column], amplitudes: Mapping[str, float]
    ) -> "Covariance":
        """With independent noise, (n,) standard deviations.

        Raises ValueError for a standard deviation that is not positive.
        """
        if not noise.min() > 0.0:
            raise ValueError(
                f"noise = {noise.min():g} of a feature, must be above zero; state the uncertainty of its channel"
            )
        return cls(base=np.diag(noise**2), columns=tuple(columns), amplitudes=amplitudes)

    @cached_property
    def deviations(self) -> Array:
        """(n, n_columns) columns times their standard deviations."""
        if not self.columns:
            return np.zeros((len(self.base), 0))
        return stacked(self.columns, self.amplitudes)

    @cached_property
    def matrix(self) -> Array:
        """(n, n)"""
        return np.asarray(self.base + self.deviations @ self.deviations.T)

    @cached_property
    def lower(self) -> Array:
        """(n, n) Cholesky factor."""
        return np.asarray(np.linalg.cholesky(self.matrix))

    @cached_property
    def log_determinant(self) -> float:
        """Of the matrix."""
        return 2.0 * float(np.log(np.diagonal(self.lower)).sum())

    def whiten(self, values: Array) -> Array:
        """(n,) or (n, m) in the space where this covariance is the unit matrix."""
        return np.asarray(solve_triangular(self.lower, values, lower=True, check_finite=False))

    def with_extra(self, columns: Sequence[Column]) -> "Covariance":
        """With further columns."""
        return Covariance(base=self.base, columns=(*self.columns, *columns), amplitudes=self.amplitudes)

    def spread(self, place: int) -> float:
        """Standard deviation of the cause of a column."""
        column = self.columns[place]
        return self.amplitudes.get(column.kind, 1.0) * column.spread

    def own(self, effect: str) -> list[int]:
        """Places of the columns that spread what ``effect`` moves."""
        return [i for i, column in enumerate(self.columns) if effect and column.effect == effect]


def inverse_of_factor(lower: Array) -> Array:
    """(n, n) inverse of a covariance from its Cholesky factor."""
    half, _ = dpotri(lower, lower=1)
    below = np.tril(half, -1)
    return np.asarray(below + below.T + np.diag(np.diagonal(half)))


@dataclass(frozen=True, kw_only=True)
class Whitened:
    """A covariance with a residual in its space; what an effect's own spread hid can be given back.

    residual : (n,) whitened; nonlinear_parts : effect -> (n,) whitened, what its constant adds beyond its column
        where the data put it: taken out of the residual, given back while that effect is tested
    """

    covariance: Covariance
    residual: Array
    nonlinear_parts: Mapping[str, Array] = field(default_factory=dict)

    @classmethod
    def of(
        cls, covariance: Covariance, residual: Array, nonlinear_parts: Mapping[str, Array] | None = None
    ) -> "Whitened":
        """Whiten a residual (n,) with its nonlinear_parts, all in the units of the features."""
        return cls(
            covariance=covariance,
            residual=covariance.whiten(residual),
            nonlinear_parts={
                effect: covariance.whiten(part) for effect, part in (nonlinear_parts or {}).items()
            },
        )

    def rows(self, keep: Sequence[int]) -> "Whitened":
        """Some of the numbers, their covariance as it is; without the causes behind it."""
        matrix = self.covariance.matrix[np.ix_(keep, keep)]
        return Whitened.of(Covariance(base=matrix, columns=(), amplitudes={}), self.raw[np.array(keep)])

    def freed(self, effects: Sequence[str]) -> Array:
        """(n,) the residual while these effects are tested."""
        return np.asarray(
            self.residual
            + sum((self.nonlinear_parts[effect] for effect in effects if effect in self.nonlinear_parts), 0.0)
        )

    @cached_property
    def chi_square(self) -> float:
        """Whitened square of the residual; n in the mean of healthy rigs."""
        return float(self.residual @ self.residual)

    @cached_property
    def raw(self) -> Array:
        """(n,) the residual in the units of the features."""
        return np.asarray(self.covariance.lower @ self.residual)

    @cached_property
    def precision(self) -> Array:
        """(n, n) inverse of the covariance."""
        return inverse_of_factor(self.covariance.lower)

    @cached_property
    def columns(self) -> Array:
        """(n, n_columns) whitened deviations."""
        return self.covariance.whiten(self.covariance.deviations)


@dataclass(frozen=True)
class Release:
    """Whitened metric after columns were taken out of the covariance: M = I + U S U'.

    directions : (n, k); weights : (k, k); log_determinant : of the covariance without them over that with them
    """

    directions: Array
    weights: Array
    log_determinant: float

    @classmethod
    def of(cls, directions: Array) -> "Release":
        """Take the whitened columns (n, k) out: (I - U U')^-1 = I + U (I - U'U)^-1 U'."""
        left = np.eye(directions.shape[1]) - directions.T @ directions
        weights = np.asarray(np.linalg.inv(left)) if len(left) else left
        _, logarithm = np.linalg.slogdet(left) if len(left) else (1.0, 0.0)
        return cls(directions, weights, float(logarithm))

    def product(self, a: Array, b: Array) -> Array:
        """a' M b for (n,) or (n, m)."""
        plain = a.T @ b
        if not self.directions.shape[1]:
            return np.asarray(plain)
        return np.asarray(plain + (a.T @ self.directions) @ self.weights @ (self.directions.T @ b))


# Single readings that fit nothing around them: rejected one at a time and listed, never silently.

LIMIT = 5.5
"""Leave-one-out deviation [standard deviations] above which a reading is left out."""
MOST_REJECTED = 0.05
"""Share of the readings that may be left out; if more stand out, none is."""


@dataclass(frozen=True)
class Outlier:
    """Place of a reading in the table and its leave-one-out deviation [standard deviations]."""

    place: int
    deviation: float


def reject(
    matrix: Array,
    residual: Array,
    series: Sequence[object],
    *,
    limit: float = LIMIT,
    most: float = MOST_REJECTED,
) -> tuple[Outlier, ...]:
    """Readings that the others contradict.

    matrix : (n, n) covariance; residual : (n,). Of the precision matrix P, the deviation of one reading from what
    the others say is (P r)_i / sqrt(P_ii) (leave-one-out prediction of a Gaussian, Rasmussen and Williams, 2006,
    eq. 5.12).

    series : (n,) what each reading is one of; where several of a series stand out they are a trace and no outliers
    most : share of the readings that may go; if more would have to, nothing is an outlier and none is rejected
    """
    outliers = _standing_out(matrix, residual, limit, most)
    count = Counter(series[outlier.place] for outlier in outliers)
    return tuple(outlier for outlier in outliers if count[series[outlier.place]] == 1)


def _standing_out(matrix: Array, residual: Array, limit: float, most: float) -> tuple[Outlier, ...]:
    kept = np.arange(len(residual))
    precision = inverse_of_factor(np.asarray(np.linalg.cholesky(matrix), dtype=np.float64))
    outliers: list[Outlier] = []
    while True:
        deviations = precision @ residual[kept] / np.sqrt(np.diagonal(precision))
        worst = int(np.argmax(np.abs(deviations)))
        if abs(deviations[worst]) <= limit:
            return tuple(outliers)
        if len(outliers) + 1 > max(1.0, most * len(residual)):
            return ()
        outliers.append(Outlier(int(kept[worst]), float(deviations[worst])))
        kept = np.delete(kept, worst)
        precision = _without(precision, worst)


def _without(precision: Array, place: int) -> Array:
    """Precision of the other readings once one of them is gone: one elimination step, no new inverse."""
    rest = np.delete(np.arange(len(precision)), place)
    row = precision[place, rest]
    return np.asarray(precision[np.ix_(rest, rest)] - np.outer(row, row) / precision[place, place])
