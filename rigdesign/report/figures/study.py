"""Figures of a study over one input: how much of every limit is left."""

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import (
    SHORT_LABEL,
    input_axis,
    legend_right,
    margin_axis,
    mark_failed,
    new_figure,
    plain,
)
from rigdesign.report.palette import GRID, INK, MUTED, SERIES, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rigdesign.report.margins.passing_range import PassRange, StudyAnswer
    from rigdesign.report.margins.regions import RegionMap
    from rigdesign.report.margins.table import MarginTable, StudyAxis

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
