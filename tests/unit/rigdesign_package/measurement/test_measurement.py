"""Measurement sets: loading, means and noise, and everything that can be wrong with them."""

import re
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import Data, MeasurementSet, features, load_measurement
from rigdesign.measurement.places import Places
from rigdesign.prediction import Feature
from tests.builders.measurement import (
    HEAD,
    changed_column,
    order_truth,
    points,
    replaced,
    truth,
    write_set,
)
from tests.builders.paths import CASES

ZERO = 273.15


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "uhcf_prototype")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_set(tmp_path / "set")


def loaded(folder: Path, case) -> tuple[MeasurementSet, Data]:
    measurement = load_measurement(folder, case)
    return measurement, features(measurement)


def identities(data: Data, weight: str = "") -> set[str]:
    return {finding.id for finding in data.findings if not weight or finding.weight == weight}


def faults(folder: Path, case) -> str:
    with pytest.raises(MeasurementError) as caught:
        load_measurement(folder, case)
    return str(caught.value)


def test_a_whole_set_is_read_in_si(folder: Path, case) -> None:
    measurement, data = loaded(folder, case)
    at = {feature: i for i, feature in enumerate(data.features)}
    for name, speed, torque in points():
        i = at[Feature("TC1", name)]
        assert data.values[i] == pytest.approx(truth("TC1", speed, torque) + ZERO, abs=1e-6)
        mean = at[Feature("M_wheel", name)]
        assert data.values[mean] == pytest.approx(truth("M_wheel", speed, torque), abs=1e-6)
        parts = [data.values[at[Feature("M_wheel", name, 99.0, part)]] for part in ("real", "imaginary")]
        assert complex(*parts) == pytest.approx(order_truth(99.0, speed, torque), abs=1e-6)
    assert data.values[at[Feature("f1", "")]] == 510.0
    assert data.settings[2].speed == pytest.approx(8000.0 * np.pi / 30)
    assert data.settings[0].inlet_temperature == {"test.gear_oil": pytest.approx(413.15)}
    assert data.usable.all() and data.strength == "proven" and not data.findings
    assert measurement.baseline is None and len(measurement.hash) == 64


def test_noise_pools_repeats_with_what_is_declared(folder: Path, case) -> None:
    """Two repeats 0.02 above and below their mean at six points: squares 6 * 2 * 0.02^2 with 6 degrees of freedom."""
    _, data = loaded(folder, case)
    i = data.features.index(Feature("TC1", "P01"))
    pooled = np.sqrt((4 * 0.1**2 + 12 * 0.02**2) / (4 + 6))
    assert data.noise[i] == pytest.approx(pooled / np.sqrt(2), rel=1e-6)


def test_without_repeats_the_strength_is_indicative(tmp_path: Path, case) -> None:
    _, data = loaded(write_set(tmp_path / "one", repeats=1), case)
    assert data.strength == "indicative" and "no_repeats" in identities(data)
    assert data.noise[data.features.index(Feature("TC1", "P01"))] == pytest.approx(0.1)


def test_a_german_file_reads_the_same(folder: Path, case) -> None:
    expected = loaded(folder, case)[1]
    for name in ("data.csv", "orders.csv"):
        text = (folder / name).read_text(encoding="utf-8")
        text = text.replace(",", ";").replace(".", ",").replace("degC", "°C")
        (folder / name).write_bytes(text.encode("cp1252"))
    replaced(
        folder, "measurement.toml", "[data]", '[data]\ndelimiter = ";"\ndecimal = ","\nencoding = "cp1252"'
    )
    np.testing.assert_array_equal(loaded(folder, case)[1].values, expected.values)


def test_a_sensor_is_undone(folder: Path, case) -> None:
    before = loaded(folder, case)[1]
    replaced(folder, "measurement.toml", "orders = [0, 1, 99]",
             'orders = [0, 1, 99]\ntransfer = { kind = "low_pass", frequency = "10 kHz" }')  # fmt: skip
    after = loaded(folder, case)[1]
    real = after.features.index(Feature("M_wheel", "P05", 99.0, "real"))
    true = complex(*after.values[real : real + 2])
    read = complex(*before.values[real : real + 2])
    assert true == pytest.approx(read * (1 + 1j * 99 * 200 / 10_000), rel=1e-9)
    assert after.noise[real] == pytest.approx(before.noise[real] * abs(1 + 1.98j), rel=1e-9)


