"""Tables on disk: names in the first row, units in the second, numbers below; decimal points or commas."""

import csv
import hashlib
import io
import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.errors import Fault, MeasurementError
from rigdesign.base.files import RefusedFileError, check_regular, foreign, read_regular
from rigdesign.case.faults import written
from rigdesign.measurement.reading.measurement_set import DataSection

MISSING = frozenset(("", "nan", "n/a", "na", "-", "--", "#n/a"))
"""Cells that say that there is no reading."""
NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
"""What a cell with a number looks like: no other digits, no grouping, no infinity."""
SEPARATOR = re.compile(r'"?sep=(.)"?[,;\s]*', re.I)
"""First line of a file by which a spreadsheet says what parts the columns."""
STAMP = re.compile(
    r"(?:(\d{4})-(\d\d)-(\d\d)[T ]|(\d\d?)\.(\d\d?)\.(\d{4}) )?(\d\d?):(\d\d):(\d\d)(?:[.,](\d{1,6})\d*)?Z?"
)
"""Date, as 2026-03-04 or 4.3.2026 and optional, and time of day."""
MOST_FAULTS = 20
"""Cells of one table that are complained of one by one."""


@dataclass(frozen=True)
class Table:
    """A table as text.

    names, units : one per column; units are empty texts where the file has none
    rows : cells, each row as long as ``names``
    lines : line of the file of each row, from 1
    cut : how the file ends within its last row, and what of it was left out; empty for a whole file
    """

    file: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]
    cut: str = ""

    @cached_property
    def places(self) -> Mapping[str, int]:
        """Column of each name, from 0."""
        return {name: place for place, name in enumerate(self.names)}

    def column(self, name: str) -> tuple[str, ...]:
        """Cells of a column; KeyError when there is none."""
        place = self.places[name]
        return tuple(row[place] for row in self.rows)

    def unit(self, name: str) -> str:
        """Unit above a column; KeyError when there is none."""
        return self.units[self.places[name]]


def read_table(folder: Path, name: str, data: DataSection, *, with_units: bool) -> Table:
    """Read a table of the set.

    Parameters
    ----------
    with_units : whether a second row with units must be there; else one is taken where it holds no number

    Raises
    ------
    MeasurementError
        The file is missing, empty, not text, no file of the set (`set_file`), has columns without or of the
        same name, or rows of other length.
    """
    text = _text(set_file(folder, name, data.size_limit), name, data)
    rows = _cells(text, name, data)
    if len(rows) < 2:
        raise refused(name, "holds no readings", "write names, units and at least one row")
    _drop_empty_ends(rows)
    names = tuple(cell.strip() for cell in rows[0][1])
    faults = _names(name, names, data)
    units, body = ("",) * len(names), rows[1:]
    has_units = not any(_is_number(cell, data.decimal) for cell in body[0][1])
    if has_units:
        units = tuple(cell.strip() for cell in body[0][1])
        units, body = units + ("",) * (len(names) - len(units)), body[1:]
    elif with_units:
        faults.append(
            Fault(f"{name} line 2", written(", ".join(body[0][1])), "a row of units is missing below the names",
                  "write the unit of every column there, nothing below point and repeat")
        )  # fmt: skip
    cut = ""
    if body and len(body[-1][1]) < len(names):
        (line, cells), body = body[-1], body[:-1]
        cut = f"line {line}: the file ends after {len(cells)} of {len(names)} cells of this row, which is left out"
    elif body and not text.endswith(("\n", "\r")) and len(body[-1][1]) == len(names):
        line, cells = body[-1]
        cut = f"line {line}, {names[-1]} = {written(cells[-1])}: the file ends without a line end; the cell may be cut "
        cut += "and is left out"
        cells[-1] = ""
    wrong = [(line, len(cells)) for line, cells in body if len(cells) != len(names)]
    if len(wrong) == len(body) > 1 and len({count for _, count in wrong}) == 1:
        faults = [
            Fault(f"{name} line {rows[0][0]}", written(data.delimiter.join(rows[0][1])),
                  f"has {len(names)} cells, every row below {wrong[0][1]}",
                  "the first line has to name the columns; remove what stands above them")
        ]  # fmt: skip
        wrong = []
    for line, count in wrong:
        faults.append(
            Fault(f"{name} line {line}", "", f"has {count} cells, the names are {len(names)}",
                  "correct the row; an empty cell is a missing reading")
        )  # fmt: skip
    if not body and not faults:
        faults.append(Fault(name, "", "holds no complete row of readings", "write at least one row"))
    if faults:
        raise MeasurementError(faults[:MOST_FAULTS])
    return Table(
        name, names, units, tuple(tuple(cells) for _, cells in body), tuple(line for line, _ in body), cut
    )


