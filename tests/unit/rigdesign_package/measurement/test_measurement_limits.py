"""What a measurement set may hold: readings that can be, whole files of its own folder, columns in any number."""

import os
import time
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.cli.exit_status import exit_status
from rigdesign.measurement import Data, DataFinding, features, load_measurement
from rigdesign.measurement.reading import hdf5_samples
from rigdesign.prediction import Feature
from tests.builders.measurement import changed_column, replaced, truth, write_set
from tests.builders.paths import CASES
from tests.builders.recording import signals, write_recorded_set, write_recording

ZERO = 273.15


@pytest.fixture(scope="module")
def case():
    return load_case(CASES / "uhcf_prototype")


@pytest.fixture(scope="module")
def loop():
    return load_case(CASES / "loop_1to1")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_set(tmp_path / "set")


def data_of(folder: Path, case) -> Data:
    return features(load_measurement(folder, case))


def found(data: Data, identity: str) -> list[DataFinding]:
    return [finding for finding in data.findings if finding.id == identity]


def refused(folder: Path, case) -> str:
    """The words of the refusal; it ends with exit status 5."""
    assert exit_status(lambda: load_measurement(folder, case)) == 5
    with pytest.raises(MeasurementError) as caught:
        load_measurement(folder, case)
    return str(caught.value)


def cell(folder: Path, line: int, name: str, text: str) -> str:
    """Write a cell of data.csv; what it held before."""
    rows = [row.split(",") for row in (folder / "data.csv").read_text(encoding="utf-8").splitlines()]
    place = rows[0].index(name)
    before, rows[line - 1][place] = rows[line - 1][place], text
    (folder / "data.csv").write_text("\n".join(",".join(row) for row in rows) + "\n", encoding="utf-8")
    return before


# Readings


@pytest.mark.parametrize(
    ("name", "value"), [("TC1", "-300"), ("P", "2e12"), ("M_wheel", "-1e9"), ("f1", "-3")]
)
def test_a_reading_that_cannot_be_is_left_out_and_told(folder: Path, case, name: str, value: str) -> None:
    line = 15 if name == "f1" else 5
    cell(folder, line, name, value)
    data = data_of(folder, case)
    (finding,) = found(data, "impossible_reading")
    assert finding.weight == "dropped" and f'data.csv line {line}, {name} = "{value}"' in finding.text
    if name == "TC1":
        i = data.features.index(Feature("TC1", "P02"))
        assert data.repeats[i] == 1
        assert data.values[i] == pytest.approx(truth("TC1", 4000.0, 180.0) + ZERO, abs=0.03)


def test_one_impossible_reading_leaves_the_noise_of_the_others(folder: Path, case) -> None:
    before = data_of(folder, case)
    cell(folder, 5, "TC1", "-300")
    after = data_of(folder, case)
    i = before.features.index(Feature("TC1", "P05"))
    assert after.noise[i] == pytest.approx(before.noise[i], rel=0.1)


@pytest.mark.parametrize("value", ["1e9", "-4000", "0"])
def test_a_speed_that_cannot_be_leaves_its_point_out(folder: Path, case, value: str) -> None:
    cell(folder, 5, "n", value)
    if value == "0":
        cell(folder, 6, "n", value)
    data = data_of(folder, case)
    (finding,) = found(data, "unknown_setting")
    assert finding.points == ("P02",) and "P02" not in {setting.name for setting in data.settings}
    assert ("zero" if value == "0" else f'data.csv line 5, n = "{value}"') in finding.text


def test_two_repeats_far_apart_are_not_used_and_spoil_no_noise(folder: Path, case) -> None:
    """Which of the two is wrong the data do not say; a median of repeats would hide it."""
    before = data_of(folder, case)
    cell(folder, 5, "TC1", "20.0")
    after = data_of(folder, case)
    (finding,) = found(after, "repeat_outlier")
    assert finding.points == ("P02",) and "neither is used" in finding.text
    assert not after.usable[after.features.index(Feature("TC1", "P02"))]
    i = before.features.index(Feature("TC1", "P05"))
    assert after.noise[i] == pytest.approx(before.noise[i], rel=0.1)


def test_two_repeats_of_one_point_are_suspected(tmp_path: Path, loop) -> None:
    folder = write_recorded_set(tmp_path / "set", "tdms")
    spoilt = signals(2)
    spoilt["T_out"] = spoilt["T_out"] + 9.0
    write_recording(folder / "P01_2.tdms", spoilt)
    data = data_of(folder, loop)
    assert found(data, "repeats_apart")[0].channels == ("T_out",)
    assert data.usable[data.features.index(Feature("T_out", "P01"))]


