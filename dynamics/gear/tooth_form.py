"""Outline of a tooth in the transverse section: root, trochoidal fillet, involute, tip edge.

The fillet is the envelope of the tip arc of the rack that generates the gear. In the transverse section of a helical
gear the arc of the normal section is an ellipse; the envelope is taken of that.
Source: ISO 21771:2007, 5 and annex A; Litvin, Fuentes, Gear Geometry and Applied Theory, 2nd ed., 6.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan2, cos, degrees, hypot, pi, radians, sin, tan

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from dynamics.gear.cylindrical_gear import CylindricalGear
from dynamics.gear.involute import GearGeometryError

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class TipEdge:
    """What is taken off the edge between flank and tip; lengths along the profile in the transverse section [m].

    rounding : radius of the edge; chamfer : radial height of a chamfer of 45 deg. At most one of them
    """

    rounding: float = 0.0
    chamfer: float = 0.0

    def __post_init__(self) -> None:
        for name in ("rounding", "chamfer"):
            if not getattr(self, name) >= 0.0:
                raise GearGeometryError(
                    f"tip_edge.{name} = {getattr(self, name)} m must not be negative; give 0 for a sharp edge"
                )
        if self.rounding and self.chamfer:
            raise GearGeometryError(
                f"tip_edge.rounding = {self.rounding} m and chamfer = {self.chamfer} m exclude each other; set one to 0"
            )


SHARP = TipEdge()


@dataclass(frozen=True, kw_only=True)
class ToothForm:
    """Right half of a tooth of ``gear`` in the transverse section; y is the tooth axis from the gear centre.

    protuberance : undercut that a protuberance tool leaves after finishing the flank, s_pr in the normal section [m]
    protuberance_angle : of the protuberance flank of that tool, below the normal pressure angle [rad]

    Raises GearGeometryError for a pointed tooth and for a tip edge or protuberance that leaves no flank, tip or fillet.
    """

    gear: CylindricalGear
    tip_edge: TipEdge = SHARP
    protuberance: float = 0.0
    protuberance_angle: float = radians(10.0)

    def __post_init__(self) -> None:
        gear = self.gear
        if not self.protuberance >= 0.0:
            raise GearGeometryError(
                f"protuberance = {self.protuberance} m must not be negative; give 0 for none"
            )
        if self.protuberance:
            self._require_fillet_of_protuberance()
        if self.flank_tip_radius <= self.form_radius:
            raise GearGeometryError(
                f"flank from d_Ff = {2e3 * self.form_radius:.3f} mm to {2e3 * self.flank_tip_radius:.3f} mm: "
                "nothing is left of it; reduce protuberance or tip edge, or raise the tip diameter"
            )
        if gear.tip_thickness <= 0.0:
            raise GearGeometryError(
                f"tooth of {gear.teeth} teeth is pointed: thickness {1e3 * gear.tip_thickness:.3f} mm at the tip; "
                "reduce the tip diameter or the profile shift"
            )
        land = float(self.tip_points()[self.tip_edge_points - 1, 0])
        if not land > 0.0:
            raise GearGeometryError(
                f"tip_edge.rounding = {1e3 * self.tip_edge.rounding:.3f} mm, chamfer = "
                f"{1e3 * self.tip_edge.chamfer:.3f} mm: the edges of both flanks overlap by {-2e3 * land:.3f} mm on a "
                f"tip of {1e3 * gear.tip_thickness:.3f} mm; reduce the tip edge"
            )

    def _require_fillet_of_protuberance(self) -> None:
        """Raise GearGeometryError for a tool that leaves no fillet from the root circle up to the involute."""
        angle, limit = self.protuberance_angle, self.gear.pressure_angle
        if not 0.0 < angle < limit:
            raise GearGeometryError(
                f"protuberance_angle = {degrees(angle):.3f} deg must lie between 0 and the normal pressure angle, "
                f"{degrees(limit):.3f} deg; correct the tool"
            )
        traced = [hypot(*self._traced(float(place))) for place in np.linspace(0.0, self._fillet_end, 121)]
        if not np.all(np.diff(traced) > 0.0):
            raise GearGeometryError(
                f"protuberance = {1e3 * self.protuberance:.3f} mm, module {1e3 * self.gear.normal_module:g} mm: the "
                "fillet that the tool leaves does not rise to the flank; a tenth of the module is usual, reduce it"
            )

    @property
    def root_radius(self) -> float:
        """Of the root circle as generated [m]."""
        gear = self.gear
        return gear.reference_radius - gear.normal_module * (
            gear.rack.dedendum - gear.generating_profile_shift
        )

    @cached_property
    def flank_tip_roll(self) -> float:
        """Roll length where the involute ends at the tip edge [m]."""
        radius, gear = self.gear.tip_radius, self.gear
        if not self.tip_edge.rounding:
            return gear.roll_length(radius - self.tip_edge.chamfer)

        def outside(roll: float) -> float:
            # centre of the rounding from the flank, against that from the tip circle
            centre = self.flank_point(roll) - self.tip_edge.rounding * self.flank_normal(roll)
            return float(np.hypot(*centre)) - (radius - self.tip_edge.rounding)

        if outside(gear.roll_length(self.form_radius)) > 0.0:
            return 0.0
        return float(
            brentq(outside, gear.roll_length(self.form_radius), gear.roll_length(radius), xtol=1e-15)
        )

    @property
    def flank_tip_radius(self) -> float:
        """Where the involute ends at the tip edge, d_Fa/2 [m]."""
        return hypot(self.gear.base_radius, self.flank_tip_roll)

    def half_angle(self, radius: float) -> float:
        """Half the angle that the tooth spans on the involute at ``radius`` [rad]; 0 beyond a sharp point."""
        return self.gear.half_angle(max(radius, self.gear.base_radius))

    @cached_property
    def _tool(self) -> tuple[float, float, float]:
        """Tip arc of the rack in the normal section: radius, depth of its centre, distance from the middle of the tool
        tooth along the pitch line [m]."""
        gear, rack = self.gear, self.gear.rack
        m, alpha = gear.normal_module, gear.pressure_angle
        radius = rack.tip_radius * m
        depth = (rack.dedendum - gear.generating_profile_shift) * m - radius
        half = 0.25 * pi * m - rack.dedendum * m * tan(alpha) - (1.0 - sin(alpha)) * radius / cos(alpha)
        return radius, depth, half + self.protuberance / cos(alpha)

    @property
    def _flank_angle(self) -> float:
        """Angle of the tool's flank that joins its tip arc [rad]."""
        return self.protuberance_angle if self.protuberance else self.gear.pressure_angle

    def fillet_point(self, tool_angle: float, beyond: float = 0.0) -> tuple[float, float]:
        """Point (x, y) [m] that the tip of the tool leaves.

        tool_angle : place on its tip arc [rad]; pi/2 gives the root circle, the angle of the adjoining flank the end
        beyond : distance up that flank from there [m]
        """
        gear = self.gear
        radius, depth, half = self._tool
        stretch = 1.0 / cos(gear.helix_angle)
        along = stretch * (half + radius * cos(tool_angle) + beyond * sin(tool_angle))
        below = depth + radius * sin(tool_angle) - beyond * cos(tool_angle)
        # the point leaves its trace where its normal in the transverse section passes through the pitch point
        roll = along - below * cos(tool_angle) / (stretch * sin(tool_angle))
        angle = (roll - 0.5 * pi * gear.transverse_module) / gear.reference_radius
        x, y = along - roll, gear.reference_radius - below
        return -(x * cos(angle) + y * sin(angle)), y * cos(angle) - x * sin(angle)

    def _traced(self, place: float) -> tuple[float, float]:
        """Fillet point (x, y) [m].

        place : 0 on the root circle, 1 at the end of the tip arc, 2 beyond the protuberance
        """
        start = self._flank_angle
        if place <= 1.0:
            return self.fillet_point(0.5 * pi + place * (start - 0.5 * pi))
        length = self.protuberance / sin(self.gear.pressure_angle - start)
        return self.fillet_point(start, 2.0 * (place - 1.0) * length)

    @cached_property
    def _fillet_end(self) -> float:
        """Place (see `_traced`) where fillet and involute meet."""
        if not self.protuberance and not self.gear.undercut:
            return 1.0
        last = 2.0 if self.protuberance else 1.0
        places = np.linspace(last, 0.0, 1441)
        outside = self._outside(float(places[0]))
        for before, after in zip(places[:-1].tolist(), places[1:].tolist(), strict=True):
            inside = self._outside(after)
            if outside >= 0.0 > inside:
                return float(brentq(self._outside, before, after, xtol=1e-15))
            outside = inside
        return 1.0

    def _outside(self, place: float) -> float:
        """Angle by which the fillet stands outside of the involute at one radius [rad]; 1 below the base circle."""
        x, y = self._traced(place)
        radius = hypot(x, y)
        return atan2(x, y) - self.half_angle(radius) if radius >= self.gear.base_radius else 1.0

    @cached_property
    def form_radius(self) -> float:
        """Half the form diameter d_Ff: where fillet and involute meet [m]."""
        return hypot(*self._traced(self._fillet_end))

    def fillet(self, n: int) -> Array:
        """(n, 2) points of the fillet from the root circle to the involute [m], even along the arc length."""
        fine = np.array([self._traced(float(place)) for place in np.linspace(0.0, self._fillet_end, 40 * n)])
        length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine, axis=0).T))])
        wanted = np.linspace(0.0, length[-1], n)
        return np.column_stack([np.interp(wanted, length, fine[:, k]) for k in (0, 1)])

    def flank_point(self, roll_length: float | Array) -> Array:
        """(..., 2) point of the involute at a roll length from the base tangent point [m]."""
        roll = np.asarray(roll_length, dtype=np.float64)
        base = self.gear.base_radius
        radius = np.hypot(base, roll)
        angle = self.gear.base_half_angle - (roll / base - np.arctan(roll / base))
        return np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)

    def flank_normal(self, roll_length: float | Array) -> Array:
        """(..., 2) unit normal of the involute, out of the tooth, at a roll length [m]."""
        angle = self.gear.base_half_angle - np.asarray(roll_length, dtype=np.float64) / self.gear.base_radius
        return np.stack([np.cos(angle), -np.sin(angle)], axis=-1)

    def axis_depth(self, roll_length: float | Array) -> Array:
        """Distance along the normal from the flank at a roll length to the tooth axis [m]."""
        point, normal = self.flank_point(roll_length), self.flank_normal(roll_length)
        return np.asarray(point[..., 0] / normal[..., 0])

    def axis_point(self, roll_length: float | Array) -> Array:
        """(..., 2) point of the tooth axis on the normal of the flank at a roll length [m]."""
        depth = self.axis_depth(roll_length)
        return np.asarray(self.flank_point(roll_length) - depth[..., None] * self.flank_normal(roll_length))

    # -- tip --------------------------------------------------------------------------------------------------
    @property
    def tip_edge_points(self) -> int:
        """How many of `tip_points` describe the edge between flank and tip; 1 for a sharp edge."""
        return 9 if self.tip_edge.rounding else 2 if self.tip_edge.chamfer else 1

    def tip_points(self) -> Array:
        """(n, 2) points from the end of the flank over its edge to the tooth axis [m]."""
        radius, end = self.gear.tip_radius, self.flank_tip_radius
        start = self.flank_point(self.gear.roll_length(end))
        if self.tip_edge.chamfer:
            angle = float(np.arctan2(*start)) - self.tip_edge.chamfer / radius
            edge = np.array([start, [radius * sin(angle), radius * cos(angle)]])
        elif self.tip_edge.rounding:
            edge = self._rounded(start)
        else:
            edge = start[None, :]
        angle = float(np.arctan2(*edge[-1]))
        land = np.linspace(angle, 0.0, 5)[1:]
        return np.concatenate([edge, radius * np.column_stack([np.sin(land), np.cos(land)])])

    def _rounded(self, start: Array) -> Array:
        """(9, 2) points of the rounding from the flank to the tip circle [m]."""
        rounding = self.tip_edge.rounding
        normal = self.flank_normal(self.flank_tip_roll)
        centre = start - rounding * normal
        first, last = atan2(normal[1], normal[0]), atan2(centre[1], centre[0])
        angles = np.linspace(first, last, 9)
        return np.asarray(centre + rounding * np.column_stack([np.cos(angles), np.sin(angles)]))


