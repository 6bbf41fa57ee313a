"""Backward differences over growing steps: closed form of a lumped body, order in time, the adaptive march."""

import numpy as np
import pytest

from tests.builders.two_blocks import CONDUCTIVITY, conditions, two_blocks
from thermal.conduction.steady import ConductionSetup, solve_steady
from thermal.transient.history import StepControl, ThermalStage, solve_transient
from thermal.transient.time_steps import SPREAD, STEPS, WarmingBody, step_lengths

START, BATH, CAPACITY = 293.15, 393.15, 3.6e6


def lumped(time_constants: float, count: int = STEPS) -> float:
    """Share of the rise of a lumped body that is missing after a time in time constants."""
    body = WarmingBody({}, START)
    for length in step_lengths(time_constants, count):
        step = body.step(length, "stored")
        body = body.after(np.atleast_1d((step.start + step.time * BATH) / (1.0 + step.time)), length)
    return float((BATH - body.latest[0]) / (BATH - START))


def test_steps_grow_evenly_and_add_up() -> None:
    lengths = step_lengths(3600.0)
    assert lengths.sum() == pytest.approx(3600.0)
    assert lengths[-1] / lengths[0] == pytest.approx(SPREAD)
    np.testing.assert_allclose(lengths[1:] / lengths[:-1], SPREAD ** (1.0 / (STEPS - 1)))


@pytest.mark.parametrize("time", [0.05, 0.3, 1.0, 2.0, 6.0, 50.0])
def test_a_lumped_body_warms_up_by_its_time_constant(time: float) -> None:
    """exp(-t/tau) is missing of a rise; one implicit step would leave tau/(tau + t), at 6 time constants 14 %."""
    assert lumped(time) == pytest.approx(np.exp(-time), abs=5e-3)


def test_the_order_in_time_is_two() -> None:
    errors = [abs(lumped(1.0, count) - np.exp(-1.0)) for count in (24, 48, 96)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 2.0) < 0.15), orders


def test_the_rate_at_the_end_is_that_of_the_last_step() -> None:
    body = WarmingBody({}, START)
    for length in step_lengths(1.0, 96):
        step = body.step(length, "stored")
        body = body.after(np.atleast_1d((step.start + step.time * BATH) / (1.0 + step.time)), length)
    rate = float((body.latest - step.start)[0] / step.time)
    assert rate == pytest.approx((BATH - START) * np.exp(-1.0), rel=1e-3)


@pytest.mark.parametrize("time", [600.0, 3600.0])
def test_two_blocks_warm_up_as_the_adaptive_march_says(time: float) -> None:
    setup = ConductionSetup(two_blocks(), CONDUCTIVITY)
    capacity = dict.fromkeys(setup.mesh.bodies, CAPACITY)
    stage = ThermalStage(name="warm", duration=time, conditions=conditions())
    steps = StepControl(tolerance=1e-3)
    exact = solve_transient(setup, capacity, [stage], START, steps=steps).temperature
    body, near = WarmingBody(capacity, START), None
    for length in step_lengths(time):
        near = solve_steady(setup, [*conditions(), body.step(length, "stored")], near=near)
        body = body.after(near.temperature, length)
    assert np.abs(near.temperature - exact).max() < 0.01 * np.abs(exact - START).max()
