"""Piecewise-linear oscillator with backlash (V4): both branches of the jump by harmonic balance."""

import numpy as np
import pytest

from tests.published.mechanics import DOWN, UP, sweep

BRANCH_END = 0.75
"""Lowest frequency of the upper branch; a walk downwards ends there."""


@pytest.mark.parametrize(("direction", "expected"), [("up", UP), ("down", DOWN)])
def test_both_branches_of_the_jump(direction: str, expected: dict[float, float]) -> None:
    frequencies = [round(float(value), 4) for value in np.arange(0.4, 1.5001, 0.025)]
    found = sweep(frequencies if direction == "up" else frequencies[::-1])
    for frequency, amplitude in expected.items():
        if direction == "up" or frequency >= BRANCH_END:
            assert found[frequency] == pytest.approx(amplitude, rel=5e-3), frequency
