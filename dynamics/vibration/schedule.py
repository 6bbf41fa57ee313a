"""Schedule of a test: stages of speed and torque, commands over time, ramp rules, load cycles.

Within a stage speed and torque follow an S-function whose first and second derivative vanish at both ends, so
that neither speed nor acceleration jumps where stages meet. A ramp-down is a stage like any other.
"""

import math
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError

Array = NDArray[np.float64]
Kind = Literal["hold", "speed", "torque"]
Direction = Literal["constant", "rising", "falling"]


class ScheduleError(DynamicsInputError):
    """A schedule that contradicts itself; the message names stage, value, limit and remedy."""


def s_function(share: ArrayLike) -> Array:
    """Smooth step from 0 to 1 over ``share`` 0 to 1: 10 u^3 - 15 u^4 + 6 u^5, constant outside."""
    u = np.clip(np.asarray(share, dtype=float), 0.0, 1.0)
    return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u**2))


def s_derivative(share: ArrayLike) -> Array:
    """Derivative of ``s_function``: 30 u^2 (1 - u)^2; 1.875 at most."""
    u = np.clip(np.asarray(share, dtype=float), 0.0, 1.0)
    return np.asarray(30.0 * u**2 * (1.0 - u) ** 2)


@dataclass(frozen=True, kw_only=True)
class Stage:
    """One stage of the schedule.

    kind : what changes: ``hold`` nothing, ``speed`` the speed alone, ``torque`` the torque alone
    speed, torque : at start and end [rad/s], [N m]; duration [s]
    direction : what the stage says it does; None takes it from the numbers
    held : True if the steady temperatures are evaluated here
    """

    name: str
    kind: Kind
    speed: tuple[float, float]
    torque: tuple[float, float]
    duration: float
    direction: Direction | None = None
    held: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.duration) and self.duration > 0.0):
            raise ScheduleError(f"stage {self.name!r}: duration = {self.duration} s: must be above 0")
        for quantity, values, unit in (("speed", self.speed, "rad/s"), ("torque", self.torque, "N m")):
            if not all(math.isfinite(value) for value in values):
                raise ScheduleError(f"stage {self.name!r}: {quantity} = {values} {unit}: must be finite")
        if min(self.speed) < 0.0:
            raise ScheduleError(f"stage {self.name!r}: speed = {min(self.speed)} rad/s: must not be below 0")
        for quantity, (start, end) in (("speed", self.speed), ("torque", self.torque)):
            if quantity != self.kind and start != end:
                raise ScheduleError(
                    f"stage {self.name!r} of kind {self.kind!r}: {quantity} goes from {start:g} to {end:g}: "
                    "it must stay; make it constant or split the stage in two"
                )
        if self.kind == "hold":
            if self.direction not in (None, "constant"):
                raise ScheduleError(
                    f"stage {self.name!r}: says {self.direction!r} but is held; leave the direction out"
                )
            return
        actual = self.actual_direction
        if self.direction is not None and self.direction != actual:
            start, end = self.speed if self.kind == "speed" else self.torque
            raise ScheduleError(
                f"stage {self.name!r}: says that the {self.kind} is {self.direction} but it goes from "
                f"{start:g} to {end:g}, which is {actual}; swap the values or correct the direction"
            )
        if self.held:
            raise ScheduleError(
                f"stage {self.name!r}: is held while its {self.kind} changes: a steady state needs constant "
                "speed and torque; state 'held' at a stage of kind 'hold' instead"
            )

    @property
    def actual_direction(self) -> Direction:
        """Direction of what changes, from the numbers."""
        start, end = self.torque if self.kind == "torque" else self.speed
        if start == end:
            return "constant"
        return "rising" if end > start else "falling"


@dataclass(frozen=True, kw_only=True)
class StageCommand:
    """Commands (n,): time [s], speed [rad/s], acceleration [rad/s2], torque [N m], index of the stage."""

    time: Array
    speed: Array
    acceleration: Array
    torque: Array
    stage: NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Schedule:
    """Stages in order; each starts where the one before ended."""

    stages: tuple[Stage, ...]

    def __post_init__(self) -> None:
        if not self.stages:
            raise ScheduleError("the schedule has no stage; give at least one")
        names = [stage.name for stage in self.stages]
        for name in names:
            if names.count(name) > 1:
                raise ScheduleError(f"stage {name!r} is given {names.count(name)} times: rename all but one")
        for before, after in pairwise(self.stages):
            for quantity, end, start in (
                ("speed", before.speed[1], after.speed[0]),
                ("torque", before.torque[1], after.torque[0]),
            ):
                if not math.isclose(end, start, rel_tol=1e-9, abs_tol=1e-9):
                    raise ScheduleError(
                        f"stage {after.name!r}: {quantity} starts at {start:g} but stage {before.name!r} "
                        f"ends at {end:g}; make them equal or put a stage in between"
                    )

    @property
    def starts(self) -> Array:
        """Start time of every stage and the end of the last (n_stages + 1,) [s]."""
        return np.concatenate([[0.0], np.cumsum([stage.duration for stage in self.stages])])

    @property
    def duration(self) -> float:
        """Total duration [s]."""
        return math.fsum(stage.duration for stage in self.stages)

    @property
    def held(self) -> tuple[Stage, ...]:
        """Stages at which the steady state is evaluated."""
        return tuple(stage for stage in self.stages if stage.held)

    def at(self, time: ArrayLike) -> StageCommand:
        """Commands at given times [s], within the schedule; the ends are kept outside."""
        when = np.atleast_1d(np.asarray(time, dtype=float))
        starts = self.starts
        index = np.clip(np.searchsorted(starts, when, side="right") - 1, 0, len(self.stages) - 1)
        length = np.array([stage.duration for stage in self.stages])[index]
        share = (when - starts[index]) / length
        speed = np.array([stage.speed for stage in self.stages])[index]
        torque = np.array([stage.torque for stage in self.stages])[index]
        step, rate = s_function(share), s_derivative(share) / length
        return StageCommand(
            time=when,
            speed=speed[:, 0] + (speed[:, 1] - speed[:, 0]) * step,
            acceleration=(speed[:, 1] - speed[:, 0]) * rate,
            torque=torque[:, 0] + (torque[:, 1] - torque[:, 0]) * step,
            stage=index.astype(np.int64),
        )

    def command(self, interval: float) -> StageCommand:
        """Commands from 0 to the end every ``interval`` [s]; the last sample is the end."""
        if not interval > 0.0:
            raise ScheduleError(f"sample interval = {interval} s: must be above 0; correct it")
        count = max(1, math.ceil(self.duration / interval - 1e-9))
        return self.at(np.linspace(0.0, self.duration, count + 1))


