"""Kind of a motion from its periods and from how neighbouring motions part."""

import math

import numpy as np
import pytest

from dynamics.response.motion_kind import growth_per_period, kind_of, repeats_after

STEPS = 32


def wave(order: float) -> np.ndarray:
    """Mesh period of 32 steps with a part of 1/order of its frequency, 48 periods of two meshes."""
    phase = 2.0 * np.pi * np.arange(48 * STEPS) / STEPS
    return np.array([np.cos(phase) + 0.3 * np.cos(phase / order), np.cos(phase)])


@pytest.mark.parametrize(("order", "periods"), [(1.0, 1), (2.0, 2), (5.0, 5), (math.e, 0)])
def test_fewest_periods_after_which_a_motion_repeats(order: float, periods: int) -> None:
    assert repeats_after(wave(order), STEPS) == periods


def test_motion_without_force_repeats_at_once() -> None:
    assert repeats_after(np.zeros((2, 4 * STEPS)), STEPS) == 1


@pytest.mark.parametrize("rate", [0.2, -0.1, 0.0])
def test_growth_is_that_of_an_exponential_up_to_its_saturation(rate: float) -> None:
    distance = np.minimum(1e-9 * np.exp(rate * np.arange(120)), 0.5)
    assert growth_per_period(distance) == pytest.approx(rate, abs=1e-9)


def test_names() -> None:
    assert str(kind_of(1)) == "periodic"
    assert str(kind_of(3)) == "subharmonic, repeats after 3 periods"
    assert kind_of(0, 0.1).kind == "chaotic" and "exp(0.100)" in str(kind_of(0, 0.1))
    assert kind_of(0, -0.01).kind == "quasi-periodic" and "does not grow" in str(kind_of(0, -0.01))
