"""Where the residual is and what it goes along with: groups of features against speed, torque and oil temperature.

A residual is divided by its standard deviation (noise and what is declared of the sensor); within a group every
channel and order may lean on one variable with its own factor, ``r = a x``. The variable that explains the most
is named; a simpler one that explains nearly as much goes first.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.prediction.model import Feature, OperatingCondition

Array = NDArray[np.float64]
VARIABLES: Mapping[str, str] = {
    "constant": "is nearly constant over the operating points",
    "speed": "grows with speed",
    "torque": "grows with torque",
    "oil_temperature": "grows with the oil temperature",
    "speed_squared": "grows with the square of the speed",
    "torque_speed": "grows with torque times speed",
}
"""Leading variables, simple ones first, and how they read in a sentence."""
NEARLY = 0.04
"""Explained share that a less simple variable has to add."""
LEAST_SHARE = 0.5
"""Explained share below which no variable leads."""


@dataclass(frozen=True, kw_only=True)
class Located:
    """One group of features and its residual.

    rms : of the whitened residual, 1 where only the declared uncertainty acts
    excess : probability that chance alone makes the residual this large
    variable, share : the variable it goes along with and the part of its square that explains; empty and 0 for none
    positive : share of the whitened residual's weight that is above the simulation
    largest : residual [SI] of each channel that is largest in size
    """

    group: str
    features: tuple[int, ...]
    channels: tuple[str, ...]
    points: tuple[str, ...]
    """Operating points where some number is off by more than 3 sigma."""
    all_points: int
    rms: float
    excess: float
    variable: str
    share: float
    positive: float
    largest: Mapping[str, float]


def leading_variables(settings: Sequence[OperatingCondition], ambient: float) -> dict[str, Array]:
    """Each variable at each setting (n_settings,), as a share of its largest value."""
    speed = np.array([setting.speed for setting in settings])
    torque = np.array([setting.torque for setting in settings])
    oil = np.array(
        [
            np.mean(list(setting.inlet_temperature.values())) - (setting.ambient_temperature or ambient)
            if setting.inlet_temperature else 0.0
            for setting in settings
        ]
    )  # fmt: skip
    raw = {
        "constant": np.ones(len(settings)), "speed": speed, "torque": torque, "oil_temperature": oil,
        "speed_squared": speed**2, "torque_speed": torque * speed,
    }  # fmt: skip
    return {name: values / max(float(np.abs(values).max()), 1e-300) for name, values in raw.items()}


def locate(
    features: Sequence[Feature],
    residual: Array,
    spread: Array,
    groups: Sequence[str],
    settings: Sequence[OperatingCondition],
    ambient: float,
) -> tuple[Located, ...]:
    """Groups by the size of their whitened residual, largest first.

    residual, spread : (n,) [SI], NaN where a feature is not usable; groups : (n,) name of the group of each feature
    """
    variables = _Variables(
        leading_variables(settings, ambient), {setting.name: i for i, setting in enumerate(settings)}
    )
    usable = np.isfinite(residual)
    found = []
    for group in dict.fromkeys(groups):
        chosen = [i for i, name in enumerate(groups) if name == group and usable[i]]
        if chosen:
            found.append(_located(group, chosen, features, residual, spread, variables))
    return tuple(sorted(found, key=lambda item: -item.rms))


@dataclass(frozen=True)
class _Variables:
    """Leading variables by name over the settings, and the row of each setting in them."""

    values: Mapping[str, Array]
    row: Mapping[str, int]


def _located(
    group: str,
    chosen: Sequence[int],
    features: Sequence[Feature],
    residual: Array,
    spread: Array,
    variables: _Variables,
) -> Located:
    from scipy.stats import chi2

    whitened = residual[list(chosen)] / spread[list(chosen)]
    squares = whitened**2
    off = dict.fromkeys(features[i].setting for i, z in zip(chosen, whitened) if abs(z) > 3.0)
    points = {features[i].setting for i in chosen}
    variable, share = _leading(chosen, features, whitened, variables)
    largest: dict[str, float] = {}
    for i in chosen:
        largest[features[i].channel] = max(largest.get(features[i].channel, 0.0), float(residual[i]), key=abs)
    return Located(
        group=group,
        features=tuple(chosen),
        channels=tuple(dict.fromkeys(features[i].channel for i in chosen)),
        points=tuple(off),
        all_points=len(points),
        rms=float(np.sqrt(squares.mean())),
        excess=float(chi2.sf(squares.sum(), len(chosen))),
        variable=variable,
        share=share,
        positive=float(squares[whitened > 0.0].sum() / squares.sum()) if squares.any() else 0.5,
        largest=largest,
    )


def _leading(
    chosen: Sequence[int], features: Sequence[Feature], whitened: Array, variables: _Variables
) -> tuple[str, float]:
    """The variable that explains the most; nothing is said of fewer than three operating points."""
    if len({features[i].setting for i in chosen} & set(variables.row)) < 3:
        return "", 0.0
    at = np.array([variables.row[features[i].setting] for i in chosen])
    series: dict[tuple[str, float, str], list[int]] = {}
    for row, i in enumerate(chosen):
        series.setdefault((features[i].channel, features[i].order, features[i].part), []).append(row)
    whole = float(np.sum(whitened**2))
    if whole == 0.0:
        return "", 0.0
    best, best_share = "", 0.0
    for name, values in variables.values.items():
        left = 0.0
        for rows in series.values():
            x, r = values[at[rows]], whitened[rows]
            slope = float(x @ r) / max(float(x @ x), 1e-300)
            left += float(np.sum((r - slope * x) ** 2))
        share = 1.0 - left / whole
        if share > best_share + (NEARLY if best else 0.0):
            best, best_share = name, share
    return (best, best_share) if best_share >= LEAST_SHARE else ("", best_share)
