"""Vibration over speed: Campbell diagram, speeds to avoid, torque by section, whirl of the shafts."""

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rigdesign.base.part_name import BearingName
from rigdesign.report.figures.drawing import (
    finish,
    gearbox_title,
    legend_right,
    new_figure,
    panels_in_pairs,
    stated_quantity,
    words,
)
from rigdesign.report.numbers import NARROW_SPACE, unit_text
from rigdesign.report.palette import (
    INK,
    MUTED,
    SERIES,
    TEMPERATURE_COLOURS,
    VERDICT_COLOURS,
    CurveStyle,
    curve_style,
)
from rigdesign.results.lateral import BearingOrbit, LateralVibration
from rigdesign.results.quantity import value_in_unit
from rigdesign.results.vibration import HeldSpectrum, Waterfall, sense_of_whirl

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ORDER_STYLES: Mapping[str, dict[str, Any]] = {
    "mesh": {"color": SERIES[0], "linestyle": "-"},
    "shaft": {"color": SERIES[1], "linestyle": (0, (6.0, 2.0))},
    "coupling": {"color": SERIES[2], "linestyle": (0, (1.2, 1.4))},
}
"""Lines of the excitation, by what excites."""
MARKERS: Mapping[str, str] = {"mesh": "o", "shaft": "s", "coupling": "^"}
MODE_STYLES: Mapping[str, tuple[Any, str]] = {
    "": ("-", "modes of the closed loop"),
    "forward": ((0, (9.0, 1.6)), "modes, forward whirl"),
    "backward": ((0, (3.0, 1.6)), "modes, backward whirl"),
}
"""Line and label of a mode by its sense of whirl."""
LABEL_DISTANCE = 0.038
"""Least distance of two labels at the right edge, as a share of the height."""
LEADER = {"arrowstyle": "-", "color": MUTED, "linewidth": 0.5, "relpos": (0.0, 0.5)}
"""Line from a label to its mode."""
LONGEST = 50
"""Characters of the name of a mode."""
BAND_KINDS = {
    "dynamic_factor": "dynamic part of the mesh torque, highest of the meshes",
    "root_stress": "root stress, dynamic / quasi-static \N{MINUS SIGN} 1",
    "shaft_torque": "half peak-to-peak torque of shafts and joints",
}
PART_KINDS = {"mesh": "mesh", "coupling": "coupling", "spline": "seat of", "motor": "joint of the"}
"""Words in front of the name of a joint."""


