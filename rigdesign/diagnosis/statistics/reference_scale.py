"""Levels: how large each number is against which an error of the model is relative.

A temperature counts from the ambient, an oil outlet from its inlet, an order from the strongest mesh order of its
channel or, for a mesh order, from its own mean over the points.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from rigdesign.diagnosis.statistics.columns import Array
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel, Feature, OperatingCondition

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
    found = above.copy()
    for name in dict.fromkeys(feature.channel for feature in features):
        rows = [i for i, feature in enumerate(features) if feature.channel == name]
        if channels[name].quantity in ORDER_QUANTITIES:
            _order_levels(features, rows, above, found, mesh_orders)
        else:
            found[rows] = np.maximum(above[rows], float(above[rows].mean()))
    return np.maximum(found, 1e-12)


def _order_levels(
    features: Sequence[Feature],
    rows: Sequence[int],
    above: Array,
    found: Array,
    mesh_orders: frozenset[float],
) -> None:
    """Mesh orders over their own root mean square, the others over the strongest of those, else of all."""
    by_order: dict[float, list[int]] = {}
    for row in rows:
        by_order.setdefault(features[row].order, []).append(row)
    sizes = {
        order: float(np.sqrt(2.0 * np.mean(above[own] ** 2))) for order, own in by_order.items() if order
    }
    mesh = {order: size for order, size in sizes.items() if order in mesh_orders}
    strongest = max((mesh or sizes).values(), default=0.0)
    for order, own in by_order.items():
        if order == 0.0:
            found[own] = np.maximum(above[own], float(above[own].mean()))
        else:
            found[own] = mesh.get(order, strongest)
