"""What sensors on the rig would read: the models of a check at single operating points."""

from rigdesign.prediction.model import Channel, Feature, OperatingCondition, Prediction, features_of

__all__ = ["Channel", "Feature", "OperatingCondition", "Prediction", "features_of"]
