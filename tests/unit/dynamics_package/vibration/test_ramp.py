import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from dynamics.vibration.schedule import (
    RampLimits,
    Schedule,
    ScheduleError,
    Stage,
    ramp_rules,
    s_derivative,
    s_function,
)

RPM = math.pi / 30.0
LIMITS = RampLimits(
    standstill_torque=10.0,
    start_torque_limit=10.0,
    transition_speed=750.0 * RPM,
    test_speed=12000.0 * RPM,
    test_torque=180.0,
)


def speed(name: str, start: float, end: float, torque: float, duration: float = 1.0) -> Stage:
    return Stage(
        name=name, kind="speed", speed=(start * RPM, end * RPM), torque=(torque, torque), duration=duration
    )


def torque(name: str, at: float, start: float, end: float) -> Stage:
    return Stage(name=name, kind="torque", speed=(at * RPM, at * RPM), torque=(start, end), duration=0.5)


def hold(name: str, at: float, value: float, duration: float = 1.0) -> Stage:
    return Stage(
        name=name,
        kind="hold",
        speed=(at * RPM, at * RPM),
        torque=(value, value),
        duration=duration,
        held=True,
    )


def p2() -> Schedule:
    """P2, Figure 9, with a way down."""
    return Schedule(
        stages=(
            torque("preload", 0, 0, 10),
            speed("to transition", 0, 750, 10),
            torque("half torque", 750, 10, 90),
            speed("run-up", 750, 12000, 90, 4.0),
            torque("full torque", 12000, 90, 180),
            hold("test", 12000, 180, 2.0),
            torque("unload", 12000, 180, 90),
            speed("run-down", 12000, 750, 90, 4.0),
            torque("to idle", 750, 90, 10),
            speed("stop", 750, 0, 10),
        )
    )


def test_s_function_is_smooth_at_both_ends() -> None:
    u = np.linspace(0.0, 1.0, 2001)
    values = s_function(u)
    assert (values[0], values[1000], values[-1]) == pytest.approx((0.0, 0.5, 1.0))
    assert np.all(np.diff(values) >= 0.0)
    assert s_derivative(u) == pytest.approx(np.gradient(values, u), abs=2e-3)
    assert s_derivative(u).max() == pytest.approx(1.875)
    ends = s_derivative(np.array([0.0, 1e-3, 1.0 - 1e-3, 1.0]))
    assert np.all(ends < 1e-4)


def test_commands_follow_the_stages_without_a_jump() -> None:
    schedule = p2()
    command = schedule.command(1e-3)
    assert command.time[-1] == schedule.duration == 14.5
    assert np.abs(np.diff(command.speed)).max() < 1.876 * 11250.0 * RPM / 4.0 * 1e-3
    assert np.abs(np.diff(command.torque)).max() < 1.9 * 90.0 / 0.5 * 1e-3
    integrated = np.concatenate(
        [[0.0], np.cumsum(0.5 * (command.acceleration[1:] + command.acceleration[:-1]) * 1e-3)]
    )
    assert integrated == pytest.approx(command.speed, abs=1e-3 * LIMITS.test_speed)
    middle = schedule.at(1.5 + 0.5 + 2.0)
    assert middle.speed[0] == pytest.approx(0.5 * 12750.0 * RPM)
    assert schedule.stages[middle.stage[0]].name == "run-up"
    assert [stage.name for stage in schedule.held] == ["test"]


def test_ramp_down_is_a_stage_like_any_other() -> None:
    down = p2().stages[7]
    assert down.actual_direction == "falling"
    assert replace(down, direction="falling") != down


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (
            lambda: replace(speed("down", 750, 12000, 90), direction="falling"),
            ["stage 'down'", "speed is falling", "is rising", "swap the values"],
        ),
        (lambda: replace(torque("t", 0, 0, 10), direction="falling"), ["torque is falling", "from 0 to 10"]),
        (lambda: replace(hold("h", 0, 1), direction="rising"), ["says 'rising' but is held"]),
        (
            lambda: replace(hold("h", 0, 1), speed=(0.0, 1.0)),
            ["stage 'h' of kind 'hold'", "speed goes from 0 to 1"],
        ),
        (
            lambda: replace(speed("s", 0, 750, 10), torque=(1.0, 2.0)),
            ["of kind 'speed'", "torque goes from 1 to 2"],
        ),
        (lambda: replace(speed("s", 0, 750, 10), held=True), ["is held while its speed changes"]),
        (lambda: hold("h", 0, 1, 0.0), ["duration = 0.0 s", "above 0"]),
        (lambda: hold("h", -5, 1), ["must not be below 0"]),
        (lambda: hold("h", 0, math.nan), ["must be finite"]),
        (lambda: Schedule(stages=()), ["no stage"]),
        (lambda: Schedule(stages=(hold("a", 0, 1), hold("a", 0, 1))), ["'a' is given 2 times"]),
        (
            lambda: Schedule(stages=(hold("a", 0, 1), hold("b", 0, 2))),
            ["stage 'b': torque starts at 2", "'a' ends at 1", "stage in between"],
        ),
        (lambda: p2().command(0.0), ["sample interval = 0.0 s"]),
    ],
)
def test_contradictions_are_refused(build: Callable[[], object], says: list[str]) -> None:
    with pytest.raises(ScheduleError) as caught:
        build()
    assert [part for part in says if part not in str(caught.value)] == []


def test_p2_keeps_its_own_ramp_rules() -> None:
    rules = ramp_rules(p2(), LIMITS)
    assert [rule.id for rule in rules if not rule.holds] == []
    assert {rule.id: rule.value for rule in rules} == pytest.approx(
        {
            "ramp.standstill_torque": 10.0,
            "ramp.start_torque": 10.0,
            "ramp.run_up_torque": 90.0,
            "ramp.test_torque": 180.0,
        }
    )


def change(schedule: Schedule, *values: float) -> Schedule:
    """P2's schedule with other torques: start, run-up, test."""
    start, run_up, test = values
    names = {10.0: start, 90.0: run_up, 180.0: test}
    return Schedule(
        stages=tuple(
            replace(s, torque=(names.get(s.torque[0], s.torque[0]), names.get(s.torque[1], s.torque[1])))
            for s in schedule.stages
        )
    )


@pytest.mark.parametrize(
    ("torques", "broken", "stage"),
    [
        ((9.0, 90.0, 180.0), "ramp.standstill_torque", "to transition"),
        ((11.0, 90.0, 180.0), "ramp.start_torque", "to transition"),
        ((10.0, 91.0, 180.0), "ramp.run_up_torque", "run-up"),
        ((10.0, 90.0, 181.0), "ramp.test_torque", "test"),
    ],
)
def test_each_rule_can_break(torques: tuple[float, float, float], broken: str, stage: str) -> None:
    rules = {rule.id: rule for rule in ramp_rules(change(p2(), *torques), LIMITS)}
    assert [name for name, rule in rules.items() if not rule.holds] == [broken]
    assert rules[broken].stage == stage


def test_losing_torque_at_speed_breaks_a_rule() -> None:
    stages = (*p2().stages[:6], torque("lost", 12000, 180, 2), speed("coast", 12000, 0, 2))
    rules = {rule.id: rule for rule in ramp_rules(Schedule(stages=stages), LIMITS)}
    assert not rules["ramp.standstill_torque"].holds
    assert rules["ramp.standstill_torque"].value == pytest.approx(2.0)
