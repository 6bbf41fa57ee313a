"""Strain records in files: the same bridge output and angle from every kind of file; what cannot be read."""

import math
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.measurement.processing.root_gauges import (
    ConstantSpeed,
    GaugeChannel,
    SpeedSignal,
    StrainRecording,
    read_strain_records,
)
from rigdesign.measurement.reading.measurement_set import Tach
from tests.builders.recording import write_recording
from tests.builders.strain_gauge import bridge, measuring_point, root_stress, wandering_angle, wandering_speed

RATE = 2000.0
TIME = np.arange(8000) / RATE
RATIO = measuring_point().ratio(root_stress(wandering_angle(TIME)))
UNITS = {"SG_I": "mV", "SG_II": "mV", "n": "rpm", "U_E": "V", "Tach": "V"}


def channels() -> dict[str, np.ndarray]:
    """5 V supply, two gauges, speed, and an index pulse at angle zero."""
    return {
        "SG_I": 1e3 * 5.0 * RATIO,
        "SG_II": 1e3 * 4.0 * RATIO,
        "n": wandering_speed(TIME) * 30.0 / math.pi,
        "U_E": np.full(len(TIME), 4.0),
        "Tach": np.tanh(20.0 * np.sin(wandering_angle(TIME))),
    }


def recording(file: str, **changes: object) -> StrainRecording:
    """Gauges I and II, II with a recorded supply; angle from the speed."""
    gauges = {
        "I": GaugeChannel(signal="SG_I", bridge=bridge()),
        "II": GaugeChannel(signal="SG_II", bridge=bridge(), supply="U_E"),
    }
    return StrainRecording(**{"file": file, "gauges": gauges, "angle": SpeedSignal("n", zero=0.3), **changes})


@pytest.mark.parametrize("kind", ["tdms", "h5", "csv"])
def test_bridge_outputs_and_angle_of_every_kind_of_file(tmp_path: Path, kind: str) -> None:
    write_recording(tmp_path / f"run.{kind}", channels(), UNITS, RATE)
    found = read_strain_records(tmp_path, recording(f"run.{kind}"))
    for name in ("I", "II"):
        assert found.records[name].time == pytest.approx(TIME, abs=1e-9)
        assert found.records[name].ratio == pytest.approx(RATIO, rel=1e-8, abs=1e-13)
    assert np.abs(found.angle(TIME) - wandering_angle(TIME)).max() < 1e-6


def test_index_pulse_and_the_gauge_itself_as_pulse(tmp_path: Path) -> None:
    write_recording(tmp_path / "run.tdms", channels(), UNITS, RATE)
    inside = TIME[(TIME > 0.8) & (TIME < 3.0)]
    index = read_strain_records(tmp_path, recording("run.tdms", angle=Tach(kind="pulses", signal="Tach")))
    off = (index.angle(inside) - wandering_angle(inside)) / (2 * math.pi)
    unseen = (
        0.01 / 0.9 / (2 * math.pi)
    )  # swing of the angle within a turn, which one pulse a turn cannot see [turns]
    assert np.ptp(off) < 4 * unseen and abs(np.mean(off) - round(np.mean(off))) < unseen
    own = read_strain_records(tmp_path, recording("run.tdms", angle=Tach(kind="pulses", signal="SG_I")))
    shift = own.angle(inside) - wandering_angle(inside)
    assert np.ptp(shift) / (2 * math.pi) < 4 * unseen
    assert (
        0.25 < np.mod(-np.mean(shift), 2 * math.pi) < 0.31
    )  # zero at the rising flank of the tooth's own stress


def test_stated_speed(tmp_path: Path) -> None:
    write_recording(tmp_path / "run.h5", channels(), UNITS, RATE)
    found = read_strain_records(tmp_path, recording("run.h5", angle=ConstantSpeed(10.0, zero=1.0)))
    assert found.angle(np.array([0.0, 0.5])) == pytest.approx([1.0, 6.0])


def test_ratios_need_no_supply(tmp_path: Path) -> None:
    write_recording(tmp_path / "run.h5", {**channels(), "SG_I": 1e3 * RATIO}, {**UNITS, "SG_I": "mV/V"}, RATE)
    gauges = {"I": GaugeChannel(signal="SG_I", bridge=bridge())}
    found = read_strain_records(tmp_path, recording("run.h5", gauges=gauges))
    assert found.records["I"].ratio == pytest.approx(RATIO, rel=1e-12, abs=1e-18)


