"""Thermal histories, power of heaters and cooler, loads in events."""

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import COLD, INK, LINES, MUTED, WARM, CurveStyle, curve_style
from rigdesign.results.loads import EventRecord
from rigdesign.results.thermal import OilPowerCurve, TransientCurve, TransientResult, WorstMoment

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FloatArray = NDArray[np.float64]

SHOWN = ("housing", "field", "gear", "shaft", "gear_oil_outlet", "bearing_oil_outlet")
"""Beginnings of the places whose temperature is drawn, in this order."""
ROWS = (("seal_gap", "smallest seal gap\n[mm]"), ("bearing_clearance", "smallest bearing\nclearance [mm]"),
        ("backlash", "smallest backlash\n[mm]"))  # fmt: skip
OFFSET = ("coupling_offset", "largest offset of a\ncoupling [mm]")
LEAST_SPAN = 30.0
"""Least ratio of the last to the first time of a column."""
EARLIEST = 1.0
"""Time of a phase [s] at which its logarithmic axis begins."""
APART = 0.25
"""Decades between two columns."""
MARKS = {1.0: "1 s", 60.0: "1 min", 3600.0: "1 h", 86400.0: "1 d", 2592000.0: "30 d"}
AXES_CHARACTERS, NARROW = 90, 12
"""Characters over the whole width, and least number of a line over a column."""
LABEL_ROOM = 1.25
"""Least distance of two time labels in decades."""


class CurveOverTime(Protocol):
    """What has phases over time: a history of temperatures, a history of oil power."""

    @property
    def time_s(self) -> list[float]:
        """Since the start of the schedule."""
        ...

    @property
    def phase(self) -> list[str]:
        """Name of the phase that each time ends."""
        ...


@dataclass(frozen=True)
class FigureColumn:
    """A phase on the common axis: its entries, and where its decades begin and end."""

    phase: str
    at: list[int]
    start: float
    end: float

    def places(self, curve: CurveOverTime) -> FloatArray:
        """Place of every entry: decades of the time since the start of the phase, from `EARLIEST`."""
        time = np.array([curve.time_s[i] for i in self.at])
        return np.asarray(self.start + np.log10(np.maximum(time - time[0], EARLIEST) / EARLIEST))


def columns_of(curve: CurveOverTime) -> list[FigureColumn]:
    """Phases side by side, each as wide as its decades of time, so that equal factors are equally long in all."""
    columns: list[FigureColumn] = []
    start = 0.0
    for phase in dict.fromkeys(curve.phase):
        at = [i for i, name in enumerate(curve.phase) if name == phase]
        at = [at[0] - 1, *at] if at[0] > 0 else at
        last = curve.time_s[at[-1]] - curve.time_s[at[0]]
        end = start + math.log10(max(last / EARLIEST, LEAST_SPAN))
        columns.append(FigureColumn(phase, at, start, end))
        start = end + APART
    return columns


def transient_figure(
    result: TransientResult, curve: TransientCurve, style: CurveStyle | None = None
) -> "Figure":
    """One thermal history: a column for each phase on a logarithmic time of its own, since a ramp takes seconds
    and a field days; the worst moment of a quantity is a ring.

    style : of the gearbox in all figures of the report; that of the first gearbox if left out
    """
    style = style or curve_style(0)
    coupled = bool(curve.alignment.get("coupling_offset_mm"))
    rows = [*ROWS, OFFSET] if coupled else list(ROWS)
    columns = columns_of(curve)
    height = 4.2 + 1.4 * len(rows)
    figure = new_figure(height)
    grid = figure.subplots(
        1 + len(rows), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": [2.0, *[1.0] * len(rows)]}
    )[:, 0]
    _temperatures(grid[0], curve, columns)
    for axes, (quantity, label) in zip(grid[1:], rows, strict=True):
        _worst_of(axes, result.worst, curve, columns, quantity, style)
        axes.set_ylabel(label)
    for axes in grid:
        _divide(axes, columns)
    _time_axis(grid[-1], columns)
    _phase_names(grid[0], columns)
    grid[0].set_ylabel("temperature [°C]")
    legend_right(grid[0])
    figure.subplots_adjust(left=0.1, right=0.83, top=1 - 0.62 / height, bottom=0.5 / height, hspace=0.12)
    return figure


def oil_power_figure(result: TransientResult, curve: OilPowerCurve) -> "Figure":
    """Power of heaters and cooler over one thermal history [kW] with their limits; the worst moment is a ring."""
    columns = columns_of(curve)
    height = 3.4
    figure = new_figure(height)
    axes = figure.subplots()
    for quantity, values, color in (
        ("heater_power", curve.heater_W, WARM),
        ("cooler_power", curve.cooler_W, COLD),
    ):
        x, y = _joined(curve, columns, [1e-3 * value for value in values])
        line = "-" if color == WARM else LINES[1]
        axes.plot(x, y, color=color, linestyle=line, label=words(quantity))
        for moment in (m for m in result.worst if (m.quantity, m.branch) == (quantity, curve.branch)):
            if moment.limit is not None:
                axes.axhline(moment.limit, color=color, linewidth=0.8, linestyle=":")
            _ring(axes, curve, columns, moment)
    _divide(axes, columns)
    _time_axis(axes, columns)
    _phase_names(axes, columns)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel("power [kW]")
    legend_right(axes)
    figure.subplots_adjust(left=0.085, right=0.83, top=1 - 0.62 / height, bottom=0.5 / height)
    return figure


def _divide(axes: "Axes", columns: Sequence[FigureColumn]) -> None:
    """White gaps with a line between the columns."""
    for column in columns[1:]:
        axes.axvspan(column.start - APART, column.start, color="white", linewidth=0, zorder=1.5)
        axes.axvline(column.start - 0.5 * APART, color=MUTED, linewidth=0.6)
    axes.yaxis.set_label_coords(-0.068, 0.5)


