"""report.html: one self-contained page in the order an engineer reads it."""

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rigdesign.base.version import __version__
from rigdesign.report import numbers
from rigdesign.report.figures.drawing import drawing_style, inline_svg
from rigdesign.report.pages import views
from rigdesign.report.pages.ranges_section import ranges_context
from rigdesign.report.pages.transient_section import oil_power_figures, transient_figures
from rigdesign.results.result import GearboxDynamics, RunResult

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup
    from matplotlib.figure import Figure

TEMPLATES = Path(__file__).parents[1] / "templates"


def report_html(result: RunResult) -> str:
    """The whole report as one HTML document: no link, script, font or picture from elsewhere.

    Everything from the case is escaped. Two runs give the same text but for the timings.
    """
    figures = _Figures()
    with drawing_style():
        context = _context(result, figures)
    return environment().get_template("report.html.j2").render(context)


@cache
def environment() -> "Environment":
    """Templates with escaping on and an error for every name that is missing."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    templates = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters.update(
        number=numbers.number_text,
        unit=numbers.unit_text,
        heading=numbers.heading_text,
        cell=numbers.cell_text,
        words=lambda text: str(text).replace("_", " "),
        signs=signs,
        symbol=symbol,
        check_families=views.check_families,
    )
    templates.globals.update(
        quantity=numbers.quantity_text,
        limit=numbers.limit_text,
        margin=numbers.margin_text,
        margin_unit=numbers.margin_unit,
        bar=views.bar_width,
        columns=views.columns,
        mesh_errors=views.mesh_errors,
        is_number=views.is_number,
        loss_table=views.loss_table,
        crossing_table=views.crossing_table,
    )
    return templates


class _Figures:
    """Turns figures into SVG and numbers them, so that ids stay unique on the page."""

    def __init__(self) -> None:
        self._count = 0

    def __call__(self, figure: "Figure", description: str) -> "Markup":
        from markupsafe import Markup

        self._count += 1
        return Markup(inline_svg(figure, f"f{self._count}", description))


def _context(result: RunResult, draw: _Figures) -> dict[str, Any]:
    return {
        "result": result,
        "tool_version": __version__,
        "checks": views.sorted_checks(result.checks),
        "counts": {
            verdict: sum(c.verdict == verdict for c in result.checks) for verdict in views.VERDICT_ORDER
        },
        "drivers": views.drivers(result),
        "bar_end": views.BAR_END,
        "main_stage": views.main_stage(result),
        **_dynamics_figures(result, draw),
        **_heat_figures(result, draw),
        **ranges_context(result, draw),
        "transient_figures": transient_figures(result.transient, draw),
        "oil_power_figures": oil_power_figures(result.transient, draw),
    }


def signs(text: str) -> "Markup":
    """Escaped text in which K_V, f_z and the like carry a subscript."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"\b([KYfnσ])_([A-Z]|z)\b", r"\1<sub>\2</sub>", str(escape(text))))


def symbol(key: str) -> "Markup":
    """A factor of a standard by its printed symbol, index as subscript; words stay words."""
    from markupsafe import Markup

    head, index = numbers.symbol_parts(key)
    if len(head) > 2 or not index:
        return Markup("{}").format(numbers.heading_text(key))
    return Markup("{}<sub>{}</sub>").format(head, index)


def _dynamics_figures(result: RunResult, draw: Callable[["Figure", str], "Markup"]) -> dict[str, Any]:
    from rigdesign.report.figures import dynamics as figures_dynamics
    from rigdesign.report.figures import ramp as figures_ramp

    shown: dict[str, Any] = {"ramp_figure": None, "kv_figure": None, "campbell": None, "root_stress": {}}
    dynamics = result.dynamics
    if dynamics is None:
        return shown
    if dynamics.ramp is not None and len(dynamics.ramp.time_s) > 1:
        figure = figures_ramp.ramp_figure(dynamics.ramp)
        shown["ramp_figure"] = draw(figure, "Speed, torques and torque envelopes over time")
    if any(gearbox.dynamic_factor for gearbox in dynamics.gearboxes.values()):
        figure = figures_dynamics.dynamic_factor_figure(dynamics)
        shown["kv_figure"] = draw(figure, "Dynamic factor over speed, simulated and by ISO 6336-1")
    if dynamics.crossings:
        shown["campbell"] = draw(
            figures_dynamics.campbell_figure(dynamics), "Mesh orders and natural frequencies over speed"
        )
    for name, gearbox in dynamics.gearboxes.items():
        if _has_root_stress(gearbox):
            figure = figures_dynamics.root_stress_figure(gearbox)
            shown["root_stress"][name] = draw(
                figure, f"Root stress of gearbox {name}, dynamic and quasi-static"
            )
    return shown


