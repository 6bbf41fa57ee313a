"""Largest torque of every section of the shafts and every joint: held stages, stages of the time run, events.

Computed at the part itself, inertia of all that turns included: from the periodic response of a held stage, from the
modal state of the time run at every sample, from the marches of the events.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.records.run_torques import run_torques
from rigdesign.results.events import EventPeak, EventRecord, PassingPeak
from rigdesign.results.vibration import HeldTorque, PlaceKind, TorquePlace
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class PartTorque:
    """A place at the largest amount of its torque [N m] in a stage or event.

    kind, part : as of `TorquePlace`; part of a seat (``spline``) is its gear ``gearbox.gear``
    place : its name in tables, that of `TorquePlace`
    """

    kind: PlaceKind
    part: str
    place: str
    torque: float
    where: str
    """``stage test``"""
    event: str | None
    """Name of the event, None of a stage."""
    speed: float
    """Stated speed there [rad/s], of a stage its highest."""
    point: PointResult
    """Held point whose temperatures count."""
    shear_stress: float | None = None
    """Nominal torsional stress at the surface [Pa]; shafts only."""


def part_torques(
    rig: Rig,
    points: Sequence[PointResult],
    held: Sequence[HeldTorque],
    ramp: TimeResponse,
    events: Sequence[EventRecord] = (),
) -> tuple[PartTorque, ...]:
    """All of them; held : of the periodic responses of ``points``."""
    return (*_of_held(points, held), *_of_run(rig, points, ramp), *_of_events(points, events))


def _of_held(points: Sequence[PointResult], held: Sequence[HeldTorque]) -> Iterator[PartTorque]:
    by_stage = {point.point.stage: point for point in points}
    for torque in held:
        point = by_stage[torque.stage]
        yield PartTorque(
            kind=torque.place.kind,
            part=torque.place.part,
            place=torque.place.name,
            torque=torque.swing.peak,
            where=f"stage {torque.stage}",
            event=None,
            speed=point.point.speed,
            point=point,
            shear_stress=torque.shear_stress,
        )


def _of_run(rig: Rig, points: Sequence[PointResult], ramp: TimeResponse) -> Iterator[PartTorque]:
    test = governing_point(points)
    by_stage = {point.point.stage: point for point in points}
    stages = {stage.name: stage for stage in rig.case.schedule.resolved()}
    for torque in run_torques(rig, ramp):
        stage = stages[torque.stage]
        yield PartTorque(
            kind=torque.place.kind,
            part=torque.place.part,
            place=torque.place.name,
            torque=torque.peak,
            where=f"time run, stage {torque.stage}",
            event=None,
            speed=max(stage.speed_start, stage.speed_end),
            point=by_stage.get(torque.stage, test),
            shear_stress=torque.shear_stress,
        )


KINDS: dict[str, PlaceKind] = {
    "coupling torque": "coupling",
    "shaft torque": "shaft",
    "seat torque": "spline",
}
"""Kind of place by the quantity of a peak of an event."""


def _of_events(points: Sequence[PointResult], events: Sequence[EventRecord]) -> Iterator[PartTorque]:
    test = governing_point(points)
    for event in events:
        peaks: tuple[EventPeak | PassingPeak, ...] = (*event.peaks, *event.passing)
        for peak in peaks:
            if peak.quantity in KINDS:
                kind = KINDS[peak.quantity]
                place = TorquePlace(kind=kind, part=peak.part)
                yield PartTorque(
                    kind=kind,
                    part=peak.part,
                    place=peak.place if kind == "shaft" else place.name,
                    torque=peak.peak,
                    where=f"event {event.name}",
                    event=event.name,
                    speed=event.speed,
                    point=test,
                    shear_stress=peak.shear_stress,
                )
