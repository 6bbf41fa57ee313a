"""Pictures of a diagnosis: residuals before and after, measured against both models, posterior, gap, detectability."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.diagnosis.document.document import kept_features
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.measurement.comparison.compare import series_of
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.prediction.model import Feature
from rigdesign.report.figures.drawing import finish, new_figure, plain
from rigdesign.report.figures.measurement import COLOUR_END
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import GRID, INK, MUTED, SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

MOST_ROWS = 40
"""Series of a map; of more, those with the largest residuals are drawn."""
MOST_SERIES = 6
"""Series whose readings are drawn against both models."""
MOST_BARS = 10
"""Explanations drawn."""
LEAST_BARS = 4
LEAST_POSTERIOR = 0.01
"""Explanations drawn at least, and the posterior from which on more are."""
FARTHEST = 10.0
"""Right end of the detectability picture [bounds]."""
MOST_EFFECTS = 30
"""Effects of the detectability picture."""
FAMILY_COLOURS = {
    "none": MUTED, "physical": SERIES[0], "sensor": SERIES[2], "input": SERIES[4], "unmodelled": SERIES[1],
    "local": SERIES[1], "pair": SERIES[3], "rest": GRID,
}  # fmt: skip
FAMILY_WORDS = {
    "none": "nothing", "physical": "catalogue", "sensor": "sensor or setting", "input": "wrong data",
    "unmodelled": "not in the catalogue", "local": "not in the catalogue", "pair": "two at once", "rest": "the rest",
}  # fmt: skip


def residual_maps(outcome: Outcome) -> "Figure":
    """Residual over the residual of a healthy rig, by series and operating point; before and after where named."""
    from matplotlib.colors import LinearSegmentedColormap

    found = outcome.result.diagnosis
    features = kept_features(outcome)
    spread = np.sqrt(np.diagonal(found.covariance.matrix))
    tables = [_by_series(outcome, features, found.residual / spread)]
    titles = ["model as it is"]
    name, answer = outcome.in_question
    if name:
        tables.append(_by_series(outcome, features, (found.residual - answer) / spread))
        titles = ["before: model as it is", f"after: with {plain(name)}"]
    kept = sorted(tables[0], key=lambda label: -float(np.nanmax(np.abs(tables[0][label]))))[:MOST_ROWS]
    shown = [label for label in tables[0] if label in kept]
    height = 1.25 + 0.17 * len(shown)
    figure = new_figure(height)
    grid = figure.subplots(1, len(tables), sharey=True, squeeze=False)[0]
    colours = LinearSegmentedColormap.from_list("residual", [SERIES[0], "#ffffff", SERIES[1]])
    points = _points(outcome, features)
    for axes, table, title in zip(grid, tables, titles):
        axes.set_facecolor(GRID)
        picture = axes.pcolormesh(
            np.ma.masked_invalid(np.array([table[label] for label in shown])),
            cmap=colours, vmin=-COLOUR_END, vmax=COLOUR_END, edgecolors="white", linewidth=0.5,
        )  # fmt: skip
        axes.set_yticks(np.arange(len(shown)) + 0.5, [plain(label) for label in shown])
        axes.set_xticks(np.arange(len(points)) + 0.5, _labels(outcome, points), rotation=90)
        axes.grid(visible=False)
        axes.tick_params(length=0)
        finish(axes, "", "", title)
    grid[0].invert_yaxis()
    figure.subplots_adjust(left=0.17, right=0.92, top=1 - 0.3 / height, bottom=0.72 / height, wspace=0.05)
    side = figure.add_axes((0.932, 0.72 / height, 0.011, 1 - 1.02 / height))
    bar = figure.colorbar(picture, cax=side, ticks=[-COLOUR_END, 0.0, COLOUR_END])
    bar.set_label("residual / σ", fontsize=7.5)
    return figure


def _points(outcome: Outcome, features: Sequence[Feature]) -> list[str]:
    points = [setting.name for setting in outcome.result.data.settings]
    return [*points, ""] if any(not feature.setting for feature in features) else points


def _labels(outcome: Outcome, points: Sequence[str]) -> list[str]:
    """Names of the points, held-out ones with a star."""
    aside = outcome.result.diagnosis.held_out_points
    return [(plain(name) + (" *" if name in aside else "")) if name else "static tests" for name in points]


def _by_series(outcome: Outcome, features: Sequence[Feature], whitened: Array) -> dict[str, Array]:
    """Series -> value at each point, NaN where none; of a complex order its size."""
    points = _points(outcome, features)
    rows = {}
    for label, chosen in series_of(features).items():
        values = np.full(len(points), np.nan)
        for i in chosen:
            column = points.index(features[i].setting)
            before = 0.0 if np.isnan(values[column]) else values[column]
            values[column] = np.hypot(before, whitened[i]) if features[i].part != "value" else whitened[i]
        rows[label] = values
    return rows


def with_and_without(outcome: Outcome) -> "Figure | None":
    """Measured less simulated of the series that the effects in question move most, without and with them."""
    found = outcome.result.diagnosis
    name, answer = outcome.in_question
    if not name:
        return None
    features = kept_features(outcome)
    moved = (answer / np.sqrt(np.diagonal(found.covariance.matrix))) ** 2
    running = {
        label: rows for label, rows in series_of(features).items() if all(features[i].setting for i in rows)
    }
    chosen = sorted(running, key=lambda label: -float(moved[running[label]].sum()))[:MOST_SERIES]
    chosen = [label for label in chosen if moved[running[label]].sum() > 1e-6]
    if not chosen:
        return None
    columns = 1 if len(chosen) == 1 else 2
    rows = -(-len(chosen) // columns)
    height = 2.35 * rows + 0.35
    figure = new_figure(height)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, label in zip(grid, chosen):
        _draw_series(axes, outcome, features, label, running[label])
    for axes in grid[len(chosen) :]:
        axes.set_visible(False)
    handles, names = grid[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="upper right", ncols=3, bbox_to_anchor=(0.99, 1.0))
    figure.subplots_adjust(
        left=0.075, right=0.99, top=1 - 0.5 / height, bottom=0.45 / height, wspace=0.2, hspace=0.48
    )
    return figure


def _draw_series(
    axes: "Axes", outcome: Outcome, features: Sequence[Feature], label: str, rows: Sequence[int]
) -> None:
    result, found = outcome.result, outcome.result.diagnosis
    residuals = result.problem.residuals
    kept = list(found.kept)
    values, noise = residuals.values[kept], residuals.noise[kept]
    entry = result.data.channels[features[rows[0]].channel]
    kind, unit = CHANNELS[entry.channel.quantity].kind, entry.unit
    points = [setting.name for setting in result.data.settings]
    at = [points.index(name) for name in dict.fromkeys(features[i].setting for i in rows)]
    without = values - found.residual
    effect, answer = outcome.in_question
    measured, before, after = (
        np.array([units.display(value, kind, unit) for value in _sizes(features, rows, numbers)])
        for numbers in (values, without, without + answer)
    )
    scale = abs(units.worth(kind, unit)[0])
    bars = [value / scale for value in _sizes(features, rows, noise, mean=True)]
    for place, name in enumerate(points):
        if name in found.held_out_points:
            axes.axvspan(place - 0.5, place + 0.5, color="#eef1f4", zorder=0, linewidth=0)
    axes.axhline(0.0, color=INK, linewidth=0.7)
    axes.plot(
        at,
        measured - before,
        "o",
        markersize=5,
        markerfacecolor="none",
        color=SERIES[0],
        label="model as it is",
    )
    axes.errorbar(
        at, measured - after, yerr=bars, fmt="o", markersize=3.2, linewidth=0.9, color=SERIES[1],
        label=f"model with {plain(effect)}", zorder=4,
    )  # fmt: skip
    axes.set_xlim(-0.5, len(points) - 0.5)
    axes.set_xticks(range(len(points)), _labels(outcome, points), rotation=90 if len(points) > 9 else 0)
    size = " (size)" if any(features[i].part != "value" for i in rows) else ""
    difference = "K" if kind == "temperature" else unit_text(unit)
    finish(axes, "", f"[{difference}]", plain(label) + size)


def _sizes(
    features: Sequence[Feature], rows: Sequence[int], numbers: Array, *, mean: bool = False
) -> list[float]:
    """One number a point: the value, or the size of a complex order; ``mean``: of two parts their root mean square."""
    found: dict[str, list[float]] = {}
    for i in rows:
        found.setdefault(features[i].setting, []).append(float(numbers[i]))
    if not any(features[i].part != "value" for i in rows):
        return [values[0] for values in found.values()]
    return [
        float(np.linalg.norm(values)) / (len(values) ** 0.5 if mean else 1.0) for values in found.values()
    ]


def posterior_bars(alternatives: Sequence[Mapping[str, Any]]) -> "Figure":
    """Posterior of the best explanations."""
    rows = _leading(alternatives)
    height = 0.75 + 0.27 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    for place, row in enumerate(rows):
        share = 100.0 * row["posterior"]
        axes.barh(place, share, height=0.66, color=FAMILY_COLOURS[row["family"]])
        axes.text(share + 0.8, place, _percent(share), va="center", fontsize=7.5)
    axes.set_yticks(range(len(rows)), [_short(row["label"]) for row in rows])
    axes.invert_yaxis()
    axes.set_xlim(0.0, 108.0)
    axes.grid(visible=False, axis="y")
    axes.tick_params(axis="y", length=0)
    present = dict.fromkeys(row["family"] for row in rows)
    for family in present:
        axes.barh(0, 0, color=FAMILY_COLOURS[family], label=FAMILY_WORDS[family])
    axes.legend(loc="lower right", fontsize=7)
    finish(axes, "posterior probability [%]")
    figure.subplots_adjust(left=0.43, right=0.985, top=1 - 0.08 / height, bottom=0.48 / height)
    return figure


def _leading(alternatives: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The explanations worth a bar, the rest taken together."""
    rows = [
        {
            "label": row["title"] if row["family"] != "pair" else row["explanation"].replace("unknown: ", ""),
            **row,
        }
        for place, row in enumerate(alternatives[:MOST_BARS])
        if place < LEAST_BARS or row["posterior"] >= LEAST_POSTERIOR
    ]
    rest = 1.0 - sum(row["posterior"] for row in rows)
    if rest > 1e-4:
        rows.append({"label": "all others together", "family": "rest", "posterior": rest})
    return rows


