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


@dataclass(frozen=True)
class DisplayUnit:
    """A unit of results: shown number = ``per_si`` (value - ``zero``)."""

    name: str
    per_si: float = 1.0
    zero: float = 0.0

    def shown(self, value: float) -> float:
        """The number in this unit of a value in SI."""
        return self.per_si * (value - self.zero)


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
NUMBER = DisplayUnit("-")
