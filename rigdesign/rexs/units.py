"""Units of REXS: what each unit id of the database is worth in SI, and the spellings in which exporters write it.

Source: the unit list of the REXS database, versions 1.0 to 2.0.0. ``°`` of the versions to 1.3 is ``deg`` of the later
ones, ``mum`` is a micrometre, ``C`` a temperature in degrees Celsius, ``1e-6 / C`` a coefficient of thermal expansion.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from rigdesign.base.quantity_kinds import ZERO_CELSIUS


class RexsUnitError(ValueError):
    """A unit that is not known, or one of another quantity than the attribute has."""


@dataclass(frozen=True)
class RexsUnit:
    """One unit: value in SI = number * factor + offset.

    dimension : SI unit of the quantity; hardness numbers and decibels have none and stand for themselves
    """

    dimension: str
    factor: float = 1.0
    offset: float = 0.0


UNITS: Mapping[str, RexsUnit] = {
    "%": RexsUnit("1", 1e-2),
    "(N / mm^2)^0.5": RexsUnit("Pa^0.5", 1e3),
    "1 / min": RexsUnit("rad/s", math.pi / 30.0),
    "1 / mm": RexsUnit("1/m", 1e3),
    "1 / s": RexsUnit("1/s"),
    "1e-6 / C": RexsUnit("1/K", 1e-6),
    "1e-6 mm^3 / (N m)": RexsUnit("m^2/N", 1e-15),
    "C": RexsUnit("K", offset=ZERO_CELSIUS),
    "dB": RexsUnit("dB"),
    "deg": RexsUnit("rad", math.pi / 180.0),
    "h": RexsUnit("s", 3600.0),
    "HB": RexsUnit("HB"),
    "HRC": RexsUnit("HRC"),
    "HV": RexsUnit("HV"),
    "Hz": RexsUnit("1/s"),
    "J / (kg K)": RexsUnit("J/(kg K)"),
    "K": RexsUnit("K"),
    "K (m / s)^0.75 mm^1.75 / W": RexsUnit("K (m/s)^0.75 m^1.75/W", 10.0**-5.25),
    "K / mus": RexsUnit("K/s", 1e6),
    "K m^2 / W": RexsUnit("K m^2/W"),
    "kg": RexsUnit("kg"),
    "kg / dm^3": RexsUnit("kg/m^3", 1e3),
    "kg / mm": RexsUnit("kg/m", 1e3),
    "kg m^2": RexsUnit("kg m^2"),
    "kN": RexsUnit("N", 1e3),
    "kW": RexsUnit("W", 1e3),
    "l / min": RexsUnit("m^3/s", 1e-3 / 60.0),
    "m / s": RexsUnit("m/s"),
    "m / s^2": RexsUnit("m/s^2"),
    "m^2": RexsUnit("m^2"),
    "m^3 / s": RexsUnit("m^3/s"),
    "mg": RexsUnit("kg", 1e-6),
    "mm": RexsUnit("m", 1e-3),
    "mm / h": RexsUnit("m/s", 1e-3 / 3600.0),
    "mm^2": RexsUnit("m^2", 1e-6),
    "mm^2 / N": RexsUnit("1/Pa", 1e-6),
    "mm^2 / s": RexsUnit("m^2/s", 1e-6),
    "MPa": RexsUnit("Pa", 1e6),
    "mPa s": RexsUnit("Pa s", 1e-3),
    "MRev": RexsUnit("1", 1e6),
    "mum": RexsUnit("m", 1e-6),
    "mus": RexsUnit("s", 1e-6),
    "N": RexsUnit("N"),
    "N / (mm mum)": RexsUnit("Pa", 1e9),
    "N / (mm s^0.5 K)": RexsUnit("N/(m s^0.5 K)", 1e3),
    "N / m": RexsUnit("N/m"),
    "N / mm": RexsUnit("N/m", 1e3),
    "N / mm^2": RexsUnit("Pa", 1e6),
    "N / rad": RexsUnit("N/rad"),
    "N m": RexsUnit("N m"),
    "N mm / rad": RexsUnit("N m/rad", 1e-3),
    "none": RexsUnit("1"),
    "Ohm": RexsUnit("Ohm"),
    "Pa": RexsUnit("Pa"),
    "pF": RexsUnit("F", 1e-12),
    "pS / m": RexsUnit("S/m", 1e-12),
    "rad": RexsUnit("rad"),
    "rad / s": RexsUnit("rad/s"),
    "s": RexsUnit("s"),
    "V": RexsUnit("V"),
    "V / m": RexsUnit("V/m"),
    "W": RexsUnit("W"),
    "W / (m K)": RexsUnit("W/(m K)"),
    "W / (m^2 K)": RexsUnit("W/(m^2 K)"),
    "W / mm": RexsUnit("W/m", 1e3),
}
"""Unit id of the database -> its worth; a turn counts 2 pi in ``1 / min`` and 1 in ``MRev``."""

_ALIASES: Mapping[str, str] = {"°": "deg", "°C": "C", "µm": "mum", "um": "mum", "-": "none", "rpm": "1 / min"}
_LONGEST = 40


def rexs_unit(text: str) -> RexsUnit:
    """Unit of a REXS file.

    Parameters
    ----------
    text : unit id as written; blanks and ``²``, ``³`` may differ from the database

    Raises
    ------
    RexsUnitError
        The unit is none of the database.
    """
    found = UNITS.get(text) or _by_spelling().get(_compact(text)) if len(text) <= _LONGEST else None
    if found is None:
        raise RexsUnitError(f"unit {text[:_LONGEST]!r} is none of REXS")
    return found


def to_si(number: float, written: str | None, standard: str) -> float:
    """Value in SI units of a number of a REXS file, with 15 digits: 82.46 mm are 0.08246 m.

    Parameters
    ----------
    number : as written
    written : unit as written; None or empty stands for the unit that the database gives the attribute
    standard : unit id that the database gives the attribute

    Raises
    ------
    RexsUnitError
        The unit is not known, or not of the quantity the attribute has, such as ``none`` for a length.
    """
    expected = UNITS[standard]
    unit = rexs_unit(written) if written else expected
    if unit.dimension != expected.dimension:
        raise RexsUnitError(f"unit {written!r} where the attribute is measured in {standard!r}")
    return float(f"{number * unit.factor + unit.offset:.15g}")


def _compact(text: str) -> str:
    for given, plain in (("²", "^2"), ("³", "^3"), ("μ", "µ"), ("·", ""), ("*", "")):
        text = text.replace(given, plain)
    return "".join(text.split())


@cache
def _by_spelling() -> dict[str, RexsUnit]:
    known = {_compact(name): unit for name, unit in UNITS.items()}
    return known | {_compact(alias): UNITS[name] for alias, name in _ALIASES.items()}
