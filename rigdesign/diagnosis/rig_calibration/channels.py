"""Channels of a rig that shift from one healthy set to the next by more than its drift says.

A thermocouple that is taken out and put back, an amplifier zeroed anew: all numbers of one channel move together, by a
share of their level. The channel with the largest whitened square is given a shift of its own, then the next, until
none stands out.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq

from rigdesign.diagnosis.residual.baseline import Change, Drift
from rigdesign.diagnosis.statistics.columns import Array

STANDS_OUT = 4.0
"""Mean square of the changes of a channel [variances] above which it has a shift of its own: by chance one channel in
twenty with two sets."""

LARGEST_SHIFT = 1e3
"""Largest shift that is looked for, over the least one that the drift leaves visible."""


def channel_shifts(changes: Sequence[Change], drift: Drift) -> dict[str, float]:
    """Channel -> standard deviation of its shift from set to set over its level, of those that stand out."""
    found: dict[str, float] = {}
    names = dict.fromkeys(feature.channel for change in changes for feature in change.residuals.features)
    for _ in names:
        seen = _seen(changes, replace(drift, channels=found), [one for one in names if one not in found])
        if not seen:
            break
        worst = max(seen, key=lambda name: seen[name].square)
        if seen[worst].square <= STANDS_OUT:
            break
        found[worst] = seen[worst].size()
    return found


@dataclass(frozen=True, kw_only=True)
class _Seen:
    """What all changes say of one channel: a'C^-1 r and a'C^-1 a of each, (changes,)."""

    load: Array
    gram: Array

    @property
    def square(self) -> float:
        """Mean of the squares in variances, those that see it best counting most."""
        return float(np.sum(self.load**2) / np.sum(self.gram))

    def size(self) -> float:
        """The shift that is most likely: where the likelihood no longer rises with its variance."""

        def rise(logarithm: float) -> float:
            variance = float(np.exp(2.0 * logarithm))
            wider = 1.0 + variance * self.gram
            return float(np.sum((self.load / wider) ** 2 - self.gram / wider))

        visible = -0.5 * np.log(self.gram)
        low, high = float(visible.min()) - np.log(LARGEST_SHIFT), float(visible.max()) + np.log(LARGEST_SHIFT)
        return float(np.exp(high if rise(high) >= 0.0 else brentq(rise, low, high, xtol=1e-6)))


def _seen(changes: Sequence[Change], drift: Drift, names: Sequence[str]) -> dict[str, _Seen]:
    loads: dict[str, list[float]] = {}
    grams: dict[str, list[float]] = {}
    for change in changes:
        factor = cho_factor(change.covariance(drift), lower=True)
        left = cho_solve(factor, change.residuals.residual - change.expected)
        for name in names:
            shift = change.shift(name)
            if shift.any():
                loads.setdefault(name, []).append(float(shift @ left))
                grams.setdefault(name, []).append(float(shift @ cho_solve(factor, shift)))
    return {name: _Seen(load=np.array(loads[name]), gram=np.array(grams[name])) for name in loads}
