"""Dynamic results of a run, as they stand in results.json."""

from dataclasses import dataclass, field
from typing import Annotated, Any

from rigdesign.results.check import Role
from rigdesign.results.loads import (
    ContactLoss,
    HeldBracing,
    JointDamping,
    ListedMode,
    MeshResonance,
    ModeCrossing,
    PressFitCapacity,
    RootStressRatio,
    SplineStress,
    StageLoad,
    TorqueBalance,
    UnsolvedSpeed,
)
from rigdesign.results.quantity import Quantity, Records
from rigdesign.results.teeth import PairShare
from rigdesign.results.vibration import HeldSpectrum, Waterfall


@dataclass(frozen=True, kw_only=True)
class DynamicFactorPoint:
    """K_V of one gearbox at one speed [rpm]; simulated = max/mean (P2, Formula 1)."""

    speed_rpm: float
    simulated: float
    simulated_half_peak_to_peak: float
    iso_6336_1_method_b: float
    method: str = ""
    """harmonic_balance or time_integration."""
    motion: str = "periodic"
    """periodic; subharmonic, quasi-periodic or chaotic where the motion does not repeat in every mesh."""
    other_branch: float | None = None
    """Simulated factor of a second stable response at this speed, to which the motion may jump; None without one."""


@dataclass(frozen=True, kw_only=True)
class RootStressHistory:
    """Root stress of one gear over its rolling angle at the held stage that stresses it most."""

    gear: str
    stage: str
    rolling_angle_deg: list[float]
    dynamic_MPa: list[float]  # noqa: N815
    quasi_static_MPa: list[float]  # noqa: N815
    source: str = ""
    """Where the stress per tooth force comes from: influence numbers or the factors of ISO 6336-3."""


@dataclass(frozen=True, kw_only=True)
class ToothTurnHistory:
    """Root stress of one tooth over a turn of its gear, and what it does to the strength."""

    gear: str
    """``gearbox.gear``"""
    stage: str
    meshes: list[str]
    rotation_deg: list[float]
    leading_MPa: list[float]  # noqa: N815
    """Fillet under the flank that faces the rotation, at its most stressed point; mean stress included."""
    trailing_MPa: list[float]  # noqa: N815
    """The same under the other flank."""
    mean_MPa: dict[str, float]  # noqa: N815
    """Held all the time: {centrifugal, press_fit, total}."""
    fillet: str
    """The one that is stressed more: ``leading`` or ``trailing``."""
    highest_MPa: float  # noqa: N815
    lowest_MPa: float  # noqa: N815
    R: float
    """Lowest over highest stress of that fillet."""
    Y_M: float
    """Mean stress influence factor of ISO 6336-3 at R."""
    rated: bool
    """Whether the root safety counts mean stress and Y_M: an idler that is bent both ways."""
    source: str


@dataclass(frozen=True, kw_only=True)
class GearboxDynamics:
    """Dynamic results of one mesh; speeds are those of its pinion."""

    role: Role
    torque: str
    """Torque of ``dynamic_factor`` where the case counts it, in words: ``180 Nm``."""
    dynamic_factor: list[DynamicFactorPoint]
    dynamic_factor_at: dict[str, list[DynamicFactorPoint]]
    """The same at the other torques at which the schedule holds or changes the speed (``90 Nm``)."""
    stage_loads: Records[StageLoad]
    """Of the time run, for every stage that turns under torque."""
    dynamic_torque_peak_Nm: float  # noqa: N815
    """Highest of the time run and the periodic responses of the held stages."""
    iso_factors: dict[str, float | str]
    """Every factor of ISO 6336-1 method B at the test speed, by its printed symbol."""
    lift_off: Records[ContactLoss]
    """Of the time run."""
    resonances: Records[MeshResonance]
    """Of all curves."""
    unsolved: Records[UnsolvedSpeed]
    root_stress: list[RootStressHistory]
    root_stress_factor: Records[RootStressRatio]
    """Over the speeds of ``dynamic_factor``, to compare with K_V(n)."""
    geometry: dict[str, float | str]
    """Gear data, as drawn and warm, for the report."""
    flank_ratings: list[dict[str, Any]] = field(default_factory=list)
    """Per held stage: {stage, K_H_beta, K_H_alpha, K_H_basis, sigma_H_pinion_MPa, S_H_pinion, sigma_H_wheel_MPa,
    S_H_wheel, bulk_degC, bulk_basis, contact_degC, contact_friction, scuffing_degC, S_B, film_ratio_least,
    film_ratio_at, film_ratio: {point: ratio}}; what is not rated is None."""
    loaded_contact: dict[str, Any] | None = None
    """Quasi-static contact of the warm teeth at the test, from influence numbers: {stage, torque_Nm, flank,
    misalignment_um (gap of the axes over the face, at its end that comes into mesh last),
    contact_ratio_geometric, contact_ratio_no_load, contact_ratio, largest_share, early_contact, late_contact,
    transmission_error_um, approach_um, mesh_stiffness_N_um, K_H_beta, line_load_N_mm, flank_pressure_MPa,
    edge_pressure_MPa, edge_contact: {where, tip_pressure_pinion_MPa, tip_pressure_wheel_MPa, tip_share,
    face_end_pressure_MPa, face_end_over_middle}, pattern: {rolling_angle_deg, face_mm, pressure_MPa, edge},
    root_stress: {pinion, wheel:
    {rolling_angle_deg, highest_MPa, mid_face_MPa, largest_MPa, at_face_mm, stress_ratio}}, strain_gauges: rows
    of the gauges}; None where the teeth are analytic or carry no torque."""

    @property
    def largest_dynamic_factor(self) -> Annotated[float | None, Quantity()]:
        """Of ``dynamic_factor``, simulated; None without a point."""
        return max((point.simulated for point in self.dynamic_factor), default=None)


