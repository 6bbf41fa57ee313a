"""report.html: one self-contained page in the order an engineer reads it, from the first page to the appendix."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from rigdesign.base.errors import without_layout
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.base.version import __version__
from rigdesign.report import numbers, palette, views
from rigdesign.report.figures.drawing import NumberedFigures, drawing_style
from rigdesign.report.input_sheets import Issue, signatures
from rigdesign.report.sections import SECTIONS
from rigdesign.report.sections.section import ReportSection
from rigdesign.results.quantity import row, value_in_unit
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

TEMPLATES = Path(__file__).parents[1] / "templates"


@dataclass(frozen=True)
class _Rendered:
    """A section with everything within it."""

    id: str
    title: str
    number: str
    body: "Markup"


@dataclass(frozen=True)
class _Page:
    """What every section is made of."""

    result: RunResult
    issue: Issue
    number_of: Mapping[str, str]


def report_html(result: RunResult, issue: Issue | None = None) -> str:
    """The whole report as one HTML document: no link, script, font or picture from elsewhere.

    Everything from the case is escaped. Two runs give the same text but for the timings and the date of issue, today
    unless ``issue`` says otherwise, which stands in the element ``issued`` and nowhere else.
    """
    shown = [section for section in SECTIONS if section.applies(result)]
    page = _Page(result, issue or Issue(), _numbers(shown))
    with drawing_style(), BackgroundTasks([partial(_body, section, page) for section in shown]) as tasks:
        bodies = dict(zip(shown, tasks.results(), strict=True))
    return (
        environment()
        .get_template("report.html.j2")
        .render(
            result=result,
            issue=page.issue,
            tool_version=__version__,
            running_title=running_title(result),
            first_page=_rendered(page, bodies, "first page"),
            body=_rendered(page, bodies, "body"),
            appendix=_rendered(page, bodies, "appendix"),
        )
    )


def running_title(result: RunResult) -> str:
    """What stands at the head of every printed page; the date stands opposite."""
    return f"{result.case['name']} – {result.verdict} – rigdesign {__version__} – {result.case['hash'][:12]}"


def _numbers(shown: Sequence[ReportSection]) -> dict[str, str]:
    """1, 2, … in the body, A, B, … in the appendix; parts of a section and the first page have none."""
    body = [section.id for section in shown if section.place == "body" and not section.within]
    appendix = [section.id for section in shown if section.place == "appendix" and not section.within]
    return {name: str(number) for number, name in enumerate(body, start=1)} | {
        name: chr(ord("A") + number) for number, name in enumerate(appendix)
    }


def _rendered(page: _Page, bodies: Mapping[ReportSection, "Markup"], place: str) -> list[_Rendered]:
    """The sections of one place in their order, each followed by what stands within it."""
    from markupsafe import Markup

    return [
        _Rendered(
            section.id,
            section.title,
            page.number_of.get(section.id, ""),
            body + Markup("").join(part for other, part in bodies.items() if other.within == section.id),
        )
        for section, body in bodies.items()
        if section.place == place and not section.within
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
        finalize=_shown,
    )
    templates.filters.update(
        number=numbers.number_text,
        unit=numbers.unit_text,
        percent=numbers.percent_text,
        heading=numbers.heading_text,
        cell=numbers.cell_text,
        row=row,
        unit_value=value_in_unit,
        words=lambda text: str(text).replace("_", " "),
        signs=signs,
        symbol=symbol,
        stated=lambda value: numbers.stated_text(str(value)),
        css_string=css_string,
    )
    templates.globals.update(
        quantity=numbers.quantity_text,
        quantities=numbers.quantity_texts,
        limit_change=numbers.limit_change_text,
        value=numbers.value_text,
        limit=numbers.limit_text,
        margin=numbers.margin_text,
        margin_unit=numbers.margin_unit,
        bar=views.bar_width,
        columns=views.columns,
        mesh_errors=views.mesh_errors,
        is_number=views.is_number,
        loss_table=views.loss_table,
        crossing_table=views.crossing_table,
        specific=views.specific,
        signatures=signatures,
        palette=palette,
    )
    return templates


def _shown(value: object) -> object:
    """What a template prints: in a text of others no mark turns the direction of the page."""
    from markupsafe import Markup

    if not isinstance(value, str):
        return value
    text = without_layout(value)
    return Markup(text) if isinstance(value, Markup) else text


def _body(section: ReportSection, page: _Page) -> "Markup":
    """Text of a section, from its template."""
    from markupsafe import Markup

    text = (
        environment()
        .get_template(section.template)
        .render(
            result=page.result,
            issue=page.issue,
            tool_version=__version__,
            number_of=page.number_of,
            **section.values(page.result, NumberedFigures(f"{section.id}-")),
        )
    )
    return Markup(text)


INDICES = {"Fbeta": "Fβ", "Falpha": "Fα", "deltarelT": "δ rel T", "RrelT": "R rel T"}
"""Indices of symbols as ISO 6336 prints them."""


def signs(text: str) -> "Markup":
    """Escaped text in which K_V, f_z and the like carry a subscript and units stand as printed."""
    from markupsafe import Markup, escape

    escaped = str(escape(numbers.text_with_units(text.replace("sigma_F", "σ_F"))))
    return Markup(
        re.sub(r"\b([KYfdσε])_([A-Z]{1,2}|[fzα]|Fbeta|Falpha|deltarelT|RrelT)\b", _subscript, escaped)
    )


def _subscript(found: re.Match[str]) -> str:
    return f"{found[1]}<sub>{INDICES.get(found[2], found[2])}</sub>"


def css_string(text: str) -> "Markup":
    """A string of a style sheet: everything but letters and digits as its code."""
    from markupsafe import Markup

    return Markup('"' + "".join(c if c.isalnum() and c.isascii() else f"\\{ord(c):06x}" for c in text) + '"')


def symbol(key: str) -> "Markup":
    """A factor of a standard by its printed symbol, index as subscript; words stay words."""
    from markupsafe import Markup

    head, index = numbers.symbol_parts(key)
    if len(head) > 2 or not index:
        return Markup("{}").format(numbers.heading_text(key))
    return Markup("{}<sub>{}</sub>").format(head, index)
