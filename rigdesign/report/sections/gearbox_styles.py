"""One colour and line style a gearbox, the same in every figure of a report."""

from rigdesign.report.palette import CurveStyle, gearbox_colours
from rigdesign.results.result import RunResult


def gearbox_styles(result: RunResult) -> dict[str, CurveStyle]:
    """Style of every gearbox of the rig, whichever of them a figure shows."""
    turning = result.dynamics.gearboxes if result.dynamics is not None else {}
    heated = [item.gearbox for item in result.thermal]
    expanded = [item.gearbox for item in result.expansion]
    return gearbox_colours([*turning, *heated, *expanded])
