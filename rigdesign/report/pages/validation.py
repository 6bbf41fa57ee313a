"""validation.json, validation.csv and validation.html: published numbers against ours."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rigdesign.base.output_folder import staged
from rigdesign.base.version import __version__
from rigdesign.report.figures.drawing import NumberedFigures, drawing_style
from rigdesign.validation import ValidationRow, headline, validation_csv, validation_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ORDER = ("gate missed", "goal missed", "gate held", "goal met", "shown", "not modelled")
"""Verdicts from top to bottom of the table."""
COLOURS = {"gate missed": "fail", "goal missed": "advisory", "gate held": "pass", "goal met": "pass"}
"""Verdict of a row -> verdict whose colour it has; others are grey."""
MOST_SOURCES = 12
"""Sources with a plot of their own."""
LEAST_ROWS = 2
"""Numbers that a source needs for a plot."""


def write_validation(rows: Sequence[ValidationRow], out: Path) -> None:
    """Write the three files to ``out``, whole or not at all.

    Raises
    ------
    OutputError
        If the folder cannot be made or written.
    """
    page = validation_page(rows)
    with staged(out) as scratch:
        for name, text in (
            ("validation.json", validation_json(rows)),
            ("validation.csv", validation_csv(rows)),
            ("validation.html", page),
        ):
            (scratch / name).write_text(text, encoding="utf-8", newline="\n")


def validation_page(rows: Sequence[ValidationRow]) -> str:
    """The page as one self-contained HTML document; what misses its limit comes first."""
    from rigdesign.report.figures.validation import deviation_figure, share_of_tolerance
    from rigdesign.report.pages.report import environment

    draw = NumberedFigures()
    with drawing_style():
        deviations, sources = deviation_figure(rows), _source_figures(rows)
        main = None if deviations is None else draw(deviations, "Deviation over what is allowed")
        drawn = [draw(figure, text) for text, figure in sources]
    notes = list(dict.fromkeys(row.assumptions for row in rows if row.assumptions))
    shares = {row.id: share_of_tolerance(row) for row in rows}

    def place(row: ValidationRow) -> tuple[int, float]:
        return ORDER.index(row.verdict), -abs(shares[row.id] or 0.0)

    return (
        environment()
        .get_template("validation.html.j2")
        .render(
            rows=sorted(rows, key=place),
            missed=[row for row in sorted(rows, key=place) if row.verdict.endswith("missed")],
            count=headline(rows),
            deviations=main,
            sources=drawn,
            shares=shares,
            colours=COLOURS,
            notes={text: number for number, text in enumerate(notes, start=1)},
            infinity=math.inf,
            tool_version=__version__,
        )
    )


def source_name(row: ValidationRow) -> str:
    """The document a number comes from, without table or figure: ``P2, Table 2`` is of P2."""
    return row.source.partition(",")[0].partition(":")[0].strip() or "no source"


def _source_figures(rows: Sequence[ValidationRow]) -> "list[tuple[str, Figure]]":
    """A plot for every document with several numbers, the one with most first, and one for all others."""
    from rigdesign.report.figures.validation import published_number, source_figure

    found: dict[str, list[ValidationRow]] = {}
    for row in rows:
        if row.computed is not None and published_number(row) is not None:
            found.setdefault(source_name(row), []).append(row)
    ordered = sorted(found, key=lambda name: -len(found[name]))
    own = [name for name in ordered if len(found[name]) >= LEAST_ROWS][:MOST_SOURCES]
    groups = {name: found[name] for name in own}
    others = [row for name in ordered if name not in groups for row in found[name]]
    if others:
        groups["other documents"] = others
    figures = ((name, source_figure(name, chosen)) for name, chosen in groups.items())
    return [
        (f"Computed over published numbers, {name}", figure) for name, figure in figures if figure is not None
    ]
