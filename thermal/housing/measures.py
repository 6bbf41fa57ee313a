"""Lengths of a gearbox: what they have to keep, and the error of those that do not."""

import math
from typing import Literal

from thermal.errors import ThermalInputError

Side = Literal["front", "rear"]
SIDES: tuple[Side, Side] = ("front", "rear")
MINIMUM_LAND = 1e-3
"""Least length or thickness [m] that geometry may leave between two features."""


class GeometryError(ThermalInputError):
    """A gearbox that cannot be built; the message names the quantity, its value, the limit and the remedy."""


def require_positive(record: object, *names: str) -> None:
    """Raises GeometryError for a length of ``record`` that is not above 0."""
    for name in names:
        value = getattr(record, name)
        if not (math.isfinite(value) and value > 0.0):
            raise GeometryError(
                f"{_label(record)}{name} = {value} m must be greater than 0; give a positive length"
            )


def require_not_negative(record: object, *names: str) -> None:
    """Raises GeometryError for a length of ``record`` below 0."""
    for name in names:
        value = getattr(record, name)
        if not (math.isfinite(value) and value >= 0.0):
            raise GeometryError(f"{_label(record)}{name} = {value} m must not be negative; give 0 or more")


def _label(record: object) -> str:
    """Who owns the quantity: the shaft by name, the field, the gear; nothing for the housing itself."""
    labels = {
        "ShaftGeometry": f"shaft {getattr(record, 'name', '')}: ",
        "EndBearing": "bearing: ",
        "GearDisc": "gear: ",
        "ClampingField": "field: ",
    }
    return labels.get(type(record).__name__, "")