@dataclass(frozen=True, kw_only=True)
class RampLimits:
    """Limits of the ramp rules (P2, "Definition of the Operating Points").

    standstill_torque : least torque before the rig rotates, takes up the backlash [N m]
    start_torque_limit : most torque below the transition speed of the journal bearings [N m]
    transition_speed : from here the bearings run on a full film [rad/s]; test_speed [rad/s]; test_torque [N m]
    run_up_share : most share of the test torque between transition and test speed [-]
    """

    standstill_torque: float
    start_torque_limit: float
    transition_speed: float
    test_speed: float
    test_torque: float
    run_up_share: float = 0.5


@dataclass(frozen=True, kw_only=True)
class RampRule:
    """Verdict of one ramp rule: worst value over the schedule against its limit, and where it occurs."""

    id: str
    text: str
    holds: bool
    value: float
    limit: float
    comparison: Literal["<=", ">="]
    stage: str
    time: float


def ramp_rules(schedule: Schedule, limits: RampLimits, samples_per_stage: int = 401) -> tuple[RampRule, ...]:
    """The four ramp rules of P2 over the whole schedule, ramp-down included.

    1. While the rig rotates the torque is at least the standstill torque, so that the flanks stay closed.
    2. Below the transition speed the torque is at most the start torque limit of the bearings.
    3. Between transition speed and test speed it is at most the run-up share of the test torque.
    4. It is at most the test torque, which is reached at test speed only.
    """
    command = schedule.at(_dense_times(schedule, samples_per_stage))
    tolerance = 1e-9 * max(limits.test_speed, 1.0)
    rotating = command.speed > tolerance
    starting = _just_before(rotating)
    below = command.speed < limits.transition_speed - tolerance
    between = ~below & (command.speed < limits.test_speed - tolerance)
    rules = (
        (
            rotating | starting,
            _TorqueLimit(
                "ramp.standstill_torque", "least torque while the rig turns, backlash taken up",
                limits.standstill_torque, ">=",
            ),
        ),
        (
            below,
            _TorqueLimit(
                "ramp.start_torque", "most torque below the transition speed of the bearings",
                limits.start_torque_limit, "<=",
            ),
        ),
        (
            between,
            _TorqueLimit(
                "ramp.run_up_torque", "most torque between transition and test speed",
                limits.run_up_share * limits.test_torque, "<=",
            ),
        ),
        (
            ~below & ~between,
            _TorqueLimit("ramp.test_torque", "most torque at test speed", limits.test_torque, "<="),
        ),
    )  # fmt: skip
    return tuple(_rule(schedule, command, where, rule) for where, rule in rules)


def _dense_times(schedule: Schedule, samples: int) -> Array:
    starts = schedule.starts
    return np.unique(np.concatenate([np.linspace(a, b, samples) for a, b in pairwise(starts)]))


def _just_before(rotating: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Last sample at rest before the rig starts."""
    before = np.zeros_like(rotating)
    before[:-1] = ~rotating[:-1] & rotating[1:]
    return before


@dataclass(frozen=True)
class _TorqueLimit:
    """One ramp rule as stated: identifier, sentence, limit [N m] and on which side the torque has to stay."""

    id: str
    text: str
    limit: float
    comparison: Literal["<=", ">="]


def _rule(
    schedule: Schedule, command: StageCommand, where: NDArray[np.bool_], rule: _TorqueLimit
) -> RampRule:
    """Worst torque among the samples ``where``; a rule without a sample holds at its limit."""
    index = np.flatnonzero(where)
    limit, at_most = rule.limit, rule.comparison == "<="
    if index.size == 0:
        return RampRule(**asdict(rule), holds=True, value=limit, stage="", time=0.0)
    torque = np.abs(command.torque[index])
    worst = int(index[np.argmax(torque) if at_most else np.argmin(torque)])
    value = float(abs(command.torque[worst]))
    slack = 1e-9 * max(abs(limit), 1.0)
    return RampRule(
        **asdict(rule),
        holds=value <= limit + slack if at_most else value >= limit - slack,
        value=value,
        stage=schedule.stages[int(command.stage[worst])].name,
        time=float(command.time[worst]),
    )
