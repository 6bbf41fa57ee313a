"""Drift, channels and model error of one rig from its healthy sets; the shipped values are the prior.

Sets of one rig share its constants, so that they are one draw of the model error: each counts as one N-th. Of N sets
N (N - 1) ordered pairs can be made, but only N - 1 changes are independent: each pair counts as one N-th as well.

A value found larger than shipped is used as found. A smaller drift is used with one standard deviation added, as one
too small gives false alarms and one too large only hides small effects. What all numbers of a set have in common
was drawn N - 1 times, which leaves the logarithm of a drift open by at least (1/1.5^2 + 2 (N - 1))^-1/2: two sets lower
a drift to no less than 1.9 times the value found, four to 1.5 times. Errors of model and channels are never lowered: a
rig is one draw of them, and single orders or channels stand out of their kind. With lower ones two of six healthy sets
of a loop gave an alarm against the model alone, with these none.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import brentq

from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.residual.baseline import CHANNEL, Change, Drift, fit_amplitudes, fit_drift, group_of
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, outliers_of, plain
from rigdesign.diagnosis.statistics.amplitudes import PRIOR, Amplitudes, Fit, Group
from rigdesign.diagnosis.statistics.columns import Array

FEWEST = 2
"""Healthy sets that a calibration needs: one pair."""
MOST = 4
"""Healthy sets that a calibration takes: more add little to a drift and each is diagnosed with all others."""

OF_THE_MEASUREMENT = frozenset({"sensor", "input"})
"""Amplitudes on what the measurement states itself."""

OF_CHANNELS = (
    "channel", "channel_speed", "point", "series_mean", "series_mesh", "series_mesh_point", "series_shaft",
    "series_shaft_point", "frequency",
)  # fmt: skip
"""Amplitudes of what channels are off by; the others are those of the model's constants."""

Kind = Literal["drift", "channel shift", "channel error", "model error"]


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """One value of a calibration.

    name : ``drift.shaft``, ``amplitudes.link``, or ``channels.`` with the name of a channel
    shipped : value before, the prior; fitted : of highest posterior density; spread : standard deviation of its
        logarithm; used : what a diagnosis takes
    """

    name: str
    kind: Kind
    shipped: float
    fitted: float
    spread: float
    used: float


@dataclass(frozen=True, kw_only=True)
class RigFit:
    """A calibration with its estimates."""

    calibration: Calibration
    estimates: tuple[Estimate, ...]


def estimate(
    sets: Sequence[ResidualProblem], shipped: Calibration, start: Amplitudes | None = None
) -> RigFit:
    """Values of a rig from healthy sets of it, of the same points and sensors as far as possible.

    start : amplitudes from which the search starts; the shipped ones when left out

    Raises ValueError for less than two sets.
    """
    if len(sets) < FEWEST:
        raise ValueError(f"healthy sets = {len(sets)}, must be at least {FEWEST}")
    sets = [_without_outliers(residuals, shipped) for residuals in sets]
    errors = _model_error(sets, shipped, start or shipped.amplitudes)
    amplitudes = shipped.amplitudes.with_values(_used(errors))
    drifts = _drift(changes_of(sets, amplitudes), shipped.drift, len(sets))
    estimates = (*drifts, *errors)
    return RigFit(
        calibration=with_values(shipped, {value.name: value.used for value in estimates}), estimates=estimates
    )


def _without_outliers(residuals: ResidualProblem, shipped: Calibration) -> ResidualProblem:
    """A set without single readings that its others contradict: a slip is no drift."""
    space = plain(residuals, shipped.amplitudes, shipped.inflation)
    gone = {outlier.place for outlier in outliers_of(residuals, space)}
    return (
        residuals.rows([row for row in range(len(residuals.features)) if row not in gone])
        if gone
        else residuals
    )


def changes_of(sets: Sequence[ResidualProblem], amplitudes: Amplitudes) -> list[Change]:
    """Every set given every other one."""
    return [
        Change.of(residuals, baseline, amplitudes)
        for residuals in sets
        for baseline in sets
        if baseline is not residuals
    ]


def _model_error(sets: Sequence[ResidualProblem], shipped: Calibration, start: Amplitudes) -> list[Estimate]:
    groups = [_one_nth(residuals, shipped, len(sets)) for residuals in sets]
    fit = fit_amplitudes(groups, start, OF_THE_MEASUREMENT, shipped.amplitudes)
    before = shipped.amplitudes.as_dict()
    return [
        _estimate(f"amplitudes.{name}", "channel error" if name in OF_CHANNELS else "model error",
                  before[name], fit.values[name], fit.spreads[name])
        for name in before
        if name in fit.values
    ]  # fmt: skip


def _one_nth(residuals: ResidualProblem, shipped: Calibration, count: int) -> Group:
    """A set against the model with a weight of one over their number, the shipped inflation included."""
    group = group_of([residuals], shipped.amplitudes, shipped.inflation)
    return replace(group, noise=group.noise + residuals.inflated(shipped.inflation), weight=1.0 / count)


def _drift(changes: Sequence[Change], shipped: Drift, sets: int) -> list[Estimate]:
    fit = fit_with_channels(changes, shipped, 1.0 / sets)
    estimates = []
    for name, fitted in fit.values.items():
        spread = spread_of_sets(fit.spreads[name], sets)
        if name.startswith(CHANNEL):
            key = f"channels.{name.removeprefix(CHANNEL)}"
            used = fitted * float(np.exp(spread))
            estimates.append(
                Estimate(name=key, kind="channel shift", shipped=0.0, fitted=fitted, spread=spread, used=used)
            )
        else:
            estimates.append(_estimate(f"drift.{name}", "drift", shipped.scales[name], fitted, spread))
    return estimates


def spread_of_sets(spread: float, sets: int) -> float:
    """Standard deviation of the logarithm of a drift, at least what so many sets leave open."""
    prior = PRIOR**-2
    seen = np.inf if spread == 0.0 else max(spread**-2 - prior, 0.0)
    return float((prior + min(seen, 2.0 * (sets - 1))) ** -0.5)


def _estimate(name: str, kind: Kind, shipped: float, fitted: float, spread: float) -> Estimate:
    least = min(shipped, fitted * float(np.exp(spread))) if kind == "drift" else shipped
    return Estimate(
        name=name, kind=kind, shipped=shipped, fitted=fitted, spread=spread, used=max(fitted, least)
    )


def _used(estimates: Sequence[Estimate]) -> dict[str, float]:
    return {value.name.partition(".")[2]: value.used for value in estimates}


def with_values(shipped: Calibration, values: Mapping[str, float]) -> Calibration:
    """A calibration with the values of a rig by the names of their estimates; what is not among them stays."""
    groups: dict[str, dict[str, float]] = {"drift": {}, "channels": {}, "amplitudes": {}}
    for name, value in values.items():
        group, _, key = name.partition(".")
        groups[group][key] = value
    return replace(
        shipped,
        amplitudes=shipped.amplitudes.with_values(groups["amplitudes"]),
        drift=replace(shipped.drift.with_scales(groups["drift"]), channels=groups["channels"]),
    )


# Channels of a rig that shift from one healthy set to the next by more than its drift says.
#
# A thermocouple that is taken out and put back, an amplifier zeroed anew: all numbers of one channel move together, by
# a share of their level. The channel that stands out most is given a shift of its own, then the next, as long as that
# explains the changes better.

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
    while (shift := most_shifted(changes, drift)) is not None:
        name, size = shift
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
