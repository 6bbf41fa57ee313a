"""results.csv, study.svg and study.html of a parameter study."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rigdesign.base.output_folder import staged
from rigdesign.base.version import __version__
from rigdesign.report.csv_text import csv_text
from rigdesign.report.figures.drawing import drawing_style, inline_svg
from rigdesign.report.numbers import margin_unit
from rigdesign.studies.grid import Variation
from rigdesign.studies.result import StudyPoint, StudyResult


def write_study(study: StudyResult, out: Path) -> None:
    """Write the three files whole; they depend on the points alone, so an interrupted study ends the same.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    """
    from rigdesign.report.figures.study import study_figure

    variations, points = study.variations, study.points
    with drawing_style():
        figure = study_figure(variations, points)
        svg = None if figure is None else inline_svg(figure, "study", "Margins over the varied input")
    with staged(out) as scratch:
        (scratch / "results.csv").write_text(study_csv(variations, points), encoding="utf-8", newline="\n")
        if svg is not None:
            document = f'<?xml version="1.0" encoding="utf-8"?>\n{svg}\n'
            (scratch / "study.svg").write_text(document, encoding="utf-8", newline="\n")
        page = _page(study, svg)
        (scratch / "study.html").write_text(page, encoding="utf-8", newline="\n")


def study_csv(variations: Sequence[Variation], points: Sequence[StudyPoint]) -> str:
    """One row per point in the order of the grid.

    Columns: varied values; status; verdict; first failing check (of the failing ones the most used-up);
    highest temperature; value, margin, utilisation and verdict of every check; error of a failed point.
    """
    checks = _all_checks(points)
    header = [variation.path for variation in variations]
    header += ["status", "verdict", "first_failing_check", "max_temperature [degC]"]
    for identity, unit in checks.items():
        header += [f"{identity} value [{unit}]", f"{identity} margin [{margin_unit(unit)}]"]
        header += [f"{identity} utilisation [1]"]
        header += [f"{identity} verdict"]
    return csv_text([*header, "error"], (_row(point, checks) for point in points))


def _all_checks(points: Sequence[StudyPoint]) -> dict[str, str]:
    """Id -> unit of every check that some point has, in the order of their appearance."""
    return {
        check["id"]: check["unit"] for point in points if not point.failed for check in point.record["checks"]
    }


def _row(point: "StudyPoint", checks: dict[str, str]) -> list[Any]:
    row: list[Any] = list(point.values.values())
    if point.failed:
        return [*row, "failed", *[""] * (3 + 4 * len(checks)), point.record["error"]]
    row += ["done", point.record["verdict"], first_failing(point), point.record["max_temperature_degC"]]
    by_id = {check["id"]: check for check in point.record["checks"]}
    for identity in checks:
        check = by_id.get(identity, {})
        row += [check.get(key) for key in ("value", "margin", "utilisation", "verdict")]
    return [*row, ""]


def first_failing(point: "StudyPoint") -> str:
    """Id of the failing check with the highest utilisation; empty when none fails."""
    failing = [check for check in point.record.get("checks", ()) if check["verdict"] == "fail"]
    worst = max(failing, key=lambda check: check["utilisation"] or 0.0, default=None)
    return "" if worst is None else str(worst["id"])


def _page(study: StudyResult, svg: str | None) -> str:
    from markupsafe import Markup

    from rigdesign.report.pages.report import environment

    picture: Markup | None = None if svg is None else Markup(svg)
    return (
        environment()
        .get_template("study.html.j2")
        .render(
            case=study.case,
            paths=[variation.path for variation in study.variations],
            points=study.points,
            fidelity=study.fidelity,
            figure=picture,
            first_failing=first_failing,
            tool_version=__version__,
        )
    )
