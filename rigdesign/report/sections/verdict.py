"""Verdict with the table of all checks, and what drives it."""

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


def _verdict(result: RunResult, draw: Draw) -> Values:
    return {
        "checks": views.sorted_checks(result.checks),
        "counts": {
            verdict: sum(c.verdict == verdict for c in result.checks) for verdict in views.VERDICT_ORDER
        },
        "drivers": views.drivers(result),
        "bar_end": views.BAR_END,
    }


def _drivers(result: RunResult, draw: Draw) -> Values:
    return {"drivers": views.drivers(result)}


VERDICT = ReportSection(
    id="verdict", title="Verdict and margins", template="verdict.html.j2", values=_verdict
)
DRIVERS = ReportSection(id="drivers", title="Governing checks", template="drivers.html.j2", values=_drivers)
