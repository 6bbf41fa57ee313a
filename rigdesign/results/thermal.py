"""Losses, oil, temperatures and thermal expansion of a run, as they stand in results.json."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.results.quantity import Degrees, Quantity, Watts

if TYPE_CHECKING:
    from rigdesign.transient.soak import Soak
    from thermal.fe.mesh import NamedMesh


@dataclass(frozen=True, kw_only=True)
class LossRow:
    """Power loss of one place at one stage; into_oil + into_body + not_heat = power + pump."""

    place: str
    kind: str
    stage: str
    power: Watts
    into_oil: Watts
    into_body: Watts
    pump: Watts = 0.0
    """Given by the oil pump, not by the shaft: kinetic energy of the jets. A negative ``power`` with it is what a jet
    faster than the pitch line gives to the shaft."""
    basis: Literal["computed", "input"]
    not_heat: Watts = 0.0
    """Work of a mesh damper: power of the motor that is heat of no part."""
    details: Mapping[str, float | str] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class OilRow:
    """One oil consumer at one stage."""

    consumer: str
    stage: str
    inlet: Degrees
    outlet: Degrees
    flow: Annotated[float, Quantity("l/min")]
    heat: Watts
    """Loss into the oil plus heat taken from bodies."""


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
