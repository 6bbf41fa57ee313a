"""One row of `rigdesign validate`: a published number beside ours, with what it is worth."""

from dataclasses import dataclass
from typing import Literal

Basis = Literal["predicted", "fitted", "arithmetic", "input", "verification"]
RowVerdict = Literal["gate held", "gate missed", "goal met", "goal missed", "shown", "not modelled"]


@dataclass(frozen=True, kw_only=True)
class ValidationRow:
    """A published quantity and ours.

    ``basis`` says what agreement is worth: a number that a fit was made to meet is ``fitted``, a textbook or
    benchmark case ``verification``, only ``predicted`` rows count in the headline.
    """

    id: str
    quantity: str
    source: str
    published: float | tuple[float, float] | None
    """A number, a range, or None where the publication gives words only."""
    published_text: str
    computed: float | None
    unit: str
    deviation: float | None
    """Relative; from the nearer end of a range, zero inside it."""
    tolerance: float | None
    verdict: RowVerdict
    basis: Basis
    free_parameters: int = 0
    assumptions: str = ""

    @property
    def computed_text(self) -> str:
        """Our number as printed in tables."""
        return "" if self.computed is None else f"{self.computed:.6g}"


def compare(
    *,
    id: str,  # noqa: A002 - the name in the document's contract
    quantity: str,
    source: str,
    published: float | tuple[float, float],
    computed: float,
    unit: str,
    basis: Basis,
    gate: float | None = None,
    goal: float | None = None,
    free_parameters: int = 0,
    assumptions: str = "",
) -> ValidationRow:
    """Row of a number we compute.

    ``gate`` and ``goal`` are relative tolerances: a gate must hold, a goal is reported, neither is shown only.
    """
    deviation = _deviation(published, computed)
    verdict: RowVerdict = "shown"
    if gate is not None:
        verdict = "gate held" if abs(deviation) <= gate else "gate missed"
    elif goal is not None:
        verdict = "goal met" if abs(deviation) <= goal else "goal missed"
    return ValidationRow(
        id=id,
        quantity=quantity,
        source=source,
        published=published,
        published_text=_text(published),
        computed=computed,
        unit=unit,
        deviation=deviation,
        tolerance=gate if gate is not None else goal,
        verdict=verdict,
        basis=basis,
        free_parameters=free_parameters,
        assumptions=assumptions,
    )


def not_modelled(
    *, id: str, quantity: str, source: str, published: str, unit: str, basis: Basis, reason: str  # noqa: A002
) -> ValidationRow:
    """Row whose model does not exist yet."""
    return ValidationRow(
        id=id,
        quantity=quantity,
        source=source,
        published=None,
        published_text=published,
        computed=None,
        unit=unit,
        deviation=None,
        tolerance=None,
        verdict="not modelled",
        basis=basis,
        assumptions=reason,
    )


def _deviation(published: float | tuple[float, float], computed: float) -> float:
    low, high = published if isinstance(published, tuple) else (published, published)
    if low <= computed <= high:
        return 0.0
    nearest = low if computed < low else high
    if nearest == 0:
        return computed
    return (computed - nearest) / abs(nearest)


def _text(published: float | tuple[float, float]) -> str:
    if isinstance(published, tuple):
        return f"{published[0]:g} … {published[1]:g}"
    return f"{published:.10g}"
