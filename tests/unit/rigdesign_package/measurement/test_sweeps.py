"""Run-ups, run-downs and hammer blows of a set: a known resonance comes back, what is wrong is said."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.measurement import features, load_measurement
from rigdesign.measurement.processing.impacts import frequency_response, resonance_peak
from rigdesign.measurement.processing.sweeps import order_curves
from rigdesign.measurement.reading.measurement_set import MeasurementSet, Tach
from rigdesign.measurement.reading.signals import Signal, turn_angle
from rigdesign.prediction.model import Feature
from tests.builders.measurement import replaced
from tests.builders.order import shipped
from tests.builders.recording import write_recorded_set, write_recording
from tests.builders.sweep import (
    CHANNEL,
    CROSSING,
    DAMPING,
    NATURAL,
    ORDER,
    RATE,
    UNITS,
    struck,
    swept,
    write_swept_set,
)

RPM = 30.0 / math.pi


def loaded(folder: Path) -> MeasurementSet:
    return load_measurement(folder, shipped("loop_1to1"))


def of_sweep(start: float, end: float, seconds: float, **more: float) -> dict[str, Signal]:
    signals = swept(start, end, seconds, **more)
    time = np.arange(signals["Tach"].size) / RATE
    return {name: Signal(time, values) for name, values in signals.items()}


@pytest.mark.parametrize("kind", ["tdms", "csv"])
def test_a_known_resonance_comes_back(tmp_path: Path, kind: str) -> None:
    """45 rpm/s, half width 18 rpm: the lag is taken off, each sweep is within 3 rpm of 1800, the declared sigma."""
    measurement = loaded(write_swept_set(tmp_path, kind))
    speeds = RPM * measurement.readings[Feature("n_res", "")]
    assert speeds.size == 2
    assert np.abs(speeds - CROSSING).max() < 3.0
    assert abs(speeds.mean() - CROSSING) < 1.0
    said = [finding.text for finding in measurement.findings if finding.id == "resonance"]
    assert any("up." in text and "half width 2" in text for text in said)
    assert measurement.readings[Feature("f_1", "")] == pytest.approx([NATURAL], abs=0.3)
    data = features(measurement)
    row = data.features.index(Feature("n_res", ""))
    assert (
        data.usable[row] and data.repeats[row] == 2 and data.noise[row] * RPM == pytest.approx(2.0, rel=0.3)
    )


def test_orders_at_speeds_are_operating_points_read_by_every_sweep(tmp_path: Path) -> None:
    measurement = loaded(write_swept_set(tmp_path, "tdms"))
    names = [point.name for point in measurement.points]
    assert names == ["P01", "1200 rpm, 100 N m in sweeps", "2000 rpm, 100 N m in sweeps"]
    slow, point = measurement.points[1], names[1]
    assert (slow.setting.speed * RPM, slow.setting.torque, slow.steady) == (
        pytest.approx(1200.0),
        100.0,
        False,
    )
    assert measurement.readings[Feature("M_wheel", point)] == pytest.approx([100.0, 100.0], abs=0.01)
    read = [measurement.readings[Feature("M_wheel", point, ORDER, part)] for part in ("real", "imaginary")]
    ratio = 1200.0 / CROSSING
    static = 0.2 / (1.0 - ratio**2 + 2j * DAMPING * ratio)
    assert np.hypot(*read) == pytest.approx([abs(static)] * 2, rel=0.02)
    order_1 = measurement.readings[Feature("M_wheel", point, 1.0, "real")]
    assert order_1 == pytest.approx([0.5, 0.5], abs=0.02)
    assert features(measurement).settings == measurement.settings


@pytest.mark.parametrize("seconds", [10.0, 20.0, 40.0])
@pytest.mark.parametrize(("start", "end"), [(900.0, 2700.0), (2700.0, 900.0)])
def test_order_curve_follows_speed_and_peak(start: float, end: float, seconds: float) -> None:
    """The rate is that of the ramp; the peak lags by the rate over order and half width, which is wide
    by the rate itself and by the window: most of it."""
    signals = of_sweep(start, end, seconds)
    turn = turn_angle(Tach(kind="pulses", signal="Tach"), signals, None)
    curves = order_curves(signals["M_wheel"], turn, (0.0, ORDER), 16)
    rate = (end - start) / seconds
    assert float(np.median(curves.rate)) * RPM == pytest.approx(rate, rel=0.01)
    assert np.abs(curves.amplitude[0.0]) == pytest.approx(np.full(curves.rate.size, 100.0), abs=0.1)
    peak = resonance_peak(curves.speed, np.abs(curves.amplitude[ORDER]))
    late = peak.place - CROSSING / RPM
    lag = rate / RPM / (ORDER * peak.half_width)
    assert lag / late == pytest.approx(0.85, abs=0.25)


def test_a_speed_that_no_window_reaches_is_not_read() -> None:
    signals = of_sweep(900.0, 2700.0, 20.0)
    turn = turn_angle(Tach(kind="pulses", signal="Tach"), signals, None)
    curves = order_curves(signals["M_wheel"], turn, (ORDER, 100.0), 8)
    assert math.isnan(curves.at(ORDER, 3000.0 / RPM).real)
    # 4 kHz over 45 turns a second: 88 samples a turn are too few for order 100 at the end of the run-up
    assert np.isnan(curves.amplitude[100.0][-5:]).all()


@pytest.mark.parametrize(
    ("amplitude", "said"),
    [
        (lambda x: x, "stands at the end"),
        (lambda x: np.ones_like(x) + 0.1 * np.exp(-((x - 50.0) ** 2)), "times the median, 3 is a peak"),
        (lambda x: np.full_like(x, np.nan), "0 points there"),
    ],
)
def test_no_peak_is_said(amplitude: object, said: str) -> None:
    x = np.linspace(0.0, 100.0, 101)
    with pytest.raises(ValueError, match=said):
        resonance_peak(x, amplitude(x))  # type: ignore[operator]


def test_peak_of_one_mode_is_exact() -> None:
    x = np.linspace(90.0, 110.0, 21)
    peak = resonance_peak(x, 3.0 / np.hypot(x - 100.37, 1.7))
    assert (peak.place, peak.half_width) == (pytest.approx(100.37), pytest.approx(1.7))


def test_a_sweep_that_is_too_fast_is_suspected(tmp_path: Path) -> None:
    folder = write_swept_set(tmp_path, "tdms")
    write_recording(folder / "up.tdms", swept(900.0, 2700.0, 3.0), UNITS, RATE)
    replaced(
        folder, "measurement.toml", 'torque = "100 N m"\nspeeds', 'torque = "100 N m"\nturns = 4\nspeeds'
    )
    found = {finding.id: finding.text for finding in loaded(folder).findings if "up.tdms" in finding.text}
    assert "sweep slower" in (found.get("fast_sweep") or found["uncertain_resonance"])


WRONG = (
    ('direction = "up"', 'direction = "down"', "data.sweeps.0.direction.*the tach goes from .* to .* rpm"),
    ('tach = { kind = "pulses", signal = "Tach" }', "", "data.tach"),
    ('file = "up.tdms"', 'file = "nowhere.tdms"', "nowhere.tdms"),
    ("orders = [8]", "orders = [8, 16]", "channels.n_res.orders.*one order meets a mode"),
    ('orders = [8]\ntorque = "100 N m"', "orders = [8]", "channels.n_res.torque.*as stiff as the torque"),
    ('place = "1"', 'place = "first"', "channels.n_res.place.*nor the name of a mode"),
    ('["1000 rpm", "2500 rpm"]', '["2500 rpm", "1000 rpm"]', "search_range.*does not ascend"),
    ('["1000 rpm", "2500 rpm"]', '["1000 Hz", "2500 rpm"]', "search_range"),
    (
        'uncertainty = "0.1 K"',
        'uncertainty = "0.1 K"\nsearch_range = ["1 degC", "2 degC"]',
        "is not looked for",
    ),
    ('force = "Hammer"', 'force = "Mallet"', "data.impacts.0.force.*no such signal in blows.tdms"),
    ('speeds = ["1200 rpm", "2000 rpm"]', 'speeds = ["1200"]', "data.sweeps.0.speeds"),
)


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_faults_name_key_and_remedy(tmp_path: Path, old: str, new: str, said: str) -> None:
    folder = write_swept_set(tmp_path, "tdms", seconds=20.0)
    replaced(folder, "measurement.toml", old, new)
    with pytest.raises(MeasurementError, match=f"(?s){said}"):
        loaded(folder)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('["1000 rpm", "2500 rpm"]', '["1000 rpm", "1700 rpm"]', "stands at the end of what is searched"),
        ('speeds = ["1200 rpm", "2000 rpm"]', 'speeds = ["5000 rpm"]', "the sweep goes from .* correct"),
        ('search_range = ["200 Hz", "300 Hz"]', "", "write the search_range"),
        ("orders = [0, 1, 8]", "orders = [0.5, 8]", "order.* 0.5 are not used.*start_turn"),
    ],
)
def test_what_cannot_be_read_is_dropped_with_a_reason(tmp_path: Path, old: str, new: str, said: str) -> None:
    folder = write_swept_set(tmp_path, "tdms", seconds=20.0)
    replaced(folder, "measurement.toml", old, new)
    measurement = loaded(folder)
    dropped = " ".join(finding.text for finding in measurement.findings if finding.weight == "dropped")
    assert not any(point.name.startswith("5000 rpm") for point in measurement.points)
    assert re.search(said, dropped)


def test_sweeps_of_another_torque_say_nothing_of_the_resonance(tmp_path: Path) -> None:
    folder = write_swept_set(tmp_path, "tdms", seconds=20.0)
    replaced(
        folder, "measurement.toml", 'orders = [8]\ntorque = "100 N m"', 'orders = [8]\ntorque = "180 N m"'
    )
    measurement = loaded(folder)
    assert "n_res" not in measurement.channels
    assert any(
        finding.id == "missing_channel" and "n_res" in finding.channels for finding in measurement.findings
    )


@pytest.mark.parametrize("kind", ["csv", "tdms"])
def test_time_in_another_unit_than_it_seems_is_told_of_blows(tmp_path: Path, kind: str) -> None:
    """Milliseconds under the label of seconds: 0.24 Hz for 240."""
    folder = write_recorded_set(tmp_path, "tdms")
    blows = f'[[data.impacts]]\nfile = "blows.{kind}"\nforce = "Hammer"\n\n[settings.n]'
    replaced(folder, "measurement.toml", "[settings.n]", blows)
    frequency = "[channels.f_1]" + CHANNEL.partition("[channels.f_1]")[2]
    replaced(folder, "measurement.toml", "[channels.T_out]", f"{frequency}\n[channels.T_out]")
    write_recording(folder / f"blows.{kind}", struck(blows=2), UNITS, 1e-3 * RATE)
    measurement = loaded(folder)
    (said,) = (one for one in measurement.findings if one.id == "no_resonance")
    assert "show frequencies up to 2 Hz, search_range begins at 200 Hz" in said.text
    assert "f_1" not in measurement.channels
    if kind == "csv":
        replaced(folder, "blows.csv", "\ns,N,g", "\nms,N,g")
        measurement = loaded(folder)
        assert measurement.readings[Feature("f_1", "")] == pytest.approx(NATURAL, abs=0.2)


def test_response_to_a_hammer_is_averaged_over_its_blows() -> None:
    signals = struck(blows=4, noise=0.01)
    time = np.arange(signals["Hammer"].size) / RATE
    force, answer = (Signal(time, signals[name]) for name in ("Hammer", "Answer"))
    found = frequency_response(force, answer)
    assert found.blows == 4
    peak = resonance_peak(found.frequency, np.abs(found.response), (200.0, 300.0))
    assert peak.place == pytest.approx(NATURAL, abs=0.2)
    assert peak.half_width / peak.place == pytest.approx(DAMPING, rel=0.15)
    near = int(np.argmin(np.abs(found.frequency - NATURAL)))
    assert found.coherence[near] > 0.95
    assert frequency_response(force, answer, 0.5).frequency[1] == pytest.approx(2.0, rel=0.01)
    with pytest.raises(ValueError, match="one clock"):
        frequency_response(force, Signal(time[:-1], answer.values[:-1]))
    with pytest.raises(ValueError, match="gives no force"):
        frequency_response(Signal(time, np.zeros_like(time)), answer)
