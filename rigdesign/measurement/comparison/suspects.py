"""Input errors that only the simulation shows: channels exchanged, readings in another unit."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.quantity_kinds import KINDS
from rigdesign.measurement.data import Data
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.measurement.reading.measurement_set import DataFinding

Array = NDArray[np.float64]
RATIO = 1.3
"""How near measured over simulated has to come to the ratio of two units."""
UNLIKE = 3.0
"""Least ratio of two units that can be distinguished from a difference of model and rig."""


def unit_findings(data: Data, simulated: Array) -> Iterator[DataFinding]:
    """Channels whose readings are larger or smaller than simulated by the ratio of two units."""
    for name, entry in data.channels.items():
        kind = CHANNELS[entry.channel.quantity].kind
        if kind == "temperature":
            continue
        rows = [
            i
            for i, f in enumerate(data.features)
            if f.channel == name and data.usable[i] and simulated[i] != 0.0
        ]
        firm = [i for i in rows if abs(data.values[i]) > 3.0 * data.noise[i]]
        if not firm:
            continue
        ratio = float(np.median(np.abs(data.values[firm] / simulated[firm])))
        own = units.worth(kind, entry.unit)[0]
        for unit in KINDS[kind].units:
            factor = own / units.worth(kind, unit)[0]
            if max(factor, 1.0 / factor) > UNLIKE and 1.0 / RATIO < ratio / factor < RATIO:
                yield DataFinding(
                    id="unit", weight="suspect", channels=(name,),
                    text=f"{name}: reads {ratio:.3g} times what is simulated; its numbers would fit {unit} instead of "
                    f"{entry.unit}; look at its unit",
                )  # fmt: skip
                break


def thousands_findings(data: Data, simulated: Array) -> Iterator[DataFinding]:
    """Channels of which a few readings are 1000 times less or more than simulated: thousands read as decimals."""
    told = {name for finding in data.findings if finding.id == "thousands" for name in finding.channels}
    rows: dict[str, list[int]] = {}
    for i, feature in enumerate(data.features):
        if data.usable[i] and feature.order == 0.0 and simulated[i] != 0.0:
            rows.setdefault(feature.channel, []).append(i)
    for name in rows.keys() - told:
        entry, own = data.channels[name], np.array(rows[name])
        kind = CHANNELS[entry.channel.quantity].kind
        ratio = np.abs(data.values[own] / simulated[own])
        for factor in (1e-3, 1e3):
            hit = own[(ratio < RATIO * factor) & (ratio * RATIO > factor)]
            if kind == "temperature" or not 0 < 2 * hit.size <= own.size:
                continue
            read, right = (
                units.show(float(x[hit[0]]), kind, entry.unit, 4) for x in (data.values, simulated)
            )
            points = tuple(data.features[i].setting for i in hit)
            yield DataFinding(
                id="thousands", weight="suspect", channels=(name,), points=points,
                text=f"{name} at {', '.join(points)}: reads {read}, simulated is {right}, a factor of 1000; look at "
                "the decimal sign there",
            )  # fmt: skip


FAR = 3.0
"""How far off, in standard deviations, both channels have to be as they stand."""
GAIN = 0.25
"""What may be left of the squared residual when the two are exchanged."""


def swap_findings(data: Data, simulated: Array, spread: Array) -> Iterator[DataFinding]:
    """Suspected swaps of channels of one quantity, best first; each channel is named once."""
    series: dict[str, dict[tuple[str, float, str], int]] = {}
    for i, feature in enumerate(data.features):
        if data.usable[i]:
            key = (feature.setting, feature.order, feature.part)
            series.setdefault(feature.channel, {})[key] = i
    found = []
    for first, second in combinations(series, 2):
        if data.channels[first].channel.quantity != data.channels[second].channel.quantity:
            continue
        keys = [key for key in series[first] if key in series[second]]
        if len(keys) < 2:
            continue
        a, b = ([series[name][key] for key in keys] for name in (first, second))
        sigma = np.sqrt(0.5 * (spread[a] ** 2 + spread[b] ** 2))
        as_is = [float(np.mean(((data.values[i] - simulated[i]) / sigma) ** 2)) for i in (a, b)]
        crossed = [
            float(np.mean(((data.values[i] - simulated[j]) / sigma) ** 2)) for i, j in ((a, b), (b, a))
        ]
        if min(as_is) > FAR**2 and all(c < GAIN * s for c, s in zip(crossed, as_is)):
            found.append((sum(crossed) / sum(as_is), first, second))
    named: set[str] = set()
    for left, first, second in sorted(found):
        if named & {first, second}:
            continue
        named |= {first, second}
        yield DataFinding(
            id="swapped_channels", weight="suspect", channels=(first, second),
            text=f"{first} and {second}: exchanged, they leave {left:.1%} of their squared residual; look at their "
            "cables and names",
        )  # fmt: skip
