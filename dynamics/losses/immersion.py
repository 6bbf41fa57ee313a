"""Gears that dip into an oil bath: depth, wetted angle, areas and volume, and what the teeth lift out of it.

Heights are measured upwards from any common datum; the oil surface is a horizontal plane. A bath at rest is what the
churning laws were fitted to, so `OilBath.level` is the level at standstill; `OilBath.lowering` is oil that *other*
parts of the rig hold away from this sump while it runs (a catch tray, a return line), not the swell of the gear itself.
"""

import math
from dataclasses import dataclass, fields
from typing import Self

from dynamics.gear.pair import GearPair
from dynamics.losses.loss import LossError

SPLASH_SPEED = 3.0
"""Tip speed [m/s] from which a dipped gear throws oil on teeth and bearings (Changenet and Velex 2008)."""
SPLASH_SHARE_RANGE = (0.001, 0.1)
"""Share of the lifted oil that reaches one bearing [-]; assumed, no source."""


@dataclass(frozen=True, kw_only=True)
class OilBath:
    """Sump of one gear chamber.

    level : of the oil at rest [m]
    volume : of oil in the sump [m3]
    density : [kg/m3]
    viscosity : dynamic, at the sump temperature [Pa s]
    lowering : drop of the level in operation, oil held elsewhere [m]
    hydraulic_length : l_h of the housing, four times inner plan area over its perimeter [m]; only for ISO/TR 14179-2
    """

    level: float
    volume: float
    density: float
    viscosity: float
    lowering: float = 0.0
    hydraulic_length: float | None = None

    def __post_init__(self) -> None:
        for name, unit in (("volume", "m3"), ("density", "kg/m3"), ("viscosity", "Pa s")):
            value = getattr(self, name)
            if not (value > 0.0 and math.isfinite(value)):
                raise LossError(
                    f"oil bath: {name} = {value:.6g} {unit}: must be above 0; correct the sump or oil data"
                )
        if not (math.isfinite(self.level) and self.lowering >= 0.0 and math.isfinite(self.lowering)):
            raise LossError(
                f"oil bath: level = {self.level} m, lowering = {self.lowering} m: the level must be finite and the "
                "lowering not negative; give heights above one datum"
            )
        if self.hydraulic_length is not None and not self.hydraulic_length > 0.0:
            raise LossError(
                f"oil bath: hydraulic_length = {self.hydraulic_length} m: must be above 0; give 4 x plan area / "
                "perimeter of the chamber"
            )

    @property
    def running_level(self) -> float:
        """Level in operation [m]."""
        return self.level - self.lowering

    @property
    def kinematic_viscosity(self) -> float:
        """[m2/s]"""
        return self.viscosity / self.density


@dataclass(frozen=True, kw_only=True)
class DippedGear:
    """Gear as the bath sees it.

    tip_radius, pitch_radius, root_radius, face_width, normal_module : [m]
    teeth : number of teeth
    axis_height : of the gear axis above the datum of the bath [m]
    shaft_radius : [m]
    pressure_angle, helix_angle : normal pressure angle and helix angle [rad]
    """

    tip_radius: float
    pitch_radius: float
    root_radius: float
    face_width: float
    normal_module: float
    teeth: int
    axis_height: float
    shaft_radius: float
    pressure_angle: float = math.radians(20.0)
    helix_angle: float = 0.0

    def __post_init__(self) -> None:
        for name in ("face_width", "normal_module", "teeth", "shaft_radius"):
            value = getattr(self, name)
            if not value > 0.0:
                raise LossError(f"dipped gear: {name} = {value:.6g}: must be above 0; correct the gear data")
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise LossError(f"dipped gear: {field.name} = {value}: must be finite; correct the gear data")
        if not (
            self.tip_radius > self.root_radius > self.shaft_radius and self.pitch_radius > self.shaft_radius
        ):
            raise LossError(
                f"dipped gear: tip, root and shaft radius = {self.tip_radius:.6g}, {self.root_radius:.6g}, "
                f"{self.shaft_radius:.6g} m, pitch radius = {self.pitch_radius:.6g} m: the first three must fall in "
                "this order and the pitch circle lie outside the shaft; correct the gear data"
            )

    @classmethod
    def of_pair(cls, pair: GearPair, index: int, axis_height: float, shaft_radius: float) -> Self:
        """Pinion (index 0) or wheel (1) of a gear pair; the pitch radius is the reference radius."""
        gear = pair.gears[index]
        return cls(
            tip_radius=gear.tip_radius,
            pitch_radius=gear.reference_radius,
            root_radius=gear.root_radius,
            face_width=pair.face_widths[index],
            normal_module=gear.normal_module,
            teeth=pair.teeth[index],
            axis_height=axis_height,
            shaft_radius=shaft_radius,
            pressure_angle=gear.pressure_angle,
            helix_angle=gear.helix_angle,
        )

    @property
    def tooth_height(self) -> float:
        """[m]"""
        return self.tip_radius - self.root_radius

    @property
    def lowest_point(self) -> float:
        """Height of the lowest tooth tip [m]."""
        return self.axis_height - self.tip_radius


@dataclass(frozen=True, kw_only=True)
class RunningGear:
    """A dipped gear at its place in the rig; speed [rad/s], its sign does not matter."""

    place: str
    gear: DippedGear
    speed: float

    @property
    def circumferential_speed(self) -> float:
        """At the pitch circle [m/s]."""
        return abs(self.speed) * self.gear.pitch_radius