def test_an_order_the_sensor_holds_back_is_not_used(folder: Path, case) -> None:
    replaced(folder, "measurement.toml", "orders = [0, 1, 99]",
             'orders = [0, 1, 99]\ntransfer = { kind = "low_pass", frequency = "3 kHz", poles = 2 }')  # fmt: skip
    _, data = loaded(folder, case)
    assert "held_back" in identities(data, "dropped")
    assert not data.usable[data.features.index(Feature("M_wheel", "P05", 99.0, "real"))]
    assert data.usable[data.features.index(Feature("M_wheel", "P05", 1.0, "real"))]


def test_points_carry_what_is_said_of_them(folder: Path, case) -> None:
    said = (
        '[points.P03]\nreassembled = true\ntooth_offset = { "test.main" = 3 }\n[points.P04]\nsteady = false\n'
    )
    replaced(folder, "measurement.toml", "[settings.n]", said + "[settings.n]")
    _, data = loaded(folder, case)
    assert data.assembly == (0, 0, 1, 1, 1, 1)
    assert data.settings[2].tooth_offset == {"test.main": 3}
    assert "not_steady" in identities(data, "dropped")
    assert not data.usable[data.features.index(Feature("TC1", "P04"))]
    assert data.usable[data.features.index(Feature("P", "P04"))]


WRONG = [
    (
        'place = "test.outer_warm"',
        'place = "test.outer_worm"',
        "channels.TC1.place",
        'did you mean "test.outer_warm"',
    ),
    ('place = "wheel_side"', 'place = "wheelside"', "channels.M_wheel.place", 'did you mean "wheel_side"'),
    ('unit = "W"', 'unit = "N m"', "channels.P.unit", "unit of torque, not of power"),
    ('unit = "Hz"', 'unit = "hertzen"', "channels.f1.unit", "not a known unit"),
    ('uncertainty = "5 W"', "uncertainty = 5", "channels.P.uncertainty", "bare number"),
    ('uncertainty = "5 W"', 'uncertainty = "-5 W"', "channels.P.uncertainty", "below zero"),
    ('uncertainty = "0.3 K"', 'uncertainty = "0.3 degC"', "settings.T_in.uncertainty", "not a difference"),
    ('quantity = "speed"', 'quantity = "sped"', "settings.n.quantity", 'did you mean "speed"'),
    ('place = "1"', 'place = "first"', "channels.f1.place", "torsional natural frequency"),
    ('at = ["0.120 m", "0 m", "0.280 m"]', "", "channels.TC2.place", "add coordinates"),
    ('title = "trial"', 'title = "trial"\nbaseline = "../nowhere"', "baseline", "no measurement.toml"),
    ("[settings.n]", "[points.P77]\n[settings.n]", "points.P77", "no such point"),
    ("orders = [0, 1, 99]", "orders = [0, -1]", "channels.M_wheel.orders", "at least 0"),
    ('place = "test.gear_oil"', 'place = "test.gearoil"', "settings.T_in.place", "oil stream"),
    ("schema_version = 1", "schema_version = 2", "schema_version", "write 1"),
]


@pytest.mark.parametrize(("old", "new", "path", "words"), WRONG, ids=[row[2] + row[1][-12:] for row in WRONG])
def test_a_wrong_key_says_where_and_what_to_write(folder: Path, case, old, new, path, words) -> None:
    replaced(folder, "measurement.toml", old, new)
    text = faults(folder, case)
    assert path in text and words in text


def test_all_faults_come_at_once(folder: Path, case) -> None:
    replaced(folder, "measurement.toml", "test.outer_warm", "test.nowhere")
    replaced(folder, "measurement.toml", 'unit = "Hz"', 'unit = "mm"')
    replaced(folder, "data.csv", ",,rpm,", ",,rad/s,")
    text = faults(folder, case)
    assert text.splitlines()[0].endswith("3 faults")
    assert (
        "channels.TC1.place" in text and "channels.f1.unit" in text and 'settings.n.unit says "rpm"' in text
    )


