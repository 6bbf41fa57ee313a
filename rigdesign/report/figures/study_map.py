"""A study over two inputs as a map: pass region and limiting check."""

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import new_figure, plain
from rigdesign.report.figures.margin_axes import input_axis
from rigdesign.report.palette import GRID, INK, MUTED, SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rigdesign.report.margins.axis import StudyAxis
    from rigdesign.report.margins.regions import RegionMap
    from rigdesign.report.margins.table import MarginTable

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
