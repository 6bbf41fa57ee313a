"""Dynamic factor and resonances from torques over speed."""

import numpy as np
import pytest
from scipy.signal import find_peaks

from dynamics.rating.dynamic_factor import DynamicFactorCurve, _prominences, resonances

WAVE = np.sin(np.linspace(0.0, 2.0 * np.pi, 4097)[:-1])


def factor_curve(speed, torques, lift_off_share):
    """Curve of dynamic torques (n_meshes, n_steps) at each speed; lift_off_share : (n_speeds, n_meshes)."""
    waves = np.array([np.atleast_2d(torque) for torque in torques])
    mean, swing = waves.mean(axis=2), 0.5 * np.ptp(waves, axis=2)
    factor = (waves * np.sign(mean)[..., None]).max(axis=2) / np.abs(mean)
    return DynamicFactorCurve(
        speed=speed, factor=factor.T, mean_torque=mean.T, amplitude=swing.T, lift_off_share=lift_off_share.T,
    )  # fmt: skip


def test_resonances_are_found_where_they_are() -> None:
    speed = np.linspace(50.0, 1250.0, 241)
    amplitude = (
        5.0 + 60.0 / (1.0 + ((speed - 373.0) / 20.0) ** 2) + 30.0 / (1.0 + ((speed - 801.0) / 30.0) ** 2)
    )
    torques = [np.stack((180.0 + a * WAVE, -180.0 - 1.0 * WAVE)) for a in amplitude]
    share = np.zeros((241, 2))
    share[np.argmin(np.abs(speed - 373.0)), 0] = 0.2
    curve = factor_curve(speed, torques, share)
    first, second = resonances(curve)
    assert (first.mesh, second.mesh) == (0, 0)
    assert first.speed == pytest.approx(373.0, abs=1.5)
    assert second.speed == pytest.approx(801.0, abs=1.5)
    assert first.factor == pytest.approx(1.0 + first.amplitude / 180.0, rel=1e-3)
    peak = int(np.argmax(amplitude))
    level = max(amplitude[:peak].min(), amplitude[peak:].min())
    assert first.amplification == pytest.approx(amplitude[peak] / level, rel=1e-3)
    assert curve.factor.shape == (2, 241)


def test_a_curve_that_ends_rising_has_its_peak_at_the_end_or_above() -> None:
    speed = np.linspace(50.0, 1250.0, 241)
    torques = [180.0 + (5.0 + 60.0 / (1.0 + ((s - 1300.0) / 60.0) ** 2)) * WAVE for s in speed]
    (last,) = resonances(factor_curve(speed, torques, np.zeros((241, 1))))
    assert last.at_end and last.speed == speed[-1]
    assert last.force_share == pytest.approx(last.amplitude / 180.0)
    assert last.amplification > 4.0
    falling = [180.0 + (70.0 - 0.05 * s) * WAVE for s in speed]
    assert resonances(factor_curve(speed, falling, np.zeros((241, 1)))) == ()


def test_prominences_are_those_of_scipy() -> None:
    values = np.random.default_rng(1).normal(size=400).cumsum()
    peaks, found = find_peaks(values, prominence=0.0)
    assert dict(_prominences(values)) == pytest.approx(dict(zip(peaks, found["prominences"], strict=True)))
