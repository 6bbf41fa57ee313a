"""What the verdicts depend on and where they come from: assumptions, hand checks, limits, warnings, provenance."""

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult


def _convergence(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.heat import convergence_figure

    if not any(history.residuals for history in result.coupling):
        return {"convergence": None}
    return {
        "convergence": draw(
            convergence_figure(result.coupling), "Residuals of the coupling loop by iteration"
        )
    }


ASSUMPTIONS = ReportSection(
    id="assumptions", title="Assumptions behind the verdicts", template="assumptions.html.j2"
)
OVERRIDES = ReportSection(id="overrides", template="overrides.html.j2", within="assumptions")
HAND_CHECKS = ReportSection(id="hand", title="Hand checks", template="hand.html.j2")
NOT_MODELLED = ReportSection(id="limits", title="What is not modelled", template="limits.html.j2")
WARNINGS = ReportSection(id="warnings", title="Warnings", template="warnings.html.j2")
PROVENANCE = ReportSection(
    id="provenance", title="Provenance", template="provenance.html.j2", values=_convergence
)
