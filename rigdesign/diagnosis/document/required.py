"""With too few data to name anything: a table of the size that each cause would need to explain the residual."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.catalogue.not_modelled import WAITING
from rigdesign.diagnosis.decision.naming import Names, display_scale
from rigdesign.diagnosis.decision.proposals import RequiredCause, required_causes
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.residual.sensors import SensorError

FAR = 20.0
"""Size over its bound beyond which no number is given: the answer was continued too far."""
MOST_FACTOR = 100.0
"""Factor up or down beyond which no number is given."""
WITHIN = "within the bound"
BEYOND = "beyond the bound"
NOT_IT = "does not explain it"
UNMOVED = "does not move these numbers"
NOT_COMPUTED = "not computed"
NOT_MODELLED = "not modelled"
ORDER = (WITHIN, BEYOND, NOT_IT, UNMOVED, NOT_COMPUTED, NOT_MODELLED)
"""Verdicts of the rows, in their order."""


@dataclass(frozen=True, kw_only=True)
class RequiredRow:
    """A cause with the size that it needs.

    size : in words, with unit; empty where it does not answer or needs too much; share : that it takes away of the
    square of the residual; verdict : one of `ORDER`; reach : size over the bound
    """

    effect: str
    title: str
    size: str
    parameters: tuple[Mapping[str, Any], ...]
    share: float | None
    bounds: str
    verdict: str
    why: str = ""
    reach: float = 0.0


def required_rows(outcome: Outcome) -> tuple[RequiredRow, ...]:
    """Of verdict ``data_insufficient``: every effect and every error of sensors and settings, the least needed first.

    Effects that no channel of the set can show are left out; of a tooth that may be any the first one is meant.
    """
    if outcome.verdict != "data_insufficient":
        return ()
    residuals = outcome.result.problem.residuals.rows(outcome.result.diagnosis.kept)
    rows = [_row(outcome.names, cause) for cause in required_causes(residuals)]
    ordered = sorted(rows, key=lambda row: (ORDER.index(row.verdict), row.reach))
    return (*ordered, *_not_modelled(outcome))


def _row(names: Names, cause: RequiredCause) -> RequiredRow:
    title, bounds, size = names.title(cause.explanation), _bounds(cause.entry), cause.size
    if size is None:
        verdict = UNMOVED if cause.computed else NOT_COMPUTED
        why = "" if cause.computed else "no channel of the set shows it, or the model refuses it"
        return RequiredRow(
            effect=cause.explanation, title=title, size="", parameters=(), share=None, bounds=bounds,
            verdict=verdict, why=why,
        )  # fmt: skip
    verdict = (WITHIN if cause.within else BEYOND) if cause.explains else NOT_IT
    if size.reach > FAR:
        return RequiredRow(
            effect=cause.explanation, title=title, size="", parameters=(), share=size.share, bounds=bounds,
            verdict=verdict, why=f"more than {FAR:g} times its bound", reach=size.reach,
        )  # fmt: skip
    shown = names.sized(cause.explanation, size.coordinates, [(one, one) for one in size.coordinates]).shown
    first = shown[0]
    scale, unit = display_scale(first.unit, first.factor)
    number = f"x {first.value:.3g}" if first.factor else f"{scale * first.value:.3g} {unit}".rstrip()
    far = first.factor and not 1.0 / MOST_FACTOR <= first.value <= MOST_FACTOR
    return RequiredRow(
        effect=cause.explanation,
        title=title,
        size="" if far else f"{first.name} {number}",
        parameters=() if far else tuple(
            {"name": one.name, "value": one.value, "unit": one.unit, "factor": one.factor} for one in shown
        ),
        share=size.share,
        bounds=bounds,
        verdict=verdict,
        why=_why(cause, far),
        reach=size.reach,
    )  # fmt: skip


def _why(cause: RequiredCause, far: bool) -> str:
    """What to know of a size."""
    assert cause.size is not None
    if far:
        return f"a factor beyond {MOST_FACTOR:g}"
    if cause.reversed:
        return "the other way round than it can be"
    return "continued beyond the runs of the model" if cause.size.extrapolated else ""


def _bounds(entry: Effect | SensorError) -> str:
    """Bounds of the first parameter, as its size is shown."""
    if isinstance(entry, SensorError):
        scale, unit = display_scale(entry.unit if entry.unit != "SI" else "", False)
        return f"+-{scale * entry.bound:.3g} {unit}, {entry.times:g} times its uncertainty"
    one = entry.parameters[0]
    scale, unit = display_scale(one.unit, one.factor)
    return f"{scale * one.low:.3g} to {scale * one.high:.3g} {unit}".rstrip()


def _not_modelled(outcome: Outcome) -> Iterator[RequiredRow]:
    """What engineers know of and no entry holds."""
    known = {effect.kind for effect in outcome.result.effects}
    for one in WAITING:
        if one.name not in known:
            yield RequiredRow(
                effect=one.name, title=one.title, size="", parameters=(), share=None, bounds="",
                verdict=NOT_MODELLED, why=one.lacks,
            )  # fmt: skip


def required_document(outcome: Outcome) -> list[dict[str, Any]]:
    """The rows as plain values."""
    return [
        {
            "effect": row.effect, "title": row.title, "size": row.size or None, "parameters": list(row.parameters),
            "explains": row.share, "bounds": row.bounds or None, "verdict": row.verdict, "why": row.why or None,
        }
        for row in required_rows(outcome)
    ]  # fmt: skip
