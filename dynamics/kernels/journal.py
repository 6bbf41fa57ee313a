"""Load of a journal bearing over eccentricity, compiled: its inverse is looked for many thousand times."""

from math import exp, log, log1p, pi, sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

HIGHEST_ECCENTRICITY = 0.99
"""Beyond it the film is thinner than any real roughness: the bearing runs in mixed friction."""


@njit(cache=True)
def short_bearing_load(eccentricity: float, width_ratio: float) -> float:
    """Sommerfeld number of an infinitely short bearing (half film).

    So = (B/D)^2 eps / (2 (1 - eps^2)^2) sqrt(pi^2 (1 - eps^2) + 16 eps^2)      Ocvirk, NACA TN 2808
    """
    rest = 1.0 - eccentricity**2
    root = sqrt(pi**2 * rest + 16.0 * eccentricity**2)
    return width_ratio**2 * eccentricity * root / (2.0 * rest**2)


@njit(cache=True)
def node_of(eccentricity: float) -> float:
    """-ln(1 - eps), over which a characteristic is interpolated."""
    return -log1p(-min(eccentricity, HIGHEST_ECCENTRICITY))


@njit(cache=True)
def load(eccentricity: float, width_ratio: float, nodes: Array, quotient: Array) -> float:
    """Sommerfeld number of a bearing.

    nodes, quotient : (n,) of `node_of`, and (4, n - 1) coefficients of the cubics between them of the logarithm of the
        load over that of a short bearing
    """
    node = node_of(eccentricity)
    piece, beyond = 0, len(nodes) - 1
    while beyond - piece > 1:
        middle = (piece + beyond) // 2
        if nodes[middle] < node:
            piece = middle
        else:
            beyond = middle
    x = node - nodes[piece]
    power = ((quotient[0, piece] * x + quotient[1, piece]) * x + quotient[2, piece]) * x + quotient[3, piece]
    return short_bearing_load(eccentricity, width_ratio) * exp(power)


@njit(cache=True)
def load_excess(
    eccentricity: float, target: float, width_ratio: float, nodes: Array, quotient: Array
) -> float:
    """Logarithm of the load less a wanted one."""
    return log(load(eccentricity, width_ratio, nodes, quotient)) - target
