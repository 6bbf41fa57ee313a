"""Gears and meshes of a gearbox."""

from collections.abc import Mapping
from math import radians
from typing import Annotated, Literal

from pydantic import Field, model_validator

from rigdesign.base.units import show
from rigdesign.case.fields import (
    COUPLED,
    Angle,
    Count,
    Deviation,
    Effect,
    Gap,
    HelixAngle,
    Inertia,
    Length,
    LinearDamping,
    LinearStiffness,
    Name,
    Offset,
    Part,
    Play,
    Positive,
    PressureAngle,
    Quantity,
    Resistance,
    Share,
    Size,
    Small,
    Stress,
    Text,
    TorsionalDamping,
    TorsionalStiffness,
    Usual,
    Voltage,
    fault,
)

# Strain gauges in the root of a tooth: place, grid, bridge; `rigdesign.rig.strain_gauges` puts them on the gear.

ArmStrain = Annotated[float, Field(ge=-1.0, le=1.0)]
ResponseTime = Annotated[float, Quantity("time", at_least="0 s", at_most="0.1 s", example="0.02 ms")]


class StrainBridge(Part):
    """Wheatstone bridge of one strain gauge."""

    kind: Literal["quarter", "half_passive", "half", "full"]
    """quarter: one gauge, completed in the amplifier; half_passive: one gauge with a passive resistor next to it,
    completed in the amplifier; half: two gauges; full: four."""
    supply_voltage: Annotated[Voltage, Usual("0.3 V", "15 V")]
    """Voltage that feeds the bridge, at the amplifier."""
    arms: tuple[ArmStrain, ...] | None = None
    """Strain of each active arm over that of the gauge, e.g. 1 and -0.3 for a second gauge across; 1 and -1, or twice
    that, when left out: a bent bar."""
    completion_resistance: Resistance | None = None
    """Of the passive resistor; that of the gauge when left out."""
    wires: int | None = None
    """Wires to the amplifier, each a channel of a slip ring; 3, and 4 for a full bridge, when left out."""
    lead_resistance: Resistance = 0.0
    """Of one wire with its slip-ring contact."""


class StrainGaugeInput(Part):
    """One strain gauge in the root of a tooth; its grid lies along the fillet, across the tooth trace.

    Its place along the fillet is one of ``fillet_position``, ``tangent_angle`` and ``root_diameter``; the 30 deg
    tangent of ISO 6336-3 when all are left out.
    """

    tooth: int = Field(default=0, ge=0, le=1999)
    """Number of its tooth, counted from 0 as those of ``flank``."""
    fillet: Literal["front", "back"] = "front"
    """Fillet under the front flank, or under the back flank; that of the front flank is pulled where the mesh runs on
    its front flanks."""
    face_position: Annotated[Offset, Usual(0.0, 0.5, "face width")]
    """Middle of the grid over the face width: from mid-face, positive to the rear end, the one that comes into mesh
    last."""
    fillet_position: Offset | None = None
    """Distance of the middle of the grid along the fillet from its 30 deg tangent, positive to the tip."""
    tangent_angle: Angle | None = None
    """Angle between the fillet and the tooth axis at the middle of the grid, in the normal section."""
    root_diameter: Size | None = None
    """Diameter at the middle of the grid."""
    misalignment: Angle = 0.0
    """Direction of the grid against that of the fillet."""
    grid_length: Annotated[Length, Usual("0.2 mm", "5 mm")]
    """Length of the measuring grid, along its wires."""
    grid_width: Annotated[Length, Usual("0.2 mm", "5 mm")]
    """Width of the measuring grid."""
    gauge_factor: Annotated[Positive, Usual(1.5, 4.0)] = 2.0
    """k: relative change of resistance over strain."""
    resistance: Annotated[Resistance, Usual("50 ohm", "1100 ohm")] = 120.0
    """Resistance of the gauge."""
    transverse_sensitivity: float = Field(default=0.0, ge=-0.2, le=0.2)
    """Sensitivity across over that along the grid."""
    stress_state: Literal["uniaxial", "plane_strain"] = "uniaxial"
    """How strain becomes stress: uniaxial: E eps, as at the ends of the face; plane_strain: E eps / (1 - nu^2), a wide
    tooth at mid-face."""
    response_time: ResponseTime = 0.0
    """Time constant of slip ring, amplifier and logger taken as a first-order low-pass: 1 / (2 pi cut-off frequency);
    0.02 ms pass 8 kHz. What a recording is compared with has it."""
    bridge: StrainBridge
    """Circuit that measures its resistance."""

    @model_validator(mode="after")
    def _one_place(self) -> "StrainGaugeInput":
        stated = [key for key in PLACES if getattr(self, key) is not None]
        if len(stated) > 1:
            raise fault(
                f"{' and '.join(stated)} are given", "keep one of them: each is the place along the fillet"
            )
        return self


