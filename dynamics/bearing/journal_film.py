"""Pressure film of a plain cylindrical journal bearing of finite width: Reynolds' equation with cavitation.

With H = 1 + eps cos(theta) counted from the widest gap, zeta = z / (B/2) and P = p psi^2 / (eta omega),

    d/dtheta (H^3 dP/dtheta) + (D/B)^2 d/dzeta (H^3 dP/dzeta) = -6 eps sin(theta) ,   P >= 0

Oil enters at ambient pressure at the widest gap and at both ends; the film breaks where P and its gradient
vanish (Reynolds or Swift-Stieber condition), found as a linear complementarity problem by active sets.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from dynamics.errors import DynamicsInputError, DynamicsNotConverged

Array = NDArray[np.float64]

FILM_END = 1.5 * math.pi
"""Angle behind the widest gap at which the grid ends [rad]: beyond any break-up of the film (257 deg)."""


class FilmNotConvergedError(DynamicsNotConverged):
    """The cavitated region of a bearing film did not converge."""


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
    carries: NDArray[np.bool_] = field(repr=False)
    """(n_theta - 1, n_zeta) nodes within the film that carry pressure."""


def solve_film(
    eccentricity: float,
    width_ratio: float,
    n_theta: int = 240,
    n_zeta: int = 24,
    near: FilmSolution | None = None,
) -> FilmSolution:
    """Solve the film at one eccentricity.

    Parameters
    ----------
    eccentricity : relative eccentricity eps, above 0 and below 1 [-]
    width_ratio : B/D, above 0 [-]
    n_theta, n_zeta : cells round the film and over half the width; second-order accurate
    near : film of a neighbouring eccentricity on as many cells; the search for the break-up starts from its own

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
    theta = _clustered_angles(eccentricity, n_theta)
    zeta = np.sin(np.linspace(0.0, 0.5 * math.pi, n_zeta + 1))
    start = np.broadcast_to((theta[1:-1] < 1.2 * math.pi)[:, None], (n_theta - 1, n_zeta))
    if near is not None and near.carries.shape == start.shape:
        start = near.carries
    pressure = _pressure(theta, zeta, eccentricity, width_ratio, start)
    return _integrals(theta, zeta, pressure, eccentricity, width_ratio)


def _clustered_angles(eccentricity: float, n_theta: int) -> Array:
    """Grid over (0, FILM_END), drawn together at the narrowest gap (Sommerfeld's substitution)."""
    squeeze = math.sqrt((1.0 - eccentricity) / (1.0 + eccentricity))
    squeeze = max(squeeze, 0.12)
    last = math.pi + 2.0 * math.atan(math.tan(0.5 * (FILM_END - math.pi)) / squeeze)
    even = np.linspace(-math.pi, last - math.pi, n_theta + 1)
    inner = math.pi + 2.0 * np.arctan(squeeze * np.tan(0.5 * even[1:-1]))
    angles: Array = np.concatenate([[0.0], inner, [FILM_END]])
    return angles


