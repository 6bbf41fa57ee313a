"""How far readings of speed, torque, oil and room move the simulated numbers: slopes from the points themselves.

The simulation is taken at the settings as they were read; their scatter moves it. The slope of each number along
each setting is that of the smallest plane through its values at the operating points (least squares of minimum
norm); a setting that never changes has no slope there, but a stream's own inlet moves its outlet and the
temperatures around it one to one.
"""

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.data import Data
from rigdesign.measurement.quantities import CHANNELS
from rigdesign.prediction.model import OperatingCondition

Array = NDArray[np.float64]
Key = tuple[str, str]


def setting_spread(data: Data, simulated: Array) -> Array:
    """1 sigma of every simulated number from the scatter of the readings it was simulated at (n_features,) [SI].

    Zero where nothing is simulated (NaN).
    """
    keys = sorted({key for noise in data.setting_noise for key in noise})
    place = {setting.name: i for i, setting in enumerate(data.settings)}
    levels = np.array([[_level(setting, key) for key in keys] for setting in data.settings], dtype=float)
    noise = np.array([[found.get(key, 0.0) for key in keys] for found in data.setting_noise], dtype=float)
    if not keys:
        return np.zeros(len(data.features))
    levels = np.where(np.isfinite(levels), levels, np.nanmean(levels, axis=0, keepdims=True))
    centred = levels - levels.mean(axis=0)
    extent = np.abs(centred).max(axis=0)
    moving = extent > 5.0 * noise.max(axis=0)
    variance = np.zeros(len(data.features))
    for rows in _series(data, np.isfinite(simulated)).values():
        at = [place[data.features[i].setting] for i in rows]
        values = simulated[rows]
        if moving.any() and len(rows) > 2:
            scaled = centred[at][:, moving] / extent[moving]
            slopes = np.linalg.lstsq(scaled, values - values.mean(), rcond=1e-2)[0] / extent[moving]
            variance[rows] += ((noise[at][:, moving] * slopes) ** 2).sum(axis=1)
        channel = data.channels[data.features[rows[0]].channel].channel
        if CHANNELS[channel.quantity].kind == "temperature":
            box = channel.place.partition(".")[0]
            for column, (quantity, where) in enumerate(keys):
                mine = where == channel.place or (
                    where.startswith(f"{box}.") and channel.quantity == "temperature"
                )
                if quantity == "inlet_temperature" and mine and not moving[column]:
                    variance[rows] += noise[at, column] ** 2
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
