"""Root stress at a strain gauge over the rolling angle of its gear, from the stress of the whole fillet.

Stress across the tooth trace in the free surface, in plane stress there (no stress normal to the surface), mean over
the grid of the gauge. Numbers of the fillet hold this stress alone: the strain that goes with it follows from the
stress state that the measuring point states, as in `SurfaceStress`. A tooth lies between its states: on the pinion of
P1's rig E eps is 0.93 to 0.96 of the stress (uniaxial: 1, plane strain: 0.91).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.root_course import RootCourse
from rigdesign.strain_gauge.measuring_point import MeasuringPoint
from rigdesign.strain_gauge.placement import grid_weights

Array = NDArray[np.float64]
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
