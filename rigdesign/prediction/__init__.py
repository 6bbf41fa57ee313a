"""What sensors on the rig would read: the models of a check at single operating points."""

from rigdesign.prediction.model import Channel, Feature, Prediction, Setting, features_of

__all__ = ["Channel", "Feature", "Prediction", "Setting", "features_of"]
