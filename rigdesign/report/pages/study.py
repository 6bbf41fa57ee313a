"""results.csv, study.svg and study.html of a parameter study."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.base.errors import UsageError
from rigdesign.base.json_text import csv_text
from rigdesign.base.output_folder import staged
from rigdesign.report.figures.drawing import drawing_style
from rigdesign.report.margins.passing_range import study_answer
from rigdesign.report.margins.table import MarginTable, margin_table
from rigdesign.report.numbers import margin_unit
from rigdesign.results.check import status
from rigdesign.studies.grid import Variation
from rigdesign.studies.result import StudyPoint, StudyResult, check_ids


def write_study(study: StudyResult, out: Path) -> None:
    """Write the three files whole; they depend on the points alone, so an interrupted study ends the same.

    Page and picture show the checks that the study is read for; the table holds all checks.

    Raises
    ------
    UsageError
        If a pattern on the checks matches no check; results.csv is written then, the others are not.
    OutputError
        If ``out`` cannot be written.
    """
    from rigdesign.report.pages.study_page import study_page, study_pictures

    table = study_csv(study.variations, study.points)
    try:
        answer = study_answer(study)
    except UsageError as error:
        with staged(out) as scratch:
            _write(scratch / "results.csv", table)
        raise UsageError(
            f"{error}; the points are kept in {out}, the same command with other patterns computes none of them again"
        ) from None
    with drawing_style():
        pictures = study_pictures(study, answer)
    with staged(out) as scratch:
        _write(scratch / "results.csv", table)
        if pictures.first is not None:
            svg = f'<?xml version="1.0" encoding="utf-8"?>\n{pictures.first.svg}\n'
            _write(scratch / "study.svg", svg)
        _write(scratch / "study.html", study_page(study, answer, pictures))


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


def study_csv(variations: Sequence[Variation], points: Sequence[StudyPoint]) -> str:
    """One row per point in the order of the design.

    Columns: varied values; status; verdict; first failing check (of the failing ones the farthest beyond its limit);
    highest temperature; value, margin, distance and verdict of every check (advisory: a missed limit that does not
    bind); smallest margin of every group of
    checks and the check it belongs to; error of a failed point.
    """
    checks = _all_checks(points)
    header = [variation.path for variation in variations]
    header += ["status", "verdict", "first_failing_check", "max_temperature [degC]"]
    for identity, unit in checks.items():
        header += [f"{identity} value [{unit}]", f"{identity} margin [{margin_unit(unit)}]"]
        header += [f"{identity} distance [1]"]
        header += [f"{identity} verdict"]
    table = margin_table(points, check_ids(points))
    groups = {group: table.of(columns) for group, columns in table.groups().items()}
    for group in groups:
        header += [f"{group}: smallest margin [%]", f"{group}: limiting check"]
    limits = list(zip(*map(_limits, groups.values()), strict=True)) or [()] * len(points)
    rows = (_row(point, checks, found) for point, found in zip(points, limits, strict=True))
    return csv_text([*header, "error"], rows)


def _all_checks(points: Sequence[StudyPoint]) -> dict[str, str]:
    """Id -> unit of every check that some point has, in the order of their appearance."""
    return {
        check["id"]: check["unit"] for point in points if not point.failed for check in point.record["checks"]
    }


def _limits(table: MarginTable) -> list[tuple[Any, Any]]:
    """Smallest margin [%] and id of its check at every point."""
    columns, margins = table.limiting()
    return [
        (float(f"{margin:.10g}"), table.checks[column].id) if column >= 0 else ("", "")
        for column, margin in zip(columns.tolist(), np.asarray(margins).tolist(), strict=True)
    ]


def _row(point: StudyPoint, checks: dict[str, str], limits: Sequence[tuple[Any, Any]]) -> list[Any]:
    row: list[Any] = list(point.values.values())
    if point.failed:
        empty = 3 + 4 * len(checks) + 2 * len(limits)
        return [*row, "failed", *[""] * empty, point.record["error"]]
    row += ["done", point.record["verdict"], first_failing(point), point.record["max_temperature_degC"]]
    by_id = {check["id"]: check for check in point.record["checks"]}
    for identity in checks:
        check = by_id.get(identity, {})
        row += [check.get(key) for key in ("value", "margin", "distance")]
        row.append(status(check["verdict"], check.get("flags", ())) if check else None)
    return [*row, *(cell for found in limits for cell in found), ""]


def first_failing(point: StudyPoint) -> str:
    """Id of the failing check that is farthest beyond its limit; empty when none that binds fails."""
    failing = [
        c for c in point.record.get("checks", ()) if status(c["verdict"], c.get("flags", ())) == "fail"
    ]
    worst = min(failing, key=lambda check: check["distance"] or 0.0, default=None)
    return "" if worst is None else str(worst["id"])
