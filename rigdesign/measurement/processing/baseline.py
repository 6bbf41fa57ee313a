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
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.measurement.reading.measurement_set import MeasurementSet
from rigdesign.prediction.model import Channel, OperatingCondition, Prediction, met_again

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
    reads = {name: entry.channel.reads for name, entry in data.channels.items()}
    return [
        entry.channel for name, entry in healthy.channels.items() if reads.get(name) == entry.channel.reads
    ]


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


# How far readings of speed, torque, oil and room move the simulated numbers: slopes from the points themselves.
#
# The simulation is taken at the settings as they were read; their scatter moves it. The slope of each number along
# each setting is that of the smallest plane through its values at the operating points (least squares of minimum
# norm); a setting that never changes has no slope there, but a stream's own inlet moves its outlet and the
# temperatures around it one to one.

Key = tuple[str, str]


def setting_spread(data: Data, simulated: Array) -> Array:
    """1 sigma of every simulated number from the scatter of the readings it was simulated at (n_features,) [SI].

    Zero where nothing is simulated (NaN).
    """
    keys = sorted({key for noise in data.setting_noise for key in noise})
    place = {setting.name: i for i, setting in enumerate(data.settings)}
    levels = np.array([[_level(setting, key) for key in keys] for setting in data.settings], dtype=float)
    noise = np.array(
        [[at_point.get(key, 0.0) for key in keys] for at_point in data.setting_noise], dtype=float
    )
    if not keys:
        return np.zeros(len(data.features))
    levels = np.where(np.isfinite(levels), levels, np.nanmean(levels, axis=0, keepdims=True))
    centred = levels - levels.mean(axis=0)
    extent = np.abs(centred).max(axis=0)
    moving = extent > 5.0 * noise.max(axis=0)
    variance = np.zeros(len(data.features))
    for rows in _series(data, np.isfinite(simulated)).values():
        points = [place[data.features[i].setting] for i in rows]
        values = simulated[rows]
        if moving.any() and len(rows) > 2:
            scaled = centred[points][:, moving] / extent[moving]
            slopes = np.linalg.lstsq(scaled, values - values.mean(), rcond=1e-2)[0] / extent[moving]
            variance[rows] += ((noise[points][:, moving] * slopes) ** 2).sum(axis=1)
        channel = data.channels[data.features[rows[0]].channel].channel
        if CHANNELS[channel.quantity].kind == "temperature":
            box = channel.place.partition(".")[0]
            for column, (quantity, where) in enumerate(keys):
                mine = where == channel.place or (
                    where.startswith(f"{box}.") and channel.quantity == "temperature"
                )
                if quantity == "inlet_temperature" and mine and not moving[column]:
                    variance[rows] += noise[points, column] ** 2
    return np.sqrt(variance)


def _series(data: Data, known: NDArray[np.bool_]) -> dict[tuple[str, float, str], list[int]]:
    series: dict[tuple[str, float, str], list[int]] = {}
    for i, feature in enumerate(data.features):
        if feature.setting and known[i]:
            series.setdefault((feature.channel, feature.order, feature.part), []).append(i)
    return series


def _level(setting: OperatingCondition, key: Key) -> float:
    quantity, place = key
    if quantity == "inlet_temperature":
        return setting.inlet_temperature.get(place, np.nan)
    if quantity == "flow":
        return setting.flow.get(place, np.nan)
    if quantity == "ambient_temperature":
        return np.nan if setting.ambient_temperature is None else setting.ambient_temperature
    return setting.speed if quantity == "speed" else setting.torque
