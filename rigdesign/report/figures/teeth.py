"""Teeth under load: contact at rest and in motion, root stress over path and turn, strain gauges."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, panels_in_pairs, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, LINES, MUTED, CurveStyle, curve_style
from rigdesign.results.dynamics import ToothTurnHistory
from rigdesign.results.quantity import value_in_unit
from rigdesign.results.teeth import PairShare

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SIGMA_F = "σ_F"
Rows = Sequence[Mapping[str, Any]]
EDGE = "#c0392b"
"""Places where a tip edge carries."""
ROOM = 1.3
"""Top of a stress axis over the highest stress: the legend stands above the curves."""
TURN = (0.0, 90.0, 180.0, 270.0, 360.0)
HEIGHT = 2.3
"""Of a row of gears [in]."""
MARGIN = 0.3
"""Shown on either side of what is strained, as a share of it."""
STRAINED = 0.1
"""Stress that counts as strained, as a share of the highest of all."""


def tooth_contact_figure(contact: dict[str, Any], style: CurveStyle | None = None) -> "Figure":
    """Pressure over face and rolling angle of the pinion, and the root stress of both gears."""
    style = style or curve_style(0)
    figure = new_figure(2.9)
    flank, *roots = figure.subplots(1, 3, squeeze=False)[0]
    _pattern(figure, flank, contact, style)
    for axes, gear in zip(roots, contact["root_stress"], strict=True):
        course = contact["root_stress"][gear]
        axes.plot(
            course["rolling_angle_deg"], course["highest_MPa"], **style.drawn, label="highest over the face"
        )
        axes.plot(
            course["rolling_angle_deg"],
            course["mid_face_MPa"],
            color=INK,
            linewidth=0.9,
            linestyle=LINES[1],
            label="mid-face",
        )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        finish(axes, "rolling angle φ [°]", f"root stress {SIGMA_F}(φ) [N/mm²]")
        gearbox_title(axes, f"{words(gear).capitalize()}, stage {words(contact['stage'])}", style)
        axes.set_ylim(top=ROOM * max(course["highest_MPa"]))
        axes.legend(loc="upper right")
    figure.subplots_adjust(left=0.065, right=0.985, top=0.90, bottom=0.17, wspace=0.54)
    return figure


def _pattern(figure: "Figure", axes: "Axes", contact: dict[str, Any], style: CurveStyle) -> None:
    pattern = contact["pattern"]
    face, angle = np.asarray(pattern["face_mm"]), np.asarray(pattern["rolling_angle_deg"])
    pressure, edge = np.asarray(pattern["pressure_MPa"]), np.asarray(pattern["edge"], dtype=bool)
    drawn = np.ma.masked_where(pressure <= 0.0, pressure)
    across = np.broadcast_to(face, angle.shape)
    shown = axes.pcolormesh(
        across, angle, drawn, shading="nearest", cmap="cividis", vmin=0.0, rasterized=True
    )
    if edge.any():
        axes.plot(across[edge], angle[edge], linestyle="", marker=".", markersize=1.2, color=EDGE)
    bar = figure.colorbar(shown, ax=axes, fraction=0.06, pad=0.03)
    bar.ax.tick_params(labelsize=8)
    bar.ax.set_title("p_H [N/mm²]", fontsize=8, pad=4)
    finish(axes, "face position z [mm]", "rolling angle φ [°]")
    gearbox_title(axes, "Pinion flank", style)


def pair_share_figure(rows: Sequence[PairShare], styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox and held stage: share of the mesh force and force over the mean, over the pinion; below
    it the line load over the face where a pair carries most."""
    faces = any(row.face for row in rows)
    height = 5.2 if faces else 2.9
    figure, panels = panels_in_pairs(height, len(rows), 1 + faces)
    lines = figure.get_figheight() / height
    for number, ((axes, *below), row) in enumerate(zip(panels, rows, strict=True)):
        style = styles[row.mesh]
        angle = value_in_unit(row, "angle")
        axes.plot(angle, row.static_share, color=INK, linewidth=0.9, label="share, quasi-static")
        axes.plot(angle, row.share, color=style.colour, label="share, in motion")
        axes.plot(
            angle, row.force, color=style.colour, linewidth=0.9, linestyle=LINES[2],
            label="force over the mean force of the mesh",
        )  # fmt: skip
        axes.set_ylim(bottom=0)
        finish(axes, "rolling angle of the pinion φ [°]", "share of a pair [–]" if number % 2 == 0 else "")
        gearbox_title(axes, f"Gearbox {words(row.mesh)}, stage {words(row.stage)}", style)
        for lower in below:
            _line_load(lower, row, style, number)
    panels[0, 0].legend(loc="lower center", fontsize=8)
    figure.subplots_adjust(
        left=0.075,
        right=0.985,
        top=1.0 - (0.055 if faces else 0.10) / lines,
        bottom=(0.095 if faces else 0.17) / lines,
        wspace=0.14,
        hspace=0.38,
    )
    return figure


