"""Directions of accelerometers and proximity probes: an axis of the case, or an angle across the shafts."""

import math

from rigdesign.base import units

Direction = tuple[float, float, float]
"""Unit vector (x, y, z): x along the shafts, y across, z up."""

AXES: dict[str, Direction] = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "-x": (-1.0, 0.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
}
REMEDY = 'write "y", "z", "x", one of them with a minus, or an angle from y towards z such as "45 deg"'


def direction_of(text: str) -> Direction:
    """The direction that a text spells; `rigdesign.base.units.QuantityError` where it spells none."""
    known = AXES.get(text.strip())
    if known is not None:
        return known
    angle = units.parse(text, "angle")
    return 0.0, math.cos(angle), math.sin(angle)


def direction_text(direction: Direction) -> str:
    """The text that spells a direction."""
    for name, axis in AXES.items():
        if axis == direction:
            return name
    return f"{math.degrees(math.atan2(direction[2], direction[1])):.10g} deg"
