"""Figures of a study over one input: how much of every limit is left."""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import (
    MARGIN_LABEL,
    SHORT_LABEL,
    finish,
    input_axis,
    legend_right,
    margin_axis,
    mark_failed,
    new_figure,
    plain,
)
from rigdesign.report.margins.table import input_name, value_shown
from rigdesign.report.palette import GRID, INK, MUTED, SERIES, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rigdesign.report.margins.passing_range import PassRange, StudyAnswer
    from rigdesign.report.margins.regions import RegionMap
    from rigdesign.report.margins.table import MarginTable, StudyAxis
    from rigdesign.studies.result import SobolIndex, Swing

NAMED_CURVES = 8
"""Checks in one picture: those that move and come nearest to their limit or break it."""
LEGEND_WIDTH = 38
"""Characters of a line of the legend beside a figure."""
PANEL_WIDTH, PANEL_HEIGHT = 5.2, 2.5
"""Size of the plot of a group [in], without its legend."""
MOST_MARKERS = 60
"""Points up to which each is marked on its curve."""


def margins_figure(answer: "StudyAnswer", positions: Sequence[float]) -> "Figure | None":
    """Margins of the nearest checks that move over the varied input; None where there is none to draw.

    The range in which everything passes (but what fails at every point) is marked at its ends.
    """
    table = answer.selected
    columns = drawn_columns(table)[:NAMED_CURVES]
    if not columns:
        return None
    figure = new_figure(4.3)
    axes = figure.subplots()
    _curves(axes, answer.axes[0], positions, table, columns)
    margin_axis(axes, table.margin[:, columns].ravel())
    input_axis(axes, answer.axes[0])
    mark_failed(axes, _failed(positions, table))
    for item in answer.passing.ranges if answer.passing else ():
        _mark_range(axes, answer.axes[0], item)
    legend_right(axes)
    figure.subplots_adjust(left=0.105, right=0.69, top=0.93, bottom=0.12)
    return figure


def group_figure(answer: "StudyAnswer", positions: Sequence[float], columns: Sequence[int]) -> "Figure":
    """Margins of the checks ``columns`` of one group over the varied input, its legend below."""
    rows = sum(len(_label(_titled(answer.selected, column), 70).split("\n")) for column in columns) + bool(
        _failed(positions, answer.selected)
    )
    legend = 0.165 * rows + 0.12
    height = PANEL_HEIGHT + legend
    figure = new_figure(height, PANEL_WIDTH)
    axes = figure.subplots()
    _curves(axes, answer.axes[0], positions, answer.selected, columns, width=70)
    margin_axis(axes, answer.selected.margin[:, list(columns)].ravel(), label=SHORT_LABEL)
    input_axis(axes, answer.axes[0])
    mark_failed(axes, _failed(positions, answer.selected))
    axes.set_title(plain(answer.selected.checks[columns[0]].group))
    figure.legend(loc="lower left", bbox_to_anchor=(0.06, 0.0), borderaxespad=0.1, handlelength=3.2)
    figure.subplots_adjust(left=0.19, right=0.98, top=1.0 - 0.25 / height, bottom=(legend + 0.42) / height)
    return figure


def drawn_columns(table: "MarginTable") -> list[int]:
    """Columns that move, the nearest first; where none moves, the nearest of all."""
    nearest = table.nearest_first()
    moving = [column for column in nearest if table.moving[column]]
    return moving or nearest[:NAMED_CURVES]


def _curves(
    axes: "Axes",
    axis: "StudyAxis",
    positions: Sequence[float],
    table: "MarginTable",
    columns: Sequence[int],
    *,
    width: int = LEGEND_WIDTH,
) -> None:
    order = np.argsort(np.asarray(positions), kind="stable")
    x = np.asarray(positions, dtype=float)[order]
    for number, column in enumerate(columns):
        style = curve_style(number)
        margin, own = table.margin[order, column], table.own[order, column]
        drawn = _through_zero(x, margin, own) if axis.numeric else (x, margin)
        axes.plot(*drawn, color=style.colour, linestyle=style.line if axis.numeric else "none")
        markers = style.marker if len(x) <= MOST_MARKERS or not axis.numeric else "none"
        axes.plot(x, margin, color=style.colour, marker=markers, linestyle="none", markersize=4)
        axes.plot(
            [], [], color=style.colour, linestyle=style.line if axis.numeric else "none", marker=markers, markersize=4,
            label=_label(_titled(table, column), width),
        )  # fmt: skip


