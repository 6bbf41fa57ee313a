"""Pressure film of a plain cylindrical journal bearing of finite width: Reynolds' equation with cavitation.

With H = 1 + eps cos(theta) counted from the widest gap, zeta = z / (B/2) and P = p psi^2 / (eta omega),

    d/dtheta (H^3 dP/dtheta) + (D/B)^2 d/dzeta (H^3 dP/dzeta) = -6 eps sin(theta) ,   P >= 0

Oil enters at ambient pressure at the widest gap, or from two axial grooves, and at both ends; the film breaks where P
and its gradient vanish (Reynolds or Swift-Stieber condition), found as a linear complementarity problem by active sets.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.linalg import solveh_banded
from scipy.optimize import brentq

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.kernels.journal import (
    HIGHEST_ECCENTRICITY,
    load,
    load_excess,
    node_of,
    short_bearing_load,
)
from dynamics.rotor.journal_feed import Feed, film_arcs

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


# Finite volumes on an arc of a journal bearing film: nodes, conductances and the banded system of Reynolds' equation.
#
# Angles theta count from the widest gap in the direction of rotation, zeta = z / (B/2) from the plane of symmetry. The
# pressure is 0 at both ends of the arc and at the end of the bearing; unknown are the nodes between.

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
    right = np.where(active if source.ndim == 1 else active[:, None], source, 0.0)
    solution: Array = solveh_banded(reduced, right, lower=True, check_finite=False)
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


class FilmNotConvergedError(DynamicsNotConverged):
    """The cavitated region of a bearing film did not converge."""


@dataclass(frozen=True, eq=False)
class FilmArc:
    """Pressure P on one arc, (n + 1, m + 1) on the nodes of its grid."""

    grid: FilmGrid
    pressure: Array

    @property
    def carries(self) -> Mask:
        """(n - 1, m) unknown nodes that carry pressure."""
        return self.pressure[1:-1, :-1] > 0.0


@dataclass(frozen=True, kw_only=True)
class FilmSolution:
    """Dimensionless pressure film of one position of the journal."""

    eccentricity: float
    width_ratio: float
    """B/D [-]."""
    sommerfeld: float
    """Load number So = F psi^2 / (B D eta omega) [-]."""
    attitude_angle: float
    """Angle from the load to the line of centres [rad]."""
    side_flow: float
    """Oil leaving both ends by its own pressure, Q / (D^3 psi omega) [-]."""
    shear_torque: float
    """Torque on the journal from its wall shear, M (C_D/2) / (2 eta omega B R^3), oil all round the gap [-];
    divided by So it is the friction number f/psi."""
    arcs: tuple[FilmArc, ...] = field(repr=False)
    """Pressure on the arcs of film between the places of feed."""


def solve_film(
    eccentricity: float,
    width_ratio: float,
    n_theta: int = 240,
    n_zeta: int = 24,
    near: FilmSolution | None = None,
    feed: Feed = "widest_gap",
) -> FilmSolution:
    """Solve the film at one eccentricity.

    Parameters
    ----------
    eccentricity : relative eccentricity eps, above 0 and below 1 [-]
    width_ratio : B/D, above 0 [-]
    n_theta, n_zeta : cells round the film and over half the width; second-order accurate
    near : film of a neighbouring eccentricity on as many cells; the search for the break-up starts from its own
    feed : where oil enters; the cells round the film are shared out among its arcs

    Returns
    -------
    FilmSolution

    Raises
    ------
    DynamicsInputError : eccentricity or width ratio out of range
    FilmNotConvergedError : the active set does not converge in 100 steps

    Source: O. Reynolds 1886; H. W. Swift 1932 and W. Stieber 1933 for the break-up of the film.
    """
    if not 0.0 < eccentricity < 1.0:
        raise DynamicsInputError(
            f"eccentricity = {eccentricity}: must lie between 0 and 1; the journal touches at 1"
        )
    if not width_ratio > 0.0:
        raise DynamicsInputError(f"width ratio B/D = {width_ratio}: must be above 0; give a positive width")

    def at(attitude: float) -> FilmSolution:
        ends = film_arcs(feed, attitude)
        grids = [film_grid(eccentricity, width_ratio, arc, n_theta // len(ends), n_zeta) for arc in ends]
        return _integrals([_pressed(grid, _start(grid, near, i)) for i, grid in enumerate(grids)])

    if feed == "widest_gap":
        return at(0.0)
    # grooves stand across the load: the attitude at which the film pushes against it
    attitude = brentq(lambda angle: at(angle).attitude_angle - angle, 0.02, 0.5 * math.pi, xtol=1e-8)
    return at(attitude)


def solve_arc(grid: FilmGrid, squeeze: Array | None = None) -> FilmArc:
    """Film on one arc of any position, started from nothing known.

    squeeze : (n - 1,) dH/dtau, tau = omega t, at the unknown nodes: the walls also approach each other

    Raises as `solve_film`.
    """
    return _pressed(grid, _start(grid, None, 0), squeeze)


def _start(grid: FilmGrid, near: FilmSolution | None, index: int) -> Mask:
    """Nodes that carry pressure in the first step."""
    if near is not None and index < len(near.arcs) and near.arcs[index].carries.shape == grid.shape:
        return near.arcs[index].carries
    converging = np.mod(grid.theta[1:-1], 2.0 * math.pi) < 1.2 * math.pi
    return np.broadcast_to(converging[:, None], grid.shape)


def _pressed(grid: FilmGrid, start: Mask, squeeze: Array | None = None) -> FilmArc:
    bands = grid.bands()
    inflow = grid.wedge(grid.middle_gap)
    if squeeze is not None:
        inflow = inflow - 12.0 * squeeze[:, None] * grid.areas
    source, active = inflow.ravel(), start.ravel()
    for _ in range(100):
        solution = solve_active(bands, source, active)
        residual = apply(bands, solution) - source
        # keep a node while it carries pressure, add a dry one that is fed more than it passes on
        wanted = np.where(active, solution > 0.0, residual < 0.0)
        if np.array_equal(wanted, active):
            break
        active = wanted
    else:
        raise FilmNotConvergedError(
            f"film at eccentricity {grid.eccentricity}, B/D {grid.width_ratio}: cavitated region still moves after "
            "100 steps; refine the grid"
        )
    pressure: Array = np.zeros((grid.theta.size, grid.zeta.size))
    pressure[1:-1, :-1] = solution.reshape(grid.shape)
    return FilmArc(grid, pressure)


def _integrals(arcs: Sequence[FilmArc]) -> FilmSolution:
    eccentricity, width_ratio = arcs[0].grid.eccentricity, arcs[0].grid.width_ratio
    along, across, side_flow, poiseuille = np.sum([_arc_integrals(arc) for arc in arcs], axis=0)
    couette = math.pi / math.sqrt(1.0 - eccentricity**2)
    return FilmSolution(
        eccentricity=eccentricity,
        width_ratio=width_ratio,
        sommerfeld=math.hypot(along, across),
        attitude_angle=math.atan2(across, along),
        side_flow=float(side_flow),
        shear_torque=couette + float(poiseuille),
        arcs=tuple(arcs),
    )


def _arc_integrals(arc: FilmArc) -> tuple[float, float, float, float]:
    """Load along and across the line of centres, side flow and shear by pressure of one arc.

    Wall shear on the journal is a Couette part over the full ring and this pressure part (H/2) dP/dtheta over the film.
    """
    theta, zeta, pressure = arc.grid.theta, arc.grid.zeta, arc.pressure
    mean = np.trapezoid(pressure, zeta, axis=1)
    along = -0.5 * float(np.trapezoid(mean * np.cos(theta), theta))
    across = 0.5 * float(np.trapezoid(mean * np.sin(theta), theta))
    gap = 1.0 + arc.grid.eccentricity * np.cos(theta)
    near, far = 1.0 - zeta[-2], 1.0 - zeta[-3]
    gradient = (pressure[:, -2] * far / near - pressure[:, -3] * near / far) / (far - near)
    side_flow = float(np.trapezoid(gap**3 * gradient, theta)) / (48.0 * arc.grid.width_ratio)
    poiseuille = 0.25 * float(np.sum(arc.grid.middle_gap * np.diff(mean)))
    return along, across, side_flow, poiseuille


# Load, attitude and side flow of a journal bearing over eccentricity, for one width ratio.
#
# The film is solved at some twenty eccentricities when a width ratio is first met, and kept. Between them the
# quotient by the short-bearing solution (F. W. Ocvirk, NACA TN 2808, 1952) is interpolated: it is smooth where
# the load itself grows by five orders of magnitude.

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
