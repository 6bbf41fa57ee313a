"""Spectra of known signals."""

import numpy as np
import pytest

from rigdesign.postprocessing.campbell import _meetings
from rigdesign.postprocessing.spectra import _blocks, _pooled, order_spectrum, spectrum
from rigdesign.results.vibration import CampbellMode, sense_of_whirl

RATE = 40e3


def test_a_cosine_has_its_amplitude() -> None:
    """1250 Hz is a line of 4096 samples: the window spreads it to neighbours, the middle keeps the amplitude."""
    time = np.arange(4096) / RATE
    frequency, amplitude = spectrum((3.0 + 2.0 * np.cos(2.0 * np.pi * 1250.0 * time))[None], RATE)
    at = int(np.argmax(amplitude[0]))
    assert frequency[at] == pytest.approx(1250.0)
    assert amplitude[0, at] == pytest.approx(2.0, rel=1e-9)


def test_blocks_follow_a_sweep() -> None:
    """From 1 to 5 kHz in one second: the strongest line of a block is the frequency at its middle."""
    time = np.arange(int(RATE)) / RATE
    sweep = np.cos(2.0 * np.pi * (1000.0 * time + 2000.0 * time**2))
    middles, frequency, amplitude = _blocks(sweep, 512, RATE, 0.4 * RATE)
    strongest = frequency[np.argmax(amplitude, axis=1)]
    # half a bin of 78 Hz, and the sweep of 51 Hz within a block
    assert strongest == pytest.approx(1000.0 + 4000.0 * middles / RATE, abs=78.0)


def test_whole_turns_keep_the_amplitudes_of_orders() -> None:
    """Order 99 at 23.7 turns a second falls between the lines of all samples, on one of those of whole turns."""
    turns = 23.7 * np.arange(20000) / RATE
    order, amplitude = order_spectrum(1.5 * np.cos(2.0 * np.pi * 99.0 * turns), 23.7 / RATE)
    at = int(np.argmax(amplitude))
    assert order[at] == pytest.approx(99.0, rel=1e-4)
    assert amplitude[at] == pytest.approx(1.5, rel=5e-3)


def test_pooling_keeps_peaks() -> None:
    values = np.zeros(1000)
    values[617] = 5.0
    order, amplitude = _pooled(np.arange(1000.0), values, 100)
    assert order[int(np.argmax(amplitude))] == 617.0
    assert amplitude.size == 100


def test_an_order_meets_a_mode_where_both_have_one_frequency() -> None:
    """A mode from 100 Hz at 10 rad/s to 200 Hz at 110 rad/s: 90 + n; three per rad/s meet it at 45 rad/s."""
    mode = CampbellMode(
        number=1,
        name="",
        frequency=(100.0, 200.0),
        damping_ratio=(0.01, 0.03),
        whirl=(None, None),
        gain={},
        driven_by="mesh",
    )
    ((speed, damping),) = _meetings(np.array([10.0, 110.0]), mode, 3.0)
    assert speed == pytest.approx(45.0)
    assert damping == pytest.approx(0.01 + 0.02 * 35.0 / 100.0)


def test_sense_is_that_of_the_roundest_orbit() -> None:
    assert sense_of_whirl((None, 0.05, -0.02)) == ""
    assert sense_of_whirl((0.2, -0.9, None)) == "backward"
    assert sense_of_whirl((0.2, 0.9)) == "forward"
    assert sense_of_whirl(()) == ""
