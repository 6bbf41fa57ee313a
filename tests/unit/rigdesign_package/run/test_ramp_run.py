"""End speeds of the stages of a time run: what is said when the rig is elsewhere."""

from functools import cache
from types import MethodType, SimpleNamespace
from typing import cast

import numpy as np
import pytest

from dynamics.vibration.march_inputs import DriveState
from dynamics.vibration.time_response import EnvelopeWindows, LiftOff, TimeResponse
from rigdesign.case import load_case
from rigdesign.checks.registry import REGISTRY
from rigdesign.coupling.time_run import (
    WINDOW,
    mesh_synchronous_window,
    missed_stage,
    schedule_of,
    torque_limits,
)
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
RPM = np.pi / 30.0


@cache
def rig() -> Rig:
    return build_rig(load_case(PROTOTYPE), "quick")


def response(stage: str, excess_rpm: float, drive: float) -> TimeResponse:
    """A run that follows its schedule but for the end of one stage."""
    schedule = schedule_of(rig())
    names = [entry.name for entry in schedule.stages]
    command = schedule.command(1e-3)
    end = schedule.starts[names.index(stage) + 1]
    late = (command.time > end - 0.05) & (command.time <= end)
    return run_of(command.time, command.speed + np.where(late, excess_rpm * RPM, 0.0), drive)


def run_of(
    time: np.ndarray, speed: np.ndarray, drive: float, angle: np.ndarray | None = None
) -> TimeResponse:
    """A run with these samples of the speed; its angle is their integral if it is not given."""
    turned = np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time))))
    run = SimpleNamespace(
        time=time,
        speed=speed,
        speed_command=speed,
        angle=turned if angle is None else angle,
        drive_torque=np.full(len(speed), drive),
        drag_torque={"test.pinion": np.full(len(speed), 1.5), "test.wheel": np.full(len(speed), 2.0)},
    )
    run.mean_speed = MethodType(TimeResponse.mean_speed, run)
    return cast("TimeResponse", run)


def complaint(stage: str, excess_rpm: float, drive: float = 20.0) -> str:
    found = missed_stage(rig(), schedule_of(rig()), response(stage, excess_rpm, drive))
    assert found is not None and schedule_of(rig()).stages[found[0]].name == stage
    return found[1]


@pytest.mark.parametrize(
    ("stage", "excess", "words"),
    [
        ("run_up", -300.0, ("'run_up' does not reach its speed: 11700 rpm against 12000 rpm at 10.00 s",)),
        ("run_up", 200.0, ("'run_up' overshoots its speed by 200 rpm: 12200 rpm against 12000 rpm",)),
        ("run_down", 500.0, ("does not come down to its speed, 500 rpm are left: 1250 rpm against 750 rpm",)),
        ("run_down", -400.0, ("'run_down' falls through its speed by 400 rpm: 350 rpm against 750 rpm",)),
        ("test", -130.0, ("'test' does not hold its speed, 130 rpm too slow: 11870 rpm against 12000 rpm",)),
        ("half_torque", 150.0, ("'half_torque' does not hold its speed, 150 rpm too fast",)),
        ("to_standstill", -150.0, ("falls through its speed by 150 rpm: -150 rpm against 0 rpm",)),
    ],
)
def test_stage_that_ends_at_another_speed(stage: str, excess: float, words: tuple[str, ...]) -> None:
    text = complaint(stage, excess)
    for part in (*words, "limit 120 rpm", "motor 20.00 N m", "torque_limit 20.00 N m", "seals 3.50 N m"):
        assert part in text


def test_remedy_follows_the_motor() -> None:
    assert complaint("run_up", -300.0, 20.0).endswith("raise the limit or give the stage more time")
    assert complaint("run_down", 300.0, -20.0).endswith("raise the limit or give the stage more time")
    assert "stiffen the shaft between motor and gears" in complaint("run_down", -300.0, 5.0)


def test_a_constant_drive_torque_limits_its_own_stage_only() -> None:
    paper = build_rig(
        load_case(PROTOTYPE / "run_up_simulation.toml").with_value("drivetrain.motor.torque_limit", "15 N m")
    )
    names = [stage.name for stage in schedule_of(paper).stages]
    assert dict(zip(names, torque_limits(paper))) == pytest.approx(
        {"bracing": 15.0, "run_up": 9.0, "test": 15.0}
    )


