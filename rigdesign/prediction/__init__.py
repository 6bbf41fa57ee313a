"""What sensors on the rig would read: the models of a check at single operating points."""

from rigdesign.prediction.model import (
    MEASURED_AGAINST,
    OWN_MODEL,
    TORSIONAL,
    Channel,
    Feature,
    OperatingCondition,
    Prediction,
    PredictionModel,
    features_of,
    measured_against,
)

__all__ = [
    "MEASURED_AGAINST",
    "OWN_MODEL",
    "TORSIONAL",
    "Channel",
    "Feature",
    "OperatingCondition",
    "Prediction",
    "PredictionModel",
    "features_of",
    "measured_against",
]
