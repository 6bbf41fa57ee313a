"""Finite volumes on an arc of a journal bearing film: nodes, conductances and the banded system of Reynolds' equation.

Angles theta count from the widest gap in the direction of rotation, zeta = z / (B/2) from the plane of symmetry. The
pressure is 0 at both ends of the arc and at the end of the bearing; unknown are the nodes between.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

CLOSEST = 0.12
"""Least ratio of the angular step at the narrowest gap to that at the widest."""


@dataclass(frozen=True, eq=False)
class FilmGrid:
    """Nodes of an arc and what links them.

    theta : (n + 1,) from the widest gap [rad], first and last the ends of the arc
    zeta : (m + 1,) from 0 to 1 [-]
    eccentricity, width_ratio : eps and B/D [-]
    """

    theta: Array
    zeta: Array
    eccentricity: float
    width_ratio: float

    @property
    def shape(self) -> tuple[int, int]:
        """(n - 1, m) unknown pressures."""
        return self.theta.size - 2, self.zeta.size - 1

    @cached_property
    def angular_steps(self) -> Array:
        """(n,) between nodes [rad]."""
        return np.diff(self.theta)

    @cached_property
    def axial_steps(self) -> Array:
        """(m,) between nodes [-]."""
        return np.diff(self.zeta)

    @cached_property
    def middles(self) -> Array:
        """(n,) angles half-way between nodes, where the cells meet [rad]."""
        return 0.5 * (self.theta[1:] + self.theta[:-1])

    @cached_property
    def gap(self) -> Array:
        """(n - 1,) H at the unknown nodes."""
        return 1.0 + self.eccentricity * np.cos(self.theta[1:-1])

    @cached_property
    def middle_gap(self) -> Array:
        """(n,) H where the cells meet."""
        return 1.0 + self.eccentricity * np.cos(self.middles)

    @cached_property
    def cell_angles(self) -> Array:
        """(n - 1,) angle that a cell covers [rad]."""
        return 0.5 * (self.theta[2:] - self.theta[:-2])

    @cached_property
    def cell_widths(self) -> Array:
        """(m,) share of zeta that a cell covers; the first reaches from the plane of symmetry."""
        steps = self.axial_steps
        return np.concatenate([[0.5 * steps[0]], 0.5 * (steps[1:] + steps[:-1])])

    @cached_property
    def areas(self) -> Array:
        """(n - 1, m) of the cells."""
        return self.cell_angles[:, None] * self.cell_widths[None, :]

    @cached_property
    def round_links(self) -> Array:
        """(n, m) conductances round the film."""
        links: Array = (self.middle_gap**3 / self.angular_steps)[:, None] * self.cell_widths[None, :]
        return links

    @cached_property
    def axial_links(self) -> Array:
        """(n - 1, m) conductances along the width, each from its node towards the end of the bearing."""
        along = (self.gap**3 * self.cell_angles)[:, None]
        links: Array = along / self.axial_steps[None, :] / self.width_ratio**2
        return links

    def bands(self) -> Array:
        """(m + 1, unknowns) lower bands of the symmetric system, as `scipy.linalg.solveh_banded` takes them."""
        n, m = self.shape
        diagonal = self.round_links[1:] + self.round_links[:-1] + self.axial_links
        diagonal[:, 1:] += self.axial_links[:, :-1]
        axial = np.zeros((n, m))
        axial[:, :-1] = -self.axial_links[:, :-1]
        bands = np.zeros((m + 1, n * m))
        bands[0] = diagonal.ravel()
        bands[1] = axial.ravel()
        bands[m, : n * m - m] = -self.round_links[1:-1].ravel()
        return bands

    def wedge(self, middle_gap: Array) -> Array:
        """(n - 1, m) Couette inflow of every cell 6 (H_west - H_east) for a gap (n,) where the cells meet."""
        inflow: Array = -6.0 * np.diff(middle_gap)[:, None] * self.cell_widths[None, :]
        return inflow


def film_grid(
    eccentricity: float, width_ratio: float, arc: tuple[float, float], n_theta: int, n_zeta: int
) -> FilmGrid:
    """Grid over an arc (start, end) [rad] with nodes drawn together at the narrowest gap and at the bearing end."""
    theta = clustered_angles(eccentricity, arc, n_theta)
    zeta = np.sin(np.linspace(0.0, 0.5 * math.pi, n_zeta + 1))
    return FilmGrid(theta, zeta, eccentricity, width_ratio)


def clustered_angles(eccentricity: float, arc: tuple[float, float], n_theta: int) -> Array:
    """(n_theta + 1,) angles over an arc, evenly spaced in Sommerfeld's substitution."""
    squeeze = max(math.sqrt((1.0 - eccentricity) / (1.0 + eccentricity)), CLOSEST)
    first, last = (_stretched(angle, 1.0 / squeeze) for angle in arc)
    angles = np.array([_stretched(angle, squeeze) for angle in np.linspace(first, last, n_theta + 1)])
    angles[0], angles[-1] = arc
    return angles


def _stretched(angle: float, factor: float) -> float:
    """tan((angle - pi) / 2) times the factor, as an angle on the same turn [rad]."""
    turn = 2.0 * math.pi * round((angle - math.pi) / (2.0 * math.pi))
    half = 0.5 * (angle - math.pi - turn)
    return turn + math.pi + 2.0 * math.atan2(factor * math.sin(half), math.cos(half))


def solve_active(bands: Array, source: Array, active: Mask) -> Array:
    """Solve a banded system for the active unknowns, all others held at zero.

    source : (unknowns,) or (unknowns, columns)
    active : (unknowns,)
    """
    reduced, width = bands.copy(), bands.shape[0] - 1
    reduced[0, ~active] = 1.0
    for offset in (1, width):
        both = active[offset:] & active[:-offset]
        reduced[offset, : both.size] *= both
    held = np.where(active if source.ndim == 1 else active[:, None], source, 0.0)
    solution: Array = solveh_banded(reduced, held, lower=True, check_finite=False)
    return solution


def apply(bands: Array, vector: Array) -> Array:
    """Product of the symmetric banded matrix with a vector."""
    product: Array = bands[0] * vector
    width = bands.shape[0] - 1
    for offset in (1, width):
        link = bands[offset, :-offset]
        product[offset:] += link * vector[:-offset]
        product[:-offset] += link * vector[offset:]
    return product