SPOILT = [
    ("data.csv", lambda text: "", "holds no readings"),
    ("data.csv", lambda text: text.replace(",", ";"), 'delimiter = ";"'),
    ("data.csv", lambda text: text.replace("P02,1,", "P02,x,"), "not a whole number"),
    ("data.csv", lambda text: text.replace("P02,2,", "P02,1,"), "stands in line"),
    ("data.csv", lambda text: text.replace("TC1,TC2", "TC1,TC1"), "two columns have this name"),
    ("data.csv", lambda text: text.replace("point,", "punkt,", 1), "no column 'point'"),
    ("data.csv", lambda text: re.sub(r"^,,rpm.*\n", "", text, flags=re.M), "row of units is missing"),
    ("data.csv", lambda text: text.replace("P02,1,", "P02,1,,"), "cells, the names are"),
    ("data.csv", lambda text: text.replace(",n,", ",nn,"), "no such column"),
    ("orders.csv", lambda text: text.replace("imaginary", "imag"), "no column imaginary"),
    ("orders.csv", lambda text: text.replace("P02,1", "P99,1"), "no such point"),
    ("orders.csv", lambda text: text.replace("M_wheel", "TC1"), "no such channel that is read by orders"),
    ("orders.csv", lambda text: text + text.splitlines()[-1] + "\n", "stands in line"),
    ("measurement.toml", lambda text: text[:-20], "not valid TOML or was cut off"),
]


@pytest.mark.parametrize(("name", "spoil", "words"), SPOILT, ids=[row[2][:18] for row in SPOILT])
def test_a_spoilt_file_is_refused_with_a_remedy(folder: Path, case, name, spoil, words) -> None:
    path = folder / name
    path.write_text(spoil(path.read_text(encoding="utf-8")), encoding="utf-8")
    assert words in faults(folder, case)


LEFT_BY_SPREADSHEETS = {
    "sep": lambda text: "sep=,\n" + text,
    "sep of a whole row": lambda text: '"sep=,",,,,\r\n' + text,
    "delimiter at the end": lambda text: text.replace("\n", ",\n"),
    "empty columns at the end": lambda text: text.replace("\n", ",,,\n"),
    "delimiter at the end of readings": lambda text: re.sub(r"^(P\d.*)$", r"\1,", text, flags=re.M),
    "comment": lambda text: "# exported 4.3.2026\n" + text.replace("P03,1", "# warmer\nP03,1"),
    "comment of a whole row": lambda text: "# exported,,,,,\n" + text,
}


@pytest.mark.parametrize("change", LEFT_BY_SPREADSHEETS.values(), ids=LEFT_BY_SPREADSHEETS)
def test_what_a_spreadsheet_leaves_around_a_table_is_no_reading(folder: Path, case, change) -> None:
    expected = loaded(folder, case)[1]
    for name in ("data.csv", "orders.csv"):
        path = folder / name
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8", newline="")
    data = loaded(folder, case)[1]
    np.testing.assert_array_equal(data.values, expected.values)
    assert not data.findings


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda text: "sep=;\n" + text,
            'data.csv line 1: says that ";" parts the columns, data.delimiter is ","',
        ),
        (lambda text: "exported 4.3.2026\n" + text, "has 1 cells, every row below 10"),
        (lambda text: "Test bench,4\n" + text, "has 2 cells, every row below 10"),
    ],
)
def test_what_stands_above_the_names_is_one_fault(folder: Path, case, change, words: str) -> None:
    path = folder / "data.csv"
    path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    said = faults(folder, case)
    assert words in said and "faults" not in said


def test_rows_of_a_point_are_counted_where_no_column_of_repeats_is(folder: Path, case) -> None:
    expected = loaded(folder, case)[1]
    text = (folder / "data.csv").read_text(encoding="utf-8").splitlines()
    rows = [[cell for place, cell in enumerate(line.split(",")) if place != 1] for line in text]
    (folder / "data.csv").write_text("\n".join(",".join(row) for row in rows) + "\n", encoding="utf-8")
    np.testing.assert_array_equal(loaded(folder, case)[1].values, expected.values)


