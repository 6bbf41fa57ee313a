"""Points of a root fillet in the transverse section as places along it in the normal section, where gauges sit."""

from math import tan

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.root_arc import root_arc

Array = NDArray[np.float64]


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
