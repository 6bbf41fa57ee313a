"""Checks of the events: torque of couplings and shafts, bearing force, trip, standstill, overspeed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.case.events import EmergencyStop, EventLoadLimits, Overspeed, ToothLoss
from rigdesign.case.model import Case
from rigdesign.checks.registry import REGISTRY, RuleFamily, Topic, Values
from rigdesign.results.check import NOT_WITHIN, Check
from rigdesign.results.units import NEWTON_METRE, NUMBER, RPM, DisplayUnit

if TYPE_CHECKING:
    from rigdesign.postprocessing.solved_rig import SolvedRig
    from rigdesign.results.loads import EventRecord, Load

GROUP = "events"
NEWTON, SECOND = DisplayUnit("N"), DisplayUnit("s")
MARCH = (
    "Time integration from the steady state at speed and torque of the event with constant twist of the bracing; gears "
    "and films at the temperatures of the test"
)
PASSED = "; in a stop also the periodic responses passed during run-down"
Part = type[EventLoadLimits] | type[ToothLoss] | type[EmergencyStop] | type[Overspeed]


@dataclass(frozen=True, kw_only=True)
class EventFamily(RuleFamily):
    """One rule for every event of a kind."""

    part: Part
    """Events that have it."""
    limit_key: str
    """Key of the limit in the event."""
    found: Callable[[EventRecord], Values]


def _of(part: Part) -> Callable[[Case], Iterator[str]]:
    return lambda case: (name for name, event in case.events.items() if isinstance(event, part))


def _peaks(quantity: Load) -> Callable[[EventRecord], Values]:
    """Within the time marched, and in a stop during run-down."""

    def values(record: EventRecord) -> Values:
        for peak in record.peaks:
            if peak.quantity == quantity:
                yield peak.peak, f"{peak.place} after {1e3 * peak.time:.2f} ms"
        for passed in record.passing:
            if passed.quantity == quantity:
                yield passed.peak, f"{passed.place} during run-down at {RPM * passed.speed:.0f} rpm"

    return values


def _one(value: Callable[[EventRecord], float | None], where: str) -> Callable[[EventRecord], Values]:
    def values(record: EventRecord) -> Values:
        found = value(record)
        return [] if found is None else [(found, where)]

    return values


def _trip(record: EventRecord) -> Values:
    """A monitor that never trips needs more than the time for which it was watched: the value is a bound."""
    if record.untripped is not None:
        return [(record.untripped, f"{NOT_WITHIN} {record.untripped:g} s, for which the event is followed")]
    return [] if record.tripped is None else [(record.tripped, "first crossing of the limit of the monitor")]


def _family(
    name: str,
    title: str,
    unit: DisplayUnit,
    part: Part,
    found: Callable[[EventRecord], Values],
    procedure: str,
) -> EventFamily:
    return EventFamily(
        key=f"event.{name}", title=f"{title} in the event {{place}}", unit=unit, group=GROUP,
        source=f"events.{{place}}.{name}", procedure=procedure, places=_of(part), part=part, limit_key=name,
        found=found, moved_by=frozenset({"events", "housing"}), comparison=">=" if name.endswith("minimum") else "<=",
        absent="the event gives no value: " + title,
    )  # fmt: skip


FAMILIES = (
    _family(
        "coupling_torque_maximum", "largest torque in a coupling and its flanges", NEWTON_METRE, EventLoadLimits,
        _peaks("coupling torque"), f"{MARCH}: largest absolute torque in a coupling{PASSED}.",
    ),
    _family(
        "shaft_torque_maximum", "largest torque in a section of a shaft", NEWTON_METRE, EventLoadLimits,
        _peaks("shaft torque"), f"{MARCH}: largest absolute torque in an element of a shaft{PASSED}.",
    ),
    _family(
        "bearing_force_maximum", "largest radial force on a bearing", NEWTON, EventLoadLimits,
        _peaks("bearing force"), f"{MARCH}: force of the stiffness and damping of the bearing, without weight; with "
        "torsional shafts the static force times peak over mean of the mesh torque.",
    ),
    _family(
        "trip_time_maximum", "time until the monitor trips", SECOND, ToothLoss,
        _trip,
        f"{MARCH}: first crossing of the limit by the monitored channel.",
    ),
    _family(
        "standstill_time_maximum", "time to standstill", SECOND, EmergencyStop,
        _one(lambda record: record.standstill, "rigid rotation under brake and drag torques"),
        "Inertia of the rig decelerated by brake torque and drag torques at every speed, from the stop on.",
    ),
    _family(
        "dynamic_factor_maximum", "dynamic factor K_V", NUMBER, Overspeed,
        lambda record: ((factor, f"mesh {name}") for name, factor in record.dynamic_factor.items()),
        "Periodic response at the overspeed, max over mean of the torque of each mesh.",
    ),
    _family(
        "resonance_distance_minimum", "distance from the nearest resonance", NUMBER, Overspeed,
        _one(lambda record: record.resonance_distance, "modes of the closed loop at the test"),
        "Modes of the closed loop that a mesh excites against orders 1 to 3 of its frequency.",
    ),
)  # fmt: skip


def checks(solved: SolvedRig) -> Iterator[Check]:
    """Rules of every event; a limit that it leaves out makes its rule not applicable."""
    records = {record.name: record for record in solved.events}
    for name, event in solved.case.events.items():
        for family in FAMILIES:
            if isinstance(event, family.part):
                rule = family.rule(getattr(event, family.limit_key), name)
                record = records.get(name)
                yield family.worst(solved, rule, [] if record is None else family.found(record))


REGISTRY.register(Topic(order=55, families=FAMILIES, checks=checks))
