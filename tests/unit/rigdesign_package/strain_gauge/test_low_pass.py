"""Low-pass: gain and delay against scipy, answer in time against the transfer function, amplifier and its faults."""

import math

import numpy as np
import pytest
from scipy import signal

from rigdesign.base.errors import CaseError
from rigdesign.strain_gauge.low_pass import LowPass
from tests.builders.strain_evaluation import passed_harmonics
from tests.builders.strain_logger import Amplifier

KINDS = [(kind, order) for kind in ("butterworth", "bessel") for order in (1, 2, 4, 8)]


@pytest.mark.parametrize(("kind", "order"), KINDS)
def test_gain_is_that_of_scipy(kind: str, order: int) -> None:
    low_pass = LowPass(kind, order, 1000.0)
    frequency = np.geomspace(10.0, 5000.0, 30)
    design = signal.butter if kind == "butterworth" else signal.bessel
    extra = {} if kind == "butterworth" else {"norm": "mag"}
    zpk = design(order, 2 * math.pi * 1000.0, analog=True, output="zpk", **extra)
    expected = signal.freqs_zpk(*zpk, worN=2 * math.pi * frequency)[1]
    assert low_pass.gain(frequency) == pytest.approx(expected, rel=1e-9)
    assert abs(complex(low_pass.gain(1000.0))) == pytest.approx(math.sqrt(0.5), rel=1e-9)
    assert complex(low_pass.gain(0.0)) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(("kind", "order"), KINDS)
def test_group_delay_is_the_slope_of_the_phase(kind: str, order: int) -> None:
    low_pass = LowPass(kind, order, 1000.0)
    for frequency in (1.0, 300.0, 900.0):
        step = 0.01
        turned = complex(low_pass.gain(frequency + step)) / complex(low_pass.gain(frequency - step))
        slope = -np.angle(turned) / (2 * math.pi * 2 * step)
        assert float(low_pass.group_delay(frequency)) == pytest.approx(slope, rel=1e-6)


def test_delay_of_known_filters() -> None:
    """First order: 1 / omega_c; Butterworth of order 2: sqrt(2) / omega_c."""
    corner = 2 * math.pi * 500.0
    assert LowPass("butterworth", 1, 500.0).delay == pytest.approx(1 / corner, rel=1e-12)
    assert LowPass("butterworth", 2, 500.0).delay == pytest.approx(math.sqrt(2) / corner, rel=1e-12)


@pytest.mark.parametrize(("kind", "order"), KINDS)
def test_answer_in_time_is_exact_for_straight_pieces(kind: str, order: int) -> None:
    """A ramp comes late by the delay at rest; random samples as scipy integrates the same straight pieces."""
    low_pass, step = LowPass(kind, order, 200.0), 1e-3
    ramp = np.arange(200.0)
    late = ramp - low_pass.passed(ramp, step)
    assert late[-1] == pytest.approx(low_pass.delay / step, rel=1e-9)
    values = np.random.default_rng(3).standard_normal(300)
    values[0] = 0.0
    scaled = low_pass.poles * step
    system = signal.ZerosPolesGain([], scaled, float(np.prod(-scaled).real)).to_ss()
    expected = signal.lsim(system, values, np.arange(300.0), interp=True)[1]
    assert low_pass.passed(values, step) == pytest.approx(expected, abs=1e-9)
    assert low_pass.passed(np.full(5, 3.0), step) == pytest.approx(3.0, rel=1e-12)


def test_sine_keeps_the_share_that_is_stated() -> None:
    """Mesh frequency of 28 teeth at 1500 rpm, 700 Hz, through 2 kHz: amplitude and angle as reported."""
    speed, teeth, low_pass = 1500 * math.pi / 30, 28, LowPass("bessel", 4, 2000.0)
    first = passed_harmonics(low_pass, speed, teeth, (1, 2))[0]
    assert first.frequency == pytest.approx(700.0)
    step = 2e-6  # straight pieces hold a sine to (omega step)^2 / 12 = 6e-6
    time = step * np.arange(100_000)
    out = low_pass.passed(np.sin(2 * math.pi * 700.0 * time), step)
    part = np.exp(-2j * math.pi * 700.0 * (time - low_pass.delay))
    found = 2j * np.mean((out * part)[25_000:])  # 150 ms, 105 whole periods
    assert abs(found) == pytest.approx(first.amplitude, rel=1e-4)
    assert -np.angle(found) / teeth == pytest.approx(first.angle_error, abs=1e-6)
    assert 0.95 < first.amplitude < 0.97 and abs(first.angle_error) < 1e-4


def test_converter_rounds_and_clips() -> None:
    amplifier = Amplifier(sample_rate=100.0, bits=12, input_range=2e-3)
    record = amplifier.record(lambda time: 3e-3 * time, 1.0)
    assert len(record.time) == 101
    assert record.ratio.max() == 2e-3 and record.overloaded == 34
    inside = record.ratio[:60]
    assert np.abs(inside - 3e-3 * record.time[:60]).max() <= 0.5 * amplifier.step * (1 + 1e-9)
    assert amplifier.step == pytest.approx(4e-3 / 4096)


def test_noise_before_the_low_pass_has_its_bandwidth() -> None:
    """White density S through a first-order low-pass: rms^2 = S^2 f_c pi / 2; offset and drift are added."""
    amplifier = Amplifier(
        sample_rate=20e3, low_pass=LowPass("butterworth", 1, 200.0), slip_ring_noise=1e-8, offset=1e-4, drift=1e-6
    )  # fmt: skip
    record = amplifier.record(lambda time: np.zeros_like(time), 10.0, seed=4)
    trend = np.polyfit(record.time, record.ratio, 1)
    assert trend == pytest.approx([1e-6, 1e-4], rel=0.02)
    rest = record.ratio - np.polyval(trend, record.time)
    assert rest[2000:].std() == pytest.approx(1e-8 * math.sqrt(200.0 * math.pi / 2), rel=0.05)


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: LowPass("bessel", 9, 1e3), "low_pass.order = 9: must lie within 1 to 8"),
        (lambda: LowPass("butterworth", 2, 0.0), "low_pass.cut_off = 0 Hz: must be above 0 Hz"),
        (lambda: LowPass("elliptic", 2, 1e3), "write butterworth or bessel"),
        (lambda: Amplifier(sample_rate=0.0), "sample_rate = 0 Hz"),
        (lambda: Amplifier(sample_rate=1e3, bits=2), "bits = 2: must lie within 4 to 32"),
        (lambda: Amplifier(sample_rate=1e3, converter_noise=-1.0), "converter_noise = -1"),
    ],
)
def test_impossible_amplifier(build: object, said: str) -> None:
    with pytest.raises(CaseError) as error:
        build()
    assert said in str(error.value)
