"""Limits the results are held against; a limit that is left out makes its check not applicable."""

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field, model_validator

from dynamics.standards.api617_2014 import LEAST_DECREMENT, MOST_CLEARANCE_SHARE, TORSIONAL_SEPARATION
from rigdesign.base import units
from rigdesign.case.fields import (
    RESONANCE_LIMIT,
    Deviation,
    Effect,
    Flow,
    Hours,
    Name,
    Part,
    Play,
    Positive,
    Power,
    Share,
    Small,
    Speed,
    Stress,
    Temperature,
    TemperatureDifference,
    Text,
    Tilt,
    Title,
    Torque,
    Usual,
    fault,
)


class ClearanceLimits(Part):
    """Play that must be left hot."""

    seal_gap_minimum: Annotated[Play, Usual(0.1, 1.2, "seal gap")] | None = None
    """Least warm radial gap of a seal without contact."""
    axial_play_minimum: Annotated[Deviation, Usual(0.06, 1.2, "axial play")] | None = None
    """Least warm axial play of a shaft between its stops; negative where a preload is allowed."""
    backlash_minimum: Annotated[Play, Usual(0.06, 2.5, "tooth thinning")] | None = None
    """Least warm backlash, transverse at the working pitch circle."""
    tip_clearance_minimum: Annotated[Play, Usual(0.04, 0.4, "module")] | None = None
    """Least warm clearance between the tip of a gear and the root of its partner."""
    bearing_clearance_minimum: Annotated[Play, Usual(0.1, 1.2, "bearing clearance")] | None = None
    """Least warm diametral clearance of a plain bearing."""


class AlignmentLimits(Part):
    """How far axes and bores may leave their drawing when hot; couplings carry limits of their own."""

    bearing_tilt_maximum: Annotated[Tilt, Usual("0.05 mrad", "2.5 mrad")] | None = None
    """Most tilt of a shaft axis in a bearing bore."""
    bore_out_of_round_maximum: Annotated[Share, Usual(0.03, 0.9)] | None = None
    """Peak to valley of the bore radius as a share of the hot radial clearance."""
    axis_inclination_maximum: Annotated[Small, Usual(1e-5, 3e-3, "face width")] | None = None
    """In-plane deviation of the axes of a mesh over the face width."""
    axis_skew_maximum: Annotated[Small, Usual(1e-5, 3e-3, "face width")] | None = None
    """Out-of-plane deviation of the axes of a mesh over the face width."""


class TemperatureLimits(Part):
    """Temperatures that must not be passed."""

    housing_maximum: Temperature | None = None
    """Most at the hottest place of a housing."""
    bearing_film_maximum: Temperature | None = None
    """Most of the lubricant film of a plain bearing."""
    rolling_bearing_maximum: Temperature | None = None
    """Most of a rolling bearing; 120 degC, up to which its rings keep their size, when left out."""
    oil_outlet_maximum: Temperature | None = None
    """Most of any oil that leaves a gearbox."""
    tempering_distance_minimum: Annotated[TemperatureDifference, Usual("3 K", "150 K")] | None = None
    """Distance of the gear bulk temperature below the tempering temperature of its material."""


class OilLimits(Part):
    """What pump, cooler and room can take."""

    flow_maximum: Annotated[Flow, Usual(0.5, 8.0, "oil fed")] | None = None
    """Most oil that the pumps feed to the whole rig."""
    cooler_power_maximum: Annotated[Power, Usual(0.01, 0.8, "circulating power")] | None = None
    """Most heat that the cooler takes out of the oil."""
    heater_power_maximum: Annotated[Power, Usual(8e-4, 0.08, "circulating power")] | None = None
    """Most heat that the heaters give to all circuits whose oil comes back colder than it went."""
    room_heat_maximum: Annotated[Power, Usual(8e-4, 0.08, "circulating power")] | None = None
    """Most heat that the rig may give to its room."""


