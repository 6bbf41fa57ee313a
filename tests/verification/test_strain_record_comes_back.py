"""A synthetic record of P1's kind as TDMS comes back as the stress curve within its noise.

100 rpm that wander by 5 %, a half bridge with passive resistor and leads, noise of slip ring and converter, drift,
16 bits, a Bessel low-pass, a tooth-passing pick-up of 60 pulses a turn with its index.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from rigdesign.measurement.processing.root_gauges import (
    ConstantSpeed,
    GaugeChannel,
    StrainRecording,
    read_strain_records,
)
from rigdesign.measurement.reading.measurement_set import Tach
from rigdesign.strain_gauge.low_pass import LowPass
from rigdesign.strain_gauge.turn_average import AngleGrid, TurnCurve
from tests.builders.recording import write_recording
from tests.builders.strain_evaluation import Evaluation, lost_in_low_pass, stress_over_angle
from tests.builders.strain_gauge import SPEED, bridge, measuring_point, root_stress, wandering_angle
from tests.builders.strain_logger import Amplifier, RootStressHistory, logged
from tests.builders.strain_zero import UnloadedAngles

RATE, SECONDS = 5000.0, 30.0
LOW_PASS = LowPass("bessel", 4, 1500.0)
POINT = measuring_point(bridge=bridge(lead_resistance=1.0, completion_resistance=120.2))
AMPLIFIER = Amplifier(
    sample_rate=RATE, low_pass=LOW_PASS, bits=16, slip_ring_noise=5e-8, converter_noise=1e-6, offset=1e-4, drift=2e-7
)  # fmt: skip
GRID = AngleGrid(points=720)
EVALUATION = Evaluation(grid=GRID, low_pass=LOW_PASS, zero=UnloadedAngles(1.5, 5.5))
PICK_UP = Tach(kind="pulses", signal="teeth", pulses_per_turn=60, index="index")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The record as TDMS: bridge voltage in mV, pick-up and index in V."""
    history = RootStressHistory(stress=root_stress, angle=wandering_angle)
    record = logged(POINT, history, AMPLIFIER, SECONDS, seed=11)
    assert record.overloaded == 0
    angle = wandering_angle(record.time)
    noise = np.random.default_rng(5).standard_normal((2, len(angle)))
    recorded = {
        "SG_II": 1e3 * 5.0 * record.ratio,
        "teeth": np.sin(60.0 * angle) + 0.002 * noise[0],
        "index": np.tanh(40.0 * np.sin(angle)) + 0.002 * noise[1],
    }
    path = tmp_path_factory.mktemp("record")
    write_recording(path / "run.tdms", recorded, {"SG_II": "mV", "teeth": "V", "index": "V"}, RATE)
    return path


def curve(folder: Path, angle: object, evaluation: Evaluation = EVALUATION) -> TurnCurve:
    gauges = {"II": GaugeChannel(signal="SG_II", bridge=POINT.bridge)}
    found = read_strain_records(folder, StrainRecording(file="run.tdms", gauges=gauges, angle=angle))
    return stress_over_angle(found.records["II"], POINT, found.angle, evaluation)


def standard_error(found: TurnCurve) -> np.ndarray:
    return found.scatter / math.sqrt(found.turns)


def test_stress_curve_within_three_standard_errors(folder: Path) -> None:
    """Residual over its standard error: about as many beyond 3 as Student's t of 49 turns has (0.43 %), and rms 1."""
    found = curve(folder, PICK_UP)
    true = root_stress(found.angle)
    share = (found.mean - true) / standard_error(found)
    lost = lost_in_low_pass(true, LOW_PASS, SPEED)
    print(
        f"{found.turns} turns, scatter {1e-6 * np.median(found.scatter):.3f} N/mm², "
        f"standard error {1e-6 * np.median(standard_error(found)):.3f}, residual rms "
        f"{1e-6 * np.std(found.mean - true):.3f}, largest {1e-6 * np.abs(found.mean - true).max():.3f}, "
        f"rms share {np.sqrt(np.mean(share**2)):.3f}, largest {np.abs(share).max():.2f}, "
        f"beyond 3: {np.mean(np.abs(share) > 3):.4f}, low-pass {1e-6 * np.abs(lost).max():.3f}"
    )
    assert found.turns >= 48
    assert np.mean(np.abs(share) > 3.0) <= 0.01
    assert 0.85 < math.sqrt(np.mean(share**2)) < 1.15
    assert np.abs(lost).max() < np.median(standard_error(found))


def test_scatter_is_the_noise_that_was_put_in(folder: Path) -> None:
    """On the far side: slip-ring noise in the bandwidth of the low-pass, converter noise and rounding."""
    found = curve(folder, PICK_UP)
    frequency = np.linspace(0.0, 50e3, 200_001)
    bandwidth = np.trapezoid(np.abs(LOW_PASS.gain(frequency)) ** 2, frequency)
    ratio = math.sqrt(5e-8**2 * bandwidth + 1e-6**2 + AMPLIFIER.step**2 / 12)
    per_stress = POINT.bridge.sensitivity * POINT.strain_factor / POINT.surface.modulus
    far = (found.angle > 1.5) & (found.angle < 5.5)
    scatter = math.sqrt(np.mean(found.scatter[far] ** 2))
    # a cubic spline between samples passes white noise with 0.84 to 1 of its standard deviation
    assert 0.84 * ratio / per_stress < scatter < 1.02 * ratio / per_stress


def test_what_the_chain_must_not_leave_out_shows(folder: Path) -> None:
    """Without the delay, without zero or with P1's formula at a speed that is not constant, the curve is off."""
    right = curve(folder, PICK_UP)
    true = root_stress(right.angle)
    late = curve(folder, PICK_UP, Evaluation(grid=GRID, zero=EVALUATION.zero))
    assert np.mean(np.abs(late.mean - true) > 3 * standard_error(late)) > 0.05
    untared = curve(folder, PICK_UP, Evaluation(grid=GRID, low_pass=LOW_PASS))
    assert np.mean(np.abs(untared.mean - true) > 3 * standard_error(untared)) > 0.99
    constant = curve(folder, ConstantSpeed(SPEED, zero=0.3), Evaluation(grid=GRID, low_pass=LOW_PASS))
    assert np.abs(constant.mean - constant.mean[360] - true).max() > 50e6
