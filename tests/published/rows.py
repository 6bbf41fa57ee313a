"""One row of `rigdesign validate`: a published number and ours, with what agreement is worth."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Literal

from rigdesign.validation import Basis, Published, RowVerdict, ValidationRow

Bound = Literal["at least", "at most"]


@dataclass(frozen=True, kw_only=True)
class PublishedQuantity:
    """What a publication prints: a number, a range, or words only."""

    id: str
    text: str
    """What it is."""
    source: str
    unit: str
    value: Published | None = None
    """None where `printed` is words, or where the digits of `printed` are the value."""
    printed: str | None = None
    """As printed, where that is not the number itself (``above 1.5``)."""
    bound: Bound | None = None
    """For a printed limit, on whose right side there is no deviation."""

    @property
    def as_printed(self) -> str:
        """Value in words."""
        if self.printed is not None:
            return self.printed
        return "" if self.value is None else _text(self.value)

    def deviation(self, computed: float) -> float | None:
        """Of a computed value, relative; from the nearer end of a range, zero inside it. None for words."""
        if self.value is None:
            return None
        found = _deviation(self.value, computed)
        if self.bound is None:
            return found
        return min(found, 0.0) if self.bound == "at least" else max(found, 0.0)


@dataclass(frozen=True)
class Gate:
    """The deviation must not be larger."""

    largest_deviation: float
    """Relative."""


@dataclass(frozen=True)
class Goal:
    """The deviation should not be larger; a goal that is missed is reported."""

    largest_deviation: float
    """Relative."""


@dataclass(frozen=True)
class Window:
    """The computed value itself must lie within."""

    low: float
    high: float


def compare(
    published: PublishedQuantity,
    computed: float,
    basis: Basis,
    criterion: Gate | Goal | Window | None = None,
    *,
    free_parameters: int = 0,
    assumptions: str = "",
) -> ValidationRow:
    """Row of a number that we compute and a publication prints, or has words for; without criterion it is shown only.

    Raises
    ------
    ValueError
        A gate or goal is given, and the publication prints no number.
    """
    deviation = published.deviation(computed)
    tolerance = None if criterion is None or isinstance(criterion, Window) else criterion.largest_deviation
    if tolerance is not None and deviation is None:
        raise ValueError(f"row {published.id}: words have no deviation; give a window")
    return ValidationRow(
        id=published.id,
        quantity=published.text,
        source=published.source,
        published=published.value,
        published_text=published.as_printed,
        computed=computed,
        unit=published.unit,
        deviation=deviation,
        tolerance=tolerance,
        verdict=_verdict(criterion, computed, deviation),
        basis=basis,
        window=(criterion.low, criterion.high) if isinstance(criterion, Window) else None,
        free_parameters=free_parameters,
        assumptions=assumptions,
    )


def compare_printed(
    published: PublishedQuantity, computed: float, *, basis: Basis = "verification", assumptions: str = ""
) -> ValidationRow:
    """Row of a gate to the printed digits: half a unit of the last digit of ``published.printed``.

    Raises
    ------
    ValueError
        What is printed is no number.
    """
    digits = published.as_printed
    value, decimals = float(digits), len(digits.partition(".")[2])
    gate = Gate(0.5 * 10.0**-decimals / abs(value))
    return compare(replace(published, value=value), computed, basis, gate, assumptions=assumptions)


def not_modelled(
    published: PublishedQuantity, basis: Basis, *, reason: str, free_parameters: int = 0
) -> ValidationRow:
    """Row whose model does not exist yet; the printed number is shown as words."""
    return ValidationRow(
        id=published.id,
        quantity=published.text,
        source=published.source,
        published=None,
        published_text=published.as_printed,
        computed=None,
        unit=published.unit,
        deviation=None,
        tolerance=None,
        verdict="not modelled",
        basis=basis,
        free_parameters=free_parameters,
        assumptions=reason,
    )


def moved(stored: Sequence[ValidationRow], rows: Sequence[ValidationRow]) -> list[str]:
    """A line for each row that is new, is gone, or differs: numbers by more than half a per cent, or words."""
    old, new = ({row.id: row for row in group} for group in (stored, rows))
    lines = [f"gone: {name}" for name in old if name not in new]
    lines += [f"new: {name}" for name in new if name not in old]
    for name in old.keys() & new.keys():
        lines += [
            f"{name}, {field.name}: {getattr(old[name], field.name)!r} -> {getattr(new[name], field.name)!r}"
            for field in fields(ValidationRow)
            if field.name != "deviation"  # follows from the computed number
            and not _same(getattr(old[name], field.name), getattr(new[name], field.name))
        ]
    return sorted(lines)


def _same(first: object, second: object) -> bool:
    if isinstance(first, float) and isinstance(second, float):
        return math.isclose(first, second, rel_tol=0.005, abs_tol=1e-6)
    if isinstance(first, str) and isinstance(
        second, str
    ):  # numbers within the words move in their last digits
        return re.sub(r"[-+]?\d[\d.e+-]*", "0", first) == re.sub(r"[-+]?\d[\d.e+-]*", "0", second)
    return first == second


def _verdict(criterion: Gate | Goal | Window | None, computed: float, deviation: float | None) -> RowVerdict:
    if isinstance(criterion, Window):
        return "gate held" if criterion.low <= computed <= criterion.high else "gate missed"
    if criterion is None or deviation is None:
        return "shown"
    near = abs(deviation) <= criterion.largest_deviation
    if isinstance(criterion, Gate):
        return "gate held" if near else "gate missed"
    return "goal met" if near else "goal missed"


def _deviation(published: Published, computed: float) -> float:
    low, high = published if isinstance(published, tuple) else (published, published)
    if low <= computed <= high:
        return 0.0
    nearest = low if computed < low else high
    if nearest == 0:
        return computed
    return (computed - nearest) / abs(nearest)


def _text(published: Published) -> str:
    if isinstance(published, tuple):
        return f"{published[0]:g} … {published[1]:g}"
    return f"{published:.10g}"
