"""How cylinders about an axis along x move and expand: bores, journals, seals, gear rims.

Facets of a coarse mesh may lie off the cylinder they stand for. The displacement read there is carried to the
cylinder with the free strain, so uniform heating gives the same expansion on every mesh.
"""

from dataclasses import dataclass

import numpy as np

from thermal.fe.elements import SurfaceElements
from thermal.fe.mesh import FloatArray, IndexArray
from thermal.fe.reference_elements import TRIANGLE_6
from thermal.housing.stations import Point


@dataclass(frozen=True)
class CylinderMotion:
    """Displacement of a cylinder in the first harmonics of its circumference.

    The radial displacement is fitted by u_r = a0 + a1 cos(p) + b1 sin(p) + a2 cos(2p) + b2 sin(2p),
    area-weighted, with the angle p from +y towards +z: to first order it alone makes the new shape. The terms
    a0, a1, b1 may vary linearly along the axis, and u_x along and across it; values are those at the centre.
    """

    shift: tuple[float, float, float]
    """Of the centre [m]: u_x, and the first harmonic of u_r in y and z."""
    radius_expansion: float
    """Expansion of the mean radius, a0 [m]."""
    ovality: float
    """Largest minus smallest diameter of the second harmonic [m]."""
    tilt: tuple[float, float]
    """Slope of the axis in y and z along x [rad]."""
    turn: float
    """Mean rotation about the axis [rad]."""


@dataclass(frozen=True, eq=False)
class Cylinder:
    """A whole cylinder about an x-line, its fit found once and read for any displacement.

    cos, sin : (n_q,) of the angle of the quadrature points; off : (n_q,) their distance inside the cylinder [m]
    radial : (8, n_q) makes the harmonics of the radial displacement, axial : (4, n_q) those of the axial one
    turn : (n_q,) makes the mean rotation
    """

    surface: SurfaceElements
    cos: FloatArray
    sin: FloatArray
    off: FloatArray
    radial: FloatArray
    axial: FloatArray
    turn: FloatArray

    @classmethod
    def of(cls, surface: SurfaceElements, points: FloatArray, centre: Point) -> "Cylinder":
        """Prepare the fit about the x-line through ``centre``; points : (n_nodes, 3) [m] undeformed coordinates."""
        area = surface.weights.ravel()
        along, *rest = (surface.at_points(points) - np.array(centre)).reshape(-1, 3).T
        across = np.column_stack(rest)
        radius = np.hypot(across[:, 0], across[:, 1])
        cos, sin = (across / radius[:, None]).T
        one = np.ones_like(cos)
        basis = np.column_stack([one, cos, sin, cos * cos - sin * sin, 2.0 * sin * cos])
        basis = np.hstack([basis, along[:, None] * basis[:, :3]])
        return cls(
            surface=surface,
            cos=cos,
            sin=sin,
            off=_radius(surface, points, centre) - radius,
            radial=_fit(basis, area),
            axial=_fit(np.column_stack([one, along, cos, sin]), area),
            turn=area / radius / area.sum(),
        )

    def motion(self, displacement: FloatArray, strain: FloatArray) -> CylinderMotion:
        """Motion from the displacement of the nodes (n_nodes, 3) [m] and their free thermal strain (n_nodes,)."""
        moved = self.surface.at_points(displacement).reshape(-1, 3)
        outwards = moved[:, 1] * self.cos + moved[:, 2] * self.sin
        outwards += self.surface.at_points(strain).ravel() * self.off
        a0, a1, b1, a2, b2, _, tilt_y, tilt_z = (self.radial @ outwards).tolist()
        tangential = moved[:, 2] * self.cos - moved[:, 1] * self.sin
        return CylinderMotion(
            shift=(float(self.axial[0] @ moved[:, 0]), a1, b1),
            radius_expansion=a0,
            ovality=4.0 * float(np.hypot(a2, b2)),
            tilt=(tilt_y, tilt_z),
            turn=float(self.turn @ tangential),
        )


