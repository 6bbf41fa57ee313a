"""Weights of a torque within a step: exact for what each hold is exact for, and the same forward and backward."""

import numpy as np
import pytest
from scipy.integrate import quad_vec

from dynamics.vibration.propagator import FASTEST, numerov, phi, straight_line

POLES = np.array([1e-9j, 1e-4j, 0.01j, 0.3j, 1.4j, -0.2 + 0.9j, -1.2, -1e-6])


@pytest.mark.parametrize("power", [0, 2])
def test_numerov_is_exact_in_the_displacement_for_parabolas(power: int) -> None:
    """x'' + w^2 x = t^power: three successive displacements fit what the two steps between them give."""
    omega = np.array([1e-3, 0.2, 0.7, 1.4])
    x = 1j * omega
    a, end = phi(1, x) - numerov(x).state, numerov(x).state

    def exact(t: float) -> np.ndarray:
        return np.array([1.0 / omega**2, t**2 / omega**2 - 2.0 / omega**4][power // 2] + 0.0 * omega)

    # z = v + i w x; the speed that fits the first step shall fit the second
    first, middle, last = exact(-1.0), exact(0.0), exact(1.0)
    push_1 = a * (-1.0) ** power + end * 0.0**power
    push_2 = a * 0.0**power + end
    rotation = np.exp(x)
    # imaginary part of z at the end of the first step gives the speed at its start
    speed = (omega * middle - (rotation * 1j * omega * first + push_1).imag) / rotation.imag
    now = rotation * (speed + 1j * omega * first) + push_1
    then = rotation * (now.real + 1j * omega * middle) + push_2
    scale = np.abs(last).max() + np.abs(middle)
    np.testing.assert_allclose(then.imag / omega, last, atol=3e-9 * scale.max())


def test_a_step_back_undoes_a_step_forward() -> None:
    start, end = phi(1, POLES) - numerov(POLES).state, numerov(POLES).state
    np.testing.assert_allclose(start, np.exp(POLES) * numerov(-POLES).state, atol=1e-14)
    np.testing.assert_allclose(end, np.exp(POLES) * (phi(1, -POLES) - numerov(-POLES).state), atol=1e-14)


@pytest.mark.parametrize("hold", [numerov, straight_line])
def test_turn_is_the_integral_of_the_state(hold) -> None:
    """Without rigid motion what has turned is (z_1 - z_0 - mean torque) / x."""
    x = POLES[2:7]
    found = hold(x)
    np.testing.assert_allclose(found.turn, (found.state - 0.5) / x, atol=1e-12)


def test_straight_line_is_exact_for_lines() -> None:
    found = straight_line(POLES)
    exact = quad_vec(lambda t: np.exp(POLES * (1.0 - t)) * t, 0.0, 1.0)[0]
    np.testing.assert_allclose(found.state, exact, atol=1e-13)


def test_a_heavy_mode_follows_by_a_twelfth_and_a_fast_one_by_the_line() -> None:
    assert numerov(np.array([0j])).turn == pytest.approx(1.0 / 12.0)
    fast = np.array([1.01 * FASTEST * 1j, -4e2])
    np.testing.assert_array_equal(numerov(fast).state, straight_line(fast).state)
