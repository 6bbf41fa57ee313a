"""Dynamic shares over speed with the bands to avoid and the stages that hold a speed."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, words
from rigdesign.report.palette import INK, MUTED, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS = {
    "dynamic_factor": "dynamic part of the mesh torque, highest of the meshes",
    "root_stress": "root stress, dynamic / quasi-static \N{MINUS SIGN} 1",
    "shaft_torque": "half peak-to-peak torque of shafts and joints",
}


def dwell_figure(dwell: Mapping[str, Any]) -> "Figure":
    """Highest share of every kind; grey where the rig should not dwell."""
    figure = new_figure(2.9)
    axes = figure.subplots()
    high = dwell["highest"]
    for number, (key, label) in enumerate(KINDS.items()):
        if key in high:
            axes.plot(high["speed_rpm"], high[key], **curve_style(number).drawn, linewidth=1.0, label=label)
    for number, band in enumerate(dwell["bands"]):
        axes.axvspan(
            band["low_rpm"], min(band["high_rpm"], dwell["high_rpm"]), color="#e3e7eb", linewidth=0, zorder=0,
            label="band to avoid" if number == 0 else None,
        )  # fmt: skip
    for number, limit in enumerate(dict.fromkeys((dwell["share_limit"], dwell["shaft_share_limit"]))):
        axes.axhline(
            limit, color=INK, linewidth=0.7, linestyle=(0, (6.0, 2.0)),
            label=None if number else "from which a peak counts: meshes, shafts",
        )  # fmt: skip
    for stage in dwell["stages"]:
        if stage["kind"] == "dwell":
            colour = VERDICT_COLOURS["fail" if stage["band"] else "pass"]
            axes.axvline(stage["speed_rpm"], color=colour, linewidth=1.1)
            axes.annotate(
                words(stage["stage"]), (stage["speed_rpm"], 1.0), xycoords=("data", "axes fraction"),
                textcoords="offset points", xytext=(0, 3), ha="center", fontsize=8, color=colour,
            )  # fmt: skip
    axes.set_xlim(0, dwell["high_rpm"])
    axes.set_ylim(bottom=0)
    axes.tick_params(colors=MUTED)
    finish(axes, "pinion speed n [rpm]", "dynamic share [–]")
    legend_right(axes)
    figure.subplots_adjust(left=0.075, right=0.65, top=0.92, bottom=0.16)
    return figure