@dataclass(frozen=True, kw_only=True)
class Immersion:
    """Part of a disc below the oil surface.

    radius : of the disc [m]; depth : of its lowest point below the surface, 0 if it is above the surface [m]
    half_angle : half of the wetted angle [rad], 0 to pi; chord : width of the disc at the surface [m]
    side_area : both faces [m2]; rim_area : smooth cylinder [m2]; volume : displaced oil [m3]
    """

    radius: float
    depth: float
    half_angle: float
    chord: float
    side_area: float
    rim_area: float
    volume: float

    @property
    def share_of_turn(self) -> float:
        """Part of a turn that a point of the rim spends in the oil [-]."""
        return self.half_angle / math.pi


def immersion(gear: DippedGear, bath: OilBath, radius: float | None = None) -> Immersion:
    """Immersion of the disc with the gear's width at ``radius`` [m], the tip radius unless given.

    The level in operation counts. Plane geometry of a circular segment, cos(theta) = 1 - h/R; the part of the shaft
    that may stand in the oil is not taken off the faces.

    Raises LossError if the oil stands at or above the top of the shaft.
    """
    circle = gear.tip_radius if radius is None else radius
    top = gear.axis_height + gear.shaft_radius
    if bath.running_level >= top:
        raise LossError(
            f"oil bath: level = {bath.running_level * 1e3:.1f} mm: must stay below the top of the shaft at "
            f"{top * 1e3:.1f} mm; lower the level or lubricate by jet"
        )
    depth = max(0.0, bath.running_level - (gear.axis_height - circle))
    angle = math.acos(max(-1.0, 1.0 - depth / circle))
    segment = 0.5 * circle**2 * (2.0 * angle - math.sin(2.0 * angle))
    return Immersion(
        radius=circle,
        depth=depth,
        half_angle=angle,
        chord=2.0 * circle * math.sin(angle),
        side_area=2.0 * segment,
        rim_area=2.0 * angle * circle * gear.face_width,
        volume=segment * gear.face_width,
    )


def wetted_area(gear: DippedGear, bath: OilBath) -> float:
    """Wetted surface S_m of faces, rim and tooth flanks [m2], to the pitch circle.

    S_m = R^2 (2 theta - sin 2 theta) + 2 theta R b + 2 z theta H b/(pi cos(alpha) cos(beta)),  cos(theta) = 1 - h/R

    R the pitch radius, h the depth of the pitch circle, H the tooth height: z theta/pi teeth stand in the oil, each
    with two flanks. Source: Changenet and Velex, J. Mech. Des. 129 (2007); from memory, the geometry is derived here.
    """
    pitch = immersion(gear, bath, gear.pitch_radius)
    flanks = 2.0 * gear.teeth * pitch.share_of_turn * gear.tooth_height * gear.face_width
    return (
        pitch.side_area
        + pitch.rim_area
        + flanks / (math.cos(gear.pressure_angle) * math.cos(gear.helix_angle))
    )


def level_warnings(place: str, gear: DippedGear, bath: OilBath) -> tuple[str, ...]:
    """Sentences for a level that reaches the shaft and for teeth of which only the tips touch the oil."""
    underside = gear.axis_height - gear.shaft_radius
    warnings: tuple[str, ...] = ()
    if bath.running_level >= underside:
        warnings += (
            f"{place}: oil level = {bath.running_level * 1e3:.1f} mm: reaches the shaft at {underside * 1e3:.1f} mm; "
            "lower it, or count flooded bearings and shaft seals",
        )
    depth = bath.running_level - gear.lowest_point
    if 0.0 < depth < gear.tooth_height:
        warnings += (
            f"{place}: immersion = {depth * 1e3:.2f} mm: less than the tooth height {gear.tooth_height * 1e3:.2f} mm; "
            "raise the level for safe lubrication",
        )
    return warnings


def tooth_space_flow(gear: DippedGear, bath: OilBath, speed: float) -> float:
    """Most oil that the tooth spaces can lift out of the bath [m3/s]: all leave it full, once a turn.

    pi (r_a^2 - r_w^2)/2 b omega/(2 pi), r_w the root radius or the radius that just dips; half of the toothed ring is
    gap. speed : [rad/s]. An upper bound by kinematics, no measurement; oil dragged along by the faces is not in it.
    """
    depth = immersion(gear, bath).depth
    inner = max(gear.root_radius, gear.tip_radius - depth)
    return 0.25 * (gear.tip_radius**2 - inner**2) * gear.face_width * abs(speed)


def splash_flow(gear: DippedGear, bath: OilBath, speed: float, share: float = 0.01) -> float:
    """Oil that splash brings to one bearing [m3/s]: a share of `tooth_space_flow`, zero below `SPLASH_SPEED`.

    share : marked assumption, 0.001 to 0.1 [-]. No published law was found that predicts it: it depends on ribs,
    pockets and the sense of rotation; measure it or carry the whole range.

    Raises LossError for a share outside its range.
    """
    low, high = SPLASH_SHARE_RANGE
    if not low <= share <= high:
        raise LossError(
            f"splash share = {share:g}: must lie within {low:g} to {high:g}; it is an assumed part of the lifted oil"
        )
    if abs(speed) * gear.tip_radius < SPLASH_SPEED:
        return 0.0
    return share * tooth_space_flow(gear, bath, speed)
