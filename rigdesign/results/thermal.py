"""Losses, oil, temperatures and thermal expansion of a run, as they stand in results.json."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from rigdesign.transient.soak import Soak
    from thermal.fe.mesh import NamedMesh


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
class FluidRow:
    """A volume or stream of a housing; heat + power + links = 0 for a volume."""

    name: str
    kind: Literal["volume", "stream"]
    inlet_degC: float | None  # noqa: N815
    """Of a stream."""
    temperature_degC: float  # noqa: N815
    """Of a volume, at the outlet of a stream."""
    heat_W: float  # noqa: N815
    """From its surfaces into it."""
    power_W: float = 0.0  # noqa: N815
    """Set free in it."""
    links_W: dict[str, float] = field(default_factory=dict)  # noqa: N815
    """Link -> heat that it brings into the volume."""


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
    fluids: list[FluidRow] = field(default_factory=list)
    """Volumes and streams of the housing."""


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


# The thermal history of a run, as it stands in results.json under ``transient``, and its worst moments in SI.


@dataclass(frozen=True, kw_only=True)
class TransientCurve:
    """Thermal history of one gearbox over one branch: lists of one length, one entry for every time step."""

    gearbox: str
    branch: str
    """``schedule``, or the event that starts from the cold rig (cold_start) or ends the dwell."""
    time_s: list[float]
    """Since the start of the schedule, warm-up included."""
    phase: list[str]
    speed_rpm: list[float]
    temperatures_degC: dict[str, list[float]]  # noqa: N815
    """By place: bodies by their mean, ``housing_max``, oil outlets, bearing films, probes of the case."""
    clearances_mm: dict[str, dict[str, list[float]]]
    """Quantity -> place -> clearance."""
    alignment: dict[str, dict[str, list[float]]] = field(default_factory=dict)
    """Quantity with its unit -> place -> size: bearing_tilt_mrad, bore_out_of_round (share of the radial clearance),
    axis_inclination_um, axis_skew_um (over the face width), coupling_offset_mm, coupling_angle_mrad."""


@dataclass(frozen=True, kw_only=True)
class OilPowerCurve:
    """What heaters and cooler must give and take over one branch, of all gearboxes together: lists of one length."""

    branch: str
    time_s: list[float]
    """Since the start of the schedule, warm-up included."""
    phase: list[str]
    heater_W: list[float]  # noqa: N815
    """Of all circuits whose oil comes back colder than it is fed."""
    cooler_W: list[float]  # noqa: N815
    """Of the others."""
    streams_W: dict[str, list[float]]  # noqa: N815
    """``gearbox.stream`` -> heat with which its oil comes back above its inlet temperature."""
    tanks_degC: dict[str, list[float]] = field(default_factory=dict)  # noqa: N815
    """Oil circuit -> temperature of its tank."""
    supplies_degC: dict[str, list[float]] = field(default_factory=dict)  # noqa: N815
    """``gearbox.stream`` -> supply temperature, of streams that an oil circuit feeds."""


@dataclass(frozen=True, kw_only=True)
class WorstMoment:
    """The least clearance, highest temperature, largest misalignment or largest oil power of all branches."""

    quantity: str
    value: float
    unit: str
    time_s: float
    """Since the start of the schedule, warm-up included."""
    place: str
    branch: str
    phase: str
    steady: float | None
    """The worst of the held stages in their steady state."""
    limit: float | None
    planned: bool = True
    """False for the cold start, which the case does not plan: it shows what the warm-up is good for."""


@dataclass(frozen=True, kw_only=True)
class Settling:
    """After which time a quantity stays near its end value in the dwell."""

    gearbox: str
    stage: str
    quantity: str
    settled_after_s: float | None
    """Since the start of the dwell; None if the dwell is too short."""
    start: float
    end: float
    unit: str


@dataclass(frozen=True, kw_only=True)
class TransientResult:
    """Temperatures and clearances over the schedule and its events."""

    curves: list[TransientCurve]
    worst: list[WorstMoment]
    settling: list[Settling]
    soak: list[Soak]
    inputs: dict[str, str]
    """Durations and assumptions behind it, as the case has them."""
    energy_closure: float
    """Largest gap of the energy balance of a branch, relative to the heat turned over."""
    missed_temperature_K: float  # noqa: N815
    """Largest temperature that the reduced basis of the expansion leaves out."""
    oil_power: list[OilPowerCurve] = field(default_factory=list)
    """One for every branch."""


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """The least clearance, highest temperature, largest misalignment or largest oil power over time, in SI."""

    quantity: str
    value: float
    place: str
    time: float
    """Since the start of the schedule, warm-up included [s]."""
    branch: str
    phase: str
    steady: float | None
    """The worst of the held stages in their steady state."""
    limit: float | None
    planned: bool = True
    """False for the cold start, which the case does not plan: it shows what the warm-up is good for."""


@dataclass(frozen=True, kw_only=True)
class SupplyHeld:
    """When the supply temperature of a line of an oil circuit holds its setpoint, over the planned schedule."""

    place: str
    """``circuit.lines.line``."""
    time: float | None
    """After the start, up to the end of the last dwell [s]; None where it is not held there."""
    reached: float
    """When the warm-up ends; where the setpoint is not held, at the end of the last dwell [degC]."""
    end: float
    """Of the last dwell [s]."""


@dataclass(frozen=True, kw_only=True)
class HistoryExtremes:
    """What the checks over time read."""

    extremes: tuple[Extreme, ...]
    soak: tuple[Soak, ...]
    """Warm-up that each gearbox needs before full torque."""
    supplies: tuple[SupplyHeld, ...] = ()
    """Of every line of an oil circuit with a setpoint."""
