"""Losses, oil, heat of the whole rig by source and sink, convergence of the coupling loop."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, words
from rigdesign.report.numbers import WORDS, power_text, quantity_text, split_key
from rigdesign.report.palette import COLD, INK, MUTED, SERIES, WARM, curve_style
from rigdesign.results.housing import RigHeat, Sink
from rigdesign.results.quantity import row as shown_row
from rigdesign.results.quantity import value_in_unit
from rigdesign.results.result import CouplingHistory
from rigdesign.results.thermal import LossRow, OilRow
from rigdesign.results.units import KW

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SEPARATED: dict[str, Any] = {"edgecolor": "white", "linewidth": 0.6}
"""Parts of a bar: an edge separates them without their colours."""
SINKS: Mapping[Sink, str] = {
    "oil": "into the oil",
    "room": "to the room",
    "water": "cooling water",
    "stored": "stored",
    "no_heat": "no heat (mesh damper)",
}
LEAST_SHARE = 1e-5
"""Of all heat, from which a sink is drawn."""


def losses_by_stage_figure(losses: list[LossRow]) -> "Figure":
    """Power loss at the end of every stage [W], stacked by kind."""
    stages = list(dict.fromkeys(row.stage for row in losses))
    kinds = list(dict.fromkeys(row.kind for row in losses))
    height = 0.75 + 0.34 * len(stages)
    figure = new_figure(height)
    axes = figure.subplots()
    left = [0.0] * len(stages)
    for number, kind in enumerate(kinds):
        colour = SERIES[number % len(SERIES)]
        power = [
            sum(row.power for row in losses if row.stage == stage and row.kind == kind) for stage in stages
        ]
        axes.barh(
            range(len(stages)), power, left=left, color=colour, height=0.65, label=words(kind), **SEPARATED
        )
        left = [start + width for start, width in zip(left, power, strict=True)]
    for row, total in enumerate(left):
        axes.annotate(
            quantity_text(total, "W", digits=3), (total, row), textcoords="offset points", xytext=(4, -3), fontsize=8
        )  # fmt: skip
    axes.set_yticks(range(len(stages)), [words(stage) for stage in stages])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.1)
    finish(axes, "power loss at the end of the stage [W]")
    legend_right(axes)
    figure.subplots_adjust(left=0.16, right=0.8, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure


def losses_by_place_figure(losses: list[LossRow], stage: str) -> "Figure":
    """Power loss of every place at one stage [W], split into oil and body."""
    rows = sorted((row for row in losses if row.stage == stage), key=lambda row: -row.power)
    height = 0.75 + 0.24 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    places = range(len(rows))
    axes.barh(
        places, [r.into_oil for r in rows], color=SERIES[0], height=0.65, label="into the oil", **SEPARATED
    )
    axes.barh(
        places,
        [r.into_body for r in rows],
        left=[r.into_oil for r in rows],
        color=SERIES[1],
        height=0.65,
        label="into the body",
        **SEPARATED,
    )
    if any(r.not_heat > 0.0 for r in rows):
        heat = [r.into_oil + r.into_body for r in rows]
        axes.barh(
            places,
            [r.not_heat for r in rows],
            left=heat,
            color=SERIES[2],
            height=0.65,
            label="no heat (mesh damper)",
            **SEPARATED,
        )
    axes.set_yticks(places, [words(f"{row.place}, {row.kind}") for row in rows])
    axes.set_xlim(right=1.04 * max((row.power for row in rows), default=1.0))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    finish(axes, f"power loss at stage {words(stage)} [W]")
    axes.legend(loc="lower right")
    figure.subplots_adjust(left=0.32, right=0.975, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure


def oil_figure(oil: list[OilRow], stage: str) -> "Figure":
    """Oil temperature of every consumer at one stage, inlet to outlet [degC]."""
    rows = [row for row in oil if row.stage == stage]
    height = 0.75 + 0.26 * len(rows)
    figure = new_figure(height)
    axes = figure.subplots()
    places = range(len(rows))
    inlets, outlets = ([value_in_unit(row, name) for row in rows] for name in ("inlet", "outlet"))
    for place, ends in enumerate(zip(inlets, outlets, strict=True)):
        axes.plot(ends, [place, place], color=MUTED, linewidth=1.6, zorder=2)
    axes.plot(inlets, places, "o", color=COLD, markersize=5.5, label="inlet")
    axes.plot(outlets, places, "s", color=WARM, markersize=5, label="outlet")
    axes.set_yticks(places, [words(row.consumer) for row in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.margins(x=0.08)
    finish(axes, f"oil temperature at stage {words(stage)}, mixed mean [°C]")
    axes.legend(loc="best")
    figure.subplots_adjust(left=0.26, right=0.975, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure


def convergence_figure(histories: list[CouplingHistory]) -> "Figure":
    """Residuals of the coupling loop by iteration, logarithmic."""
    rows = {history.stage: [shown_row(residual) for residual in history.residuals] for history in histories}
    quantities = list(dict.fromkeys(key for own in rows.values() for values in own for key in values))
    figure = new_figure(2.4)
    axes_list = figure.subplots(1, max(1, len(quantities)), squeeze=False)[0]
    for axes, quantity in zip(axes_list, quantities, strict=False):
        for number, history in enumerate(histories):
            style = curve_style(number)
            own = enumerate(rows[history.stage], start=1)
            values = [(n, residual[quantity]) for n, residual in own if residual[quantity]]
            axes.plot(
                [n for n, _ in values],
                [abs(v) for _, v in values],
                **style.drawn,
                marker=style.marker,
                markersize=3,
                label=words(history.stage),
            )
        if any(residual[quantity] for own in rows.values() for residual in own):
            _logarithmic(axes)
        axes.xaxis.get_major_locator().set_params(integer=True)
        finish(axes, "iteration [–]", *_residual_labels(quantity))
        axes.legend(loc="best")
    figure.subplots_adjust(left=0.085, right=0.985, top=0.88, bottom=0.2, wspace=0.32)
    return figure


def _logarithmic(axes: "Axes") -> None:
    """A logarithmic axis whose ticks are powers of ten, without the search for smaller ones."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(numticks=7))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: power_text(value)))
    axes.yaxis.set_minor_locator(NullLocator())


def _residual_labels(key: str) -> tuple[str, str]:
    """Label of the axis and title."""
    quantity, unit = split_key(key)
    quantity = " ".join(WORDS.get(word, word) for word in quantity.replace(" relative", "").split())
    return f"largest change [{unit or '–'}]", quantity.capitalize()


def rig_heat_figure(heat: RigHeat) -> "Figure":
    """Heat of every source at one stage [kW], divided by its sinks; to the left what is taken from there."""
    sources = [source for source in heat.sources if any(source.sinks.values())]
    height = 0.8 + 0.27 * len(sources)
    figure = new_figure(height)
    axes = figure.subplots()
    given, taken = [0.0] * len(sources), [0.0] * len(sources)
    visible = LEAST_SHARE * sum(abs(power) for source in sources for power in source.sinks.values())
    for number, (sink, text) in enumerate(SINKS.items()):
        values = [KW * source.sinks.get(sink, 0.0) for source in sources]
        if not any(abs(source.sinks.get(sink, 0.0)) > visible for source in sources):
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
            quantity_text(source.power, "W", digits=3), (end, place), textcoords="offset points", xytext=(4, -3),
            fontsize=8,
        )  # fmt: skip
    axes.axvline(0.0, color=INK, linewidth=0.6)
    axes.set_yticks(range(len(sources)), [words(f"{source.kind} {source.name}") for source in sources])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlim(1.05 * min(taken), 1.12 * max(given))
    finish(axes, f"heat at stage {words(heat.stage)} [kW]")
    axes.legend(loc="best")
    figure.subplots_adjust(left=0.26, right=0.975, top=1 - 0.1 / height, bottom=0.47 / height)
    return figure
