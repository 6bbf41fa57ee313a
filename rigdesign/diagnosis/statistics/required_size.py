"""How large a cause would have to be to explain a residual by itself, whatever its bounds say."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from rigdesign.diagnosis.statistics.columns import Array

MOST = 1e3
"""Size over its bound beyond which a cause does not answer at all to what is to be explained."""
ALIKE = 0.01
"""Share of the square within which two sizes meet the data alike; the smaller one counts."""


@dataclass(frozen=True, kw_only=True)
class RequiredSize:
    """A cause at the size at which it meets the data best.

    coordinates : (k,); share : of the square of the residual that it takes away [-]; reach : its size over its bound
    extrapolated : beyond the runs of the model, continued in proportion
    """

    coordinates: tuple[float, ...]
    share: float
    reach: float
    extrapolated: bool = False


class ResidualMetric:
    """Residual (n,) in the metric of what is no cause: noise, and the systematic errors of sensors and settings.

    covariance : (n, n)
    """

    def __init__(self, residual: Array, covariance: Array) -> None:
        self._factor = cho_factor(covariance, lower=True)
        self._residual = residual
        self._white = cho_solve(self._factor, residual)
        self.square = float(residual @ self._white)
        """Weighted square of the residual; n where nothing is to be explained."""

    def of_columns(self, columns: Array, bound: float) -> RequiredSize | None:
        """Of a cause that answers in proportion, columns (n, k); None where it does not answer."""
        normal = columns.T @ cho_solve(self._factor, columns)
        largest = float(np.max(np.diagonal(normal), initial=0.0))
        if not largest * (MOST * bound) ** 2 > 1.0:
            return None
        right = columns.T @ self._white
        sizes = np.asarray(np.linalg.lstsq(normal, right, rcond=1e-9)[0], dtype=np.float64)
        return self._sized(sizes, float(right @ sizes), bound, extrapolated=False)

    def of_runs(self, coordinates: Array, answers: Array, bound: float) -> RequiredSize | None:
        """Of a cause with runs at coordinates (m,), zero among them, answers (m, n); straight between and beyond.

        The smallest size of those that meet the data best is taken.
        """
        order = np.argsort(coordinates)
        places, runs = coordinates[order], answers[order]
        found_all: list[RequiredSize] = []
        for k in range(len(places) - 1):
            low, high = places[k], places[k + 1]
            slope = (runs[k + 1] - runs[k]) / (high - low)
            metric = float(slope @ cho_solve(self._factor, slope))
            if not metric * (MOST * bound) ** 2 > 1.0:
                continue
            left = self._residual - runs[k]
            size = float(low + slope @ cho_solve(self._factor, left) / metric)
            size = max(size, low) if k > 0 else size
            size = min(size, high) if k < len(places) - 2 else size
            rest = left - slope * (size - low)
            taken = self.square - float(rest @ cho_solve(self._factor, rest))
            beyond = not places[0] <= size <= places[-1]
            found = self._sized(np.array([size]), taken, bound, extrapolated=beyond)
            found_all.append(found)
        most = max((one.share for one in found_all), default=0.0)
        best = [one for one in found_all if one.share > most - ALIKE]
        return min(best, key=lambda one: one.reach, default=None)

    def _sized(self, sizes: Array, taken: float, bound: float, *, extrapolated: bool) -> RequiredSize:
        return RequiredSize(
            coordinates=tuple(float(size) for size in sizes),
            share=taken / self.square if self.square else 0.0,
            reach=float(np.linalg.norm(sizes)) / bound,
            extrapolated=extrapolated,
        )


def straight(coordinates: Array, answers: Array, size: float) -> Array:
    """(n,) answer of runs at coordinates (m,), answers (m, n), at a size: straight between them and beyond."""
    order = np.argsort(coordinates)
    places, runs = coordinates[order], answers[order]
    at = int(np.clip(np.searchsorted(places, size) - 1, 0, len(places) - 2))
    share = (size - places[at]) / (places[at + 1] - places[at])
    return np.asarray((1.0 - share) * runs[at] + share * runs[at + 1])
