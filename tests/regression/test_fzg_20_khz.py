"""An FZG rig with lightly damped shaft modes at half its sample rate keeps its speed.

Its shafts have modes at 10.3 kHz that nothing damps; at 20 kHz they once grew by drag torques that were held over a
sample, until the stage was refused as "too slow" by tens of rpm.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from dynamics.rotor.torsional_modes import loop_modes, modes_above_samples
from dynamics.vibration.time_response import TimeResponse
from rigdesign.case import load_case
from rigdesign.coupling.loop import PointResult, solve_point
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.time_run import held_points, run_ramp, schedule_of
from rigdesign.rig.model import Rig, build_rig
from tests.builders.undamped_shafts import undamped_shafts

CASE = Path(__file__).parent / "fzg_20_kHz"
RPM = np.pi / 30.0


@cache
def solved() -> tuple[Rig, PointResult]:
    rig = build_rig(load_case(CASE), "quick")
    return rig, solve_point(rig, held_points(rig)[0])


@cache
def run() -> TimeResponse:
    rig, point = solved()
    assert point.setting is not None
    return run_ramp(rig, point.last, point.setting, point.last.coupling_state)


def last(stage: str, seconds: float = 0.3) -> np.ndarray:
    """Speeds [rpm] in the last seconds of a stage."""
    rig, _ = solved()
    schedule, response = schedule_of(rig), run()
    end = schedule.starts[1 + [entry.name for entry in schedule.stages].index(stage)]
    return np.asarray(response.speed[(response.time > end - seconds) & (response.time <= end)] / RPM)


def test_rig_stands_still_before_it_turns() -> None:
    """It creeps to rest against the lips of its shaft exits: 1.5 rpm after 0.9 s, 0.007 rpm after 1.2 s.

    With the teeth summed slice by slice it came to rest 0.3 s earlier. Step count and the modes that give way to drags
    are not the cause; that the tables turn friction over a range of speeds may be.
    """
    assert np.abs(last("bracing", 0.01)).max() < 0.01
    assert np.abs(last("bracing", 0.05)).max() < 0.1


def test_rig_keeps_its_test_speed() -> None:
    """The mesh ripple of 600 Hz remains: 0.14 rpm."""
    assert last("test").mean() == pytest.approx(2250.0, abs=0.01)
    assert last("test").std() < 0.2
    assert run().unconverged_steps == 0


def test_modes_beyond_the_samples_are_named() -> None:
    """Of shafts without damping of their own; that of steel, as a damper, leaves none of them to be seen."""
    damped, point = solved()
    drivetrain = build_rig(damped.case.with_values(undamped_shafts(damped.case)), "quick").drivetrain
    assert drivetrain is not None
    texts = modes_above_samples(loop_modes(drivetrain, laws_of(point.last.models), 50e3), 20e3)
    named = next(text for text in texts if "10.34 kHz" in text)
    assert "slave_wheel" in named
    assert "show it at 9.66 kHz" in named
