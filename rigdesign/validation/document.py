"""The rows as a document and as files."""

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from rigdesign import __version__
from rigdesign.report.output import staged
from rigdesign.validation.rows import ValidationRow

SCHEMA_VERSION = 1


def headline(rows: Sequence[ValidationRow]) -> dict[str, int]:
    """Counts: predicted rows that have a goal or gate and those that meet it, gates, rows without a model."""
    judged = [
        row for row in rows if row.basis == "predicted" and row.verdict not in ("shown", "not modelled")
    ]
    verdicts = [row.verdict for row in rows]
    return {
        "rows": len(rows),
        "predicted_with_goal": len(judged),
        "predicted_met": sum(row.verdict in ("gate held", "goal met") for row in judged),
        "gates_held": verdicts.count("gate held"),
        "gates_missed": verdicts.count("gate missed"),
        "not_modelled": verdicts.count("not modelled"),
    }


def validation_document(rows: Sequence[ValidationRow]) -> dict[str, Any]:
    """The JSON document of `rigdesign validate --json`; open ends of a window are null."""
    return {
        "schema_version": SCHEMA_VERSION,
        "tool_version": __version__,
        "headline": headline(rows),
        "rows": [_plain(row) for row in rows],
    }


def write_validation(rows: Sequence[ValidationRow], out: Path) -> None:
    """Write validation.json and validation.csv to ``out``, whole or not at all.

    Raises OutputError if the folder cannot be made or written.
    """
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    names = [field.name for field in fields(ValidationRow) if field.name not in ("published", "window")]
    writer.writerow(names)
    writer.writerows([_cell(getattr(row, name)) for name in names] for row in rows)
    document = json.dumps(validation_document(rows), indent=2, ensure_ascii=False, allow_nan=False)
    with staged(out) as scratch:
        (scratch / "validation.json").write_text(document + "\n", encoding="utf-8", newline="\n")
        (scratch / "validation.csv").write_text(table.getvalue(), encoding="utf-8", newline="\n")


def _plain(row: ValidationRow) -> dict[str, Any]:
    return {field.name: _json(getattr(row, field.name)) for field in fields(ValidationRow)}


def _json(value: object) -> object:
    if isinstance(value, tuple):
        return [_json(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _cell(value: object) -> object:
    return "" if value is None else value
