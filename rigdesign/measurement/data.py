"""Numbers of a measurement set that a prediction is held against."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigdesign.measurement.reading.measurement_set import DataFinding, MeasuredChannel
from rigdesign.prediction.model import Feature, OperatingCondition

Strength = Literal["proven", "indicative"]


@dataclass(frozen=True, kw_only=True)
class Data:
    """Numbers of a measurement set in the order of ``features_of(settings, channels)``, SI.

    features, values, noise, usable, repeats : one entry per feature; NaN and infinity where not usable
    """

    features: tuple[Feature, ...]
    values: NDArray[np.float64]
    """Means over repeats, corrected for the transfer function of the sensor."""
    noise: NDArray[np.float64]
    """1 sigma of the mean: repeats pooled over the operating points, or the declared uncertainty."""
    usable: NDArray[np.bool_]
    repeats: NDArray[np.int64]
    """Readings behind each number."""
    settings: tuple[OperatingCondition, ...]
    setting_noise: tuple[Mapping[tuple[str, str], float], ...]
    """Per setting, 1 sigma of the mean of each measured setting by (quantity, place) [SI; K]."""
    assembly: tuple[int, ...]
    """Per setting, how often the rig has been put together anew before it."""
    channels: Mapping[str, MeasuredChannel]
    findings: tuple[DataFinding, ...]
    strength: Strength
    """indicative: without repeats, the declared noise is used."""
