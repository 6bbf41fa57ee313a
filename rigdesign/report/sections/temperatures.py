"""Temperature fields and heat balance of every housing."""

from typing import TYPE_CHECKING

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup


def _temperatures(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.flow import body_flow_figure

    return {
        "pictures": _pictures(result, draw),
        "heat_flows": {
            (item.gearbox, item.stage): draw(
                body_flow_figure(item), f"Heat through gearbox {item.gearbox} at stage {item.stage}"
            )
            for item in result.thermal
            if any(row.power_W for row in item.heat)
        },
    }


def _pictures(result: RunResult, draw: Draw) -> dict[tuple[str, str], list[tuple["Markup", str]]]:
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


TEMPERATURES = ReportSection(
    id="temperatures", title="Temperatures", template="temperatures.html.j2", values=_temperatures
)