def _pressure(
    theta: Array, zeta: Array, eccentricity: float, width_ratio: float, start: NDArray[np.bool_]
) -> Array:
    """Nodal pressure P, shape (n_theta + 1, n_zeta + 1), zeta = 0 the plane of symmetry.

    start : (n_theta - 1, n_zeta) nodes that carry pressure in the first step
    """
    n, m = theta.size - 2, zeta.size - 1
    gap_mid = 1.0 + eccentricity * np.cos(0.5 * (theta[1:] + theta[:-1]))
    gap_cubed = (1.0 + eccentricity * np.cos(theta[1:-1])) ** 3
    cell_theta = 0.5 * (theta[2:] - theta[:-2])
    half_steps = np.diff(zeta)
    cell_zeta = np.concatenate([[0.5 * half_steps[0]], 0.5 * (half_steps[1:] + half_steps[:-1])])
    round_link = (gap_mid**3 / np.diff(theta))[:, None] * cell_zeta[None, :]
    axial_link = (gap_cubed * cell_theta)[:, None] / half_steps[None, :] / width_ratio**2
    diagonal = round_link[1:] + round_link[:-1] + axial_link
    diagonal[:, 1:] += axial_link[:, :-1]
    # Couette inflow of each cell, exact difference of the gap over its faces: 6 (H_west - H_east)
    inflow = -6.0 * np.diff(gap_mid)[:, None] * cell_zeta[None, :]

    size = n * m
    axial = np.zeros((n, m))
    axial[:, :-1] = -axial_link[:, :-1]
    bands = np.zeros((m + 1, size))
    bands[0] = diagonal.ravel()
    bands[1] = axial.ravel()
    bands[m, : size - m] = -round_link[1:-1].ravel()
    source = inflow.ravel()
    active = start.ravel()
    for _ in range(100):
        solution = _solve_active(bands, source, active, m)
        residual = _apply(bands, solution, m) - source
        # keep a node while it carries pressure, add a dry one that is fed more than it passes on
        wanted = np.where(active, solution > 0.0, residual < 0.0)
        if np.array_equal(wanted, active):
            break
        active = wanted
    else:
        raise FilmNotConvergedError(
            f"film at eccentricity {eccentricity}, B/D {width_ratio}: cavitated region still moves after "
            "100 steps; refine the grid"
        )
    pressure: Array = np.zeros((theta.size, zeta.size))
    pressure[1:-1, :-1] = solution.reshape(n, m)
    return pressure


def _solve_active(bands: Array, source: Array, active: NDArray[np.bool_], width: int) -> Array:
    """Solve for the nodes that carry pressure, all others held at zero."""
    reduced = bands.copy()
    reduced[0, ~active] = 1.0
    for offset in (1, width):
        both = active[offset:] & active[:-offset]
        reduced[offset, : both.size] *= both
    solution: Array = solveh_banded(reduced, np.where(active, source, 0.0), lower=True, check_finite=False)
    return solution


def _apply(bands: Array, vector: Array, width: int) -> Array:
    """Product of the symmetric banded matrix with a vector."""
    product: Array = bands[0] * vector
    for offset in (1, width):
        link = bands[offset, :-offset]
        product[offset:] += link * vector[:-offset]
        product[:-offset] += link * vector[offset:]
    return product


def _integrals(
    theta: Array, zeta: Array, pressure: Array, eccentricity: float, width_ratio: float
) -> FilmSolution:
    mean = np.trapezoid(pressure, zeta, axis=1)
    along = -0.5 * float(np.trapezoid(mean * np.cos(theta), theta))
    across = 0.5 * float(np.trapezoid(mean * np.sin(theta), theta))
    sommerfeld = math.hypot(along, across)
    gap = 1.0 + eccentricity * np.cos(theta)
    near, far = 1.0 - zeta[-2], 1.0 - zeta[-3]
    gradient = (pressure[:, -2] * far / near - pressure[:, -3] * near / far) / (far - near)
    side_flow = float(np.trapezoid(gap**3 * gradient, theta)) / (48.0 * width_ratio)
    # wall shear on the journal: Couette part over the full ring, pressure part (H/2) dP/dtheta over the film
    couette = math.pi / math.sqrt(1.0 - eccentricity**2)
    middle_gap = 1.0 + eccentricity * np.cos(0.5 * (theta[1:] + theta[:-1]))
    poiseuille = 0.25 * float(np.sum(middle_gap * np.diff(mean)))
    return FilmSolution(
        eccentricity=eccentricity,
        width_ratio=width_ratio,
        sommerfeld=sommerfeld,
        attitude_angle=math.atan2(across, along),
        side_flow=side_flow,
        shear_torque=couette + poiseuille,
        carries=pressure[1:-1, :-1] > 0.0,
    )