@dataclass(frozen=True, kw_only=True)
class RampHistory:
    """Time run over the schedule, decimated for the report; envelopes keep the peaks at the internal rate."""

    time_s: list[float]
    speed_rpm: list[float]
    stage: list[str]
    target_torque_Nm: list[float]  # noqa: N815
    drive_torque_Nm: list[float]  # noqa: N815
    torque: dict[str, dict[str, list[float]]]
    """gearbox -> {mean, maximum, minimum} of the dynamic torque [Nm] in each time window."""


@dataclass(frozen=True, kw_only=True)
class DynamicsResult:
    """Everything the drivetrain says."""

    gearboxes: dict[str, GearboxDynamics]
    """By gearbox; by ``gearbox.mesh`` where a gearbox has several meshes."""
    natural_frequencies: Records[ListedMode]
    damping_audit: Records[JointDamping]
    sampling: dict[str, float]
    bracing: Records[HeldBracing]
    """Of every held stage."""
    ramp: RampHistory | None
    torque_balance: Records[TorqueBalance]
    """Of every held stage."""
    tooth_histories: list[ToothTurnHistory] = field(default_factory=list)
    """Of every loaded gear at the held stage that speaks for the rig."""
    loop_crossings: Records[ModeCrossing] = field(default_factory=Records)
    """Mesh orders that meet a mode of the closed loop which the mesh excites, and shaft orders that meet one."""
    campbell: dict[str, Any] | None = None
    """Modes of the closed loop over speed, bearings as they run there: {speed_rpm (of the first pinion), modes:
    [{mode, shape, driven_by, frequency_Hz, damping_ratio, gain: {gearbox}}], orders: [{kind, of, harmonic,
    per_turn}], crossings: [{mode, kind, of, harmonic, speed_rpm, frequency_Hz, damping_ratio, gain}],
    modes_left_out}; lists of modes run over speed_rpm, None where a mode is damped out."""
    section_torques: dict[str, Any] | None = None
    """Torque in every section of the shafts, joint and mesh, from the periodic responses: {held: [{place, kind, part,
    from_mm, to_mm, stage, speed_rpm, mean_Nm, half_peak_to_peak_Nm, peak_Nm, time_run_peak_Nm, shear_stress_MPa}],
    over_speed: {torque, speed_rpm, places: [{place, ..., mean_Nm, half_peak_to_peak_Nm, peak_Nm}]}, time_run: [{place,
    ..., stage, peak_Nm, shear_stress_MPa, half_peak_to_peak_Nm, mean_Nm, time_s, speed_rpm}]}; of a section where it is
    highest. Of the time run in every stage: highest torque, and the window in which it alternates most, read at every
    sample."""
    dynamic_root: dict[str, Any] | None = None
    """Root stress in motion over the rolling angle at the held stages and the speeds of numerics.root_stress_speeds:
    {curves: [{gearbox, gear, gauge (empty: the most stressed point), stage (empty: a speed asked for),
    pinion_speed_rpm, highest_MPa, highest_quasi_static_MPa, ratio, highest_strain_um_m, highest_strain_rate_per_s,
    rolling_angle_deg, dynamic_MPa, quasi_static_MPa, strain_um_m, strain_rate_per_s, source}], missing: [{speed_rpm,
    reason}]}."""
    dwell: dict[str, Any] | None = None
    """Speeds to avoid and the recommended ramp, pinion speeds: {share_limit, shaft_share_limit, margin, low_rpm,
    high_rpm, bands: [{low_rpm, high_rpm, resonances: [{kind, where, speed_rpm, share, low_rpm, high_rpm}]}],
    safe: [{low_rpm, high_rpm}], stages: [{stage, kind, speed_rpm, computed, band, nearest_safe_rpm}], ramp: [{step,
    action, speed_rpm, torque_Nm, reason}], highest: {speed_rpm, kind: share over speed}}."""
    waterfalls: Records[Waterfall] = field(default_factory=Records)
    """Spectrum of the mesh torque over run-up and run-down, from the time run; empty where no torque is kept."""
    spectra: Records[HeldSpectrum] = field(default_factory=Records)
    """At the held stages."""
    pair_shares: Records[PairShare] = field(default_factory=Records)
    """Load on a tooth pair at the held stages."""
    press_fits: Records[PressFitCapacity] = field(default_factory=Records)
    """Of every gear with an interference at every torque that its check counts, of held stages, time run and events."""
    splines: Records[SplineStress] = field(default_factory=Records)
    """Of every gear whose spline states its toothing at every torque that its checks count, each stress with an
    allowable one."""
