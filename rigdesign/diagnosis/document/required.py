"""With too few data to name anything: how large each cause would have to be to explain the residual by itself."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import hypot
from typing import Any

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.catalogue.waiting import WAITING
from rigdesign.diagnosis.decision.naming import Names, display_scale
from rigdesign.diagnosis.document.outcome import Outcome
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.residual.sensors import SensorError
from rigdesign.diagnosis.statistics.required_size import RequiredSize, ResidualMetric

FAR = 20.0
"""Size over its bound beyond which no number is given: the answer was continued too far."""
EXPLAINS = 0.5
"""Share of the square of the residual from which a cause explains it."""
WITHIN, BEYOND, NOT_IT = "within the bound", "beyond the bound", "does not explain it"
UNMOVED, NOT_MODELLED = "does not move these numbers", "not modelled"
ORDER = (WITHIN, BEYOND, NOT_IT, UNMOVED, NOT_MODELLED)
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

    The residual is measured by the noise of the readings and settings, and by the systematic uncertainties of sensors
    and settings, which the causes do not have to explain. A tooth that may be any is the first one.
    """
    if outcome.verdict != "data_insufficient":
        return ()
    residuals = outcome.result.problem.residuals.rows(outcome.result.diagnosis.kept)
    found = [
        *(_of_effect(residuals, outcome.names, effect) for effect in residuals.effects),
        *(_of_error(residuals, outcome.names, error) for error in residuals.errors),
    ]
    ordered = sorted(found, key=lambda row: (ORDER.index(row.verdict), row.reach))
    return (*ordered, *_not_modelled(outcome))


def metric_of(residuals: ResidualProblem, without: str = "") -> ResidualMetric:
    """Of the residual of a set; without the systematic part of one error."""
    covariance = np.diag(residuals.noise**2) + residuals.scatter
    for error in residuals.errors:
        if error.name != without:
            covariance = covariance + error.spread**2 * np.outer(error.values, error.values)
    return ResidualMetric(residuals.residual, covariance)


def _of_effect(residuals: ResidualProblem, names: Names, effect: Effect) -> RequiredRow:
    response = residuals.library.responses.get(effect.name)
    explanation = f"{effect.name}/0" if effect.any_tooth else effect.name
    size = None
    if response is not None:
        metric = metric_of(residuals)
        if response.nonlinear:
            size = metric.of_runs(response.coordinates[:, 0], response.answers, effect.reach)
        else:
            size = metric.of_columns(response.sensitivity(), effect.reach)
    within = size is not None and _admits(effect, size.coordinates)
    return _row(names, explanation, size, within, _bounds(effect))


def _of_error(residuals: ResidualProblem, names: Names, error: SensorError) -> RequiredRow:
    size = metric_of(residuals, error.name).of_columns(error.values[:, None], error.bound)
    scale, unit = display_scale(error.unit if error.unit != "SI" else "", False)
    bounds = f"+-{scale * error.bound:.3g} {unit}, {error.times:g} times its uncertainty"
    return _row(names, error.name, size, size is not None and size.reach <= 1.0, bounds)


def _admits(effect: Effect, coordinates: tuple[float, ...]) -> bool:
    """Whether a size lies within the bounds; that of a harmonic by its amplitude."""
    if len(coordinates) > 1:
        return hypot(*coordinates) <= effect.reach
    low, high = effect.parameters[0].bounds
    return low <= coordinates[0] <= high


def _row(names: Names, explanation: str, size: RequiredSize | None, within: bool, bounds: str) -> RequiredRow:
    title = names.title(explanation)
    if size is None or size.reach > FAR:
        return RequiredRow(
            effect=explanation, title=title, size="", parameters=(), share=None, bounds=bounds,
            verdict=UNMOVED if size is None else BEYOND,
            why="" if size is None else f"more than {FAR:g} times its bound", reach=FAR,
        )  # fmt: skip
    shown = names.sized(explanation, size.coordinates, [(one, one) for one in size.coordinates]).shown
    values = tuple(
        {"name": one.name, "value": one.value, "unit": one.unit, "factor": one.factor} for one in shown
    )
    first = shown[0]
    scale, unit = display_scale(first.unit, first.factor)
    number = f"x {first.value:.3g}" if first.factor else f"{scale * first.value:.3g} {unit}".rstrip()
    verdict = WITHIN if within else BEYOND
    return RequiredRow(
        effect=explanation,
        title=title,
        size=f"{first.name} {number}",
        parameters=values,
        share=size.share,
        bounds=bounds,
        verdict=verdict if size.share >= EXPLAINS else NOT_IT,
        why="continued beyond the runs of the model" if size.extrapolated else "",
        reach=size.reach,
    )


def _bounds(effect: Effect) -> str:
    """Bounds of the first parameter, as its size is shown."""
    one = effect.parameters[0]
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
