"""How large a cause would have to be to explain a residual."""

import numpy as np
import pytest

from rigdesign.diagnosis.statistics.detectability import ResidualMetric, straight

NOISE = np.diag([0.1, 0.1]) ** 2
GAP = np.array([0.0, -2.0])


def test_a_cause_in_proportion_needs_the_size_that_meets_the_gap() -> None:
    size = ResidualMetric(GAP, NOISE).of_columns(np.array([[0.0], [-0.5]]), bound=1.0)
    assert size is not None
    assert size.coordinates[0] == pytest.approx(4.0)
    assert size.share == pytest.approx(1.0) and size.reach == pytest.approx(4.0)


def test_a_cause_that_moves_all_numbers_alike_explains_no_change() -> None:
    """Where the scale of the sensor is free, as a change from point to point is all that counts."""
    free = NOISE + 1e4 * np.ones((2, 2))
    alike = ResidualMetric(GAP, free).of_columns(np.array([[1.0], [1.0]]), bound=5.0)
    assert alike is not None and alike.share < 0.01
    one = ResidualMetric(GAP, free).of_columns(np.array([[0.0], [1.0]]), bound=5.0)
    assert one is not None and one.coordinates[0] == pytest.approx(-2.0, rel=1e-3)


def test_a_cause_that_moves_nothing_has_no_size() -> None:
    assert ResidualMetric(GAP, NOISE).of_columns(np.zeros((2, 1)), bound=1.0) is None
    assert ResidualMetric(GAP, NOISE).of_runs(np.array([0.0, 1.0]), np.zeros((2, 2)), bound=1.0) is None


def test_runs_are_followed_straight_and_continued_beyond_the_last() -> None:
    places = np.array([0.0, 1.0, -1.0])
    answers = np.array([[0.0, 0.0], [0.0, -1.0], [0.0, -0.5]])
    within = ResidualMetric(0.4 * GAP, NOISE).of_runs(places, answers, bound=1.0)
    assert within is not None and not within.extrapolated
    assert within.coordinates[0] == pytest.approx(0.8) and within.share == pytest.approx(1.0)
    beyond = ResidualMetric(GAP, NOISE).of_runs(places, answers, bound=1.0)
    assert beyond is not None and beyond.extrapolated
    assert abs(beyond.coordinates[0]) in (pytest.approx(2.0), pytest.approx(4.0))


def test_answers_are_straight_between_runs_and_beyond() -> None:
    places, answers = np.array([0.0, 2.0, -1.0]), np.array([[0.0], [4.0], [-1.0]])
    assert straight(places, answers, 1.0) == pytest.approx([2.0])
    assert straight(places, answers, 3.0) == pytest.approx([6.0])
    assert straight(places, answers, -2.0) == pytest.approx([-2.0])
