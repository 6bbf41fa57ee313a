"""Shafts, joints and drive of the power circuit."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from rigdesign.base.part_name import GearName
from rigdesign.case.fields import (
    ALLOWED_MISALIGNMENT,
    Angle,
    Deviation,
    Effect,
    Gap,
    Inertia,
    Length,
    LinearStiffness,
    Mass,
    Name,
    Part,
    Size,
    Slope,
    Small,
    Speed,
    TemperatureDifference,
    Text,
    Tilt,
    Torque,
    TorsionalDamping,
    TorsionalStiffness,
    Unbalance,
    Usual,
)

End = Literal["start", "end"]
ShaftModel = Literal["elastic", "torsional"]
MeshStiffness = Literal["influence_numbers", "iso_6336_scaled", "weber_banaschek_0.8"]


class SectionInput(Part):
    """Cylinder of a stepped shaft."""

    length: Annotated[Size, Usual(0.02, 13.0, "shaft diameter")]
    """Axial length of the section."""
    outer_diameter: Annotated[Length, Usual(0.3, 3.2, "shaft diameter")]
    """Outside diameter of the section."""
    inner_diameter: Annotated[Gap, Usual(0.05, 3.0, "shaft diameter")] = 0.0
    """Bore; zero for a solid section."""


class DiscInput(Part):
    """Rigid disc on a shaft: flange, nut, thrust collar."""

    position: Gap
    """Distance from the start of the shaft."""
    inertia: Annotated[Inertia, Usual(0.2, 3.2, "mass times the shaft diameter squared")]
    """Polar mass moment of inertia about the axis of the shaft."""
    mass: Mass | None = None
    """For bending; that of a steel disc a third as thick as its radius when left out."""
    diametral_inertia: Inertia | None = None
    """Mass moment of inertia about a diameter, for bending; half the polar one when left out."""


class UnbalanceInput(Part):
    """Unbalance at one place of a shaft."""

    position: Gap
    """Distance from the start of the shaft."""
    unbalance: Unbalance
    """Mass times its distance from the axis."""
    angle: Angle = 0.0
    """From +y in the sense of rotation, where the pinion of the first mesh passes zero."""


class BowInput(Part):
    """Shape of a shaft that is not straight without load; it turns with the shaft. Two bearings have to carry it."""

    amplitude: Small = 0.0
    """Residual bow: distance of its axis from the line through its bearings, half a sine between them."""
    position: Gap | None = None
    """Distance from the start of the shaft at which it has that amplitude; midway between the bearings when left
    out."""
    angle: Angle = 0.0
    """Of the residual bow, from +y in the sense of rotation."""
    temperature_difference: TemperatureDifference | None = None
    """Across the diameter: bends the shaft with the curvature alpha dT / d."""
    hot_side: Angle = 0.0
    """Angle of the hot side, from +y in the sense of rotation."""


class ShaftInput(Part):
    """Stepped shaft; positions on it count from its start."""

    sections: tuple[SectionInput, ...] = Field(min_length=1)
    """Cylinders from the start of the shaft to its end, one after the other."""
    discs: Mapping[Name, DiscInput] = {}
    """Rigid discs by name."""
    material: Name
    """Built-in material or a name under ``materials``: shear modulus and density of the shaft."""
    material_damping: Annotated[float, Usual(0.0002, 0.005)] = Field(default=0.0, ge=0.0, le=0.2)
    """Loss factor of the shaft in torsion at the mesh frequency of the test speed, a damper in parallel with every
    element that grows with frequency. That of steel is 0.0002 to 0.002, far below what couplings and films take, but
    all that damps a mode within one shaft; seats and shrink fits reach 0.01."""

    unbalances: Mapping[Name, UnbalanceInput] = {}
    """Unbalances by name; they take the place of the balance grade of the drivetrain."""
    balance_grade: Annotated[float, Usual(0.3, 20.0)] | None = Field(default=None, ge=0.0, le=4000.0)
    """Balance quality grade G of ISO 21940-11 [mm/s], whose permissible unbalance stands in the planes of its bearings
    in addition to ``unbalances``; that of the drivetrain when left out."""
    balance_speed: Speed | None = None
    """Speed of the shaft for which the grade holds; its highest of the schedule when left out."""
    balance_angles: tuple[Angle, Angle] = (0.0, 0.0)
    """Angles of the unbalances in the planes of its first and second bearing; half a turn apart they are a couple."""
    bow: BowInput | None = None
    """Residual and thermal bow; straight when left out."""

    def section_at(self, position: float) -> SectionInput | None:
        """Section at a distance from the start of the shaft [m], the first of two that meet; None beyond its end."""
        end = 0.0
        for section in self.sections:
            end += section.length
            if position <= end:
                return section
        return None


class HarmonicTorqueInput(Part):
    """Torque that alternates with the rotation of a shaft: torque cos(order angle - phase)."""

    order: float = Field(gt=0.0, le=1000.0)
    """Per turn of that shaft; the angle is zero where the pinion of the first mesh passes zero."""
    torque: Torque
    """Amplitude of the torque (half peak to peak)."""
    phase: Angle = 0.0
    """Phase angle by which the torque lags: its maximum is where order times angle equals it."""


OF_OFFSET = Effect(checks=("coupling offset",))


class CouplingInput(Part):
    """Springs and dampers between the ends of two shafts."""

    shafts: tuple[Name, Name]
    """First and second shaft that it joins."""
    ends: tuple[End, End]
    """End of the first and of the second shaft at which it sits."""
    torsional_stiffness: Annotated[TorsionalStiffness, Usual(0.02, 20.0, "stiffness of the shaft")]
    """Torque per angle of twist between its two halves."""
    torsional_damping: Annotated[TorsionalDamping, Usual(2e-6, 5e-3, "stiffness of the coupling times 1 s")]
    """Massless; its flanges and a torque flange are discs of the shafts."""
    radial_stiffness: Annotated[LinearStiffness, Usual("1e4 N/m", "1.2e9 N/m")] | None = None
    """Force per offset of the two ends; none when left out: bending does not pass it."""
    axial_stiffness: LinearStiffness | None = None
    """Force per axial travel of the two ends; none when left out."""
    angular_stiffness: Annotated[TorsionalStiffness, Usual(3e-4, 20.0, "stiffness of the shaft")] | None = (
        None
    )
    """Moment per angle between the two ends, about a diameter; none when left out."""
    lateral_damping_time: float = Field(default=0.0, ge=0.0, le=1e-3)
    """Damping over stiffness of these three [s]."""
    excitation: tuple[HarmonicTorqueInput, ...] = ()
    """Torques between its two ends, drawing the first ahead: what it makes of axes out of line turns up at order 2."""
    radial_offset_maximum: Annotated[Length, Usual("0.02 mm", "2.5 mm"), ALLOWED_MISALIGNMENT] | None = None
    """What its maker allows between the axes, as set and warm."""
    angle_maximum: Annotated[Tilt, Usual("0.15 mrad", "9 mrad"), ALLOWED_MISALIGNMENT] | None = None
    """What its maker allows between the axes, as set and warm."""
    cold_offset_lateral: Annotated[Deviation, OF_OFFSET] = 0.0
    """Axis of the first shaft against that of the second as set up, across (y)."""
    cold_offset_vertical: Annotated[Deviation, OF_OFFSET] = 0.0
    """Axis of the first shaft against that of the second as set up, upwards (z)."""
    cold_angle_lateral: Slope = 0.0
    """Slope of the axis of the first shaft against that of the second as set up, across (y) over x."""
    cold_angle_vertical: Slope = 0.0
    """Slope of the axis of the first shaft against that of the second as set up, upwards (z) over x."""
    flange_run_out: Small = 0.0
    """Distance of the centre of the flange of the first shaft from its axis, half of what a dial gauge reads."""
    flange_run_out_angle: Angle = 0.0
    """From +y in the sense of rotation."""
    flange_tilt: Slope = 0.0
    """Angle of the face of that flange from square."""
    flange_tilt_angle: Angle = 0.0
    """From +y in the sense of rotation."""
    joint: Literal["constant_velocity", "hooke"] = "constant_velocity"
    """hooke: a cross joint, which under an angle b between the axes turns one shaft ahead and back by b^2/4 twice a
    turn, against its torsional stiffness, and bends both by half of its torque times b, all the time and twice a
    turn."""

    @property
    def alternates(self) -> bool:
        """Whether an angle between its axes alternates its turn and its bending."""
        return self.joint == "hooke"


class MotorInput(Part):
    """Drive outside the power circuit."""

    shaft: Name
    """Shaft of the power circuit that the motor drives."""
    end: End
    """End of that shaft at which it drives."""
    torque_limit: Annotated[
        Torque, Usual(0.01, 1.1, "test torque"), Effect(checks=("time run",), solved=("time run",))
    ]
    """Most torque of the motor at every speed; its power has a limit of its own under ``limits.bought_parts``."""
    inertia: Annotated[Inertia, Usual(1.2e-4, 3e-3, "torque of the motor")]
    """Polar mass moment of inertia of the rotor, turning with the shaft."""
    ripple: tuple[HarmonicTorqueInput, ...] = ()
    """Alternating parts of its torque about the mean."""


OF_FRICTION = Effect(checks=("spline friction",))


class Bracing(Part):
    """How the test torque is locked into the loop."""

    mode: Literal["torque_controlled", "twist_held", "shift_held"]
    """torque_controlled: the mean torque at ``torque_at`` is held at that of the stage, whatever expands;
    twist_held, shift_held: the twist of a coupling or the axial shift of a gear that makes the torque in the
    initial state is kept, so that thermal expansion changes the torque."""
    coupling: Name | None = None
    """Coupling that is twisted (``twist_held``)."""
    shifted_gear: Text | None = None
    """Helical gear that is shifted, ``gearbox.gear`` (``shift_held`` and ``torque_controlled``)."""
    partner_floats: bool = False
    """The partner of the shifted half floats axially and takes half of the shift."""
    spline_friction_coefficient: Annotated[float, Usual(0.02, 0.4), OF_FRICTION] = Field(
        default=0.0, ge=0.0, le=1.0
    )
    """Friction coefficient of the seat on which the shifted gear slides: adds to the force of the load
    unit."""
    spline_pitch_radius: Annotated[Length, Usual(0.25, 2.5, "shaft diameter"), OF_FRICTION] | None = None
    """Radius at which that friction acts; no friction force when left out."""
    temperature_drift: float = Field(default=0.0, ge=-0.02, le=0.02)
    """Change of the locked torque, as a share, for each kelvin by which the gear oil that enters the gearbox of
    ``torque_at`` is warmer than ``ambient.reference_temperature``."""


class DrivetrainInput(Part):
    """The power circuit: which shafts, how joined, how driven and braced."""

    shafts: Mapping[Name, ShaftInput] = Field(min_length=2)
    """Shafts of the power circuit by name."""
    couplings: Mapping[Name, CouplingInput] = {}
    """Couplings between ends of shafts by name."""
    motor: MotorInput
    """Drive of the rig."""
    bracing: Bracing
    """How the test torque is locked into the loop."""
    torque_at: Text
    """Gear at which test torque and speed are counted, ``gearbox.gear``."""
    shaft_model: ShaftModel = "elastic"
    """elastic: shafts that bend in bearings that give, gears in six degrees of freedom; torsional: shafts that only
    twist."""
    balance_grade: Annotated[float, Usual(0.3, 20.0)] | None = Field(default=None, ge=0.0, le=4000.0)
    """Balance quality grade G of ISO 21940-11 [mm/s] of all shafts that state neither one of their own nor unbalances;
    2.5 when left out."""
    bearing_coefficients: Literal["computed", "stated"] = "computed"
    """Lateral stiffness and damping of the bearings: computed for load, speed and temperature of each stage, or
    ``radial_stiffness`` and ``radial_damping`` as each bearing states them."""
    mesh_stiffness: MeshStiffness = "influence_numbers"
    """Tooth model: finite-element influence numbers of the teeth as drawn on the gear bodies that all pairs share, the
    analytic shape scaled to the mean of ISO 6336-1, or unscaled times 0.8."""

    @property
    def counting_gear(self) -> GearName:
        """The gear of ``torque_at``."""
        return GearName.read(self.torque_at)


NO_DRIVETRAIN = DrivetrainInput.model_construct(
    shafts={},
    motor=MotorInput.model_construct(shaft="", end="start", torque_limit=0.0, inertia=0.0),
    bracing=Bracing(mode="torque_controlled"),
    torque_at="",
    shaft_model="torsional",
    bearing_coefficients="stated",
    mesh_stiffness="iso_6336_scaled",
)
"""Of a rig whose losses are given: no shafts, no couplings, nothing braced."""
