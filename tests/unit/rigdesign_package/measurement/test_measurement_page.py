"""cases/measurement_sets.md is true: its sets load, its command runs; raw files of every kind give the same orders."""

import json
import math
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from nptdms import ChannelObject, TdmsWriter

from rigdesign.base.errors import MeasurementError, OutputError
from rigdesign.case import load_case
from rigdesign.cli.main import app
from rigdesign.measurement import features, load_measurement
from rigdesign.measurement.template import write_template
from rigdesign.prediction import Feature
from tests.builders.measurement import replaced
from tests.builders.page_files import written_out
from tests.builders.paths import CASES

PAGE = (CASES / "measurement_sets.md").read_text(encoding="utf-8")
RATE = 10_000.0
ORDERS = {0.0: 103.0 + 0j, 1.0: 0.6 - 0.3j, 2.0: 0.1j}
ZERO = math.radians(12.0)
"""Angle of the gear at the pulse, as the page has it."""


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "loop_1to1")


def signals(seconds: float = 2.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, torque and tach of 25 turns a second; the tach rises where the gear stands at 12 degrees."""
    time = np.arange(int(RATE * seconds)) / RATE
    phi = 2 * math.pi * 25.0 * time + 0.2 * np.sin(2 * math.pi * 0.7 * time)
    torque = sum((amplitude * np.exp(1j * k * phi)).real for k, amplitude in ORDERS.items())
    return time, np.asarray(torque), np.tanh(60.0 * np.sin(phi - ZERO))


def write_tdms(path: Path, unit: str = "N m", torque: np.ndarray | None = None) -> None:
    _, own, tach = signals()
    timing = {"wf_increment": 1.0 / RATE, "wf_start_offset": 0.0}
    values = own if torque is None else torque
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("Dev1", "ai0", values, properties={**timing, "unit_string": unit}),
                ChannelObject("Dev1", "Tach", tach, properties={**timing, "unit_string": "V"}),
            ]
        )


def write_hdf5(path: Path) -> None:
    _, torque, tach = signals()
    with h5py.File(path, "w") as file:
        file.attrs["sample_rate"] = RATE
        file["Dev1/ai0"] = torque
        file["Dev1/ai0"].attrs["units"] = "N m"
        file["Tach"] = tach


def write_csv(path: Path) -> None:
    rows = ["time,Dev1/ai0,Tach", "s,N m,V"]
    rows += [f"{t:.5f},{m:.6f},{p:.6f}" for t, m, p in zip(*signals(1.0))]
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "writer"), [("P01_1.tdms", write_tdms), ("P01_1.h5", write_hdf5), ("P01_1.csv", write_csv)]
)
def test_the_labview_set_gives_the_orders_in_the_signal(tmp_path: Path, case, name: str, writer) -> None:
    """The page's low-pass of two poles is undone, so the orders come out larger by its gain."""
    written_out(PAGE, tmp_path)
    replaced(tmp_path / "labview", "measurement.toml", "P01_1.tdms", name)
    writer(tmp_path / "labview" / name)
    data = features(load_measurement(tmp_path / "labview", case))
    at = dict(zip(data.features, data.values))
    assert at[Feature("M_wheel", "P01")] == pytest.approx(103.0, abs=2e-3)
    for order in (1.0, 2.0):
        s = 1j * order * 2 * math.pi * 25.0 / (2 * math.pi * 2000.0)
        true = ORDERS[order] * (s**2 + math.sqrt(2) * s + 1)
        read = complex(*(at[Feature("M_wheel", "P01", order, part)] for part in ("real", "imaginary")))
        assert read == pytest.approx(true, abs=6e-3)


def test_the_spreadsheet_set_is_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written_out(PAGE, tmp_path)
    assert re.search(r"^ {4}rigdesign compare cases/loop_1to1 spreadsheet --out out$", PAGE, re.MULTILINE)
    arguments = [
        "compare",
        str(CASES / "loop_1to1"),
        str(tmp_path / "spreadsheet"),
        "--out",
        str(tmp_path / "out"),
    ]
    assert app(arguments, result_action="return_value") == 0
    assert "simulation" in capsys.readouterr().out.lower()
    document = json.loads((tmp_path / "out" / "compare.json").read_text(encoding="utf-8"))
    assert document["measurement"]["points"] == 3 and document["measurement"]["strength"] == "proven"
    assert {row["channel"] for row in document["residuals"]} == {"T_gear_out", "P"}
    assert (tmp_path / "out" / "compare.html").stat().st_size > 20_000


@pytest.mark.parametrize("name", ["loop_1to1", "uhcf_prototype"])
def test_a_template_loads_once_it_is_filled_in(tmp_path: Path, name: str) -> None:
    case = load_case(CASES / name)
    paths = write_template(case, tmp_path / "new")
    lines = paths[1].read_text(encoding="utf-8").splitlines()
    units = lines[1].split(",")
    values = {
        "rpm": "1000",
        "N m": "50",
        "degC": "40",
        "l/min": "1",
        "W": "500",
        "deg": "0.1",
        "Hz": "300",
        "mm": "0.1",
    }
    row = ["P01", "1", *(values[unit] for unit in units[2:])]
    paths[1].write_text("\n".join([*lines[:2], ",".join(row)]) + "\n", encoding="utf-8")
    measurement = load_measurement(tmp_path / "new", case)
    data = features(measurement)
    assert len(data.settings[0].inlet_temperature) == 4 and len(data.settings[0].flow) == 4
    assert {"one_point", "no_repeats"} <= {finding.id for finding in data.findings}
    assert not any(
        finding.weight == "dropped" and finding.id != "missing_channel" for finding in data.findings
    )
    with pytest.raises(OutputError, match="is there already"):
        write_template(case, tmp_path / "new")


def labview(tmp_path: Path, **changes: str) -> Path:
    written_out(PAGE, tmp_path)
    for old, new in changes.items():
        replaced(tmp_path / "labview", "measurement.toml", old, new)
    return tmp_path / "labview"


def findings_of(folder: Path, case) -> dict[str, str]:
    measurement = load_measurement(folder, case)
    return {finding.id: finding.text for finding in measurement.findings}


def test_a_signal_in_another_unit_is_refused(tmp_path: Path, case) -> None:
    folder = labview(tmp_path)
    write_tdms(folder / "P01_1.tdms", unit="V")
    with pytest.raises(MeasurementError, match='unit says "N m"'):
        load_measurement(folder, case)


def test_a_file_cut_in_the_middle_is_refused_or_read_as_far_as_it_goes(tmp_path: Path, case) -> None:
    folder = labview(tmp_path)
    write_hdf5(folder / "P01_1.h5")
    replaced(folder, "measurement.toml", "P01_1.tdms", "P01_1.h5")
    whole = (folder / "P01_1.h5").read_bytes()
    (folder / "P01_1.h5").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(MeasurementError, match="cannot be read or was cut off"):
        load_measurement(folder, case)


@pytest.mark.parametrize("name", ["P01_1.tdms", "P01_1.xlsx"])
def test_a_missing_or_unknown_file_is_refused(tmp_path: Path, case, name: str) -> None:
    folder = labview(tmp_path)
    replaced(folder, "measurement.toml", "P01_1.tdms", name)
    with pytest.raises(MeasurementError, match=r"no such file|unknown kind of file"):
        load_measurement(folder, case)


def spoilt_torque(kind: str) -> np.ndarray:
    _, torque, _ = signals()
    if kind == "clipped":
        return np.clip(torque, 102.6, 103.3)
    if kind == "dead":
        return np.full_like(torque, 103.0)
    gaps = torque.copy()
    gaps[5000:5100] = np.nan
    return gaps if kind == "gaps" else np.where(np.arange(len(torque)) % 3 > 0, np.nan, torque)


@pytest.mark.parametrize(
    ("kind", "identity", "usable"),
    [
        ("clipped", "clipped", False),
        ("dead", "dead_channel", False),
        ("holes", "missing_samples", False),
        ("gaps", "missing_samples", True),
    ],
)
def test_a_bad_signal_is_left_out_and_said(
    tmp_path: Path, case, kind: str, identity: str, usable: bool
) -> None:
    folder = labview(tmp_path)
    write_tdms(folder / "P01_1.tdms", torque=spoilt_torque(kind))
    if usable:
        assert identity in findings_of(folder, case)
        return
    with pytest.raises(MeasurementError, match="no channel has a reading") as caught:
        load_measurement(folder, case)
    words = {
        "clipped": "is clipped",
        "dead_channel": "throughout",
        "missing_samples": "of its samples are missing",
    }
    assert words[identity] in str(caught.value)


@pytest.mark.parametrize(
    ("speed", "weight", "words"),
    [
        ("1500", "", ""),
        ("1515", "suspect", "the table 1515 rpm"),
        ("3000", "dropped", "nothing that depends on the angle is read"),
        ("90000", "dropped", 'the unit of its time, which would fit as "min"'),
    ],
)
def test_a_tach_of_another_speed_is_told_and_gives_no_orders(
    tmp_path: Path, case, speed: str, weight: str, words: str
) -> None:
    """1 % is more than the table may be off (1 rpm), and less than leaves no doubt that one of them is wrong."""
    folder = labview(tmp_path)
    replaced(folder, "data.csv", ",n,M", ",n,M,P")
    replaced(folder, "data.csv", ",rpm,N m", ",rpm,N m,W")
    replaced(folder, "data.csv", "P01,1,1500,100", f"P01,1,{speed},100,470")
    replaced(folder, "measurement.toml", "[channels.M_wheel]",
             '[channels.P]\nquantity = "motor_power"\nunit = "W"\nuncertainty = "5 W"\n[channels.M_wheel]')  # fmt: skip
    write_tdms(folder / "P01_1.tdms")
    measurement = load_measurement(folder, case)
    said = [finding for finding in measurement.findings if finding.id == "tach_speed"]
    assert [finding.weight for finding in said] == ([weight] if weight else [])
    assert not said or words in said[0].text
    assert ("M_wheel" in measurement.channels) == (weight != "dropped")
    assert not any(finding.id == "missing_channel" for finding in measurement.findings)


def test_a_mesh_line_beside_its_order_is_suspected(tmp_path: Path, case) -> None:
    folder = labview(tmp_path)
    time, torque, _ = signals()
    phi = 2 * math.pi * 25.0 * time + 0.2 * np.sin(2 * math.pi * 0.7 * time)
    write_tdms(folder / "P01_1.tdms", torque=torque + 2.0 * np.cos(28.5 * phi))
    assert "order 28.5" in findings_of(folder, case)["mesh_order"]
    write_tdms(folder / "P01_1.tdms", torque=torque + 2.0 * np.cos(28.0 * phi))
    assert "mesh_order" not in findings_of(folder, case)
