"""A REXS model as read: components with attributes, relations with roles, load spectra; nothing is converted."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import isfinite
from typing import Literal

from rigdesign.base.errors import shortened

Scalar = bool | int | float | str | None
"""One value; XML leaves numbers and truth values as text."""
Value = Scalar | tuple[Scalar, ...] | tuple[tuple[Scalar, ...], ...]
"""Scalar, vector, or matrix by rows (and arrays of arrays, whose rows differ in length)."""
ValueKind = Literal[
    "untyped", "boolean", "string", "integer", "floating_point", "enum", "reference_component", "file_reference",
    "date_time", "floating_point_array", "integer_array", "boolean_array", "string_array", "enum_array",
    "floating_point_matrix", "integer_matrix", "boolean_matrix", "string_matrix", "array_of_integer_arrays", "unknown",
]  # fmt: skip
"""Value type of the database, stated in JSON only; ``unknown`` for a type that REXS 2.0 does not have."""

_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,4})?\s*")
_LONGEST_NUMBER = 60
_SHOWN = 60


class AttributeValueError(ValueError):
    """An attribute whose value is not what is asked of it; the text says what it is instead."""


@dataclass(frozen=True)
class Attribute:
    """One attribute of a component, as written.

    unit : unit id as written, None where the file states none
    kind : value type as JSON states it; XML states none
    """

    id: str
    unit: str | None
    value: Value
    kind: ValueKind = "untyped"

    def number(self) -> float:
        """The scalar as a finite number.

        Raises
        ------
        AttributeValueError
            No number: text, a truth value, a vector, not finite, a decimal comma, empty.
        """
        return _number(self.value)

    def whole_number(self) -> int:
        """The scalar as an integer; ``16.0`` counts as one.

        Raises
        ------
        AttributeValueError
            No number, or one with a fraction.
        """
        number = _number(self.value)
        if number != int(number):
            raise AttributeValueError(f"{_shown(self.value)} where a whole number belongs")
        return int(number)

    def text(self) -> str:
        """The scalar as text: string, enumeration, file reference; a number as it is written.

        Raises
        ------
        AttributeValueError
            Empty, a vector or a truth value.
        """
        if isinstance(self.value, str) and self.value.strip():
            return self.value.strip()
        if isinstance(self.value, int | float) and not isinstance(self.value, bool):
            return str(self.value)
        raise AttributeValueError(f"{_shown(self.value)} where a text belongs")

    def flag(self) -> bool:
        """The scalar as true or false.

        Raises
        ------
        AttributeValueError
            Neither.
        """
        if isinstance(self.value, bool):
            return self.value
        if isinstance(self.value, str) and self.value.strip() in ("true", "false"):
            return self.value.strip() == "true"
        raise AttributeValueError(f"{_shown(self.value)} where true or false belongs")

    def vector(self) -> tuple[float, ...]:
        """The vector as finite numbers.

        Raises
        ------
        AttributeValueError
            No vector, or an entry that is no number.
        """
        if not isinstance(self.value, tuple):
            raise AttributeValueError(f"{_shown(self.value)} where a list of numbers belongs")
        return tuple(_number(entry) for entry in self.value)

    def written(self) -> str:
        """Value and unit as a reader of the file sees them, shortened."""
        unit = f" {self.unit}" if self.unit and self.unit != "none" else ""
        return _shown(self.value) + unit


@dataclass(frozen=True)
class Component:
    """One component: part of the gear unit, connection, contact or data of one of them."""

    id: int
    type: str
    name: str
    attributes: tuple[Attribute, ...]

    @cached_property
    def _by_id(self) -> Mapping[str, Attribute]:
        return {attribute.id: attribute for attribute in reversed(self.attributes)}

    def attribute(self, name: str) -> Attribute | None:
        """The first attribute of this id, None where there is none."""
        return self._by_id.get(name)


@dataclass(frozen=True)
class RoleReference:
    """A component in the role it has in a relation."""

    component: int
    role: str


@dataclass(frozen=True)
class Relation:
    """Components related to each other: ``assembly`` of assembly and part, ``side`` of a bearing and what it joins.

    order : place in an ordered relation, counted from 1; None in others
    """

    id: int
    type: str
    references: tuple[RoleReference, ...]
    order: int | None = None

    def with_role(self, role: str) -> int | None:
        """Id of the first component in this role."""
        return next((item.component for item in self.references if item.role == role), None)


@dataclass(frozen=True)
class LoadCase:
    """One load case: of some components the attributes that hold in it."""

    id: int
    components: tuple[Component, ...]


@dataclass(frozen=True)
class LoadSpectrum:
    """Load cases, and attributes that sum up all of them (``accumulation``)."""

    id: int
    load_cases: tuple[LoadCase, ...]
    accumulation: tuple[Component, ...] = ()


@dataclass(frozen=True)
class RexsModel:
    """A REXS file.

    source : file it was read from, for messages
    version : REXS version as written
    application : program that wrote it, with its version
    """

    source: str
    version: str
    application: str
    date: str
    components: tuple[Component, ...]
    relations: tuple[Relation, ...] = ()
    load_spectra: tuple[LoadSpectrum, ...] = ()

    @cached_property
    def _by_id(self) -> Mapping[int, Component]:
        return {component.id: component for component in self.components}

    @cached_property
    def _by_role(self) -> Mapping[tuple[str, str, int], tuple[Relation, ...]]:
        found: dict[tuple[str, str, int], list[Relation]] = {}
        for relation in self.relations:
            for item in relation.references:
                found.setdefault((relation.type, item.role, item.component), []).append(relation)
        return {key: tuple(relations) for key, relations in found.items()}

    def component(self, number: int) -> Component:
        """Component of this id; KeyError for none."""
        return self._by_id[number]

    def has(self, number: int) -> bool:
        """Whether a component has this id."""
        return number in self._by_id

    def of_type(self, *types: str) -> tuple[Component, ...]:
        """All components of these types, in the order of the file."""
        return tuple(component for component in self.components if component.type in types)

    def relations_of(self, relation: str, role: str, component: int) -> tuple[Relation, ...]:
        """Relations of a type in which a component has a role, in the order of the file."""
        return self._by_role.get((relation, role, component), ())

    def related(self, relation: str, role: str, component: int, other: str) -> tuple[Component, ...]:
        """Components in the role ``other`` of the relations in which ``component`` has ``role``.

        Ordered relations come in their order.
        """
        relations = sorted(self.relations_of(relation, role, component), key=lambda item: item.order or 0)
        numbers = [number for item in relations if (number := item.with_role(other)) is not None]
        return tuple(self._by_id[number] for number in dict.fromkeys(numbers))


def _number(value: Value) -> float:
    if isinstance(value, str):
        if len(value) > _LONGEST_NUMBER or not _NUMBER.fullmatch(value):
            raise AttributeValueError(f"{_shown(value)} where a number belongs")
        number = float(value)
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300:
        number = float(value)
    else:
        raise AttributeValueError(f"{_shown(value)} where a number belongs")
    if not isfinite(number):
        raise AttributeValueError(f"{_shown(value)} where a finite number belongs")
    return number


def _shown(value: Value) -> str:
    """Value in a line of a list."""
    if value is None or value == "":
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return shortened(value, _SHOWN)
    if isinstance(value, tuple):
        few = ", ".join(_shown(entry) for entry in value[:4])
        return f"[{few}]" if len(value) <= 4 else f"[{few}, … {len(value)} entries]"
    return shortened(repr(value), _SHOWN)
