"""The run-up on one time axis: speed, torques, dynamic torque of every gearbox."""

from itertools import groupby
from typing import TYPE_CHECKING

from rigdesign.report.figures.drawing import finish, new_figure, plain
from rigdesign.report.palette import INK, MUTED, SERIES
from rigdesign.results.dynamics import RampHistory

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MAX_POINTS = 2500
"""Points drawn of one curve; an envelope keeps the extremes of the slots it merges."""


def ramp_figure(ramp: RampHistory) -> "Figure":
    """Speed, target and drive torque, and the envelope of the dynamic torque in each gearbox over time."""
    rows = 2 + len(ramp.torque)
    height = 0.75 + 1.55 * rows
    figure = new_figure(height)
    axes_list = figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0]
    step = max(1, -(-len(ramp.time_s) // MAX_POINTS))
    _speed(axes_list[0], ramp, step)
    _torque(axes_list[1], ramp, step)
    for axes, colour, (name, curves) in zip(axes_list[2:], SERIES, ramp.torque.items(), strict=False):
        _envelope(axes, ramp, curves, colour, step)
        axes.set_title(f"Dynamic torque in {plain(name)}: mean, maximum and minimum of each time slot")
    for axes in axes_list:
        _stage_bands(axes, ramp)
        axes.yaxis.set_label_coords(-0.052, 0.5)
    _stage_names(axes_list[0], ramp)
    axes_list[-1].set_xlabel("time [s]")
    axes_list[-1].set_xlim(ramp.time_s[0], ramp.time_s[-1])
    figure.subplots_adjust(left=0.085, right=0.985, top=1 - 0.52 / height, bottom=0.45 / height, hspace=0.32)
    return figure


def _speed(axes: "Axes", ramp: RampHistory, step: int) -> None:
    axes.plot(ramp.time_s[::step], ramp.speed_rpm[::step], color=SERIES[0])
    finish(axes, ylabel="pinion speed\nn [rpm]")


def _torque(axes: "Axes", ramp: RampHistory, step: int) -> None:
    time = ramp.time_s[::step]
    axes.plot(time, ramp.target_torque_Nm[::step], color=INK, label="bracing torque, target")
    axes.plot(time, ramp.drive_torque_Nm[::step], color=SERIES[1], label="drive torque")
    finish(axes, ylabel="torque [Nm]\nmean")
    axes.legend(loc="upper left", ncols=2)


def _envelope(
    axes: "Axes", ramp: RampHistory, curves: dict[str, list[float]], colour: str, step: int
) -> None:
    time = ramp.time_s[::step]
    low = [min(curves["minimum"][i : i + step]) for i in range(0, len(ramp.time_s), step)]
    high = [max(curves["maximum"][i : i + step]) for i in range(0, len(ramp.time_s), step)]
    axes.fill_between(time, low, high, color=colour, alpha=0.28, linewidth=0, label="maximum to minimum")
    axes.plot(time, high, color=colour, linewidth=0.6)
    axes.plot(time, low, color=colour, linewidth=0.6)
    axes.plot(time, curves["mean"][::step], color=INK, linewidth=1.0, label="mean")
    axes.axhline(0, color=MUTED, linewidth=0.8)
    finish(axes, ylabel="torque [Nm]\n0 to peak")
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
            plain(name),
            ((start + end) / 2, 1.0),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            xytext=(0, 4 + 11 * (number % 2)),
            ha="center",
            fontsize=7.5,
        )
