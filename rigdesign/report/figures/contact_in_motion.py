"""Load on the tooth pairs in motion."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, LINES, CurveStyle

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
    panels[0].legend(loc="lower center", fontsize=8)
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
        axes.legend(loc="lower center", fontsize=8)
