"""The first page: verdict, why, what would turn it, the rig, and who signs."""

from rigdesign.report import flips, reasons, views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

NEAREST = 5
"""Lines of the table of the first page."""
SCHEMATIC = "Schematic of the rig: gearboxes, shafts, couplings, motor, bracing and oil"
NAMED = 4
"""Assumed inputs that the first page names."""


def _decision(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.case_sheet import CaseSheet
    from rigdesign.report.figures.schematic import phone_schematic_figure, schematic_figure

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
        "flips": flips.flips(result),
        "searched": flips.searched(result),
        "assumed_flips": flips.within_ranges(result),
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
