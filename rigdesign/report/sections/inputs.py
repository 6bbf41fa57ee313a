"""Inputs, assumptions and what the run leaves open."""

from collections import Counter

from rigdesign.report import input_sheets
from rigdesign.report.input_sheets import (
    assumption_groups,
    bearing_sheet,
    joint_sheet,
    most_influential,
    shaft_sheet,
)
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

STRONGEST = 8
"""Lines in the body."""
OVERRIDES = ReportSection(id="overrides", template="overrides.html.j2", within="assumptions")
HAND_CHECKS = ReportSection(id="hand", title="Hand checks", template="hand.html.j2", place="appendix")
WARNINGS = ReportSection(id="warnings", title="Warnings", template="warnings.html.j2", place="appendix")


def _inputs(result: RunResult, draw: Draw) -> Values:
    return {"gears": input_sheets.gear_sheets(result), "oil": input_sheets.oil_sheet(result)}


def _drivetrain(result: RunResult, draw: Draw) -> Values:
    sheets = (
        input_sheets.material_sheet(result),
        shaft_sheet(result),
        joint_sheet(result),
        bearing_sheet(result),
    )
    return {"sheets": [sheet for sheet in sheets if sheet is not None]}


def _stated(result: RunResult) -> bool:
    return bool(result.inputs)


INPUTS = ReportSection(
    id="inputs", title="Gears and oil", template="inputs.html.j2", values=_inputs, applies=_stated
)
DRIVETRAIN_INPUTS = ReportSection(
    id="drivetrain", title="Materials and drivetrain", template="sheets.html.j2", values=_drivetrain, applies=_stated,
    place="appendix",
)  # fmt: skip


def _strongest(result: RunResult, draw: Draw) -> Values:
    return {"strongest": most_influential(result, STRONGEST), "order": _order(result)}


def _all(result: RunResult, draw: Draw) -> Values:
    return {"groups": assumption_groups(result), "order": _order(result)}


def _order(result: RunResult) -> str:
    """How the lines are sorted, and what is not known of them."""
    if result.ranges is not None:
        return (
            "Sorted by how far an input moves the distance to the limit of a governing check over its range (one that "
            "fails; if none does, one with less than 10 % of its limit left, or the nearest); the others by name."
        )
    return (
        "Sorted by name: which of them moves the governing margins most is not known, as their ranges were not "
        f"evaluated. rigdesign check {result.case['name']} --ranges works it out."
    )


ASSUMPTIONS = ReportSection(
    id="assumptions",
    title="Assumptions behind the verdicts",
    template="assumptions.html.j2",
    values=_strongest,
)
ALL_ASSUMPTIONS = ReportSection(
    id="all_assumptions",
    title="All assumptions",
    template="all_assumptions.html.j2",
    values=_all,
    place="appendix",
)


def _convergence(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.heat import convergence_figure

    if not any(history.residuals for history in result.coupling):
        return {"convergence": None}
    return {
        "convergence": draw(
            convergence_figure(result.coupling), "Residuals of the coupling loop by iteration"
        )
    }


def _topics(result: RunResult, draw: Draw) -> Values:
    return {"topics": Counter(record.id.replace("_", " ") for record in result.warnings)}


NOT_MODELLED = ReportSection(
    id="limits", title="What is not modelled", template="limits.html.j2", values=_topics
)


PROVENANCE = ReportSection(
    id="provenance", title="Provenance", template="provenance.html.j2", values=_convergence, place="appendix"
)
