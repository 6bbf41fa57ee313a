"""The run-up on one time axis: speed, torques, dynamic torque of every gearbox."""

from itertools import groupby
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, MUTED, CurveStyle, curve_style, gearbox_colours
from rigdesign.results.dynamics import RampHistory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
