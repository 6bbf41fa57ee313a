"""Signals of recordings in every kind of file: their time, their names, and what lies beside them."""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
from nptdms import ChannelObject, RootObject, TdmsWriter

from rigdesign.base.errors import MeasurementError
from rigdesign.measurement.reading.measurement_set import DataSection, Tach
from rigdesign.measurement.reading.signals import Signal, Signals, TachError, read_signals, turn_angle

RATE = 1000.0
COUNT = 500
TIME = np.arange(COUNT) / RATE
TORQUE = 100.0 + np.cos(2.0 * math.pi * 25.0 * TIME)
TACH = np.tanh(20.0 * np.sin(2.0 * math.pi * 25.0 * TIME))
KINDS = ["tdms", "h5", "csv", "mf4"]


@dataclass
class Written:
    """A signal for a file: samples, what is said of them, and the times of its group with their unit."""

    name: str
    samples: Any
    said: dict[str, Any] = field(default_factory=dict)
    time: Any = None
    time_unit: str = ""


def write(path: Path, *signals: Written) -> None:
    {".tdms": write_tdms, ".h5": write_hdf5, ".csv": write_csv}[path.suffix](path, signals)


def write_tdms(path: Path, signals: tuple[Written, ...]) -> None:
    objects: dict[str, ChannelObject] = {}
    for one in signals:
        group, _, name = one.name.rpartition("/")
        objects[one.name] = ChannelObject(group or "D", name, one.samples, properties=one.said)
        if one.time is not None:
            unit = {"unit_string": one.time_unit}
            objects[f"{group}/time"] = ChannelObject(group or "D", "time", one.time, properties=unit)
    with TdmsWriter(path) as writer:
        writer.write_segment([RootObject(), *objects.values()])


def write_hdf5(path: Path, signals: tuple[Written, ...]) -> None:
    with h5py.File(path, "w") as file:
        for one in signals:
            file[one.name] = one.samples
            file[one.name].attrs.update(one.said)
            at = f"{one.name.rpartition('/')[0]}/time"
            if one.time is not None and at not in file:
                file[at] = one.time
                file[at].attrs["units"] = one.time_unit


def write_csv(path: Path, signals: tuple[Written, ...]) -> None:
    head = [
        ",".join(["time", *(one.name for one in signals)]),
        ",".join([signals[0].time_unit, *("N m" for _ in signals)]),
    ]
    rows = [
        ",".join(str(cell) for cell in row) for row in zip(signals[0].time, *(one.samples for one in signals))
    ]
    path.write_text("\n".join([*head, *rows]) + "\n", encoding="utf-8")


class StubMdf:
    """What is used of asammdf: groups with a master, and samples over the time since the measurement began."""

    signals: Mapping[str, Written]

    def __init__(self, path: Path) -> None:
        self.names = list(self.signals)
        self.groups = [
            SimpleNamespace(
                channel_group=SimpleNamespace(acq_name=name.rpartition("/")[0], comment=""),
                channels=[
                    SimpleNamespace(
                        name="t", channel_type=2, sync_type=one.said.get("sync_type", 1), unit=one.time_unit
                    ),
                    SimpleNamespace(name=name.rpartition("/")[2], channel_type=0, sync_type=0, unit=""),
                ],
            )
            for name, one in self.signals.items()
        ]

    def __enter__(self) -> "StubMdf":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def get(self, group: int, index: int) -> SimpleNamespace:
        one = self.signals[self.names[group]]
        assert index == 1
        return SimpleNamespace(samples=np.asarray(one.samples), timestamps=np.asarray(one.time), unit="N m")


