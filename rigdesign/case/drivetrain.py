"""Shafts, joints and drive of the power circuit."""

from collections.abc import Mapping
from typing import Literal

from pydantic import Field

from rigdesign.case.fields import (
    Angle,
    Deviation,
    Gap,
    Inertia,
    Length,
    LinearStiffness,
    Mass,
    Name,
    Part,
    Size,
    Text,
    Tilt,
    Torque,
    TorsionalDamping,
    TorsionalStiffness,
)

End = Literal["start", "end"]
ShaftModel = Literal["elastic", "torsional"]
MeshStiffness = Literal["influence_numbers", "iso_6336_scaled", "weber_banaschek_0.8"]


class SectionInput(Part):
    """Cylinder of a stepped shaft."""

    length: Size
    """Axial length of the section."""
    outer_diameter: Length
    """Outside diameter of the section."""
    inner_diameter: Gap = 0.0
    """Bore; zero for a solid section."""


class DiscInput(Part):
    """Rigid disc on a shaft: flange, nut, thrust collar."""

    position: Gap
    """Distance from the start of the shaft."""
    inertia: Inertia
    """Polar mass moment of inertia about the axis of the shaft."""
    mass: Mass | None = None
    """For bending; that of a steel disc a third as thick as its radius when left out."""
    diametral_inertia: Inertia | None = None
    """Mass moment of inertia about a diameter, for bending; half the polar one when left out."""


class ShaftInput(Part):
    """Stepped shaft; positions on it count from its start."""

    sections: tuple[SectionInput, ...] = Field(min_length=1)
    """Cylinders from the start of the shaft to its end, one after the other."""
    discs: Mapping[Name, DiscInput] = {}
    """Rigid discs by name."""
    material: Name
    """Built-in material or a name under ``materials``: shear modulus and density of the shaft."""
    material_damping: float = Field(default=0.0, ge=0.0, le=0.2)
    """Loss factor of the shaft in torsion at the mesh frequency of the test speed, a damper beside every element that
    grows with frequency. Zero unless stated: that of steel, 0.0002 to 0.002, is far below what couplings and films
    take; seats and shrink fits reach 0.01."""

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


class CouplingInput(Part):
    """Springs and dampers between the ends of two shafts."""

    shafts: tuple[Name, Name]
    """First and second shaft that it joins."""
    ends: tuple[End, End]
    """End of the first and of the second shaft at which it sits."""
    torsional_stiffness: TorsionalStiffness
    """Torque per angle of twist between its two halves."""
    torsional_damping: TorsionalDamping
    """Massless; its flanges and a torque flange are discs of the shafts."""
    radial_stiffness: LinearStiffness | None = None
    """Force per offset of the two ends; none when left out: bending does not pass it."""
    axial_stiffness: LinearStiffness | None = None
    """Force per axial travel of the two ends; none when left out."""
    angular_stiffness: TorsionalStiffness | None = None
    """Moment per angle between the two ends, about a diameter; none when left out."""
    lateral_damping_time: float = Field(default=0.0, ge=0.0, le=1e-3)
    """Damping over stiffness of these three [s]."""
    excitation: tuple[HarmonicTorqueInput, ...] = ()
    """Torques between its two ends, drawing the first ahead: what it makes of axes out of line turns up at order 2."""
    radial_offset_maximum: Length | None = None
    """What its maker allows between the axes, as set and warm."""
    angle_maximum: Tilt | None = None
    """What its maker allows between the axes, as set and warm."""
    cold_offset_lateral: Deviation = 0.0
    """Axis of the first shaft against that of the second as set up, across (y)."""
    cold_offset_vertical: Deviation = 0.0
    """Axis of the first shaft against that of the second as set up, upwards (z)."""


class MotorInput(Part):
    """Drive outside the power circuit."""

    shaft: Name
    """Shaft of the power circuit that the motor drives."""
    end: End
    """End of that shaft at which it drives."""
    torque_limit: Torque
    """Most torque of the motor at every speed; its power has a limit of its own under ``limits.bought_parts``."""
    inertia: Inertia
    """Polar mass moment of inertia of the rotor, turning with the shaft."""
    ripple: tuple[HarmonicTorqueInput, ...] = ()
    """Alternating parts of its torque about the mean."""


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
    spline_friction_coefficient: float = Field(default=0.0, ge=0.0, le=1.0)
    """Friction coefficient of the seat on which the shifted gear slides: adds to the force of the load
    unit."""
    spline_pitch_radius: Length | None = None
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
    twist, as always at fidelity quick."""
    bearing_coefficients: Literal["computed", "stated"] = "computed"
    """Lateral stiffness and damping of the bearings: computed for load, speed and temperature of each stage, or
    ``radial_stiffness`` and ``radial_damping`` as each bearing states them."""
    mesh_stiffness: MeshStiffness = "influence_numbers"
    """Tooth model: finite-element influence numbers of the teeth as drawn on the gear bodies that all pairs share
    (``iso_6336_scaled`` at fidelity quick), the analytic shape scaled to the mean of ISO 6336-1, or unscaled times
    0.8."""
