"""What became of every attribute of a REXS model: taken over in SI, or listed with the reason why not."""

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, inf
from typing import TypeVar

from rigdesign.rexs.model import Attribute, AttributeValueError, Component
from rigdesign.rexs.units import RexsUnitError, to_si

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
