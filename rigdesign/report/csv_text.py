"""A table as CSV text."""

import csv
import io
from collections.abc import Iterable, Sequence
from typing import Any

from rigdesign.base.json_text import SIGNIFICANT_DIGITS

Row = Sequence[Any]


def csv_text(header: Row, rows: Iterable[Row]) -> str:
    """One table as CSV text; floats keep ten significant digits, None is an empty cell."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([_cell(value) for value in row] for row in rows)
    return buffer.getvalue()


def _cell(value: Any) -> Any:
    return f"{value:.{SIGNIFICANT_DIGITS}g}" if isinstance(value, float) else value
