"""Columns: how every number of a comparison answers to one thing that may be off by some spread.

A column is a derivative (n_features,) with the spread its cause has in a healthy rig. Amplitudes scale the spreads
of a whole kind of columns; they are dimensionless, so that what one rig taught serves another.
"""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.prediction.model import Feature

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Column:
    """One cause that is no effect: an uncertain constant, a sensor, an input, a local conductance."""

    name: str
    kind: str
    """Names the amplitude that scales its spread."""
    values: Array
    """(n_features,) change of the features per unit of the cause."""
    spread: float
    """Standard deviation of the cause in a healthy rig, before the amplitude."""
    effect: str = ""
    """Effect of the catalogue that moves the same thing; its spread is left out while that effect is tested."""


def stacked(columns: Sequence[Column], amplitudes: Mapping[str, float]) -> Array:
    """(n_features, n_columns) of the columns times their standard deviations; amplitude 1 where none is given."""
    if not columns:
        raise ValueError("no columns to stack; a comparison has at least its noise and its inputs")
    scaled = [amplitudes.get(column.kind, 1.0) * column.spread * column.values for column in columns]
    return np.stack(scaled, axis=1)


def numbered(names: Sequence[Hashable]) -> NDArray[np.intp]:
    """(n,) number of every name, the same for the same name, from zero in the order they appear."""
    numbers = {name: number for number, name in enumerate(dict.fromkeys(names))}
    return np.array([numbers[name] for name in names], dtype=np.intp)


def series_numbers(features: Sequence[Feature]) -> NDArray[np.intp]:
    """(n,) number of the series of every feature, one channel and one order, from zero in the order they appear."""
    return numbered([(one.channel, one.order, one.part) for one in features])


def order_numbers(features: Sequence[Feature]) -> NDArray[np.intp]:
    """(n,) number of the order that every feature is a part of, at its channel and point, in the order they appear."""
    return numbered([(one.channel, one.setting, one.order) for one in features])


def amplitudes_of(features: Sequence[Feature], values: Array) -> Array:
    """(n,) amplitude of the order that a number is a part of; zero for means and all other numbers."""
    amplitudes = together(values, order_numbers(features))
    return np.where([feature.order != 0.0 for feature in features], amplitudes, 0.0)


def together(values: Array, groups: NDArray[np.intp]) -> Array:
    """(n,) root of the sum of squares over the group of each number."""
    return np.asarray(np.sqrt(np.bincount(groups, weights=values**2))[groups])
