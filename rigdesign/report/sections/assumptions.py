"""Assumed inputs: the strongest in the body, all of them by part of the rig in the appendix."""

from rigdesign.report.assumption_groups import assumption_groups, most_influential
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

STRONGEST = 8
"""Lines in the body."""


def _strongest(result: RunResult, draw: Draw) -> Values:
    return {"strongest": most_influential(result, STRONGEST), "near": _near_words(result)}


def _all(result: RunResult, draw: Draw) -> Values:
    return {"groups": assumption_groups(result), "near": _near_words(result)}


def _near_words(result: RunResult) -> str:
    """How the lines are sorted."""
    evaluated = result.ranges is not None
    by_range = "by how far they move a distance over their range, then " if evaluated else ""
    near = "by how many checks that fail or use more than 90 % of their limit depend on them"
    return f"{by_range}{near}, those with a range first"


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
OVERRIDES = ReportSection(id="overrides", template="overrides.html.j2", within="assumptions")