PLACES = ("fillet_position", "tangent_angle", "root_diameter")
"""Keys of the place along the fillet."""


# Seats of gears on their shafts: splines with their stiffness and damping, and the toothing that limits their load.

SplineAngle = Annotated[float, Quantity("angle", at_least="15 deg", at_most="50 deg")]


WORKING_DEPTH = 0.9
"""Of a spline to DIN 5480, in modules: half of tip diameter of the shaft less tip diameter of the hub."""


class SplineToothing(Part):
    """Toothing of a spline and its strength; each stress is checked where its allowable value is stated."""

    teeth: Count = Field(ge=4, le=500)
    """Number of teeth."""
    module: Annotated[Length, Usual(0.005, 0.2, "shaft diameter")] | None = None
    """Module; or ``pitch_diameter``."""
    pitch_diameter: Annotated[Length, Usual(0.4, 2.5, "shaft diameter")] | None = None
    """Pitch diameter, teeth times module."""
    pressure_angle: SplineAngle = radians(30.0)
    """Pressure angle of the flanks; 30 deg by DIN 5480."""
    length: Annotated[Length, Usual(0.1, 4.0, "shaft diameter")]
    """Axial length of contact."""
    working_depth: Length | None = None
    """Radial height over which the flanks touch; 0.9 modules when left out, as of a spline to DIN 5480."""
    load_distribution_factor: float = Field(default=1.0, ge=1.0, le=5.0)
    """K_m of Dudley: load distribution over length and teeth with tilted axes, 1 to 3."""
    shaft_root_diameter: Length | None = None
    """Root circle of the teeth of the shaft; without it the shear of the shaft under them is not checked."""
    hub_root_diameter: Length | None = None
    """Root circle of the teeth of the hub, its largest bore; without it the tension of the hub is not checked."""
    hub_diameter: Length | None = None
    """Outside diameter of the hub; the root circle of the gear when left out."""
    allowable_pressure: Annotated[Stress, Usual("5 MPa", "600 MPa")] | None = None
    """Allowable flank pressure under the dynamic torque, life factor included. Dudley: 35 MPa for straight teeth of
    case-hardened steel that slide, nine times as much where they are fixed."""
    allowable_shear: Annotated[Stress, Usual("40 MPa", "700 MPa")] | None = None
    """Allowable shear stress of teeth and shaft. Dudley: 345 MPa for case-hardened steel, times its life
    factor, 0.5 to 0.2 for 1e5 to 1e7 cycles of the torque."""
    allowable_tension: Annotated[Stress, Usual("40 MPa", "1000 MPa")] | None = None
    """Allowable tensile stress of the hub at speed."""

    @model_validator(mode="after")
    def _geometry(self) -> "SplineToothing":
        if (self.module is None) == (self.pitch_diameter is None):
            given = "neither" if self.module is None else "both"
            raise fault(
                f"{given} of module and pitch_diameter is given",
                'write one of the two, e.g. module = "2 mm"',
            )
        inner, outer = self.hub_root_diameter, self.hub_diameter
        if outer is not None and (inner is None or inner >= outer):
            raise fault(
                f"hub_diameter = {show(outer, 'length')} needs a hub_root_diameter inside of it",
                "write the root circle of the teeth of the hub, or leave hub_diameter out",
            )
        return self

    @property
    def reference_diameter(self) -> float:
        """Pitch diameter [m]."""
        return self.teeth * (self.module or 0.0) if self.pitch_diameter is None else self.pitch_diameter

    @property
    def contact_height(self) -> float:
        """Radial height over which the flanks touch [m]."""
        if self.working_depth is not None:
            return self.working_depth
        return WORKING_DEPTH * self.reference_diameter / self.teeth


