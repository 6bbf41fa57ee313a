"""compare.json and compare.html of a comparison of measured with simulated numbers."""

from pathlib import Path
from typing import Any

from rigdesign.base.json_text import to_text
from rigdesign.base.output_folder import staged
from rigdesign.base.version import __version__
from rigdesign.measurement.comparison.compare import Comparison, comparison_document, headline, significant
from rigdesign.report.figures.drawing import NumberedFigures, drawing_style

GROUPS_DRAWN = 6
"""Groups whose residuals are drawn over their leading variable."""


def write_comparison(comparison: Comparison, out: Path, *, model: str, fidelity: str) -> None:
    """Write compare.json and compare.html, each whole or not at all.

    Raises
    ------
    OutputError
        If ``out`` cannot be written.
    """
    document = comparison_document(comparison, model=model, fidelity=fidelity)
    page = comparison_page(comparison, document)
    with staged(out) as scratch:
        (scratch / "compare.html").write_text(page, encoding="utf-8", newline="\n")
        (scratch / "compare.json").write_text(to_text(document), encoding="utf-8", newline="\n")


def comparison_page(comparison: Comparison, document: dict[str, Any]) -> str:
    """The page as one self-contained HTML document."""
    from rigdesign.report.figures import measurement as figures
    from rigdesign.report.pages.report import environment

    draw = NumberedFigures()
    with drawing_style():
        leading = []
        for item in [item for item in comparison.located if significant(item)][:GROUPS_DRAWN]:
            figure = figures.leading_figure(comparison, item)
            if figure is not None:
                leading.append(draw(figure, f"Residual of {item.group}"))
        context = {
            "case": comparison.measurement.case,
            "measurement": comparison.measurement,
            "data": comparison.data,
            "document": document,
            "headline": headline(comparison),
            "agrees": not comparison.sentences,
            "healthy": comparison.healthy,
            "readings": draw(
                figures.readings_figure(comparison), "Measured and simulated over the operating points"
            ),
            "agreement": draw(figures.agreement_figure(comparison), "Measured over simulated numbers"),
            "map": draw(figures.residual_map(comparison), "Residuals by channel and operating point"),
            "leading": leading,
            "tool_version": __version__,
        }
    return environment().get_template("compare.html.j2").render(context)