def number(cell: str, decimal: str) -> float:
    """The number of a cell, NaN for a missing one; ValueError for anything else."""
    text = cell.strip()
    if text.lower() in MISSING:
        return math.nan
    if decimal == "," and "." in text:
        raise ValueError("a point in a file with decimal commas")
    if decimal == "." and "," in text:
        raise ValueError("a comma in a file with decimal points")
    plain = text.replace(",", ".").replace("\u2212", "-")
    if not NUMBER.fullmatch(plain):
        raise ValueError("not a number")
    value = float(plain)
    if not math.isfinite(value):
        raise ValueError("not finite")
    return value


def numbers(table: Table, name: str, decimal: str) -> tuple[list[float], list[Fault]]:
    """A column as numbers, NaN where missing; a fault names the first cell that is none and counts the others."""
    values: list[float] = []
    wrong: list[tuple[int, str, str]] = []
    for line, cell in zip(table.lines, table.column(name)):
        try:
            values.append(number(cell, decimal))
        except ValueError as error:
            values.append(math.nan)
            wrong.append((line, cell, str(error)))
    if not wrong:
        return values, []
    line, cell, reason = wrong[0]
    more = f", and {len(wrong) - 1} more cells below" if len(wrong) > 1 else ""
    remedy = f'write a number (data.decimal = "{decimal}") or leave the cell empty'
    return values, [Fault(f"{table.file} line {line}, {name}", written(cell), reason + more, remedy)]


def time_stamp(text: str) -> "np.datetime64 | None":
    """The time stamp of a cell, on some day where it has no date; None for any other text."""
    match = STAMP.fullmatch(text.strip())
    if match is None:
        return None
    year, month, day, day_de, month_de, year_de, *clock, fraction = match.groups()
    date = f"{year or year_de or 2000}-{month or month_de or 1:0>2}-{day or day_de or 1:0>2}"
    try:
        return np.datetime64(f"{date}T{clock[0]:0>2}:{':'.join(clock[1:])}.{fraction or 0:0<6}", "us")
    except ValueError:
        return None


def time_stamps(cells: Sequence[str]) -> "NDArray[np.datetime64] | None":
    """(n,) time stamps of a column, NaT where missing; None where a cell is something else, or none is one."""
    parsed = [
        np.datetime64("NaT", "us") if cell.strip().lower() in MISSING else time_stamp(cell) for cell in cells
    ]
    stamps = np.array([stamp for stamp in parsed if stamp is not None], dtype="datetime64[us]")
    return stamps if len(stamps) == len(parsed) and not np.isnat(stamps).all() else None


def _text(path: Path, name: str, data: DataSection) -> str:
    encoding = "utf-8-sig" if data.encoding == "utf-8" else data.encoding
    try:
        content = path.read_bytes()
        if (kind := foreign(content)) is not None:
            raise refused(name, f"is {kind}, not a table of text", "export the sheet as CSV")
        text = content.decode(encoding)
    except OSError as error:
        raise refused(name, f"cannot be read: {error.strerror}", "check its rights") from None
    except UnicodeError:
        raise refused(
            name, f"is not {data.encoding} text", 'save it so, or write data.encoding = "cp1252"'
        ) from None
    if "\0" in text:
        raise refused(name, "holds bytes that are no text", "save it as CSV text")
    return text


def _cells(text: str, name: str, data: DataSection) -> list[tuple[int, list[str]]]:
    """Rows that hold something and are no comment, each with the line it begins in."""
    first, _, _ = text.partition("\n")
    if match := SEPARATOR.fullmatch(first):
        if match[1] != data.delimiter:
            raise refused(
                f"{name} line 1", f'says that "{match[1]}" parts the columns, data.delimiter is "{data.delimiter}"',
                "correct the key",
            )  # fmt: skip
        text = text[len(first) :]
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=data.delimiter, strict=True)
    lines: list[tuple[int, list[str]]] = []
    line = 1
    try:
        for cells in rows:
            if any(cell.strip() for cell in cells):
                lines.append((line, cells))
            line = rows.line_num + 1
    except csv.Error as error:
        raise refused(f"{name} line {line}", f"cannot be read: {error}", "correct it") from None
    return [(line, cells) for line, cells in lines if not _is_comment(cells)]


