"""What sensors on the rig would read: the models of a check at single operating points."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from rigdesign.prediction.model import Channel, Feature, Prediction, Setting, features_of

if TYPE_CHECKING:
    from rigdesign.prediction.full import predict
    from rigdesign.prediction.predictor import Predictor

__all__ = ["Channel", "Feature", "Prediction", "Predictor", "Setting", "features_of", "predict"]

_LATE = {"predict": "rigdesign.prediction.full", "Predictor": "rigdesign.prediction.predictor"}


def __getattr__(name: str) -> Any:
    """What needs ``rigdesign.run.main`` when it is first asked for: that module needs the contract here."""
    if name in _LATE:
        return getattr(import_module(_LATE[name]), name)
    raise AttributeError(name)
