"""Records as JSON and tables as CSV: ten digits, of curves six, the same bytes for the same numbers."""

import csv
import io
import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite
from typing import Any

import numpy as np

from rigdesign.base.errors import NonFiniteResultError, one_line

SIGNIFICANT_DIGITS = 10
"""Digits kept of every number: far beyond any model's accuracy, short of the last bits of round-off."""
CURVE, CURVE_DIGITS = 16, 6
"""Numbers of a list from which it is a curve, and the digits that each of them keeps in JSON."""

FORMULA = ("=", "+", "-", "@")
"""What a spreadsheet takes for the beginning of a formula."""
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[\w°µ²³%/·.() ]*")
"""A number, with or without a unit."""
Row = Sequence[Any]


def to_text(document: Mapping[str, Any]) -> str:
    """JSON text without indentation, with a final newline; keys keep their order."""
    return json.dumps(document, separators=(",", ":"), ensure_ascii=False, allow_nan=False) + "\n"


def to_plain(value: Any, path: str = "") -> Any:
    """Turn records, arrays and numpy scalars into what JSON knows; numbers keep ten significant digits, of curves six.

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
        if len(value) >= CURVE and all(isinstance(item, float) for item in value):
            return [_rounded(item, f"{path}[{index}]", CURVE_DIGITS) for index, item in enumerate(value)]
        return [to_plain(item, f"{path}[{index}]") for index, item in enumerate(value)]
    raise TypeError(f"{path}: {type(value).__name__} has no JSON form")


def _rounded(value: float, path: str, digits: int = SIGNIFICANT_DIGITS) -> float:
    return float(f"{finite(path, value):.{digits}g}") + 0.0


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def csv_text(header: Row, rows: Iterable[Row]) -> str:
    """One table as CSV text; floats keep ten significant digits, None is an empty cell.

    A text that a spreadsheet would run as a formula stands behind an apostrophe; every cell is one line.
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerows([csv_cell(value) for value in row] for row in (header, *rows))
    return buffer.getvalue()


def csv_cell(value: Any) -> Any:
    """A value as it stands in a cell: floats with ten significant digits, texts in one line and never a formula."""
    if isinstance(value, float):
        return f"{value:.{SIGNIFICANT_DIGITS}g}"
    if not isinstance(value, str):
        return value
    text = one_line(value)
    return f"'{text}" if text.startswith(FORMULA) and not NUMBER.fullmatch(text) else text


# The one place that says what happens to a number that is none: the run fails, and names where it stood.
#
# NaN passes every comparison in silence and the maximum of a list may skip it, so that a verdict built on one is
# worthless. Values of checks, the state of the coupling loop after every iteration and every record of a result are
# held against this; the command ends with the exit status of an iteration without a solution.


def finite(path: str, value: float) -> float:
    """``value``, if it is a number.

    Raises
    ------
    NonFiniteResultError
        NaN or infinite; names ``path``.
    """
    if isfinite(value):
        return value
    raise _error(path, value)


def require_finite(record: Any, path: str = "") -> None:
    """Check every number of a record: dataclasses, mappings, sequences and arrays, however deep.

    Raises
    ------
    NonFiniteResultError
        The first number that is NaN or infinite; names its path, that of the record in front.
    """
    for place, value in _not_finite(record, path):
        raise _error(place, value)


def _error(path: str, value: complex) -> NonFiniteResultError:
    return NonFiniteResultError(
        f"{path} = {value}: results hold finite numbers only; a quantity that does not exist is None. An input at the "
        "edge of its range may cause it: move it inwards; report the case as a defect if it does not"
    )


def _not_finite(value: Any, path: str) -> Iterator[tuple[str, complex]]:
    """Path and value of every number that is NaN or infinite."""
    if isinstance(value, float | complex | np.inexact):
        if not np.isfinite(value):
            yield path, value.item() if isinstance(value, np.inexact) else value
    elif isinstance(value, np.ndarray):
        if value.dtype.kind in "fc" and not np.isfinite(value).all():
            place = np.argwhere(~np.isfinite(value))[0]
            yield f"{path}[{', '.join(map(str, place))}]", value[tuple(place)].item()
    elif is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            yield from _not_finite(getattr(value, item.name), _join(path, item.name))
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from _not_finite(item, _join(path, str(key)))
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        for index, item in enumerate(value):
            yield from _not_finite(item, f"{path}[{index}]")
