"""Alignment of a hot gearbox: shaft axes, bores out of round, tilts, and what two neighbouring shafts make of it.

Coordinates: x along the shafts, y across, z up. Angles are small; an axis is a shift in y and z over x.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thermal.fe.elements import FiniteElements
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


# What an engineer reads from the displacement of a gearbox, and the closed forms to compare it with. SI units.


@dataclass(frozen=True, kw_only=True)
class BearingExpansion:
    """Bore and journal of one bearing."""

    name: str
    bore_shift: tuple[float, float, float]
    """Displacement of the bore centre [m]."""
    bore_expansion: float
    """Of the mean bore diameter [m]."""
    bore_ovality: float
    """Largest minus smallest hot bore diameter of the ellipse [m], mean over the length."""
    bore_roundness: Roundness
    """Out of round in the first, middle and last section."""
    bore_tilt: tuple[float, float]
    """Slope of the bore's axis in y and z [rad]."""
    misalignment: tuple[float, float]
    """Tilt of the shaft axis in the bore in y and z [rad]."""
    journal_expansion: float
    """Of the mean journal diameter [m]."""

    @property
    def clearance_change(self) -> float:
        """Change of the diametral clearance [m]: bore minus journal."""
        return self.bore_expansion - self.journal_expansion

    @property
    def tilt(self) -> float:
        """Angle between the axes of shaft and bore [rad]."""
        return float(np.hypot(*self.misalignment))


@dataclass(frozen=True, kw_only=True)
class SealExpansion:
    """Radial gap of one seal around the circumference, shaft axis through the hot bearing centres."""

    name: str
    undeformed_gap: float
    """[m]"""
    angles: FloatArray
    """(n,) [rad] from +y towards +z."""
    gaps: FloatArray
    """(3, n) hot gap [m] at the first, middle and last section of the seal."""
    axial_shift: float
    """Of the shaft in the seal [m], positive along +x."""
    gap_by_hand: float
    """Concentric closed form with the mean temperatures of the two surfaces [m]."""

    @property
    def gap(self) -> FloatArray:
        """(n,) hot gap [m], mean over the length (Simpson's rule)."""
        return np.asarray((self.gaps[0] + 4.0 * self.gaps[1] + self.gaps[2]) / 6.0)

    @property
    def mean(self) -> float:
        """Mean hot gap [m]."""
        return float(self.gap.mean())

    @property
    def minimum(self) -> float:
        """Smallest hot gap anywhere [m]; below zero the seal runs on."""
        return float(self.gaps.min())

    @property
    def angle_of_minimum(self) -> float:
        """Where the smallest gap is [rad]."""
        return float(self.angles[np.unravel_index(np.argmin(self.gaps), self.gaps.shape)[1]])


@dataclass(frozen=True, kw_only=True)
class ShaftExpansion:
    """Lengthening of one shaft relative to its locating bearing [m]."""

    name: str
    start: float
    """Of the part towards the end face at low x; positive when longer."""
    end: float
    """Of the part towards the end face at high x."""
    datum: float
    """Travel of the journal in the locating bearing along x."""
    start_by_hand: float
    """alpha L (Tm - T0) with the length-mean temperature."""
    end_by_hand: float
    between_bearings: float
    """Of the shaft between its locating and its farthest bearing; 0 with one bearing."""
    housing_between_bearings: float
    """Of the housing between the same two bores."""

    @property
    def axial_play_change(self) -> float:
        """Shaft minus housing between the same bearings [m]; positive uses up play."""
        return self.between_bearings - self.housing_between_bearings


@dataclass(frozen=True, kw_only=True)
class GearExpansion:
    """One gear body."""

    name: str
    bulk_temperature: float
    """Volume mean [K]."""
    rim_expansion: float
    """Of the mean rim radius [m]."""


@dataclass(frozen=True, kw_only=True)
class CentreDistance:
    """Axes of two gears in their common mid-plane, from the lines through the bearing bore centres."""

    gear_a: str
    gear_b: str
    undeformed: float
    """[m]"""
    hot: float
    inclination: float
    """Angle between the hot axes in their common plane [rad], positive when they open towards +x."""
    skew: float
    """Angle between the hot axes across their common plane [rad]."""

    @property
    def change(self) -> float:
        """[m]"""
        return self.hot - self.undeformed


def free_expansion(expansion: float, length: float, mean_temperature: float, reference: float) -> float:
    """Free lengthening [m]: dL = alpha L (Tm - T0), Tm the length mean [K]."""
    return expansion * length * (mean_temperature - reference)


def concentric_gap_change(
    radius: float,
    housing: tuple[float, float],
    shaft: tuple[float, float],
    reference: float,
) -> float:
    """Change of a concentric radial gap [m]: R [alpha_h (T_h - T0) - alpha_s (T_s - T0)].

    housing, shaft : expansion coefficient [1/K] and temperature [K]; reference : T0 [K].
    """
    outer, inner = housing[0] * (housing[1] - reference), shaft[0] * (shaft[1] - reference)
    return radius * (outer - inner)


def length_mean(
    elements: FiniteElements, temperature: FloatArray, body: str, start: float, end: float, slices: int = 40
) -> float:
    """Mean over x from ``start`` to ``end`` [m] of the section mean of a body's temperature [K].

    The mean that free axial expansion needs: a thick section counts no more than a thin one.
    """
    cells = elements.mesh.bodies[body]
    x, volume = elements.at_points(elements.mesh.points[:, 0], cells)
    values, _ = elements.at_points(temperature, cells)
    edges = np.linspace(min(start, end), max(start, end), slices + 1)
    slice_of = np.searchsorted(edges, x) - 1
    inside = (slice_of >= 0) & (slice_of < slices)
    weight = np.bincount(slice_of[inside], volume[inside], minlength=slices)
    heat = np.bincount(slice_of[inside], (values * volume)[inside], minlength=slices)
    filled = weight > 0.0
    if not filled.any():
        return float(values @ volume / volume.sum())
    return float(np.mean(heat[filled] / weight[filled]))
