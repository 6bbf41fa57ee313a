"""The ranges of the assumed inputs in the report: two figures and the margins worth a line."""

from typing import TYPE_CHECKING

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from rigdesign.results.ranges import CheckRange, RangeMargin

LEAST_MOVE = 0.01
"""Shift of the distance from which a pair of check and input has a line in the report; results.json has more."""


def _details(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.ranges import margins_figure, temperature_figure

    ranges = result.ranges
    assert ranges is not None
    margins = margins_figure(ranges, {check.id: check.title for check in result.checks})
    temperatures = temperature_figure(ranges)
    moved = "Margin of every check over the ranges of the assumed inputs"
    hottest = "Highest temperature over the ranges of the inputs"
    stated = {row.check: row for row in ranges.checks}
    return {
        "range_margins": None if margins is None else draw(margins, moved),
        "range_temperature": None if temperatures is None else draw(temperatures, hottest),
        "strong_margins": [row for row in ranges.margins if _moves(row, stated[row.check])],
    }


def _moves(row: "RangeMargin", stated: "CheckRange") -> bool:
    ends = (row.distance_low, row.distance_high)
    return any(end is not None and abs(end - (stated.distance or 0.0)) > LEAST_MOVE for end in ends)


def _evaluated(result: RunResult) -> bool:
    return result.ranges is not None


RANGES = ReportSection(
    id="ranges", title="Verdicts over the ranges", template="ranges.html.j2", applies=_evaluated
)
RANGE_DETAILS = ReportSection(
    id="range_details", title="Margins at the ends of the ranges", template="range_details.html.j2", values=_details,
    applies=_evaluated, place="appendix",
)  # fmt: skip
