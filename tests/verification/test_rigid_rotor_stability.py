"""Stability of a rigid rotor on a bearing against the roots of its motion."""

import math
from typing import Any

import numpy as np
import pytest

from dynamics.errors import DynamicsInputError
from dynamics.rotor.bearing import LateralCoefficients
from tests.builders.rotor_stability import rotor_stability, threshold_speed

SKEWED = ([[2.1e8, 0.9e8], [-1.6e8, 0.8e8]], [[2.2e5, 0.4e5], [0.4e5, 1.5e5]])


def bearing(stiffness: Any, damping: Any) -> LateralCoefficients:
    return LateralCoefficients(
        stiffness=np.array(stiffness), damping=np.array(damping), position=np.zeros(2), regime="constant"
    )


def growth(stiffness: Any, damping: Any, mass: float) -> complex:
    """Root of det(m s^2 + C s + K) that grows fastest."""
    lower = np.hstack([-np.array(stiffness) / mass, -np.array(damping) / mass])
    roots = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower]))
    return complex(roots[np.argmax(roots.real)])


@pytest.mark.parametrize(
    "coefficients",
    [
        ([[1.0e8, 1.5e8], [-2.0e8, 1.2e8]], [[2.2e5, 0.4e5], [0.4e5, 1.5e5]]),
        ([[0.2e8, 3.0e8], [-2.0e8, 0.5e8]], [[5.0e5, 0.2e5], [0.2e5, 4.0e5]]),
    ],
)
def test_at_the_critical_mass_a_root_is_imaginary(coefficients: Any) -> None:
    found = rotor_stability(bearing(*coefficients))
    root = growth(*coefficients, found.critical_mass)
    assert root.real == pytest.approx(0.0, abs=1e-6 * found.whirl_frequency)
    assert abs(root.imag) == pytest.approx(found.whirl_frequency, rel=1e-6)
    assert found.equivalent_stiffness == pytest.approx(found.critical_mass * found.whirl_frequency**2)
    assert growth(*coefficients, 0.99 * found.critical_mass).real < 0.0
    assert growth(*coefficients, 1.01 * found.critical_mass).real > 0.0


def test_whirl_of_pure_cross_coupling() -> None:
    """K = [[k, s], [-s, k]], C = c I: nu = s / c, m = k c^2 / s^2."""
    found = rotor_stability(bearing([[4e7, 1e8], [-1e8, 4e7]], 2e5 * np.eye(2)))
    assert found.whirl_frequency == pytest.approx(500.0)
    assert found.critical_mass == pytest.approx(4e7 / 500.0**2)
    assert found.whirl_ratio(1000.0) == pytest.approx(0.5)


def test_symmetric_stiffness_is_stable_for_every_mass() -> None:
    found = rotor_stability(bearing([[2e8, 1e7], [1e7, 1e8]], [[1e5, 0.0], [0.0, 2e5]]))
    assert math.isinf(found.critical_mass)
    assert found.whirl_frequency == 0.0
    assert growth([[2e8, 1e7], [1e7, 1e8]], [[1e5, 0.0], [0.0, 2e5]], 1e4).real < 0.0


@pytest.mark.parametrize("stiffness", [[[0.0, 1e8], [-1e8, 0.0]], [[1e8, 2e8], [2e8, 1e8]]])
def test_skew_or_indefinite_stiffness_is_stable_for_none(stiffness: Any) -> None:
    assert rotor_stability(bearing(stiffness, 1e5 * np.eye(2))).critical_mass == 0.0
    assert growth(stiffness, 1e5 * np.eye(2), 1.0).real > 0.0


def test_moderate_cross_coupling_with_unlike_axes_is_stable() -> None:
    assert math.isinf(rotor_stability(bearing([[6e8, 1e8], [-0.2e8, 0.5e8]], SKEWED[1])).critical_mass)


def test_no_damping_no_threshold() -> None:
    with pytest.raises(DynamicsInputError, match="damping"):
        rotor_stability(bearing(1e8 * np.eye(2), np.zeros((2, 2))))


def running(omega: float) -> LateralCoefficients:
    """Half-speed whirl of a film with a stiffness that stays: m omega^2 / 4 = k at the threshold."""
    skew = 0.5 * omega * 1e5
    return bearing([[1e7, skew], [-skew, 1e7]], 1e5 * np.eye(2))


def test_threshold_speed_by_hand() -> None:
    threshold = threshold_speed(running, 2.0, 10.0, 1e5)
    assert threshold == pytest.approx(2.0 * math.sqrt(1e7 / 2.0), rel=1e-5)


def test_threshold_outside_of_the_range() -> None:
    assert threshold_speed(running, 2.0, 10.0, 4000.0) is None
    assert threshold_speed(running, 2.0, 5000.0, 9000.0) == pytest.approx(5000.0)
    with pytest.raises(DynamicsInputError, match="speeds"):
        threshold_speed(running, 2.0, 0.0, 100.0)
