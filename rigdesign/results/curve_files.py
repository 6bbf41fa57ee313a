"""What stands in the files of curves is named in results.json, not repeated.

A list of values that is a column of a file, or some rows of one, is written as

    {"file": "curves/ramp.csv", "column": "time [s]"}          whole column
    {..., "rows": [120, 240]}                                   rows from 120 up to 240
    {..., "rows": [0, 840], "width": 12}                        cut into lists of 12
    {"file": ..., "columns": ["first", "last"]}                 a list for each row over these columns and those between

and a list of records of which every number stands so as {"columns": {key: list}}.
"""

import csv
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from rigdesign.base.errors import UsageError
from rigdesign.base.json_text import csv_cell
from rigdesign.results.curves import Columns

FOLDER = "curves"
LEAST = 16
"""Values from which a list is a curve."""
Json = Any
Cell = tuple[str, str, int]
"""File, column and row."""


PLACE: Json = {
    "description": "Where the values stand in a file of curves, or the columns of a list of records.",
    "type": "object",
    "properties": {
        "file": {"type": "string"},
        "column": {"type": "string"},
        "columns": {},
        "rows": {"type": "array", "items": {"type": "integer"}},
        "width": {"type": "integer"},
    },
    "required": [],
    "additionalProperties": False,
}
"""JSON Schema of what stands for a list."""


def with_references(document: Json, curves: Mapping[str, Columns]) -> Json:
    """The document with every list that stands in a file as its place there; numbers as in ``curves``."""
    return _Places(curves).named(document)


class _Places:
    """Where values stand."""

    def __init__(self, curves: Mapping[str, Columns]) -> None:
        self.curves = curves
        self.starts: dict[tuple[Any, Any], list[Cell]] = {}
        """Cells by their value and the one below; of cells that agree with the one above none."""
        for file, table in curves.items():
            for column, values in table.items():
                before = None
                for row, pair in enumerate(pairwise(values)):
                    if pair != before:
                        self.starts.setdefault(pair, []).append((file, column, row))
                    before = pair

    def named(self, value: Json) -> Json:
        """The value with places for what stands in files."""
        if isinstance(value, dict):
            return {key: self.named(item) for key, item in value.items()}
        if not isinstance(value, list):
            return value
        place = None
        if len(value) >= LEAST:
            of_records, of_lists = isinstance(value[0], dict), isinstance(value[0], list)
            place = (self._records if of_records else self._matrix if of_lists else self._curve)(value)
        return [self.named(item) for item in value] if place is None else place

    def _curve(self, values: list[Any]) -> Json | None:
        """A list of single values."""
        for cell in self._cells(values):
            if self._stands(values, *cell):
                return self._place(*cell, len(values))
        return None

    def _cells(self, values: list[Any]) -> Sequence[Cell]:
        if any(isinstance(item, list | dict) for item in values[:2]):
            return ()
        return self.starts.get((values[0], values[1]), ())

    def _stands(self, values: list[Any], file: str, column: str, row: int) -> bool:
        """Whether values stand from a cell down, and are read again as what they are."""
        known = self.curves[file][column]
        if known[row : row + len(values)] != values:
            return False
        if all(isinstance(item, float) for item in values):
            return True
        cells = ["" if item is None else str(csv_cell(item)) for item in known]
        return [type(item) for item in _read(cells)[row : row + len(values)]] == [
            type(item) for item in values
        ]

    def _place(self, file: str, column: str, row: int, count: int) -> Json:
        whole = count == len(self.curves[file][column])
        rows = {} if whole else {"rows": [row, row + count]}
        return {"file": f"{FOLDER}/{file}.csv", "column": column, **rows}

    def _matrix(self, values: list[Any]) -> Json | None:
        """Lists of one length: one after the other in a column, or a row each of neighbouring columns."""
        width = len(values[0])
        if width < 2 or any(not isinstance(item, list) or len(item) != width for item in values):
            return None
        flat = [each for item in values for each in item]
        place = self._curve(flat)
        if place is not None:
            return {"rows": [0, len(flat)], **place, "width": width}
        turned = [list(item) for item in zip(*values, strict=True)]
        for file, column, row in self._cells(turned[0]):
            names = list(self.curves[file])
            between = names[names.index(column) :][:width]
            if row == 0 and [self.curves[file][name] for name in between] == turned:
                return {"file": f"{FOLDER}/{file}.csv", "columns": [between[0], between[-1]]}
        return None

    def _records(self, values: list[Any]) -> Json | None:
        """Records of one kind whose numbers all stand beside each other."""
        if any(not isinstance(item, dict) or item.keys() != values[0].keys() for item in values):
            return None
        columns = {key: [item[key] for item in values] for key in values[0]}
        numbers = {
            key: column for key, column in columns.items() if any(isinstance(item, float) for item in column)
        }
        for file, _, row in self._cells(next(iter(numbers.values()), [[]])):
            beside = {key: self._beside(column, file, row) for key, column in columns.items()}
            if all(beside[key] is not None for key in numbers):
                return {
                    "columns": {
                        key: columns[key] if place is None else place for key, place in beside.items()
                    }
                }
        return None

    def _beside(self, values: list[Any], file: str, row: int) -> Json | None:
        """The column of a file that has values from a row on; None where none has."""
        for column in self.curves[file]:
            if self._stands(values, file, column, row):
                return self._place(file, column, row, len(values))
        return None


