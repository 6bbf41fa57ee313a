"""What a run returns: immutable records, named as they stand in results.json."""

from dataclasses import asdict, dataclass, field
from difflib import get_close_matches
from html import escape
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex, get_args, overload

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.errors import MissingLibraryError
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.results.ranges import RangesResult
from rigdesign.results.transient import TransientResult
from rigdesign.results.verdict import Verdict
from thermal.fe.mesh import NamedMesh

if TYPE_CHECKING:
    import pandas

Role = Literal["specimen", "rig"]


@dataclass(frozen=True, kw_only=True)
class Check:
    """One design rule held against the result.

    ``margin`` is the distance to the limit in the unit of the value, positive when held; ``utilisation`` is
    the share of the limit used up, 1 at the limit. Both are None when the rule is not applicable.
    """

    id: str
    title: str
    value: float | None
    limit: float | None
    unit: str
    comparison: Literal["<=", ">=", "within"]
    margin: float | None
    utilisation: float | None
    verdict: Verdict
    source: str
    role: Role
    reason: str = ""
    group: str = ""
    """Section of the report, as the rule of the check states it."""
    upper_limit: float | None = None
    """Second limit of a window (comparison ``within``)."""
    assumptions: tuple[str, ...] = ()
    """Case paths of the assumptions the value depends on."""
    left_out: tuple[str, ...] = ()
    """Known contributors that the value does not count: the check is at best a warning, unless they are small."""
    discretisation_error: float | None = None
    """How far the value may be from that of an infinitely fine housing mesh, in its unit; None where no housing
    mesh enters, or where there is no coarser one to tell."""


class Checks(list[Check]):
    """The checks of a run in the order of the report, by number or by id: ``checks["oil.room"]``."""

    @overload
    def __getitem__(self, key: SupportsIndex) -> Check: ...
    @overload
    def __getitem__(self, key: slice) -> list[Check]: ...
    @overload
    def __getitem__(self, key: str) -> Check: ...
    def __getitem__(self, key: SupportsIndex | slice | str) -> Check | list[Check]:
        """A check; KeyError names the nearest ids for one that is none."""
        if not isinstance(key, str):
            return super().__getitem__(key)
        found = next((check for check in self if check.id == key), None)
        if found is None:
            near = get_close_matches(key, [check.id for check in self], n=3, cutoff=0.4)
            raise KeyError(f"no check {key!r}; the nearest are {', '.join(near) or 'none'}")
        return found


@dataclass(frozen=True, kw_only=True)
class DynamicFactorPoint:
    """K_V of one gearbox at one speed [rpm]; simulated = max/mean (P2, Formula 1)."""

    speed_rpm: float
    simulated: float
    simulated_half_peak_to_peak: float
    iso_6336_1_method_b: float
    method: str = ""
    """harmonic_balance or time_integration."""


@dataclass(frozen=True, kw_only=True)
class RootStressHistory:
    """Root stress of one gear over its rolling angle at the held stage that stresses it most."""

    gear: str
    stage: str
    rolling_angle_deg: list[float]
    dynamic_MPa: list[float]  # noqa: N815
    quasi_static_MPa: list[float]  # noqa: N815


@dataclass(frozen=True, kw_only=True)
class GearboxDynamics:
    """Dynamic results of one mesh; speeds are those of its pinion."""

    role: Role
    torque: str
    """Torque of ``dynamic_factor`` where the case counts it, in words: ``180 Nm``."""
    dynamic_factor: list[DynamicFactorPoint]
    dynamic_factor_at: dict[str, list[DynamicFactorPoint]]
    """The same at the other torques at which the schedule holds or changes the speed (``90 Nm``)."""
    dynamic_factor_variants: dict[str, list[DynamicFactorPoint]]
    """The curve of ``dynamic_factor`` under a named variant of the mesh law (``weber_banaschek_0.8``)."""
    stage_loads: list[dict[str, Any]]
    """Time run, per stage that turns under torque: {stage, dynamic_factor, speed_rpm, mean_Nm, peak_Nm, least_Nm,
    least_share, least_share_at_rpm, least_share_mean_Nm}."""
    dynamic_torque_peak_Nm: float  # noqa: N815
    """Highest of the time run and the periodic responses of the held stages."""
    iso_factors: dict[str, float | str]
    """Every factor of ISO 6336-1 method B at the test speed, by its printed symbol."""
    lift_off: list[dict[str, Any]]
    """{stage, start_s, end_s, share} intervals without tooth contact."""
    resonances: list[dict[str, Any]]
    """{torque, mode, frequency_Hz, harmonic, speed_rpm, dynamic_factor, force_share, amplification, at_end,
    dangerous}; at_end: the torque still rises at the highest speed computed."""
    unsolved: list[dict[str, Any]]
    """{curve, speed_rpm, reason}: speeds at which a curve has no point because no periodic response was found."""
    root_stress: list[RootStressHistory]
    root_stress_factor: list[dict[str, float]]
    """{speed_rpm, pinion, wheel}: max sigma_F dynamic / quasi-static, to compare with K_V(n)."""
    geometry: dict[str, float | str]
    """Gear data, as drawn and warm, for the report."""


