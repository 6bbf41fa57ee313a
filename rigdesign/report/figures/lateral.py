"""Motion once a turn in the bearings over speed, against the clearance of the films."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, words
from rigdesign.report.palette import MUTED, VERDICT_COLOURS, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def whirl_figure(lateral: Mapping[str, Any], limit: float | None) -> "Figure":
    """Orbit (larger half axis, all shaft lines) of every bearing over speed [um], a plot for each gearbox.

    limit : most peak-to-peak motion over the diametral clearance
    """
    curve = lateral["curve"]
    boxes: dict[str, list[Mapping[str, Any]]] = {}
    for bearing in curve["bearings"]:
        boxes.setdefault(bearing["bearing"].split(".")[0], []).append(bearing)
    height = 0.5 + 2.4 * len(boxes)
    figure = new_figure(height)
    held = sorted({stage["speed_rpm"] for stage in lateral["stages"]})
    for axes, (box, bearings) in zip(
        figure.subplots(len(boxes), 1, squeeze=False)[:, 0], boxes.items(), strict=True
    ):
        _orbits(axes, curve["speed_rpm"], bearings)
        _limit(axes, bearings, limit)
        for speed in held:
            axes.axvline(speed, color=MUTED, linewidth=0.8, linestyle=":")
        finish(axes, "speed where the case counts it, n [rpm]", "orbit, 0-peak [µm]", f"Gearbox {words(box)}")
        axes.set_xlim(0.0, curve["speed_rpm"][-1])
        legend_right(axes)
    figure.subplots_adjust(left=0.085, right=0.74, top=1 - 0.32 / height, bottom=0.47 / height, hspace=0.45)
    return figure


def _orbits(axes: "Axes", speeds: list[float], bearings: list[Mapping[str, Any]]) -> None:
    axes.set_yscale("log")
    for number, bearing in enumerate(bearings):
        name = words(bearing["bearing"].split(".", 1)[1])
        axes.plot(speeds, bearing["orbit_um"], **curve_style(number).drawn, label=name)


def _limit(axes: "Axes", bearings: list[Mapping[str, Any]], limit: float | None) -> None:
    """Half of the least clearance of a film, and what of it may be used."""
    clearances = [bearing["clearance_um"] for bearing in bearings if bearing["clearance_um"]]
    if not clearances:
        return
    radial = 0.5 * min(clearances)
    axes.axhline(radial, color=VERDICT_COLOURS["fail"], linewidth=1.2, label="least radial clearance")
    if limit is not None:
        axes.axhline(
            limit * radial, color=VERDICT_COLOURS["fail"], linewidth=1.0, linestyle="--",
            label=f"{100.0 * limit:.0f} % of it, limit",
        )  # fmt: skip
