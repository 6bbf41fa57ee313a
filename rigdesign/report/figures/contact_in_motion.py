"""Load on the tooth pairs in motion, and where contact is lost over speed and torque."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, LINES, MUTED, TEMPERATURE_COLOURS, VERDICT_COLOURS, CurveStyle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Rows = Sequence[Mapping[str, Any]]


def pair_share_figure(rows: Rows, styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox and held stage: share of the mesh force and force over the mean, over the pinion; below
    it the line load over the face where a pair carries most."""
    faces = any(row["face_mm"] for row in rows)
    figure = new_figure(5.2 if faces else 2.9)
    grid = figure.subplots(1 + faces, len(rows), squeeze=False)
    panels = grid[0]
    for axes, row in zip(panels, rows, strict=True):
        style = styles[row["gearbox"]]
        angle = row["rolling_angle_deg"]
        axes.plot(angle, row["share_quasi_static"], color=INK, linewidth=0.9, label="share, quasi-static")
        axes.plot(angle, row["share"], color=style.colour, label="share, in motion")
        axes.plot(
            angle, row["force_over_mean"], color=style.colour, linewidth=0.9, linestyle=LINES[2],
            label="force over the mean force of the mesh",
        )  # fmt: skip
        axes.set_ylim(bottom=0)
        finish(axes, "rolling angle of the pinion φ [°]", "share of a pair [–]" if axes is panels[0] else "")
        gearbox_title(axes, f"Gearbox {words(row['gearbox'])}, stage {words(row['stage'])}", style)
    panels[0].legend(loc="lower center", fontsize=7)
    if faces:
        for axes, row in zip(grid[1], rows, strict=True):
            _line_load(axes, row, styles[row["gearbox"]], first=axes is grid[1][0])
    figure.subplots_adjust(
        left=0.075, right=0.985, top=0.945 if faces else 0.90, bottom=0.095 if faces else 0.17, wspace=0.14,
        hspace=0.38,
    )  # fmt: skip
    return figure


def _line_load(axes: "Axes", row: Mapping[str, Any], style: CurveStyle, *, first: bool) -> None:
    """Line load over the face in motion and at rest, at the angle at which a pair carries most."""
    face = row["face_mm"]
    axes.plot(face, row["line_load_quasi_static_N_mm"], color=INK, linewidth=0.9, label="quasi-static")
    axes.plot(face, row["line_load_N_mm"], color=style.colour, label="in motion")
    axes.set_ylim(bottom=0)
    finish(
        axes,
        f"position from mid-face [mm], at φ = {round(row['most_loaded_angle_deg'], 1) + 0.0:.1f}°",
        f"line load [{unit_text('N/mm')}]" if first else "",
    )
    if first:
        axes.legend(loc="lower center", fontsize=7)


def contact_loss_figure(rows: Rows, styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox: least torque over the mean by speed and torque; crosses at contact loss."""
    figure = new_figure(3.3)
    panels = figure.subplots(1, len(rows), squeeze=False, sharey=True)[0]
    for axes, row in zip(panels, rows, strict=True):
        values = np.array([[np.nan if v is None else v for v in line] for line in row["least_share"]])
        places = np.arange(len(row["torque_Nm"]))
        image = axes.pcolormesh(
            row["pinion_speed_rpm"], places, values, cmap=TEMPERATURE_COLOURS, vmin=0.0, vmax=1.0, shading="nearest",
            rasterized=True,
        )  # fmt: skip
        lost = np.array([[v is not None and v > 0.0 for v in line] for line in row["lift_off_share"]])
        unstable = np.array(row["unstable"])
        for marks, marker, colour, label in (
            (lost, "x", VERDICT_COLOURS["fail"], "contact is lost"),
            (
                unstable,
                "+",
                VERDICT_COLOURS["fail"],
                "contact is lost, motion not periodic with the mesh",
            ),
            (np.isnan(values) & ~unstable, ".", MUTED, "no response found"),
        ):
            torque, speed = np.nonzero(marks)
            if speed.size:
                axes.plot(
                    np.array(row["pinion_speed_rpm"])[speed], places[torque], marker, color=colour, markersize=4,
                    label=label,
                )  # fmt: skip
        axes.grid(visible=False)
        axes.set_yticks(places, [f"{torque:.3g}" for torque in row["torque_Nm"]])
        finish(axes, "pinion speed n [rpm]", f"torque [{unit_text('Nm')}]" if axes is panels[0] else "")
        gearbox_title(axes, f"Gearbox {words(row['gearbox'])}", styles[row["gearbox"]])
    handles: dict[str, Any] = {}
    for axes in panels:
        handles |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="lower left", bbox_to_anchor=(0.07, 0.0), ncols=3)
    bar = figure.colorbar(image, ax=list(panels), pad=0.015, fraction=0.05)
    bar.set_label("minimum torque over mean [–]")
    figure.subplots_adjust(left=0.075, right=0.87, top=0.89, bottom=0.28, wspace=0.08)
    bar.ax.set_position((0.895, 0.28, 0.014, 0.61))
    return figure
