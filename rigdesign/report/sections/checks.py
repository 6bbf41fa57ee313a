"""All checks with their margins, and what the governing ones depend on."""

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


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
