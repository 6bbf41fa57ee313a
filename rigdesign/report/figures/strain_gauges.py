"""Figure of the root stress at strain gauges over the rolling angle."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, new_figure, words
from rigdesign.report.palette import INK, curve_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARGIN = 0.3
"""Shown on either side of what is strained, as a share of it."""
STRAINED = 0.1
"""Stress that counts as strained, as a share of the highest of all."""


def strain_gauge_figure(contact: dict[str, Any]) -> "Figure":
    """Stress at every gauge, a panel for each gear that has some."""
    gauges = contact["strain_gauges"]
    gears = list(dict.fromkeys(gauge["gear"] for gauge in gauges))
    figure = new_figure(2.9)
    panels = figure.subplots(1, len(gears), squeeze=False)[0]
    for axes, gear in zip(panels, gears, strict=True):
        shown = [gauge for gauge in gauges if gauge["gear"] == gear]
        for number, gauge in enumerate(shown):
            axes.plot(
                gauge["rolling_angle_deg"],
                gauge["stress_MPa"],
                **curve_style(number).drawn,
                label=f"{label(gauge)}, z = {gauge['face_position_mm']:.3g} mm".replace(
                    "-", "\N{MINUS SIGN}"
                ),
            )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        axes.set_xlim(*_range(shown))
        finish(axes, "rolling angle φ [°]", "stress at the gauge [N/mm²]")
        axes.set_title(f"{words(gear).capitalize()}, stage {words(contact['stage'])}")
        axes.legend(loc="upper left")
    figure.subplots_adjust(left=0.075, right=0.985, top=0.90, bottom=0.17, wspace=0.25)
    return figure


def label(gauge: dict[str, Any]) -> str:
    """Name of a gauge as engineers write it: Roman numerals in capitals."""
    name = str(gauge["name"])
    return name.upper() if set(name) <= set("ivx") else words(name)


def _range(gauges: Sequence[dict[str, Any]]) -> tuple[float, float]:
    """Rolling angles in which a gauge is strained, and a margin."""
    highest = max(max(gauge["stress_MPa"]) for gauge in gauges)
    angles = [
        angle
        for gauge in gauges
        for angle, stress in zip(gauge["rolling_angle_deg"], gauge["stress_MPa"], strict=True)
        if abs(stress) > STRAINED * highest
    ]
    margin = MARGIN * (max(angles) - min(angles))
    return min(angles) - margin, max(angles) + margin