def _is_comment(cells: Sequence[str]) -> bool:
    """Whether a row is a line of text behind a #."""
    return cells[0].lstrip().startswith("#") and not any(cell.strip() for cell in cells[1:])


def _drop_empty_ends(rows: Sequence[tuple[int, list[str]]]) -> None:
    """Take away what a delimiter at the end of all rows leaves: cells without a name that hold nothing."""
    count = max((i for i, cell in enumerate(rows[0][1], start=1) if cell.strip()), default=0)
    readings = [cells for _, cells in rows[2:]] or [rows[1][1]]
    widths = {len(cells) for cells in readings[:-1]} | ({len(rows[0][1])} if len(readings) == 1 else set())
    if (
        len(widths) > 1
        or max(widths) <= count
        or any(cell.strip() for _, row in rows for cell in row[count:])
    ):
        return
    for _, cells in rows:
        del cells[count:]


def _names(file: str, names: Sequence[str], data: DataSection) -> list[Fault]:
    faults = [
        Fault(f"{file} line 1", "", f"column {number} has no name", "name it or remove it")
        for number, name in enumerate(names, start=1)
        if not name
    ]
    faults += [
        Fault(f"{file} line 1", written(name), "two columns have this name", "give each its own name")
        for name, count in Counter(names).items()
        if name and count > 1
    ]
    if len(names) == 1:
        other = next(
            (delimiter for delimiter in ";,\t" if delimiter in names[0]),
            ";" if data.delimiter == "," else ",",
        )
        faults.append(
            Fault(f"{file} line 1", written(names[0]), "only one column was found",
                  f'write data.delimiter = "{other}" if that parts the columns')
        )  # fmt: skip
    return faults


def _is_number(cell: str, decimal: str) -> bool:
    try:
        return not math.isnan(number(cell, decimal))
    except ValueError:
        return False


# Files that a measurement set names: inside its folder, regular, no larger than the set allows.

LARGEST_DOCUMENT = 16_000_000
"""Most bytes of measurement.toml itself."""


def set_file(folder: Path, name: str, limit: float) -> Path:
    """Path of a file of the set, links followed.

    Parameters
    ----------
    folder : of the set
    name : as measurement.toml has it
    limit : most bytes, ``data.size_limit``

    Raises
    ------
    MeasurementError
        No name of a file, no such file, one outside the folder, no regular file (a folder, device or pipe), too large.
    """
    try:
        home, path = folder.resolve(), (folder / name).resolve()
        if not path.is_relative_to(home):
            raise refused(
                name,
                f"leads to {path}, outside the folder of the set",
                "put the file itself into that folder",
            )
        check_regular(path, limit)
    except FileNotFoundError:
        raise refused(name, "no such file", "correct the name in [data] or add the file") from None
    except RefusedFileError as error:
        if error.size is None:
            raise refused(name, f"is {error.strerror}", "give a regular file") from None
        raise refused(
            name,
            f"has {_shown(error.size)}, data.size_limit is {_shown(limit)}",
            f'if that is meant, write size_limit = "{_shown(1.2 * error.size)}" under [data]',
        ) from None
    except (OSError, RuntimeError) as error:
        raise refused(name, f"cannot be followed: {error}", "correct the name or the link") from None
    return path


def document_text(file: Path) -> str:
    """Text of measurement.toml; MeasurementError where it cannot be read, is too large or no UTF-8."""
    try:
        return read_regular(file, LARGEST_DOCUMENT).decode("utf-8-sig")
    except RefusedFileError as error:
        raise MeasurementError(f"is {error.strerror}; readings belong into tables", str(file)) from None
    except OSError as error:
        raise MeasurementError(
            f"cannot be read: {error.strerror}; check the path and its rights", str(file)
        ) from None
    except UnicodeDecodeError as error:
        raise MeasurementError(
            f"is not UTF-8 text (byte {error.start}); save it as UTF-8", str(file)
        ) from None


def digest_of(file: Path, others: Iterable[Path]) -> str:
    """SHA-256 over measurement.toml and the files it names."""
    digest = hashlib.sha256(file.read_bytes())
    for path in dict.fromkeys(others):
        with path.open("rb") as stream:
            digest.update(hashlib.file_digest(stream, "sha256").digest())
    return digest.hexdigest()


def refused(path: str, problem: str, remedy: str) -> MeasurementError:
    """The error of a file, or of a place in it, that cannot be used."""
    return MeasurementError([Fault(path, "", problem, remedy)])


def _shown(size: float) -> str:
    return units.show(size, "data_size", digits=3)
