"""Records of the time run: the flank that carries, the stage that is hit, the mesh that is meant."""

from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.vibration.time_response import EnvelopeWindows, LiftOff
from rigdesign.case import load_case
from rigdesign.coupling.time_run import schedule_of
from rigdesign.postprocessing import dynamics as time_run
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

WINDOW = 0.01


@cache
def rig() -> Rig:
    return build_rig(load_case(CASES / "uhcf_prototype"), "quick")


def run(lift_off: tuple[LiftOff, ...] = ()) -> Any:
    """The schedule as commanded; mesh 0 carries on the front flank, mesh 1 on the back flank.

    The torque swings by a tenth, in one window of the run-up by a half, in mesh 1 more than in mesh 0.
    """
    schedule = schedule_of(rig())
    time = WINDOW * np.arange(1, round(schedule.duration / WINDOW) + 1)
    command = schedule.at(time - 0.5 * WINDOW)
    swing = np.full(time.size, 0.1)
    swing[500] = 0.5
    mean = np.stack((command.torque, -1.04 * command.torque))
    half = np.stack((swing, 1.2 * swing)) * np.abs(mean)
    windows = EnvelopeWindows(
        duration=WINDOW, time=time, speed=command.speed, least=mean - half, mean=mean, greatest=mean + half,
        out_of_contact=np.where(np.arange(time.size) < 151, 0.6, 0.2) * np.ones((2, 1)),
        longest_gap=np.full(mean.shape, 1e-3),
    )  # fmt: skip
    return SimpleNamespace(
        windows=windows, lift_off=lift_off, time=time, drive_torque=np.full(time.size, 9.0)
    )


def test_the_peak_of_a_mesh_on_its_back_flank_is_its_highest_torque() -> None:
    windows = run().windows
    assert time_run.torque_peak(windows, 0) == pytest.approx(180.0 * 1.1)
    assert time_run.torque_peak(windows, 1) == pytest.approx(1.04 * 180.0 * 1.12)
    history = time_run.ramp_history(rig(), run())
    for mesh, name in enumerate(("test", "reference")):
        assert max(history.torque[name]["maximum"]) == pytest.approx(time_run.torque_peak(windows, mesh))
        assert min(history.torque[name]["mean"]) > 0.0


def test_loads_of_a_stage_are_those_of_its_worst_slot() -> None:
    loads = {load.stage: load for load in time_run.stage_loads(rig(), run(), 1)}
    load = loads["run_up"]
    assert load.dynamic_factor == pytest.approx(1.6)
    assert load.least_share == pytest.approx(0.4)
    assert load.mean == pytest.approx(1.04 * 90.0)
    assert load.speed == load.least_share_speed == pytest.approx(run().windows.speed[500])
    assert loads["test"].peak == pytest.approx(1.04 * 180.0 * 1.12)
    assert "bracing" not in loads


def test_a_loss_of_contact_over_two_stages_is_counted_in_both() -> None:
    """From 1.2 to 1.8 s: the stage at the start torque ends at 1.5 s, the next one begins there."""
    lost = LiftOff(mesh=0, start=1.2, end=1.8, out_of_contact=0.4, longest_gap=1e-3)
    other = LiftOff(mesh=1, start=3.0, end=3.1, out_of_contact=0.4, longest_gap=1e-3)
    first, second = time_run.contact_losses(rig(), run((lost, other)), 0)
    assert (first.stage, second.stage) == ("to_transition_speed", "half_torque")
    assert (first.end, second.start) == pytest.approx((1.5, 1.5))
    assert first.share == pytest.approx(0.6)
    assert second.share == pytest.approx((0.6 + 29 * 0.2) / 30.0)
