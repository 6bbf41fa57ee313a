"""A measuring point: gauge, bridge and surface, from stress to bridge output and back."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.tooth.root_field import RootCourse
from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import refuse, require_above
from rigdesign.strain_gauge.gauge import Bridge, StrainGauge

Array = NDArray[np.float64]


# Where a gauge sits in the tooth root, and the mean of a stress field over its grid.
#
# Coordinates: s along the fillet from the 30 deg tangent, positive towards the tip; z along the face from mid-face [m].
# The grid's length lies along s, its width along z, both turned by the misalignment from s towards z.

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


def _shares(key: str, nodes: Array, places: Array) -> Array:
    """(m, n) share of every node in (m,) places; a spline through two or three nodes is a line or parabola."""
    from scipy.interpolate import CubicSpline

    steps = np.diff(nodes)
    if len(nodes) < 2 or not np.all(steps > 0.0):
        refuse(key, f"{len(nodes)} nodes", "must be at least 2 and increase", "sort them")
    if places.min() < nodes[0] - 0.5 * steps[0] or places.max() > nodes[-1] + 0.5 * steps[-1]:
        refuse(
            key, f"{1e3 * nodes[0]:.4g} to {1e3 * nodes[-1]:.4g} mm",
            f"do not cover the grid from {1e3 * places.min():.4g} to {1e3 * places.max():.4g} mm",
            "compute the stress further out or correct the position of the gauge",
        )  # fmt: skip
    return np.asarray(CubicSpline(nodes, np.eye(len(nodes)))(places))


# Hooke's law at the free surface of the tooth root: strain along the fillet to stress along it, and back.

StressState = Literal["uniaxial", "plane_strain", "biaxial"]


@dataclass(frozen=True, kw_only=True)
class SurfaceStress:
    """Elastic surface with no stress normal to it: sigma = E (1 + nu r) / (1 - nu^2) eps, r = eps_across / eps.

    Parameters
    ----------
    youngs_modulus : [Pa]
    poisson_ratio : [-]
    state : uniaxial: r = -nu, sigma = E eps, as P1 converts ("Hooke's law") and as holds at the ends of the face;
        plane_strain: r = 0, sigma = E eps / (1 - nu^2), a wide tooth at mid-face, 9.9 % more for steel;
        biaxial: r is stated
    transverse_ratio : r of a biaxial state [-]

    Raises
    ------
    CaseError
        A modulus not above zero, a Poisson's ratio outside 0 to 0.5, a transverse ratio missing or out of place.
    """

    youngs_modulus: float
    poisson_ratio: float
    state: StressState = "uniaxial"
    transverse_ratio: float | None = None

    def __post_init__(self) -> None:
        require_above("youngs_modulus", self.youngs_modulus, "Pa", "write that of the gear's steel, 206e9")
        if not 0.0 <= self.poisson_ratio < 0.5:
            refuse(
                "poisson_ratio",
                f"{self.poisson_ratio:.6g}",
                "must lie within 0 to 0.5",
                "write 0.3 for steel",
            )
        if self.state not in ("uniaxial", "plane_strain", "biaxial"):
            refuse(
                "state", str(self.state), "no such stress state", "write uniaxial, plane_strain or biaxial"
            )
        given = "" if self.transverse_ratio is None else f"{self.transverse_ratio:.6g}"
        if (self.state == "biaxial") != (self.transverse_ratio is not None):
            refuse(
                "transverse_ratio",
                given,
                "belongs to a biaxial state and to no other",
                "give both or neither",
            )
        if self.transverse_ratio is not None and not -0.5 <= self.transverse_ratio <= 1.0:
            refuse("transverse_ratio", given, "must lie within -0.5 to 1", "take it from the computed stress")

    @property
    def strain_ratio(self) -> float:
        """r, strain across over strain along the fillet [-]."""
        if self.transverse_ratio is not None:
            return self.transverse_ratio
        return 0.0 if self.state == "plane_strain" else -self.poisson_ratio

    @property
    def modulus(self) -> float:
        """Stress over strain along the fillet [Pa]."""
        if self.state == "uniaxial":
            return self.youngs_modulus
        share = 1.0 + self.poisson_ratio * self.strain_ratio
        return self.youngs_modulus * share / (1.0 - self.poisson_ratio**2)

    def stress(self, strain: float | Array) -> Array:
        """Stress along the fillet [Pa]."""
        return np.asarray(self.modulus * np.asarray(strain, dtype=float))

    def strain(self, stress: float | Array) -> Array:
        """Strain along the fillet [-]."""
        return np.asarray(np.asarray(stress, dtype=float) / self.modulus)


@dataclass(frozen=True)
class StrainRecord:
    """Recorded bridge output of one measuring point.

    time : (n,) increasing [s]; ratio : (n,) U_B / U_E [V/V], NaN where missing; overloaded : samples at the input range
    """

    time: Array
    ratio: Array
    overloaded: int = 0


@dataclass(frozen=True, kw_only=True)
class MeasuringPoint:
    """One strain gauge with its bridge, on the surface of the tooth root.

    Parameters
    ----------
    name : as the rig has it, e.g. "II"
    placement, region : where it sits and what part of the root there is

    Raises
    ------
    CaseError
        The grid reaches over the face or the fillet.
    """

    name: str
    bridge: Bridge
    surface: SurfaceStress
    placement: GaugePlacement
    region: RootRegion

    def __post_init__(self) -> None:
        check_inside(self.name, self.bridge.gauge, self.placement, self.region)

    @property
    def strain_factor(self) -> float:
        """Indicated strain over strain along the fillet [-]: transverse sensitivity and misalignment."""
        return self.bridge.gauge.indicated(self.surface.strain_ratio, self.placement.misalignment)

    def ratio(self, stress: float | Array, temperature: float | Array | None = None) -> Array:
        """Bridge output U_B / U_E [V/V], not balanced, at stresses (n,) along the fillet [Pa]."""
        return self.bridge.ratio(self.strain_factor * self.surface.strain(stress), temperature)

    def stress(
        self,
        ratio: float | Array,
        zero: float | Array | None = None,
        temperature: float | Array | None = None,
    ) -> Array:
        """Stress along the fillet (n,) [Pa] from the bridge output (n,) [V/V]; the exact inverse of `ratio`.

        Parameters
        ----------
        zero : output without load (n,) or one of all [V/V]; None: that of the bridge itself at ``temperature``
        temperature : of gauge and root [K]; None: without thermal output

        Raises
        ------
        MeasurementError
            An output that no strain gives.
        """
        output = np.asarray(ratio, dtype=float)
        if zero is not None:
            output = output - zero + self.bridge.ratio(0.0, temperature)
        return self.surface.stress(self.bridge.strain(output, temperature) / self.strain_factor)


# Root stress at a strain gauge over the rolling angle of its gear, from the stress of the whole fillet.
#
# Stress across the tooth trace in the free surface, in plane stress there (no stress normal to the surface), mean over
# the grid of the gauge. Numbers of the fillet hold this stress alone: the strain that goes with it follows from the
# stress state that the measuring point states, as in `SurfaceStress`. A tooth lies between its states: on the pinion of
# P1's rig E eps is 0.93 to 0.96 of the stress (uniaxial: 1, plane strain: 0.91).

RISEN = 0.05
"""Share of the peak from which a gauge counts as strained by the force on its own tooth."""


@dataclass(frozen=True, kw_only=True, eq=False)
class GaugeCurve:
    """Stress at a gauge over the way of its tooth through the mesh.

    angle : (n,) rolling angle of the gear from the pitch point at mid-face, growing towards the tip of its flank [rad]
    stress : (n,) along the fillet, mean over the grid [Pa]
    """

    angle: Array
    stress: Array

    @property
    def peak(self) -> float:
        """Highest stress [Pa]."""
        return float(self.stress.max())

    @property
    def peak_angle(self) -> float:
        """Rolling angle of the peak [rad]."""
        return float(self.angle[self.stress.argmax()])

    @property
    def rise_angle(self) -> float:
        """Rolling angle from which the stress rises to its peak [rad]: where the tooth itself begins to carry."""
        risen = self.stress > RISEN * self.peak
        highest = int(self.stress.argmax())
        before = np.flatnonzero(~risen[:highest])
        return float(self.angle[before[-1] if len(before) else 0])

    @property
    def lowest(self) -> float:
        """Lowest stress, as a rule compression by the neighbouring tooth [Pa]."""
        return float(self.stress.min())


def gauge_curve(
    course: RootCourse, places: Array, point: MeasuringPoint, angle_per_path: float
) -> GaugeCurve:
    """Stress at a measuring point.

    The width of the grid counts along the axis: the tilt of a helical trace within the grid moves its ends by less than
    a tenth of a millimetre, to either side.

    Parameters
    ----------
    course : stress of the fillet that carries the gauge
    places : (n_r,) of its points along the fillet from the 30 deg tangent of the normal section, growing [m]
    angle_per_path : rolling angle per path position: 1 / r_b of a pinion, -1 / r_b of a wheel [rad/m]

    Raises
    ------
    CaseError
        The points of the fillet do not cover the grid.
    """
    weights = grid_weights(places, course.face, point.bridge.gauge, point.placement)
    stress = np.einsum("sz,psz->p", weights, course.stress)
    angle = angle_per_path * course.path
    order = np.argsort(angle)
    return GaugeCurve(angle=angle[order], stress=stress[order])
