"""Figures of sampled designs: margins over each input, tornado bars, Sobol indices."""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from rigdesign.report.figures.drawing import (
    MARGIN_LABEL,
    SHORT_LABEL,
    finish,
    input_axis,
    margin_axis,
    mark_failed,
    new_figure,
    plain,
)
from rigdesign.report.margins.table import input_name, value_shown
from rigdesign.report.palette import INK, MUTED, SERIES, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rigdesign.report.margins.table import MarginTable, StudyAxis
    from rigdesign.studies.result import SobolIndex, Swing

PANEL_WIDTH = 5.2
MOST_LIMITING = 7
"""Limiting checks with a colour of their own in a scatter plot."""
MOST_VECTORS = 1500
"""Points up to which every one is drawn as its own shape; more are drawn as a picture."""
TITLE_WIDTH = 42
"""Characters of a line of the title above a bar chart."""
TORNADO_LEFT, TORNADO_RIGHT = 0.36, 0.98
"""Ends of the axis of a tornado plot in the width of its figure."""
LEAST_SPAN = 5.0
"""Margins that a tornado plot spans at least, so that inputs that move little look so [%]."""
LABEL_SIZE = 6.5
MOST_INPUTS = 12
"""Inputs of a bar chart, the strongest first."""


def scatter_figure(axis: "StudyAxis", positions: Sequence[float], table: "MarginTable") -> "Figure":
    """Smallest margin of every point over one input, by the check that limits it."""
    column, margin = table.limiting()
    names, counts = np.unique(column[column >= 0], return_counts=True)
    shown = [int(name) for name in names[np.argsort(-counts, kind="stable")]][:MOST_LIMITING]
    x = np.asarray(positions, dtype=float)
    failed = x[~table.computed]
    labels = [plain(fill(table.checks[name].title, 66)) for name in shown]
    rows = sum(len(label.split("\n")) for label in labels) + bool(len(failed)) + (len(names) > len(shown))
    legend = 0.165 * rows + 0.12
    height = 2.5 + legend
    figure = new_figure(height, PANEL_WIDTH)
    axes = figure.subplots()
    for number, (name, label) in enumerate(zip(shown, labels, strict=True)):
        style, chosen = curve_style(number), column == name
        axes.plot(
            x[chosen], margin[chosen], color=style.colour, marker=style.marker, linestyle="none", markersize=3.6,
            markeredgewidth=0, alpha=0.75, label=label, rasterized=len(x) > MOST_VECTORS,
        )  # fmt: skip
    others = (column >= 0) & ~np.isin(column, shown)
    if others.any():
        axes.plot(x[others], margin[others], ".", color=MUTED, markersize=3, label="another check")
    margin_axis(axes, margin, label=SHORT_LABEL)
    input_axis(axes, axis)
    mark_failed(axes, failed)
    figure.legend(loc="lower left", bbox_to_anchor=(0.06, 0.0), borderaxespad=0.1, handlelength=2)
    figure.subplots_adjust(left=0.19, right=0.98, top=1.0 - 0.1 / height, bottom=(legend + 0.45) / height)
    return figure


def tornado_figure(title: str, swings: "Sequence[Swing]") -> "Figure | None":
    """Margin of one check with every input at its two ends, the strongest first; None where no input moves it."""
    bars = [bar for bar in map(_bar, swings) if bar is not None]
    bars = sorted(bars, key=lambda bar: bar.reach, reverse=True)[:MOST_INPUTS]
    if not bars:
        return None
    lines = len(fill(title, TITLE_WIDTH).split("\n"))
    height = 0.8 + 0.15 * lines + 0.36 * len(bars)
    figure = new_figure(height, PANEL_WIDTH)
    axes = figure.subplots()
    for place, bar in enumerate(bars):
        axes.barh(place - 0.17, bar.low - bar.stated, left=bar.stated, height=0.32, color=SERIES[0])
        axes.barh(place + 0.17, bar.high - bar.stated, left=bar.stated, height=0.32, color=SERIES[1], hatch="////",
                  edgecolor="white", linewidth=0)  # fmt: skip
        for offset, (tip, text) in zip((-0.17, 0.17), bar.ends, strict=True):
            left = tip < bar.stated
            axes.annotate(
                plain(value_shown(text)),
                (tip, place + offset), xytext=(-3 if left else 3, 0), textcoords="offset points",
                ha="right" if left else "left", va="center", fontsize=LABEL_SIZE, color=INK,
            )  # fmt: skip
    axes.axvline(bars[0].stated, color=INK, linewidth=1.0)
    start, end = _limits(bars)
    axes.set_xlim(start, end)
    if start < 0.0 < end:
        axes.axvspan(start, 0.0, color=VERDICT_COLOURS["fail"], alpha=0.06, linewidth=0)
        axes.axvline(0.0, color=VERDICT_COLOURS["fail"], linewidth=1.2, linestyle="--")
    axes.set_yticks(range(len(bars)), [plain(fill(input_name(bar.swing.path), 26)) for bar in bars])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    finish(axes, MARGIN_LABEL, "", plain(fill(title, TITLE_WIDTH)))
    top = 1 - (0.16 + 0.16 * lines) / height
    figure.subplots_adjust(left=TORNADO_LEFT, right=TORNADO_RIGHT, top=top, bottom=0.5 / height)
    return figure


