"""Anonymous competitors: causes without a name that a named effect has to beat.

Heat at any place of the rig with the laws a loss may follow, paid by the motor or not; a conductance between any
neighbours; an order of torque or angle on any channel with the laws an excitation may follow. What they explain
better than the catalogue is reported as located but unknown.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from rigdesign.diagnosis.columns import Array
from rigdesign.diagnosis.healthy import relative_speed, relative_torque
from rigdesign.diagnosis.levels import excess
from rigdesign.diagnosis.library import NEAR_SENSOR, Library
from rigdesign.prediction.model import ORDER_QUANTITIES, Channel

Anonymous = tuple[str, Array]
"""Name, (n, k) columns: k = 2 for an order with free phase."""


def anonymous(library: Library, channels: Mapping[str, Channel]) -> Iterator[Anonymous]:
    """All of them, in a fixed order."""
    speed = np.exp(relative_speed(library.features, library.settings))
    torque = np.exp(relative_torque(library.features, library.settings))
    laws = {"constant": np.ones_like(speed), "~n": speed, "~n2": speed**2, "~T n": torque * speed}
    for family, sources in (("heat", library.sources), ("heat unpaid", library.dry_sources)):
        for place, values in sources.items():
            if place.startswith(NEAR_SENSOR):
                continue
            for law, share in laws.items():
                yield f"{family} at {place} {law}", (values * share)[:, None]
    yield from _beside_sensors(library, channels)
    for name, values in library.links.items():
        yield f"conductance {name}", values[:, None]
    yield from _orders(library, channels, {"constant": laws["constant"], "~T": torque, "~n2": speed**2})


def _beside_sensors(library: Library, channels: Mapping[str, Channel]) -> Iterator[Anonymous]:
    """Heat from outside beside one thermocouple: a neighbour, a lamp; or a draught, as the wall is above ambient."""
    warm = excess(library.features, library.base, channels, library.settings)
    for place, values in library.dry_sources.items():
        if not place.startswith(NEAR_SENSOR):
            continue
        name = place.removeprefix(NEAR_SENSOR)
        above = {f.setting: warm[row] for row, f in enumerate(library.features) if f.channel == name}
        share = np.array([above.get(feature.setting, 0.0) for feature in library.features])
        yield f"heat near {name} constant", values[:, None]
        yield f"heat near {name} ~T above ambient", (values * share)[:, None]


def _orders(
    library: Library, channels: Mapping[str, Channel], laws: Mapping[str, Array]
) -> Iterator[Anonymous]:
    """An order of one channel, or of all channels of its kind, free in phase but the same at all points."""
    found = dict.fromkeys(
        (feature.channel, feature.order)
        for feature in library.features
        if channels[feature.channel].quantity in ORDER_QUANTITIES and feature.order
    )
    for name, order in found:
        parts = [
            np.array(
                [(f.channel, f.order, f.part) == (name, order, part) for f in library.features],
                dtype=np.float64,
            )
            for part in ("real", "imaginary")
        ]
        for law, share in laws.items():
            yield f"order {order:g} of {name} {law}", np.stack([part * share for part in parts], axis=1)
