"""Alignment of a hot gearbox: shaft axes, bores out of round, tilts, and what two neighbouring shafts make of it.

Coordinates: x along the shafts, y across, z up. Angles are small; an axis is a shift in y and z over x.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermal.fe.mesh import FloatArray

Across = tuple[float, float]
"""Components in y and z."""


@dataclass(frozen=True, kw_only=True)
class ShaftAxis:
    """Hot axis of a shaft: the straight line through its bearing bores, relative to its undeformed place.

    The bow of the shaft itself is not part of it: a turning shaft is heated evenly round its axis.
    """

    name: str
    at: float
    """x of the reference point, the middle of the bearings [m]."""
    offset: Across
    """Displacement there [m]."""
    slope: Across
    """Along x [rad]."""

    def shift(self, x: float) -> Across:
        """Displacement of the axis at ``x`` [m]."""
        arm = x - self.at
        return self.offset[0] + arm * self.slope[0], self.offset[1] + arm * self.slope[1]


def shaft_axis(name: str, places: Sequence[float], shifts: Sequence[Across]) -> ShaftAxis:
    """Line of least squares through the bore centres of a shaft.

    places : x of the bearings [m]; shifts : displacement of their centres in y and z [m]
    One bearing gives no slope.
    """
    x, moved = np.array(places), np.array(shifts)
    middle = float(x.mean())
    arms = x - middle
    spread = float(arms @ arms)
    slope = arms @ moved / spread if spread > 0.0 else np.zeros(2)
    mean = moved.mean(axis=0)
    return ShaftAxis(
        name=name,
        at=middle,
        offset=(float(mean[0]), float(mean[1])),
        slope=(float(slope[0]), float(slope[1])),
    )


@dataclass(frozen=True, kw_only=True)
class Roundness:
    """How far a hot bore is out of round; its mean expansion and the shift of its centre are taken out."""

    peak_to_valley: float
    """Largest minus smallest radius about the least-squares circle [m], the worst of the sections."""
    second_harmonic: float
    """Amplitude of the ellipse in the radius [m], the largest of the sections."""
    long_axis: float
    """Direction of the long axis of that ellipse [rad], 0 to pi from +y towards +z."""


def roundness(angles: FloatArray, radial: FloatArray) -> Roundness:
    """Roundness of sections from their radial displacement (n_sections, n) [m] at even ``angles`` (n,) [rad].

    Source: ISO 12181-1:2011, roundness deviation about the least-squares reference circle.
    """
    count = len(angles)
    first = radial @ np.exp(-1j * angles) * (2.0 / count)
    second = radial @ np.exp(-2j * angles) * (2.0 / count)
    circle = radial.mean(axis=1)[:, None] + (first[:, None] * np.exp(1j * angles)).real
    left = radial - circle
    worst = int(np.argmax(np.abs(second)))
    return Roundness(
        peak_to_valley=float((left.max(axis=1) - left.min(axis=1)).max()),
        second_harmonic=float(np.abs(second[worst])),
        long_axis=float(np.remainder(-0.5 * np.angle(second[worst]), np.pi)),
    )


def misalignment(axis: ShaftAxis, bore_tilt: Across) -> Across:
    """Tilt of a shaft in its bore, in y and z [rad]: slope of the axis less that of the bore."""
    return axis.slope[0] - bore_tilt[0], axis.slope[1] - bore_tilt[1]


@dataclass(frozen=True, kw_only=True)
class ShaftPair:
    """Two shaft ends that a coupling joins: the first against the second."""

    offset: Across
    """Radial offset in y and z at the coupling [m]."""
    angle: Across
    """Between the axes in y and z [rad]."""

    @property
    def radial_offset(self) -> float:
        """[m]"""
        return float(np.hypot(*self.offset))

    @property
    def bend(self) -> float:
        """Angle between the axes [rad]."""
        return float(np.hypot(*self.angle))


def shaft_pair(
    first: tuple[Across, Across], second: tuple[Across, Across], as_set: Across = (0.0, 0.0)
) -> ShaftPair:
    """Alignment of two shaft ends.

    first, second : displacement [m] and slope [rad] of each axis at its end, from its undeformed place
    as_set : offset at which the first was set against the second [m]
    """
    shift, slope = np.subtract(first[0], second[0]) + as_set, np.subtract(first[1], second[1])
    return ShaftPair(offset=(float(shift[0]), float(shift[1])), angle=(float(slope[0]), float(slope[1])))


def axis_tolerances(helix_tolerance: float) -> tuple[float, float]:
    """Greatest in-plane and out-of-plane deviation of two axes over the face width [m].

    helix_tolerance : total helix tolerance F_beta of the gear [m]
    Source: ISO/TR 10064-3:1996, recommended over the bearing span L with the face width b:
    f_Sigma_beta = 0.5 (L/b) F_beta across, f_Sigma_delta = 2 f_Sigma_beta in the plane; here times b/L.
    """
    return helix_tolerance, 0.5 * helix_tolerance
