"""Pictures of a comparison: measured against simulated, the map of residuals, residuals over their variable."""

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.measurement.comparison.compare import Comparison, display_residual, series_of
from rigdesign.measurement.comparison.locate import Located, leading_variables
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.prediction.model import ORDER_QUANTITIES
from rigdesign.report.figures.drawing import finish, legend_right, new_figure, plain, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import GRID, INK, MUTED, SERIES, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_ROWS = 60
"""Rows of a map; of more, those with the largest residuals are drawn."""
COLOUR_END = 10.0
"""Whitened residual at which the colours of the map end."""
PANELS = 3
"""Plots next to each other."""
MOST_PANELS = 12
"""Channels and orders whose readings are drawn over the operating points."""
MOST_NAMES = 24
"""Operating points that are named along an axis; of more the number in the table is given."""

AXES = {
    "constant": ("speed", "speed [rpm]"),
    "speed": ("speed", "speed [rpm]"),
    "speed_squared": ("speed", "speed [rpm]"),
    "torque": ("torque", f"torque [{unit_text('Nm')}]"),
    "torque_speed": ("torque_speed", "torque times speed [kW]"),
    "oil_temperature": ("oil_temperature", "oil inlet above ambient, share of the largest"),
    "": ("speed", "speed [rpm]"),
}
"""Leading variable -> what is drawn along the axis."""


