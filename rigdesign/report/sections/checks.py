"""First page, all checks with their margins, and the ranges of the assumed inputs."""

from typing import TYPE_CHECKING

from rigdesign.report import reasons, views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from rigdesign.results.ranges import CheckRange, RangeMargin


NEAREST = 5
"""Lines of the table of the first page."""
SCHEMATIC = "Schematic of the rig: gearboxes, shafts, couplings, motor, bracing and oil"
NAMED = 4
"""Assumed inputs that the first page names."""
LEAST_MOVE = 0.01
"""Shift of the distance from which a pair of check and input has a line in the report; results.json has more."""


def _decision(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.schematic import phone_schematic_figure, schematic_figure
    from rigdesign.report.input_sheets import CaseSheet

    real = views.predicted(result.checks) or views.applicable(result.checks)
    nearest = views.sorted_checks(real)[:NEAREST]
    governing = nearest[0] if nearest else None
    case = CaseSheet.of(result.inputs)
    schematics = {"wide": schematic_figure(case), "narrow": phone_schematic_figure(case)}
    specific = [] if governing is None else views.specific(result, governing)
    return {
        "counts": result.counts,
        "applicable": len(views.applicable(result.checks)),
        "why": reasons.why(result),
        "nearest": nearest,
        "governing": governing,
        "flips": reasons.flips(result),
        "searched": reasons.searched(result),
        "assumed_flips": reasons.within_ranges(result),
        "depends_on": len(specific),
        "with_range": sum(record.range is not None for record in specific),
        "named": specific[:NAMED],
        "schematics": {
            width: draw(figure, SCHEMATIC) for width, figure in schematics.items() if figure is not None
        },
    }


DECISION = ReportSection(
    id="decision", title="Decision", template="decision.html.j2", values=_decision, place="first page"
)


def _checks(result: RunResult, draw: Draw) -> Values:
    return {
        "predicted": views.sorted_checks(views.predicted(result.checks)),
        "stated": views.sorted_checks(views.stated(result.checks)),
        "inapplicable": views.inapplicable(result.checks),
        "bar_end": views.BAR_END,
    }


def _drivers(result: RunResult, draw: Draw) -> Values:
    return {
        "drivers": views.drivers(result),
        "reservations": views.reservations(result.checks),
        "remarked": views.remarked(result.checks),
    }


def _basis(result: RunResult, draw: Draw) -> Values:
    return {"checks": views.applicable(result.checks)}


CHECKS = ReportSection(id="verdict", title="Checks and margins", template="checks.html.j2", values=_checks)
DRIVERS = ReportSection(
    id="drivers", title="Governing checks and reservations", template="drivers.html.j2", values=_drivers
)
CHECK_BASIS = ReportSection(
    id="basis", title="Basis of the checks", template="basis.html.j2", values=_basis, place="appendix"
)


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
