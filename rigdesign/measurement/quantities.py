"""What is measured on a rig: the unit each quantity may have, and how its uncertainty is written."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.units import KINDS

Reading = TypeVar("Reading", float, NDArray[np.float64])
SettingQuantity = Literal["speed", "torque", "inlet_temperature", "flow", "ambient_temperature"]

DIFFERENCES: Mapping[str, str] = {"temperature": "temperature_difference"}
"""Kind of a point on a scale -> kind of a distance on it; all others are their own."""


@dataclass(frozen=True)
class Measured:
    """A quantity as it is read.

    kind : name in ``rigdesign.base.units.KINDS`` of the reading
    uncertainty : an example of its uncertainty
    limits : lowest and highest reading that the quantity can have on any rig [SI; K]
    offset, scale : systematic uncertainty of a usual instrument where a setting states none [SI; K], relative
    """

    kind: str
    uncertainty: str
    limits: tuple[float, float]
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


LIQUID_OR_HOT = (173.15, 1273.15)
"""Temperatures [K]: no oil flows below, no steel carries above."""
TURNING = (0.0, 500_000.0 * math.pi / 30.0)
"""Speeds [rad/s]: a gear of 40 mm has 1000 m/s at its tips there and bursts below."""
TORQUES = (-1e8, 1e8)
"""[N m]; the largest gearboxes that are tested carry 2e7."""
POWERS = (-1e9, 1e9)
CLEARANCES = (-1e-3, 1.0)
"""[m]; a dial gauge may read a closed gap a little below zero."""
STRAINS = (-0.05, 0.05)
"""Foil gauges end at 3 to 5 %."""
LEAST_UNCERTAINTY = 1e-15
"""Share of the span of a quantity below which an uncertainty is none that an instrument has."""

SETTINGS: Mapping[str, Measured] = {
    "speed": Measured("speed", "1 rpm", TURNING),
    "torque": Measured("torque", "0.5 N m", (0.0, TORQUES[1]), scale=0.01),
    "inlet_temperature": Measured("temperature", "0.3 K", LIQUID_OR_HOT, offset=0.3),
    "flow": Measured("flow", "0.05 l/min", (0.0, 10.0), scale=0.02),
    "ambient_temperature": Measured("temperature", "0.5 K", LIQUID_OR_HOT, offset=0.5),
}
"""Quantities that say how an operating point was run."""

CHANNELS: Mapping[str, Measured] = {
    "temperature": Measured("temperature", "0.1 K", LIQUID_OR_HOT),
    "warming_rate": Measured("warming_rate", "0.5 K/h", (-1.0, 1.0)),
    "oil_outlet_temperature": Measured("temperature", "0.1 K", LIQUID_OR_HOT),
    "motor_power": Measured("power", "10 W", POWERS),
    "drive_torque": Measured("torque", "0.02 N m", TORQUES),
    "torque": Measured("torque", "0.05 N m", TORQUES),
    "angle": Measured("angle", "0.001 mrad", (-1e7, 1e7)),
    "natural_frequency": Measured("frequency", "0.5 Hz", (1e-3, 1e7)),
    "backlash": Measured("length", "2 um", CLEARANCES),
    "seal_gap": Measured("length", "5 um", CLEARANCES),
    "acceleration": Measured("acceleration", "0.02 m/s2", (-1e6, 1e6)),
    "shaft_displacement": Measured("length", "0.1 um", (-0.01, 0.01)),
    "resonance_speed": Measured("speed", "10 rpm", TURNING),
    "root_strain": Measured("strain", "2 um/m", STRAINS),
}
"""Quantities of ``rigdesign.prediction.model.Channel``."""


def impossible(values: NDArray[np.float64], measured: Measured) -> NDArray[np.bool_]:
    """(n,) whether readings (n,) [SI] lie outside the limits of their quantity; missing ones (NaN) do not."""
    low, high = measured.limits
    return np.asarray((values < low) | (values > high))


def impossible_text(measured: Measured, unit: str, count: int) -> str:
    """What is wrong with the first of ``count`` impossible readings, and what to do; ``unit`` of its kind."""
    low, high = (units.display(limit, measured.kind, unit) for limit in measured.limits)
    more = f", as are {count - 1} more" if count > 1 else ""
    return f"outside {low:.6g} to {high:.6g} {unit}{more}; not used, look at sensor, cable and unit"


def accepted_unit(text: str, kind: str) -> str | None:
    """The unit of ``kind`` that ``text`` spells, as the tables of units write it; None for any other text."""
    return next((unit for unit in KINDS[kind].units if units.same_unit(text, unit)), None)


def unit_kind(text: str) -> str | None:
    """Kind of quantity the unit belongs to; None for an unknown one."""
    return next((kind for kind in KINDS if accepted_unit(text, kind) is not None), None)


def unit_problem(text: str, kind: str) -> str:
    """What is wrong with a unit that is not one of ``kind``."""
    other = unit_kind(text)
    problem = "is not a known unit" if other is None else f"is a unit of {KINDS[other].label}"
    return f"{problem}, not of {KINDS[kind].label}"


def same_worth(first: str, second: str, kind: str) -> bool:
    """Whether two texts spell units of ``kind`` that are worth the same: ``rpm``, ``1/min``."""
    spelled = [accepted_unit(text, kind) for text in (first, second)]
    return None not in spelled and len({units.worth(kind, unit) for unit in spelled if unit}) == 1


def to_si(value: Reading, kind: str, unit: str) -> Reading:
    """SI value of a number or array of numbers in ``unit``."""
    factor, offset = units.worth(kind, unit)
    return value * factor + offset