@pytest.mark.parametrize("text", ["2_871", "٢٨٧١", "inf", "0x1F", "1e400", "２"])
def test_a_cell_that_is_no_plain_number_is_refused(folder: Path, case, text: str) -> None:
    cell(folder, 6, "P", text)
    words = refused(folder, case)
    assert "data.csv line 6, P" in words and text in words


def test_repeats_and_places_are_plain_numbers(folder: Path, case) -> None:
    replaced(folder, "data.csv", "P03,2,", f"P03,{'9' * 5000},")
    replaced(folder, "data.csv", "P04,2,", "P04,٢,")
    replaced(folder, "measurement.toml", 'place = "1"', 'place = "١"')
    words = refused(folder, case)
    assert words.count("not a whole number") == 2 and "channels.f1.place" in words


def test_an_order_that_cannot_be_is_left_out_and_told(folder: Path, case) -> None:
    text = (folder / "orders.csv").read_text(encoding="utf-8").splitlines()
    cells = text[3].split(",")
    text[3] = ",".join([*cells[:4], "-1e300", cells[5]])
    (folder / "orders.csv").write_text("\n".join(text) + "\n", encoding="utf-8")
    (finding,) = found(data_of(folder, case), "impossible_reading")
    assert "orders.csv line 4, real = -1e+300" in finding.text


@pytest.mark.parametrize(("key", "old"), [("uncertainty", "5 W"), ("offset_uncertainty", "0.5 K")])
@pytest.mark.parametrize(("size", "words"), [("1e300", "is more than"), ("1e-300", "is smaller than")])
def test_an_uncertainty_no_instrument_has_is_refused(folder: Path, case, key, old, size, words) -> None:
    replaced(folder, "measurement.toml", f'"{old}"', f'"{size} {old[-1]}"')
    text = refused(folder, case)
    assert f".{key}" in text and words in text


# Samples of recordings


def spoilt(change: Callable[[np.ndarray], None], name: str) -> dict[str, np.ndarray]:
    recorded = signals()
    change(recorded[name])
    return recorded


def at_700(value: float) -> Callable[[np.ndarray], None]:
    def change(values: np.ndarray) -> None:
        values[700] = value

    return change


@pytest.mark.parametrize("kind", ["tdms", "h5"])
@pytest.mark.parametrize(
    ("name", "value", "identity"),
    [
        ("T_out", np.inf, "impossible_reading"),
        ("T_out", -300.0, "impossible_reading"),
        ("M_wheel", 1e300, "impossible_reading"),
        ("M_wheel", 5e6, "spike"),
    ],
)
def test_a_sample_that_cannot_be_is_left_out_and_told(
    tmp_path: Path, loop, kind: str, name: str, value: float, identity: str
) -> None:
    folder = write_recorded_set(tmp_path / "set", kind)
    clean = data_of(folder, loop)
    write_recording(folder / f"P01_1.{kind}", spoilt(at_700(value), name))
    data = data_of(folder, loop)
    (finding,) = found(data, identity)
    assert f"P01_1.{kind}: {name}: sample 701 (at 0.7 s) = {value:g}" in finding.text
    i = data.features.index(Feature(name, "P01"))
    assert data.values[i] == pytest.approx(clean.values[i], abs=2e-2)


# Whole files


@pytest.mark.parametrize("share", [1 / 3, 0.9, 0.999])
@pytest.mark.parametrize("kind", ["tdms", "h5", "csv"])
def test_a_recording_that_was_cut_is_refused(tmp_path: Path, loop, kind: str, share: float) -> None:
    folder = write_recorded_set(tmp_path / "set", kind)
    path = folder / f"P01_1.{kind}"
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    assert path.name in refused(folder, loop)


def test_a_tdms_file_says_how_many_samples_are_missing(tmp_path: Path, loop) -> None:
    folder = write_recorded_set(tmp_path / "set", "tdms")
    path = folder / "P01_1.tdms"
    path.write_bytes(path.read_bytes()[:-8000])
    assert "'T_out' 2000 of 3000" in refused(folder, loop)


def test_a_table_cut_inside_its_last_number_is_told(folder: Path, case) -> None:
    path = folder / "data.csv"
    cell(folder, 15, "f1", "510.25")
    path.write_bytes(path.read_bytes()[:-4])
    data = data_of(folder, case)
    (finding,) = found(data, "cut_file")
    assert 'data.csv line 15, f1 = "510"' in finding.text and finding.weight == "dropped"
    assert not data.usable[data.features.index(Feature("f1", ""))]


def test_an_order_cut_inside_its_last_number_is_told(folder: Path, case) -> None:
    path = folder / "orders.csv"
    path.write_bytes(path.read_bytes()[:-3])
    (finding,) = found(data_of(folder, case), "cut_file")
    assert "orders.csv line 25, imaginary = " in finding.text