class BearingLimits(Part):
    """Journal bearings and rolling bearings."""

    start_torque_limit: (
        Annotated[
            Torque, Usual(0.01, 0.4, "test torque"), Effect(checks=("start torque",), solved=("curves",))
        ]
        | None
    ) = None
    """Most torque below the transition speed."""
    film_thickness_minimum: Annotated[Play, Usual(2e-5, 1e-3, "smallest bearing")] | None = None
    """Least oil film of a journal bearing at a held stage."""
    specific_load_maximum: Annotated[Stress, Usual("1.5 MPa", "15 MPa")] | None = None
    """Most radial load over diameter times width."""
    rating_life_minimum: Hours | None = None
    """Least modified rating life of a rolling bearing; the planned test time when left out."""
    static_safety_minimum: Annotated[Positive, Usual(0.5, 5.0)] = 1.5
    """Least static safety of a rolling bearing: of usual operation 1 with balls and 1.5 with rollers (ISO 76, guide
    values)."""
    operating_clearance_minimum: Deviation = 0.0
    """Least radial internal clearance of a rolling bearing as it runs, of those without contact angle; negative where a
    preload is allowed."""
    operating_clearance_maximum: Deviation | None = None
    """Most radial internal clearance of a rolling bearing as it runs."""


class DynamicsLimits(Part):
    """Additional dynamic load."""

    dynamic_factor_maximum: Annotated[float, Field(gt=1.0), Usual(1.02, 4.0)] | None = None
    """K_V at the held stages, max over mean."""
    resonance_distance_minimum: Annotated[Share, Usual(0.012, 0.6), RESONANCE_LIMIT] | None = None
    """Distance of a speed at which the rig dwells from a dangerous resonance of meshes, shafts and joints, as a share
    of that speed; the bands that the recommended ramp avoids have it too."""
    dangerous_amplification: Annotated[Positive, Usual(1.1, 8.0), RESONANCE_LIMIT] = 2.0
    """A resonance is dangerous above this amplification of the mesh force, or above ``dangerous_force_share``."""
    dangerous_force_share: Annotated[Positive, Usual(0.03, 1.5), RESONANCE_LIMIT] = 0.2
    """A resonance is dangerous above this dynamic mesh force as a share of the mean one."""
    lift_off_share_maximum: Share | None = None
    """Share of time without tooth contact in a loaded stage."""
    orbit_share_maximum: Annotated[Positive, Usual(0.2, 1.0)] = MOST_CLEARANCE_SHARE
    """Most peak-to-peak motion once a turn in an oil film over its diametral clearance; API 617 has 0.75."""
    logarithmic_decrement_minimum: Annotated[Positive, Usual(0.03, 0.9)] = LEAST_DECREMENT
    """Least logarithmic decrement of lateral modes up to the speed of the fastest shaft, with the torque and without;
    API 617 has 0.1."""
    lateral_separation_minimum: Annotated[Positive, Usual(0.5, 3.0)] = 1.0
    """Least distance of critical speeds from held speeds over that which API 617 asks for at their amplification."""
    torsional_separation_minimum: Annotated[Share, Usual(0.03, 0.5)] = TORSIONAL_SEPARATION
    """Least distance of torsional modes from once and twice a turn, as a share of that frequency; API 617 has 0.1."""
    contact_margin_minimum: Annotated[Share, Usual(0.02, 0.8)] | None = None
    """Least torque in a loaded stage as a share of the mean: what is left for errors the teeth of the model lack."""


class StrengthLimits(Part):
    """Safety of the gears that belong to the rig."""

    root_safety_minimum: Annotated[Positive, Usual(0.8, 4.0)] | None = None
    """Least safety S_F against tooth breakage, ISO 6336-3."""
    press_fit_safety_minimum: Annotated[Positive, Usual(0.8, 4.0)] = 1.2
    """Least safety of the press fits of gears against slip, hot and at speed: 1.2 as is usual with DIN 7190-1; not
    verified against its text."""
    shaft_shear_maximum: Annotated[Stress, Usual("20 MPa", "600 MPa")] | None = None
    """Highest nominal torsional stress of a shaft section at its surface in stages and events, without notch factor."""
    spline_safety_minimum: Annotated[Positive, Usual(0.8, 4.0)] = 1.0
    """Least allowable stress of a spline over its stress; the allowable stresses of the case carry the safety."""


