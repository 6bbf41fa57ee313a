"""Columns: how every number of a comparison answers to one thing that may be off by some spread.

A column is a derivative (n_features,) with the spread its cause has in a healthy rig. Amplitudes scale the spreads
of a whole kind of columns; they are dimensionless, so that what one rig taught serves another.
"""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np
from numpy.typing import NDArray

from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, Feature, OperatingCondition

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
    return numbered([(feature.channel, feature.order, feature.part) for feature in features])


def order_numbers(features: Sequence[Feature]) -> NDArray[np.intp]:
    """(n,) number of the order that every feature is a part of, at its channel and point, in the order they appear."""
    return numbered([(feature.channel, feature.setting, feature.order) for feature in features])


def amplitudes_of(features: Sequence[Feature], values: Array) -> Array:
    """(n,) amplitude of the order that a number is a part of; zero for means and all other numbers."""
    amplitudes = together(values, order_numbers(features))
    return np.where([feature.order != 0.0 for feature in features], amplitudes, 0.0)


def together(values: Array, groups: NDArray[np.intp]) -> Array:
    """(n,) root of the sum of squares over the group of each number."""
    return np.asarray(np.sqrt(np.bincount(groups, weights=values**2))[groups])


# The same answer some teeth later: complex orders turned by the angle that has passed.


@dataclass(frozen=True)
class Turning:
    """Where the complex orders stand among features.

    real, imaginary : (p,) places of their parts; orders : (p,)
    """

    real: NDArray[np.intp]
    imaginary: NDArray[np.intp]
    orders: Array

    @classmethod
    def of(cls, features: Sequence[Feature]) -> "Turning":
        """Of features; means, quantities without orders and parts that stand alone do not turn."""
        place = {feature: row for row, feature in enumerate(features) if feature.part == "imaginary"}
        rows = [
            (row, place.get(replace(feature, part="imaginary")), feature.order)
            for row, feature in enumerate(features)
            if feature.part == "real"
        ]
        pairs = [(real, imaginary, order) for real, imaginary, order in rows if imaginary is not None]
        return cls(
            real=np.array([pair[0] for pair in pairs], dtype=np.intp),
            imaginary=np.array([pair[1] for pair in pairs], dtype=np.intp),
            orders=np.array([pair[2] for pair in pairs], dtype=np.float64),
        )

    def turned(self, answers: Array, teeth: int, teeth_a_turn: int) -> Array:
        """(m, n) answers of a cause that sits ``teeth`` teeth further on its gear.

        teeth_a_turn : of the reference gear; each tooth that passes turns order k by 2 pi k over them
        """
        angle = -2.0 * pi * self.orders * teeth / teeth_a_turn
        turned = answers.copy()
        real, imaginary = answers[:, self.real], answers[:, self.imaginary]
        turned[:, self.real] = np.cos(angle) * real - np.sin(angle) * imaginary
        turned[:, self.imaginary] = np.sin(angle) * real + np.cos(angle) * imaginary
        return np.asarray(turned)

    def ahead(self, values: Array) -> Array:
        """(n,) every complex order of values (n,) turned by a right angle, times i; zero for what does not turn."""
        ahead = np.zeros(len(values))
        ahead[self.real], ahead[self.imaginary] = -values[self.imaginary], values[self.real]
        return ahead

    def order_of(self, count: int) -> Array:
        """(count,) order of every number that turns, zero for the others."""
        orders = np.zeros(count)
        orders[self.real] = orders[self.imaginary] = self.orders
        return orders


# How far each number of an order may be from the answer of a right cause, by itself.
#
# A model has natural frequencies a little off, and mesh orders worse than that. And a cause that changes the circuit
# (stiffness, inertia, damping) changes how all passes through it that the teeth excite: where it alters the mesh orders
# of a channel by some share, the orders that pitch errors and run-out of the healthy teeth leave there follow by as
# much, and no model knows those errors.


