"""Figure of two results: how the margins of the checks moved."""

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import margin_axis, new_figure, plain
from rigdesign.report.palette import INK, MUTED, VERDICT_COLOURS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rigdesign.studies.difference import CheckChange

MOST_ROWS = 24
"""Checks drawn, those that moved most."""
LEAST_CHANGE = 0.001
"""Change of a distance from which a check is drawn."""


def margins_figure(changes: "Sequence[CheckChange]") -> "Figure | None":
    """Margin of every check that moved before (open) and after (filled), the largest change on top; None if none."""
    rows = [row for row in changes if abs(row.distance_change or 0.0) > LEAST_CHANGE]
    rows = sorted(rows, key=lambda row: -abs(row.distance_change or 0.0))[:MOST_ROWS]
    if not rows:
        return None
    height = 1.0 + 0.3 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    ends = []
    for place, row in enumerate(rows):
        before, after = (_percent(side.distance) for side in (row.before, row.after) if side is not None)
        colour = VERDICT_COLOURS.get(row.known.verdict, MUTED)
        flipped = row.change == "flipped"
        axes.plot([before, after], [place, place], color=colour, linewidth=3.2 if flipped else 1.4, zorder=2)
        axes.plot(
            [before], [place], "o", markerfacecolor="white", markeredgecolor=INK, markersize=6, zorder=3
        )
        axes.plot([after], [place], "D" if flipped else "o", color=colour, markersize=7, zorder=4)
        ends += [before, after]
    margin_axis(axes, ends, upright=False)
    axes.set_yticks(range(len(rows)), [plain(fill(row.known.title, 46)) for row in rows], fontsize=7.5)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(axis="y", visible=False)
    figure.subplots_adjust(left=0.36, right=0.985, top=1 - 0.1 / height, bottom=0.62 / height)
    return figure


def _percent(distance: float | None) -> float:
    return 100.0 * (1.0 if distance is None else distance)
