"""Quantities at the border: ``"140 degC"`` in a case file, 413.15 inside, ``"140 degC"`` in a report.

A closed table says which units a kind of quantity accepts; pint knows what they are worth. It is imported
when the first unit is met, and each unit is asked once. Absolute temperature and temperature difference are
different kinds, because 10 K more and 10 degC are not the same thing. Speeds count revolutions: ``1/min`` is
one revolution a minute.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, NoReturn

from rigdesign.base.errors import CaseError, Fault

if TYPE_CHECKING:
    from pint import UnitRegistry

# Kinds of quantity a case file knows: the unit inside, the units accepted, the unit shown.

ZERO_CELSIUS = 273.15
"""0 degC [K]."""


@dataclass(frozen=True)
class QuantityKind:
    """A kind of quantity.

    si : unit inside, in pint's words
    units : spelling in the case file -> unit in pint's words; the first is the one used for display
    example : a quantity of this kind as a user writes it
    """

    name: str
    si: str
    units: Mapping[str, str]
    example: str

    @property
    def display_unit(self) -> str:
        """Unit of tables and axes."""
        return next(iter(self.units))

    @property
    def remedy(self) -> str:
        """What to write: the accepted units and an example."""
        return f'write a {self.label} such as "{self.example}" (units: {", ".join(self.units)})'

    def like(self, example: str) -> "QuantityKind":
        """The kind with another example, whose unit then comes first: hints for the size of what is meant."""
        unit = example.partition(" ")[2]
        return replace(self, example=example, units={unit: self.units[unit], **self.units})

    @property
    def label(self) -> str:
        """Name in a sentence."""
        return self.name.replace("_", " ")


def _kinds(*kinds: QuantityKind) -> dict[str, QuantityKind]:
    return {kind.name: kind for kind in kinds}


KINDS: Mapping[str, QuantityKind] = _kinds(
    QuantityKind("length", "m", {"mm": "mm", "um": "um", "cm": "cm", "m": "m", "in": "inch"}, "7 mm"),
    QuantityKind("angle", "rad", {"deg": "degree", "rad": "radian", "mrad": "milliradian"}, "20 deg"),
    QuantityKind("volume", "m**3", {"l": "liter", "ml": "milliliter", "m3": "m**3"}, "1.5 l"),
    QuantityKind("mass", "kg", {"kg": "kg", "g": "g"}, "4 kg"),
    QuantityKind(
        "inertia", "kg*m**2", {"kg m2": "kg*m**2", "kg cm2": "kg*cm**2", "g m2": "g*m**2"}, "0.01 kg m2"
    ),
    QuantityKind(
        "unbalance", "kg*m", {"g mm": "g*mm", "kg mm": "kg*mm", "g m": "g*m", "kg m": "kg*m"}, "50 g mm"
    ),
    QuantityKind("temperature", "kelvin", {"degC": "degC", "K": "kelvin", "degF": "degF"}, "140 degC"),
    QuantityKind("temperature_difference", "kelvin", {"K": "kelvin"}, "20 K"),
    QuantityKind(
        "warming_rate",
        "kelvin/second",
        {"K/h": "kelvin/hour", "K/min": "kelvin/minute", "K/s": "kelvin/second"},
        "2 K/h",
    ),
    QuantityKind("time", "s", {"s": "s", "ms": "ms", "min": "minute", "h": "hour", "d": "day"}, "8 s"),
    QuantityKind(
        "recording_time",
        "s",
        {"s": "s", "ms": "ms", "us": "us", "ns": "ns", "min": "minute", "h": "hour", "d": "day"},
        "1 ms",
    ),
    QuantityKind("frequency", "hertz", {"Hz": "hertz", "kHz": "kilohertz"}, "40 kHz"),
    QuantityKind(
        "speed",
        "rad/s",
        {"rpm": "revolution/minute", "1/min": "revolution/minute", "rad/s": "rad/s"},
        "12000 rpm",
    ),
    QuantityKind("velocity", "m/s", {"m/s": "m/s", "km/h": "km/hour"}, "20 m/s"),
    QuantityKind("acceleration", "m/s**2", {"m/s2": "m/s**2", "g": "g_0"}, "2 m/s2"),
    QuantityKind("force", "N", {"N": "N", "kN": "kN"}, "450 N"),
    QuantityKind(
        "torque", "N*m", {"N m": "N*m", "Nm": "N*m", "kN m": "kN*m", "kNm": "kN*m", "N mm": "N*mm"}, "180 N m"
    ),
    QuantityKind("power", "W", {"W": "W", "kW": "kW", "MW": "MW"}, "500 W"),
    QuantityKind(
        "pressure",
        "Pa",
        {"MPa": "MPa", "N/mm2": "MPa", "Pa": "Pa", "kPa": "kPa", "GPa": "GPa", "bar": "bar"},
        "206 GPa",
    ),
    QuantityKind(
        "flow",
        "m**3/s",
        {
            "l/min": "liter/minute",
            "l/h": "liter/hour",
            "l/s": "liter/s",
            "ml/min": "ml/minute",
            "m3/h": "m**3/hour",
            "m3/s": "m**3/s",
        },
        "5 l/min",
    ),
    QuantityKind(
        "density", "kg/m**3", {"kg/m3": "kg/m**3", "g/cm3": "g/cm**3", "kg/l": "kg/liter"}, "1000 kg/m3"
    ),
    QuantityKind(
        "kinematic_viscosity",
        "m**2/s",
        {"mm2/s": "mm**2/s", "cSt": "mm**2/s", "m2/s": "m**2/s"},
        "27.6 mm2/s",
    ),
    QuantityKind(
        "dynamic_viscosity",
        "Pa*s",
        {"mPa s": "mPa*s", "Pa s": "Pa*s", "cP": "mPa*s"},
        "5 mPa s",
    ),
    QuantityKind(
        "heat_capacity",
        "J/(kg*K)",
        {"J/(kg K)": "J/(kg*K)", "J/kgK": "J/(kg*K)", "kJ/(kg K)": "kJ/(kg*K)", "kJ/kgK": "kJ/(kg*K)"},
        "2000 J/(kg K)",
    ),
    QuantityKind(
        "pressure_viscosity",
        "1/Pa",
        {"1/GPa": "1/GPa", "mm2/N": "mm**2/N", "m2/N": "m**2/N", "1/Pa": "1/Pa"},
        "18 1/GPa",
    ),
    QuantityKind("conductance", "W/K", {"W/K": "W/K", "kW/K": "kW/K"}, "20 W/K"),
    QuantityKind("body_heat_capacity", "J/K", {"J/K": "J/K", "kJ/K": "kJ/K"}, "20 kJ/K"),
    QuantityKind("conductivity", "W/(m*K)", {"W/(m K)": "W/(m*K)", "W/mK": "W/(m*K)"}, "45 W/(m K)"),
    QuantityKind(
        "heat_transfer_coefficient",
        "W/(m**2*K)",
        {"W/(m2 K)": "W/(m**2*K)", "W/m2K": "W/(m**2*K)"},
        "300 W/(m2 K)",
    ),
    QuantityKind(
        "torsional_stiffness",
        "N*m/rad",
        {"N m/rad": "N*m/rad", "Nm/rad": "N*m/rad", "kN m/rad": "kN*m/rad"},
        "290e3 N m/rad",
    ),
    QuantityKind(
        "torsional_damping", "N*m*s/rad", {"N m s/rad": "N*m*s/rad", "Nms/rad": "N*m*s/rad"}, "600 N m s/rad"
    ),
    QuantityKind("linear_stiffness", "N/m", {"N/m": "N/m", "N/um": "N/um", "kN/mm": "kN/mm"}, "1e8 N/m"),
    QuantityKind(
        "linear_damping", "N*s/m", {"N s/m": "N*s/m", "Ns/m": "N*s/m", "kN s/m": "kN*s/m"}, "1000 N s/m"
    ),
    QuantityKind("data_size", "byte", {"MB": "megabyte", "GB": "gigabyte", "kB": "kilobyte"}, "500 MB"),
    QuantityKind("voltage", "V", {"V": "V", "mV": "mV", "uV": "uV"}, "5 V"),
    QuantityKind("resistance", "ohm", {"ohm": "ohm", "mohm": "milliohm", "kohm": "kiloohm"}, "120 ohm"),
    QuantityKind("voltage_ratio", "V/V", {"mV/V": "mV/V", "uV/V": "uV/V", "V/V": "V/V"}, "2 mV/V"),
    QuantityKind("strain", "m/m", {"um/m": "um/m", "mm/m": "mm/m", "m/m": "m/m"}, "500 um/m"),
    QuantityKind("expansion_coefficient", "1/K", {"1/K": "1/K", "um/(m K)": "um/(m*K)"}, "11.5e-6 1/K"),
)
"""Every kind of quantity a case file knows, by name."""


class QuantityError(ValueError):
    """A text that is no quantity of the kind asked for.

    ``problem`` says what is wrong, ``remedy`` what is accepted, with an example; ``outside``: the text is a quantity of
    the kind, its number none that exists.
    """

    def __init__(self, problem: str, remedy: str, *, outside: bool = False) -> None:
        super().__init__(problem, remedy)
        self.problem = problem
        self.remedy = remedy
        self.outside = outside

    def __str__(self) -> str:
        return f"{self.problem}; {self.remedy}"


_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*\Z")
_LONGEST = 100
"""Characters of a number with its unit."""
_SPELLINGS = (
    ("°", "deg"), ("µ", "u"), ("μ", "u"), ("²", "2"), ("³", "3"), ("**", ""), ("^", ""),
    ("·", " "), ("*", " "),
)  # fmt: skip


def parse(text: object, kind: str, example: str | None = None) -> float:
    """Value in SI units of a quantity written as number and unit.

    Parameters
    ----------
    text : e.g. ``"140 degC"``; anything but a string with a unit of this kind is refused
    kind : name in ``KINDS``
    example : what a message shows; that of the kind when left out

    Raises
    ------
    QuantityError
        A bare number, a wrong dimension, an unknown unit, a number that cannot be read.
    """
    table = _table(kind, example)
    if not isinstance(text, str):
        if isinstance(text, int | float) and not isinstance(text, bool):
            raise QuantityError(
                "a bare number without a unit",
                f'give it a unit, e.g. "{text} {table.display_unit}" (units: {", ".join(table.units)})',
            )
        raise QuantityError(f"{describe(text)} where a {table.label} belongs", table.remedy)
    return _parse(text, kind, example)


def number_match(text: str) -> re.Match[str] | None:
    """Number [1] and unit [2], which may be empty, of a text such as ``"7 mm"``; None for any other text.

    No number is longer than 100 characters.
    """
    return _QUANTITY.match(text) if len(text) <= _LONGEST else None


@cache
def _table(kind: str, example: str | None) -> QuantityKind:
    return KINDS[kind] if example is None else KINDS[kind].like(example)


@lru_cache(maxsize=4096)
def _parse(text: str, kind: str, example: str | None) -> float:
    table = _table(kind, example)
    if len(text) > _LONGEST:
        raise QuantityError(f"{len(text)} characters, too long for a number with a unit", table.remedy)
    match = _QUANTITY.match(text)
    if re.match(r"\s*[+-]?\d+,\d", text):
        raise QuantityError("a decimal comma", "use a decimal point; " + table.remedy)
    if match is None:
        raise QuantityError("not a number with a unit", table.remedy)
    number, unit = float(match.group(1)), _normal(match.group(2))
    if not math.isfinite(number):
        raise QuantityError("the number is too large to be read", table.remedy)
    if not unit:
        raise QuantityError(
            "a number without a unit",
            f'give it a unit, e.g. "{match.group(1)} {table.display_unit}" (units: {", ".join(table.units)})',
        )
    expression = _units_of(kind).get(unit)
    if expression is None:
        raise QuantityError(_what_is(unit, match.group(2), table), table.remedy)
    factor, offset = _worth(expression, table.si)
    value = number * factor + offset
    if kind == "temperature" and value < 0.0:
        raise QuantityError("below absolute zero", table.remedy, outside=True)
    return value


def kind_of(text: object) -> str | None:
    """The first kind of quantity that ``text`` can be read as; None for anything else."""
    for kind in KINDS:
        try:
            parse(text, kind)
        except QuantityError:
            continue
        return kind
    return None


def display(value: float, kind: str, unit: str | None = None) -> float:
    """Number of ``value`` [SI] in ``unit`` (default: the display unit of its kind)."""
    table = KINDS[kind]
    expression = table.units[unit or table.display_unit]
    factor, offset = _worth(expression, table.si)
    return (value - offset) / factor


def worth(kind: str, unit: str) -> tuple[float, float]:
    """Factor and offset that turn a number in ``unit``, as ``KINDS`` spells it, into SI."""
    table = KINDS[kind]
    return _worth(table.units[unit], table.si)


def same_unit(first: str, second: str) -> bool:
    """Whether two texts spell one unit: ``N·m``, ``N m``; ``°C``, ``degC``."""
    return _normal(first) == _normal(second)


def show(value: float, kind: str, unit: str | None = None, digits: int = 6) -> str:
    """Text of ``value`` [SI] as number and unit, e.g. ``140 degC``."""
    return f"{display(value, kind, unit):.{digits}g} {unit or KINDS[kind].display_unit}"


def pattern(kind: str) -> str:
    """Regular expression of a quantity of this kind, in the common subset of Python and ECMAScript."""
    spellings = "|".join(_pattern_of(unit) for unit in KINDS[kind].units)
    return rf"^\s*{_NUMBER}\s*(?:{spellings})\s*$"


def describe(value: object) -> str:
    """What a value of a TOML file is, in words."""
    if isinstance(value, bool):
        return "a true/false value"
    if isinstance(value, str):
        return "a text"
    if isinstance(value, int | float):
        return "a number"
    if isinstance(value, list | tuple):
        return "a list"
    if isinstance(value, dict):
        return "a table"
    return f"a {type(value).__name__}"


def _normal(unit: str) -> str:
    """One spelling of a unit: no superscripts, dots or carets, single blanks."""
    for given, plain in _SPELLINGS:
        unit = unit.replace(given, plain)
    unit = re.sub(r"\s*([/()])\s*", r"\1", unit)
    return " ".join(unit.split())


@cache
def _units_of(kind: str) -> dict[str, str]:
    return {_normal(unit): expression for unit, expression in KINDS[kind].units.items()}


def _what_is(unit: str, written: str, table: QuantityKind) -> str:
    """Say what the unit measures, when it is one of another kind."""
    for other in KINDS.values():
        if other.name != table.name and unit in _units_of(other.name):
            if table.name == "temperature_difference" and other.name == "temperature":
                return f"unit {written!r} is a point on a scale, not a difference"
            return f"unit {written!r} is one of {other.label}, not of {table.label}"
    return f"unit {written!r} is not known"


def _pattern_of(unit: str) -> str:
    text = re.sub(r"([().^$*+?|\[\]{}])", r"\\\1", unit).replace("deg", "(?:deg|°)")
    text = re.sub(r"^u|(?<=[ (/])u", "[uµμ]", text)
    text = re.sub(r"(?<=[a-z])2", r"(?:\\^?2|²)", text)
    text = re.sub(r"(?<=[a-z])3", r"(?:\\^?3|³)", text)
    return text.replace(" ", r"[ ·*]")


@cache
def _worth(expression: str, si: str) -> tuple[float, float]:
    """Factor and offset from a unit to SI, asked of pint once."""
    quantity = _registry().Quantity
    offset = float(quantity(0.0, expression).to(si).magnitude)
    span = 1000.0 if offset else 1.0
    factor = (float(quantity(span, expression).to(si).magnitude) - offset) / span
    return _without_noise(factor), offset


def _without_noise(number: float) -> float:
    """The short decimal a conversion factor stands for, where only its last bits differ."""
    short = float(f"{number:.12g}")
    return short if abs(short - number) <= 1e-15 * abs(number) else number


@lru_cache(maxsize=1)
def _registry() -> "UnitRegistry[Any]":
    from pint import UnitRegistry

    return UnitRegistry(autoconvert_offset_to_baseunit=True)


# Numbers that a part cannot have: one fault with key, value, limit and remedy.


def refuse(key: str, given: str, problem: str, remedy: str) -> NoReturn:
    """Raise CaseError with one fault."""
    raise CaseError([Fault(key, given, problem, remedy)])


def require_above(key: str, value: float, unit: str, remedy: str, *, limit: float = 0.0) -> None:
    """Raise CaseError unless ``value`` is finite and above ``limit``."""
    if not (math.isfinite(value) and value > limit):
        refuse(key, _written(value, unit), f"must be above {_written(limit, unit)}", remedy)


def require_at_least(key: str, value: float, unit: str, remedy: str, *, limit: float = 0.0) -> None:
    """Raise CaseError unless ``value`` is finite and at least ``limit``."""
    if not (math.isfinite(value) and value >= limit):
        refuse(key, _written(value, unit), f"must be at least {_written(limit, unit)}", remedy)


def require_share(key: str, value: float, remedy: str, *, zero: bool = True) -> None:
    """Raise CaseError unless ``value`` lies within 0 to 1; ``zero``: whether 0 itself is a share."""
    if not (0.0 <= value <= 1.0 and (zero or value > 0.0)):
        refuse(key, f"{value:.6g}", f"must lie within 0 to 1{'' if zero else ', above 0'}", remedy)


def celsius(temperature: float) -> str:
    """A temperature [K] as a message shows it."""
    return f"{temperature - ZERO_CELSIUS:.4g} degC"


def _written(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".strip()
