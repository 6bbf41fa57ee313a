"""Loads of the rig in an event: SI records."""

from dataclasses import dataclass, field
from typing import Literal

Quantity = Literal["coupling torque", "shaft torque", "seat torque", "mesh torque", "bearing force"]
NOT_WITHIN = "not within"
"""How the reason of a check begins whose value is the time followed without the event it waits for: a lower bound."""


@dataclass(frozen=True, kw_only=True)
class EventPeak:
    """Largest amount of one quantity of one part [N m], [N]."""

    place: str
    """Coupling, section of a shaft as in tables, gear on its seat ``gearbox.gear``, ``gearbox.mesh`` or
    ``gearbox.bearing``."""
    part: str
    """The same, of a section its shaft."""
    quantity: Quantity
    before: float
    """Mean before the event."""
    peak: float
    time: float
    """From the instant of the event [s]."""
    shear_stress: float | None = None
    """Nominal torsional stress at the surface of a shaft under the peak [Pa]."""


@dataclass(frozen=True, kw_only=True)
class PassingPeak:
    """Largest amount of a torque at one place during run-down through the resonances [N m]."""

    place: str
    part: str
    quantity: Quantity
    peak: float
    speed: float
    """Stated speed at which it is passed [rad/s]."""
    shear_stress: float | None = None
    """As of `EventPeak`."""


@dataclass(frozen=True, kw_only=True)
class Reversal:
    """Contact of one mesh through an event."""

    mesh: str
    open_share: float
    """Share of the time without contact [-]."""
    other_flank: float
    """Most torque on the flanks that carry nothing before [N m]."""


@dataclass(frozen=True, kw_only=True)
class EventCurve:
    """Extremes of a torque in envelope windows [N m]."""

    place: str
    quantity: Quantity
    least: list[float] = field(repr=False)
    greatest: list[float] = field(repr=False)


@dataclass(frozen=True, kw_only=True)
class EventRecord:
    """One event."""

    name: str
    kind: str
    speed: float
    """Of the test gear's shaft as stated [rad/s]."""
    torque: float
    """As stated [N m]."""
    what: str
    """In words: teeth lost, brake torque."""
    peaks: tuple[EventPeak, ...] = ()
    passing: tuple[PassingPeak, ...] = ()
    """Of a stop, from the periodic responses over speed."""
    reversals: tuple[Reversal, ...] = ()
    tripped: float | None = None
    """Time until the limit of the monitor is crossed [s]."""
    untripped: float | None = None
    """Time for which a monitor was watched that never tripped [s]."""
    standstill: float | None = None
    """Time to standstill, from the trip or the stop on [s]."""
    dynamic_factor: dict[str, float] = field(default_factory=dict)
    """K_V by mesh, of an overspeed."""
    resonance: str = ""
    """Nearest resonance of an overspeed, in words."""
    resonance_distance: float | None = None
    """Its distance as a share of the speed [-]."""
    time: list[float] = field(default_factory=list, repr=False)
    """End of each envelope window of the curves [s]."""
    curves: tuple[EventCurve, ...] = ()
    notes: tuple[str, ...] = ()
