"""The plot of a study: how much of every limit is left over the varied input."""

from collections.abc import Iterable, Sequence
from itertools import product
from math import isnan, nan
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, plain
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import GRID, INK, SERIES, VERDICT_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rigdesign.studies.grid import Variation
    from rigdesign.studies.result import StudyPoint

NAMED_CURVES = 8
"""Checks drawn in colour with their name: those that move and come nearest to their limit or break it."""
LEAST_MOVE = 0.05
"""Change of a margin over the study from which it counts as moved [% of the limit]."""
FLOOR = -100.0
"""Lowest margin drawn [% of the limit]."""


def study_figure(variations: "Sequence[Variation]", points: "Sequence[StudyPoint]") -> "Figure | None":
    """Margin of every check in percent of its limit over the first varied input; None if no point is done, or
    for ranges.

    With one varied input a curve per check; with several the smallest margin of all checks, a curve per
    combination of the others.
    """
    if all(point.failed for point in points) or any(variation.distribution for variation in variations):
        return None
    figure = new_figure(4.0)
    axes = figure.subplots()
    first = variations[0]
    numbers = first.numbers()
    positions = numbers[0] if numbers else [float(n) for n in range(len(first.values))]
    if len(variations) == 1:
        _curves_of_checks(axes, positions, points)
    else:
        _curves_of_minimum(axes, positions, variations, points)
    _failed_points(axes, positions, first, points)
    axes.axhline(0, color=INK, linewidth=1.2)
    low = min(axes.get_ylim()[0], 0.0)
    axes.axhspan(min(low, FLOOR), 0, color=VERDICT_COLOURS["fail"], alpha=0.06, linewidth=0)
    axes.set_ylim(bottom=max(low, FLOOR), top=100)
    if numbers is None:
        axes.set_xticks(positions, [plain(value) for value in first.values])
    unit = f" [{unit_text(numbers[1])}]" if numbers and numbers[1] else ""
    finish(axes, f"{plain(first.path)}{unit}", "margin, 1 − utilisation [% of the limit]")
    legend_right(axes)
    figure.subplots_adjust(left=0.08, right=0.68, top=0.93, bottom=0.12)
    return figure


def _curves_of_checks(axes: "Axes", positions: list[float], points: "Sequence[StudyPoint]") -> None:
    curves: dict[str, dict[float, float]] = {}
    titles: dict[str, str] = {}
    for x, point in zip(positions, points, strict=True):
        for check in point.record.get("checks", ()):
            if check["utilisation"] is not None:
                curve = curves.setdefault(check["id"], dict.fromkeys(positions, nan))
                curve[x] = _margin(check["utilisation"])
                titles[check["id"]] = check["title"]
    nearest = sorted(
        curves, key=lambda identity: (not _moves(curves[identity]), _lowest(curves[identity].values()))
    )
    for identity in nearest[NAMED_CURVES:]:
        axes.plot(*zip(*curves[identity].items(), strict=True), color=GRID, linewidth=1.0, zorder=1.5)
    for colour, identity in zip(SERIES, nearest[:NAMED_CURVES], strict=False):
        axes.plot(
            *zip(*curves[identity].items(), strict=True),
            "o-",
            color=colour,
            markersize=3.5,
            label=_label(titles[identity]),
        )
    if len(nearest) > NAMED_CURVES:
        axes.plot(
            [],
            [],
            color=GRID,
            label=f"{len(nearest) - NAMED_CURVES} checks with more margin or none that moves",
        )


def _moves(curve: dict[float, float]) -> bool:
    """Whether the margin changes over the study; a rule the input does not touch is no news."""
    known = [value for value in curve.values() if not isnan(value)]
    return len(known) > 1 and max(known) - min(known) > LEAST_MOVE


def _curves_of_minimum(
    axes: "Axes", positions: list[float], variations: "Sequence[Variation]", points: "Sequence[StudyPoint]"
) -> None:
    others = list(product(*(variation.values for variation in variations[1:])))
    for number, combination in enumerate(others):
        margins = [_smallest(point) for point in points[number :: len(others)]]
        colour = SERIES[number] if number < len(SERIES) else GRID
        label = _label(", ".join(combination)) if number < len(SERIES) else None
        axes.plot(positions, margins, "o-", markersize=3.5, color=colour, label=label)
    names = ", ".join(variation.path for variation in variations[1:])
    axes.set_title(f"Smallest margin of all checks; curves: {plain(names)}")


def _failed_points(
    axes: "Axes", positions: list[float], first: "Variation", points: "Sequence[StudyPoint]"
) -> None:
    places = dict(zip(first.values, positions, strict=True))
    failed = sorted({places[point.values[first.path]] for point in points if point.failed})
    if failed:
        axes.plot(failed, [0.0] * len(failed), "x", color=VERDICT_COLOURS["fail"], markersize=7,
                  label="a point without result")  # fmt: skip


def _smallest(point: "StudyPoint") -> float:
    """Smallest margin of a point; NaN, a gap in the curve, where there is none."""
    checks = point.record.get("checks", ())
    return _lowest(_margin(check["utilisation"]) for check in checks if check["utilisation"] is not None)


def _lowest(margins: Iterable[float]) -> float:
    return min((margin for margin in margins if not isnan(margin)), default=nan)


def _margin(utilisation: float) -> float:
    return 100.0 * (1.0 - utilisation)


def _label(text: str) -> str:
    from textwrap import fill

    return plain(fill(text, 38))
