"""What became of every attribute of a REXS model: taken over in SI, or listed with the reason why not."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from math import hypot, inf
from typing import TypeVar

from rigdesign.base.units import ZERO_CELSIUS
from rigdesign.rexs.model import Attribute, AttributeValueError, Component

T = TypeVar("T")
_Key = tuple[str | None, int, str]


@dataclass(frozen=True)
class MappedAttribute:
    """An attribute that a case takes over.

    written : value and unit in the file
    target : place in the gear unit, e.g. ``gears[6].face_width``
    value : there, in SI
    """

    component: int
    type: str
    attribute: str
    written: str
    target: str
    value: object
    load_case: str | None = None


@dataclass(frozen=True)
class ListedAttribute:
    """An attribute that is not taken over: what is written, and why not."""

    component: int
    type: str
    attribute: str
    written: str
    reason: str
    load_case: str | None = None


class AttributeLog:
    """Takes attributes of components and keeps account of it."""

    def __init__(self) -> None:
        self._mapped: dict[_Key, MappedAttribute] = {}
        self._listed: dict[_Key, ListedAttribute] = {}
        self._repeated: list[ListedAttribute] = []
        self.load_case: str | None = None
        """Load case whose components are being read, None for the components of the model."""

    @property
    def mapped(self) -> tuple[MappedAttribute, ...]:
        """What was taken over, in the order of asking."""
        return tuple(self._mapped.values())

    @property
    def listed(self) -> tuple[ListedAttribute, ...]:
        """What was not."""
        return (*self._listed.values(), *self._repeated)

    def number(
        self, component: Component, attribute: str, unit: str, target: str, *, above: float | None = None
    ) -> float | None:
        """Value of an attribute in SI.

        Parameters
        ----------
        component : where it stands
        attribute : its id in REXS 2.0
        unit : unit id that the database gives it; counts where the file states none
        target : place in the gear unit that takes it
        above : SI value it has to exceed, where there is such a limit

        Returns
        -------
        value : None where it is not there or cannot be used, which is listed
        """

        def read(found: Attribute) -> float:
            value = to_si(found.number(), found.unit, unit)
            if above is not None and value <= above:
                raise AttributeValueError(f"not above {above:g}")
            return value

        return self._take(component, attribute, target, read)

    def whole_number(self, component: Component, attribute: str, target: str, least: int) -> int | None:
        """A count of at least ``least``, or None; enumerations of numbers are such as well."""

        def read(found: Attribute) -> int:
            value = found.whole_number()
            if value < least:
                raise AttributeValueError(f"below {least}")
            return value

        return self._take(component, attribute, target, read)

    def text(self, component: Component, attribute: str, target: str) -> str | None:
        """A string or entry of an enumeration, or None."""
        return self._take(component, attribute, target, Attribute.text)

    def flag(self, component: Component, attribute: str, target: str) -> bool | None:
        """True, false or None."""
        return self._take(component, attribute, target, Attribute.flag)

    def vector(
        self, component: Component, attribute: str, unit: str, target: str
    ) -> tuple[float, float, float] | None:
        """Three numbers in SI, or None."""

        def read(found: Attribute) -> tuple[float, float, float]:
            first, second, third = (to_si(number, found.unit, unit) for number in _three(found))
            return first, second, third

        return self._take(component, attribute, target, read)

    def direction(
        self, component: Component, attribute: str, target: str
    ) -> tuple[float, float, float] | None:
        """Unit vector of a direction, whatever unit its components have, or None."""

        def read(found: Attribute) -> tuple[float, float, float]:
            first, second, third = _three(found)
            length = hypot(first, second, third)
            if not 1e-12 < length < inf:
                raise AttributeValueError("no direction")
            return first / length, second / length, third / length

        return self._take(component, attribute, target, read)

    def refuse(self, component: Component, attribute: str, reason: str) -> None:
        """List an attribute that is not to be taken over, even if it was before."""
        found = component.attribute(attribute)
        if found is not None:
            self._mapped.pop((self.load_case, component.id, attribute), None)
            self._list(component, found, reason)

    def refuse_rest(self, component: Component, attribute: str, reason: str) -> None:
        """List an attribute that nothing has asked for."""
        found = component.attribute(attribute)
        key = (self.load_case, component.id, attribute)
        if found is not None and key not in self._mapped:
            self._list(component, found, reason)

    def list_rest(self, component: Component, reason: str) -> None:
        """List all attributes of a component that nothing has asked for."""
        for found in component.attributes:
            key = (self.load_case, component.id, found.id)
            if found is not component.attribute(found.id):
                repeated = "stated twice; the first counts"
                self._repeated.append(_listed(component, found, repeated, self.load_case))
            elif key not in self._mapped and key not in self._listed:
                self._list(component, found, reason)

    def _take(
        self, component: Component, attribute: str, target: str, read: Callable[[Attribute], T]
    ) -> T | None:
        found = component.attribute(attribute)
        if found is None:
            return None
        try:
            value = read(found)
        except (AttributeValueError, RexsUnitError) as error:
            self._list(component, found, str(error))
            return None
        mapped = MappedAttribute(
            component.id, component.type, attribute, found.written(), target, value, self.load_case
        )
        self._mapped.setdefault((self.load_case, component.id, attribute), mapped)
        return value

    def _list(self, component: Component, found: Attribute, reason: str) -> None:
        listed = _listed(component, found, reason, self.load_case)
        self._listed.setdefault((self.load_case, component.id, found.id), listed)


def _three(found: Attribute) -> tuple[float, float, float]:
    numbers = found.vector()
    if len(numbers) != 3:
        raise AttributeValueError(f"{len(numbers)} entries where three belong")
    return numbers[0], numbers[1], numbers[2]


def _listed(component: Component, found: Attribute, reason: str, load_case: str | None) -> ListedAttribute:
    return ListedAttribute(component.id, component.type, found.id, found.written(), reason, load_case)


# Units of REXS: what each unit id of the database is worth in SI, and the spellings in which exporters write it.
#
# Source: the unit list of the REXS database, versions 1.0 to 2.0.0. ``°`` of the versions to 1.3 is ``deg`` of the
# later ones, ``mum`` is a micrometre, ``C`` a temperature in degrees Celsius, ``1e-6 / C`` a coefficient of thermal
# expansion.


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