def test_orders_missing_at_some_repeats_are_told(folder: Path, case) -> None:
    path = folder / "orders.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join(lines[:-1]) + "\n", encoding="utf-8")
    (finding,) = found(data_of(folder, case), "missing_order")
    assert "lacks 2 numbers" in finding.text and finding.points == ("P06",)


def test_a_recording_shorter_than_its_repeats_is_suspected(tmp_path: Path, loop) -> None:
    folder = write_recorded_set(tmp_path / "set", "csv")
    lines = (folder / "P01_2.csv").read_text(encoding="utf-8").splitlines()
    (folder / "P01_2.csv").write_text("\n".join(lines[:1000]) + "\n", encoding="utf-8")
    (finding,) = found(data_of(folder, loop), "shorter_recording")
    assert "P01_2.csv" in finding.text and "0.997 s" in finding.text


def test_a_quotation_mark_that_is_never_closed_is_refused(folder: Path, case) -> None:
    cell(folder, 5, "TC1", '"68.0')
    assert "data.csv line 5" in refused(folder, case)


# Headers that say what cannot be


def h5_set(folder: Path, change: Callable[[h5py.File], None]) -> Path:
    write_recorded_set(folder, "h5")
    with h5py.File(folder / "P01_1.h5", "r+") as file:
        change(file)
    return folder


def huge_shape(file: h5py.File) -> None:
    del file["T_out"]
    file.create_dataset("T_out", shape=(10**12,), chunks=(1000,), dtype="f8")


def never_written(file: h5py.File) -> None:
    values = file["T_out"][:]
    del file["T_out"]
    file.create_dataset("T_out", shape=(3000,), chunks=(500,), dtype="f8")[:1000] = values[:1000]


def elsewhere(file: h5py.File) -> None:
    del file["T_out"]
    file.create_dataset("T_out", shape=(3000,), dtype="f8", external=[("/dev/zero", 0, 24000)])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda file: file.attrs.__setitem__("sample_rate", 0.0), "sample_rate = 0"),
        (lambda file: file.attrs.__setitem__("sample_rate", np.nan), "sample_rate = nan"),
        (lambda file: file.attrs.__setitem__("sample_rate", "fast"), 'sample_rate = "fast" is no number'),
        (huge_shape, "samples, data.size_limit"),
        (never_written, "holds 1000 samples, its shape states 3000"),
        (elsewhere, "lie in another file"),
    ],
)
def test_a_header_that_cannot_be_is_refused_with_file_and_place(
    tmp_path: Path, loop, change, words: str
) -> None:
    text = refused(h5_set(tmp_path / "set", change), loop)
    assert "P01_1.h5" in text and words in text


@pytest.mark.parametrize(
    ("script", "words"),
    [
        (
            "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)",
            "the HDF5 library crashed on it, signal 11",
        ),
        ("import time; time.sleep(60)", "cannot be read within 2 s"),
        ("import sys; sys.exit('wrong chunk')", "wrong chunk"),
    ],
)
def test_a_file_that_crashes_the_hdf5_library_is_refused(
    tmp_path: Path, loop, monkeypatch, script, words
) -> None:
    """A flipped bit of an attribute's header does: the library reads in a process of its own."""
    folder = write_recorded_set(tmp_path / "set", "h5")
    (tmp_path / "script.py").write_text(script, encoding="utf-8")
    monkeypatch.setattr(hdf5_samples, "__file__", str(tmp_path / "script.py"))
    monkeypatch.setattr(hdf5_samples, "PATIENCE", 2.0)
    text = refused(folder, loop)
    assert "P01_1.h5" in text and words in text


def test_garbage_is_refused_whatever_it_is_called(tmp_path: Path, loop) -> None:
    rng = np.random.default_rng(3)
    for kind, head in (("tdms", b"TDSm"), ("h5", b"\x89HDF\r\n\x1a\n"), ("csv", b"time,T_out\n")):
        folder = write_recorded_set(tmp_path / kind, kind)
        for _ in range(10):
            (folder / f"P01_1.{kind}").write_bytes(head + rng.bytes(400))
            assert f"P01_1.{kind}" in refused(folder, loop)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("schema_version = 1", f"schema_version = {'1' * 5000}"),
        ('title = "trial"', 'title = "trial"\nbaseline = "a\\u0000b"'),
        ('title = "trial"', f'title = "trial"\nbaseline = "{"x" * 5000}"'),
        ("orders = [0, 1, 99]", "orders = [0, inf]"),
    ],
)
def test_a_document_that_cannot_be_is_refused(folder: Path, case, old: str, new: str) -> None:
    replaced(folder, "measurement.toml", old, new)
    assert "measurement.toml" in refused(folder, case)


# Files of the folder alone


OUTSIDE = [
    "../other.csv",
    "/etc/passwd",
    "/dev/full",
    "/dev/zero",
    "linked.csv",
    "a\\u0000b.csv",
    "sub",
    "pipe.csv",
]


