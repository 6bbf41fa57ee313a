"""Assumed inputs: those that move the governing margins most in the body, all by part of the rig in the appendix."""

from rigdesign.report.assumption_groups import assumption_groups, most_influential
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

STRONGEST = 8
"""Lines in the body."""


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
OVERRIDES = ReportSection(id="overrides", template="overrides.html.j2", within="assumptions")
