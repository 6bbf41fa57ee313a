"""Stiffness and damping of a bearing film: Reynolds' equation linearised about a static position.

A displacement u and a velocity v of the journal (in units of the clearance c and of c omega) change the gap by
-u . n, n = (cos theta, sin theta), and with it the pressure by P_1,

    div (H^3 grad P_1) = -6 d(u . n)/dtheta - 12 v . n + div (3 H^2 (u . n) grad P_0)

on the film that carries pressure, P_1 = 0 on all its edges: feed, bearing end and, because P_0 leaves it with no
gradient, the break-up (J. W. Lund, K. K. Thomsen 1978). The places of feed stand still in the bearing. The operator is
symmetric, so the damping is; motion round the centre is to the film another speed: C (0, eps) = 2 F, F its static
force.

The break-up lies between nodes. Ahead of it the static solution is the parabola P'' s^2 / 2 of the distance s from it,
which the difference equation also solves: a last node with pressure P, the grid step d before the first dry one, has
s = d/2 + P / (P'' d). With the link from that node to P_1 = 0 set to this distance the coefficients converge at second
order; with the edge on the dry node they jitter at first order.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.bearing.journal_film import FilmArc, FilmSolution
from dynamics.bearing.journal_grid import FilmGrid, Mask, solve_active

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FilmCoefficients:
    """Dimensionless stiffness and damping of a film, force on the journal = -stiffness u - damping v.

    Axes r (from the centre of the bearing to that of the journal) and t (r turned a right angle in the direction of
    rotation); u in clearances c, v in c omega, forces in B D eta omega / psi^2 as the Sommerfeld number.

    stiffness, damping : (2, 2) [-]
    """

    stiffness: Array
    damping: Array

    def turned(self, attitude: float) -> "FilmCoefficients":
        """The same in axes along the load and across it, the line of centres at ``attitude`` [rad] from the load."""
        cosine, sine = math.cos(attitude), math.sin(attitude)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        return FilmCoefficients(turn @ self.stiffness @ turn.T, turn @ self.damping @ turn.T)


def film_coefficients(film: FilmSolution) -> FilmCoefficients:
    """Stiffness and damping of a solved film."""
    return _sum([arc_coefficients(arc) for arc in film.arcs])


def arc_coefficients(arc: FilmArc) -> FilmCoefficients:
    """Part of one arc of film; in axes along the widest gap and across it, which are -r and -t."""
    grid, active = arc.grid, arc.carries
    theta, middles = grid.theta[1:-1], grid.middles
    normals, middle_normals = _normals(theta), _normals(middles)
    bands = grid.bands()
    bands[0] += np.where(active, _edges(arc), 0.0).ravel()
    displaced = [_displaced(arc, normals[i], middle_normals[i]) for i in range(2)]
    moved = [12.0 * normals[i][:, None] * grid.areas for i in range(2)]
    sources = np.stack([source.ravel() for source in (*displaced, *moved)], axis=1)
    changes = solve_active(bands, sources, active.ravel())
    changes[~active.ravel()] = 0.0
    weights = np.stack([(normal[:, None] * grid.areas).ravel() for normal in normals])
    found = 0.5 * weights @ changes
    return FilmCoefficients(found[:, :2], found[:, 2:])


def _sum(parts: Sequence[FilmCoefficients]) -> FilmCoefficients:
    return FilmCoefficients(
        np.sum([part.stiffness for part in parts], axis=0), np.sum([part.damping for part in parts], axis=0)
    )


def _normals(angles: Array) -> tuple[Array, Array]:
    return np.cos(angles), np.sin(angles)


def _displaced(arc: FilmArc, normal: Array, middle_normal: Array) -> Array:
    """(n - 1, m) sources of a unit displacement: the wedge of the changed gap and the changed flow of P_0."""
    grid, pressure = arc.grid, arc.pressure
    source = grid.wedge(-middle_normal)
    round_change = -3.0 * middle_normal / grid.middle_gap
    round_flow = round_change[:, None] * grid.round_links * np.diff(pressure[:, :-1], axis=0)
    source += round_flow[1:] - round_flow[:-1]
    axial_change = -3.0 * normal / grid.gap
    axial_flow = axial_change[:, None] * grid.axial_links * np.diff(pressure[1:-1], axis=1)
    source += axial_flow
    source[:, 1:] -= axial_flow[:, :-1]
    return source


def _edges(arc: FilmArc) -> Array:
    """(n - 1, m) what moving the edge of the film to its place adds to the diagonal of the nodes before it."""
    grid, active = arc.grid, arc.carries
    here = arc.pressure[1:-1, :-1]
    steps = grid.angular_steps[:, None]
    extra = np.zeros(grid.shape)
    dry = np.zeros(grid.shape, dtype=bool)
    dry[:-1] = ~active[1:]
    extra += _stretch(here, arc.pressure[:-2, :-1], steps[1:], steps[:-1], dry) * grid.round_links[1:]
    dry = np.zeros(grid.shape, dtype=bool)
    dry[1:] = ~active[:-1]
    extra += _stretch(here, arc.pressure[2:, :-1], steps[:-1], steps[1:], dry) * grid.round_links[:-1]
    return extra + _axial_edges(grid, arc.pressure[1:-1], active)


def _axial_edges(grid: FilmGrid, pressure: Array, active: Mask) -> Array:
    """The same for edges across the width, seen from the plane of symmetry and from the bearing end."""
    steps, extra = grid.axial_steps[None, :], np.zeros(grid.shape)
    inner = active[:, 1:-1]
    outwards = _stretch(pressure[:, 1:-2], pressure[:, :-3], steps[:, 1:-1], steps[:, :-2], ~active[:, 2:])
    extra[:, 1:-1] += np.where(inner, outwards, 0.0) * grid.axial_links[:, 1:-1]
    inwards = _stretch(pressure[:, 1:-1], pressure[:, 2:], steps[:, :-1], steps[:, 1:], ~active[:, :-1])
    extra[:, 1:] += np.where(active[:, 1:], inwards, 0.0) * grid.axial_links[:, :-1]
    return extra


def _stretch(here: Array, behind: Array, ahead_step: Array, behind_step: Array, dry: Mask) -> Array:
    """d / s - 1 where the next node ahead is dry, else 0.

    here, behind : static pressure of the node and of the one on its other side
    """
    curvature = 2.0 * ((behind - here) / behind_step - here / ahead_step) / (ahead_step + behind_step)
    bent = dry & (curvature > 0.0) & (here > 0.0)
    share = 0.5 + np.where(bent, here, 0.0) / np.where(bent, curvature * ahead_step**2, 1.0)
    stretch: Array = np.where(bent, 1.0 / np.clip(share, 0.5, 1.5) - 1.0, 0.0)
    return stretch
