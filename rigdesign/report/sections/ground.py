"""What the run leaves open and where it comes from: limits, warnings, hand checks, provenance."""

from collections import Counter

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


def _topics(result: RunResult, draw: Draw) -> Values:
    return {"topics": Counter(record.id.replace("_", " ") for record in result.warnings)}


NOT_MODELLED = ReportSection(
    id="limits", title="What is not modelled", template="limits.html.j2", values=_topics
)
HAND_CHECKS = ReportSection(id="hand", title="Hand checks", template="hand.html.j2", place="appendix")
WARNINGS = ReportSection(id="warnings", title="Warnings", template="warnings.html.j2", place="appendix")
PROVENANCE = ReportSection(
    id="provenance", title="Provenance", template="provenance.html.j2", values=_convergence, place="appendix"
)
