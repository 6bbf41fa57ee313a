"""Torque of every section and joint in the stages of the time run, from its readings at every sample."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.graph import TorqueSection, TwistRows
from dynamics.vibration.section_torque import section_torques
from dynamics.vibration.time_response import TimeResponse
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.coupling.preloaded_loop import periodic_laws, shifted_laws
from rigdesign.coupling.time_run import schedule_of, stage_names
from rigdesign.results.loads import EventPeak, EventRecord, PassingPeak
from rigdesign.results.vibration import HeldTorque, PlaceKind, RunTorque, TorquePlace, TorqueSwing
from rigdesign.rig.model import Rig

Indices = NDArray[np.int64]


def run_torques(rig: Rig, ramp: TimeResponse) -> tuple[RunTorque, ...]:
    """One entry for every section and joint in every stage of the schedule; none where the run read no torques."""
    if ramp.sections is None:
        return ()
    windows = ramp.windows
    stages = np.array(stage_names(schedule_of(rig), windows.time - 0.5 * windows.duration))
    members: dict[TorqueSection, list[int]] = {}
    for i, section in enumerate(ramp.sections.sections):
        members.setdefault(section, []).append(i)
    return tuple(
        _of_stage(ramp, section, np.array(own), stage, np.flatnonzero(stages == stage))
        for section, own in members.items()
        for stage in dict.fromkeys(stages.tolist())
    )


def _of_stage(
    ramp: TimeResponse, section: TorqueSection, own: Indices, stage: str, windows: Indices
) -> RunTorque:
    """Of the elements ``own`` of a section in some windows of the run."""
    sections, found = ramp.sections, ramp.windows
    assert sections is not None
    place = np.ix_(own, windows)
    swing = sections.half_peak_to_peak[place]
    element, window = np.unravel_index(int(swing.argmax()), swing.shape)
    peak = float(sections.peak[place].max())
    at = windows[window]
    return RunTorque(
        place=place_of(section),
        stage=stage,
        peak=peak,
        half_peak_to_peak=float(swing[element, window]),
        mean=abs(float(sections.mean[own[element], at])),
        time=float(found.time[at]),
        speed=float(found.speed[at]),
        shear_stress=shear_stress(section, peak),
    )


def place_of(section: TorqueSection) -> TorquePlace:
    """Place of a section or joint in records."""
    of_shaft = section.kind == "shaft"
    return TorquePlace(
        kind=section.kind,
        part=section.part,
        start=section.start if of_shaft else None,
        end=section.end if of_shaft else None,
    )


def shear_stress(section: TorqueSection, torque: float) -> float | None:
    """Nominal torsional stress at the surface under a torque [N m] [Pa]; None of a joint."""
    return section.shear_per_torque * torque if section.section is not None else None


# Dynamic torque in every section of the shafts and every joint at a held stage, from its periodic response.

Array = NDArray[np.float64]


def held_torques(rig: Rig, point: PointResult) -> Iterator[HeldTorque]:
    """Of every section and joint at a held point, without the peaks of the time run; none without a response."""
    last = point.last
    if last.system is None or last.response is None or point.setting is None:
        return
    laws = periodic_laws(rig, shifted_laws(rig, last.models, point.setting))
    loop = section_torques(last.system, laws, twist_rows_of(rig, point.point.speed))
    torque = loop.over_period(last.response, last.drags)
    for place, section, swing in section_swings(loop.rows, torque):
        yield HeldTorque(
            place=place,
            stage=point.point.stage,
            speed=rig.pinion_speed(point.point.speed),
            swing=swing,
            run_peak=None,
            shear_stress=shear_stress(section, swing.peak),
        )


def section_swings(
    rows: TwistRows, torque: Array
) -> Iterator[tuple[TorquePlace, TorqueSection, TorqueSwing]]:
    """Of every section and joint, from the torque (r, count) of their springs: that with the highest peak."""
    peak = np.abs(torque).max(axis=1)
    members: dict[TorqueSection, list[int]] = {}
    for i, section in enumerate(rows.sections):
        members.setdefault(section, []).append(i)
    for section, own in members.items():
        worst = own[int(np.argmax(peak[own]))]
        swing = TorqueSwing(
            mean=abs(float(torque[worst].mean())),
            half_peak_to_peak=0.5 * float(np.ptp(torque[worst])),
            peak=float(peak[worst]),
        )
        yield place_of(section), section, swing


# Largest torque of every section of the shafts and every joint: held stages, stages of the time run, events.
#
# Computed at the part itself, inertia of all that turns included: from the periodic response of a held stage, from the
# modal state of the time run at every sample, from the marches of the events.


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