@dataclass(frozen=True)
class _Bar:
    """One input of a tornado plot; margins in percent, stated and at both ends."""

    swing: "Swing"
    stated: float
    low: float
    high: float

    @property
    def ends(self) -> tuple[tuple[float, str], tuple[float, str]]:
        """Margin and value at both ends."""
        return (self.low, self.swing.low), (self.high, self.swing.high)

    @property
    def reach(self) -> float:
        return max(self.low, self.high, self.stated) - min(self.low, self.high, self.stated)


def _limits(bars: "Sequence[_Bar]") -> tuple[float, float]:
    """Ends of the axis of a tornado plot: no nearer to each other than `LEAST_SPAN`, with room for the labels."""
    labels = {
        side: [text for bar in bars for tip, text in bar.ends if (tip < bar.stated) == (side == "left")]
        for side in ("left", "right")
    }
    width = (TORNADO_RIGHT - TORNADO_LEFT) * PANEL_WIDTH * 72.0
    left, right = (
        (8.0 + 0.62 * LABEL_SIZE * max((len(value_shown(text)) for text in texts), default=0)) / width
        for texts in labels.values()
    )
    tips = [tip for bar in bars for tip in (bar.low, bar.stated, bar.high)]
    low, high = min(tips), max(tips)
    spare = max(0.0, LEAST_SPAN - (high - low))
    low, high = low - 0.5 * spare, high + 0.5 * spare
    whole = (high - low) / (1.0 - left - right)
    return low - left * whole, high + right * whole


def _bar(swing: "Swing") -> _Bar | None:
    """None where an end has no result, or neither moves the check."""
    stated, low, high = swing.distance_stated, swing.distance_low, swing.distance_high
    if stated is None or low is None or high is None or stated == low == high:
        return None
    return _Bar(swing, *(100.0 * distance for distance in (stated, low, high)))


def indices_figure(title: str, indices: "Sequence[SobolIndex]") -> "Figure":
    """First-order and total Sobol index of every input for one check, with their 95 % intervals."""
    ordered = sorted(indices, key=lambda index: -index.total)[:MOST_INPUTS]
    lines = len(fill(title, TITLE_WIDTH).split("\n"))
    height = 0.95 + 0.15 * lines + 0.36 * len(ordered)
    figure = new_figure(height, PANEL_WIDTH)
    axes = figure.subplots()
    series = (
        (
            "alone (first order)",
            SERIES[0],
            "",
            [(i.first_order, i.first_order_interval) for i in ordered],
            -0.17,
        ),
        (
            "with interactions (total)",
            SERIES[1],
            "////",
            [(i.total, i.total_interval) for i in ordered],
            0.17,
        ),
    )
    for label, colour, hatch, values, offset in series:
        places = [place + offset for place in range(len(ordered))]
        sizes = [value for value, _ in values]
        below = [max(0.0, value - low) for value, (low, _) in values]
        above = [max(0.0, high - value) for value, (_, high) in values]
        axes.barh(
            places, sizes, height=0.32, color=colour, hatch=hatch, edgecolor="white", linewidth=0, label=label
        )
        axes.errorbar(sizes, places, xerr=[below, above], fmt="none", ecolor=INK, elinewidth=0.8, capsize=2)
    axes.set_xlim(min(0.0, axes.get_xlim()[0]), max(1.0, axes.get_xlim()[1]))
    axes.set_yticks(range(len(ordered)), [plain(fill(input_name(index.path), 26)) for index in ordered])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.legend(loc="lower right", frameon=True, framealpha=0.85, edgecolor="none")
    finish(axes, "share of the variance of the distance", "", plain(fill(title, TITLE_WIDTH)))
    figure.subplots_adjust(left=0.36, right=0.98, top=1 - (0.16 + 0.16 * lines) / height, bottom=0.5 / height)
    return figure
