"""Constants of a case fitted to a healthy set: what the data know better than the case does.

The healthy covariance says how far each constant may be off; given the residual its mean and spread follow by linear
algebra (posterior of the linear Gaussian model). Constants that the data hardly narrow are left as they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.covariance import Whitened
from rigdesign.diagnosis.effects import Effect
from rigdesign.diagnosis.patch import Fitted

NARROWED = 0.7
"""Spread after over spread before from which on a constant is left alone."""


@dataclass(frozen=True, kw_only=True)
class Constant:
    """One constant as a healthy set has it.

    coordinates, deviations : of the parameters of its effect, after; before : their healthy spread
    """

    effect: Effect
    coordinates: tuple[float, ...]
    deviations: tuple[float, ...]
    before: float

    def fitted(self) -> Fitted:
        """As a change of the case."""
        values = tuple(
            parameter.value(u) for parameter, u in zip(self.effect.parameters, self.coordinates, strict=True)
        )
        return Fitted(effect=self.effect, values=values, reason="fitted to a healthy set")


def constants(space: Whitened, effects: Sequence[Effect]) -> tuple[Constant, ...]:
    """Constants that the residual of a healthy set narrows, clipped to their bounds."""
    found = []
    for effect in effects:
        places = space.covariance.own(effect.name)
        if not places:
            continue
        columns = space.columns[:, places]
        column = space.covariance.columns[places[0]]
        spread = space.covariance.amplitudes.get(column.kind, 1.0) * column.spread
        mean = spread * (columns.T @ space.residual)
        left = np.clip(1.0 - np.einsum("nk,nk->k", columns, columns), 0.0, 1.0)
        deviations = spread * np.sqrt(left)
        if not (deviations < NARROWED * spread).any():
            continue
        bounds = [parameter.bounds for parameter in effect.parameters]
        found.append(
            Constant(
                effect=effect,
                coordinates=tuple(float(np.clip(u, *limits)) for u, limits in zip(mean, bounds, strict=True)),
                deviations=tuple(float(value) for value in deviations),
                before=spread,
            )
        )
    return tuple(found)
