"""What is measured on a rig: the unit each quantity may have, and how its uncertainty is written."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from rigdesign import units
from rigdesign.kinds import KINDS

SettingQuantity = Literal["speed", "torque", "inlet_temperature", "flow", "ambient_temperature"]

DIFFERENCES: Mapping[str, str] = {"temperature": "temperature_difference"}
"""Kind of a point on a scale -> kind of a distance on it; all others are their own."""


@dataclass(frozen=True)
class Measured:
    """A quantity as it is read.

    kind : name in ``rigdesign.kinds.KINDS`` of the reading
    uncertainty : an example of its uncertainty
    offset, scale : systematic uncertainty of a usual instrument where a setting states none [SI; K], relative
    """

    kind: str
    uncertainty: str
    offset: float = 0.0
    scale: float = 0.0

    @property
    def spread(self) -> str:
        """Kind of its uncertainty."""
        return DIFFERENCES.get(self.kind, self.kind)

    @property
    def unit(self) -> str:
        """The usual unit."""
        return KINDS[self.kind].display_unit


SETTINGS: Mapping[str, Measured] = {
    "speed": Measured("speed", "1 rpm"),
    "torque": Measured("torque", "0.5 N m", scale=0.01),
    "inlet_temperature": Measured("temperature", "0.3 K", offset=0.3),
    "flow": Measured("flow", "0.05 l/min", scale=0.02),
    "ambient_temperature": Measured("temperature", "0.5 K", offset=0.5),
}
"""Quantities that say how an operating point was run."""

CHANNELS: Mapping[str, Measured] = {
    "temperature": Measured("temperature", "0.1 K"),
    "oil_outlet_temperature": Measured("temperature", "0.1 K"),
    "motor_power": Measured("power", "10 W"),
    "drive_torque": Measured("torque", "0.02 N m"),
    "torque": Measured("torque", "0.05 N m"),
    "angle": Measured("angle", "0.001 mrad"),
    "natural_frequency": Measured("frequency", "0.5 Hz"),
    "backlash": Measured("length", "2 um"),
    "seal_gap": Measured("length", "5 um"),
}
"""Quantities of ``rigdesign.prediction.model.Channel``."""


def accepted_unit(text: str, kind: str) -> str | None:
    """The unit of ``kind`` that ``text`` spells, as the tables of units write it; None for any other text."""
    return next((unit for unit in KINDS[kind].units if units.same_unit(text, unit)), None)


def unit_kind(text: str) -> str | None:
    """Kind of quantity the unit belongs to; None for an unknown one."""
    return next((kind for kind in KINDS if accepted_unit(text, kind) is not None), None)


def same_worth(first: str, second: str, kind: str) -> bool:
    """Whether two texts spell units of ``kind`` that are worth the same: ``rpm``, ``1/min``."""
    spelled = [accepted_unit(text, kind) for text in (first, second)]
    return None not in spelled and len({units.worth(kind, unit) for unit in spelled if unit}) == 1


def to_si(value: float, kind: str, unit: str) -> float:
    """SI value of a number in ``unit``."""
    factor, offset = units.worth(kind, unit)
    return value * factor + offset
