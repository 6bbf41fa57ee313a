"""The worst moments of the thermal history: SI records."""

from dataclasses import dataclass

from rigdesign.transient.warm_up import Soak


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