@pytest.mark.parametrize("name", OUTSIDE)
@pytest.mark.parametrize("key", ["table", "orders", "recording"])
def test_files_outside_the_folder_and_devices_are_refused(folder: Path, case, key: str, name: str) -> None:
    (folder.parent / "other.csv").write_bytes((folder / "data.csv").read_bytes())
    (folder / "linked.csv").symlink_to("../other.csv")
    (folder / "sub").mkdir()
    os.mkfifo(folder / "pipe.csv")
    if key == "recording":
        new = '[data]\ntach = { kind = "pulses", signal = "T" }\n'
        new += f'recordings = [{{ point = "P01", file = "{name}" }}]\n'
        replaced(folder, "measurement.toml", "[data]", new)
    elif key == "table":
        replaced(folder, "measurement.toml", "[data]", f'[data]\ntable = "{name}"')
    else:
        replaced(folder, "measurement.toml", 'orders = "orders.csv"', f'orders = "{name}"')
    words = refused(folder, case)
    said = ("outside the folder", "not a regular file", "control character", "unknown kind of file")
    assert name in words and any(one in words for one in said)


def test_a_link_within_the_folder_is_followed(folder: Path, case) -> None:
    (folder / "raw").mkdir()
    (folder / "data.csv").rename(folder / "raw" / "data.csv")
    (folder / "data.csv").symlink_to("raw/data.csv")
    assert data_of(folder, case).usable.all()


def test_a_large_file_is_refused_until_the_limit_is_raised(folder: Path, case) -> None:
    with (folder / "data.csv").open("ab") as file:
        file.write(b"\n" * 300_000)
    replaced(folder, "measurement.toml", "[data]", '[data]\nsize_limit = "200 kB"')
    words = refused(folder, case)
    assert "data.csv" in words and "data.size_limit is 0.2 MB" in words and 'size_limit = "0.361 MB"' in words
    replaced(folder, "measurement.toml", '"200 kB"', '"0.361 MB"')
    assert data_of(folder, case).usable.all()


def test_a_file_without_end_is_refused_at_once(folder: Path, case) -> None:
    """A sparse file of 1 TB: nothing of it is read."""
    with (folder / "data.csv").open("r+b") as file:
        file.truncate(10**12)
    started = time.perf_counter()
    assert "data.size_limit is 200 MB" in refused(folder, case)
    assert time.perf_counter() - started < 10.0


# Columns in any number


def wide_set(folder: Path, count: int, described: int) -> Path:
    """``count`` columns of temperatures, of which the first ones are described."""
    folder.mkdir()
    names = [f"T{i}" for i in range(count)]
    rows = [["point", "repeat", "n", "M", *names], ["", "", "rpm", "N m", *["degC"] * count]]
    for point in range(3):
        for repeat in (1, 2):
            readings = [f"{60 + 5 * point + 0.01 * repeat + 1e-4 * i:.4f}" for i in range(count)]
            rows.append([f"P{point}", str(repeat), str(4000 + 1000 * point), "100", *readings])
    (folder / "data.csv").write_text("\n".join(",".join(row) for row in rows) + "\n", encoding="utf-8")
    text = 'schema_version = 1\ntitle = "wide"\n'
    text += '[settings.n]\nquantity = "speed"\nunit = "rpm"\nuncertainty = "1 rpm"\n'
    text += '[settings.M]\nquantity = "torque"\nunit = "N m"\nuncertainty = "0.5 N m"\n'
    for name in names[:described]:
        text += f'[channels.{name}]\nquantity = "temperature"\nplace = "test.outer_warm"\nunit = "degC"\n'
        text += 'uncertainty = "0.1 K"\n'
    (folder / "measurement.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.parametrize(("small", "described"), [(4000, 4), (250, 250)])
def test_columns_take_time_in_proportion(tmp_path: Path, case, small: int, described: int) -> None:
    """Four times the columns: at most 7 times the processor time; in quadratic time it would be 16 times."""
    times = []
    for factor in (1, 4):
        more = factor if described == small else 1
        folder = wide_set(tmp_path / f"x{factor}", factor * small, more * described)
        spent = []
        for _ in range(3):
            started = time.process_time()
            data_of(folder, case)
            spent.append(time.process_time() - started)
        times.append(min(spent))
    assert times[1] < 7.0 * times[0]


def test_exchanged_digits_of_a_whole_column_stay_a_matter_of_units(folder: Path, case) -> None:
    """Kelvin under degC lie within the limits: the set goes on and the unit is suspected, as before."""
    changed_column(folder, "TC1", lambda value: value + ZERO)
    data = data_of(folder, case)
    assert found(data, "unit") and not found(data, "impossible_reading")
