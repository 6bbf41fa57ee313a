"""The thermal history of a run, as it stands in results.json under ``transient``, and its worst moments in SI."""

from dataclasses import dataclass, field

from rigdesign.transient.soak import Soak


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