def _has_root_stress(gearbox: GearboxDynamics) -> bool:
    return bool(gearbox.root_stress or gearbox.root_stress_factor)


def _heat_figures(result: RunResult, draw: Callable[["Figure", str], "Markup"]) -> dict[str, Any]:
    from rigdesign.report.figures import heat as figures_heat
    from rigdesign.report.figures import seals as figures_seals

    stage = views.main_stage(result)
    shown: dict[str, Any] = dict.fromkeys(
        ("losses_by_stage", "losses_by_place", "oil", "seal_gaps", "convergence")
    )
    if result.losses:
        shown["losses_by_stage"] = draw(
            figures_heat.losses_by_stage_figure(result.losses), "Power loss by stage and kind"
        )
        figure = figures_heat.losses_by_place_figure(result.losses, stage)
        shown["losses_by_place"] = draw(figure, f"Power loss by place at stage {stage}")
    oil_stage = (
        stage if any(row.stage == stage for row in result.oil) else next((r.stage for r in result.oil), "")
    )
    if result.oil:
        shown["oil"] = draw(
            figures_heat.oil_figure(result.oil, oil_stage), f"Oil inlet and outlet at stage {oil_stage}"
        )
    if any(seal.get("hot_mm") for expansion in result.expansion for seal in expansion.seal_gaps):
        shown["seal_gaps"] = draw(
            figures_seals.seal_gap_figure(result.expansion), "Seal gap over the angle, hot and cold"
        )
    if any(history.residuals for history in result.coupling):
        shown["convergence"] = draw(
            figures_heat.convergence_figure(result.coupling), "Residuals of the coupling loop by pass"
        )
    shown |= _flow_figures(result, oil_stage, draw)
    shown["pictures"] = _pictures(result, draw)
    shown["seals_round"] = _seals_round(result, draw)
    return shown


def _flow_figures(result: RunResult, stage: str, draw: Callable[["Figure", str], "Markup"]) -> dict[str, Any]:
    """Heat of the rig at its main held stage, and through the bodies of every gearbox at every held stage."""
    from rigdesign.report.figures.flow import body_flow_figure, rig_flow_figure

    balance = next((row for row in result.cooler if row["stage"] == stage), None)
    whole = None
    if balance is not None:
        losses = [row for row in result.losses if row.stage == stage]
        figure = rig_flow_figure(losses, [row for row in result.oil if row.stage == stage], balance)
        whole = (
            None
            if figure is None
            else draw(figure, f"Heat of the rig from losses to cooler and room at stage {stage}")
        )
    return {
        "rig_flow": whole,
        "flow_stage": stage,
        "heat_flows": {
            (item.gearbox, item.stage): draw(
                body_flow_figure(item), f"Heat through gearbox {item.gearbox} at stage {item.stage}"
            )
            for item in result.thermal
            if any(row.power_W for row in item.heat)
        },
    }


def _pictures(
    result: RunResult, draw: Callable[["Figure", str], "Markup"]
) -> dict[tuple[str, str], list[tuple["Markup", str]]]:
    """Temperature, heat flux and displacement with their captions, by gearbox and stage."""
    from rigdesign.report.figures.field import MeshViews, field_pictures

    views: dict[int, MeshViews] = {}
    shown: dict[tuple[str, str], list[tuple[Markup, str]]] = {}
    for field in result.fields:
        view = views.setdefault(id(field.mesh), MeshViews(field.mesh))
        shown[field.gearbox, field.stage] = [
            (
                draw(picture.figure, f"{picture.title} of gearbox {field.gearbox} at stage {field.stage}"),
                picture.caption,
            )
            for picture in field_pictures(field, view)
        ]
    return shown


def _seals_round(
    result: RunResult, draw: Callable[["Figure", str], "Markup"]
) -> dict[tuple[str, str], "Markup"]:
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
