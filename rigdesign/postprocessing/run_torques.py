"""Torque of every section and joint in the stages of the time run, from its readings at every sample."""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.rating.dynamic_factor import parabola_apex
from dynamics.rotor.graph import TorqueSection, TwistRows
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.response_curve import CurvePoint, ResponseCurve, SectionTorques, section_torques
from dynamics.vibration.time_response import TimeResponse
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import periodic_laws, shifted_laws
from rigdesign.coupling.time_run import schedule_of, stage_names
from rigdesign.postprocessing.curves import LoopState, dwell_speeds, is_around, nearest
from rigdesign.results.loads import EventPeak, EventRecord, PassingPeak
from rigdesign.results.vibration import (
    HeldTorque,
    PlaceKind,
    RunTorque,
    TorqueOverSpeed,
    TorquePlace,
    TorqueSwing,
)
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


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


# Dynamic torque in shafts, joints and meshes over speed: the forces of the meshes drive the linear loop between them.
#
# The loop has the matrices of the nearest of a few speeds (`loop_states`), around a dwell speed those at it; the forces
# are those of every speed. Torsional resonances of the shafts are far narrower than what they do to the meshes, by
# which the speeds of a curve were chosen: around their peaks the response is solved at more speeds.

ROUNDS = 3
"""Times at which the response is solved where peaks are expected, each nearer to them."""
FINE = 3e-4
"""Share of a speed within which a peak is not looked for again: less than half the bandwidth of steel that damps
itself. The highest peaks of the prototype's sections are within 0.2 % of those with steps halved nine times."""
LEAST_SHARE = 0.1
"""Half peak-to-peak torque of a peak that is looked at more closely, per mean torque of the first mesh."""
FLAT = 0.03
"""Share of a peak by which it stands above the lower of the speeds beside it, below which it is found."""

Swings = Mapping[TorquePlace, TorqueSwing]
Solve = Callable[[Sequence[float]], ResponseCurve]
"""Periodic responses at speeds of the first pinion [rad/s], rising."""


@dataclass(frozen=True)
class LoopOverSpeed:
    """Finds the torque of every section, joint and mesh at points of curves, with the gears of ``warm``."""

    rig: Rig
    warm: IterationResult
    states: Sequence[LoopState]
    _loops: dict[int, SectionTorques] = field(default_factory=dict, repr=False)

    def swings(self, point: CurvePoint) -> Swings:
        """Of every place."""
        stated = point.speed / self.rig.pinion_speed(1.0)
        near = (dwell for dwell in self._dwells if is_around(stated, dwell))
        around = min(near, key=lambda dwell: abs(dwell - stated), default=stated)
        system = nearest(self.states, around).system
        rows = twist_rows_of(self.rig) if not self._loops else self._any.rows
        if id(system) not in self._loops:
            self._loops[id(system)] = section_torques(system, self._laws(), rows)
        torque = self._loops[id(system)].over_period(point, self.warm.drags)
        found = {place: swing for place, _, swing in section_swings(rows, torque)}
        for mesh, name in enumerate(self.rig.mesh_names):
            found[TorquePlace(kind="mesh", part=self.rig.mesh_labels[name])] = mesh_swing(point, mesh)
        return found

    @cached_property
    def _dwells(self) -> tuple[float, ...]:
        return dwell_speeds(self.rig)

    @property
    def shear_per_torque(self) -> Mapping[str, float]:
        """Nominal torsional stress at the surface per torque by the name of a section [Pa/(N m)]."""
        return {one.name: one.shear_per_torque for one in self._any.rows.sections if one.kind == "shaft"}

    @property
    def _any(self) -> SectionTorques:
        return next(iter(self._loops.values()))

    def _laws(self) -> Sequence[MeshLaw]:
        return periodic_laws(self.rig, laws_of(self.warm.models))


def torques_over_speed(
    loop: LoopOverSpeed, points: Sequence[CurvePoint], solve: Solve | None
) -> tuple[tuple[CurvePoint, ...], tuple[TorqueOverSpeed, ...]]:
    """Points by rising speed, those of narrow peaks among them, and the torque of every place at each.

    solve : finds the response at more speeds, or none at some; None where the points are all there is
    """
    if not points:
        return (), ()
    found = {point.speed: (point, loop.swings(point)) for point in points}
    asked: set[float] = set()
    for _ in range(ROUNDS if solve is not None else 0):
        speeds = _expected_peaks(found, asked)
        if not speeds or solve is None:
            break
        asked.update(speeds)
        found |= {point.speed: (point, loop.swings(point)) for point in solve(speeds).points}
    kept = sorted({point.speed for point in points} | set(_peaks(found)))
    listed = [found[speed] for speed in kept]
    stress = loop.shear_per_torque
    return tuple(point for point, _ in listed), tuple(
        TorqueOverSpeed(
            place=place,
            swings=tuple(swings[place] for _, swings in listed),
            shear_per_torque=stress.get(place.name, 0.0),
        )
        for place in listed[0][1]
    )


Found = Mapping[float, tuple[CurvePoint, Swings]]


def _peaks(found: Found) -> Iterator[float]:
    """Speeds at which the alternating torque of a place has a peak that counts."""
    speeds, _, inner = _table(found)
    return (speeds[i] for i in np.flatnonzero(inner.any(axis=1)))


def _expected_peaks(found: Found, asked: Collection[float]) -> list[float]:
    """Rising speeds, not known yet, where peaks that are not flat are expected: near a resonance the inverse square of
    an amplitude is a parabola over speed, whatever the damping."""
    speeds, swing, peaks = _table(found, FLAT)
    known = np.array(sorted({*speeds, *asked}))
    new: list[float] = []
    for i, place in zip(*np.nonzero(peaks), strict=True):
        relative = np.maximum(swing[i - 1 : i + 2, place] / swing[i, place], 1e-3)
        peak = parabola_apex(np.array(speeds[i - 1 : i + 2]), relative**-2.0)
        if np.abs(np.append(known, new) - peak).min() > FINE * peak:
            new.append(peak)
    return sorted(new)


def _table(found: Found, above: float = 0.0) -> tuple[list[float], Array, NDArray[np.bool_]]:
    """Rising speeds (n,), half peak-to-peak of each place, and whether it peaks there (n, n_places); ends are no peaks.

    above : share of a peak by which it stands above one of the speeds beside it at least
    """
    speeds = sorted(found)
    swing = np.array([[one.half_peak_to_peak for one in found[speed][1].values()] for speed in speeds])
    least = LEAST_SHARE * np.array([abs(float(found[speed][0].mean[0])) for speed in speeds])
    peaks = np.zeros(swing.shape, bool)
    middle = swing[1:-1]
    peaks[1:-1] = (middle >= swing[:-2]) & (middle > swing[2:]) & (middle > least[1:-1, None])
    peaks[1:-1] &= middle - np.minimum(swing[:-2], swing[2:]) >= above * middle
    return speeds, swing, peaks


def mesh_swing(point: CurvePoint, mesh: int) -> TorqueSwing:
    """Torque of a mesh at its pinion."""
    high, low = float(point.maximum[mesh]), float(point.minimum[mesh])
    return TorqueSwing(
        mean=abs(float(point.mean[mesh])), half_peak_to_peak=0.5 * (high - low), peak=max(abs(high), abs(low))
    )