def _percent(share: float) -> str:
    if share < 0.1:
        return "< 0.1 %"
    return f"{share:.1f} %" if share < 99.95 else "> 99.9 %"


def _short(text: str, most: int = 62) -> str:
    return plain(text if len(text) <= most else text[: most - 1].rstrip() + "…")


def detectability_figure(rows: Sequence[Mapping[str, Any]]) -> "Figure | None":
    """Smallest size seen and smallest size that can be named, as a share of the physical bound."""
    drawn = [row for row in rows if 0.0 < (row["detectable_share_of_bound"] or 0.0) < FARTHEST][:MOST_EFFECTS]
    if not drawn:
        return None
    height = 0.95 + 0.2 * len(drawn)
    figure = new_figure(height)
    axes = figure.subplots()
    low, high = min(0.1, 0.6 * min(row["detectable_share_of_bound"] for row in drawn)), FARTHEST
    axes.axvspan(1.0, high, color="#f1f3f5", zorder=0, linewidth=0)
    for place, row in enumerate(drawn):
        seen, separable = row["detectable_share_of_bound"], row["isolable_share_of_bound"] or high
        colour = SERIES[0] if row["verdict"] != "not testable here" else MUTED
        axes.plot([seen, min(separable, high)], [place, place], color=colour, linewidth=1.2)
        axes.plot(seen, place, "o", markersize=4.5, markerfacecolor="white", color=colour,
                  label="detectable" if not place else None)  # fmt: skip
        if separable < high:
            axes.plot(
                separable,
                place,
                "o",
                markersize=4.5,
                color=colour,
                label="identifiable" if not place else None,
            )
    axes.axvline(1.0, color=INK, linewidth=0.9)
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    axes.set_ylim(len(drawn) - 0.4, -0.6)
    axes.set_yticks(range(len(drawn)), [_short(row["title"], 52) for row in drawn])
    axes.tick_params(axis="y", length=0)
    axes.legend(loc="lower left", fontsize=7, frameon=True, framealpha=0.9)
    finish(
        axes,
        "smallest size over the physical bound of the effect (right of the line: beyond what is believed)",
    )
    figure.subplots_adjust(left=0.36, right=0.985, top=1 - 0.08 / height, bottom=0.5 / height)
    return figure
