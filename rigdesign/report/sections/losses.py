"""Losses by stage and place, oil, and where the heat goes."""

from typing import TYPE_CHECKING

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup


def _losses(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    by_stage = None
    if result.losses:
        by_stage = draw(figures.losses_by_stage_figure(result.losses), "Power loss by stage and kind")
    return {
        "losses_by_stage": by_stage,
        "rig_flow": _rig_flow(result, oil_stage, draw),
        "flow_stage": oil_stage,
        "oil_rows": [row for row in result.oil if row.stage == oil_stage],
    }


def _details(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    shown: Values = {"losses_by_place": None, "oil": None, "main_stage": stage}
    if result.losses:
        shown["losses_by_place"] = draw(
            figures.losses_by_place_figure(result.losses, stage), f"Power loss by place at stage {stage}"
        )
    if result.oil:
        shown["oil"] = draw(
            figures.oil_figure(result.oil, oil_stage), f"Oil inlet and outlet at stage {oil_stage}"
        )
    return shown


def _oil_stage(result: RunResult, stage: str) -> str:
    """The stage with the most heat, or the first that has oil rows."""
    stages = [row.stage for row in result.oil]
    return stage if stage in stages else next(iter(stages), "")


def _rig_flow(result: RunResult, stage: str, draw: Draw) -> "Markup | None":
    """Heat of the rig at its main held stage."""
    from rigdesign.report.figures.flow import rig_flow_figure

    balance = next((row for row in result.cooler if row["stage"] == stage), None)
    if balance is None:
        return None
    losses = [row for row in result.losses if row.stage == stage]
    figure = rig_flow_figure(losses, [row for row in result.oil if row.stage == stage], balance)
    if figure is None:
        return None
    return draw(figure, f"Heat of the rig from losses to cooler and room at stage {stage}")


LOSSES = ReportSection(id="losses", title="Losses and oil", template="losses.html.j2", values=_losses)
LOSS_DETAILS = ReportSection(
    id="loss_details", title="Losses and oil in detail", template="loss_details.html.j2", values=_details,
    applies=lambda result: bool(result.losses or result.oil), place="appendix",
)  # fmt: skip
