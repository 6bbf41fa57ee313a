"""Figures of a study over one input: how much of every limit is left."""

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import legend_right, new_figure, plain
from rigdesign.report.figures.margin_axes import SHORT_LABEL, input_axis, margin_axis, mark_failed
from rigdesign.report.palette import INK, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rigdesign.report.margins.answer import StudyAnswer
    from rigdesign.report.margins.axis import StudyAxis
    from rigdesign.report.margins.passing import PassRange
    from rigdesign.report.margins.table import MarginTable

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