def _through_zero(
    x: NDArray[np.float64], margin: NDArray[np.float64], own: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The curve with a vertex where the margin in the unit of the check, linear in its value, is zero."""
    before, after = own[:-1], own[1:]
    with np.errstate(invalid="ignore"):
        crossed = np.flatnonzero(before * after < 0.0)
    share = before[crossed] / (before[crossed] - after[crossed])
    zeros = x[crossed] + (x[crossed + 1] - x[crossed]) * share
    return np.insert(x, crossed + 1, zeros), np.insert(margin, crossed + 1, 0.0)


def _mark_range(axes: "Axes", axis: "StudyAxis", item: "PassRange") -> None:
    """Ends of a range where everything passes, with the value at each that is no end of the study."""
    axes.axvspan(
        item.low.value, item.high.value, ymin=0.985, color=VERDICT_COLOURS["pass"], alpha=0.8, linewidth=0
    )
    for end in (item.low, item.high):
        if end.cause == "crossing":
            axes.axvline(
                end.value, color=VERDICT_COLOURS["pass"], linewidth=1.3, linestyle=(0, (5, 2)), zorder=1.8
            )
            axes.plot(
                [end.value], [0.0], "o", markersize=8, markerfacecolor="white", markeredgecolor=INK, zorder=5
            )
            axes.annotate(
                plain(axis.read_off(end.value, end.held, end.beyond)),
                (end.value, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3), textcoords="offset points",
                ha="center", fontweight="bold", color=VERDICT_COLOURS["pass"],
            )  # fmt: skip


def _failed(positions: Sequence[float], table: "MarginTable") -> list[float]:
    return [position for position, computed in zip(positions, table.computed, strict=True) if not computed]


def _titled(table: "MarginTable", column: int) -> str:
    never = " (fails at every point)" if table.always_failing[column] else ""
    return table.checks[column].title + never


def _label(text: str, width: int) -> str:
    return plain(fill(text, width))


# A study over two inputs as a map: pass region and limiting check.

LETTERS = "ABCDEFGH"
"""Of the limiting checks, the largest region first; further ones share a grey without a letter."""
PASS_TINT, FAIL_TINT = 0.22, 0.62
LEVELS = (10, 20, 30, 40, 50, 60, 70, 80, 90)
"""Contours of the smallest margin [%]."""
FEW_POINTS = 200
"""Points of a map up to which each has a clear mark."""
LEAST_REGION = 0.004
"""Share of the map below which a region gets no letter."""


def region_figure(
    axes_of_study: "tuple[StudyAxis, StudyAxis]",
    found: "RegionMap",
    table: "MarginTable",
    *,
    small: bool = False,
) -> "Figure":
    """Regions by limiting check (colour and letter), hatched where it fails; zero margin as a thick line.

    small : one of several maps
    """
    legend = _legend(found)
    width, height = (6.6, 3.6) if small else (9.2, 4.7)
    figure = new_figure(height, width)
    axes = figure.subplots()
    _regions(axes, found, legend)
    _contours(axes, found)
    _points(axes, found)
    input_axis(axes, axes_of_study[0])
    input_axis(axes, axes_of_study[1], upright=True)
    axes.grid(visible=False)
    _explain(axes, found, table, legend, width=34 if small else 40)
    left = 0.12 if small else 0.09
    figure.subplots_adjust(left=left, right=0.6 if small else 0.66, top=0.97, bottom=0.6 / height)
    return figure


def _legend(found: "RegionMap") -> list[int]:
    """Columns of the limiting checks that get a letter, the largest region first."""
    columns, counts = np.unique(found.limiting[found.limiting >= 0], return_counts=True)
    return [int(column) for column in columns[np.argsort(-counts, kind="stable")]][: len(LETTERS)]


def _regions(axes: "Axes", found: "RegionMap", legend: Sequence[int]) -> None:
    from matplotlib.colors import to_rgb

    colours = np.ones((*found.limiting.shape, 3))
    colours[found.limiting >= 0] = _tinted(to_rgb(MUTED), PASS_TINT)
    for number, column in enumerate(legend):
        for fails, tint in ((False, PASS_TINT), (True, FAIL_TINT)):
            region = (found.limiting == column) & (found.fails == fails)
            colours[region] = _tinted(to_rgb(SERIES[number]), tint)
            for x, y in _middle(found, region):
                axes.text(
                    x, y, LETTERS[number], ha="center", va="center", fontsize=13, fontweight="bold", zorder=6,
                    bbox={"boxstyle": "circle,pad=0.15", "facecolor": "white", "edgecolor": INK, "linewidth": 0.8},
                )  # fmt: skip
    left, right, bottom, top = *_ends(found.x), *_ends(found.y)
    axes.imshow(
        colours,
        extent=(left, right, bottom, top),
        origin="lower",
        aspect="auto",
        interpolation="nearest",
        zorder=1,
    )
    if found.fails.any():
        axes.contourf(
            found.x, found.y, found.fails.astype(float), levels=[0.5, 1.5], colors="none", hatches=["////"], zorder=2
        ).set_edgecolor("white")  # fmt: skip


def _contours(axes: "Axes", found: "RegionMap") -> None:
    margin = np.ma.masked_invalid(np.where(found.fails, np.nan, found.margin))
    if margin.count() and margin.max() > LEVELS[0] > 0:
        lines = axes.contour(
            found.x, found.y, margin, levels=LEVELS, colors=[INK], linewidths=0.6, alpha=0.6, zorder=3
        )
        axes.clabel(lines, fmt="%d %%", fontsize=7)
    distance = np.ma.masked_invalid(found.distance)
    if found.fails.any() and distance.count() and distance.min() < 0.0 < distance.max():
        axes.contour(found.x, found.y, distance, levels=[0.0], colors=[INK], linewidths=2.4, zorder=4)


def _points(axes: "Axes", found: "RegionMap") -> None:
    size, edge = (5.0, 1.0) if len(found.points) <= FEW_POINTS else (1.6, 0.3)
    for fails, face in ((False, "white"), (True, INK)):
        chosen = [point for point in found.points if not point.failed and point.fails == fails]
        axes.plot(
            [point.x for point in chosen], [point.y for point in chosen], "o", markersize=size, markeredgecolor=INK,
            markeredgewidth=edge, markerfacecolor=face, zorder=5, clip_on=False,
        )  # fmt: skip
    failed = [point for point in found.points if point.failed]
    axes.plot([point.x for point in failed], [point.y for point in failed], "x", color=INK, markersize=9,
              markeredgewidth=2.2, zorder=5, clip_on=False)  # fmt: skip


def _explain(
    axes: "Axes", found: "RegionMap", table: "MarginTable", legend: Sequence[int], *, width: int
) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: list[tuple[object, str]] = [
        (
            Patch(facecolor=_key_colour(SERIES[number]), edgecolor=INK, linewidth=0.6),
            plain(fill(f"{LETTERS[number]}  {table.checks[column].title}", width)),
        )
        for number, column in enumerate(legend)
    ]
    others = len(np.setdiff1d(np.unique(found.limiting[found.limiting >= 0]), legend))
    if others:
        entries.append((Patch(facecolor=_key_colour(MUTED)), f"{others} other checks"))
    if found.fails.any():
        entries.append(
            (Patch(facecolor=GRID, edgecolor="white", hatch="////"), "hatched: it fails; plain: all pass")
        )
    dot: dict[str, Any] = {"linestyle": "none", "marker": "o", "markeredgecolor": INK, "markersize": 5}
    if any(not point.fails and not point.failed for point in found.points):
        entries.append((Line2D([], [], markerfacecolor="white", **dot), "computed, passes"))
    if any(point.fails and not point.failed for point in found.points):
        entries.append((Line2D([], [], markerfacecolor=INK, **dot), "computed, fails"))
    if any(point.failed for point in found.points):
        cross = Line2D([], [], linestyle="none", marker="x", color=INK, markersize=8, markeredgewidth=2.0)
        entries.append((cross, "no result"))
    if found.fails.any() and not found.fails.all():
        entries.append((Line2D([], [], color=INK, linewidth=2.4), "zero margin"))
    axes.legend(*zip(*entries, strict=True), loc="upper left", bbox_to_anchor=(1.02, 1.02), borderaxespad=0.0)


def _middle(found: "RegionMap", region: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """The place in each piece of a region farthest from its border, for its letter; none in slivers."""
    from scipy.ndimage import distance_transform_edt, label

    pieces, count = label(region)
    places = []
    for piece in range(1, count + 1):
        inside = pieces == piece
        if inside.mean() < LEAST_REGION:
            continue
        depth = distance_transform_edt(np.pad(inside, 1))[1:-1, 1:-1]
        row, column = np.unravel_index(int(np.argmax(depth)), depth.shape)
        places.append((float(found.x[column]), float(found.y[row])))
    return places


def _ends(fine: NDArray[np.float64]) -> tuple[float, float]:
    half = 0.5 * float(fine[1] - fine[0])
    return float(fine[0]) - half, float(fine[-1]) + half


def _tinted(colour: tuple[float, ...], tint: float) -> NDArray[np.float64]:
    return 1.0 - tint * (1.0 - np.asarray(colour))


def _key_colour(colour: str) -> str:
    from matplotlib.colors import to_hex, to_rgb

    red, green, blue = (float(part) for part in _tinted(to_rgb(colour), 0.45))
    return to_hex((red, green, blue))


# Figures of sampled designs: margins over each input, tornado bars, Sobol indices.

SAMPLE_WIDTH = 5.2
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
    figure = new_figure(height, SAMPLE_WIDTH)
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
    figure = new_figure(height, SAMPLE_WIDTH)
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
    width = (TORNADO_RIGHT - TORNADO_LEFT) * SAMPLE_WIDTH * 72.0
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
    figure = new_figure(height, SAMPLE_WIDTH)
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