class Spline(Part):
    """Spline-hub connection of a gear with its shaft."""

    torsional_stiffness: Annotated[TorsionalStiffness, Usual(1.6, 70.0, "stiffness of the shaft")]
    """Torque per angle of twist between gear and shaft."""
    torsional_damping: TorsionalDamping = 0.0
    """Torque per speed of twist between gear and shaft."""
    loss_factor: Share = 0.0
    """Friction between the teeth, instead of ``torsional_damping``: a cycle of twist dissipates pi times this factor
    times ``torsional_stiffness`` times the square of its amplitude, at any frequency. The loop has a viscous damper
    with the same loss at the mesh frequency of the gear at every speed."""
    radial_stiffness: LinearStiffness | None = None
    """Force per radial offset between gear and shaft, of shafts that bend; with ``axial_stiffness`` and
    ``angular_stiffness``, or none of the three for a gear that only twists against its shaft."""
    axial_stiffness: LinearStiffness | None = None
    """Force per axial travel between gear and shaft."""
    angular_stiffness: TorsionalStiffness | None = None
    """Moment per tilt between gear and shaft, about a diameter."""
    lateral_damping_time: float = Field(default=0.0, ge=0.0, le=1e-3)
    """Damping over stiffness of these three [s]."""
    toothing: Annotated[SplineToothing, Effect(checks=("gear seats",))] | None = None
    """Toothing of the spline, for the checks of its strength."""

    @model_validator(mode="after")
    def _one_damper(self) -> "Spline":
        if self.torsional_damping and self.loss_factor:
            raise fault(
                f"torsional_damping = {show(self.torsional_damping, 'torsional_damping')} and loss_factor = "
                f"{self.loss_factor:g} exclude each other",
                "write one of the two",
            )
        return self

    @model_validator(mode="after")
    def _whole_seat(self) -> "Spline":
        stated = {
            "radial_stiffness": self.radial_stiffness,
            "axial_stiffness": self.axial_stiffness,
            "angular_stiffness": self.angular_stiffness,
        }
        missing = [key for key, value in stated.items() if value is None]
        if missing and len(missing) < len(stated):
            raise fault(
                f"{' and '.join(missing)} of the seat missing: an elastic seat needs all three",
                "write all three, or none for a seat that is elastic in torsion only",
            )
        if self.lateral_damping_time and missing:
            raise fault(
                f"lateral_damping_time = {self.lateral_damping_time:g} is given without stiffness",
                "write radial_stiffness, axial_stiffness and angular_stiffness, or leave it out",
            )
        return self


Modification = Annotated[Small, Usual(4e-4, 0.02, "module")]
ReliefExponent = Annotated[float, Field(ge=0.5, le=6.0)]


class RackInput(Part):
    """Basic rack of the toothing, in modules (ISO 53 A: 1.0, 1.25, 0.38)."""

    addendum: Annotated[Positive, Usual(0.6, 1.6)] = 1.0
    """Addendum of the basic rack in normal modules."""
    dedendum: Annotated[Positive, Usual(0.8, 2.0)] = 1.25
    """Dedendum of the basic rack in normal modules."""
    tip_radius: Annotated[float, Usual(0.1, 0.6)] = Field(default=0.38, ge=0.0, le=0.6)
    """Fillet radius of the basic rack (tip radius of the tool) in normal modules."""
    protuberance: float = Field(default=0.0, ge=0.0, le=0.3)
    """s_pr in normal modules: undercut by a protuberance tool that is left once the flanks are finished."""
    protuberance_angle: Angle = radians(10.0)
    """Of the protuberance flank of that tool, above zero and below the normal pressure angle."""

    @model_validator(mode="after")
    def _radius_fits(self) -> "RackInput":
        if self.dedendum <= 0.2 or self.tip_radius >= self.dedendum:
            raise fault(
                f"a tip radius of {self.tip_radius} modules does not fit a dedendum of {self.dedendum}",
                "write a dedendum above the tip radius and above 0.2, e.g. 1.25 and 0.38",
            )
        return self