@pytest.mark.parametrize("excess", [-100.0, 100.0])
def test_within_the_tolerance(excess: float) -> None:
    assert missed_stage(rig(), schedule_of(rig()), response("run_up", excess, 20.0)) is None


def test_a_run_that_diverges_is_no_weak_motor() -> None:
    schedule = schedule_of(rig())
    command = schedule.command(1e-3)
    shaken = command.speed + np.where(command.time > 3.0, 30000.0 * RPM * np.sin(500.0 * command.time), 0.0)
    run = run_of(command.time, shaken, 20.0)
    run.speed_command = command.speed
    number, text = missed_stage(rig(), schedule, run) or (-1, "")
    assert schedule.starts[number] <= 3.01 <= schedule.starts[number + 1]
    assert "diverges" in text and "its torque is not too small" in text and "raise the limit" not in text


def test_a_missed_stage_leaves_what_comes_before_it() -> None:
    """The run ends before the stage; checks over it name the stage and its reason, those of held stages stay."""
    windows = EnvelopeWindows(
        duration=0.5, time=0.5 * np.arange(1.0, 9.0), speed=np.ones(8),
        **{name: np.ones((1, 8)) for name in ("least", "mean", "greatest", "out_of_contact", "longest_gap")},
    )  # fmt: skip
    time = 0.01 * np.arange(1.0, 401.0)
    whole = TimeResponse(
        time=time, speed=time, speed_command=time, drive_torque=time, twist=time, angle=time, drag_torque={"a": time},
        torque=np.ones((1, 800), np.float32), torque_step=0.005, windows=windows,
        lift_off=tuple(LiftOff(mesh=0, start=at, end=3.5, out_of_contact=0.1, longest_gap=0.1) for at in (1.0, 3.2)),
        energy=None,
        drive_limited_share=0.0, speed_missed=0.0, end=DriveState(angles=time, speeds=time), unconverged_steps=0,
    )  # fmt: skip
    cut = whole.until(3.0, "stage 'run_down' does not come down")
    assert (
        cut.time[-1] == pytest.approx(3.0)
        and cut.windows.time[-1] == 3.0
        and cut.windows.mean.shape == (1, 6)
    )
    assert (
        cut.torque.shape == (1, 600)
        and [one.end for one in cut.lift_off] == [3.0]
        and len(cut.drag_torque["a"]) == 300
    )
    solved = cast("SolvedRig", SimpleNamespace(run=SimpleNamespace(ramp=cut), case=rig().case))
    ramp_peak, kv = (
        next(family for family in REGISTRY.families() if family.key == key)
        for key in ("dynamics.ramp_peak", "dynamics.dynamic_factor")
    )
    assert "after 3.00 s, which were not evaluated: stage 'run_down'" in ramp_peak.cut_run(solved)
    assert kv.cut_run(solved) == "" and ramp_peak.cut_run(SimpleNamespace(run=None)) == ""


def test_a_vibration_is_no_lack_of_speed() -> None:
    """A mode of 20.68 kHz at 40 kHz looks like a slow swing of 700 rpm; the angle knows the mean."""
    schedule = schedule_of(rig())
    command = schedule.command(1.0 / 40e3)
    omega, swing = 2.0 * np.pi * 20.68e3, 700.0 * RPM
    speed = command.speed + swing * np.cos(omega * command.time)
    angle = np.cumsum(command.speed) / 40e3 + swing / omega * np.sin(omega * command.time)
    ends = np.searchsorted(command.time, schedule.starts[1:] - 1e-9)
    assert np.abs(speed - command.speed)[ends].max() > 200.0 * RPM
    assert missed_stage(rig(), schedule, run_of(command.time, speed, 20.0, angle)) is None


@pytest.mark.parametrize("rpm", [12000.0, 750.0, 61.0, 30.0])
def test_the_window_of_a_mean_speed_is_whole_mesh_periods(rpm: float) -> None:
    """As many as fill one window; a single one where a period is longer."""
    period = 60.0 / (rpm * 99.0)
    window = mesh_synchronous_window(rig(), rpm * RPM, 1.0)
    assert window / period == pytest.approx(round(window / period), rel=1e-12)
    assert WINDOW <= window < WINDOW + period


def test_the_window_of_a_mean_speed_ends_with_its_stage() -> None:
    assert mesh_synchronous_window(rig(), 750.0 * RPM, 4e-3) == 4e-3
    assert mesh_synchronous_window(rig(), 0.0, 1.0) == pytest.approx(WINDOW)