class FlankLimits(Part):
    """Load capacity of the flanks."""

    pitting_safety_minimum: Annotated[Positive, Usual(0.8, 4.0)] | None = None
    """Least safety S_H against pitting of the gears of the rig itself, ISO 6336-2."""
    scuffing_safety_minimum: Annotated[Positive, Usual(0.8, 4.0)] | None = None
    """Least safety S_B against scuffing of every mesh, flash temperature method of ISO/TS 6336-20."""
    film_ratio_minimum: Annotated[Positive, Usual(0.05, 2.5)] | None = None
    """Least film over roughness lambda_GF of every mesh, ISO/TS 6336-22. What an oil needs against micropitting its FZG
    test C-GF/8.3/90 says."""
    contact_pressure_maximum: Annotated[Stress, Usual(0.4, 2.5, "flank strength")] | None = None
    """Most pressure on the flanks of a mesh in the loaded contact, away from tip edges; the pitting stress limit over
    ``pitting_safety_minimum`` for gears of the rig when left out."""
    edge_pressure_maximum: Annotated[Stress, Usual(0.4, 4.0, "flank strength")] | None = None
    """Most pressure at a tip edge in the loaded contact of a mesh; not held when left out."""
    flank_over_root_minimum: Annotated[Positive, Usual(0.8, 4.0)] | None = None
    """Least load that the flanks carry, those of specimens and those of the rig, over what the root of the weakest
    specimen carries: of tests that are to end with a broken tooth."""


class GeometryLimits(Part):
    """Toothing as drawn, held before anything is solved; lengths in normal modules. Usual practice, by no standard but
    where one is named."""

    tip_thickness_minimum: Positive = 0.2
    """Least thickness at the tip circle; 0.4 is usual for case-hardened teeth."""
    root_clearance_minimum: Positive = 0.1
    """Least clearance between a tip and the root of its mate; ISO 53 has 0.25."""
    fillet_distance_minimum: float = 0.0
    """Least distance of the fillet from the path of the mating tip, along the line of action."""
    undercut_distance_minimum: float = -0.17
    """Least profile shift less that at which undercut begins: 14 teeth without shift instead of 17 at 20 deg."""
    contact_ratio_minimum: Positive = 1.1
    """Least transverse contact ratio; of meshes with an overlap ratio from 1 on the total one."""
    profile_shift_sum_maximum: Positive = 1.5
    """Most sum of the two profile shifts of a mesh, without its sign."""


class SpecimenWindow(Part):
    """What the test gears are meant to see."""

    root_stress_minimum: Annotated[Stress, Usual(0.1, 1.0, "root_stress_maximum")] | None = None
    """Lower end of the window of the root stress of specimens."""
    root_stress_maximum: Annotated[Stress, Usual(0.2, 2.0, "root strength")] | None = None
    """Upper end of the window of the root stress of specimens."""
    load_cycles_minimum: Annotated[Positive, Usual(0.15, 1.5, "turns of the planned test")] | None = None
    """Load cycles that every tooth of a specimen has to see in the planned time."""

    @model_validator(mode="after")
    def _window_open(self) -> "SpecimenWindow":
        low, high = self.root_stress_minimum, self.root_stress_maximum
        if (low is None) != (high is None):
            raise fault("a window needs both ends", "write root_stress_minimum and root_stress_maximum")
        if low is not None and high is not None and low >= high:
            raise fault("root_stress_minimum is not below root_stress_maximum", "exchange or correct them")
        return self


class RampRules(Part):
    """Rules of the run-up (P2, Figure 9)."""

    standstill_torque: Annotated[Torque, Usual(0.01, 0.4, "test torque")] | None = None
    """Least torque at which the speed may rise from standstill."""
    transition_speed: Annotated[Speed, Usual(0.055, 0.6, "test speed")] | None = None
    """Speed from which the journal bearings run on a full film."""
    run_up_torque_share_maximum: Share | None = None
    """Most torque between transition and test speed, as a share of the test torque."""


ResultQuantity = Literal[
    "torque_peak",
    "torque_mean",
    "speed",
    "drive_torque",
    "drive_power",
    "actuator_force",
    "shift_travel",
    "circulating_power",
    "seal_surface_velocity",
    "shaft_growth",
    "oil_flow",
    "temperature_maximum",
]
RESULT_KINDS: Mapping[ResultQuantity, str] = {
    "torque_peak": "torque",
    "torque_mean": "torque",
    "speed": "speed",
    "drive_torque": "torque",
    "drive_power": "power",
    "actuator_force": "force",
    "shift_travel": "length",
    "circulating_power": "power",
    "seal_surface_velocity": "velocity",
    "shaft_growth": "length",
    "oil_flow": "flow",
    "temperature_maximum": "temperature",
}
"""Kind of quantity of each result that a bought part may be held against."""