@dataclass(frozen=True, kw_only=True)
class RampHistory:
    """Time run over the schedule, decimated for the report; envelopes keep the peaks at the internal rate."""

    time_s: list[float]
    speed_rpm: list[float]
    stage: list[str]
    target_torque_Nm: list[float]  # noqa: N815
    drive_torque_Nm: list[float]  # noqa: N815
    torque: dict[str, dict[str, list[float]]]
    """gearbox -> {mean, maximum, minimum} of the dynamic torque [Nm] in each time slot."""


@dataclass(frozen=True, kw_only=True)
class DynamicsResult:
    """Everything the drivetrain says."""

    gearboxes: dict[str, GearboxDynamics]
    """By gearbox; by ``gearbox.mesh`` where a gearbox has several meshes."""
    natural_frequencies: list[dict[str, Any]]
    """{mode, frequency_Hz, damping_ratio, shape, largest_at}: modes of the closed loop, meshes at their mean
    stiffness; shape: parts that hold the strain energy; largest_at: shaft and place that swing most; mode 0 turns
    without swinging."""
    shaft_frequencies: dict[str, list[float]]
    """Free-free torsional frequencies [Hz] of each isolated shaft."""
    crossings: list[dict[str, Any]]
    """{gearbox, shaft, frequency_Hz, harmonic, speed_rpm}: of the isolated shafts."""
    damping_audit: list[dict[str, Any]]
    """{joint, damping_ratio, corner_frequency_Hz, warning}."""
    sampling: dict[str, float]
    bracing: list[dict[str, Any]]
    """Per stage: {stage, mode, torque_Nm, twist_deg, axial_shift_mm, half_gear_rotation_deg,
    actuator_force_N, torque_cold_Nm, torque_hot_Nm}."""
    ramp: RampHistory | None
    torque_balance: list[dict[str, Any]]
    loop_crossings: list[dict[str, Any]] = field(default_factory=list)
    """{kind, order_of, mode, shape, frequency_Hz, damping_ratio, harmonic, speed_rpm, gain, excited}: mesh and shaft
    orders that meet a mode of the closed loop; order_of: gearbox or shaft, speed_rpm that of its pinion or its own;
    excited: the mesh reaches the mode."""