@pytest.mark.parametrize(
    ("cells", "suspected"),
    [
        (["470", "2.871", "466", "2864", "1802", "1796"], ["P01"]),
        (["1.470", "2.871", "1.466", "2.864", "1802", "1796"], ["P01", "P01", "P02", "P02"]),
        (["1.470", "2.871", "1.466", "2.864", "1.802", "1.796"], []),
        (["470.123", "2.871", "466.456", "2864.789", "1802", "1796"], []),
        (["470", "0.871", "466", "2864", "1802", "1796"], []),
        (["2.5", "2.871", "2.4", "2.6", "1.8", "1.7"], []),
    ],
)
def test_a_number_that_both_conventions_accept_is_held_against_its_column(
    folder: Path, case, cells: list[str], suspected: list[str]
) -> None:
    rows = iter(cells * 2)
    changed_column(folder, "P", lambda value: next(rows))
    said = [one for one in load_measurement(folder, case).findings if one.id == "thousands"]
    assert all(one.weight == "suspect" and "a factor of 1000" in one.text for one in said)
    assert [point for one in said for point in one.points][: len(suspected)] == suspected
    assert bool(said) == bool(suspected)
    assert all(f'P = "{cells[0]}"' in one.text or f'P = "{cells[1]}"' in one.text for one in said[:1])


@pytest.mark.parametrize(
    ("content", "named"),
    [(b"PK\x03\x04\x14\0 xl/workbook.xml", "an Excel workbook (.xlsx)"), (b"TDSm\x0e\0", "a TDMS recording")],
)
def test_a_table_of_another_format_is_named_as_such(folder: Path, case, content: bytes, named: str) -> None:
    (folder / "data.csv").write_bytes(content)
    reported = faults(folder, case)
    assert f"is {named}, not a table of text; export the sheet as CSV" in reported


@pytest.mark.parametrize("content", [bytes(range(256)) * 4, b"a,b\0c\n1,2\n"])
def test_bytes_that_are_no_text(folder: Path, case, content: bytes) -> None:
    (folder / "data.csv").write_bytes(content)
    assert "text" in faults(folder, case)


def test_no_such_set(tmp_path: Path, case) -> None:
    with pytest.raises(MeasurementError, match="no measurement"):
        load_measurement(tmp_path, case)
    with pytest.raises(MeasurementError, match="no such file"):
        load_measurement(tmp_path / "nothing", case)


GOES_ON = [
    ("dead_channel", "dropped", lambda f: changed_column(f, "TC1", lambda value: 21.0)),
    ("dead_channel", "dropped", lambda f: changed_column(f, "TC1", lambda value: "NaN")),
    ("missing_channel", "dropped", lambda f: replaced(f, "measurement.toml", "[channels.TC1]", "[channels.TC9]")),
    ("unused_column", "note", lambda f: replaced(f, "measurement.toml", "[channels.TC1]", "[channels.TC9]")),
    ("cut_file", "dropped", lambda f: replaced(f, "data.csv", "standstill,1,,,,,,,,510\n", "P07,1,40")),
    ("zero_uncertainty", "note", lambda f: replaced(f, "measurement.toml", '"5 W"', '"0 W"')),
    ("unit", "suspect", lambda f: changed_column(f, "TC1", lambda value: value + ZERO)),
    ("unit", "suspect", lambda f: changed_column(f, "n", lambda value: value * 60 / 2 / np.pi)),
    ("unused_order", "note", lambda f: replaced(f, "measurement.toml", "[0, 1, 99]", "[0, 1]")),
    ("unknown_setting", "dropped", lambda f: replaced(f, "data.csv", "P02,1,4000.0,", "P02,1,-4000.0,")),
    ("scatter", "note", lambda f: replaced(f, "measurement.toml", 'uncertainty = "0.1 K"', 'uncertainty = "0.001 K"')),
    ("same_readings", "suspect", lambda f: doubled(f)),
    ("other_case", "suspect",
     lambda f: replaced(f, "measurement.toml", '"trial"', '"trial"\ncase = "another"')),
]  # fmt: skip


def doubled(folder: Path) -> None:
    """The column of TC1 twice, as TC1 and TC1b."""
    table = HEAD.partition("[channels.TC1]")[2].partition("[channels.TC2]")[0]
    replaced(folder, "measurement.toml", "[channels.f1]", f"[channels.TC1b]{table}[channels.f1]")
    lines = [line.split(",") for line in (folder / "data.csv").read_text(encoding="utf-8").splitlines()]
    place = lines[0].index("TC1")
    for cells in lines:
        cells.insert(place, cells[place])
    lines[0][place] = "TC1b"
    (folder / "data.csv").write_text("\n".join(",".join(cells) for cells in lines) + "\n", encoding="utf-8")


