"""A comparison from files: measurement set, healthy set if it names one, simulation of both."""

from collections.abc import Callable, Sequence
from pathlib import Path

from rigdesign.base.fidelity import Fidelity
from rigdesign.case import Case
from rigdesign.measurement.comparison.compare import Comparison, compare
from rigdesign.measurement.data import Data
from rigdesign.measurement.loader import load_measurement
from rigdesign.measurement.processing.baseline import HealthySet, at_all, shared_channels
from rigdesign.measurement.processing.features import features
from rigdesign.prediction.model import Channel, Prediction, measured_against
from rigdesign.prediction.predict import Thermal, predict

Progress = Callable[[str], None]


def compare_measurement(
    case: Case,
    folder: Path,
    *,
    model: Thermal = "full",
    fidelity: Fidelity = "quick",
    say: Progress = lambda message: None,
) -> Comparison:
    """Hold a measurement set, and the healthy set it declares, against the simulation.

    Raises
    ------
    MeasurementError
        Data of which nothing can be used, in either set.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    measurement = load_measurement(folder, case)
    baseline = None if measurement.baseline is None else load_measurement(measurement.baseline, case)
    data = features(measurement)
    healthy = None if baseline is None else features(baseline)

    def simulated(of: Data, channels: Sequence[Channel], what: str) -> Prediction:
        say(f"predicting {len(of.settings)} operating points of {what}")
        return predict(
            case, of.settings, channels, model=model, fidelity=fidelity, circuit=measured_against(channels)
        )

    prediction = simulated(data, [entry.channel for entry in data.channels.values()], "the set")
    if baseline is None or healthy is None:
        return compare(measurement, data, prediction)
    shared = simulated(healthy, shared_channels(data, healthy), "the healthy set")
    known = HealthySet(measurement=baseline, data=healthy, prediction=at_all(healthy, shared))
    return compare(measurement, data, prediction, known)
