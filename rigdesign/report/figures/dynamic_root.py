"""Dynamic root stress and strain rate over the rolling angle, at strain gauges or at the most stressed point."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, new_figure, words
from rigdesign.report.figures.strain_gauges import label
from rigdesign.report.palette import INK, LINES, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Rows = Sequence[dict[str, Any]]


def dynamic_root_figure(rows: Rows) -> "Figure":
    """A column for each gear: stress above, strain rate below; colours by place, lines by speed.

    rows : curves of one gearbox
    """
    gears = list(dict.fromkeys(row["gear"] for row in rows))
    speeds = sorted({row["pinion_speed_rpm"] for row in rows})
    figure = new_figure(5.0)
    panels = figure.subplots(2, len(gears), squeeze=False, sharex="col")
    for column, gear in enumerate(gears):
        own = [row for row in rows if row["gear"] == gear]
        upper, lower = panels[:, column]
        _stress(upper, own, speeds)
        _rate(lower, own, speeds)
        finish(upper, "", "root stress [N/mm²]", words(gear).capitalize())
        finish(lower, "rolling angle φ [°]", "strain rate [1/s]")
        upper.legend(loc="upper left", fontsize=8)
    figure.subplots_adjust(left=0.085, right=0.985, top=0.945, bottom=0.1, wspace=0.22, hspace=0.1)
    return figure


def _styles(rows: Rows, speeds: Sequence[float]) -> list[dict[str, Any]]:
    """Of every row: the colour tells the place and the line the speed; of one place both tell the speed."""
    places = list(dict.fromkeys(row["gauge"] for row in rows))
    found = []
    for row in rows:
        speed = speeds.index(row["pinion_speed_rpm"])
        colour = curve_style(speed if len(places) == 1 else places.index(row["gauge"])).colour
        found.append({"color": colour, "linestyle": LINES[speed % len(LINES)]})
    return found


def _stress(axes: "Axes", rows: Rows, speeds: Sequence[float]) -> None:
    places = list(dict.fromkeys(row["gauge"] for row in rows))
    for row, style in zip(rows, _styles(rows, speeds), strict=True):
        axes.plot(
            row["rolling_angle_deg"], row["dynamic_MPa"], linewidth=1.1, **style,
            label=f"{place(row)}, {row['pinion_speed_rpm']:.0f} rpm",
        )  # fmt: skip
    for number, name in enumerate(places):
        row = next(row for row in rows if row["gauge"] == name)
        axes.plot(
            row["rolling_angle_deg"], row["quasi_static_MPa"], color=INK, linewidth=0.6,
            label="quasi-static" if number == 0 else None,
        )  # fmt: skip
    low = min(min(row["dynamic_MPa"]) for row in rows)
    if low >= 0.0:
        axes.set_ylim(bottom=0)


def _rate(axes: "Axes", rows: Rows, speeds: Sequence[float]) -> None:
    for row, style in zip(rows, _styles(rows, speeds), strict=True):
        axes.plot(row["rolling_angle_deg"], row["strain_rate_per_s"], linewidth=0.9, **style)
    axes.axhline(0.0, color=INK, linewidth=0.4)


def place(row: dict[str, Any]) -> str:
    """Where on the root a curve holds."""
    return label({"name": row["gauge"]}) if row["gauge"] else "most stressed point"
