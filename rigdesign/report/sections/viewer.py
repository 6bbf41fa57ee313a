"""The turnable picture of temperature and deformation, with a still one for print and for browsers without WebGL."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup


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
