"""The schedule as a thermal model sees it: warm-up, ramps, dwell, stop, oil run-on, soak-back; and what may go wrong.

Between two knots speed and torque change evenly in time, and with them losses and films. Ramps of seconds are one
phase each, dwells are as long as the test is planned.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.case.model import Case
from rigdesign.case.schedule import Event, StageValues
from rigdesign.coupling.state import OperatingPoint

PARTS = 4
"""Parts into which a change of speed is cut: losses are no straight line over it."""
SCHEDULE = "schedule"
"""Name of the branch that follows the schedule from start to end."""


@dataclass(frozen=True, kw_only=True)
class Knot:
    """Operating point at a time since the start of a phase [s]."""

    time: float
    point: OperatingPoint


@dataclass(frozen=True, kw_only=True)
class Phase:
    """A part of the thermal schedule."""

    name: str
    duration: float
    """[s]"""
    knots: tuple[Knot, ...]
    """The first at time 0; one for a phase at one point."""
    oil: bool = True
    held: bool = False

    def speed(self, time: float) -> float:
        """Stated speed [rad/s] at a time since its start [s]."""
        before, after, share = self.between(time)
        return (1.0 - share) * before.point.speed + share * after.point.speed

    def between(self, time: float) -> tuple[Knot, Knot, float]:
        """The knots round a time since the start [s], and the share of the second."""
        for before, after in zip(self.knots, self.knots[1:]):
            if time <= after.time:
                return before, after, (time - before.time) / (after.time - before.time)
        return self.knots[-1], self.knots[-1], 0.0


@dataclass(frozen=True, kw_only=True)
class Timeline:
    """The times of one housing over the schedule, or over what an event makes of it."""

    gearbox: str
    name: str
    """``schedule`` or the event."""
    phases: tuple[Phase, ...]
    start: float
    """Time since the start of the schedule at which it begins [s]."""
    times: NDArray[np.float64]
    """(n,) since the start of the schedule [s]."""
    phase: NDArray[np.int32]
    """(n,) number of the phase each time ends."""


def schedule_phases(case: Case) -> tuple[Phase, ...]:
    """The planned schedule, from the rig at the temperature of the room to the rig that has soaked back."""
    plan = case.transient
    running = running_phases(case)
    start = running[0].knots[0].point
    still = OperatingPoint(stage=start.stage, speed=0.0, torque=start.torque)
    return (
        _constant("warm_up", plan.warm_up, still),
        *running,
        *_after(case, running[-1].knots[-1].point, "stop"),
    )


def running_phases(case: Case) -> tuple[Phase, ...]:
    """The stages of the case: ramps between the dwells, and the dwells."""
    phases: list[Phase] = []
    ramp: list[StageValues] = []
    for stage in case.schedule.resolved():
        if not stage.held:
            ramp.append(stage)
            continue
        phases += _ramp(ramp)
        ramp = []
        dwell = case.transient.dwell or case.test_plan.time
        point = OperatingPoint(stage=stage.name, speed=stage.speed_end, torque=stage.torque_end)
        phases.append(_constant(stage.name, dwell, point, held=True))
    return (*phases, *_ramp(ramp))


def event_phases(case: Case, event: Event, dwell: Phase) -> tuple[Phase, ...]:
    """What follows when ``event`` ends a dwell; for a cold start the schedule without warm-up up to that dwell."""
    plan, point = case.transient, dwell.knots[0].point
    if event == "cold_start":
        running = running_phases(case)
        return running[: [phase.name for phase in running].index(dwell.name) + 1]
    if event == "emergency_stop":
        return _after(case, point, "emergency_stop")
    without = Phase(
        name="oil_loss", duration=plan.oil_loss_time, knots=(Knot(time=0.0, point=point),), oil=False
    )
    stop = _stop("emergency_stop", plan.stop_time, point, oil=False)
    return without, stop, _constant("soak_back", plan.soak_back, stop.knots[-1].point, oil=False)


def _after(case: Case, point: OperatingPoint, name: str) -> tuple[Phase, ...]:
    """Stop if the rig still turns, oil run-on, soak-back."""
    plan = case.transient
    stop = [_stop(name, plan.stop_time, point)] if point.speed > 0.0 else []
    still = OperatingPoint(stage=point.stage, speed=0.0, torque=0.0)
    return (
        *stop,
        _constant("oil_run_on", plan.oil_run_on, still),
        _constant("soak_back", plan.soak_back, still, oil=False),
    )


def _constant(
    name: str, duration: float, point: OperatingPoint, *, oil: bool = True, held: bool = False
) -> Phase:
    return Phase(name=name, duration=duration, knots=(Knot(time=0.0, point=point),), oil=oil, held=held)


def _stop(name: str, duration: float, point: OperatingPoint, *, oil: bool = True) -> Phase:
    """Speed and torque fall to nothing."""
    end = OperatingPoint(stage=point.stage, speed=0.0, torque=0.0)
    return Phase(name=name, duration=duration, knots=tuple(_cut(0.0, duration, point, end)), oil=oil)


def _ramp(stages: Sequence[StageValues]) -> list[Phase]:
    """One phase of successive stages; none without any."""
    if not stages:
        return []
    first = stages[0]
    last = OperatingPoint(stage=first.name, speed=first.speed_start, torque=first.torque_start)
    knots, time = [Knot(time=0.0, point=last)], 0.0
    for stage in stages:
        end = OperatingPoint(stage=stage.name, speed=stage.speed_end, torque=stage.torque_end)
        knots += list(_cut(time, time + stage.duration, last, end))[1:]
        time, last = time + stage.duration, end
    name = first.name if len(stages) == 1 else f"{first.name} to {stages[-1].name}"
    return [Phase(name=name, duration=time, knots=tuple(knots))]


def _cut(start: float, end: float, first: OperatingPoint, last: OperatingPoint) -> Iterator[Knot]:
    """Knots from the first to the last point; a falling speed belongs to the stage it comes from."""
    parts = PARTS if first.speed != last.speed else 1
    inner = last.stage if last.speed >= first.speed else first.stage
    for part in range(parts + 1):
        share = part / parts
        stage = first.stage if part == 0 else last.stage if part == parts else inner
        yield Knot(
            time=start + share * (end - start),
            point=OperatingPoint(
                stage=stage,
                speed=(1.0 - share) * first.speed + share * last.speed,
                torque=(1.0 - share) * first.torque + share * last.torque,
            ),
        )
