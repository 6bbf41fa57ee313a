"""What an engineer reads from the displacement of a gearbox, and the closed forms to compare it with. SI units."""

from dataclasses import dataclass

import numpy as np

from thermal.expansion.alignment import Roundness
from thermal.fe.elements import FiniteElements
from thermal.fe.mesh import FloatArray


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
    at = np.searchsorted(edges, x) - 1
    inside = (at >= 0) & (at < slices)
    weight = np.bincount(at[inside], volume[inside], minlength=slices)
    heat = np.bincount(at[inside], (values * volume)[inside], minlength=slices)
    filled = weight > 0.0
    if not filled.any():
        return float(values @ volume / volume.sum())
    return float(np.mean(heat[filled] / weight[filled]))
