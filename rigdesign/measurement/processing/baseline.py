"""What a healthy set of the same rig foretells: the residual it has at the numbers that are measured again.

What model and sensors have wrong is the same in both sets and cancels in the difference of their residuals; the
scatter of both remains (`rigdesign.diagnosis.residual.baseline` is the same with the covariance of the model's
constants).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.data import Data
from rigdesign.measurement.processing.propagation import setting_spread
from rigdesign.measurement.reading.measurement_set import MeasurementSet
from rigdesign.prediction.met_again import met_again
from rigdesign.prediction.model import Channel, Prediction

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class HealthySet:
    """The baseline of a set: its readings and their simulation.

    prediction : at ``data.features``, NaN for channels that the set does not have
    """

    measurement: MeasurementSet
    data: Data
    prediction: Prediction


@dataclass(frozen=True, kw_only=True)
class Foretold:
    """What a healthy set says of the numbers of another one.

    residual, variance, reading : (n,) measured less simulated in the healthy set [SI], its variance by noise and
        settings, the reading itself; NaN where it has no such number
    points : operating point -> that of the healthy set; "" is the rig at rest
    """

    residual: Array
    variance: Array
    reading: Array
    points: Mapping[str, str]

    @property
    def known(self) -> NDArray[np.bool_]:
        """(n,) whether the healthy set has the number."""
        return np.isfinite(self.residual)


def shared_channels(data: Data, healthy: Data) -> list[Channel]:
    """Channels of a healthy set that have the name, the quantity and the place of one of the set."""
    own = {name: entry.channel.reads for name, entry in data.channels.items()}
    return [entry.channel for name, entry in healthy.channels.items() if own.get(name) == entry.channel.reads]


def at_all(healthy: Data, prediction: Prediction) -> Prediction:
    """A prediction of some channels of a healthy set as one of all its numbers, NaN for the other channels."""
    values = dict(zip(prediction.features, prediction.values.tolist()))
    whole = np.array([values.get(feature, np.nan) for feature in healthy.features], dtype=float)
    return Prediction(features=healthy.features, values=whole, error=prediction.error)


def foretold(data: Data, healthy: HealthySet) -> Foretold:
    """Residuals of a healthy set in the order of the features of another one."""
    points = met_again(data.settings, healthy.data.settings)
    shared = {channel.name for channel in shared_channels(data, healthy.data)}
    simulated = healthy.prediction.values
    known = np.isfinite(simulated) & healthy.data.usable
    spread = setting_spread(healthy.data, simulated)
    rows = {feature: row for row, feature in enumerate(healthy.data.features) if known[row]}
    residual, variance, reading = (np.full(len(data.features), np.nan) for _ in range(3))
    for i, feature in enumerate(data.features):
        if feature.channel not in shared or feature.setting not in points:
            continue
        row = rows.get(replace(feature, setting=points[feature.setting]))
        if row is not None:
            reading[i] = healthy.data.values[row]
            residual[i] = reading[i] - simulated[row]
            variance[i] = healthy.data.noise[row] ** 2 + spread[row] ** 2
    return Foretold(residual=residual, variance=variance, reading=reading, points=points)
