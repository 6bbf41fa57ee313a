"""Figures of the validation page: deviations over what is allowed, computed over published numbers."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, get_args

import numpy as np

from rigdesign.report.figures.drawing import finish, new_figure, plain
from rigdesign.report.palette import INK, MUTED, VERDICT_COLOURS, curve_style
from rigdesign.validation import Basis, ValidationRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROW_HEIGHT = 0.125
"""Height of a row of the first figure [in]."""
LEAST_BAND = 0.36
"""Height of a basis with few rows [in]."""
LINEAR_TO = 1.5
"""Share of the tolerance up to which the scale is linear."""
PANEL = 3.3
"""Side of a plot of one source [in]."""


def share_of_tolerance(row: ValidationRow) -> float | None:
    """Deviation over what is allowed, -1 to 1 within it; in a window from its middle. None without a limit."""
    if row.window is not None and row.computed is not None:
        low, high = row.window
        if np.isinf(low) and np.isinf(high):
            return None
        if np.isinf(low) or np.isinf(high):
            return _open_window(row.computed, low, high)
        return (
            (2.0 * row.computed - low - high) / (high - low)
            if high > low
            else float(row.computed != low) * 2.0
        )
    if row.tolerance is None or row.deviation is None:
        return None
    if row.tolerance == 0.0:
        return 0.0 if row.deviation == 0.0 else float(np.sign(row.deviation)) * 2.0
    return row.deviation / row.tolerance


def _open_window(computed: float, low: float, high: float) -> float:
    """Of a limit on one side: how much of it is used up, above 1 beyond it."""
    limit, upper = (high, True) if np.isinf(low) else (low, False)
    if limit == 0.0 or computed == 0.0 or (computed > 0) != (limit > 0):
        return 0.0 if (computed <= limit) == upper else 2.0
    used = computed / limit if upper == (limit > 0) else limit / computed
    return used if upper else -used


def deviation_figure(rows: Sequence[ValidationRow]) -> "Figure | None":
    """Deviation of every row over what is allowed, by basis; None where no row has a limit."""
    bands = {basis: _shares(rows, basis) for basis in get_args(Basis)}
    bands = {basis: found for basis, found in bands.items() if found}
    if not bands:
        return None
    heights = [max(LEAST_BAND, ROW_HEIGHT * len(found)) for found in bands.values()]
    height = sum(heights) + 1.15
    figure = new_figure(height)
    panels = figure.subplots(len(bands), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    largest = max(abs(share) for found in bands.values() for share, _ in found)
    for axes, (basis, found) in zip(panels, bands.items(), strict=True):
        _band(axes, basis, found)
        axes.set_xscale("symlog", linthresh=LINEAR_TO, linscale=2.0)
        end = max(LINEAR_TO, 1.25 * largest)
        axes.set_xlim(-end, end)
    ticks = [tick for tick in (1, 2, 5, 10, 100, 1000) if tick <= max(LINEAR_TO, 1.25 * largest)]
    places = [*(-tick for tick in reversed(ticks)), -0.5, 0, 0.5, *ticks]
    panels[-1].set_xticks(places, [f"{place:g}".replace("-", "\u2212") for place in places])
    panels[-1].minorticks_off()
    panels[-1].set_xlabel("deviation over what is allowed; ±1: at the limit")
    _key(figure, height)
    figure.subplots_adjust(left=0.125, right=0.985, top=1 - 0.42 / height, bottom=0.5 / height, hspace=0.12)
    return figure


def _shares(rows: Sequence[ValidationRow], basis: str) -> list[tuple[float, ValidationRow]]:
    """Rows of a basis with a limit, the farthest off first."""
    found = [(share_of_tolerance(row), row) for row in rows if row.basis == basis]
    known = [(share, row) for share, row in found if share is not None]
    return sorted(known, key=lambda item: -abs(item[0]))


def _band(axes: "Axes", basis: str, found: Sequence[tuple[float, ValidationRow]]) -> None:
    axes.axvspan(-1.0, 1.0, color=VERDICT_COLOURS["pass"], alpha=0.08, linewidth=0)
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color=VERDICT_COLOURS["pass"], linewidth=1.0)
    axes.axvline(0.0, color=MUTED, linewidth=0.7)
    for place, (share, row) in enumerate(found):
        axes.plot([0.0, share], [place, place], color=MUTED, linewidth=0.6, zorder=2)
        missed = row.verdict.endswith("missed")
        axes.plot(
            [share], [place], marker="X" if missed else "o" if row.verdict.startswith("gate") else "D",
            color=VERDICT_COLOURS["fail" if missed else "pass"], markersize=6 if missed else 3.6, zorder=3,
        )  # fmt: skip
        if missed:
            axes.annotate(
                plain(row.id), (share, place), xytext=(-7 if share > 0 else 7, 0), textcoords="offset points",
                ha="right" if share > 0 else "left", va="center", fontsize=7, fontweight="bold", color=INK, zorder=5,
                bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.85},
            )  # fmt: skip
    axes.set_ylim(len(found) - 0.3, -0.7)
    axes.set_yticks([])
    axes.grid(axis="y", visible=False)
    axes.set_ylabel(f"{basis}\n({len(found)})", rotation=0, ha="right", va="center")


def _key(figure: "Figure", height: float) -> None:
    from matplotlib.lines import Line2D

    marks = (("o", "pass", "gate held"), ("D", "pass", "goal met"), ("X", "fail", "missed, with its id"))
    handles = [
        Line2D([], [], linestyle="none", marker=marker, color=VERDICT_COLOURS[verdict], label=label)
        for marker, verdict, label in marks
    ]
    figure.legend(handles=handles, loc="upper left", ncols=3, bbox_to_anchor=(0.1, 1.0 - 0.08 / height),
                  borderaxespad=0.0)  # fmt: skip


def source_figure(source: str, rows: Sequence[ValidationRow]) -> "Figure | None":
    """Computed over published numbers of one source, both logarithmic; None where none can be drawn."""
    pairs = _positive(rows)
    if not pairs:
        return None
    figure = new_figure(PANEL, PANEL)
    axes = figure.subplots()
    for number, (label, chosen) in enumerate(_by_verdict([row for _, _, row in pairs]).items()):
        style, missed = curve_style(number), label == "missed"
        axes.plot(
            [x for x, _, row in pairs if row in chosen], [y for _, y, row in pairs if row in chosen],
            marker="X" if missed else style.marker, color=VERDICT_COLOURS["fail"] if missed else style.colour,
            linestyle="none", markersize=6 if missed else 4, alpha=0.85, label=label,
        )  # fmt: skip
    values = [value for x, y, _ in pairs for value in (x, y)]
    low, high = min(values) / 2.0, max(values) * 2.0
    axes.plot([low, high], [low, high], color=MUTED, linewidth=0.9, zorder=1)
    axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high))
    axes.minorticks_off()
    axes.legend(loc="lower right", handletextpad=0.2, borderaxespad=0.2)
    finish(axes, "published", "computed", f"{plain(source)} ({len(pairs)})")
    figure.subplots_adjust(left=0.2, right=0.97, top=0.92, bottom=0.15)
    return figure


def _positive(rows: Sequence[ValidationRow]) -> list[tuple[float, float, ValidationRow]]:
    """Published and computed numbers of the rows that have both above zero."""
    pairs = []
    for row in rows:
        published, computed = published_number(row), row.computed
        if published is not None and computed is not None and min(published, computed) > 0.0:
            pairs.append((published, computed, row))
    return pairs


def _by_verdict(rows: Sequence[ValidationRow]) -> dict[str, list[ValidationRow]]:
    """Rows that meet their limit, that have none, that miss it."""
    named = {
        "within its limit": [row for row in rows if row.verdict in ("gate held", "goal met")],
        "shown": [row for row in rows if row.verdict == "shown"],
        "missed": [row for row in rows if row.verdict.endswith("missed")],
    }
    return {label: chosen for label, chosen in named.items() if chosen}


def published_number(row: ValidationRow) -> float | None:
    """The published number, of a range its nearer end or the computed number within it."""
    if isinstance(row.published, tuple):
        low, high = row.published
        return None if row.computed is None else min(max(row.computed, low), high)
    return row.published