# What the drawing of a gear has beyond its involute, its rack and its bore.


@dataclass(frozen=True, kw_only=True)
class FlankEnds:
    """Radii where the involute of a gear begins at its fillet and ends at its tip edge, d_Ff/2 and d_Fa/2 [m]."""

    form_radius: float
    tip_radius: float


@dataclass(frozen=True, kw_only=True)
class GearDetails:
    """Tip edge, protuberance of the tool and body of one gear, cold; lengths [m].

    protuberance, protuberance_angle : see `ToothForm`; the angle in [rad]
    rim_thickness : from the root circle inwards; None: solid down to the bore
    web_thickness : axial, in the middle of the face, inside of the rim; None: as wide as the face
    """

    tip_edge: TipEdge = SHARP
    protuberance: float = 0.0
    protuberance_angle: float = radians(10.0)
    rim_thickness: float | None = None
    web_thickness: float | None = None

    def form_of(self, gear: CylindricalGear, scale: float = 1.0) -> ToothForm:
        """Tooth outline of the gear; scale : of lengths, present over cold.

        Raises GearGeometryError, see `ToothForm`.
        """
        return ToothForm(
            gear=gear,
            tip_edge=TipEdge(rounding=scale * self.tip_edge.rounding, chamfer=scale * self.tip_edge.chamfer),
            protuberance=scale * self.protuberance,
            protuberance_angle=self.protuberance_angle,
        )

    def flank_of(self, gear: CylindricalGear, scale: float = 1.0) -> FlankEnds:
        """Ends of the involute of the gear; arguments and errors as in `form_of`."""
        if self.tip_edge == SHARP and not self.protuberance:
            return FlankEnds(form_radius=gear.form_radius, tip_radius=gear.tip_radius)
        form = self.form_of(gear, scale)
        return FlankEnds(form_radius=form.form_radius, tip_radius=form.flank_tip_radius)


PLAIN = GearDetails()
