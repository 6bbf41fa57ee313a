"""Gaps of the contactless seals: over the angle, and enlarged round the shaft."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.figures.drawing import finish, gearbox_title, legend_right, new_figure, words
from rigdesign.report.numbers import number_text
from rigdesign.report.palette import (
    INK,
    MUTED,
    SERIES,
    VERDICT_COLOURS,
    CurveStyle,
    curve_style,
    gearbox_colours,
)
from rigdesign.results.thermal import ExpansionResult
from thermal.fe.mesh import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLUMNS = 4
"""Seals side by side."""
SHAFT = 0.3
"""Drawn radius of a shaft, as a share of that of the largest gap's outer edge."""
PITCH = 2.75
"""Distance between the middles of two seals, in the same measure."""
ROWS_APART = 2.85


def seal_gap_figure(
    expansion: list[ExpansionResult], styles: Mapping[str, CurveStyle] | None = None
) -> "Figure":
    """Radial gap of every seal over the angle, warm against as drawn [mm].

    styles : of all gearboxes of the report; of those in ``expansion`` if left out
    """
    styles = styles or gearbox_colours(item.gearbox for item in expansion)
    shown = [item for item in expansion if _seals(item)]
    height = 0.4 + 2.2 * len(shown)
    figure = new_figure(height)
    for axes, item in zip(figure.subplots(len(shown), 1, squeeze=False)[:, 0], shown, strict=True):
        _over_angle(axes, item)
        finish(axes, "angle about the shaft axis [°]", "radial gap, local [mm]")
        gearbox_title(axes, f"Gearbox {words(item.gearbox)}, stage {words(item.stage)}", styles[item.gearbox])
        legend_right(axes)
    figure.subplots_adjust(left=0.085, right=0.76, top=1 - 0.28 / height, bottom=0.47 / height, hspace=0.5)
    return figure


def seal_round_figure(item: ExpansionResult, limit: float | None) -> "Figure":
    """Gap of every seal of a gearbox round its shaft, seen along x, in one radial scale.

    limit : least gap allowed [mm], if there is one
    """
    seals = _seals(item)
    rows = -(-len(seals) // COLUMNS)
    top = max(max(seal["hot_mm"]) for seal in seals)
    top = 1.04 * max([top, *(seal["cold_mm"] for seal in seals)])
    figure = new_figure(2.34 * rows + 0.1)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    for number, seal in enumerate(seals):
        row, column = divmod(number, COLUMNS)
        _round(axes, seal, np.array([PITCH * column, -ROWS_APART * row]), top, limit)
    axes.set_xlim(-0.5 * PITCH, (COLUMNS - 0.5) * PITCH)
    middle, half = -0.5 * ROWS_APART * (rows - 1), 0.5 * COLUMNS * PITCH * (2.34 * rows + 0.1) / 9.2
    axes.set_ylim(middle - half, middle + half)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return figure


def _seals(item: ExpansionResult) -> list[dict[str, Any]]:
    """Seals whose gap is given round the circumference."""
    return [seal for seal in item.seal_gaps if seal.get("hot_mm")]


def _over_angle(axes: "Axes", item: ExpansionResult) -> None:
    seals = _seals(item)
    for number, seal in enumerate(seals):
        angle, gap = _closed(seal)
        axes.plot(angle, gap, **curve_style(number).drawn, label=f"{words(str(seal['seal']))}, warm")
    for number, cold in enumerate(sorted({seal["cold_mm"] for seal in seals})):
        axes.axhline(cold, color=MUTED, linewidth=1.6, alpha=0.6, label=None if number else "as drawn")
    axes.set_xlim(0, 360)
    axes.set_xticks(range(0, 361, 45))


def _closed(seal: dict[str, Any]) -> tuple[list[float], list[float]]:
    """Angles [deg] and gaps [mm] from 0 to 360 degrees, the first again at the end."""
    angle, gap = list(seal["angle_deg"]), list(seal["hot_mm"])
    if angle[-1] < angle[0] + 360.0:
        angle, gap = [*angle, angle[0] + 360.0], [*gap, gap[0]]
    return angle, gap


def _round(axes: "Axes", seal: dict[str, Any], middle: FloatArray, top: float, limit: float | None) -> None:
    """One seal: shaft, hot gap as a band between shaft and bore, bore as drawn dashed, least gap marked."""
    from matplotlib.patches import Circle

    def radius(gap: Any) -> Any:
        return SHAFT + (1.0 - SHAFT) * np.asarray(gap) / top

    angle, gap = (np.array(values) for values in _closed(seal))
    around = np.column_stack([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    edge = middle + radius(gap)[:, None] * around
    axes.fill(edge[:, 0], edge[:, 1], facecolor="#dbe7f1", edgecolor=SERIES[0], linewidth=1.3)
    axes.add_patch(Circle(tuple(middle), SHAFT, facecolor="#b9c3cc", edgecolor=INK, linewidth=0.8, zorder=3))
    for value, colour, style in ((seal["cold_mm"], INK, (0, (4, 2))), (limit, VERDICT_COLOURS["fail"], ":")):
        if value is not None:
            axes.add_patch(
                Circle(
                    tuple(middle), float(radius(value)), fill=False, edgecolor=colour, linestyle=style,
                    linewidth=0.9, zorder=4,
                )
            )  # fmt: skip
    least = int(np.argmin(np.abs(angle - seal["angle_of_min_deg"])))
    toward = np.array([middle + SHAFT * around[least], edge[least]])
    axes.plot(toward[:, 0], toward[:, 1], color=VERDICT_COLOURS["fail"], linewidth=1.6, zorder=5)
    _scale(axes, middle, top)
    axes.text(
        middle[0],
        middle[1] + 1.3,
        words(str(seal["seal"])),
        ha="center",
        fontsize=8,
        fontweight="bold",
    )
    least_words = f"least {seal['hot_min_mm']:.3f} mm at {seal['angle_of_min_deg']:.0f}°"
    below = f"{least_words}, mean {seal['hot_mean_mm']:.3f} mm"
    axes.text(middle[0], middle[1] + 1.12, below, ha="center", fontsize=8)
    axes.text(middle[0], middle[1], "shaft", ha="center", va="center", fontsize=8, zorder=6)


def _scale(axes: "Axes", middle: FloatArray, top: float) -> None:
    """Ticks of the gap [mm] from the shaft to the right."""
    from matplotlib.ticker import MaxNLocator

    ticks = [float(tick) for tick in MaxNLocator(3).tick_values(0.0, top) if 0.0 < tick <= top]
    places = middle[0] + SHAFT + (1.0 - SHAFT) * np.array(ticks) / top
    axes.plot([middle[0] + SHAFT, places[-1]], [middle[1]] * 2, color=MUTED, linewidth=0.6, zorder=2)
    axes.plot(places, np.full(len(places), middle[1]), "|", color=MUTED, markersize=4, zorder=2)
    axes.text(
        places[-1] - 0.02,
        middle[1] - 0.1,
        f"{number_text(ticks[-1], 2)} mm",
        ha="right",
        va="center",
        fontsize=8,
    )
