"""Measurement sets: what sensors of the rig read, as numbers a prediction can be held against.

    load_measurement(folder, case) -> MeasurementSet     sensors, operating points as run, readings
    features(measurement) -> Data                        means over repeats, noise, data checks

``document`` is the table of contents of measurement.toml.
"""

from rigdesign.measurement.data import Data
from rigdesign.measurement.loader import load_measurement
from rigdesign.measurement.processing.features import features
from rigdesign.measurement.reading.measurement_set import (
    DataFinding,
    MeasuredChannel,
    MeasuredPoint,
    MeasurementSet,
    SettingSensor,
)

__all__ = [
    "Data",
    "DataFinding",
    "MeasuredChannel",
    "MeasuredPoint",
    "MeasurementSet",
    "SettingSensor",
    "features",
    "load_measurement",
]
