"""One row of `rigdesign validate`: a published number and ours, with what agreement is worth."""

from dataclasses import dataclass, replace
from typing import Literal

Basis = Literal["predicted", "fitted", "arithmetic", "input", "verification"]
RowVerdict = Literal["gate held", "gate missed", "goal met", "goal missed", "shown", "not modelled"]
Published = float | tuple[float, float]
Bound = Literal["at least", "at most"]


@dataclass(frozen=True, kw_only=True)
class ValidationRow:
    """A published quantity and ours.

    ``basis`` says what agreement is worth: a number that a fit was made to meet is ``fitted``, a textbook or
    benchmark case ``verification``, only ``predicted`` rows count in the headline.
    """

    id: str
    quantity: str
    source: str
    published: Published | None
    """A number, a range, or None where the publication gives words only."""
    published_text: str
    computed: float | None
    unit: str
    deviation: float | None
    """Relative; from the nearer end of a range, zero inside it."""
    tolerance: float | None
    """Largest deviation that holds the gate or meets the goal."""
    verdict: RowVerdict
    basis: Basis
    window: tuple[float, float] | None = None
    """Limits of the computed value where a gate is stated as such, instead of a tolerance."""
    free_parameters: int = 0
    """Inputs that the publication leaves open and that were chosen with this number in view."""
    assumptions: str = ""

    @property
    def computed_text(self) -> str:
        """Our number as printed in tables."""
        return "" if self.computed is None else f"{self.computed:.6g}"


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