@pytest.mark.parametrize(
    ("identity", "weight", "spoil"), GOES_ON, ids=[f"{r[0]}-{i}" for i, r in enumerate(GOES_ON)]
)
def test_what_can_go_on_goes_on_and_says_so(folder: Path, case, identity, weight, spoil) -> None:
    spoil(folder)
    _, data = loaded(folder, case)
    assert identity in identities(data, weight)
    assert data.usable.sum() > 15


def test_an_outlier_among_three_repeats_is_left_out(tmp_path: Path, case) -> None:
    folder = write_set(tmp_path / "three", repeats=3)
    lines = (folder / "data.csv").read_text(encoding="utf-8").splitlines()
    lines[2] = lines[2].replace(f"{truth('TC1', 4000.0, 90.0) - 0.02:.4f}", "99.0")
    (folder / "data.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    _, data = loaded(folder, case)
    assert "repeat_outlier" in identities(data, "dropped")
    i = data.features.index(Feature("TC1", "P01"))
    assert data.repeats[i] == 2 and data.values[i] == pytest.approx(
        truth("TC1", 4000.0, 90.0) + ZERO, abs=0.03
    )


def test_scatter_is_that_of_the_readings_that_are_kept(folder: Path, case) -> None:
    replaced(folder, "data.csv", f"{truth('TC1', 4000.0, 180.0) + 0.02:.4f}", "99.0")
    _, data = loaded(folder, case)
    assert "repeat_outlier" in identities(data, "dropped") and "scatter" not in identities(data)


def test_nothing_left_is_an_error(tmp_path: Path, case) -> None:
    folder = write_set(tmp_path / "zero", repeats=1)
    text = re.sub(r'uncertainty = "[^"]*"(?=\n(\[|orders|offset|$))', lambda m: m[0], HEAD)
    head, _, channels = text.partition("[channels.TC1]")
    channels = re.sub(r'\nuncertainty = "[\d.]+ ', '\nuncertainty = "0 ', channels)
    (folder / "measurement.toml").write_text(head + "[channels.TC1]" + channels, encoding="utf-8")
    with pytest.raises(MeasurementError, match="no usable reading is left") as caught:
        loaded(folder, case)
    assert caught.value.exit_code == 5


def test_points_run_alike_that_differ_are_suspects_unless_put_together_anew(folder: Path, case) -> None:
    lines = (folder / "data.csv").read_text(encoding="utf-8").splitlines()
    lines.append(lines[2].replace("P01", "P07").replace(f"{truth('P', 4000.0, 90.0) - 0.02:.4f}", "9000"))
    (folder / "data.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert "contradicting_points" in identities(loaded(folder, case)[1], "suspect")
    replaced(folder, "measurement.toml", "[settings.n]", "[points.P07]\nreassembled = true\n[settings.n]")
    assert "reassembly" in identities(loaded(folder, case)[1], "note")


def test_order_lines_follow_from_tooth_numbers() -> None:
    places = Places(load_case(CASES / "loop_hunting"))
    teeth = [gear.teeth for gear in places.case.gearboxes["test"].gears.values()]
    assert places.cycle == teeth[1] // np.gcd(*teeth)
    assert {0.0, 1.0, float(teeth[0]), teeth[0] / teeth[1]} <= set(places.orders)


def test_a_rounded_order_is_the_fraction_it_stands_for(case) -> None:
    places = Places(case)
    assert places.snapped(0.9706) == 33 / 34 and places.snapped(2.0) == 2.0
    assert places.snapped(0.4875) == 0.4875


def test_rounded_orders_of_a_table_are_found(folder: Path, case) -> None:
    replaced(folder, "measurement.toml", "[0, 1, 99]", "[0, 0.971, 99]")
    text = (folder / "orders.csv").read_text(encoding="utf-8").replace("M_wheel,1,", "M_wheel,0.9706,")
    (folder / "orders.csv").write_text(text, encoding="utf-8")
    _, data = loaded(folder, case)
    assert data.usable[data.features.index(Feature("M_wheel", "P01", 33 / 34, "real"))]
