"""Where a residual sits: groups of numbers held against the residual of a healthy rig in them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.stats import chi2

from rigdesign.diagnosis.run import Result
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.measurement.comparison.bands import Bands
from rigdesign.measurement.comparison.locate import Located, locate


def located(result: Result, residual: Array) -> tuple[Located, ...]:
    """Groups of the numbers that were kept, the most conspicuous first.

    residual : (n_kept,). A group is evaluated by its own block of the covariance of a healthy rig, so that numbers
    that go up and down together count once: ``rms`` is 1 in the mean of healthy rigs, ``excess`` the probability that
    the residual of a healthy rig is as large.
    """
    found = result.diagnosis
    features = [result.problem.residuals.features[row] for row in found.kept]
    bands = Bands(result.measurement)
    matrix = found.covariance.matrix
    items = locate(
        features, residual, np.sqrt(np.diagonal(matrix)), [bands.of(feature) for feature in features],
        result.data.settings, result.case.ambient.temperature,
    )  # fmt: skip
    evaluated = [_weighed(item, residual, matrix) for item in items]
    return tuple(sorted(evaluated, key=lambda item: -item.rms))


def _weighed(item: Located, residual: Array, matrix: Array) -> Located:
    square = _square(residual, matrix, item.features)
    return replace(
        item,
        rms=float(np.sqrt(square / len(item.features))),
        excess=float(chi2.sf(square, len(item.features))),
    )


def _square(residual: Array, matrix: Array, rows: Sequence[int]) -> float:
    places = np.array(rows, dtype=np.intp)
    block = cho_factor(matrix[np.ix_(places, places)], lower=True)
    return float(residual[places] @ cho_solve(block, residual[places]))