def readings_figure(comparison: Comparison) -> "Figure":
    """Measured and simulated numbers over the operating points in one plot per channel; of an order its size.

    Where a healthy set is known, what simulation and healthy set say together is a third curve.
    """
    chosen = _panels(comparison)
    rows = max(-(-len(chosen) // PANELS), 1)
    figure = new_figure(2.3 * rows + 0.45)
    grid = figure.subplots(rows, PANELS, squeeze=False).ravel()
    points = [setting.name for setting in comparison.data.settings]
    for axes, (label, features) in zip(grid, chosen):
        _readings(axes, comparison, label, features)
        names = [plain(name) for name in points] if len(points) <= MOST_NAMES else []
        places = range(len(points)) if names else axes.get_xticks()
        axes.set_xticks(list(places), names or None, rotation=90 if sum(map(len, names)) > 24 else 0)
        axes.set_xlim(-0.5, len(points) - 0.5)
    for axes in grid[len(chosen) :]:
        axes.set_visible(False)
    if chosen:
        handles, labels = grid[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="upper left", ncols=3, bbox_to_anchor=(0.07, 1.0), borderaxespad=0.1
        )
    height = 2.3 * rows + 0.45
    figure.subplots_adjust(
        left=0.08, right=0.99, top=1.0 - 0.5 / height, bottom=0.4 / height, wspace=0.36, hspace=0.55
    )
    return figure


def _panels(comparison: Comparison) -> list[tuple[str, list[int]]]:
    """Channels and orders to draw: of every quantity the one farthest off, then the farthest off of all."""
    data, whitened = comparison.data, np.abs(comparison.whitened)
    series = {
        label: rows
        for label, rows in series_of(data.features).items()
        if data.features[rows[0]].setting and data.usable[rows].any()
    }
    far = sorted(series, key=lambda label: -float(np.nanmax(whitened[series[label]])))
    first = {
        data.channels[data.features[series[label][0]].channel].channel.quantity: label
        for label in reversed(far)
    }
    kept = set([*first.values(), *(label for label in far if label not in first.values())][:MOST_PANELS])
    return [(label, rows) for label, rows in series.items() if label in kept]


def _readings(axes: "Axes", comparison: Comparison, label: str, rows: list[int]) -> None:
    """One channel or order: readings with their bars, the simulation as a curve."""
    data = comparison.data
    entry = data.channels[data.features[rows[0]].channel]
    quantity, unit = entry.channel.quantity, entry.unit
    kind = CHANNELS[quantity].kind
    place = {setting.name: i for i, setting in enumerate(data.settings)}
    x = sorted({place[data.features[i].setting] for i in rows})

    def sizes(values: NDArray[np.float64]) -> list[float]:
        parts: list[list[float]] = [[] for _ in x]
        for i in rows:
            value = values[i] if data.usable[i] else np.nan
            parts[x.index(place[data.features[i].setting])].append(float(value))
        found = (part[0] if len(part) == 1 else math.hypot(*part) for part in parts)
        return [units.display(value, kind, unit) for value in found]

    bars = np.zeros(len(x))
    for i in rows:
        if data.usable[i]:
            size = 2.0 * display_residual(float(comparison.spread[i]), quantity, unit)[0]
            at = x.index(place[data.features[i].setting])
            bars[at] = max(bars[at], size)
    axes.plot(x, sizes(comparison.simulated), "-s", color=SERIES[0], markersize=3.4, markerfacecolor="white",
              linewidth=1.0, label="simulated", zorder=2)  # fmt: skip
    if comparison.healthy is not None:
        axes.plot(x, sizes(comparison.expected), "--", color=SERIES[2], linewidth=1.0,
                  label="simulated, with the residual of the healthy set", zorder=3)  # fmt: skip
    axes.errorbar(x, sizes(data.values), yerr=bars, fmt="o", color=SERIES[1], markersize=3.2, linewidth=0.9,
                  label="measured", zorder=4)  # fmt: skip
    finish(axes, "", f"{quantity.replace('_', ' ')} [{unit_text(unit)}]", plain(label))


def agreement_figure(comparison: Comparison) -> "Figure":
    """Measured over simulated, one plot per quantity; orders by their amplitude parts."""
    data = comparison.data
    quantities = list(dict.fromkeys(entry.channel.quantity for entry in data.channels.values()))
    rows = -(-len(quantities) // PANELS)
    figure = new_figure(2.9 * rows)
    grid = figure.subplots(rows, PANELS, squeeze=False).ravel()
    for axes, quantity in zip(grid, quantities):
        names = [name for name, entry in data.channels.items() if entry.channel.quantity == quantity]
        kind, unit = CHANNELS[quantity].kind, data.channels[names[0]].unit
        for number, name in enumerate(names):
            chosen = [i for i, f in enumerate(data.features) if f.channel == name and data.usable[i]]
            x = [units.display(float(comparison.expected[i]), kind, unit) for i in chosen]
            y = [units.display(float(data.values[i]), kind, unit) for i in chosen]
            axes.plot(x, y, **curve_style(number).marked, markersize=3.4, label=words(name))
        ends = (*axes.get_xlim(), *axes.get_ylim())
        low, high = min(ends), max(ends)
        axes.plot([low, high], [low, high], color=MUTED, linewidth=0.9, zorder=1)
        axes.set_xlim(low, high)
        axes.set_ylim(low, high)
        shown = unit_text(unit)
        said = "simulated" if comparison.healthy is None else "simulated, with the healthy set"
        finish(axes, f"{said} [{shown}]", f"measured [{shown}]", quantity.replace("_", " "))
        if 1 < len(names) <= 8:
            axes.legend(loc="upper left", fontsize=6.5, handletextpad=0.2, borderaxespad=0.2)
    for axes in grid[len(quantities) :]:
        axes.set_visible(False)
    figure.subplots_adjust(
        left=0.07, right=0.99, top=0.93, bottom=0.42 / (2.9 * rows), wspace=0.3, hspace=0.42
    )
    return figure


def residual_map(comparison: Comparison) -> "Figure":
    """Whitened residual by channel (and order) and operating point; of complex orders its size."""
    from matplotlib.colors import LinearSegmentedColormap

    data = comparison.data
    points = [setting.name for setting in data.settings]
    if any(not feature.setting for feature in data.features):
        points.append("")
    whitened = comparison.whitened
    rows = {}
    for label, chosen in series_of(data.features).items():
        values = np.full(len(points), np.nan)
        for i in chosen:
            if data.usable[i]:
                column = points.index(data.features[i].setting)
                complex_part = data.features[i].part != "value"
                before = 0.0 if np.isnan(values[column]) else values[column]
                values[column] = np.hypot(before, whitened[i]) if complex_part else whitened[i]
        if np.isfinite(values).any():
            rows[label] = values
    kept = sorted(rows, key=lambda label: -float(np.nanmax(np.abs(rows[label]))))[:MOST_ROWS]
    shown = {label: values for label, values in rows.items() if label in kept}
    height = 0.9 + 0.17 * len(shown)
    figure = new_figure(height)
    axes = figure.subplots()
    axes.set_facecolor(GRID)
    colours = LinearSegmentedColormap.from_list("residual", [SERIES[0], "#ffffff", SERIES[1]])
    picture = axes.pcolormesh(
        np.ma.masked_invalid(np.array(list(shown.values()))),
        cmap=colours, vmin=-COLOUR_END, vmax=COLOUR_END, edgecolors="white", linewidth=0.5,
    )  # fmt: skip
    axes.set_yticks(np.arange(len(shown)) + 0.5, [plain(label) for label in shown])
    names = [plain(name) if name else "static tests" for name in points]
    axes.set_xticks(np.arange(len(points)) + 0.5, names, rotation=90 if len(points) > 12 else 0)
    axes.invert_yaxis()
    axes.grid(visible=False)
    bar = figure.colorbar(picture, ax=axes, fraction=0.025, pad=0.015)
    bar.set_label("residual / σ")
    finish(axes, "operating point")
    figure.subplots_adjust(left=0.2, right=0.93, top=1 - 0.12 / height, bottom=0.6 / height)
    return figure


def leading_figure(comparison: Comparison, item: Located) -> "Figure | None":
    """Residuals of a group over the variable they go along with; None for numbers of the rig at rest."""
    data = comparison.data
    place = {setting.name: i for i, setting in enumerate(data.settings)}
    rows = [i for i in item.features if data.features[i].setting in place]
    if not rows:
        return None
    key, label = AXES[item.variable]
    variables = leading_variables(data.settings, comparison.measurement.case.ambient.temperature)
    speed = np.array([setting.speed for setting in data.settings])
    torque = np.array([setting.torque for setting in data.settings])
    along = {"speed": speed * 30.0 / np.pi, "torque": torque, "torque_speed": speed * torque / 1e3}.get(
        key, variables["oil_temperature"]
    )
    figure = new_figure(2.6)
    axes = figure.subplots()
    labels = series_of([data.features[i] for i in rows])
    unit = ""
    for number, (name, inner) in enumerate(labels.items()):
        chosen = [rows[i] for i in inner]
        entry = data.channels[data.features[chosen[0]].channel]
        quantity = entry.channel.quantity
        x = [along[place[data.features[i].setting]] for i in chosen]
        y = [display_residual(float(comparison.residual[i]), quantity, entry.unit)[0] for i in chosen]
        bars = [display_residual(float(comparison.spread[i]), quantity, entry.unit)[0] for i in chosen]
        unit = display_residual(0.0, quantity, entry.unit)[1]
        axes.errorbar(
            x, y, yerr=bars, **curve_style(number).marked, markersize=3.4, elinewidth=0.8,
            label=plain(name) if number < 14 else None,
        )  # fmt: skip
    axes.axhline(0.0, color=INK, linewidth=0.9)
    parts = ", real and imaginary parts" if _has_parts(comparison, rows) else ""
    finish(axes, label, f"measured − simulated [{unit_text(unit)}]", plain(item.group) + parts)
    legend_right(axes)
    figure.subplots_adjust(left=0.08, right=0.76, top=0.9, bottom=0.18)
    return figure


def _has_parts(comparison: Comparison, rows: list[int]) -> bool:
    data = comparison.data
    return any(
        data.channels[data.features[i].channel].channel.quantity in ORDER_QUANTITIES
        and data.features[i].part != "value"
        for i in rows
    )