class TipEdgeInput(Part):
    """What is taken off the edge between flank and tip of a gear, in its transverse section; one of the two."""

    rounding: Small = 0.0
    """Radius of the edge."""
    chamfer: Small = 0.0
    """Radial height of a chamfer of 45 deg."""

    @model_validator(mode="after")
    def _one_of_two(self) -> "TipEdgeInput":
        if self.rounding and self.chamfer:
            raise fault(
                f"rounding = {show(self.rounding, 'length')} and chamfer = {show(self.chamfer, 'length')} exclude "
                "each other",
                "write one of the two",
            )
        return self


class PitchWave(Part):
    """Cumulative pitch that comes back several times a turn: amplitude cos(order angle - phase)."""

    order: int = Field(ge=1, le=1000)
    """Waves per turn of the gear; 1 is near to a run-out, without its change along the flank."""
    amplitude: Small
    """How far the teeth stand ahead and behind, along the line of action."""
    phase: Angle = 0.0
    """Angle of the wave at tooth 0."""


class WeakTooth(Part):
    """One tooth that gives way: cracked, or missing."""

    tooth: int = Field(default=0, ge=0, le=1999)
    """Number of the weak tooth, counted from 0."""
    stiffness: float = Field(default=1.0, ge=0.0, le=1.0)
    """Of the tooth pairs it is in, as a share of that of the others; 0 for a missing tooth, whose neighbours carry
    what it would."""


class FlankModification(Part):
    """Micro-geometry and deviations of one gear; everything is zero unless stated."""

    profile_crowning: Modification = 0.0
    """C_alpha: relief at tip and root against the middle of the profile."""
    lead_crowning: Modification = 0.0
    """C_beta: relief at both face ends against the middle."""
    lead_crowning_form: Literal["parabolic", "circular"] = "parabolic"
    """Parabola over the face width, or arc of a circle."""
    tip_relief: Modification = 0.0
    """C_a: relief at the tip edge."""
    tip_relief_length: Gap = 0.0
    """Radial height over which the tip relief grows."""
    tip_relief_exponent: ReliefExponent = 1.0
    """How it grows with the distance: 1 linear, 2 parabolic."""
    root_relief: Modification = 0.0
    """C_f: relief at the start of the active profile."""
    root_relief_length: Gap = 0.0
    """Radial height over which the root relief grows."""
    root_relief_exponent: ReliefExponent = 1.0
    """How it grows with the distance: 1 linear, 2 parabolic."""
    end_relief: Modification = 0.0
    """C_betaI, C_betaII: relief at the ends of the face."""
    end_relief_length: Gap = 0.0
    """Face width over which the end relief grows, at each end."""
    end_relief_exponent: ReliefExponent = 1.0
    """How it grows with the distance: 1 linear, 2 parabolic."""
    end_relief_at: Literal["both", "front", "rear"] = "both"
    """Ends of the face that are relieved; the rear end is the one that comes into mesh last."""
    profile_slope: Deviation = 0.0
    """f_Halpha over the active profile, positive where the tip stands out of the flank."""
    profile_slope_scatter: tuple[Deviation, ...] = ()
    """What the profile slope of each tooth has beyond ``profile_slope``, one entry per tooth; empty for equal teeth."""
    helix_slope: Deviation = 0.0
    """f_Hbeta over the face width, positive where the rear end is relieved."""
    twist: Deviation = 0.0
    """S_alpha: profile slope at the front end of the face less that at the rear end, the relief difference between the
    two diagonals of the flank; a quarter of it is the relief at the tip of the rear end. Intended, or measured."""
    manufacturing_twist: Share = 0.0
    """Share of the natural twist that the lead crowning of a helical gear brings: 1 when hobbed or ground by a worm at
    a changing centre distance, 0 when the grinding is free of twist. On top of ``twist``."""
    topography: Text | None = None
    """CSV file next to the case with the measured deviations of the front flanks over profile and face: a row of
    names, a row of units, one row for each place. Columns: roll_length, diameter or roll_angle; face from its middle to
    the rear end; removed (metal missing is positive) or deviation (metal standing out is positive); tooth from 0 where
    every tooth was measured. Replaces crownings, reliefs and twist of the gear."""
    back_topography: Text | None = None
    """The same of the back flanks, for the loaded contact of a mesh that runs on them. The analytic mesh law has one
    table for both and takes the front flanks for it."""
    topography_interpolation: Literal["bilinear", "bicubic"] = "bilinear"
    """Between the places of the topography; bicubic: cubic spline, at least 4 places each way."""
    run_out: Small = 0.0
    """F_r: total run-out; the eccentricity is half of it."""
    run_out_phase: Angle = 0.0
    """Angle of the tooth with the largest run-out."""
    single_pitch: tuple[Deviation, ...] = ()
    """Pitch deviation of each tooth, one entry per tooth; empty for an ideal pitch."""
    pitch_waves: tuple[PitchWave, ...] = ()
    """Waves of the cumulative pitch, on top of ``single_pitch``."""
    tooth_stiffness: tuple[float, ...] = ()
    """Stiffness of the pairs each tooth is in, as a share of that of a sound one, one entry per tooth."""
    weak_tooth: WeakTooth = WeakTooth()
    """One weak tooth, on top of ``tooth_stiffness``."""


