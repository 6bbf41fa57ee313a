"""Waterfalls of run-up and run-down, and spectra at the held stages."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.report.figures.drawing import finish, gearbox_title, new_figure, panels_in_pairs, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import INK, MUTED, TEMPERATURE_COLOURS, CurveStyle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Rows = Sequence[Mapping[str, Any]]
DECADES = 3.0
"""Of the colours, below the highest amplitude."""
HARMONICS = 4
"""Mesh orders named in a figure."""
KHZ = 1e-3


def waterfall_figure(rows: Rows, styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox: frequency across, speed upwards, amplitude as colour; mesh orders named at the edge."""
    from matplotlib.colors import LogNorm

    figure, panels = panels_in_pairs(3.9, len(rows))
    lines = figure.get_figheight() / 3.9
    top = max(max(map(max, row["amplitude_Nm"])) for row in rows)
    bottom = top * 10.0**-DECADES
    norm = LogNorm(bottom, top)
    for axes, row in zip(panels[:, 0], rows, strict=True):
        amplitude = np.maximum(np.array(row["amplitude_Nm"]), bottom)
        speed, frequency = np.array(row["pinion_speed_rpm"]), KHZ * np.array(row["frequency_Hz"])
        image = axes.pcolormesh(
            frequency,
            speed,
            amplitude,
            norm=norm,
            cmap=TEMPERATURE_COLOURS,
            shading="nearest",
            rasterized=True,
        )
        _mesh_orders(axes, row, float(frequency[-1]))
        axes.grid(visible=False)
        axes.set(xlim=(0, frequency[-1]), ylim=(speed[0], speed[-1]))
        finish(axes, "frequency [kHz]", "pinion speed n [rpm]")
        gearbox_title(
            axes, f"Gearbox {words(row['gearbox'])}, stage {words(row['stage'])}", styles[row["gearbox"]]
        )
    figure.subplots_adjust(
        left=0.085, right=0.87, top=1.0 - 0.12 / lines, bottom=0.13 / lines, wspace=0.24, hspace=0.32
    )
    beside = figure.add_axes((0.895, 0.13 / lines, 0.014, 1.0 - 0.25 / lines))
    bar = figure.colorbar(image, cax=beside)
    bar.set_label(f"amplitude of the dynamic torque [{unit_text('Nm')}]")
    return figure


def _mesh_orders(axes: "Axes", row: Mapping[str, Any], last: float) -> None:
    """f_z and its multiples: a short mark at the edge they leave the plot by."""
    low, high = row["pinion_speed_rpm"][0], row["pinion_speed_rpm"][-1]
    for harmonic in range(1, HARMONICS + 1):
        slope = KHZ * harmonic * row["teeth"] / 60.0
        speed = min(high, last / slope)
        if speed <= low:
            continue
        text = "f_z" if harmonic == 1 else f"{harmonic} f_z"
        beyond = slope * high > last
        axes.annotate(
            text, (slope * speed, speed), textcoords="offset points", xytext=(-3, 2) if beyond else (-9, -2),
            ha="right", va="top", fontsize=8, color="white", annotation_clip=False,
        )  # fmt: skip


def spectrum_figure(rows: Rows, styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox and held stage: time run as a line, mesh orders of the periodic response as stems."""
    figure = new_figure(0.5 + 2.0 * len(rows))
    panels = figure.subplots(len(rows), 1, squeeze=False)[:, 0]
    for axes, row in zip(panels, rows, strict=True):
        style = styles[row["gearbox"]]
        floor = 1e-6 * row["mean_Nm"]
        if row["order"]:
            axes.plot(
                row["order"], np.maximum(row["amplitude_Nm"], floor), color=style.colour, linewidth=0.7,
                label="time run",
            )  # fmt: skip
        orders, heights = row["mesh_harmonic_order"], row["mesh_harmonic_amplitude_Nm"]
        axes.vlines(orders, floor, heights, color=INK, linewidth=1.0)
        axes.plot(orders, heights, "o", color=INK, markersize=2.6, label="periodic response")
        for harmonic in range(1, HARMONICS + 1):
            height = max(
                (h for o, h in zip(orders, heights, strict=True) if abs(o - harmonic * row["teeth"]) < 0.01),
                default=None,
            )
            if height is not None:
                axes.annotate(
                    "f_z" if harmonic == 1 else f"{harmonic} f_z", (harmonic * row["teeth"], height),
                    textcoords="offset points", xytext=(0, 4), ha="center", fontsize=8,
                )  # fmt: skip
        axes.set_yscale("log")
        highest = max([*heights, *row["amplitude_Nm"]], default=1.0)
        axes.set_ylim(max(floor, 1e-5 * highest), 6.0 * highest)
        axes.set_xlim(0, (HARMONICS + 0.4) * row["teeth"])
        finish(axes, "", f"amplitude [{unit_text('Nm')}]")
        title = (
            f"Gearbox {words(row['gearbox'])}, stage {words(row['stage'])}, {row['pinion_speed_rpm']:.0f} rpm"
        )
        gearbox_title(axes, title, style)
        axes.tick_params(colors=MUTED)
    panels[0].legend(loc="upper right", ncols=2)
    panels[-1].set_xlabel("order of the pinion [–]")
    height = figure.get_figheight()
    figure.subplots_adjust(left=0.085, right=0.985, top=1 - 0.3 / height, bottom=0.45 / height, hspace=0.42)
    return figure