@dataclass(frozen=True, kw_only=True)
class ModelError:
    """Error by itself of every number.

    share : (n,) of its answer, zero for what is of no order; mesh : (n,) whether it is of a mesh order
    values : (n,) as measured; orders, places : (n,) number of its order, and of its channel and point
    """

    share: Array
    mesh: NDArray[np.bool_]
    values: Array
    orders: NDArray[np.intp]
    places: NDArray[np.intp]

    @classmethod
    def of(
        cls, features: Sequence[Feature], share: Array, mesh: NDArray[np.bool_], values: Array
    ) -> "ModelError":
        """Of the numbers of a comparison."""
        return cls(
            share=share,
            mesh=mesh,
            values=np.where([feature.order != 0.0 for feature in features], values, 0.0),
            orders=order_numbers(features),
            places=numbered([(feature.channel, feature.setting) for feature in features]),
        )

    def at(self, answer: Array, circuit: bool) -> Array:
        """(n,) standard deviations of an answer (n,); ``circuit``: whether its cause changes the circuit."""
        spread = self.share * together(answer, self.orders)
        if not circuit:
            return np.asarray(spread)
        changed, before = (together(self.mesh * numbers, self.places) for numbers in (answer, self.values))
        passed_on = np.minimum(changed / np.maximum(before, 1e-150), 1.0)
        excited = np.where(self.mesh, 0.0, together(self.values, self.orders))
        return np.asarray(np.hypot(spread, passed_on * excited))


# Levels: how large each number is against which an error of the model is relative.
#
# A temperature counts from the ambient, an oil outlet from its inlet, an order from the strongest mesh order of its
# channel or, for a mesh order, from its own mean over the points.

AMBIENT = 293.15
"""Ambient [K] where neither point nor case says more."""


def setting_of(
    features: Sequence[Feature], settings: Sequence[OperatingCondition]
) -> dict[str, OperatingCondition]:
    """Settings by name; features name them."""
    return {setting.name: setting for setting in settings}


def excess(
    features: Sequence[Feature],
    base: Array,
    channels: Mapping[str, Channel],
    settings: Sequence[OperatingCondition],
) -> Array:
    """(n,) prediction less what it counts from."""
    by_name = setting_of(features, settings)
    zero = [_zero(feature, channels[feature.channel], by_name.get(feature.setting)) for feature in features]
    return np.asarray(base - np.array(zero))


def _zero(feature: Feature, channel: Channel, setting: OperatingCondition | None) -> float:
    if setting is None or channel.quantity not in ("temperature", "oil_outlet_temperature"):
        return 0.0
    ambient = AMBIENT if setting.ambient_temperature is None else setting.ambient_temperature
    if channel.quantity == "temperature":
        return ambient
    return setting.inlet_temperature.get(channel.place, ambient)


def reference_scale(
    features: Sequence[Feature],
    base: Array,
    channels: Mapping[str, Channel],
    settings: Sequence[OperatingCondition],
    mesh_orders: frozenset[float],
) -> Array:
    """(n,) level of every number, positive."""
    above = np.abs(excess(features, base, channels, settings))
    scale = above.copy()
    for name in dict.fromkeys(feature.channel for feature in features):
        rows = [i for i, feature in enumerate(features) if feature.channel == name]
        if channels[name].quantity in ORDER_QUANTITIES:
            _order_levels(features, rows, above, scale, mesh_orders)
        else:
            scale[rows] = np.maximum(above[rows], float(above[rows].mean()))
    return np.maximum(scale, 1e-12)


def _order_levels(
    features: Sequence[Feature],
    rows: Sequence[int],
    above: Array,
    scale: Array,
    mesh_orders: frozenset[float],
) -> None:
    """Mesh orders over their own root mean square, the others over the strongest of those, else of all."""
    by_order: dict[float, list[int]] = {}
    for row in rows:
        by_order.setdefault(features[row].order, []).append(row)
    sizes = {
        order: float(np.sqrt(2.0 * np.mean(above[of_order] ** 2)))
        for order, of_order in by_order.items()
        if order
    }
    mesh = {order: size for order, size in sizes.items() if order in mesh_orders}
    strongest = max((mesh or sizes).values(), default=0.0)
    for order, of_order in by_order.items():
        if order == 0.0:
            scale[of_order] = np.maximum(above[of_order], float(above[of_order].mean()))
        else:
            scale[of_order] = mesh.get(order, strongest)
