"""How large each cause would have to be to explain a residual by itself, where too few data can name anything."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import Response
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.residual.sensors import SensorError
from rigdesign.diagnosis.statistics.required_size import RequiredSize, ResidualMetric

EXPLAINS = 0.5
"""Share of the square of the residual from which a cause explains it."""


@dataclass(frozen=True, kw_only=True)
class RequiredCause:
    """An effect or an error of a sensor or setting with the size that it needs.

    explanation : its name, of a tooth that may be any that of the first; size : None where it moves none of the numbers
    within : whether its bounds admit the size; computed : whether the model has its answer
    """

    explanation: str
    entry: Effect | SensorError
    size: RequiredSize | None
    within: bool = False
    computed: bool = True

    @property
    def explains(self) -> bool:
        """Whether the residual is met by it."""
        return self.size is not None and self.size.share >= EXPLAINS

    @property
    def reversed(self) -> bool:
        """Whether it would have to go the other way round than it can."""
        if self.size is None or not isinstance(self.entry, Effect) or len(self.size.coordinates) > 1:
            return False
        low, high = self.entry.parameters[0].bounds
        return (self.size.coordinates[0] < 0.0 and low == 0.0) or (
            self.size.coordinates[0] > 0.0 and high == 0.0
        )


def required_causes(residuals: ResidualProblem) -> tuple[RequiredCause, ...]:
    """All effects, then all errors.

    The residual is measured by the noise of the readings and settings, and by the systematic uncertainties of sensors
    and settings, which the causes do not have to explain.
    """
    metric = _metric(residuals)
    return (
        *(_of_effect(metric, residuals.library.responses, effect) for effect in residuals.effects),
        *(_of_error(residuals, error) for error in residuals.errors),
    )


def _metric(residuals: ResidualProblem, without: str = "") -> ResidualMetric:
    """Without the systematic part of one error."""
    covariance = np.diag(residuals.noise**2) + residuals.scatter
    for error in residuals.errors:
        if error.name != without:
            covariance = covariance + error.spread**2 * np.outer(error.values, error.values)
    return ResidualMetric(residuals.residual, covariance)


def _of_effect(metric: ResidualMetric, responses: Mapping[str, Response], effect: Effect) -> RequiredCause:
    explanation = f"{effect.name}/0" if effect.any_tooth else effect.name
    response = responses.get(effect.name)
    if response is None:
        return RequiredCause(explanation=explanation, entry=effect, size=None, computed=False)
    if response.nonlinear:
        size = metric.of_runs(response.coordinates[:, 0], response.answers, effect.reach)
    else:
        size = metric.of_columns(response.sensitivity(), effect.reach)
    within = size is not None and _admits(effect, size.coordinates)
    return RequiredCause(explanation=explanation, entry=effect, size=size, within=within)


def _of_error(residuals: ResidualProblem, error: SensorError) -> RequiredCause:
    size = _metric(residuals, error.name).of_columns(error.values[:, None], error.bound)
    within = size is not None and size.reach <= 1.0
    return RequiredCause(explanation=error.name, entry=error, size=size, within=within)


def _admits(effect: Effect, coordinates: tuple[float, ...]) -> bool:
    """Whether a size lies within the bounds; that of a harmonic by its amplitude."""
    if len(coordinates) > 1:
        return hypot(*coordinates) <= effect.reach
    low, high = effect.parameters[0].bounds
    return low <= coordinates[0] <= high
