"""One row of `rigdesign validate`: a published number against ours, with what it is worth."""

from dataclasses import dataclass
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


def compare(
    *,
    id: str,  # noqa: A002 - the name in the document's contract
    quantity: str,
    source: str,
    published: Published,
    computed: float,
    unit: str,
    basis: Basis,
    gate: float | None = None,
    goal: float | None = None,
    window: tuple[float, float] | None = None,
    bound: Bound | None = None,
    published_text: str | None = None,
    free_parameters: int = 0,
    assumptions: str = "",
) -> ValidationRow:
    """Row of a number we compute and a publication prints.

    ``gate`` and ``goal`` are relative tolerances: a gate must hold, a goal is reported. ``window`` is a gate
    on the computed value itself. With none of them the row is shown only. ``bound`` says that the
    published number is a limit, on whose right side there is no deviation. ``published_text`` replaces the
    number as printed ("above 1.5").

    Raises ValueError if more than one of gate, goal and window is given.
    """
    if sum(limit is not None for limit in (gate, goal, window)) > 1:
        raise ValueError(f"row {id}: give one of gate, goal and window")
    deviation = _deviation(published, computed)
    if bound is not None:
        deviation = min(deviation, 0.0) if bound == "at least" else max(deviation, 0.0)
    verdict: RowVerdict = "shown"
    if gate is not None:
        verdict = "gate held" if abs(deviation) <= gate else "gate missed"
    elif window is not None:
        verdict = "gate held" if window[0] <= computed <= window[1] else "gate missed"
    elif goal is not None:
        verdict = "goal met" if abs(deviation) <= goal else "goal missed"
    return ValidationRow(
        id=id,
        quantity=quantity,
        source=source,
        published=published,
        published_text=_text(published) if published_text is None else published_text,
        computed=computed,
        unit=unit,
        deviation=deviation,
        tolerance=gate if gate is not None else goal,
        verdict=verdict,
        basis=basis,
        window=window,
        free_parameters=free_parameters,
        assumptions=assumptions,
    )


def compare_printed(
    *,
    id: str,  # noqa: A002
    quantity: str,
    source: str,
    printed: str,
    computed: float,
    unit: str,
    basis: Basis = "verification",
    assumptions: str = "",
) -> ValidationRow:
    """Row of a gate to the printed digits: half a unit of the last digit of ``printed``."""
    decimals = len(printed.partition(".")[2])
    published = float(printed)
    return compare(
        id=id,
        quantity=quantity,
        source=source,
        published=published,
        published_text=printed,
        computed=computed,
        unit=unit,
        basis=basis,
        gate=0.5 * 10.0**-decimals / abs(published),
        assumptions=assumptions,
    )


def stated(
    *,
    id: str,  # noqa: A002
    quantity: str,
    source: str,
    published: str,
    computed: float,
    unit: str,
    basis: Basis,
    window: tuple[float, float] | None = None,
    free_parameters: int = 0,
    assumptions: str = "",
) -> ValidationRow:
    """Row of a number we compute where the publication has words only; ``window`` makes it a gate."""
    verdict: RowVerdict = "shown"
    if window is not None:
        verdict = "gate held" if window[0] <= computed <= window[1] else "gate missed"
    return ValidationRow(
        id=id,
        quantity=quantity,
        source=source,
        published=None,
        published_text=published,
        computed=computed,
        unit=unit,
        deviation=None,
        tolerance=None,
        verdict=verdict,
        basis=basis,
        window=window,
        free_parameters=free_parameters,
        assumptions=assumptions,
    )


def not_modelled(
    *,
    id: str,  # noqa: A002
    quantity: str,
    source: str,
    published: str,
    unit: str,
    basis: Basis,
    reason: str,
    free_parameters: int = 0,
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
        free_parameters=free_parameters,
        assumptions=reason,
    )


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