class Gear(Part):
    """One gear: body, toothing of its own, and where it sits."""

    shaft: Name
    """Shaft on which it sits; ``GEARBOX_GEAR`` when left out."""
    teeth: Count = Field(ge=6, le=2000)
    """Number of teeth."""
    face_width: Annotated[Length, Usual(0.4, 2.5, "face width of its mate")]
    """Width of the toothing; of one half for a double-helical gear."""
    bore_diameter: Annotated[Gap, Usual(0.25, 4.0, "shaft diameter")] = 0.0
    """Bore of the gear body; zero for a gear that is cut into its shaft."""
    rim_thickness: Annotated[Length, Usual(1.0, 30.0, "module")] | None = None
    """Radial, of the rim under the root circle; the body is solid down to the bore when left out. Temperature field and
    centrifugal expansion take any body as solid."""
    web_thickness: Annotated[Length, Usual(0.5, 20.0, "module")] | None = None
    """Axial, of the web inside of the rim, in the middle of the face; as wide as the face when left out."""
    tip_edge: TipEdgeInput = TipEdgeInput()
    """Rounding or chamfer between flank and tip, where the active flank ends; sharp unless stated."""
    helix_hand: Literal["right", "left"] | None = None
    """Hand of the teeth of a single-helical gear; its partner has the other one, and so on through a train. With
    ``rotation`` of the gearbox it says which end of the face comes into mesh last; that at the rear of the housing when
    no gear of the train states one."""
    shaft_interference: Annotated[Small, Usual(1e-4, 3e-3, "shaft diameter")] = 0.0
    """Press fit: effective interference of the bore on its shaft at rest, on the diameter, whose stress the root of an
    idler holds as well. Zero for a seat without one. At 20 degC: its slip torque counts what a gear warmer than its
    shaft loses of it and a colder one gains, the stress in the root does not."""
    shaft_interference_minimum: Annotated[Small, Effect(checks=("gear seats",))] | None = None
    """The least that the tolerances of bore and shaft leave of ``shaft_interference``: what the slip torque of the
    press fit is computed with; the same when left out."""
    position: Gap | None = None
    """Distance of the middle of the face from the start of its shaft in the drivetrain."""
    seat_offset: Deviation = 0.0
    """Distance of the middle of the face from the middle of its seat on the shaft, positive towards the end of the
    shaft; the load acts on the shaft at the seat, on bending shafts with the moment of the offset."""
    profile_shift: Annotated[float, Usual(0.02, 1.2)] | None = Field(default=None, ge=-2.0, le=2.0)
    """x, in modules; give it for one gear of the pair, or ``profile_shift_split`` of the mesh. For both gears they
    have to agree with the centre distance."""
    tip_shortening: Annotated[Play, Usual(1e-6, 1.0, "module")] = 0.0
    """Radial cut of the tip cylinder; or ``contact_ratio`` of the mesh."""
    tooth_thinning: Annotated[Small, Usual(0.007, 0.12, "module")] = 0.0
    """Allowance of the normal tooth thickness that makes the backlash."""
    quality_grade: Annotated[int, Effect(checks=("gear rating",))] = Field(ge=1, le=11)
    """Flank tolerance class, ISO 1328-1:2013."""
    flank_roughness: Annotated[Small, Usual("0.06 um", "3 um"), COUPLED]
    """Arithmetic mean roughness Ra of the flanks."""
    material: Name
    """Built-in material or a name under ``materials``."""
    flank: FlankModification = FlankModification()
    """Modifications and deviations of the flanks."""
    inertia: Annotated[Inertia, Usual(0.3, 3.0, "inertia of a disc of its size")] | None = None
    """Polar inertia of the gear body; that of the bored disc, or of rim and web, when left out."""
    inertia_factor: Annotated[float, Usual(0.3, 3.0)] = Field(default=1.0, ge=0.1, le=10.0)
    """Times the inertia, stated or of the disc."""
    spline: Spline | None = None
    """Connection with the shaft; a gear without one is rigid with its shaft."""
    strain_gauges: Annotated[Mapping[Name, StrainGaugeInput], Effect(of_rig=False)] = {}
    """Strain gauges in the root of its teeth, by name."""

    @property
    def seat_position(self) -> float | None:
        """Distance of the middle of its seat from the start of its shaft [m]."""
        return None if self.position is None else self.position - self.seat_offset

    @model_validator(mode="after")
    def _seat(self) -> "Gear":
        if self.shaft_interference > 0.0 and self.bore_diameter == 0.0:
            raise fault("a press fit needs a seat", "write bore_diameter, or leave shaft_interference out")
        least = self.shaft_interference_minimum
        if least is not None and least > self.shaft_interference:
            raise fault(
                f"shaft_interference_minimum = {show(least, 'length', 'um')} is above shaft_interference = "
                f"{show(self.shaft_interference, 'length', 'um')}",
                "write the least interference below the effective one, or exchange them",
            )
        return self


