"""Clearances as drawn and warm at the held stages."""

from typing import TYPE_CHECKING

from rigdesign.report.sections.gearbox_styles import gearbox_styles
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import ExpansionResult

if TYPE_CHECKING:
    from markupsafe import Markup


def _clearances(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.seals import seal_gap_figure

    gaps = None
    if any(seal.get("hot_mm") for expansion in result.expansion for seal in expansion.seal_gaps):
        gaps = draw(
            seal_gap_figure(result.expansion, gearbox_styles(result)),
            "Seal gap over the angle, as drawn and warm",
        )
    return {"seal_gaps": gaps, "shown": _last(result)}


def _details(result: RunResult, draw: Draw) -> Values:
    return {"seals_round": _seals_round(result, draw)}


def _last(result: RunResult) -> list[ExpansionResult]:
    """Of every gearbox the last held stage."""
    return list({item.gearbox: item for item in result.expansion}.values())


def _seals_round(result: RunResult, draw: Draw) -> dict[tuple[str, str], "Markup"]:
    """Seal gaps round the shafts by gearbox and stage, with the limit of the case."""
    from rigdesign.report.figures.seals import seal_round_figure

    limit = next((check.limit for check in result.checks if check.id == "clearance.seal_gap"), None)
    return {
        (item.gearbox, item.stage): draw(
            seal_round_figure(item, limit),
            f"Seal gaps round the shafts of gearbox {item.gearbox} at stage {item.stage}",
        )
        for item in result.expansion
        if any(seal.get("hot_mm") for seal in item.seal_gaps)
    }


CLEARANCES = ReportSection(
    id="clearances", title="Clearances as drawn and warm", template="clearances.html.j2", values=_clearances
)
CLEARANCE_DETAILS = ReportSection(
    id="clearance_details", title="Clearances in detail", template="clearance_details.html.j2", values=_details,
    applies=lambda result: bool(result.expansion), place="appendix",
)  # fmt: skip