PASSED = ("drivetrain.couplings.", "drivetrain.shafts.")
"""Parts that the torque of the events passes through."""


class BoughtPart(Part):
    """Limit of a bought part: a result or a given value held below what its maker allows."""

    title: Title
    """Name of the limit in the report."""
    part: Text
    """Case path of the part it belongs to, e.g. ``drivetrain.couplings.pinion_side``."""
    quantity: ResultQuantity
    """Which result is held against the limit."""
    given: str | None = None
    """The value, when it does not come from the run."""
    limit: str
    """Limit of its maker, a quantity with unit of the kind of ``quantity``."""
    overload: str | None = None
    """Of a coupling, torque flange or shaft with ``torque_peak``: highest torque it withstands in an event such
    as a tooth loss; ``limit`` when left out."""
    source: Text
    """Where the limit is printed, e.g. the data sheet."""

    @model_validator(mode="after")
    def _quantities(self) -> "BoughtPart":
        for key in ("limit", "given", "overload"):
            text = getattr(self, key)
            if text is not None:
                try:
                    units.parse(text, RESULT_KINDS[self.quantity])
                except units.QuantityError as error:
                    raise fault(f"{key}: {error.problem}", error.remedy) from None
        if self.overload is not None:
            self._overload(self.overload)
        return self

    def _overload(self, overload: str) -> None:
        """An overload counts in the events alone, for the torque of parts that it passes through."""
        if self.quantity != "torque_peak":
            raise fault(
                f"overload = {overload} is given of {self.quantity}: it counts for torque_peak only",
                "leave it out",
            )
        if not self.part.startswith(PASSED):
            raise fault(
                f"overload = {overload} is given of {self.part}: it counts for couplings and shafts only, through "
                "which the torque of the events passes",
                f"leave it out, or write a part of {' or '.join(PASSED)}",
            )
        if self.given is not None:
            raise fault(
                f"overload = {overload} is given beside given = {self.given}, which no event changes",
                "leave one out",
            )
        if self.overload_si < self.limit_si:
            raise fault(f"overload = {overload} is below limit = {self.limit}", "correct one of them")

    @property
    def kind(self) -> str:
        """Kind of quantity of value and limit."""
        return RESULT_KINDS[self.quantity]

    @property
    def limit_si(self) -> float:
        """The limit in SI."""
        return units.parse(self.limit, self.kind)

    @property
    def overload_si(self) -> float:
        """What it withstands in an event in SI: ``overload``, or the limit."""
        return self.limit_si if self.overload is None else units.parse(self.overload, self.kind)

    @property
    def given_si(self) -> float | None:
        """The given value in SI, if there is one."""
        return None if self.given is None else units.parse(self.given, self.kind)


class Limits(Part):
    """All limits of the rig; a case without any is held against the standard set, listed as assumptions."""

    standard_set: bool = False
    """Whether limits that are left out here are those of the standard set; a case without limits has all of it."""
    clearances: ClearanceLimits = ClearanceLimits()
    """Limits of warm clearances."""
    alignment: AlignmentLimits = AlignmentLimits()
    """Limits of axes and bores."""
    temperatures: TemperatureLimits = TemperatureLimits()
    """Limits of the temperatures of housing, films, oil and gears."""
    oil: OilLimits = OilLimits()
    """Limits of the oil plant and the room."""
    bearing: BearingLimits = BearingLimits()
    """Limits of the bearings."""
    dynamics: DynamicsLimits = DynamicsLimits()
    """Limits of the additional dynamic load and of resonances."""
    strength: Annotated[StrengthLimits, Effect(checks=("strength limits",))] = StrengthLimits()
    """Least safeties of the gears of the rig itself."""
    flanks: FlankLimits = FlankLimits()
    """Least load capacity of the flanks."""
    geometry: GeometryLimits = GeometryLimits()
    """Limits of the toothing as drawn."""
    specimen: Annotated[SpecimenWindow, Effect(checks=("specimen limits",))] = SpecimenWindow()
    """Window of the test gears."""
    ramp: Annotated[RampRules, Effect(checks=("ramp limits",))] = RampRules()
    """Rules of the run-up."""
    bought_parts: Mapping[Name, BoughtPart] = {}
    """Limits of bought parts by name."""