def campbell_diagram(campbell: Mapping[str, Any], held: Mapping[str, float]) -> "Figure":
    """Both axes logarithmic: orders are parallel lines, from those of the shafts up to those of the teeth.

    held : pinion speed of every held stage [rpm]
    """
    figure = new_figure(5.2)
    axes = figure.subplots()
    low, high = 0.75 * campbell["speed_rpm"][0], 1.02 * campbell["speed_rpm"][-1]
    bottom, top = _frequencies(campbell, low, high)
    axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(bottom, top))
    _orders(axes, campbell["orders"])
    _modes(axes, campbell)
    _crossings(axes, campbell["crossings"])
    for stage, speed in held.items():
        axes.axvline(speed, color=MUTED, linewidth=0.9, linestyle=(0, (7.0, 1.6, 1.4, 1.6)))
        axes.annotate(
            words(stage), (speed, bottom), textcoords="offset points", xytext=(-3, 3), rotation=90, fontsize=8,
            ha="right", va="bottom", color=MUTED,
        )  # fmt: skip
    finish(axes, "pinion speed n [rpm]", "frequency [Hz]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(_whole)
        axis.set_minor_formatter(_some)
    axes.grid(visible=True, which="minor", linewidth=0.3)
    figure.legend(loc="lower left", bbox_to_anchor=(0.075, 0.0), ncols=4, fontsize=8)
    figure.subplots_adjust(left=0.085, right=0.63, top=0.955, bottom=0.175)
    return figure


def _frequencies(campbell: Mapping[str, Any], low: float, high: float) -> tuple[float, float]:
    """Lowest and highest frequency shown [Hz]."""
    modes = [f for mode in campbell["modes"] for f in mode["frequency_Hz"] if f is not None]
    turning = [order["per_turn"] * low / 60.0 for order in campbell["orders"] if order["kind"] != "mesh"]
    reached = [order["per_turn"] * high / 60.0 for order in campbell["orders"]]
    least = min([*modes, *reached])
    shafts = any(mode["driven_by"] == "shaft" for mode in campbell["modes"])
    bottom = max(least / 4.0, min(turning, default=least)) if shafts else 0.5 * min(modes, default=least)
    return bottom, 1.5 * max(modes, default=max(reached))


def _orders(axes: "Axes", orders: Sequence[Mapping[str, Any]]) -> None:
    low, high = axes.get_xlim()
    bottom, top = axes.get_ylim()
    named: set[str] = set()
    for order in orders:
        kind, slope = order["kind"], order["per_turn"] / 60.0
        if slope * high <= bottom or slope * low >= top:
            continue
        label = {"mesh": "mesh orders", "shaft": "turning frequencies", "coupling": "coupling orders"}[kind]
        axes.plot(
            [low, high], [slope * low, slope * high], linewidth=0.9, **ORDER_STYLES[kind],
            label=None if kind in named else label,
        )  # fmt: skip
        named.add(kind)
        if kind == "mesh":
            text = "f_z" if order["harmonic"] == 1 else f"{order['harmonic']:g} f_z"
            at = min(0.97 * top / slope, 0.93 * high)
            axes.annotate(
                text, (at, slope * at), textcoords="offset points", xytext=(-9, 0), fontsize=8, ha="right",
                va="top", color=SERIES[0],
            )  # fmt: skip


def _modes(axes: "Axes", campbell: Mapping[str, Any]) -> None:
    speeds = campbell["speed_rpm"]
    low, high = axes.get_xlim()
    ends, texts = [], []
    named: set[str] = set()
    for mode in campbell["modes"]:
        values = [np.nan if f is None else f for f in mode["frequency_Hz"]]
        style, text = MODE_STYLES[sense_of_whirl(mode["whirl"])]
        axes.plot(
            [low, *speeds, high], [values[0], *values, values[-1]], color=INK, linewidth=0.8, linestyle=style,
            label=None if text in named else text,
        )  # fmt: skip
        named.add(text)
        known = [f for f in values if np.isfinite(f)]
        ends.append(known[-1])
        texts.append(f"{mode['mode']}  {_short(mode['shape'])}")
    _edge_labels(axes, ends, texts)


def _edge_labels(axes: "Axes", values: Sequence[float], texts: Sequence[str]) -> None:
    """Labels right of the plot, moved apart where they would touch, each with a line to its mode."""
    bottom, top = (np.log(limit) for limit in axes.get_ylim())
    order = np.argsort(values)
    places = [(np.log(values[i]) - bottom) / (top - bottom) for i in order]
    spread = list(places)
    for _ in range(200):
        for i in range(1, len(spread)):
            lack = LABEL_DISTANCE - (spread[i] - spread[i - 1])
            if lack > 1e-9:
                spread[i] += 0.5 * lack
                spread[i - 1] -= 0.5 * lack
        if spread:
            shift = max(0.0, 0.01 - spread[0]) - max(0.0, spread[-1] - 0.99)
            spread = [place + shift for place in spread] if shift else spread
    for i, at, place in zip(order, spread, places):
        axes.annotate(
            words(texts[i]), (1.0, place), (1.035, at), xycoords="axes fraction", textcoords="axes fraction",
            fontsize=8, va="center", arrowprops=LEADER,
            annotation_clip=False,
        )  # fmt: skip


def _short(name: str) -> str:
    """Name of a mode, as many of its parts as there is room for."""
    parts = name.split(", ")
    while len(parts) > 1 and len(", ".join(parts)) > LONGEST:
        parts.pop()
    return re.sub(r"\s+", " ", ", ".join(parts))


def _crossings(axes: "Axes", crossings: Sequence[Mapping[str, Any]]) -> None:
    for kind, marker in MARKERS.items():
        own = [item for item in crossings if item["kind"] == kind]
        if own:
            axes.plot(
                [item["speed_rpm"] for item in own], [item["frequency_Hz"] for item in own], marker,
                color=ORDER_STYLES[kind]["color"], markersize=3.6, label=f"crossing, {kind} order", zorder=5,
            )  # fmt: skip


def _whole(value: float, position: float = 0.0) -> str:
    text = f"{value:,.0f}" if value >= 10000 else f"{value:.0f}"
    return text.replace(",", NARROW_SPACE)


def _some(value: float, position: float = 0.0) -> str:
    """Label of minor ticks: 2 and 5 of each decade."""
    lead = value / 10.0 ** np.floor(np.log10(value) + 1e-9)
    return _whole(value) if round(lead, 6) in (2.0, 5.0) else ""


def dwell_figure(dwell: Mapping[str, Any]) -> "Figure":
    """Highest share of every kind; grey where the rig should not dwell."""
    figure = new_figure(2.9)
    axes = figure.subplots()
    high = dwell["highest"]
    for number, (key, label) in enumerate(BAND_KINDS.items()):
        if key in high:
            axes.plot(high["speed_rpm"], high[key], **curve_style(number).drawn, linewidth=1.0, label=label)
    for number, band in enumerate(dwell["bands"]):
        axes.axvspan(
            band["low_rpm"], min(band["high_rpm"], dwell["high_rpm"]), color="#e3e7eb", linewidth=0, zorder=0,
            label="band to avoid" if number == 0 else None,
        )  # fmt: skip
    for number, limit in enumerate(dict.fromkeys((dwell["share_limit"], dwell["shaft_share_limit"]))):
        axes.axhline(
            limit, color=INK, linewidth=0.7, linestyle=(0, (6.0, 2.0)),
            label=None if number else "from which a peak counts: meshes, shafts",
        )  # fmt: skip
    for stage in dwell["stages"]:
        if stage["kind"] == "dwell":
            colour = VERDICT_COLOURS["fail" if stage["band"] else "pass"]
            axes.axvline(stage["speed_rpm"], color=colour, linewidth=1.1)
            axes.annotate(
                words(stage["stage"]), (stage["speed_rpm"], 1.0), xycoords=("data", "axes fraction"),
                textcoords="offset points", xytext=(0, 3), ha="center", fontsize=8, color=colour,
            )  # fmt: skip
    axes.set_xlim(0, dwell["high_rpm"])
    axes.set_ylim(bottom=0)
    axes.tick_params(colors=MUTED)
    finish(axes, "pinion speed n [rpm]", "dynamic share [–]")
    legend_right(axes)
    figure.subplots_adjust(left=0.075, right=0.65, top=0.92, bottom=0.16)
    return figure


def section_torque_figure(over_speed: Mapping[str, Any], held: Mapping[str, float]) -> "Figure":
    """Half the peak-to-peak torque: meshes and joints above, the highest section of every shaft below.

    held : pinion speed of every held stage [rpm]
    """
    joints = [place for place in over_speed["places"] if place["kind"] != "shaft"]
    joints.sort(key=lambda place: list(PART_KINDS).index(place["kind"]))
    shafts = highest_sections(over_speed["places"])
    figure = new_figure(5.2)
    upper, lower = figure.subplots(2, 1, sharex=True)
    torque = stated_quantity(over_speed["torque"])
    for axes, places, title in (
        (upper, joints, f"Meshes, couplings and gear seats, torque of the curve {torque}"),
        (lower, shafts, "Shafts, the section with the highest peak"),
    ):
        for number, place in enumerate(places):
            axes.plot(
                over_speed["speed_rpm"], place["half_peak_to_peak_Nm"], **curve_style(number).drawn,
                linewidth=1.0, label=_label(place),
            )  # fmt: skip
        _held_lines(axes, held)
        axes.set_xlim(0, 1.02 * over_speed["speed_rpm"][-1])
        axes.set_ylim(bottom=0)
        finish(axes, "", f"half peak-to-peak torque\n[{unit_text('Nm')}]", title)
        legend_right(axes)
    lower.set_xlabel("pinion speed n [rpm]")
    figure.subplots_adjust(left=0.085, right=0.72, top=0.945, bottom=0.095, hspace=0.2)
    return figure


def highest_sections(places: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Of every shaft the section with the highest half peak-to-peak torque over speed."""
    found: dict[str, Mapping[str, Any]] = {}
    for place in places:
        if place["kind"] == "shaft":
            before = found.get(place["part"])
            if before is None or max(place["half_peak_to_peak_Nm"]) > max(before["half_peak_to_peak_Nm"]):
                found[place["part"]] = place
    return list(found.values())


def _label(place: Mapping[str, Any]) -> str:
    kind = place["kind"]
    return words(place["place"] if kind == "shaft" else f"{PART_KINDS[kind]} {place['part']}")


def _held_lines(axes: "Axes", held: Mapping[str, float]) -> None:
    for speed in held.values():
        axes.axvline(speed, color=MUTED, linewidth=0.9, linestyle=(0, (7.0, 1.6, 1.4, 1.6)))


def whirl_figure(lateral: LateralVibration, limit: float | None) -> "Figure":
    """Orbit (larger half axis, all shaft lines) of every bearing over speed [um], a plot for each gearbox.

    limit : most peak-to-peak motion over the diametral clearance
    """
    boxes: dict[str, list[BearingOrbit]] = {}
    for bearing in lateral.curve.bearings:
        boxes.setdefault(BearingName.read(bearing.bearing).gearbox, []).append(bearing)
    speeds = value_in_unit(lateral.curve, "speed")
    height = 0.5 + 2.4 * len(boxes)
    figure = new_figure(height)
    held = sorted({value_in_unit(stage, "speed") for stage in lateral.stages})
    for axes, (box, bearings) in zip(
        figure.subplots(len(boxes), 1, squeeze=False)[:, 0], boxes.items(), strict=True
    ):
        _orbits(axes, speeds, bearings)
        _limit(axes, bearings, limit)
        for speed in held:
            axes.axvline(speed, color=MUTED, linewidth=0.8, linestyle=":")
        finish(axes, "speed where the case counts it, n [rpm]", "orbit, 0-peak [µm]", f"Gearbox {words(box)}")
        axes.set_xlim(0.0, speeds[-1])
        legend_right(axes)
    figure.subplots_adjust(left=0.085, right=0.74, top=1 - 0.32 / height, bottom=0.47 / height, hspace=0.45)
    return figure


def _orbits(axes: "Axes", speeds: Sequence[float], bearings: list[BearingOrbit]) -> None:
    axes.set_yscale("log")
    for number, bearing in enumerate(bearings):
        name = words(BearingName.read(bearing.bearing).part)
        axes.plot(speeds, value_in_unit(bearing, "orbit"), **curve_style(number).drawn, label=name)


def _limit(axes: "Axes", bearings: list[BearingOrbit], limit: float | None) -> None:
    """Half of the least clearance of a film, and what of it may be used."""
    clearances = [value_in_unit(bearing, "clearance") for bearing in bearings if bearing.clearance]
    if not clearances:
        return
    radial = 0.5 * min(clearances)
    axes.axhline(radial, color=VERDICT_COLOURS["fail"], linewidth=1.2, label="least radial clearance")
    if limit is not None:
        axes.axhline(
            limit * radial, color=VERDICT_COLOURS["fail"], linewidth=1.0, linestyle="--",
            label=f"{100.0 * limit:.0f} % of it, limit",
        )  # fmt: skip


# Waterfalls of run-up and run-down, and spectra at the held stages.

DECADES = 3.0
"""Of the colours, below the highest amplitude."""
HARMONICS = 4
"""Mesh orders named in a figure."""
KHZ = 1e-3


def waterfall_figure(rows: Sequence[Waterfall], styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox: frequency across, speed upwards, amplitude as colour; mesh orders named at the edge."""
    from matplotlib.colors import LogNorm

    figure, panels = panels_in_pairs(3.9, len(rows))
    lines = figure.get_figheight() / 3.9
    top = max(max(map(max, row.amplitude)) for row in rows)
    bottom = top * 10.0**-DECADES
    norm = LogNorm(bottom, top)
    for axes, row in zip(panels[:, 0], rows, strict=True):
        amplitude = np.maximum(np.array(row.amplitude), bottom)
        speed, frequency = np.array(value_in_unit(row, "speed")), KHZ * np.array(row.frequency)
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
        gearbox_title(axes, f"Gearbox {words(row.mesh)}, stage {words(row.stage)}", styles[row.mesh])
    figure.subplots_adjust(
        left=0.085, right=0.87, top=1.0 - 0.12 / lines, bottom=0.13 / lines, wspace=0.24, hspace=0.32
    )
    beside = figure.add_axes((0.895, 0.13 / lines, 0.014, 1.0 - 0.25 / lines))
    bar = figure.colorbar(image, cax=beside)
    bar.set_label(f"amplitude of the dynamic torque [{unit_text('Nm')}]")
    return figure


def _mesh_orders(axes: "Axes", row: Waterfall, last: float) -> None:
    """f_z and its multiples: a short mark at the edge they leave the plot by."""
    low, *_, high = value_in_unit(row, "speed")
    for harmonic in range(1, HARMONICS + 1):
        slope = KHZ * harmonic * row.per_turn / 60.0
        speed = min(high, last / slope)
        if speed <= low:
            continue
        text = "f_z" if harmonic == 1 else f"{harmonic} f_z"
        beyond = slope * high > last
        axes.annotate(
            text, (slope * speed, speed), textcoords="offset points", xytext=(-3, 2) if beyond else (-9, -2),
            ha="right", va="top", fontsize=8, color="white", annotation_clip=False,
        )  # fmt: skip


def spectrum_figure(rows: Sequence[HeldSpectrum], styles: Mapping[str, CurveStyle]) -> "Figure":
    """A panel for each gearbox and held stage: time run as a line, mesh orders of the periodic response as stems."""
    figure = new_figure(0.5 + 2.0 * len(rows))
    panels = figure.subplots(len(rows), 1, squeeze=False)[:, 0]
    for axes, row in zip(panels, rows, strict=True):
        style = styles[row.mesh]
        floor = 1e-6 * row.mean
        if row.order:
            axes.plot(
                row.order, np.maximum(row.amplitude, floor), color=style.colour, linewidth=0.7,
                label="time run",
            )  # fmt: skip
        orders, heights = row.harmonic_order, row.harmonic_amplitude
        axes.vlines(orders, floor, heights, color=INK, linewidth=1.0)
        axes.plot(orders, heights, "o", color=INK, markersize=2.6, label="periodic response")
        for harmonic in range(1, HARMONICS + 1):
            height = max(
                (h for o, h in zip(orders, heights, strict=True) if abs(o - harmonic * row.teeth) < 0.01),
                default=None,
            )
            if height is not None:
                axes.annotate(
                    "f_z" if harmonic == 1 else f"{harmonic} f_z", (harmonic * row.teeth, height),
                    textcoords="offset points", xytext=(0, 4), ha="center", fontsize=8,
                )  # fmt: skip
        axes.set_yscale("log")
        highest = max([*heights, *row.amplitude], default=1.0)
        axes.set_ylim(max(floor, 1e-5 * highest), 6.0 * highest)
        axes.set_xlim(0, (HARMONICS + 0.4) * row.teeth)
        finish(axes, "", f"amplitude [{unit_text('Nm')}]")
        title = f"Gearbox {words(row.mesh)}, stage {words(row.stage)}, {value_in_unit(row, 'speed'):.0f} rpm"
        gearbox_title(axes, title, style)
        axes.tick_params(colors=MUTED)
    panels[0].legend(loc="upper right", ncols=2)
    panels[-1].set_xlabel("order of the pinion [–]")
    height = figure.get_figheight()
    figure.subplots_adjust(left=0.085, right=0.985, top=1 - 0.3 / height, bottom=0.45 / height, hspace=0.42)
    return figure
