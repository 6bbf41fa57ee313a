"""Points so slow that the loop follows quasi-statically."""

import numpy as np
import pytest

from rigdesign.coupling.preloaded_loop import respond
from rigdesign.prediction import memoisation as slow_response
from rigdesign.prediction.memoisation import respond_at_any_speed
from tests.builders.order import changed, settled, shipped


@pytest.fixture
def quasi_static(monkeypatch):
    """The response of a braced loop with every speed taken as slow."""

    def solve(one):
        monkeypatch.setattr(slow_response, "FOLLOWED", 0.0)
        return respond_at_any_speed(*one.arguments)

    return solve


def test_means_and_losses_are_those_of_harmonic_balance(quasi_static) -> None:
    """Below the resonances of the meshes only the swing about the mean differs."""
    one = settled(shipped("loop_1to1"), 400.0, 200.0)
    still, moving = quasi_static(one), respond(*one.arguments)
    assert moving.method == "harmonic_balance" and still.method == "quasi_static"
    assert still.mean == pytest.approx(moving.mean, rel=3e-3)
    assert still.drive_torque == pytest.approx(moving.drive_torque, rel=0.03)
    assert np.all(still.maximum - still.mean < moving.maximum - moving.mean)


def test_teeth_that_differ_are_in_it_over_a_turn(quasi_static) -> None:
    run_out = {"gearboxes__test__gears__pinion__flank__run_out": "30 um"}
    still, turning = (
        quasi_static(settled(changed("loop_1to1", **run_out, **period), 400.0, 200.0))
        for period in ({}, {"numerics__response_period": "revolution"})
    )
    assert still.method == turning.method == "quasi_static"
    assert np.ptp(turning.wave.torque[0]) > 1.3 * np.ptp(still.wave.torque[0])


def test_only_points_far_below_the_reach_of_harmonic_balance_are_quasi_static() -> None:
    assert respond_at_any_speed(*settled(shipped("loop_1to1"), 1.0, 200.0).arguments).method == "quasi_static"
    assert (
        respond_at_any_speed(*settled(shipped("loop_1to1"), 3000.0, 200.0).arguments).method
        == "harmonic_balance"
    )