@pytest.fixture
def read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Writes signals in a kind of file and reads those that are wanted."""

    def through(
        kind: str, signals: tuple[Written, ...], *wanted: str, data: DataSection | None = None, **more: Any
    ) -> Signals:
        path = tmp_path / f"P01.{kind}"
        if kind == "mf4":
            module = ModuleType("asammdf")
            stub = type("MDF", (StubMdf,), {"signals": {one.name: one for one in signals}})
            module.MDF = stub  # type: ignore[attr-defined]
            monkeypatch.setitem(sys.modules, "asammdf", module)
            path.write_bytes(b"MDF     4.10    ")
        else:
            write(path, *signals)
        return read_signals(tmp_path, path.name, data or DataSection(), wanted, **more)

    return through


def refused(read, *arguments: Any, **more: Any) -> str:
    with pytest.raises(MeasurementError) as caught:
        read(*arguments, **more)
    return str(caught.value)


# Time


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("unit", "worth"), [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0), ("", 1.0)]
)
def test_a_signal_of_times_counts_in_its_unit(read, kind: str, unit: str, worth: float) -> None:
    found = read(kind, (Written("D/M", TORQUE, time=TIME / worth, time_unit=unit),), "M")["M"]
    np.testing.assert_allclose(found.time, TIME, atol=1e-9)
    np.testing.assert_allclose(found.values, TORQUE)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("unit", "stated", "words"),
    [
        ("Hz", None, "is a unit of frequency, not of recording time"),
        ("furlong", None, "is not a known unit, not of recording time"),
        ("ms", "s", 'its time is in "ms", data.time_unit says "s"'),
    ],
)
def test_a_unit_that_is_none_of_time_or_another_one_is_refused(
    read, kind: str, unit: str, stated, words: str
) -> None:
    signals = (Written("D/M", TORQUE, time=TIME, time_unit=unit),)
    assert words in refused(read, kind, signals, "M", data=DataSection(time_unit=stated))


@pytest.mark.parametrize("kind", KINDS)
def test_a_unit_is_stated_where_the_file_has_none(read, kind: str) -> None:
    signals = (Written("D/M", TORQUE, time=1e3 * TIME),)
    np.testing.assert_allclose(
        read(kind, signals, "M", data=DataSection(time_unit="ms"))["M"].time, TIME, atol=1e-9
    )


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("tdms", {"wf_increment": 1.0, "wf_xunit_string": "ms"}),
        ("tdms", {"wf_increment": 1e-3}),
        ("h5", {"dt": 1.0, "dt_unit": "ms"}),
        ("h5", {"dt": np.array([[1e-3]])}),
        ("h5", {"sample_rate": 1.0, "sample_rate_unit": "kHz"}),
        ("h5", {"sample_rate": np.array([[1000.0]])}),
    ],
)
def test_a_sampling_rate_counts_in_its_unit(read, kind: str, said: dict[str, Any]) -> None:
    np.testing.assert_allclose(read(kind, (Written("D/M", TORQUE, said),), "M")["M"].time, TIME, atol=1e-9)


@pytest.mark.parametrize(
    ("kind", "said", "words"),
    [
        ("tdms", {"wf_increment": 1.0, "wf_xunit_string": "Hz"}, "unit of frequency, not of recording time"),
        ("h5", {"sample_rate": "fast"}, 'sample_rate = "fast" is no number'),
        ("h5", {"sample_rate": 1.0, "sample_rate_unit": "s"}, "is a unit of time, not of frequency"),
        ("h5", {"sample_rate": 0.5 * RATE}, "by its sampling rate, 0.499 s by its signal of times"),
    ],
)
def test_a_sampling_rate_that_cannot_be_is_refused(read, kind: str, said: dict[str, Any], words: str) -> None:
    time = TIME if words.startswith("by its") else None
    assert words in refused(read, kind, (Written("D/M", TORQUE, said, time, "s"),), "M")


STAMPS = np.datetime64("2026-03-04T08:15:00", "us") + (1e6 * TIME).round().astype("timedelta64[us]")


@pytest.mark.parametrize(
    ("kind", "stamps"),
    [
        ("tdms", STAMPS),
        ("h5", STAMPS.astype(str).astype("S")),
        ("csv", STAMPS.astype(str)),
        ("csv", [f"4.3.2026 08:15:00.{milli:03d}" for milli in range(COUNT)]),
        ("csv", [f"8:15:00.{milli:03d}" for milli in range(COUNT)]),
    ],
)
def test_time_stamps_are_recognised(read, kind: str, stamps: Any) -> None:
    found = read(kind, (Written("D/M", TORQUE, time=stamps),), "M")["M"]
    np.testing.assert_allclose(found.time, TIME, atol=1e-9)


# What places signals against each other

EARLY, LATE = np.datetime64("2026-03-04T08:15:00.000000"), np.datetime64("2026-03-04T08:15:00.020000")
STEP = {"tdms": {"wf_increment": 1e-3}, "h5": {"dt": 1e-3}}


@pytest.mark.parametrize(
    ("kind", "early", "late"),
    [
        ("tdms", {"wf_start_time": EARLY}, {"wf_start_time": LATE}),
        ("tdms", {}, {"wf_start_offset": 0.02}),
        ("tdms", {"wf_start_time": LATE, "wf_start_offset": -0.02}, {"wf_start_time": LATE}),
        ("h5", {"t0": 5.0}, {"t0": 5.02}),
        ("h5", {"start_time": str(EARLY)}, {"start_time": str(LATE)}),
    ],
)
def test_a_group_that_began_later_is_placed_later(
    read, kind: str, early: dict[str, Any], late: dict[str, Any]
) -> None:
    """A tach that began half a turn after the torque: the phase of order 1 would be off by 180 degrees."""
    signals = (Written("A/M", TORQUE, STEP[kind] | early), Written("B/Tach", TACH[20:], STEP[kind] | late))
    found = read(kind, signals, "M", "Tach")
    np.testing.assert_allclose(found["Tach"].time[0] - found["M"].time[0], 0.02, atol=1e-9)
    angle = turn_angle(Tach(kind="pulses", signal="Tach"), found, None).at(found["M"].time)
    inside = np.isfinite(angle)
    phase = np.angle(np.sum((found["M"].values - 100.0)[inside] * np.exp(-1j * angle[inside])))
    assert phase == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize(
    ("kind", "early", "late", "words"),
    [
        ("tdms", {"wf_start_time": EARLY}, {}, "Tach: has no start, M has one"),
        (
            "tdms",
            {"wf_start_time": EARLY},
            {"wf_start_time": np.datetime64("1904-01-01T00:00:00")},
            "has no start",
        ),
        ("tdms", {"Trigger_Delay": 0.0}, {"Trigger_Delay": 0.02}, "Trigger_Delay = 0.0 at M, 0.02 at Tach"),
        ("h5", {}, {"pretrigger": 20}, "pretrigger = None at M, 20 at Tach"),
        ("h5", {"start_time": "early"}, {"start_time": "late"}, "start_time = early at M, late at Tach"),
    ],
)
def test_a_start_that_is_not_known_is_refused_where_it_counts(
    read, kind: str, early, late, words: str
) -> None:
    signals = (Written("A/M", TORQUE, STEP[kind] | early), Written("B/Tach", TACH, STEP[kind] | late))
    assert words in refused(read, kind, signals, "M", "Tach")
    assert set(read(kind, signals, "M", "Tach", timed=["M"])) == {"M", "Tach"}


def test_signals_of_mdf_are_in_the_time_of_the_measurement_or_refused(read) -> None:
    early, late = Written("A/M", TORQUE, time=TIME), Written("B/Tach", TACH, time=TIME + 0.02)
    found = read("mf4", (early, late), "M", "Tach")
    assert found["Tach"].time[0] - found["M"].time[0] == pytest.approx(0.02)
    late.said["sync_type"] = 2  # over an angle
    assert "B/Tach: is not recorded over time" in refused(read, "mf4", (early, late), "M", "Tach")


# Names

OIL, ROOM = 61.6 + 0.01 * np.arange(COUNT), 22.0 + 0.01 * np.arange(COUNT)


@pytest.mark.parametrize("kind", KINDS)
def test_two_signals_of_one_name_are_told_apart_by_their_groups(read, kind: str) -> None:
    said = STEP.get(kind, {})
    time = None if said else TIME
    signals = (Written("Room/T", ROOM, said, time), Written("Oil/T", OIL, said, time))
    words = refused(read, kind, signals, "T")
    assert "T: 2 signals have this name" in words and "Room/T" in words and "Oil/T" in words
    found = read(kind, signals, "Oil/T", "Room/T")
    np.testing.assert_allclose(found["Oil/T"].values, OIL)
    np.testing.assert_allclose(found["Room/T"].values, ROOM)
    assert read(kind, signals[1:], "T")["T"].values[0] == OIL[0]


def test_real_mdf4(tmp_path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        for group, values in (("Room", ROOM), ("Oil", OIL)):
            signal = asammdf.Signal(samples=values, timestamps=TIME, name="T", unit="degC")
            file.append([signal], comment=group)
        file.save(tmp_path / "P01.mf4")
    with pytest.raises(MeasurementError, match="Room/T and Oil/T"):
        read_signals(tmp_path, "P01.mf4", DataSection(), ["T"])
    found = read_signals(tmp_path, "P01.mf4", DataSection(), ["Oil/T"])["Oil/T"]
    np.testing.assert_allclose(found.values, OIL)
    assert found.unit == "degC"


# Beside the wanted signals

OTHERS: Mapping[str, list[Written]] = {
    "tdms": [
        Written("C/Serial", np.array([4711], dtype=np.int32)),
        Written("C/Texts", ["ok", "ok"]),
        Written("C/Empty", np.array([], dtype=float)),
    ],
    "h5": [
        Written("gains", np.array([1.0, 2.0])),
        Written("texts", np.array([b"ok", b"ok"])),
        Written("matrix", np.zeros((3, 2)), {"sample_rate": "fast"}),
        Written("empty", np.zeros(0)),
    ],
    "csv": [Written("Status", ["OK"] * COUNT), Written("Empty", [""] * COUNT)],
    "mf4": [Written("C/Status", ["OK"] * COUNT, {"sync_type": 2}, TIME)],
}


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_not_wanted_is_left_alone_and_refused_where_it_is(read, kind: str) -> None:
    said = STEP.get(kind, {})
    own = Written("Oil/T", OIL, said, None if said else TIME)
    signals = (own, *OTHERS[kind])
    found = read(kind, signals, "T")
    np.testing.assert_allclose(found["T"].values, OIL)
    for other in OTHERS[kind][:3]:
        name = other.name.rpartition("/")[2]
        assert any(one.endswith(name) for one in found.names)
        if name != "Empty" or kind != "csv":
            assert name in refused(read, kind, signals, "T", name)


# HDF5 as MATLAB writes it


@pytest.mark.parametrize("shape", [(COUNT, 1), (1, COUNT)])
def test_a_vector_is_a_signal_whatever_its_shape(read, shape: tuple[int, int]) -> None:
    signals = (Written("M", TORQUE.reshape(shape), {"sample_rate": RATE, "units": "N m"}),)
    found = read("h5", signals, "M")["M"]
    np.testing.assert_allclose(found.values, TORQUE)
    assert found.unit == "N m"


def test_a_table_of_named_columns_is_read_by_column(read) -> None:
    table = np.zeros(COUNT, dtype=[("time", "<f8"), ("M", "<f8"), ("state", "S2")])
    table["time"], table["M"] = TIME, TORQUE
    found = read("h5", (Written("log", table),), "M")
    np.testing.assert_allclose(found["M"].time, TIME)
    np.testing.assert_allclose(found["M"].values, TORQUE)
    assert found.names == ("log/time", "log/M", "log/state")


def test_a_matrix_is_refused_with_its_shape(read) -> None:
    signals = (Written("M", np.zeros((250, 2)), {"sample_rate": RATE}),)
    assert "M: has the shape 250 x 2, a signal has one dimension" in refused(read, "h5", signals, "M")


# Pulses of a turn


def turning(pulses: int, seconds: float = 1.0) -> Signals:
    time = np.arange(int(20_000 * seconds)) / 20_000.0
    angle = 2.0 * math.pi * 5.0 * time
    return Signals(
        Tach=Signal(time, (np.mod(pulses * angle / (2.0 * math.pi), 1.0) < 0.5).astype(float)),
        Index=Signal(time, (np.mod(angle - 1.0, 2.0 * math.pi) < 0.5).astype(float)),
    )


@pytest.mark.parametrize("stated", [60, None])
def test_an_index_gives_or_confirms_the_pulses_of_a_turn(stated: int | None) -> None:
    tach = Tach(kind="pulses", signal="Tach", index="Index", pulses_per_turn=stated)
    assert turn_angle(tach, turning(60), None).speed == pytest.approx(2.0 * math.pi * 5.0, rel=1e-4)


@pytest.mark.parametrize("stated", [64, 61, 1])
def test_pulses_that_the_index_contradicts_give_no_angle(stated: int) -> None:
    """61 for 60 turns the speed by 1.6 % only, and every order of 60 turns vanishes."""
    tach = Tach(kind="pulses", signal="Tach", index="Index", pulses_per_turn=stated)
    with pytest.raises(
        TachError, match=f"Index comes every 60 pulses of Tach, data.tach.pulses_per_turn says {stated}"
    ):
        turn_angle(tach, turning(60), None)