class GearMesh(Part):
    """Two meshing gears of a gearbox."""

    pinion: Name
    """Gear at which torque and speed of the mesh are counted."""
    wheel: Name
    """The gear that the pinion meshes with."""
    normal_module: Length
    """Module in the normal section."""
    pressure_angle: PressureAngle
    """Normal pressure angle at the reference cylinder."""
    helix_angle: Annotated[HelixAngle, Usual("3 deg", "40 deg")] = 0.0
    """Helix angle at the reference cylinder, without sign; zero for spur gears."""
    centre_distance: Size
    """Working distance of the axes, as drawn."""
    axis_inclination: Deviation = 0.0
    """Deviation of the axes as made, in their common plane, over the narrower face width; positive where they open
    towards the rear. Mesh law and loaded contact have it; what the warm housing adds is computed for the contact."""
    axis_skew: Deviation = 0.0
    """The same across that plane: positive where the axis of the wheel, seen from the front, turns clockwise about that
    of the pinion towards the rear. With ``rotation`` of the gearbox it says which flanks it parts there."""
    rack: RackInput = RackInput()
    """Basic rack of both gears."""
    profile_shift_split: Literal["equal"] | None = None
    """How the sum of the profile shifts is shared when no gear states its own."""
    contact_ratio: float | None = Field(default=None, gt=0.5, lt=4.0)
    """Transverse contact ratio to which the tips named in ``tip_cut`` are shortened."""
    tip_cut: Literal["pinion", "wheel", "both"] | None = None
    """Gear whose tip is shortened until ``contact_ratio`` is met."""
    double_helical: bool = False
    """Two opposite helices; face widths and ``damping`` are those of one half."""
    carrying_halves: Literal[1, 2] = 2
    """Halves of a double-helical mesh that carry. 2: they share the torque, as a gear that floats lets them, and the
    loop has the springs, dampers and mass of both. 1: the loop has one of them, which carries the whole torque; unless
    the inertia of its gears is stated it is that of one half."""
    damping: Annotated[LinearDamping, Usual(0.015, 0.25, "critical damping of the mesh")] | None = None
    """Damping along the line of action at the mean mesh stiffness; or ``damping_ratio``."""
    damping_ratio: Annotated[float, Usual(0.015, 0.3)] | None = Field(default=None, gt=0.0, le=0.5)
    """Damping as a share of the critical one, c / (2 sqrt(k m_red)): k mean mesh stiffness, m_red both gear bodies
    reduced to the line of action."""
    damping_acts_on: Literal["relative_rotation", "contact_closing_rate"] = "relative_rotation"
    """relative_rotation: on the approach rate r_b1 omega_1 - r_b2 omega_2 while teeth touch; contact_closing_rate: on
    the rate at which each contact closes, so that tip corners that come in under steady load are damped as well."""
    stiffness_factor: Annotated[float, Usual(0.3, 3.0)] = Field(default=1.0, ge=0.1, le=10.0)
    """Times the stiffness of the tooth pairs, however that is found."""
    friction_factor: Annotated[float, Usual(0.3, 3.0)] = Field(default=1.0, ge=0.0, le=10.0)
    """Times the friction coefficient, in the loop and for the heat, on top of ``loss_factors.mesh`` of the gearbox."""
    tooth_offset: int = Field(default=0, ge=0, le=1999)
    """Teeth by which the wheel is put on further: tooth 0 of the pinion meets this tooth of the wheel."""
    application_factor: float = Field(default=1.0, ge=1.0, le=5.0)
    """K_A of ISO 6336: load from outside the gearbox over the nominal one."""
    face_load_factor: Annotated[float, Usual(1.0, 3.0), Effect(checks=("gear rating",), solved=())] = Field(
        default=1.0, ge=1.0, le=10.0
    )
    """K_Fbeta of ISO 6336-3: uneven load over the face width. K_Hbeta of the flanks follows from it. It counts where no
    loaded contact is computed (analytic teeth); where one is, its own K_Hbeta, K_Fbeta, K_Halpha and K_Falpha do."""
    phase: Share = 0.0
    """Where the pinion's teeth stand when all shafts stand at zero, as a share of a pitch; how the gears are put on
    their shafts decides it. A pinion in a second mesh of its gearbox counts from there on, by the place of its axes
    in the housing."""
    low_load_factor: bool = True
    """Reduce the tooth stiffness below 100 N/mm line load (ISO 6336-1)."""

    @property
    def sharing(self) -> int:
        """Halves that share its torque: 1 but for double-helical gears of which both carry."""
        return self.carrying_halves if self.double_helical else 1

    @model_validator(mode="after")
    def _tips(self) -> "GearMesh":
        if (self.contact_ratio is None) != (self.tip_cut is None):
            raise fault(
                "contact_ratio and tip_cut belong together",
                'write both, e.g. contact_ratio = 1.26 and tip_cut = "wheel", or neither',
            )
        if (self.damping is None) == (self.damping_ratio is None):
            given = "neither" if self.damping is None else "both"
            raise fault(
                f"{given} of damping and damping_ratio is given",
                'write one of the two, e.g. damping = "1000 N s/m" or damping_ratio = 0.06',
            )
        if self.pinion == self.wheel:
            raise fault("a gear cannot mesh with itself", "name two gears of the gearbox")
        return self
