"""Directions in which the numbers of a set go with one cause each, of the catalogue or without a name.

Along them calibration asks how far healthy rigs go beyond what the columns of their constants span, and inflates the
covariance by that.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.library.library import Library, Response
from rigdesign.diagnosis.residual.unmodelled_cause import heats
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.phase_shift import Turning


@dataclass(frozen=True, kw_only=True)
class Direction:
    """Change of the numbers per coordinate of one cause.

    likeness : what it shares with such causes elsewhere and on other rigs; reach : largest coordinate that is believed
    values : (n, k), one column for each parameter
    """

    likeness: str
    reach: float
    values: Array


def directions(library: Library, effects: Sequence[Effect], teeth_a_turn: int) -> Iterator[Direction]:
    """Of all effects the sensors answer to, of every tooth that may be meant; and of heat at any place.

    A nonlinear response has a direction at neutral and one to every run. The coordinate of heat is its share of
    the mean losses of the points.
    """
    turning = Turning.of(library.features)
    for effect in effects:
        response = library.responses.get(effect.name)
        if response is None:
            continue
        rows = _courses(response)
        for tooth in range(max(effect.any_tooth, 1)):
            turned = turning.turned(rows, tooth, teeth_a_turn) if tooth else rows
            yield Direction(likeness=effect.likeness, reach=effect.reach, values=turned.T)
    losses = float(np.mean(list(library.powers.values()))) if library.powers else 0.0
    if losses > 0.0:
        for heat in heats(library):
            yield Direction(likeness=heat.likeness, reach=1.0, values=losses * heat.values[:, None])


def _courses(response: Response) -> Array:
    """(k, n) sensitivities at neutral; of a nonlinear response the secants to its runs as well."""
    slopes = response.sensitivity().T
    if not response.nonlinear:
        return slopes
    places = response.coordinates[:, 0]
    away = places != 0.0
    return np.vstack([slopes, response.answers[away] / places[away, None]])
