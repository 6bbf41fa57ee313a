"""Periodic loads: the harmonic load is the torque over time, with its peak where the phase says."""

import math

import numpy as np
import pytest

from dynamics.rotor.parts import LoadOrder, PeriodicLoad, harmonic_loads, left_out, waves_within

TURNS = 4.0
RATIOS = np.array([1.0, 0.75, 0.5])


def swinging(*parts: LoadOrder, dof: int = 1) -> PeriodicLoad:
    return PeriodicLoad(name="coupling", load=np.array([0.0, 1.0, -1.0]), dof=dof, parts=parts)


def over_time(loads: dict[int, np.ndarray], time: np.ndarray) -> np.ndarray:
    """(freedoms, times): the sum of Re(value exp(i h w t)); the reference turns once in a unit of time."""
    omega = 2.0 * math.pi / TURNS
    return sum((value[:, None] * np.exp(1j * h * omega * time) for h, value in loads.items()), 0.0).real


def test_harmonics_add_up_to_the_torque_over_the_angle() -> None:
    torques = swinging(
        LoadOrder(order=1.0, amplitude=3.0, phase=0.7), LoadOrder(order=2.0, amplitude=5.0, phase=-1.9)
    )
    time = np.linspace(0.0, TURNS, 97)
    found = over_time(harmonic_loads([torques], RATIOS, TURNS), time)
    expected = torques.at(2.0 * math.pi * RATIOS[1] * time)
    assert found == pytest.approx(np.outer([0.0, 1.0, -1.0], expected), abs=1e-9)


def test_a_torque_peaks_after_its_phase() -> None:
    """Order 2 with a phase of 90 degrees: highest after an eighth of a turn of its shaft."""
    torques = swinging(LoadOrder(order=2.0, amplitude=5.0, phase=0.5 * math.pi))
    time = np.linspace(0.0, 0.5, 3001)
    peak = time[np.argmax(over_time(harmonic_loads([torques], RATIOS, TURNS), time)[1])]
    assert peak == pytest.approx(0.125 / RATIOS[1], abs=1e-3)


def test_two_torques_of_one_harmonic_add() -> None:
    """Equal torques in opposite phase leave nothing."""
    opposed = [swinging(LoadOrder(order=1.0, amplitude=3.0, phase=phase)) for phase in (0.3, 0.3 + math.pi)]
    (load,) = harmonic_loads(opposed, RATIOS, TURNS).values()
    assert load == pytest.approx(np.zeros(3), abs=1e-12)


def test_an_order_that_does_not_fit_the_period_is_left_out_and_named() -> None:
    fits, odd = LoadOrder(order=1.0, amplitude=3.0), LoadOrder(order=1.1, amplitude=3.0)
    assert waves_within(1.0, 0.75, TURNS) == 3
    assert waves_within(1.1, 0.75, TURNS) is None
    assert list(harmonic_loads([swinging(fits, odd)], RATIOS, TURNS)) == [3]
    assert left_out([swinging(fits, odd)], RATIOS, TURNS) == ["coupling order 1.1"]
