"""Load, attitude and side flow of a journal bearing over eccentricity, for one width ratio.

The film is solved at some twenty eccentricities when a width ratio is first met, and kept. Between them the
quotient by the short-bearing solution (F. W. Ocvirk, NACA TN 2808, 1952) is interpolated: it is smooth where
the load itself grows by five orders of magnitude.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from dynamics.bearing.journal_feed import Feed
from dynamics.bearing.journal_film import FilmSolution, solve_film
from dynamics.errors import DynamicsInputError
from dynamics.kernels.journal import (
    HIGHEST_ECCENTRICITY,
    load,
    load_excess,
    node_of,
    short_bearing_load,
)

Array = NDArray[np.float64]

NODES: Array = 0.001 - (math.log(1.0 - HIGHEST_ECCENTRICITY) + 0.001) * np.linspace(0.0, 1.0, 22) ** 1.5
"""Where the film is solved, as -ln(1 - eps), closer together near the concentric journal."""
WIDTH_RATIO_STEP = 1e-3
"""B/D is rounded to this step, so that the expansion of a journal does not cost a new table."""


def short_bearing_attitude(eccentricity: float) -> float:
    """Attitude angle of an infinitely short bearing [rad]: tan beta = pi sqrt(1 - eps^2) / (4 eps)."""
    return math.atan2(math.pi * math.sqrt(1.0 - eccentricity**2), 4.0 * eccentricity)


def short_bearing_side_flow(eccentricity: float, width_ratio: float) -> float:
    """Side flow of an infinitely short bearing, Q / (D^3 psi omega) = (B/D) eps / 4 [-]."""
    return 0.25 * width_ratio * eccentricity


@dataclass(frozen=True)
class Characteristic:
    """Dimensionless behaviour of a bearing of one width ratio; make it with `characteristic`."""

    width_ratio: float
    _load: CubicSpline
    _attitude: CubicSpline
    _flow: CubicSpline

    def sommerfeld(self, eccentricity: float) -> float:
        """Sommerfeld number So = F psi^2 / (B D eta omega) at eps in [0, HIGHEST_ECCENTRICITY]."""
        return float(load(eccentricity, self.width_ratio, self._load.x, self._load.c))

    def attitude_angle(self, eccentricity: float) -> float:
        """Angle from the load to the line of centres [rad]."""
        return short_bearing_attitude(eccentricity) + float(self._attitude(node_of(eccentricity)))

    def side_flow(self, eccentricity: float) -> float:
        """Oil leaving the ends by its own pressure, Q / (D^3 psi omega) [-]."""
        short = short_bearing_side_flow(eccentricity, self.width_ratio)
        return short * float(self._flow(node_of(eccentricity)))

    def eccentricity(self, sommerfeld: float) -> float:
        """Relative eccentricity that carries a Sommerfeld number, at most HIGHEST_ECCENTRICITY."""
        if sommerfeld <= 0.0:
            return 0.0
        if sommerfeld >= self.sommerfeld(HIGHEST_ECCENTRICITY):
            return HIGHEST_ECCENTRICITY
        known = (math.log(sommerfeld), self.width_ratio, self._load.x, self._load.c)
        root: float = brentq(load_excess, 1e-12, HIGHEST_ECCENTRICITY, args=known, xtol=1e-12)
        return root


def characteristic(width_ratio: float, feed: Feed = "widest_gap") -> Characteristic:
    """Characteristic of a width ratio B/D and a feed, solved once and kept.

    Raises
    ------
    DynamicsInputError : B/D outside 0.1 to 2, where a plain bearing of this kind is not built
    """
    return _solved(width_steps(width_ratio), feed)


def width_steps(width_ratio: float) -> int:
    """B/D in whole steps of `WIDTH_RATIO_STEP`; raises as `characteristic`."""
    if not 0.1 <= width_ratio <= 2.0:
        raise DynamicsInputError(
            f"width ratio B/D = {width_ratio:.4g}: must lie within 0.1 to 2; change width or diameter"
        )
    return round(width_ratio / WIDTH_RATIO_STEP)


def solved_films(width_ratio: float, feed: Feed, nodes: Array) -> list[FilmSolution]:
    """Film at every node -ln(1 - eps), rising."""
    films: list[FilmSolution] = []
    for node in nodes:
        near = films[-1] if films else None
        films.append(solve_film(-math.expm1(-node), width_ratio, near=near, feed=feed))
    return films


@lru_cache(maxsize=64)
def _solved(steps: int, feed: Feed) -> Characteristic:
    width_ratio = steps * WIDTH_RATIO_STEP
    films = solved_films(width_ratio, feed, NODES)
    quotient = [math.log(f.sommerfeld / short_bearing_load(f.eccentricity, width_ratio)) for f in films]
    attitude = [f.attitude_angle - short_bearing_attitude(f.eccentricity) for f in films]
    flow = [f.side_flow / short_bearing_side_flow(f.eccentricity, width_ratio) for f in films]
    return Characteristic(
        width_ratio, CubicSpline(NODES, quotient), CubicSpline(NODES, attitude), CubicSpline(NODES, flow)
    )
