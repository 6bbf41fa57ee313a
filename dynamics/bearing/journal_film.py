"""Pressure film of a plain cylindrical journal bearing of finite width: Reynolds' equation with cavitation.

With H = 1 + eps cos(theta) counted from the widest gap, zeta = z / (B/2) and P = p psi^2 / (eta omega),

    d/dtheta (H^3 dP/dtheta) + (D/B)^2 d/dzeta (H^3 dP/dzeta) = -6 eps sin(theta) ,   P >= 0

Oil enters at ambient pressure at the widest gap, or from two axial grooves, and at both ends; the film breaks where P
and its gradient vanish (Reynolds or Swift-Stieber condition), found as a linear complementarity problem by active sets.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from dynamics.bearing.journal_feed import Feed, film_arcs
from dynamics.bearing.journal_grid import FilmGrid, apply, film_grid, solve_active
from dynamics.errors import DynamicsInputError, DynamicsNotConverged

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


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
