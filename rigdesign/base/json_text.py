"""Records as JSON and tables as CSV: plain values with ten digits, the same bytes for the same numbers."""

import csv
import io
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from rigdesign.base.errors import one_line
from rigdesign.base.finite import finite

SIGNIFICANT_DIGITS = 10
"""Digits kept of every number: far beyond any model's accuracy, short of the last bits of round-off."""

FORMULA = ("=", "+", "-", "@")
"""What a spreadsheet takes for the beginning of a formula."""
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[\w°µ²³%/·.() ]*")
"""A number, with or without a unit."""
Row = Sequence[Any]


def to_text(document: Mapping[str, Any]) -> str:
    """JSON text with a final newline; keys keep their order."""
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def to_plain(value: Any, path: str = "") -> Any:
    """Turn records, arrays and numpy scalars into what JSON knows; numbers keep ten significant digits.

    Raises
    ------
    NonFiniteResultError
        If a number is NaN or infinite; names the key.
    TypeError
        If a value has no JSON form; names the key.
    """
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return _rounded(float(value), path)
    if isinstance(value, np.bool_):
        return bool(value)
    if is_dataclass(value) and not isinstance(value, type):
        return {
            item.name: to_plain(getattr(value, item.name), _join(path, item.name)) for item in fields(value)
        }
    if isinstance(value, Mapping):
        return {str(key): to_plain(item, _join(path, str(key))) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return to_plain(value.tolist(), path)
    if isinstance(value, Sequence):
        return [to_plain(item, f"{path}[{index}]") for index, item in enumerate(value)]
    raise TypeError(f"{path}: {type(value).__name__} has no JSON form")


def _rounded(value: float, path: str) -> float:
    return float(f"{finite(path, value):.{SIGNIFICANT_DIGITS}g}") + 0.0


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def csv_text(header: Row, rows: Iterable[Row]) -> str:
    """One table as CSV text; floats keep ten significant digits, None is an empty cell.

    A text that a spreadsheet would run as a formula stands behind an apostrophe; every cell is one line.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerows([_cell(value) for value in row] for row in (header, *rows))
    return buffer.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, float):
        return f"{value:.{SIGNIFICANT_DIGITS}g}"
    if not isinstance(value, str):
        return value
    text = one_line(value)
    return f"'{text}" if text.startswith(FORMULA) and not NUMBER.fullmatch(text) else text