def _line_load(axes: "Axes", row: PairShare, style: CurveStyle, number: int) -> None:
    """Line load over the face in motion and at rest, at the angle at which a pair carries most."""
    face = value_in_unit(row, "face")
    axes.plot(face, value_in_unit(row, "static_line_load"), color=INK, linewidth=0.9, label="quasi-static")
    axes.plot(face, value_in_unit(row, "line_load"), color=style.colour, label="in motion")
    axes.set_ylim(bottom=0)
    finish(
        axes,
        f"position from mid-face [mm], at φ = {round(value_in_unit(row, 'most_loaded'), 1) + 0.0:.1f}°",
        f"line load [{unit_text('N/mm')}]" if number % 2 == 0 else "",
    )
    if number == 0:
        axes.legend(loc="lower center", fontsize=8)


def tooth_history_figure(histories: Sequence[ToothTurnHistory]) -> "Figure":
    """Stress over rotation, a row for each gear: the leading and the trailing flank, and the mean stress at rest."""
    figure = new_figure(HEIGHT * len(histories))
    style = curve_style(0)
    for axes, history in zip(figure.subplots(len(histories), 1, squeeze=False)[:, 0], histories, strict=True):
        turned = history.rotation_deg
        axes.plot(turned, history.leading_MPa, **style.drawn, label="fillet of the leading flank")
        axes.plot(
            turned,
            history.trailing_MPa,
            color=INK,
            linewidth=0.9,
            linestyle=LINES[1],
            label="fillet of the trailing flank",
        )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        if history.mean_MPa["total"] > 0.0:
            axes.axhline(
                history.mean_MPa["total"], color=MUTED, linewidth=0.7, linestyle=LINES[2], label="mean stress"
            )
        axes.set_xlim(0.0, 360.0)
        axes.set_xticks(TURN)
        finish(axes, "rotation of the gear [°]", f"root stress {SIGMA_F} [N/mm²]", _title(history))
        axes.legend(loc="best")
    height = HEIGHT * len(histories)
    figure.subplots_adjust(left=0.09, right=0.985, top=1.0 - 0.25 / height, bottom=0.45 / height, hspace=0.42)
    return figure


def _title(history: ToothTurnHistory) -> str:
    return (
        f"{words(history.gear)}, stage {words(history.stage)}: R = {history.R:.2f}, Y_M = {history.Y_M:.3f}"
    )


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


def place(row: Mapping[str, Any]) -> str:
    """Where on the root a curve holds."""
    return label({"name": row["gauge"]}) if row["gauge"] else "most stressed point"


def strain_gauge_figure(contact: dict[str, Any]) -> "Figure":
    """Stress at every gauge, a panel for each gear that has some."""
    gauges = contact["strain_gauges"]
    gears = list(dict.fromkeys(gauge["gear"] for gauge in gauges))
    figure = new_figure(2.9)
    panels = figure.subplots(1, len(gears), squeeze=False)[0]
    for axes, gear in zip(panels, gears, strict=True):
        shown = [gauge for gauge in gauges if gauge["gear"] == gear]
        for number, gauge in enumerate(shown):
            axes.plot(
                gauge["rolling_angle_deg"],
                gauge["stress_MPa"],
                **curve_style(number).drawn,
                label=f"{label(gauge)}, z = {gauge['face_position_mm']:.3g} mm".replace(
                    "-", "\N{MINUS SIGN}"
                ),
            )
        axes.axhline(0.0, color=INK, linewidth=0.4)
        axes.set_xlim(*_range(shown))
        finish(axes, "rolling angle φ [°]", "stress at the gauge [N/mm²]")
        axes.set_title(f"{words(gear).capitalize()}, stage {words(contact['stage'])}")
        axes.legend(loc="upper left")
    figure.subplots_adjust(left=0.075, right=0.985, top=0.90, bottom=0.17, wspace=0.25)
    return figure


def label(gauge: dict[str, Any]) -> str:
    """Name of a gauge as engineers write it: Roman numerals in capitals."""
    name = str(gauge["name"])
    return name.upper() if set(name) <= set("ivx") else words(name)


def _range(gauges: Sequence[dict[str, Any]]) -> tuple[float, float]:
    """Rolling angles in which a gauge is strained, and a margin."""
    highest = max(max(gauge["stress_MPa"]) for gauge in gauges)
    angles = [
        angle
        for gauge in gauges
        for angle, stress in zip(gauge["rolling_angle_deg"], gauge["stress_MPa"], strict=True)
        if abs(stress) > STRAINED * highest
    ]
    margin = MARGIN * (max(angles) - min(angles))
    return min(angles) - margin, max(angles) + margin