def faults(folder: Path, wanted: StrainRecording) -> str:
    with pytest.raises(MeasurementError) as error:
        read_strain_records(folder, wanted)
    return str(error.value)


@pytest.mark.parametrize(("kind", "keep"), [("tdms", 0.7), ("h5", 0.5)])
def test_file_that_was_cut_off(tmp_path: Path, kind: str, keep: float) -> None:
    path = tmp_path / f"run.{kind}"
    write_recording(path, channels(), UNITS, RATE)
    content = path.read_bytes()
    path.write_bytes(content[: int(keep * len(content))])
    said = faults(tmp_path, recording(f"run.{kind}"))
    assert f"run.{kind}" in said and "record or export it again" in said


def test_missing_channels_are_all_named(tmp_path: Path) -> None:
    given = {name: values for name, values in channels().items() if name in ("SG_I", "Tach")}
    write_recording(tmp_path / "run.h5", given, UNITS, RATE)
    said = faults(tmp_path, recording("run.h5"))
    for key, name in (("gauges.II.signal", "SG_II"), ("gauges.II.supply", "U_E"), ("angle.signal", "n")):
        assert f"run.h5, {key} = {name}: no such channel; the file has SG_I, Tach" in said


def test_mixed_units_are_refused_unless_each_is_stated(tmp_path: Path) -> None:
    mixed = {**channels(), "SG_I": 5.0 * RATIO}
    write_recording(tmp_path / "run.tdms", mixed, {**UNITS, "SG_I": "V"}, RATE)
    said = faults(tmp_path, recording("run.tdms"))
    assert (
        "run.tdms, gauges = I in V; II in mV: the bridges of one file are stored in different units" in said
    )
    stated = {
        "I": GaugeChannel(signal="SG_I", bridge=bridge(), unit="V"),
        "II": GaugeChannel(signal="SG_II", bridge=bridge(), unit="mV", supply="U_E"),
    }
    found = read_strain_records(tmp_path, recording("run.tdms", gauges=stated))
    assert found.records["I"].ratio == pytest.approx(found.records["II"].ratio, rel=1e-12, abs=1e-18)


@pytest.mark.parametrize(
    ("in_file", "stated", "said"),
    [
        ("N m", "", "gauges.I = N m: is a unit of torque, not of voltage; write one of V, mV, uV, mV/V"),
        ("furlong", "", "gauges.I = furlong: is not a known unit"),
        ("", "", "gauges.I: neither the file nor the channel has a unit"),
        ("mV", "V", 'gauges.I = V: the file says "mV"; correct what is wrong; nothing is converted'),
    ],
)
def test_unit_of_a_bridge_output(tmp_path: Path, in_file: str, stated: str, said: str) -> None:
    write_recording(tmp_path / "run.h5", channels(), {**UNITS, "SG_I": in_file}, RATE)
    gauges = {"I": GaugeChannel(signal="SG_I", bridge=bridge(), unit=stated)}
    assert said in faults(tmp_path, recording("run.h5", gauges=gauges))


def test_speed_in_a_unit_of_something_else_and_dead_supply(tmp_path: Path) -> None:
    write_recording(tmp_path / "run.h5", channels(), {**UNITS, "n": "Hz"}, RATE)
    assert "angle.n = Hz: is a unit of frequency, not of speed" in faults(tmp_path, recording("run.h5"))
    write_recording(tmp_path / "run.h5", {**channels(), "U_E": np.zeros(len(TIME))}, UNITS, RATE)
    assert "U_E = 0 V: the supply must be above 0 V" in faults(tmp_path, recording("run.h5"))
    dead = {**channels(), "Tach": np.zeros(len(TIME))}
    write_recording(tmp_path / "run.h5", dead, UNITS, RATE)
    said = faults(tmp_path, recording("run.h5", angle=Tach(kind="pulses", signal="Tach")))
    assert "the tach signal never changes" in said


def test_dead_gauge_is_refused_and_missing_samples_are_noted(tmp_path: Path) -> None:
    dead = {**channels(), "SG_II": np.full(len(TIME), 0.3)}
    write_recording(tmp_path / "run.h5", dead, UNITS, RATE)
    assert "gauges.II = SG_II: reads the same throughout" in faults(tmp_path, recording("run.h5"))
    holed = channels()
    holed["SG_II"][100:180] = math.nan
    write_recording(tmp_path / "run.h5", holed, UNITS, RATE)
    found = read_strain_records(tmp_path, recording("run.h5"))
    assert found.notes == {"I": (), "II": ("1.00% of its samples are missing",)}
