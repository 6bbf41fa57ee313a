"""Temperatures, seal gap and backlash over the schedule; the worst moment is marked."""

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.drawing import INK, MUTED, SERIES, legend_right, new_figure, plain
from rigdesign.results_transient import TransientCurve, TransientResult, WorstMoment

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

SHOWN = ("housing", "field", "gear", "shaft", "gear_oil_outlet", "bearing_oil_outlet")
"""Beginnings of the places whose temperature is drawn, in this order."""
ROWS = (("seal_gap", "smallest seal gap\n[mm]"), ("bearing_clearance", "smallest bearing\nclearance [mm]"),
        ("backlash", "smallest backlash\n[mm]"))  # fmt: skip
TITLE_WIDTH = 12
"""Characters of a line over a column."""
LEAST_SPAN = 30.0
"""Least ratio of the last to the first time of a column."""
EARLIEST = 1.0
"""Time of a phase [s] at which its logarithmic axis begins."""


def transient_figure(result: TransientResult, curve: TransientCurve) -> "Figure":
    """One course: a column for each phase on a logarithmic axis of its own, since a ramp takes seconds and a field
    days; the worst moment of a quantity is a ring."""
    phases = list(dict.fromkeys(curve.phase))
    height = 8.4
    figure = new_figure(height)
    ratios = {
        "height_ratios": [2.0, *[1.0] * len(ROWS)],
        "width_ratios": [_decades(curve, phase) for phase in phases],
    }
    grid = figure.subplots(1 + len(ROWS), len(phases), sharey="row", squeeze=False, gridspec_kw=ratios)
    for column, phase in enumerate(phases):
        at = _of_phase(curve, phase)
        time = _since(curve, at)
        _temperatures(grid[0][column], curve, at, time)
        title = textwrap.fill(plain(phase.replace("_", " ")), TITLE_WIDTH)
        grid[0][column].set_title(title, fontsize=7.5)
        for row, (quantity, _) in enumerate(ROWS, start=1):
            _clearance(grid[row][column], result.worst, curve, quantity, at, time)
        for axes in grid[:, column]:
            axes.set_xscale("log")
            end = max(float(time[-1]), LEAST_SPAN * EARLIEST)
            _time_ticks(axes, end)
            axes.set_xlim(EARLIEST, end)
        for axes in grid[:-1, column]:
            axes.tick_params(labelbottom=False)
    grid[0][0].set_ylabel("temperature [°C]")
    for row, (_, label) in enumerate(ROWS, start=1):
        grid[row][0].set_ylabel(label)
    grid[-1][len(phases) // 2].set_xlabel("time since the start of the phase")
    legend_right(grid[0][-1])
    figure.subplots_adjust(left=0.085, right=0.83, top=0.93, bottom=0.08, hspace=0.12, wspace=0.1)
    return figure


def _of_phase(curve: TransientCurve, phase: str) -> list[int]:
    """Entries of a phase, with the one it starts from."""
    at = [i for i, name in enumerate(curve.phase) if name == phase]
    return [at[0] - 1, *at] if at[0] > 0 else at


def _since(curve: TransientCurve, at: Sequence[int]) -> FloatArray:
    """Time since the start of the phase [s], not before the axis begins."""
    time = np.array([curve.time_s[i] for i in at])
    return np.asarray(np.maximum(time - time[0], EARLIEST))


def _places(curve: TransientCurve) -> list[str]:
    def rank(place: str) -> int:
        return next((i for i, start in enumerate(SHOWN) if place.startswith(start)), len(SHOWN))

    chosen = [
        place for place in curve.temperatures_degC if rank(place) < len(SHOWN) and place != "housing_max"
    ]
    return sorted(chosen, key=lambda place: (rank(place), place))


def _temperatures(axes: "Axes", curve: TransientCurve, at: Sequence[int], time: FloatArray) -> None:
    for number, place in enumerate(_places(curve)):
        values = [curve.temperatures_degC[place][i] for i in at]
        style = "--" if place.endswith("outlet") else "-"
        colour = SERIES[number % len(SERIES)]
        axes.plot(time, values, style, color=colour, label=plain(place.replace("_", " ")))


def _clearance(
    axes: "Axes",
    worst: Sequence[WorstMoment],
    curve: TransientCurve,
    quantity: str,
    at: Sequence[int],
    time: FloatArray,
) -> None:
    places = curve.clearances_mm[quantity]
    values = [min(course[i] for course in places.values()) for i in at]
    axes.plot(time, values, color=INK)
    moment = next((m for m in worst if (m.quantity, m.branch) == (quantity, curve.branch)), None)
    if moment is None:
        return
    if moment.limit is not None:
        axes.axhline(moment.limit, color=MUTED, linewidth=0.8, linestyle=":")
    least = min(range(len(at)), key=lambda i: abs(curve.time_s[at[i]] - moment.time_s))
    if curve.phase[at[least]] == moment.phase and abs(curve.time_s[at[least]] - moment.time_s) < 1e-6:
        axes.plot([time[least]], [moment.value], "o", mfc="none", mec=SERIES[1], ms=8, mew=1.6)


def _decades(curve: TransientCurve, phase: str) -> float:
    """Width of a column: decades of time, so that equal factors are equally long in all."""
    last = float(_since(curve, _of_phase(curve, phase))[-1])
    return math.log10(max(last / EARLIEST, LEAST_SPAN))


def _time_ticks(axes: "Axes", end: float) -> None:
    from matplotlib.ticker import NullLocator

    marks = {1.0: "1 s", 60.0: "1 min", 3600.0: "1 h", 86400.0: "1 d", 2592000.0: "30 d"}
    shown = {time: text for time, text in marks.items() if time <= 1.01 * end}
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(list(shown), list(shown.values()), fontsize=6.5)