@dataclass(frozen=True, kw_only=True)
class LossRow:
    """Power loss of one place at one stage [W]; into_oil + into_body + not_heat = power + pump."""

    place: str
    kind: str
    stage: str
    power_W: float  # noqa: N815
    into_oil_W: float  # noqa: N815
    into_body_W: float  # noqa: N815
    pump_W: float = 0.0  # noqa: N815
    """Given by the oil pump, not by the shaft: kinetic energy of the jets. A negative ``power_W`` with it is what a
    jet faster than the pitch line gives to the shaft."""
    basis: Literal["computed", "input"]
    not_heat_W: float = 0.0  # noqa: N815
    """Work of a mesh damper: power of the motor that is heat of no part."""
    details: dict[str, float | str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class OilRow:
    """One oil consumer at one stage."""

    consumer: str
    stage: str
    inlet_degC: float  # noqa: N815
    outlet_degC: float  # noqa: N815
    flow_l_min: float
    heat_W: float  # noqa: N815
    """Loss into the oil plus heat taken from bodies."""


@dataclass(frozen=True, kw_only=True)
class HeatRow:
    """Heat of one surface [W], positive into the solid."""

    surface: str
    kind: str
    power_W: float  # noqa: N815
    area_m2: float
    mean_temperature_degC: float  # noqa: N815
    coefficient: dict[str, Any] | None = None
    """Film coefficient with formula, inputs, range, source."""


@dataclass(frozen=True, kw_only=True)
class HeatSplitRow:
    """Where the friction heat of one gear goes; friction = at once into the oil + into the rim."""

    gear: str
    rule: Literal["assumed", "flank_film"]
    friction_W: float  # noqa: N815
    """Of all its meshes, into its flanks."""
    at_once_W: float  # noqa: N815
    """Leaves with the oil before it reaches the rim."""
    film_W: float  # noqa: N815
    """From the rim into the gear oil; other heat of the gear leaves this way too."""
    share_into_oil: float
    """(at once + film) / friction; above 1 where other heat of the gear leaves through its teeth."""
    share_into_bodies: float
    bulk_degC: float  # noqa: N815
    """Mean of the gear body."""
    tooth_degC: float | None  # noqa: N815
    """Mean of the teeth; None without a flank film."""
    flank_film_W_m2K: float | None  # noqa: N815
    """Mean over all flanks."""
    fin_efficiency: float | None
    weak_film: dict[str, float | None] | None = None
    """share_into_oil, bulk_degC, tooth_degC, flank_film_W_m2K at the low ends of the ranges of the film."""
    strong_film: dict[str, float | None] | None = None
    """The same at the high ends."""


@dataclass(frozen=True, kw_only=True)
class ThermalResult:
    """Steady temperatures of one gearbox at one held stage."""

    gearbox: str
    stage: str
    max_temperature_degC: float  # noqa: N815
    max_temperature_body: str
    heat: list[HeatRow]
    closure_relative: float
    nodes: int
    elements: int
    bodies: dict[str, dict[str, float]]
    """body -> {mean_degC, max_degC, min_degC}."""
    room_heat_W: float  # noqa: N815
    alternatives: dict[str, float]
    """Highest temperature under either reading of radiation, heat to the room under the one not taken."""
    heat_split: list[HeatSplitRow] = field(default_factory=list)
    """Of the friction heat of every gear."""


@dataclass(frozen=True, kw_only=True)
class ExpansionResult:
    """Expansion of one gearbox at one held stage; every entry as drawn (``cold``) and warm (``hot``), with its
    unit."""

    gearbox: str
    stage: str
    seal_gaps: list[dict[str, Any]]
    """{seal, shaft, cold_mm, hot_min_mm, hot_mean_mm, angle_of_min_deg, hot_mm: [...], angle_deg: [...]}"""
    shafts: list[dict[str, Any]]
    """{shaft, growth_mm, axial_play_cold_mm, axial_play_hot_mm, free_expansion_mm}"""
    gears: list[dict[str, Any]]
    """{gear pair, centre_distance_cold_mm, centre_distance_hot_mm, backlash_cold_mm, backlash_hot_mm,
    tip_clearance_cold_mm, tip_clearance_hot_mm, bulk_pinion_degC, bulk_wheel_degC}"""
    bearings: list[dict[str, Any]]
    """{bearing, diametral_clearance_cold_um, diametral_clearance_hot_um}"""
    bores: list[dict[str, Any]] = field(default_factory=list)
    """{bearing, tilt_mrad, tilt_lateral_mrad, tilt_vertical_mrad, tilt_over_width_um, out_of_round_um,
    second_harmonic_um, long_axis_deg, out_of_round_share}: shaft axis in the bore, bore round; as drawn all are
    zero."""
    axes: list[dict[str, Any]] = field(default_factory=list)
    """{gear_pair, centre_distance_change_um, face_width_mm, inclination_um, recommended_inclination_um, skew_um,
    recommended_skew_um}: axes of a mesh over its face width; as drawn they are parallel."""
    couplings: list[dict[str, Any]] = field(default_factory=list)
    """{coupling, first, second, offset_cold_mm, offset_hot_mm, lateral_hot_mm, vertical_hot_mm, angle_cold_mrad,
    angle_hot_mrad, ends_nearer_mm, recommended_cold_lateral_mm, recommended_cold_vertical_mm}: first shaft against
    second; a shaft without a housing stays where it was set."""


@dataclass(frozen=True, kw_only=True)
class DiscretisationRow:
    """How far a number is from that of an infinitely fine mesh."""

    quantity: str
    """A number of one gearbox at the governing stage, or the id of a check."""
    gearbox: str
    """Empty for a check, which takes the worst place of all."""
    stage: str
    """Empty for a check."""
    value: float
    error: float
    """Estimated size of the error in the unit of the value."""
    unit: str
    method: str
    order: float | None
    """Order of convergence behind the estimate; None where none was used."""


@dataclass(frozen=True, kw_only=True)
class MeshShift:
    """What the fine mesh changes in the value of one check."""

    id: str
    standard: float
    reference: float
    shift: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class CouplingHistory:
    """Residuals of every iteration of the coupling loop of one stage."""

    stage: str
    iterations: int
    residuals: list[dict[str, float]]
    """{temperature_K, growth_um, torque_relative} by iteration."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A warning of the tool's own: a result, never a Python warning."""

    id: str
    text: str


@dataclass(frozen=True)
class TemperatureField:
    """Temperature, displacement and heat flux of one gearbox at one stage, for pictures and .vtu."""

    gearbox: str
    stage: str
    mesh: NamedMesh
    temperature: NDArray[np.float64]
    """(n_nodes,) [K]"""
    displacement: NDArray[np.float64]
    """(n_nodes, 3) [m]"""
    heat_flux: NDArray[np.float64] | None = None
    """(n_nodes, 3) [W/m2]"""


@dataclass(frozen=True, kw_only=True, repr=False)
class RunResult:
    """Result of `rigdesign.run_case`; all of it but ``fields`` goes into results.json."""

    case: dict[str, str]
    """{name, path, hash, title}"""
    fidelity: str
    verdict: Literal["pass", "warn", "fail"]
    checks: Checks
    dynamics: DynamicsResult | None
    losses: list[LossRow]
    oil: list[OilRow]
    cooler: list[dict[str, float | str]]
    """Per held stage {stage, losses_W, pump_W, heater_W, cooler_W, room_W, not_heat_W, open_W, flow_l_min}: losses of
    the shafts, jets of the pump and heaters put in what cooler and room take out; losses that are no heat stand
    apart."""
    thermal: list[ThermalResult]
    expansion: list[ExpansionResult]
    coupling: list[CouplingHistory]
    discretisation: list[DiscretisationRow] = field(default_factory=list)
    reference_shift: list[MeshShift] = field(default_factory=list)
    """At reference: every check that depends on a housing mesh, on the standard mesh and on the fine one."""
    hand_checks: list[dict[str, Any]]
    """{quantity, computed, by_hand, unit, formula}: a number an engineer can redo for each key result."""
    assumptions: list[AssumptionRecord]
    overrides: list[dict[str, str]]
    not_modelled: list[str]
    warnings: list[Finding]
    timings_s: dict[str, float]
    transient: TransientResult | None = None
    """With ``--transient``."""
    ranges: RangesResult | None = None
    """With `--ranges`: verdicts and margins over the ranges of the assumed inputs."""
    fields: list[TemperatureField] = field(repr=False)

    def __repr__(self) -> str:
        counts = ", ".join(f"{number} {verdict}" for verdict, number in self.counts.items() if number)
        return f"RunResult({self.case['name']}, {self.fidelity}: {self.verdict}; {len(self.checks)} checks: {counts})"

    def _repr_html_(self) -> str:
        """Verdict and checks as a table, for notebooks."""
        rows = "".join(
            f"<tr><td>{escape(check.id)}</td><td>{_shown(check.value)}</td><td>{_shown(check.limit)}</td>"
            f"<td>{escape(check.unit)}</td><td>{_shown(check.utilisation)}</td><td>{check.verdict}</td></tr>"
            for check in self.checks
        )
        head = "".join(
            f"<th>{name}</th>" for name in ("check", "value", "limit", "unit", "utilisation", "verdict")
        )
        return (
            f"<p>{escape(repr(self))}</p><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        )

    @property
    def counts(self) -> dict[Verdict, int]:
        """How many checks end with each verdict."""
        return {
            verdict: sum(check.verdict == verdict for check in self.checks) for verdict in get_args(Verdict)
        }

    def to_dataframe(self) -> "pandas.DataFrame":
        """The checks as a table, one row each, indexed by id.

        Raises
        ------
        MissingLibraryError
            pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            raise MissingLibraryError("to_dataframe needs pandas; run: pip install pandas") from error
        return pandas.DataFrame([asdict(check) for check in self.checks]).set_index("id")


def _shown(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"
