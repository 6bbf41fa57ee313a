"""Units in which results are shown: the one place that turns SI into them."""

import math
from dataclasses import dataclass

from rigdesign.base.units import ZERO_CELSIUS

ZERO = ZERO_CELSIUS
"""0 degC [K]."""
MM, UM, MRAD = 1e3, 1e6, 1e3
KW, MPA = 1e-3, 1e-6
L_MIN = 6e4
"""Litres per minute in a cubic metre per second."""
RPM = 30.0 / math.pi
HOUR = 3600.0
"""[s]"""


_KEY = str.maketrans({"/": "_", " ": None, "(": None, ")": None})


@dataclass(frozen=True)
class DisplayUnit:
    """A unit of results: shown number = ``per_si`` (value - ``zero``)."""

    name: str
    per_si: float = 1.0
    zero: float = 0.0

    def shown(self, value: float) -> float:
        """The number in this unit of a value in SI."""
        return self.per_si * (value - self.zero)

    def stored(self, value: float) -> float:
        """The value in SI of a number in this unit."""
        return value / self.per_si + self.zero

    @property
    def suffix(self) -> str:
        """At the end of a key: ``_l_min``; none for a plain number."""
        return "" if self.name == "-" else "_" + self.name.translate(_KEY)


DEGREE_CELSIUS = DisplayUnit("degC", zero=ZERO)
KELVIN = DisplayUnit("K")
MILLIMETRE = DisplayUnit("mm", MM)
MICROMETRE = DisplayUnit("um", UM)
MILLIRADIAN = DisplayUnit("mrad", MRAD)
MEGAPASCAL = DisplayUnit("MPa", MPA)
LITRE_PER_MINUTE = DisplayUnit("l/min", L_MIN)
KILOWATT = DisplayUnit("kW", KW)
REVOLUTION_PER_MINUTE = DisplayUnit("rpm", RPM)
NEWTON_METRE = DisplayUnit("N m")
HOURS = DisplayUnit("h", 1.0 / HOUR)
NUMBER = DisplayUnit("-")

UNITS = {
    unit.name: unit
    for unit in (
        DEGREE_CELSIUS,
        KELVIN,
        MILLIMETRE,
        MICROMETRE,
        MILLIRADIAN,
        MEGAPASCAL,
        LITRE_PER_MINUTE,
        KILOWATT,
        REVOLUTION_PER_MINUTE,
        NEWTON_METRE,
        HOURS,
        NUMBER,
        *map(DisplayUnit, ("W", "N", "Hz", "s", "m2")),
        DisplayUnit("ms", 1e3),
        DisplayUnit("deg", 180.0 / math.pi),
        DisplayUnit("N/mm", 1e-3),
        DisplayUnit("N/um", 1e-6),
        DisplayUnit("kN m/rad", 1e-3),
        DisplayUnit("m3/h", HOUR),
        DisplayUnit("W/(m2 K)"),
    )
}
"""By name."""
