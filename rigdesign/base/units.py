"""Quantities at the border: ``"140 degC"`` in a case file, 413.15 inside, ``"140 degC"`` in a report.

A closed table says which units a kind of quantity accepts; pint knows what they are worth. It is imported
when the first unit is met, and each unit is asked once. Absolute temperature and temperature difference are
different kinds, because 10 K more and 10 degC are not the same thing. Speeds count revolutions: ``1/min`` is
one revolution a minute.
"""

import math
import re
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

from rigdesign.base.quantity_kinds import KINDS, QuantityKind

if TYPE_CHECKING:
    from pint import UnitRegistry


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
