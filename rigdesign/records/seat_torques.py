"""Largest torque between every gear and its shaft: periodic responses, time run over the schedule, events.

In the periodic response of a held stage it is that of the spring of the seat, inertia of the gear included. Time run
and events keep the torques of the meshes: there the seat has its torque of the held stage times what the mesh peaks at
over its peak in that response, the largest of the meshes of the gear. Where the gear itself swings in an event its
inertia adds to that.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.response.section_torque import section_torques
from rigdesign.coupling.braced_loop import shifted_laws
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.twist_rows import twist_rows_of
from rigdesign.records.tooth_history import gear_meshes
from rigdesign.results.events import EventRecord
from rigdesign.results.loads import DynamicLoads
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class SeatTorque:
    """A gear ``gearbox.gear`` at the largest torque of its seat [N m] in a stage or event.

    speed : stated speed there [rad/s], of a stage its highest; point : held point whose temperatures count
    """

    gear: str
    torque: float
    where: str
    """``stage test``"""
    speed: float
    point: PointResult


def held_seat_torques(rig: Rig, points: Sequence[PointResult]) -> Iterator[SeatTorque]:
    """Of every gear in the periodic response of every held point."""
    for point in points:
        for gear, torque in _of_response(rig, point).items():
            yield SeatTorque(
                gear=gear,
                torque=torque,
                where=f"stage {point.point.stage}",
                speed=point.point.speed,
                point=point,
            )


def seat_torques(
    rig: Rig, points: Sequence[PointResult], loads: DynamicLoads, events: Sequence[EventRecord] = ()
) -> tuple[SeatTorque, ...]:
    """The same, and of every gear in the stages of the time run and in the events."""
    held = tuple(held_seat_torques(rig, points))
    return (*held, *_of_run(rig, points, loads, held), *_of_events(rig, points, events, held))


def _of_response(rig: Rig, point: PointResult) -> dict[str, float]:
    last = point.last
    if last.system is None or last.response is None or point.setting is None:
        return {}
    laws = periodic_laws(rig, shifted_laws(rig, last.models, point.setting))
    loop = section_torques(last.system, laws, twist_rows_of(rig, last.system, point.point.speed))
    peaks = np.abs(loop.over_period(last.response, last.drags)).max(axis=1)
    return {
        section.part: float(peak)
        for section, peak in zip(loop.rows.sections, peaks, strict=True)
        if section.kind == "spline"
    }


def _of_run(
    rig: Rig, points: Sequence[PointResult], loads: DynamicLoads, held: Sequence[SeatTorque]
) -> Iterator[SeatTorque]:
    test = governing_point(points)
    by_stage = {point.point.stage: point for point in points}
    for stage in rig.case.schedule.resolved():
        peaks = {
            name: load.peak
            for name in rig.mesh_names
            for load in loads.meshes[rig.mesh_labels[name]].stage_loads
            if load.stage == stage.name
        }
        point = by_stage.get(stage.name, test)
        speed = max(stage.speed_start, stage.speed_end)
        yield from _scaled(rig, held, peaks, (f"time run, stage {stage.name}", speed, point))


def _of_events(
    rig: Rig, points: Sequence[PointResult], events: Sequence[EventRecord], held: Sequence[SeatTorque]
) -> Iterator[SeatTorque]:
    test = governing_point(points)
    for event in events:
        peaks = {peak.place: peak.peak for peak in event.peaks if peak.quantity == "mesh torque"}
        yield from _scaled(rig, held, peaks, (f"event {event.name}", event.speed, test))


def _scaled(
    rig: Rig, held: Sequence[SeatTorque], peaks: dict[str, float], at: tuple[str, float, PointResult]
) -> Iterator[SeatTorque]:
    """Of every gear by the peaks [N m] of its meshes at their pinions; at : in words, stated speed, held point."""
    where, speed, point = at
    response = point.last.response
    if response is None:
        return
    own = {one.gear: one.torque for one in held if one.point is point}
    for gear, places in gear_meshes(rig).items():
        shares = [
            peaks[name] / float(response.maximum[place.mesh])
            for place in places
            if (name := rig.mesh_names[place.mesh]) in peaks and response.maximum[place.mesh] > 0.0
        ]
        if shares and gear in own:
            yield SeatTorque(gear=gear, torque=max(shares) * own[gear], where=where, speed=speed, point=point)
