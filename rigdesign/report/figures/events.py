"""Torques of an event over time: couplings as lines, meshes as bands of their extremes."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, new_figure, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, MUTED, curve_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def event_figure(event: Mapping[str, Any]) -> "Figure":
    """Coupling torques in the upper part, mesh torques in the lower one; zero is the instant of the event."""
    height = 4.2
    figure = new_figure(height)
    axes_list = figure.subplots(2, 1, sharex=True)
    time = [1e3 * value for value in event["curves"]["time_s"]]
    for axes, quantity in zip(axes_list, ("coupling torque", "mesh torque"), strict=True):
        curves = [one for one in event["curves"]["torque"] if one["quantity"] == quantity]
        for i, curve in enumerate(curves):
            style = curve_style(i)
            axes.fill_between(
                time, curve["least"], curve["greatest"], color=style.drawn["color"], alpha=0.35, linewidth=0.0
            )
            middle = [0.5 * (a + b) for a, b in zip(curve["least"], curve["greatest"], strict=True)]
            axes.plot(time, middle, **style.drawn, label=words(curve["place"]))
        axes.axhline(0.0, color=MUTED, linewidth=0.6)
        if event["time_to_trip_s"] is not None:
            axes.axvline(1e3 * event["time_to_trip_s"], color=INK, linewidth=0.8, linestyle=":", label="trip")
        finish(axes, ylabel=f"{quantity}\n[{unit_text('Nm')}]")
        axes.legend(loc="center right", ncols=3)
    axes_list[-1].set_xlabel("time from the event on [ms]")
    axes_list[-1].set_xlim(0.0, time[-1])
    figure.subplots_adjust(left=0.085, right=0.985, top=0.97, bottom=0.12, hspace=0.12)
    return figure
