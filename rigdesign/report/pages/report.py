"""report.html: one self-contained page in the order an engineer reads it."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rigdesign.base.version import __version__
from rigdesign.report import numbers, views
from rigdesign.report.figures.drawing import drawing_style, inline_svg
from rigdesign.report.sections import SECTIONS
from rigdesign.report.sections.section import Draw, ReportSection
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup
    from matplotlib.figure import Figure

TEMPLATES = Path(__file__).parents[1] / "templates"


@dataclass(frozen=True)
class _Rendered:
    """A numbered section with everything within it."""

    id: str
    title: str
    number: int
    body: "Markup"


def report_html(result: RunResult) -> str:
    """The whole report as one HTML document: no link, script, font or picture from elsewhere.

    Everything from the case is escaped. Two runs give the same text but for the timings.
    """
    with drawing_style():
        sections = _sections(result, _Figures())
    page = environment().get_template("report.html.j2")
    return page.render(result=result, tool_version=__version__, sections=sections)


def _sections(result: RunResult, draw: Draw) -> list[_Rendered]:
    """Every section that applies, numbered in their order, each followed by what stands within it."""
    from markupsafe import Markup

    shown = [section for section in SECTIONS if section.applies(result)]
    numbered = [section for section in shown if not section.within]
    number_of = {section.id: number for number, section in enumerate(numbered, start=1)}
    bodies = {section.id: _body(section, result, number_of, draw) for section in shown}
    return [
        _Rendered(
            section.id,
            section.title,
            number_of[section.id],
            bodies[section.id] + Markup("").join(bodies[s.id] for s in shown if s.within == section.id),
        )
        for section in numbered
    ]


@cache
def environment() -> "Environment":
    """Templates with escaping on and an error for every name that is missing."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    templates = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters.update(
        number=numbers.number_text,
        unit=numbers.unit_text,
        heading=numbers.heading_text,
        cell=numbers.cell_text,
        words=lambda text: str(text).replace("_", " "),
        signs=signs,
        symbol=symbol,
        check_families=views.check_families,
    )
    templates.globals.update(
        quantity=numbers.quantity_text,
        limit=numbers.limit_text,
        margin=numbers.margin_text,
        margin_unit=numbers.margin_unit,
        bar=views.bar_width,
        columns=views.columns,
        mesh_errors=views.mesh_errors,
        is_number=views.is_number,
        loss_table=views.loss_table,
        crossing_table=views.crossing_table,
    )
    return templates


class _Figures:
    """Turns figures into SVG and numbers them, so that ids stay unique on the page."""

    def __init__(self) -> None:
        self._count = 0

    def __call__(self, figure: "Figure", description: str) -> "Markup":
        from markupsafe import Markup

        self._count += 1
        return Markup(inline_svg(figure, f"f{self._count}", description))


def _body(section: ReportSection, result: RunResult, number_of: Mapping[str, int], draw: Draw) -> "Markup":
    """Text of a section, from its template."""
    from markupsafe import Markup

    text = (
        environment()
        .get_template(section.template)
        .render(
            result=result,
            tool_version=__version__,
            number_of=number_of,
            **section.values(result, draw),
        )
    )
    return Markup(text)


def signs(text: str) -> "Markup":
    """Escaped text in which K_V, f_z and the like carry a subscript."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"\b([KYfnσ])_([A-Z]|z)\b", r"\1<sub>\2</sub>", str(escape(text))))


def symbol(key: str) -> "Markup":
    """A factor of a standard by its printed symbol, index as subscript; words stay words."""
    from markupsafe import Markup

    head, index = numbers.symbol_parts(key)
    if len(head) > 2 or not index:
        return Markup("{}").format(numbers.heading_text(key))
    return Markup("{}<sub>{}</sub>").format(head, index)