def _fit(basis: FloatArray, area: FloatArray) -> FloatArray:
    """(k, n) that makes the coefficients of a ``basis`` (n, k) from values (n,), least squares weighted by area."""
    root = np.sqrt(area)
    return np.asarray(np.linalg.pinv(basis * root[:, None]) * root)


def axial_range(surface: SurfaceElements, points: FloatArray) -> tuple[float, float]:
    """Least and greatest x of a surface [m]; points : (n_nodes, 3)."""
    x = points[surface.nodes, 0]
    return float(x.min()), float(x.max())


@dataclass(frozen=True, eq=False)
class CylinderSection:
    """Points round a cylinder in one cross-section, found once in its mesh and read for any displacement.

    nodes : (n, 6) of the facet that covers each point of the unrolled cylinder; shapes : (n, 6) functions there
    off : (n,) distance of the facet inside the cylinder [m]; cos, sin : (n,) of the angles, +y to +z
    """

    nodes: IndexArray
    shapes: FloatArray
    off: FloatArray
    cos: FloatArray
    sin: FloatArray

    @classmethod
    def of(
        cls, surface: SurfaceElements, points: FloatArray, centre: Point, angles: FloatArray, x: float
    ) -> "CylinderSection":
        """Find the points at ``angles`` (n,) [rad] in section ``x`` [m] of a cylinder about an axis along x."""
        corners = points[surface.facets[:, :3]] - np.array(centre)
        phi = np.arctan2(corners[:, :, 2], corners[:, :, 1])
        start = phi[:, :1]
        phi = start + np.remainder(phi - start + np.pi, 2.0 * np.pi) - np.pi
        middle = phi.mean(axis=1)
        turned = middle + np.remainder(angles[:, None] - middle + np.pi, 2.0 * np.pi) - np.pi
        radius = _radius(surface, points, centre)
        edge_1 = np.column_stack([radius * (phi[:, 1] - phi[:, 0]), corners[:, 1, 0] - corners[:, 0, 0]])
        edge_2 = np.column_stack([radius * (phi[:, 2] - phi[:, 0]), corners[:, 2, 0] - corners[:, 0, 0]])
        det = edge_1[:, 0] * edge_2[:, 1] - edge_1[:, 1] * edge_2[:, 0]
        to_1 = radius * (turned - phi[:, 0])
        to_2 = x - centre[0] - corners[:, 0, 0]
        xi = (to_1 * edge_2[:, 1] - to_2 * edge_2[:, 0]) / det
        eta = (to_2 * edge_1[:, 0] - to_1 * edge_1[:, 1]) / det
        best = np.argmax(np.minimum(np.minimum(xi, eta), 1.0 - xi - eta), axis=1)
        rows = np.arange(len(angles))
        shapes = TRIANGLE_6.values(np.column_stack([xi[rows, best], eta[rows, best]]))
        nodes = surface.facets[best]
        place = np.einsum("na,nai->ni", shapes, points[nodes] - np.array(centre))
        off = radius - np.hypot(place[:, 1], place[:, 2])
        return cls(nodes, shapes, off, np.cos(angles), np.sin(angles))

    def radial(self, displacement: FloatArray, strain: FloatArray) -> FloatArray:
        """Radial displacement (n,) [m] from that of the nodes (n_nodes, 3) [m] and their free strain (n_nodes,)."""
        moved = np.einsum("na,nai->ni", self.shapes, displacement[self.nodes])
        widened = np.einsum("na,na->n", self.shapes, strain[self.nodes]) * self.off
        return np.asarray(moved[:, 1] * self.cos + moved[:, 2] * self.sin + widened)


def _radius(surface: SurfaceElements, points: FloatArray, centre: Point) -> float:
    """Radius [m] of the cylinder: mean distance of its corner nodes from the axis."""
    corners = points[surface.facets[:, :3]] - np.array(centre)
    return float(np.hypot(corners[:, :, 1], corners[:, :, 2]).mean())
