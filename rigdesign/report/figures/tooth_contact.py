"""Figure of the loaded contact: pressure on the flank, root stress over the rolling angle."""

from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, words
from rigdesign.report.palette import INK, LINES, CurveStyle, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIGMA_F = "σ_F"
EDGE = "#c0392b"
"""Places where a tip edge carries."""
ROOM = 1.3
"""Top of a stress axis over the highest stress: the legend stands above the curves."""


def tooth_contact_figure(contact: dict[str, Any], style: CurveStyle | None = None) -> "Figure":
    """Pressure over face and rolling angle of the pinion, and the root stress of both gears."""
    style = style or curve_style(0)
    figure = new_figure(2.9)
    flank, *roots = figure.subplots(1, 3, squeeze=False)[0]
    _pattern(figure, flank, contact, style)
    for axes, gear in zip(roots, contact["root_stress"], strict=True):
        course = contact["root_stress"][gear]
        axes.plot(
            course["rolling_angle_deg"], course["highest_MPa"], **style.drawn, label="highest over the face"
        )
        axes.plot(
            course["rolling_angle_deg"],
            course["mid_face_MPa"],
            color=INK,
            linewidth=0.9,
            linestyle=LINES[1],
            label="mid-face",
        )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        finish(axes, "rolling angle φ [°]", f"root stress {SIGMA_F}(φ) [N/mm²]")
        gearbox_title(axes, f"{words(gear).capitalize()}, stage {words(contact['stage'])}", style)
        axes.set_ylim(top=ROOM * max(course["highest_MPa"]))
        axes.legend(loc="upper right")
    figure.subplots_adjust(left=0.065, right=0.985, top=0.90, bottom=0.17, wspace=0.54)
    return figure


def _pattern(figure: "Figure", axes: "Axes", contact: dict[str, Any], style: CurveStyle) -> None:
    pattern = contact["pattern"]
    face, angle = np.asarray(pattern["face_mm"]), np.asarray(pattern["rolling_angle_deg"])
    pressure, edge = np.asarray(pattern["pressure_MPa"]), np.asarray(pattern["edge"], dtype=bool)
    drawn = np.ma.masked_where(pressure <= 0.0, pressure)
    across = np.broadcast_to(face, angle.shape)
    shown = axes.pcolormesh(
        across, angle, drawn, shading="nearest", cmap="cividis", vmin=0.0, rasterized=True
    )
    if edge.any():
        axes.plot(across[edge], angle[edge], linestyle="", marker=".", markersize=1.2, color=EDGE)
    bar = figure.colorbar(shown, ax=axes, fraction=0.06, pad=0.03)
    bar.ax.tick_params(labelsize=8)
    bar.ax.set_title("p_H [N/mm²]", fontsize=8, pad=4)
    finish(axes, "face position z [mm]", "rolling angle φ [°]")
    gearbox_title(axes, "Pinion flank", style)
