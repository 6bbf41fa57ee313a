"""Places along the root fillet of a tooth: by arc length, by the angle of the tangent, by diameter.

In the normal section of the gear, where its fillet is that of the virtual spur gear.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import cos, hypot, pi, tan

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.standards.iso6336_3_2006 import ToothRoot, root_section

Array = NDArray[np.float64]


TANGENT_30 = pi / 6.0
"""Angle between fillet and tooth axis where ISO 6336-3 has the critical section [rad]."""
POINTS = 1200
"""Points of the fillet."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RootArc:
    """The fillet from root circle to involute.

    arc : (n,) distance along it from the 30 deg tangent, positive towards the tip [m]
    tangent : (n,) angle between it and the tooth axis, falling [rad]
    radius : (n,) from the axis of the gear [m]
    """

    arc: Array
    tangent: Array
    radius: Array

    def at_tangent(self, angle: float) -> float:
        """Arc at which the tangent stands at ``angle`` to the tooth axis [m]; NaN outside of the fillet."""
        return _inside(-angle, -self.tangent, self.arc)

    def at_radius(self, radius: float) -> float:
        """Arc at a distance from the axis of the gear [m]; NaN outside of the fillet."""
        return _inside(radius, self.radius, self.arc)


def root_arc(gear: CylindricalGear) -> RootArc:
    """Fillet of a gear.

    An undercut tooth has it up to its crossing with the involute; where that lies below the 30 deg tangent, arcs count
    from the crossing.
    """
    outline = tooth_outline(gear, n_fillet=POINTS)
    x, y = outline.x[: outline.n_fillet], outline.y[: outline.n_fillet]
    length = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    tangent = np.minimum.accumulate(np.abs(np.arctan2(np.gradient(x, length), np.gradient(y, length))))
    middle = float(np.interp(-TANGENT_30, -tangent, length))
    # heights over the reference circle are those of the gear itself
    virtual = outline.tip_radius - gear.tip_radius
    return RootArc(arc=length - middle, tangent=tangent, radius=np.hypot(x, y) - virtual)


def _inside(place: float, places: Array, values: Array) -> float:
    return float(np.interp(place, places, values, left=np.nan, right=np.nan))


# Points of a root fillet in the transverse section as places along it in the normal section, where gauges sit.


def normal_arc(gear: CylindricalGear, point: Array, arc: Array) -> Array:
    """Distance from the 30 deg tangent, measured in the surface of the fillet across the tooth trace [m].

    Helix lines through points dt apart in the transverse section lie dt sqrt(1 - (sin beta_y cos psi)^2) apart in the
    surface, beta_y the helix angle at their radius and psi the angle between fillet and circumference. The 30 deg
    tangent is that of the normal section, see `RootArc`; both sections have a helix line at one radius.

    Parameters
    ----------
    gear : whose tooth it is
    point : (n, 2) places from the gear centre, from the ground of the tooth space up the fillet [m]
    arc : (n,) lengths along them in the transverse section, growing [m]

    Returns
    -------
    (n,) places, growing, positive towards the tip [m]
    """
    radius = np.hypot(*point.T)
    slope = np.gradient(point, arc, axis=0)
    around = (slope[:, 0] * point[:, 1] - slope[:, 1] * point[:, 0]) / (radius * np.hypot(*slope.T))
    lead_angle = np.arctan(tan(gear.helix_angle) * radius / gear.reference_radius)
    shrink = np.sqrt(1.0 - (np.sin(lead_angle) * around) ** 2)
    steps = 0.5 * (shrink[1:] + shrink[:-1]) * np.diff(arc)
    across = np.concatenate([[0.0], np.cumsum(steps)])
    normal = root_arc(gear)
    middle = float(np.interp(0.0, normal.arc, normal.radius))
    return np.asarray(across - np.interp(middle, radius, across))


# Half outline of one tooth with its trochoidal fillet, in the virtual spur gear of the normal section.


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothOutline:
    """Right half of a tooth; y is the tooth axis from the gear centre. Lengths [m], angles [rad].

    x, y : (n,) points from the root circle over the fillet and the involute to the tip, y growing
    n_fillet : points that belong to the fillet
    base_radius, root_radius, tip_radius : of the virtual spur gear; ``root_radius`` is generated
    root_chord, root_height : thickness of the tooth between its 30 degree tangents and their height y
    """

    x: Array
    y: Array
    n_fillet: int
    base_radius: float
    root_radius: float
    tip_radius: float
    root_chord: float
    root_height: float


@lru_cache(maxsize=64)
def tooth_outline(gear: CylindricalGear, n_fillet: int = 160, n_flank: int = 240) -> ToothOutline:
    """Outline of a tooth of ``gear`` with ``n_fillet`` and ``n_flank`` points (ISO 21771 rack generation).

    A spur gear is its own virtual gear. An undercut tooth keeps the fillet up to its crossing with the flank.
    """
    module = gear.normal_module
    reference = 0.5 * module * gear.virtual_teeth
    base = reference * cos(gear.pressure_angle)
    tip = reference + gear.tip_radius - gear.reference_radius
    form = hypot(base, gear.roll_length(gear.form_radius) / cos(gear.base_helix_angle))
    fillet = np.array(
        [gear.trochoid_point(angle) for angle in np.linspace(0.5 * pi, gear.pressure_angle, n_fillet)]
    )
    keep = np.hypot(fillet[:, 0], fillet[:, 1]) < form
    keep &= np.concatenate(([True], np.diff(fillet[:, 1]) > 0.0))
    fillet = fillet[keep]
    radii = np.linspace(form, tip, n_flank)
    half = np.array([gear.virtual_half_angle(radius) for radius in radii])
    section = root_section(_root(gear))
    return ToothOutline(
        x=np.concatenate((fillet[:, 0], radii * np.sin(half))),
        y=np.concatenate((fillet[:, 1], radii * np.cos(half))),
        n_fillet=len(fillet),
        base_radius=base,
        root_radius=float(np.hypot(fillet[0, 0], fillet[0, 1])),
        tip_radius=tip,
        root_chord=section.s_Fn * module,
        root_height=section.y_F * module,
    )


def _root(gear: CylindricalGear) -> ToothRoot:
    return ToothRoot(
        z=gear.teeth,
        m_n=gear.normal_module * 1e3,
        alpha_n=float(np.degrees(gear.pressure_angle)),
        beta=float(np.degrees(gear.helix_angle)),
        x=gear.generating_profile_shift,
        h_fP=gear.rack.dedendum,
        rho_fP=gear.rack.tip_radius,
        d_a=gear.tip_diameter * 1e3,
    )
