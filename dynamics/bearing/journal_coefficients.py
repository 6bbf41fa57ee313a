"""Stiffness and damping of a journal film over eccentricity, for one width ratio and feed.

The film is perturbed at the eccentricities at which the characteristic is solved, when a width ratio is first met, and
kept. Between them the coefficients over So / eps, freed of their growth towards contact, are interpolated: smooth from
the centred journal, where K = (omega / 2) C J with J = [[0, 1], [-1, 0]] because moving with half the speed of rotation
round the centre is the same to the film as standing off it, to the thinnest film.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from dynamics.bearing.journal_characteristic import (
    NODES,
    WIDTH_RATIO_STEP,
    Characteristic,
    characteristic,
    solved_films,
    width_steps,
)
from dynamics.bearing.journal_feed import Feed
from dynamics.bearing.journal_perturbation import FilmCoefficients, film_coefficients
from dynamics.kernels.journal import node_of

Array = NDArray[np.float64]

CENTRED = 1e-6
"""Eccentricity at which the film of the centred journal is perturbed; closer in, rounding shows."""
CLOSE_IN: Array = np.array([CENTRED, 0.005, 0.015, 0.03])
"""Where the film is perturbed besides the nodes of the characteristic: the break-up of a narrow film moves quickly."""
GROWTH: Array = np.array([1.0, -0.5, 0.5, 0.0, 0.5, 0.0, 0.0, -0.5])
"""Powers of 1 / (1 - eps) with which the entries of stiffness and damping grow over So towards contact, those of the
short bearing."""


@dataclass(frozen=True, eq=False)
class CoefficientTable:
    """Coefficients of a bearing of one width ratio and feed; make it with `coefficient_table`."""

    characteristic: Characteristic
    _scaled: CubicSpline

    def at(self, eccentricity: float) -> FilmCoefficients:
        """Dimensionless stiffness and damping at eps in [0, HIGHEST_ECCENTRICITY], axes r and t."""
        eps = max(eccentricity, CENTRED)
        scale = self.characteristic.sommerfeld(eps) / eps * (1.0 - eps) ** -GROWTH
        values = scale * self._scaled(node_of(eps))
        return FilmCoefficients(values[:4].reshape(2, 2), values[4:].reshape(2, 2))


def coefficient_table(width_ratio: float, feed: Feed = "widest_gap") -> CoefficientTable:
    """Table of a width ratio B/D and a feed, solved once and kept.

    Raises
    ------
    DynamicsInputError : B/D outside 0.1 to 2, where a plain bearing of this kind is not built
    """
    return _solved(width_steps(width_ratio), feed)


@lru_cache(maxsize=64)
def _solved(steps: int, feed: Feed) -> CoefficientTable:
    width_ratio = steps * WIDTH_RATIO_STEP
    rows, nodes = [], np.sort(np.concatenate([CLOSE_IN, NODES]))
    for film in solved_films(width_ratio, feed, nodes):
        found = film_coefficients(film)
        values = np.concatenate([found.stiffness.ravel(), found.damping.ravel()])
        rows.append(values * film.eccentricity / film.sommerfeld * (1.0 - film.eccentricity) ** GROWTH)
    return CoefficientTable(characteristic(width_ratio, feed), CubicSpline(nodes, np.array(rows)))
