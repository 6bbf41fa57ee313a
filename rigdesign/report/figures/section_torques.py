"""Dynamic torque in shafts, joints and meshes over speed."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rigdesign.report.figures.drawing import finish, legend_right, new_figure, stated_quantity, words
from rigdesign.report.numbers import unit_text
from rigdesign.report.palette import MUTED, curve_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KINDS = {"mesh": "mesh", "coupling": "coupling", "spline": "seat of", "motor": "joint of the"}
"""Words in front of the name of a joint."""


def section_torque_figure(over_speed: Mapping[str, Any], held: Mapping[str, float]) -> "Figure":
    """Half the peak-to-peak torque: meshes and joints above, the highest section of every shaft below.

    held : pinion speed of every held stage [rpm]
    """
    joints = [place for place in over_speed["places"] if place["kind"] != "shaft"]
    joints.sort(key=lambda place: list(KINDS).index(place["kind"]))
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
    return words(place["place"] if kind == "shaft" else f"{KINDS[kind]} {place['part']}")


def _held_lines(axes: "Axes", held: Mapping[str, float]) -> None:
    for speed in held.values():
        axes.axvline(speed, color=MUTED, linewidth=0.9, linestyle=(0, (7.0, 1.6, 1.4, 1.6)))
