"""Dynamic factor and resonances from torques over speed."""

import numpy as np
import pytest

from dynamics.rating.dynamic_factor import dynamic_factor, factor_curve, half_peak_to_peak_factor, resonances

WAVE = np.sin(np.linspace(0.0, 2.0 * np.pi, 4097)[:-1])


def test_factor_of_p2_reads_both_ways() -> None:
    # 150 Nm amplitude at 180 Nm: 1.83 as zero to peak; swinging by 150 Nm from peak to peak it is 1.42
    assert dynamic_factor(180.0 + 150.0 * WAVE) == pytest.approx(1.8333, abs=1e-4)
    assert half_peak_to_peak_factor(180.0 + 75.0 * WAVE) == pytest.approx(1.4167, abs=1e-4)


def test_skewed_peaks_part_the_two_readings() -> None:
    wave = 100.0 + 10.0 * WAVE + 10.0 * np.cos(2.0 * np.linspace(0.0, 2.0 * np.pi, 4097)[:-1])
    assert dynamic_factor(wave) != pytest.approx(half_peak_to_peak_factor(wave), abs=0.01)


def test_back_flank_counts_by_magnitude() -> None:
    np.testing.assert_allclose(dynamic_factor(-(180.0 + 150.0 * WAVE)), dynamic_factor(180.0 + 150.0 * WAVE))


def test_no_load_has_no_factor() -> None:
    with pytest.raises(ValueError, match="carries no load"):
        dynamic_factor(np.zeros(10))


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


def test_unsorted_speeds_are_refused() -> None:
    with pytest.raises(ValueError, match="must increase"):
        factor_curve([2.0, 1.0], [WAVE + 3.0] * 2, np.zeros((2, 1)))
    with pytest.raises(ValueError, match="must agree"):
        factor_curve([1.0], [WAVE + 3.0] * 2, np.zeros((2, 1)))
