"""Kind of a motion from its periods and from how neighbouring motions part."""

import math

import numpy as np
import pytest

from dynamics.vibration.steady_motion import growth_per_period, kind_of, repeats_after, swings

STEPS = 32


def wave(order: float) -> np.ndarray:
    """Mesh period of 32 steps with a part of 1/order of its frequency, 48 periods of two meshes."""
    phase = 2.0 * np.pi * np.arange(48 * STEPS) / STEPS
    return np.array([np.cos(phase) + 0.3 * np.cos(phase / order), np.cos(phase)])


@pytest.mark.parametrize(("order", "periods"), [(1.0, 1), (2.0, 2), (5.0, 5), (math.e, 0)])
def test_fewest_periods_after_which_a_motion_repeats(order: float, periods: int) -> None:
    assert repeats_after(wave(order), STEPS) == periods


def beating(turns: float) -> np.ndarray:
    """Mesh period of 32 steps whose amplitude swings by a tenth, ``turns`` times over 480 periods, of two meshes."""
    phase = 2.0 * np.pi * np.arange(480 * STEPS) / STEPS
    return np.array([np.cos(phase) * (1.0 + 0.1 * np.sin(phase * turns / 480)), np.cos(phase)])


@pytest.mark.parametrize("turns", [0.25, 1.0, 5.0])
def test_a_slow_swing_shows_in_the_extremes_of_a_longer_time(turns: float) -> None:
    """From one period to the next it changes by less than what counts as a repetition."""
    force = beating(turns)
    waves = force.reshape(2, -1, STEPS)
    assert np.abs(np.diff(waves, axis=1)).max() < 0.01 * np.ptp(waves)
    extremes = np.stack((waves.min(axis=2), waves.max(axis=2)), axis=2)
    assert swings(extremes, 1, np.ptp(force[:, : 24 * STEPS], axis=1))
    assert repeats_after(force, STEPS) == 0


def test_a_motion_of_two_alternating_periods_does_not_swing() -> None:
    extremes = np.tile([[[-1.0, 1.2], [-0.9, 1.0]]], (2, 100, 1))
    assert not swings(extremes, 2, np.array([2.2, 2.2]))
    assert swings(extremes, 1, np.array([2.2, 2.2]))


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
