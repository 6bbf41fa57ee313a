"""Misalignment of two nominally parallel axes as a gap along the line of action."""

from dataclasses import dataclass
from math import cos, sin

from dynamics.gear.pair_geometry import PairGeometry


@dataclass(frozen=True, kw_only=True)
class AxisMisalignment:
    """Angles between the axes of a pair [rad], over z of the common face width.

    inclination : in the common plane of the axes (in-plane deviation f_Sigma_delta per bearing span): positive where
        the axes part with growing z
    skew : out of that plane (f_Sigma_beta per bearing span): positive where the front flanks part with growing z

    A shift of the wheel by (radial, tangential) moves its flank along the line of action n = (sin alpha_wt,
    +-cos alpha_wt), front and back. Definitions and weights as in ISO/TR 10064-3 and ISO 1328-1 have them from memory
    of the documents; the weights follow from n.
    """

    inclination: float = 0.0
    skew: float = 0.0

    @classmethod
    def of_gap(cls, pair: PairGeometry, front: float, back: float) -> "AxisMisalignment":
        """Misalignment with these gaps per face width on the front and back flanks [rad]."""
        angle = pair.working_pressure_angle
        return cls(inclination=0.5 * (front + back) / sin(angle), skew=0.5 * (front - back) / cos(angle))

    def gap_slope(self, pair: PairGeometry) -> tuple[float, float]:
        """Gap along the line of action per face width [rad], front and back flanks."""
        angle = pair.working_pressure_angle
        in_plane, out_of_plane = self.inclination * sin(angle), self.skew * cos(angle)
        return in_plane + out_of_plane, in_plane - out_of_plane


PARALLEL = AxisMisalignment()