def _places(curve: TransientCurve) -> list[str]:
    def rank(place: str) -> int:
        return next((i for i, start in enumerate(SHOWN) if place.startswith(start)), len(SHOWN))

    chosen = [
        place for place in curve.temperatures_degC if rank(place) < len(SHOWN) and place != "housing_max"
    ]
    return sorted(chosen, key=lambda place: (rank(place), place))


def _joined(
    curve: CurveOverTime, columns: Sequence[FigureColumn], values: Sequence[float]
) -> tuple[FloatArray, FloatArray]:
    """Places and values of all columns in one line that breaks between them."""
    x = [np.append(column.places(curve), np.nan) for column in columns]
    y = [np.append([values[i] for i in column.at], np.nan) for column in columns]
    return np.concatenate(x), np.concatenate(y)


def _temperatures(axes: "Axes", curve: TransientCurve, columns: Sequence[FigureColumn]) -> None:
    for number, place in enumerate(_places(curve)):
        x, y = _joined(curve, columns, curve.temperatures_degC[place])
        axes.plot(x, y, **curve_style(number).drawn, label=words(place))


def _worst_of(
    axes: "Axes",
    worst: Sequence[WorstMoment],
    curve: TransientCurve,
    columns: Sequence[FigureColumn],
    quantity: str,
    style: CurveStyle,
) -> None:
    """The worst place of a quantity at every time, its limit, a ring where a history has its worst moment."""
    offset = quantity == OFFSET[0]
    places = curve.alignment["coupling_offset_mm"] if offset else curve.clearances_mm[quantity]
    values = (
        np.array(list(places.values())).max(axis=0) if offset else np.array(list(places.values())).min(axis=0)
    )
    axes.plot(*_joined(curve, columns, values.tolist()), **style.drawn)
    for moment in (m for m in worst if (m.quantity, m.branch) == (quantity, curve.branch)):
        if moment.limit is not None:
            axes.axhline(moment.limit, color=MUTED, linewidth=0.8, linestyle=":")
        if moment.place in places:
            _ring(axes, curve, columns, moment)


def _ring(axes: "Axes", curve: CurveOverTime, columns: Sequence[FigureColumn], moment: WorstMoment) -> None:
    """Mark the moment in the column of its phase."""
    for column in columns:
        least = min(range(len(column.at)), key=lambda i: abs(curve.time_s[column.at[i]] - moment.time_s))
        exact = abs(curve.time_s[column.at[least]] - moment.time_s) < 1e-6
        if column.phase == moment.phase and exact:
            where = float(column.places(curve)[least])
            axes.plot([where], [moment.value], "o", mfc="none", mec=INK, ms=8, mew=1.6)


def _phase_names(axes: "Axes", columns: Sequence[FigureColumn]) -> None:
    """Names over the columns, each above its left neighbour where that is wider than its column."""
    per_decade = AXES_CHARACTERS / (columns[-1].end - columns[0].start)
    height = 4
    for column in columns:
        room = int(per_decade * (column.end - column.start))
        lines = textwrap.wrap(words(column.phase), max(room, NARROW))
        axes.annotate(
            "\n".join(lines), (column.start, 1.0), xycoords=("data", "axes fraction"), textcoords="offset points",
            xytext=(2, height), va="bottom", fontsize=8, fontweight="bold",
        )  # fmt: skip
        height = height + 10 * len(lines) if max(map(len, lines)) > room else 4


def _time_axis(axes: "Axes", columns: Sequence[FigureColumn]) -> None:
    """Marks of time in every column, those left out that would touch their neighbour."""
    from matplotlib.ticker import NullLocator

    places: list[float] = []
    labels: list[str] = []
    last = -LABEL_ROOM
    for column in columns:
        for time, text in MARKS.items():
            place = column.start + math.log10(time / EARLIEST)
            if place <= column.end + 1e-9:
                places.append(place)
                shown = place - last >= LABEL_ROOM
                labels.append(text if shown else "")
                last = place if shown else last
    axes.set_xticks(places, labels, fontsize=8)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlim(columns[0].start, columns[-1].end)
    axes.set_xlabel("time since the start of the phase, logarithmic")


def event_figure(event: EventRecord) -> "Figure":
    """Coupling torques in the upper part, mesh torques in the lower one; zero is the instant of the event."""
    height = 4.2
    figure = new_figure(height)
    axes_list = figure.subplots(2, 1, sharex=True)
    time = [1e3 * value for value in event.time]
    for axes, quantity in zip(axes_list, ("coupling torque", "mesh torque"), strict=True):
        curves = [curve for curve in event.curves if curve.quantity == quantity]
        for i, curve in enumerate(curves):
            style = curve_style(i)
            axes.fill_between(
                time, curve.least, curve.greatest, color=style.drawn["color"], alpha=0.35, linewidth=0.0
            )
            middle = [0.5 * (a + b) for a, b in zip(curve.least, curve.greatest, strict=True)]
            axes.plot(time, middle, **style.drawn, label=words(curve.place))
        axes.axhline(0.0, color=MUTED, linewidth=0.6)
        if event.tripped is not None:
            axes.axvline(1e3 * event.tripped, color=INK, linewidth=0.8, linestyle=":", label="trip")
        finish(axes, ylabel=f"{quantity}\n[{unit_text('Nm')}]")
        axes.legend(loc="center right", ncols=3)
    axes_list[-1].set_xlabel("time from the event on [ms]")
    axes_list[-1].set_xlim(0.0, time[-1])
    figure.subplots_adjust(left=0.085, right=0.985, top=0.97, bottom=0.12, hspace=0.12)
    return figure
