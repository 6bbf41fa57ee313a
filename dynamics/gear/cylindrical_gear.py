"""One involute cylindrical gear: sizes, tooth thickness and limits of the generated flank (ISO 21771)."""

from dataclasses import dataclass
from functools import cached_property
from math import acos, asin, atan, cos, hypot, inf, pi, sin, sqrt, tan

from scipy.optimize import brentq

from dynamics.gear.involute import GearGeometryError, involute, require_angles


@dataclass(frozen=True, kw_only=True)
class Rack:
    """Basic rack in multiples of the normal module (ISO 53): addendum, dedendum, tip radius of the tool."""

    addendum: float = 1.0
    dedendum: float = 1.25
    tip_radius: float = 0.38

    def __post_init__(self) -> None:
        for name in ("addendum", "dedendum", "tip_radius"):
            if not getattr(self, name) >= 0.0:
                raise GearGeometryError(
                    f"rack.{name} = {getattr(self, name)} must not be negative; give it in modules"
                )


@dataclass(frozen=True, kw_only=True)
class CylindricalGear:
    """An external gear with the tooth thickness and root that its tool leaves. Lengths [m], angles [rad].

    ``profile_shift`` is nominal; ``thickness_allowance`` [m] is the reduction of the normal tooth thickness
    that makes backlash. The tool is fed deeper for it, so thickness, form circle and fillet follow the
    generating profile shift x_E (ISO 21771:2007, 4.4); tip and root diameter stay nominal.
    """

    normal_module: float
    pressure_angle: float
    helix_angle: float
    teeth: int
    profile_shift: float
    tip_diameter: float
    rack: Rack
    thickness_allowance: float = 0.0

    def __post_init__(self) -> None:
        require_angles(self.pressure_angle, self.helix_angle)
        for name in ("normal_module", "teeth"):
            if not getattr(self, name) > 0:
                raise GearGeometryError(
                    f"{name} = {getattr(self, name)} must be positive; correct the gear data"
                )
        alpha, rack = self.pressure_angle, self.rack
        tip_land = 0.25 * pi - rack.dedendum * tan(alpha) - rack.tip_radius * (1 - sin(alpha)) / cos(alpha)
        if not tip_land > -5e-3:
            raise GearGeometryError(
                f"rack: half the tool tip is {tip_land:.4f} modules wide, it must not be negative with "
                f"dedendum = {rack.dedendum} and tip_radius = {rack.tip_radius}; reduce one of them"
            )
        if not self.reference_radius > self._root_feed:
            raise GearGeometryError(
                f"profile_shift = {self.profile_shift:.3f} with dedendum = {rack.dedendum} leaves no root on "
                f"{self.teeth} teeth; raise the shift or the tooth number"
            )

    @property
    def transverse_module(self) -> float:
        """m_t = m_n / cos(beta) [m]."""
        return self.normal_module / cos(self.helix_angle)

    @property
    def transverse_pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return atan(tan(self.pressure_angle) / cos(self.helix_angle))

    @property
    def base_helix_angle(self) -> float:
        """beta_b [rad]."""
        return asin(sin(self.helix_angle) * cos(self.pressure_angle))

    @property
    def virtual_teeth(self) -> float:
        """Tooth number z_n of the virtual spur gear in the normal section [-]."""
        return self.teeth / (cos(self.base_helix_angle) ** 2 * cos(self.helix_angle))

    @property
    def reference_radius(self) -> float:
        """Half the reference diameter d [m]."""
        return 0.5 * self.transverse_module * self.teeth

    @property
    def base_radius(self) -> float:
        """Half the base diameter d_b [m]."""
        return self.reference_radius * cos(self.transverse_pressure_angle)

    @property
    def tip_radius(self) -> float:
        """Half the tip diameter d_a [m]."""
        return 0.5 * self.tip_diameter

    @property
    def root_radius(self) -> float:
        """Half the nominal root diameter d_f [m]."""
        return self.reference_radius - self.normal_module * (self.rack.dedendum - self.profile_shift)

    @property
    def mean_radius(self) -> float:
        """Half the mean tooth diameter d_m = (d_a + d_f)/2 [m]."""
        return 0.5 * (self.tip_radius + self.root_radius)

    @property
    def base_pitch(self) -> float:
        """Transverse base pitch p_bt [m]."""
        return 2.0 * pi * self.base_radius / self.teeth

    @property
    def generating_profile_shift(self) -> float:
        """x_E, the profile shift that leaves the thinned tooth [-]."""
        return self.profile_shift - self.thickness_allowance / (
            2.0 * self.normal_module * tan(self.pressure_angle)
        )

    @property
    def base_half_angle(self) -> float:
        """Half the angle that one tooth spans on the base circle [rad]."""
        half = (0.5 * pi + 2.0 * self.generating_profile_shift * tan(self.pressure_angle)) / self.teeth
        return half + involute(self.transverse_pressure_angle)

    def half_angle(self, radius: float) -> float:
        """Half the angle that one tooth spans at ``radius`` [m] at or outside the base circle [rad]."""
        return self.base_half_angle - involute(acos(self.base_radius / radius))

    @property
    def tip_thickness(self) -> float:
        """Normal tooth thickness on the tip circle [m]; zero or less is a pointed tooth."""
        helix = atan(tan(self.helix_angle) * self.tip_radius / self.reference_radius)
        return 2.0 * self.tip_radius * self.half_angle(self.tip_radius) * cos(helix)

    def roll_length(self, radius: float) -> float:
        """Distance of the flank point at ``radius`` [m] from the base tangent point [m]."""
        return sqrt(max(radius**2 - self.base_radius**2, 0.0))

    @property
    def _root_feed(self) -> float:
        """Distance B of the last straight rack point below the reference circle [m]."""
        rack = self.rack
        height = rack.dedendum - self.generating_profile_shift
        return self.normal_module * (height - rack.tip_radius * (1.0 - sin(self.pressure_angle)))

    @property
    def least_profile_shift(self) -> float:
        """x_min, the generating profile shift below which the tool cuts off flank [-]: h_fP - rho_fP (1 - sin alpha_n)
        - z sin^2 alpha_t / (2 cos beta)."""
        over = self._root_feed - self.reference_radius * sin(self.transverse_pressure_angle) ** 2
        return self.generating_profile_shift + over / self.normal_module

    @property
    def undercut(self) -> bool:
        """True if the tool reaches below the base tangent point and cuts off flank."""
        return self.generating_profile_shift < self.least_profile_shift

    @cached_property
    def form_radius(self) -> float:
        """Half the generated form diameter d_Ff [m]: where involute and fillet join or, undercut, cross.

        Source: rack without protuberance, r_Ff^2 = (r - B)^2 + (B / tan alpha_t)^2 (ISO 21771:2007, 5.4);
        an undercut tooth by crossing the trochoid with the involute in the virtual spur gear.
        """
        if not self.undercut:
            feed = self._root_feed
            return hypot(self.reference_radius - feed, feed / tan(self.transverse_pressure_angle))
        roll = self._undercut_roll_length() * cos(self.base_helix_angle)
        return hypot(self.base_radius, roll)

    def trochoid_point(self, tool_angle: float) -> tuple[float, float]:
        """Fillet point (x, y) [m] of the virtual spur gear for a contact angle [rad] on the tool tip arc.

        y is the tooth axis. pi/2 gives the root circle, the normal pressure angle the end of the fillet.
        Source: envelope of the rack tip arc rolling without slip (ISO 53 rack, ISO 21771 generation).
        """
        alpha, module, rack = self.pressure_angle, self.normal_module, self.rack
        radius = 0.5 * module * self.virtual_teeth
        arc = rack.tip_radius * module
        depth = (rack.dedendum - self.generating_profile_shift - rack.tip_radius) * module
        edge = 0.25 * pi * module - rack.dedendum * module * tan(alpha) - (1 - sin(alpha)) * arc / cos(alpha)
        roll = (depth / tan(tool_angle) + 0.5 * pi * module - edge) / radius
        reach = depth / sin(tool_angle) + arc
        x = radius * sin(roll) - reach * cos(tool_angle - roll)
        y = radius * cos(roll) - reach * sin(tool_angle - roll)
        return x, y

    def virtual_half_angle(self, radius: float) -> float:
        """Half the angle that one tooth of the virtual spur gear spans at ``radius`` [m] on it [rad]."""
        teeth = self.virtual_teeth
        base = 0.5 * self.normal_module * teeth * cos(self.pressure_angle)
        half = (0.5 * pi + 2.0 * self.generating_profile_shift * tan(self.pressure_angle)) / teeth
        return half + involute(self.pressure_angle) - involute(acos(min(base / radius, 1.0)))

    def _fillet_excess(self, tool_angle: float) -> float:
        """Half angle of the fillet beyond the involute at the same radius of the virtual gear [rad]."""
        x, y = self.trochoid_point(tool_angle)
        return atan(x / y) - self.virtual_half_angle(hypot(x, y))

    def _undercut_roll_length(self) -> float:
        """Roll length where the virtual gear's trochoid crosses its involute, 0 if all flank stays [m]."""
        base = 0.5 * self.normal_module * self.virtual_teeth * cos(self.pressure_angle)
        outside = self.pressure_angle
        for k in range(1, 361):
            inside = self.pressure_angle + (0.5 * pi - self.pressure_angle) * k / 360
            if hypot(*self.trochoid_point(inside)) <= base:
                return 0.0
            if self._fillet_excess(inside) < 0.0:
                crossing = brentq(self._fillet_excess, outside, inside, xtol=1e-14)
                return sqrt(max(hypot(*self.trochoid_point(crossing)) ** 2 - base**2, 0.0))
            outside = inside
        return 0.0

    def fillet_overlap(self, roll_length: float) -> float:
        """Metal of the fillet in the way of a mating flank that reaches down to ``roll_length`` [m].

        Distance along the line of action by which the fillet stands beyond the extended involute there [m];
        0 where the involute was generated or the tooth is undercut.
        """
        radius = hypot(self.base_radius, max(roll_length, 0.0))
        if self.undercut or radius >= self.form_radius:
            return 0.0
        base = 0.5 * self.normal_module * self.virtual_teeth * cos(self.pressure_angle)
        wanted = hypot(base, roll_length / cos(self.base_helix_angle))

        def miss(tool_angle: float) -> float:
            return hypot(*self.trochoid_point(tool_angle)) - wanted

        if roll_length <= 0.0 or miss(0.5 * pi) >= 0.0:
            return inf
        angle = brentq(miss, self.pressure_angle, 0.5 * pi, xtol=1e-14)
        return base * self._fillet_excess(angle)
