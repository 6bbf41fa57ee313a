"""How steep orders are near natural frequencies."""

import numpy as np
import pytest

from rigdesign.diagnosis.statistics.columns import amplitudes_of
from rigdesign.diagnosis.statistics.resonance import DAMPING_RATIO, FREQUENCY_ERROR, Resonances
from rigdesign.prediction.model import Feature, OperatingCondition

SETTINGS = (
    OperatingCondition(name="slow", speed=100.0, torque=50.0),
    OperatingCondition(name="fast", speed=300.0, torque=50.0),
)
MODES = np.array([1000.0, 6000.0])


def number(setting: str, order: float, part: str = "real", channel: str = "M") -> Feature:
    return Feature(channel, setting, order, part if order else "value")


def resonances(features, modes=MODES) -> Resonances:
    """Of a rig with 28 teeth on the reference gear, ``phi`` an angle."""
    of_angle = np.array([one.channel == "phi" for one in features])
    return Resonances(features=features, settings=SETTINGS, modes=modes, of_angle=of_angle, teeth=28)


def test_an_order_follows_its_frequency_as_the_circuit_does():
    """Of H = 1 / (1 - (f/f_i)^2) near f_i, by a difference."""
    frequency, step = 1150.0, 1e-6
    gain = [1.0 / (1.0 - (f / 1000.0) ** 2) for f in (frequency * np.exp(-step), frequency * np.exp(step))]
    slope = abs(np.log(gain[1] / gain[0])) / (2.0 * step)
    (found,) = resonances([number("slow", 11.5)], MODES[:1]).steepness
    assert found == pytest.approx(slope, rel=0.25)


def test_steepness_is_the_mean_square_over_where_the_natural_frequency_may_be():
    features = [number("slow", order) for order in (10.0, 10.3, 12.0)]
    found = resonances(features, MODES[:1]).steepness
    share = np.linspace(-12.0, 12.0, 400_001)
    weight = np.exp(-0.5 * share**2)
    for one, feature in zip(found, features, strict=True):
        away = 1.0 - feature.order / 10.0 + FREQUENCY_ERROR * share
        square = np.sum(weight / (away**2 + DAMPING_RATIO**2)) / np.sum(weight)
        assert one == pytest.approx(np.sqrt(square), rel=1e-3)


def test_the_nearest_natural_frequency_counts():
    features = [number("slow", 10.0), number("fast", 10.0), number("fast", 20.0), number("slow", 0.0)]
    at, between, on, mean = resonances(features).steepness
    assert at == on > 100.0
    assert between == pytest.approx(2.0, rel=0.01)
    assert mean == 0.0


def test_orders_far_below_a_natural_frequency_hardly_notice_where_it_is():
    """Of H = 1 / (1 - (f/f_i)^2), by a difference."""
    features = [number("slow", order) for order in (0.1, 2.0, 8.5, 12.0)]
    found = resonances(features, MODES[:1]).shift(np.ones(4))
    for one, feature in zip(found, features, strict=True):
        gain = [1.0 / (1.0 - (100.0 * feature.order / f) ** 2) for f in (999.0, 1001.0)]
        assert one == pytest.approx(abs(np.log(gain[1] / gain[0])) / 0.002, rel=0.5)


def test_numbers_of_no_order_and_rigs_without_natural_frequencies_are_not_steep():
    assert not resonances([Feature("T", "slow")]).steepness.any()
    assert not resonances([number("slow", 10.0)], np.zeros(0)).steepness.any()
    assert not resonances([number("slow", 10.0)], np.zeros(0)).change(np.ones(1)).any()


def test_a_loop_that_turns_as_a_whole_follows_the_sidebands_of_the_meshes():
    """At 100 rad/s sideband 29 is a quarter below 4000 rad/s; what is there at 300 rad/s too is wind-up."""
    features = [number(setting, 1.0, channel=name) for name in ("M", "phi") for setting in ("slow", "fast")]
    amplitude = np.array([8.0, 2.0, 8.0, 2.0])
    torque, _, angle, least = resonances(features, np.array([4000.0])).change(amplitude)
    assert torque == pytest.approx(8.0 / (1.0 - 100.0 / 4000.0), rel=0.01)
    assert angle == pytest.approx(np.hypot(torque, (8.0 - 2.0) / (1.0 - 2900.0 / 4000.0)), rel=0.01)
    assert least == pytest.approx(2.0 / (1.0 - 300.0 / 4000.0), rel=0.01)
    # orders of half the meshes and more are no common rotation
    features = [number("slow", 14.0, channel="phi"), number("fast", 14.0, channel="phi")]
    both = resonances(features, np.array([4000.0]))
    assert both.change(amplitude[:2]) == pytest.approx(both.steepness * amplitude[:2])


def test_at_one_point_all_of_an_angle_may_be_the_loop_as_a_whole():
    (found,) = resonances([number("slow", 1.0, channel="phi")], np.array([4000.0])).change(np.array([6.0]))
    assert found == pytest.approx(np.hypot(6.0 / (1.0 - 0.025), 6.0 / (1.0 - 0.725)), rel=0.01)


def test_both_parts_of_an_order_have_its_amplitude():
    features = [
        number("slow", 2.0),
        number("slow", 2.0, "imaginary"),
        number("slow", 0.0),
        Feature("T", "slow"),
    ]
    assert amplitudes_of(features, np.array([3.0, -4.0, 7.0, 300.0])) == pytest.approx([5.0, 5.0, 0.0, 0.0])
