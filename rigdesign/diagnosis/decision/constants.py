"""Constants of a case fitted to a healthy set: what the data know better than the case does.

The healthy covariance says how far each constant may be off; given the residual its mean and spread follow by linear
algebra (posterior of the linear Gaussian model). Constants that the data hardly narrow are left as they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.patch import Fitted
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.covariance import Whitened
from rigdesign.diagnosis.statistics.intervals import NORMAL_95

NARROWED = 0.7
"""Spread after over spread before from which on a constant is left alone."""


@dataclass(frozen=True, kw_only=True)
class Constant:
    """One constant as a healthy set has it.

    coordinate, deviation : of the parameter of its effect, after; before : its healthy spread
    """

    effect: Effect
    coordinate: float
    deviation: float
    before: float

    def fitted(self, reason: str) -> Fitted:
        """As a change of the case."""
        parameter = self.effect.parameters[0]
        low, high = parameter.bounds
        half = NORMAL_95 * self.deviation
        ends = (max(self.coordinate - half, low), min(self.coordinate + half, high))
        return Fitted(
            effect=self.effect,
            values=(parameter.value(self.coordinate),),
            ends=((parameter.value(ends[0]), parameter.value(ends[1])),),
            reason=reason,
        )


@dataclass(frozen=True, kw_only=True)
class Constants:
    """Constants of a rig with their covariance (m, m) in the coordinates of their parameters."""

    entries: tuple[Constant, ...]
    covariance: Array


def constants(space: Whitened, effects: Sequence[Effect]) -> Constants:
    """Constants of one parameter that the residual of a healthy set narrows, clipped to their bounds."""
    entries: list[Constant] = []
    kept: list[Array] = []
    for effect in effects:
        places = space.covariance.own(effect.name)
        if not places or len(effect.parameters) != 1:
            continue
        spreads = np.array([space.covariance.spread(place) for place in places])
        spread = float(np.linalg.norm(spreads))
        white = space.columns[:, places] @ spreads
        deviation = float(np.sqrt(max(spread**2 - float(white @ white), 0.0)))
        if deviation >= NARROWED * spread:
            continue
        mean = float(white @ space.residual)
        entries.append(
            Constant(
                effect=effect,
                coordinate=float(np.clip(mean, *effect.parameters[0].bounds)),
                deviation=deviation,
                before=spread,
            )
        )
        kept.append(white)
    seen = np.array(kept).reshape(len(kept), -1)
    before = np.diag([entry.before**2 for entry in entries])
    return Constants(entries=tuple(entries), covariance=np.asarray(before - seen @ seen.T))
