"""results.parquet and results.xlsx: the table of results.csv, its numbers as numbers with their units."""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from rigdesign.base.errors import CONTROL, MissingLibraryError, UsageError
from rigdesign.base.output_folder import staged
from rigdesign.base.version import __version__
from rigdesign.report.pages.study import study_csv
from rigdesign.studies.grid import Variation
from rigdesign.studies.result import StudyResult

if TYPE_CHECKING:
    from openpyxl import Workbook

TableFormat = Literal["parquet", "xlsx"]
LIBRARIES: dict[TableFormat, str] = {"parquet": "pyarrow", "xlsx": "openpyxl"}
HEADING = re.compile(r"(.+) \[([^\[\]]*)\]")
"""Heading of a column of numbers: name and unit."""
NO_UNIT = "1"
"""Unit of a number without one."""
XLSX_ROWS, XLSX_COLUMNS = 1_048_576, 16_384
"""Most rows and columns of a sheet."""
WIDTHS = (10, 40)
"""Least and greatest width of a column of a sheet [characters]."""


@dataclass(frozen=True)
class Column:
    """A column of the table of a study.

    unit : of the numbers in it; None where it holds texts
    values : one a point; None where it has none
    """

    name: str
    unit: str | None
    values: Sequence[float | str | None]


def table_columns(text: str) -> list[Column]:
    """The columns of results.csv; one whose heading ends in a unit holds numbers."""
    heading, *rows = csv.reader(io.StringIO(text))
    cells = list(zip(*rows, strict=True)) or [()] * len(heading)
    return [_column(name, values) for name, values in zip(heading, cells, strict=True)]


def _column(heading: str, cells: Sequence[str]) -> Column:
    found = HEADING.fullmatch(heading)
    if found is None:
        return Column(heading, None, [cell or None for cell in cells])
    return Column(found[1], found[2], [float(cell) if cell else None for cell in cells])


def with_numbers(columns: Iterable[Column], variations: Sequence[Variation]) -> list[Column]:
    """The columns with varied values as numbers, where all of one input have the same unit."""
    varied = {variation.path for variation in variations}
    found = []
    for column in columns:
        texts = tuple(str(value) for value in column.values)
        numbers = Variation(column.name, texts).numbers() if column.name in varied else None
        found.append(Column(column.name, numbers[1] or NO_UNIT, numbers[0]) if numbers else column)
    return found


def require_table_libraries(formats: Iterable[TableFormat]) -> None:
    """Raise MissingLibraryError for a format whose library is not installed, before anything is computed."""
    for name in formats:
        library = LIBRARIES[name]
        if find_spec(library) is None:
            raise MissingLibraryError(f"--table {name} needs {library}; run: pip install 'rigdesign[{name}]'")


def write_tables(study: StudyResult, out: Path, formats: Sequence[TableFormat]) -> None:
    """Write results.parquet or results.xlsx, whole; they depend on the points alone.

    Raises
    ------
    MissingLibraryError
        If the library of a format is not installed.
    UsageError
        If there are more rows or columns than a sheet holds.
    OutputError
        If ``out`` cannot be written.
    """
    if not formats:
        return
    require_table_libraries(formats)
    table = table_columns(study_csv(study.variations, study.points))
    columns = with_numbers(table, study.variations)
    writers = {"parquet": _write_parquet, "xlsx": _write_xlsx}
    with staged(out) as scratch:
        for name in dict.fromkeys(formats):
            writers[name](columns, study, scratch / f"results.{name}")


def _write_parquet(columns: Sequence[Column], study: StudyResult, path: Path) -> None:
    import pyarrow
    from pyarrow import parquet

    fields = []
    for column in columns:
        kind = pyarrow.string() if column.unit is None else pyarrow.float64()
        metadata = {} if column.unit is None else {"unit": column.unit}
        fields.append(pyarrow.field(column.name, kind, metadata=metadata))
    arrays = [pyarrow.array(column.values, field.type) for column, field in zip(columns, fields, strict=True)]
    schema = pyarrow.schema(fields, metadata=_origin(study))
    parquet.write_table(pyarrow.Table.from_arrays(arrays, schema=schema), path)


def _origin(study: StudyResult) -> dict[str, str]:
    """What the numbers are of."""
    return {
        "case": study.case.name,
        "case_hash": study.case.hash,
        "tool_version": __version__,
        "fidelity": study.fidelity,
        "method": study.method,
    }


def _write_xlsx(columns: Sequence[Column], study: StudyResult, path: Path) -> None:
    """A sheet with the points, names and units above them, and one that says what they are of."""
    from openpyxl import Workbook

    rows = len(study.points)
    if rows + 2 > XLSX_ROWS or len(columns) > XLSX_COLUMNS:
        raise UsageError(
            f"--table xlsx: {rows} points and {len(columns)} columns, a sheet holds {XLSX_ROWS - 2} and "
            f"{XLSX_COLUMNS}; take --table parquet"
        )
    book = Workbook()
    _fill_points(book, columns)
    about = book.create_sheet("study")
    for key, value in {**_origin(study), **_ranges(study)}.items():
        about.append([key, value])
    about.column_dimensions["A"].width = about.column_dimensions["B"].width = WIDTHS[1]
    book.properties.creator = f"rigdesign {__version__}"
    book.properties.created = book.properties.modified = datetime(2000, 1, 1)
    book.save(path)


def _fill_points(book: "Workbook", columns: Sequence[Column]) -> None:
    from openpyxl.styles import Alignment, Font
    from openpyxl.utils import get_column_letter

    sheet = book.active
    sheet.title = "points"
    sheet.append([column.name for column in columns])
    sheet.append([column.unit or "" for column in columns])
    for row in zip(*(column.values for column in columns), strict=True):
        sheet.append([_cell(value) for value in row])
        for cell in sheet[sheet.max_row]:
            if cell.data_type == "f":
                cell.data_type = "s"  # a text that begins like a formula
    for number, column in enumerate(columns, 1):
        sheet.cell(1, number).font = Font(bold=True)
        sheet.cell(1, number).alignment = Alignment(wrap_text=True, vertical="top")
        sheet.cell(2, number).font = Font(italic=True)
        widest = max((len(str(value)) for value in column.values if isinstance(value, str)), default=0)
        sheet.column_dimensions[get_column_letter(number)].width = min(max(widest, WIDTHS[0]), WIDTHS[1])
    sheet.freeze_panes = "B3"


def _cell(value: float | str | None) -> float | str | None:
    """A value without the control characters that a sheet cannot hold."""
    return CONTROL.sub("", value) if isinstance(value, str) else value


def _ranges(study: StudyResult) -> dict[str, str]:
    return {
        variation.path: f"{' to '.join(variation.values)}, {variation.distribution}"
        for variation in study.variations
        if variation.distribution
    }
