"""Temperature fields and heat balance of every housing, clearances as drawn and warm."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING

from rigdesign.report.sections.section import Draw, ReportSection, Values, gearbox_styles
from rigdesign.results.housing import HousingTemperatures
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import ExpansionResult, TemperatureField

if TYPE_CHECKING:
    from markupsafe import Markup


def hottest_stages(result: RunResult) -> list[HousingTemperatures]:
    """Of every gearbox the stage with the highest temperature."""
    found: dict[str, HousingTemperatures] = {}
    for item in result.thermal:
        if item.gearbox not in found or item.max_temperature > found[item.gearbox].max_temperature:
            found[item.gearbox] = item
    return list(found.values())


def _temperatures(result: RunResult, draw: Draw) -> Values:
    hottest = hottest_stages(result)
    keys = [(item.gearbox, item.stage) for item in hottest]
    pictures = _pictures(
        [field for field in result.fields if (field.gearbox, field.stage) in keys], draw, slice(1)
    )
    return {"hottest": hottest, "pictures": pictures}


def _details(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.flow import body_flow_figure

    keys = [(item.gearbox, item.stage) for item in hottest_stages(result)]
    first = [field for field in result.fields if (field.gearbox, field.stage) in keys]
    others = [field for field in result.fields if (field.gearbox, field.stage) not in keys]
    return {
        "pictures": _pictures(first, draw, slice(1, None)) | _pictures(others, draw, slice(None)),
        "heat_flows": {
            (item.gearbox, item.stage): draw(
                body_flow_figure(item), f"Heat through gearbox {item.gearbox} at stage {item.stage}"
            )
            for item in result.thermal
            if any(row.power for row in item.heat)
        },
    }


def _pictures(
    fields: Sequence[TemperatureField], draw: Draw, which: slice
) -> dict[tuple[str, str], list[tuple["Markup", str]]]:
    """Some of temperature, heat flux and displacement with their captions, by gearbox and stage."""
    from rigdesign.report.figures.field import MeshViews, field_pictures

    views: dict[int, MeshViews] = {}
    shown: dict[tuple[str, str], list[tuple[Markup, str]]] = {}
    for field in fields:
        view = views.setdefault(id(field.mesh), MeshViews(field.mesh))
        shown[field.gearbox, field.stage] = [
            (
                draw(picture.figure, f"{picture.title} of gearbox {field.gearbox} at stage {field.stage}"),
                picture.caption,
            )
            for picture in islice(field_pictures(field, view), which.start, which.stop)
        ]
    return shown


TEMPERATURES = ReportSection(
    id="temperatures", title="Temperatures", template="temperatures.html.j2", values=_temperatures
)
TEMPERATURE_DETAILS = ReportSection(
    id="temperature_details", title="Temperatures and heat in detail", template="temperature_details.html.j2",
    values=_details, applies=lambda result: bool(result.thermal), place="appendix",
)  # fmt: skip


def _clearances(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.seals import seal_gap_figure

    gaps = None
    if any(seal.get("hot_mm") for expansion in result.expansion for seal in expansion.seal_gaps):
        gaps = draw(
            seal_gap_figure(result.expansion, gearbox_styles(result)),
            "Seal gap over the angle, as drawn and warm",
        )
    return {"seal_gaps": gaps, "shown": _last(result)}


def _clearance_details(result: RunResult, draw: Draw) -> Values:
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
    id="clearance_details", title="Clearances in detail", template="clearance_details.html.j2",
    values=_clearance_details, applies=lambda result: bool(result.expansion), place="appendix",
)  # fmt: skip


# The turnable picture of temperature and deformation, with a still one for print and for browsers without WebGL.


@dataclass(frozen=True)
class ViewerParts:
    """What the template puts together; ``scene`` is JSON, ``library`` gzip in base64."""

    still: "Markup"
    caption: str
    scene: "Markup"
    library: "Markup"
    script: "Markup"
    style: "Markup"


def _viewer(result: RunResult, draw: Draw) -> Values:
    import json

    from markupsafe import Markup

    from rigdesign.report.viewer.cutaway import cutaway_picture
    from rigdesign.report.viewer.library import drawing_library, viewer_text
    from rigdesign.report.viewer.scene import hottest, viewer_scene
    from rigdesign.report.viewer.solid import solid_pictures

    field = result.fields[hottest(result.fields)]
    solids = solid_pictures(item.mesh for item in result.fields)
    still = cutaway_picture(field, solids[id(field.mesh)])
    scene = json.dumps(viewer_scene(result.fields, solids), ensure_ascii=True, allow_nan=False)
    return {
        "viewer": ViewerParts(
            still=draw(still.figure, f"{still.title} of gearbox {field.gearbox} at stage {field.stage}"),
            caption=still.caption,
            scene=Markup(scene.replace("<", "\\u003c")),
            library=Markup(drawing_library()),
            script=Markup(viewer_text("viewer.js")),
            style=Markup(viewer_text("viewer.css")),
        )
    }


def _with_fields(result: RunResult) -> bool:
    return bool(result.fields)


VIEWER = ReportSection(
    id="viewer",
    template="viewer.html.j2",
    values=_viewer,
    applies=_with_fields,
    within="temperatures",
)
