"""Single readings that fit nothing around them: rejected one at a time and listed, never silently."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import inverse_of_factor

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
    found = _standing_out(matrix, residual, limit, most)
    count = Counter(series[one.place] for one in found)
    return tuple(one for one in found if count[series[one.place]] == 1)


def _standing_out(matrix: Array, residual: Array, limit: float, most: float) -> tuple[Outlier, ...]:
    kept = np.arange(len(residual))
    precision = inverse_of_factor(np.asarray(np.linalg.cholesky(matrix), dtype=np.float64))
    found: list[Outlier] = []
    while True:
        deviations = precision @ residual[kept] / np.sqrt(np.diagonal(precision))
        worst = int(np.argmax(np.abs(deviations)))
        if abs(deviations[worst]) <= limit:
            return tuple(found)
        if len(found) + 1 > max(1.0, most * len(residual)):
            return ()
        found.append(Outlier(int(kept[worst]), float(deviations[worst])))
        kept = np.delete(kept, worst)
        precision = _without(precision, worst)


def _without(precision: Array, place: int) -> Array:
    """Precision of the other readings once one of them is gone: one elimination step, no new inverse."""
    rest = np.delete(np.arange(len(precision)), place)
    row = precision[place, rest]
    return np.asarray(precision[np.ix_(rest, rest)] - np.outer(row, row) / precision[place, place])
