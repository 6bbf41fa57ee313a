"""How steep orders are near natural frequencies."""

import numpy as np
import pytest

from rigdesign.diagnosis.statistics.columns import amplitudes_of
from rigdesign.diagnosis.statistics.resonance import BLURRED, steepness
from rigdesign.prediction.model import Feature, OperatingCondition

SETTINGS = (
    OperatingCondition(name="slow", speed=100.0, torque=50.0),
    OperatingCondition(name="fast", speed=300.0, torque=50.0),
)
MODES = np.array([1000.0, 6000.0])


def number(setting: str, order: float, part: str = "real") -> Feature:
    return Feature("M", setting, order, part if order else "value")


def test_an_order_follows_its_frequency_as_the_circuit_does():
    """Of H = 1 / (1 - (f/f_i)^2) near f_i, by a difference."""
    frequency, step = 1150.0, 1e-6
    gain = [1.0 / (1.0 - (f / 1000.0) ** 2) for f in (frequency * np.exp(-step), frequency * np.exp(step))]
    slope = abs(np.log(gain[1] / gain[0])) / (2.0 * step)
    (found,) = steepness([number("slow", 11.5)], SETTINGS, MODES[:1])
    assert found == pytest.approx(slope, rel=0.25)


def test_the_nearest_natural_frequency_counts_and_no_order_is_steeper_than_the_model_knows():
    features = [number("slow", 10.0), number("fast", 10.0), number("fast", 20.0), number("slow", 0.0)]
    at, between, on, mean = steepness(features, SETTINGS, MODES)
    assert at == on == pytest.approx(1.0 / BLURRED)
    assert between == pytest.approx(1.0 / np.hypot(0.5, BLURRED))
    assert mean == 0.0


def test_numbers_of_no_order_and_rigs_without_natural_frequencies_are_not_steep():
    assert not steepness([Feature("T", "slow")], SETTINGS, MODES).any()
    assert not steepness([number("slow", 10.0)], SETTINGS, np.zeros(0)).any()


def test_both_parts_of_an_order_have_its_amplitude():
    features = [
        number("slow", 2.0),
        number("slow", 2.0, "imaginary"),
        number("slow", 0.0),
        Feature("T", "slow"),
    ]
    assert amplitudes_of(features, np.array([3.0, -4.0, 7.0, 300.0])) == pytest.approx([5.0, 5.0, 0.0, 0.0])
