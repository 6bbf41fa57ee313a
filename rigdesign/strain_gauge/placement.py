"""Where a gauge sits in the tooth root, and the mean of a stress field over its grid.

Coordinates: s along the fillet from the 30 deg tangent, positive towards the tip; z along the face from mid-face [m].
The grid's length lies along s, its width along z, both turned by the misalignment from s towards z.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.number_faults import refuse, require_above
from rigdesign.strain_gauge.gauge import StrainGauge

Array = NDArray[np.float64]
StressField = Callable[[Array, Array], Array]
"""Stress along the fillet at (m,) positions s and (m,) positions z [m]: (..., m) [Pa], e.g. one row an angle."""
POINTS = 16
"""Gauss points along each side of a grid."""


@dataclass(frozen=True, kw_only=True)
class RootRegion:
    """Part of the tooth root that a stress field covers.

    face_width : b [m]; fillet_start, fillet_end : s towards root and tip [m]
    """

    face_width: float
    fillet_start: float
    fillet_end: float

    def __post_init__(self) -> None:
        require_above("face_width", self.face_width, "m", "write that of the gear")
        require_above(
            "fillet_end",
            self.fillet_end,
            "m",
            "write where the fillet meets the flank",
            limit=self.fillet_start,
        )


@dataclass(frozen=True, kw_only=True)
class GaugePlacement:
    """Centre of the grid and its direction.

    face_position : z [m]; fillet_position : s [m]; misalignment : from the direction of the fillet [rad]
    """

    face_position: float
    fillet_position: float = 0.0
    misalignment: float = 0.0

    def __post_init__(self) -> None:
        if not abs(self.misalignment) <= 0.25 * np.pi:
            refuse(
                "misalignment", f"{np.degrees(self.misalignment):.6g} deg", "must lie within -45 to 45 deg",
                "a grid turned further measures the strain across the fillet",
            )  # fmt: skip


class GridPoints(NamedTuple):
    """Gauss points of a grid: s, z (m,) [m]; weight (m,) with sum 1."""

    s: Array
    z: Array
    weight: Array


def check_inside(name: str, gauge: StrainGauge, placement: GaugePlacement, region: RootRegion) -> None:
    """Raise CaseError, with every fault, unless the whole grid of measuring point ``name`` lies in the region."""
    c, d = abs(np.cos(placement.misalignment)), abs(np.sin(placement.misalignment))
    half_s = 0.5 * (gauge.grid_length * c + gauge.grid_width * d)
    half_z = 0.5 * (gauge.grid_length * d + gauge.grid_width * c)
    z, s = placement.face_position, placement.fillet_position
    faults = []
    edge = 0.5 * region.face_width
    if not abs(z) + half_z <= edge * (1.0 + 1e-9):
        faults.append(Fault(
            f"{name}.face_position", f"{1e3 * z:.6g} mm",
            f"the grid reaches {1e3 * (abs(z) + half_z):.4g} mm from mid-face, the face ends at {1e3 * edge:.4g} mm",
            f"state the position from mid-face, within +-{1e3 * max(edge - half_z, 0.0):.4g} mm",
        ))  # fmt: skip
    slack = 1e-9 * (region.fillet_end - region.fillet_start)
    if not region.fillet_start - slack <= s - half_s <= s + half_s <= region.fillet_end + slack:
        faults.append(Fault(
            f"{name}.fillet_position", f"{1e3 * s:.6g} mm",
            f"the grid reaches from {1e3 * (s - half_s):.4g} to {1e3 * (s + half_s):.4g} mm, the fillet from "
            f"{1e3 * region.fillet_start:.4g} to {1e3 * region.fillet_end:.4g} mm of the 30 deg tangent",
            "correct the position along the fillet or the length of the grid",
        ))  # fmt: skip
    if faults:
        raise CaseError(faults)


def grid_points(gauge: StrainGauge, placement: GaugePlacement) -> GridPoints:
    """Gauss points over the active grid, POINTS a side."""
    node, weight = np.polynomial.legendre.leggauss(POINTS)
    along, across = np.meshgrid(0.5 * gauge.grid_length * node, 0.5 * gauge.grid_width * node, indexing="ij")
    c, d = np.cos(placement.misalignment), np.sin(placement.misalignment)
    return GridPoints(
        (placement.fillet_position + c * along - d * across).ravel(),
        (placement.face_position + d * along + c * across).ravel(),
        (0.25 * np.outer(weight, weight)).ravel(),
    )


def grid_average(field: StressField, gauge: StrainGauge, placement: GaugePlacement) -> Array:
    """Mean stress over the grid (...,) [Pa]; ``field`` gives (..., m) at (m,) points."""
    points = grid_points(gauge, placement)
    return np.asarray(np.asarray(field(points.s, points.z)) @ points.weight)


def grid_weights(s: Array, z: Array, gauge: StrainGauge, placement: GaugePlacement) -> Array:
    """Weights (n_s, n_z), sum 1, that make the mean over the grid from stresses at nodes, cubic splines in between.

    Found once, they serve every rolling angle: ``np.einsum("sz,...sz->...", weights, stress)``.

    Parameters
    ----------
    s, z : (n_s,), (n_z,) nodes, increasing [m]; the grid may reach beyond the outer ones by half an interval

    Raises
    ------
    CaseError
        The nodes do not increase or do not cover the grid.
    """
    points = grid_points(gauge, placement)
    along = _shares("fillet positions", s, points.s)
    across = _shares("face positions", z, points.z)
    return np.asarray(np.einsum("q,qs,qz->sz", points.weight, along, across, optimize=True))


def _shares(what: str, nodes: Array, at: Array) -> Array:
    """(m, n) share of every node in (m,) places; a spline through two or three nodes is a line or parabola."""
    from scipy.interpolate import CubicSpline

    steps = np.diff(nodes)
    if len(nodes) < 2 or not np.all(steps > 0.0):
        refuse(what, f"{len(nodes)} nodes", "must be at least 2 and increase", "sort them")
    if at.min() < nodes[0] - 0.5 * steps[0] or at.max() > nodes[-1] + 0.5 * steps[-1]:
        refuse(
            what, f"{1e3 * nodes[0]:.4g} to {1e3 * nodes[-1]:.4g} mm",
            f"do not cover the grid from {1e3 * at.min():.4g} to {1e3 * at.max():.4g} mm",
            "compute the stress further out or correct the position of the gauge",
        )  # fmt: skip
    return np.asarray(CubicSpline(nodes, np.eye(len(nodes)))(at))
