"""Places along the root fillet of a tooth: by arc length, by the angle of the tangent, by diameter.

In the normal section of the gear, where its fillet is that of the virtual spur gear.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.tooth_outline import tooth_outline

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