def without_references(document: Json, folder: Path) -> Json:
    """The document with the values of the files beside it.

    Raises
    ------
    UsageError
        A file is not there, or has not what the document names.
    """
    return _Files(folder).filled(document)


class _Files:
    """Files of curves of one result, each read once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.tables: dict[str, Columns] = {}

    def filled(self, value: Json) -> Json:
        """The value with what stands in files."""
        if isinstance(value, list):
            return [self.filled(item) for item in value]
        if not isinstance(value, dict):
            return value
        if value.keys() >= {"file", "column"} or value.keys() >= {"file", "columns"}:
            return self._values(value)
        if value.keys() == {"columns"}:
            columns = {key: self.filled(item) for key, item in value["columns"].items()}
            return [dict(zip(columns, items, strict=True)) for items in zip(*columns.values(), strict=True)]
        return {key: self.filled(item) for key, item in value.items()}

    def _values(self, place: Mapping[str, Any]) -> Json:
        path = self.folder / place["file"]
        if place["file"] not in self.tables:
            self.tables[place["file"]] = _table(path)
        table = self.tables[place["file"]]
        try:
            if "columns" in place:
                names = list(table)
                first, last = (names.index(name) for name in place["columns"])
                between = names[first : last + 1]
                return [list(item) for item in zip(*(table[name] for name in between), strict=True)]
            values = table[place["column"]]
        except (KeyError, ValueError):
            raise UsageError(f"{path}: has not the columns that results.json names; {TOGETHER}") from None
        first, last = place.get("rows", [0, len(values)])
        if last > len(values):
            raise UsageError(f"{path}: ends before row {last}, which results.json names; {TOGETHER}")
        values, width = values[first:last], place.get("width")
        return values if width is None else [values[i : i + width] for i in range(0, len(values), width)]


TOGETHER = "curves of a result stand in files beside it: keep its folder together"


def _table(path: Path) -> Columns:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {getattr(error, 'strerror', None) or 'is damaged'}; {TOGETHER}") from None
    return dict(zip(header, map(_read, _turned(rows, len(header))), strict=True))


def _turned(rows: Sequence[Sequence[str]], count: int) -> Iterator[Sequence[str]]:
    return zip(*rows, strict=True) if rows else iter([()] * count)


def _read(cells: Sequence[str]) -> list[Any]:
    """Numbers, truth values or texts; an empty cell between numbers is None."""
    try:
        return [float(cell) if cell else None for cell in cells]
    except ValueError:
        truth = {"True": True, "False": False}
        return [truth[cell] for cell in cells] if set(cells) <= truth.keys() else list(cells)
