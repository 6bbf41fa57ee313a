"""Changes of a case by dotted path, with bare numbers in SI where the file would want a unit."""

from collections.abc import Mapping, Sequence

from rigdesign.base import units
from rigdesign.base.quantity_kinds import KINDS, QuantityKind
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.case.paths import slot_at
from rigdesign.case.provenance import take_off

Changes = Mapping[str, object]
"""Dotted path -> value as the file would hold it; a bare number at a place with a unit counts in SI, kelvin."""


def changed_case(case: Case, changes: Changes) -> Case:
    """The case with some values replaced, validated once.

    Raises
    ------
    CaseError
        A path that does not exist, or faults of the changed case.
    """
    if not changes:
        return case
    plain, _, _ = take_off(dict(case.origin.tree))
    return changed_together(case, {path: _written(plain, path, value) for path, value in changes.items()})


WARMING = "ambient.warming_time"
"""Path of the time that a point had run where it was not steady."""


def only_warming(changes: Changes | Sequence[Changes]) -> bool:
    """Whether the time that points had run is all that changes."""
    given = [changes] if isinstance(changes, Mapping) else changes
    return any(given) and all(set(one) <= {WARMING} for one in given)


def written(case: Case, path: str, value: object) -> object:
    """A value of ``Changes`` as the file of this case would hold it."""
    plain, _, _ = take_off(dict(case.origin.tree))
    return _written(plain, path, value)


def _written(plain: Mapping[str, object], path: str, value: object) -> object:
    """The value as a file holds it."""
    if isinstance(value, bool) or not isinstance(value, int | float) or "*" in path:
        return value
    slot = slot_at(Case, plain, path.split("."))
    if slot is None or slot.quantity is None:
        return value
    return _with_unit(float(value), KINDS[slot.quantity.kind])


def _with_unit(value: float, kind: QuantityKind) -> str:
    """A number in SI with the unit a file knows it by."""
    spelling = next(unit for unit in kind.units if units.worth(kind.name, unit) == (1.0, 0.0))
    return f"{value!r} {spelling}"
