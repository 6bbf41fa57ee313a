"""diff.json and diff.html: two results of a check against each other."""

from pathlib import Path

from rigdesign.base.json_text import to_plain, to_text
from rigdesign.base.output_folder import staged
from rigdesign.base.version import __version__
from rigdesign.report.figures.drawing import NumberedFigures, drawing_style
from rigdesign.studies.difference import ResultsDifference, difference_document, headline


def write_difference(difference: ResultsDifference, out: Path) -> None:
    """Write both files, each whole or not at all.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    """
    page = difference_page(difference)
    with staged(out) as scratch:
        (scratch / "diff.html").write_text(page, encoding="utf-8", newline="\n")
        text = to_text(to_plain(difference_document(difference)))
        (scratch / "diff.json").write_text(text, encoding="utf-8", newline="\n")


def difference_page(difference: ResultsDifference) -> str:
    """The page as one self-contained HTML document."""
    from rigdesign.report.figures.difference import LEAST_CHANGE, MOST_ROWS, margins_figure
    from rigdesign.report.pages.report import environment

    with drawing_style():
        figure = margins_figure(difference.checks)
        text = "Margins of the checks before and after"
        svg = None if figure is None else NumberedFigures()(figure, text)
    return (
        environment()
        .get_template("difference.html.j2")
        .render(
            difference=difference,
            headline=headline(difference),
            worse=any(row.worse for row in difference.checks),
            failing=difference.checks_that("newly failing"),
            figure=svg,
            most_rows=MOST_ROWS,
            least_change=LEAST_CHANGE,
            applicability=difference.checks_that("now applicable", "no longer applicable"),
            moved=difference.checks_that("moved"),
            single=difference.checks_that("added", "removed"),
            tool_version=__version__,
        )
    )
