"""What the sensors of a rig would read, by the full thermal model or the reduced one."""

from collections.abc import Iterable
from typing import Literal

from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.prediction.full import predict_full
from rigdesign.prediction.model import OWN_MODEL, Channel, OperatingCondition, Prediction, PredictionModel
from rigdesign.prediction.predictor import Predictor

Thermal = Literal["full", "reduced"]
"""Temperature fields by the finite-element model of a check, or by its projection on a reduced basis."""


def predict(
    case: Case,
    settings: Iterable[OperatingCondition],
    channels: Iterable[Channel],
    *,
    model: Thermal = "full",
    circuit: PredictionModel = OWN_MODEL,
    fidelity: Fidelity = "quick",
) -> Prediction:
    """What the channels would read at the operating points of a measurement.

    The solve of a point is that of ``run_case``: the full model at a dwell of the schedule gives what a check with the
    same shafts and teeth gives. Every point starts from the one before, as in a check.

    Parameters
    ----------
    case : from `load_case`
    settings, channels : operating points as run, sensors as the model sees them; see `rigdesign.prediction.model`
    model : the full thermal model, or the reduced one of `Predictor` with its stated error
    circuit : shafts and teeth of the power circuit; left out, the shafts of the case
    fidelity : size of the models

    Raises
    ------
    UsageError
        A place, stream or quantity the case does not have; two settings or channels of one name.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    settings, channels = tuple(settings), tuple(channels)
    if model == "full":
        return predict_full(case, settings, channels, fidelity, circuit)
    predictor = Predictor(case, settings, channels, circuit=circuit, fidelity=fidelity)
    return Prediction(features=predictor.features, values=predictor.base, error=predictor.error)
