"""Inputs of two cases as quantities: 40 mm and 0.04 m are one value."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from rigdesign.base import units
from rigdesign.case.inputs import is_label
from rigdesign.difference.reading import InputValue

SAME = 1e-12
"""Relative difference of two quantities that are one value: round-off of the units."""


@dataclass(frozen=True, kw_only=True)
class InputChange:
    """An input that differs; ``before`` or ``after`` is None where the case has it not.

    change : ``basis`` where the value is the same and its source is not
    relative : change over the value before, None for what are no quantities on one scale
    """

    path: str
    change: Literal["changed", "added", "removed", "basis"]
    before: InputValue | None
    after: InputValue | None
    relative: float | None = None


def changed_inputs(
    before: Mapping[str, InputValue], after: Mapping[str, InputValue]
) -> tuple[InputChange, ...]:
    """What differs, in the order of the case: values first changed, then added and removed, then sources.

    Names and titles are left out: no result depends on them.
    """
    found = []
    for path in dict.fromkeys([*before, *after]):
        if is_label(path):
            continue
        old, new = before.get(path), after.get(path)
        if old is None or new is None:
            found.append(
                InputChange(path=path, change="added" if old is None else "removed", before=old, after=new)
            )
        elif not same_value(old.value, new.value):
            found.append(
                InputChange(
                    path=path,
                    change="changed",
                    before=old,
                    after=new,
                    relative=_relative(old.value, new.value),
                )
            )
        elif old.basis != new.basis:
            found.append(InputChange(path=path, change="basis", before=old, after=new))
    order = ("changed", "added", "removed", "basis")
    return tuple(sorted(found, key=lambda row: order.index(row.change)))


def same_value(first: str, second: str) -> bool:
    """Whether two texts of a case state one value: quantity, number, list of them, or word."""
    if first == second:
        return True
    parts, others = first.split(","), second.split(",")
    return len(parts) == len(others) and all(map(_same, parts, others))


def _same(first: str, second: str) -> bool:
    if first.strip() == second.strip():
        return True
    numbers = _numbers(first, second)
    return numbers is not None and math.isclose(*numbers, rel_tol=SAME)


def _numbers(first: str, second: str) -> tuple[float, float] | None:
    """Both in SI, or as plain numbers; None for words and for quantities of different kinds."""
    try:
        return float(first), float(second)
    except ValueError:
        pass
    kind = units.kind_of(first.strip())
    if kind is None:
        return None
    try:
        return units.parse(first.strip(), kind), units.parse(second.strip(), kind)
    except units.QuantityError:
        return None


def _relative(first: str, second: str) -> float | None:
    """Change over the first value; None for lists, words, temperatures (their zero means nothing) and zero."""
    if units.kind_of(first.strip()) == "temperature":
        return None
    numbers = _numbers(first, second)
    if numbers is None or numbers[0] == 0.0:
        return None
    return (numbers[1] - numbers[0]) / abs(numbers[0])
