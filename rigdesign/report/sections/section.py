"""What a section of the report is; one colour and line style a gearbox, the same in every figure of a report."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from rigdesign.report.palette import CurveStyle, gearbox_colours
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure


Draw = Callable[["Figure", str], "Markup"]
"""Figure and its description for those who cannot see it -> SVG for the page."""
Values = dict[str, Any]
"""Name in the template -> what stands there."""
Place = Literal["first page", "body", "appendix"]
"""The first page is read alone and signed, the body is for the meeting, the appendix for the question behind it."""


def _always(result: RunResult) -> bool:
    return True


def _nothing(result: RunResult, draw: Draw) -> Values:
    return {}


@dataclass(frozen=True, kw_only=True)
class ReportSection:
    """One section: its entry in the contents, its template, and what the template shows in addition to the result.

    id : anchor on the page; title : heading and entry in the contents, empty for a part of another section
    template : of ``templates``; it is given ``result``, ``tool_version``, ``number_of`` (id -> number) and ``values``
    values : picks and draws; applies : whether the section is on the page at all
    place : sections of the body are numbered, those of the appendix lettered
    within : id of the section it closes; empty for a section of its own
    """

    id: str
    template: str
    title: str = ""
    values: Callable[[RunResult, Draw], Values] = _nothing
    applies: Callable[[RunResult], bool] = _always
    place: Place = "body"
    within: str = ""


def gearbox_styles(result: RunResult) -> dict[str, CurveStyle]:
    """Style of every gearbox of the rig, whichever of them a figure shows."""
    turning = result.dynamics.gearboxes if result.dynamics is not None else {}
    heated = [item.gearbox for item in result.thermal]
    expanded = [item.gearbox for item in result.expansion]
    return gearbox_colours([*turning, *heated, *expanded])
