"""Heat of the whole rig by source and sink."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, new_figure, words
from rigdesign.report.numbers import quantity_text
from rigdesign.report.palette import INK, SERIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SINKS = {
    "oil_W": "into the oil",
    "room_W": "to the room",
    "water_W": "cooling water",
    "stored_W": "stored",
    "no_heat_W": "no heat (mesh damper)",
}

LEAST_SHARE = 1e-5
"""Of all heat, from which a sink is drawn."""


def rig_heat_figure(row: Mapping[str, Any]) -> "Figure":
    """Heat of every source at one stage [kW], divided by its sinks; to the left what is taken from there.

    row : of ``RunResult.rig_heat``
    """
    sources = [source for source in row["sources"] if any(source[sink] for sink in SINKS)]
    height = 0.8 + 0.27 * len(sources)
    figure = new_figure(height)
    axes = figure.subplots()
    given, taken = [0.0] * len(sources), [0.0] * len(sources)
    visible = LEAST_SHARE * sum(abs(source[sink]) for source in sources for sink in SINKS)
    for number, (sink, text) in enumerate(SINKS.items()):
        values = [1e-3 * source[sink] for source in sources]
        if not any(abs(source[sink]) > visible for source in sources):
            continue
        left = [given[i] if value >= 0.0 else taken[i] for i, value in enumerate(values)]
        axes.barh(
            range(len(sources)), values, left=left, color=SERIES[number % len(SERIES)], height=0.65, label=text,
            edgecolor="white", linewidth=0.6,
        )  # fmt: skip
        given = [start + max(value, 0.0) for start, value in zip(given, values, strict=True)]
        taken = [start + min(value, 0.0) for start, value in zip(taken, values, strict=True)]
    for place, (source, end) in enumerate(zip(sources, given, strict=True)):
        axes.annotate(
            quantity_text(source["power_W"], "W", digits=3), (end, place), textcoords="offset points", xytext=(4, -3),
            fontsize=8,
        )  # fmt: skip
    axes.axvline(0.0, color=INK, linewidth=0.6)
    axes.set_yticks(
        range(len(sources)), [words(f"{source['kind']} {source['source']}") for source in sources]
    )
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlim(1.05 * min(taken), 1.12 * max(given))
    finish(axes, f"heat at stage {words(str(row['stage']))} [kW]")
    axes.legend(loc="best")
    figure.subplots_adjust(left=0.26, right=0.975, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure
