"""Figures of the drivetrain: K_V(n), root stress over the mesh."""

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from rigdesign.report.figures.drawing import (
    finish,
    gearbox_title,
    legend_right,
    new_figure,
    stated_quantity,
    words,
)
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import (
    INK,
    LINES,
    MUTED,
    VERDICT_COLOURS,
    CurveStyle,
    curve_style,
    gearbox_colours,
)
from rigdesign.results.dynamics import DynamicFactorPoint, DynamicsResult, GearboxDynamics, RampHistory
from rigdesign.results.loads import RootStressRatio
from rigdesign.results.quantity import value_in_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KV = "K_V"
SIGMA_F = "σ_F"


def dynamic_factor_figure(dynamics: DynamicsResult) -> "Figure":
    """K_V(n) of every gearbox: simulated max/mean, half peak-to-peak, ISO 6336-1 method B."""
    count = len(dynamics.gearboxes)
    figure = new_figure(0.4 + 2.6 * count)
    axes_list = figure.subplots(count, 1, squeeze=False)[:, 0]
    styles = gearbox_colours(dynamics.gearboxes)
    for axes, (name, gearbox) in zip(axes_list, dynamics.gearboxes.items(), strict=True):
        _dynamic_factor(axes, gearbox, styles[name], len(styles))
        finish(axes, "pinion speed n [rpm]", f"dynamic factor {KV} [–]")
        gearbox_title(axes, f"Gearbox {words(name)} ({gearbox.role})", styles[name])
        legend_right(axes)
    _margins(figure, count, right=0.72)
    return figure


def _dynamic_factor(axes: "Axes", gearbox: GearboxDynamics, style: CurveStyle, others_from: int) -> None:
    """One gearbox; others_from : number of the style of the first curve at another torque."""
    torque = stated_quantity(gearbox.torque)
    points = gearbox.dynamic_factor
    speed = [point.speed_rpm for point in points]
    main = _with_gaps(gearbox, gearbox.torque, points)
    axes.plot(
        [p.speed_rpm for p in main],
        [p.simulated for p in main],
        **style.drawn,
        label=f"simulated at {torque}, max / mean",
        zorder=4,
    )
    axes.plot(
        [p.speed_rpm for p in main],
        [p.simulated_half_peak_to_peak for p in main],
        color=style.colour,
        linewidth=0.8,
        linestyle=LINES[2],
        label="simulated, 1 + half\npeak-to-peak / mean",
    )
    for number, (key, curve) in enumerate(gearbox.dynamic_factor_at.items(), start=others_from):
        shown = _with_gaps(gearbox, key, curve)
        axes.plot(
            [point.speed_rpm for point in shown],
            [point.simulated for point in shown],
            **curve_style(number).drawn,
            linewidth=0.9,
            label=f"simulated at {stated_quantity(key)}, max / mean",
        )
    axes.plot(
        speed,
        [p.iso_6336_1_method_b for p in points],
        color=INK,
        linewidth=1.5,
        label="ISO 6336-1:2006 method B",
    )
    dangerous = [
        value_in_unit(item, "speed")
        for item in gearbox.resonances
        if item.dangerous and item.torque == gearbox.torque
    ]
    if dangerous and points:
        heights = np.interp(dangerous, speed, [p.simulated for p in points])
        axes.plot(
            dangerous,
            heights,
            "o",
            color=VERDICT_COLOURS["fail"],
            markersize=4,
            label="dangerous resonance",
            zorder=5,
        )
    axes.set_xlim(left=0)


def _with_gaps(
    gearbox: GearboxDynamics, curve: str, points: list[DynamicFactorPoint]
) -> list[DynamicFactorPoint]:
    """The points with one without value at every speed that has no solution, so that no line is drawn over it."""
    nothing = float("nan")
    holes = [
        DynamicFactorPoint(
            speed_rpm=value_in_unit(hole, "speed"),
            simulated=nothing,
            simulated_half_peak_to_peak=nothing,
            iso_6336_1_method_b=nothing,
        )
        for hole in gearbox.unsolved
        if hole.curve == curve
    ]
    return sorted([*points, *holes], key=lambda point: point.speed_rpm)


def root_stress_figure(gearbox: GearboxDynamics, style: CurveStyle | None = None) -> "Figure":
    """sigma_F over the rolling angle, dynamic against quasi-static, and the stress ratio over speed.

    style : of the gearbox in all figures of the report; that of the first gearbox if left out
    """
    style = style or curve_style(0)
    histories = gearbox.root_stress
    columns = len(histories) + bool(gearbox.root_stress_factor)
    figure = new_figure(2.9)
    axes_list = list(figure.subplots(1, columns, squeeze=False)[0])
    for axes, history in zip(axes_list, histories, strict=False):
        angle = history.rolling_angle_deg
        axes.plot(angle, history.quasi_static_MPa, color=INK, linewidth=0.9, label="quasi-static")
        axes.plot(angle, history.dynamic_MPa, **style.drawn, label="dynamic")
        axes.set_ylim(bottom=0)
        finish(axes, "rolling angle φ [°]", f"root stress {SIGMA_F}(φ), 0-peak [N/mm²]")
        gearbox_title(axes, f"{words(history.gear).capitalize()}, stage {words(history.stage)}", style)
        axes.legend(loc="best")
    if gearbox.root_stress_factor:
        _stress_ratio(axes_list[-1], gearbox.root_stress_factor, gearbox.dynamic_factor, style)
    figure.subplots_adjust(left=0.075, right=0.985, top=0.90, bottom=0.17, wspace=0.3)
    return figure


def _stress_ratio(
    axes: "Axes", ratios: Sequence[RootStressRatio], points: list[DynamicFactorPoint], style: CurveStyle
) -> None:
    speed = [value_in_unit(ratio, "speed") for ratio in ratios]
    axes.plot(
        [p.speed_rpm for p in points], [p.simulated for p in points], color=MUTED, linewidth=0.9, label=KV
    )
    for line, colour, gear in zip(LINES, (style.colour, INK), ("pinion", "wheel"), strict=False):
        values = [getattr(ratio, gear) for ratio in ratios]
        axes.plot(speed, values, color=colour, linestyle=line, label=f"{SIGMA_F} ratio, {words(gear)}")
    axes.set_xlim(left=0)
    axes.locator_params(axis="x", nbins=4)
    finish(
        axes,
        "pinion speed n [rpm]",
        f"max {SIGMA_F} dynamic / quasi-static [–]",
        f"Stress ratio and {KV}(n)",
    )
    axes.legend(loc="best")


def _margins(figure: "Figure", rows: int, right: float) -> None:
    height = figure.get_figheight()
    figure.subplots_adjust(
        left=0.075, right=right, top=1 - 0.28 / height, bottom=0.45 / height, hspace=0.16 + 0.17 * rows
    )


# The run-up on one time axis: speed, torques, dynamic torque of every gearbox.

MAX_POINTS = 900
"""Points drawn of one curve; an envelope keeps the extremes of the windows it merges."""


def ramp_figure(ramp: RampHistory) -> "Figure":
    """Speed, target and drive torque, and the envelope of the dynamic torque in each gearbox over time."""
    rows = 2 + len(ramp.torque)
    height = 0.75 + 1.55 * rows
    figure = new_figure(height)
    axes_list = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    step = max(1, -(-len(ramp.time_s) // MAX_POINTS))
    _speed(axes_list[0], ramp, step)
    _torque(axes_list[1], ramp, step)
    styles = gearbox_colours(ramp.torque)
    for axes, (name, curves) in zip(axes_list[2:], ramp.torque.items(), strict=True):
        _envelope(axes, ramp, curves, styles[name], step)
        gearbox_title(
            axes, f"Dynamic torque in gearbox {words(name)}, extremes of every envelope window", styles[name]
        )
    for axes in axes_list:
        _stage_bands(axes, ramp)
        axes.yaxis.set_label_coords(-0.052, 0.5)
    _stage_names(axes_list[0], ramp)
    axes_list[-1].set_xlabel("time [s]")
    axes_list[-1].set_xlim(ramp.time_s[0], ramp.time_s[-1])
    figure.subplots_adjust(left=0.085, right=0.985, top=1 - 0.52 / height, bottom=0.45 / height, hspace=0.32)
    return figure


def _speed(axes: "Axes", ramp: RampHistory, step: int) -> None:
    axes.plot(ramp.time_s[::step], ramp.speed_rpm[::step], color=INK)
    finish(axes, ylabel="pinion speed\nn [rpm]")


def _torque(axes: "Axes", ramp: RampHistory, step: int) -> None:
    time = ramp.time_s[::step]
    axes.plot(time, ramp.target_torque_Nm[::step], color=INK, label="bracing torque, target")
    drive = curve_style(len(ramp.torque))
    axes.plot(time, ramp.drive_torque_Nm[::step], **drive.drawn, label="drive torque")
    finish(axes, ylabel=f"torque, mean\n[{unit_text('Nm')}]")
    axes.legend(loc="upper left", ncols=2)


def _envelope(
    axes: "Axes", ramp: RampHistory, curves: dict[str, list[float]], style: CurveStyle, step: int
) -> None:
    time = ramp.time_s[::step]
    low = [min(curves["minimum"][i : i + step]) for i in range(0, len(ramp.time_s), step)]
    high = [max(curves["maximum"][i : i + step]) for i in range(0, len(ramp.time_s), step)]
    colour = style.colour
    axes.fill_between(time, low, high, color=colour, alpha=0.28, linewidth=0, label="maximum to minimum")
    axes.plot(time, high, color=colour, linewidth=0.6)
    axes.plot(time, low, color=colour, linewidth=0.6)
    axes.plot(time, curves["mean"][::step], color=INK, linewidth=1.0, label="mean")
    axes.axhline(0, color=MUTED, linewidth=0.8)
    finish(axes, ylabel=f"torque, 0-peak\n[{unit_text('Nm')}]")
    axes.legend(loc="upper left", ncols=2)


def stage_spans(ramp: RampHistory) -> list[tuple[str, float, float]]:
    """Stages in their order: name, start and end [s]."""
    spans = []
    for name, members in groupby(range(len(ramp.stage)), key=lambda index: ramp.stage[index]):
        indices = list(members)
        end = min(indices[-1] + 1, len(ramp.time_s) - 1)
        spans.append((name, ramp.time_s[indices[0]], ramp.time_s[end]))
    return spans


def _stage_bands(axes: "Axes", ramp: RampHistory) -> None:
    for number, (_, start, end) in enumerate(stage_spans(ramp)):
        if number % 2:
            axes.axvspan(start, end, color="#eef1f4", linewidth=0, zorder=0)


def _stage_names(axes: "Axes", ramp: RampHistory) -> None:
    """Stage names over the top plot, on two levels so that short stages stay legible."""
    for number, (name, start, end) in enumerate(stage_spans(ramp)):
        axes.annotate(
            words(name),
            ((start + end) / 2, 1.0),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            xytext=(0, 4 + 11 * (number % 2)),
            ha="center",
            fontsize=8,
        )
