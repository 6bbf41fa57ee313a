"""results.parquet and results.xlsx of a study against results.csv."""

import csv
import sys

import pytest

from rigdesign.base.errors import MissingLibraryError, UsageError
from rigdesign.report import study_tables
from rigdesign.report.pages.study import write_study
from rigdesign.report.study_tables import require_table_libraries, write_tables
from rigdesign.studies.design import StudyDesign
from tests.builders.study import InProcess, run_study
from tests.builders.study_functions import CURVES, curves

VARY = ("oil.inlet=121:124:1 degC", "gear.teeth=30,40", "oil.name=FVA 3,=1+1")


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Written twice, so that what depends on the time would show; a point of four has no result."""
    folders = []
    for name in ("one", "two"):
        out = tmp_path_factory.mktemp(name)

        def write(study, out):
            write_tables(study, out, ["parquet", "xlsx"])
            write_study(study, out)

        run_study(CURVES, StudyDesign(vary=VARY), out, write=write, run=curves, executor=InProcess())
        folders.append(out)
    return folders


@pytest.fixture(scope="module")
def rows(tables):
    with (tables[0] / "results.csv").open(encoding="utf-8", newline="") as table:
        return list(csv.reader(table))


def expected(heading, cells):
    """Name, unit and values of a column of results.csv."""
    if heading in ("oil.inlet", "gear.teeth"):
        return heading, "degC" if heading == "oil.inlet" else "1", [float(cell.split()[0]) for cell in cells]
    if heading.endswith("]"):
        name, _, unit = heading[:-1].rpartition(" [")
        return name, unit, [float(cell) if cell else None for cell in cells]
    return heading, None, [cell or None for cell in cells]


def test_parquet_holds_the_numbers_of_the_csv_with_their_units(tables, rows):
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(tables[0] / "results.parquet")
    columns = [
        expected(heading, cells) for heading, cells in zip(rows[0], zip(*rows[1:], strict=True), strict=True)
    ]
    assert table.column_names == [name for name, _, _ in columns]
    for field, column, (_, unit, values) in zip(table.schema, table.columns, columns, strict=True):
        assert column.to_pylist() == values
        assert (field.metadata or {}).get(b"unit") == (None if unit is None else unit.encode())
    assert table.num_rows == 16
    assert table.schema.metadata[b"case_hash"] == CURVES.hash.encode()
    assert b"16 points" in table.schema.metadata[b"method"]


def test_xlsx_holds_numbers_as_numbers_below_names_and_units(tables, rows):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook(tables[0] / "results.xlsx")
    sheet = book["points"]
    columns = [
        expected(heading, cells) for heading, cells in zip(rows[0], zip(*rows[1:], strict=True), strict=True)
    ]
    assert sheet.freeze_panes == "B3"
    for found, (name, unit, values) in zip(sheet.columns, columns, strict=True):
        assert [found[0].value, found[1].value] == [name, unit]
        assert [cell.value for cell in found[2:]] == values
        assert all(cell.data_type == "n" for cell in found[2:] if cell.value is not None and unit)
        assert all(cell.data_type != "f" for cell in found)
    assert dict(book["study"].values)["case"] == "numbers"


def test_the_parquet_of_the_same_points_is_the_same(tables):
    assert (tables[0] / "results.parquet").read_bytes() == (tables[1] / "results.parquet").read_bytes()


@pytest.mark.parametrize(("name", "library"), [("parquet", "pyarrow"), ("xlsx", "openpyxl")])
def test_a_library_that_is_missing_is_named_before_the_start(name, library, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(
        MissingLibraryError, match=rf"needs {library}; run: pip install 'rigdesign\[{name}\]'"
    ):
        require_table_libraries([name])


def test_more_points_than_a_sheet_holds_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(study_tables, "XLSX_ROWS", 4)
    result = run_study(CURVES, "oil.inlet=80:90:1 degC", tmp_path, run=curves, executor=InProcess()).result
    with pytest.raises(UsageError, match=r"11 points .* take --table parquet"):
        write_tables(result, tmp_path, ["xlsx"])
    assert not (tmp_path / "results.xlsx").exists()
