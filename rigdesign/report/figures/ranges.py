"""Figures of the ranges: how far every check and the highest temperature move."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import finish, new_figure, plain
from rigdesign.report.palette import COLD, INK, MUTED, VERDICT_COLOURS, WARM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rigdesign.results.ranges import CheckRange, RangedInput, RangesResult

FLOOR = -50.0
"""Lowest margin drawn [% of the limit]."""
MOST_ROWS = 15
"""Inputs drawn in the figure of the highest temperature."""
LEAST_SHIFT = 0.1
"""Shift of the highest temperature below which an input is not drawn [K]."""
LEAST_SPAN = 0.1
"""Range of a margin below which a check is not drawn [% of the limit]."""


def margins_figure(ranges: "RangesResult", titles: dict[str, str]) -> "Figure | None":
    """Margin of every check that moves, from the worst to the best end of any one input [% of the limit].

    titles : title of every check by its id. None if no check moves.
    """
    rows = sorted(
        (row for row in ranges.checks if _span(row) > LEAST_SPAN),
        key=lambda row: 1.0 if row.worst_distance is None else row.worst_distance,
    )
    if not rows:
        return None
    height = 0.8 + 0.3 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    for place, row in enumerate(rows):
        low, stated, high = (_left(u) for u in (row.worst_distance, row.distance, row.best_distance))
        colour = VERDICT_COLOURS[row.verdict]
        axes.plot([low, high], [place, place], color=colour, linewidth=5, solid_capstyle="butt", alpha=0.75)
        axes.plot([stated], [place], "|", color=INK, markersize=11, markeredgewidth=1.6)
        if row.worst_path is not None:
            axes.annotate(
                plain(f"{_short(row.worst_path)} = {row.worst_value}"), (max(high, low), place),
                textcoords="offset points", xytext=(6, -3), fontsize=8, color=MUTED,
            )  # fmt: skip
    axes.axvspan(FLOOR, 0.0, color=VERDICT_COLOURS["fail"], alpha=0.06, linewidth=0)
    axes.axvline(0.0, color=INK, linewidth=1.2)
    axes.set_yticks(range(len(rows)), [plain(_wrapped(titles.get(row.check, row.check))) for row in rows])
    axes.set_xlim(max(FLOOR, min(0.0, *(_left(row.worst_distance) for row in rows)) - 2.0), 135.0)
    axes.set_xticks([tick for tick in range(-50, 101, 25) if tick >= axes.get_xlim()[0]])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    finish(axes, "distance to the limit [%]; upright mark: as stated; named: what lowers it most")
    figure.subplots_adjust(left=0.34, right=0.985, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure


def temperature_figure(ranges: "RangesResult") -> "Figure | None":
    """Highest temperature of all housings with one input at either end [degC], the strongest first."""
    hottest = ranges.max_temperature
    if hottest is None:
        return None
    stated = hottest.stated_degC
    rows = _strongest(ranges.inputs, stated)
    if not rows:
        return None
    height = 0.8 + 0.27 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    for place, row in enumerate(rows):
        ends = ((row.max_temperature_low_degC, row.low), (row.max_temperature_high_degC, row.high))
        for temperature, value in ends:
            if temperature is None or abs(temperature - stated) < LEAST_SHIFT:
                continue
            warmer = temperature > stated
            axes.barh(place, temperature - stated, left=stated, color=WARM if warmer else COLD, height=0.62)
            axes.annotate(
                plain(value), (temperature, place), textcoords="offset points", fontsize=8, color=MUTED,
                xytext=(4 if warmer else -4, -3), ha="left" if warmer else "right",
            )  # fmt: skip
    axes.axvline(stated, color=INK, linewidth=1.2)
    axes.margins(x=0.16)
    axes.set_yticks(range(len(rows)), [plain(_short(row.path)) for row in rows])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    finish(axes, f"highest temperature [°C]; as stated {stated:.1f} °C")
    figure.subplots_adjust(left=0.34, right=0.985, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure


def _strongest(inputs: "Sequence[RangedInput]", stated: float) -> "list[RangedInput]":
    def shift(row: "RangedInput") -> float:
        ends = (row.max_temperature_low_degC, row.max_temperature_high_degC)
        return max((abs(value - stated) for value in ends if value is not None), default=0.0)

    return sorted((row for row in inputs if shift(row) > LEAST_SHIFT), key=lambda row: -shift(row))[
        :MOST_ROWS
    ]


def _span(row: "CheckRange") -> float:
    return _left(row.best_distance) - _left(row.worst_distance)


def _left(distance: float | None) -> float:
    """Margin [% of the limit], cut off where the figure ends."""
    return max(FLOOR, 100.0 * (1.0 if distance is None else distance))


def _short(path: str) -> str:
    """A path without its first name, which says little: ``test.oil.flow``."""
    head, _, rest = path.partition(".")
    return rest.replace("_", " ") if head == "gearboxes" else path.replace("_", " ")


def _wrapped(text: str) -> str:
    from textwrap import fill

    return fill(text, 44)
