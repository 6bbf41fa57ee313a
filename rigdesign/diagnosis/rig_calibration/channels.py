"""Channels of a rig that shift from one healthy set to the next by more than its drift says.

A thermocouple that is taken out and put back, an amplifier zeroed anew: all numbers of one channel move together, by a
share of their level. The channel that stands out most is given a shift of its own, then the next, as long as that
explains the changes better.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq

from rigdesign.diagnosis.residual.baseline import Change, Drift
from rigdesign.diagnosis.residual.calibration import fit_drift
from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.diagnosis.statistics.marginal_likelihood import Fit

STANDS_OUT = 4.0
"""Mean square of the changes of a channel [variances] above which a shift of its own is tried."""

WORTH_A_SHIFT = 2.0
"""Logarithm by which the likelihood has to rise for a shift of a channel."""

LARGEST_SHIFT = 1e3
"""Largest shift that is looked for, over the least one that the drift leaves visible."""


def fit_with_channels(changes: Sequence[Change], drift: Drift, weight: float) -> Fit:
    """The scales of a drift, with a shift for each channel that the data give one.

    Candidates are looked for with the drift known before: otherwise one channel that shifts is taken for a drift of
    everything. Each is fitted together with all other scales and kept where that explains the changes better.
    """
    best = fit_drift(changes, drift, weight)
    while (found := most_shifted(changes, drift)) is not None:
        name, size = found
        drift = replace(drift, channels={**drift.channels, name: size})
        more = fit_drift(changes, drift, weight)
        if more.misfit > best.misfit - WORTH_A_SHIFT:
            break
        best = more
    return best


def most_shifted(changes: Sequence[Change], drift: Drift) -> tuple[str, float] | None:
    """The channel that stands out most beyond a drift and the size of its shift; None where none does."""
    seen = _seen(changes, drift)
    worst = max(seen, key=lambda name: seen[name].square, default="")
    return (worst, seen[worst].size()) if worst and seen[worst].square > STANDS_OUT else None


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


def _seen(changes: Sequence[Change], drift: Drift) -> dict[str, _Seen]:
    """Channels without a shift so far, of those that read more than orders."""
    loads: dict[str, list[float]] = {}
    grams: dict[str, list[float]] = {}
    for change in changes:
        factor = cho_factor(change.covariance(drift), lower=True)
        left = cho_solve(factor, change.residuals.residual - change.expected)
        for name in dict.fromkeys(feature.channel for feature in change.residuals.features):
            shift = change.shift(name)
            if name not in drift.channels and shift.any():
                loads.setdefault(name, []).append(float(shift @ left))
                grams.setdefault(name, []).append(float(shift @ cho_solve(factor, shift)))
    return {name: _Seen(load=np.array(loads[name]), gram=np.array(grams[name])) for name in loads}
