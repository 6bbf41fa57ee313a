"""A diagnosis from files: measurement set, healthy baseline if there is one, library of the rig, verdict."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.diagnosis.decision.cross_validation import FullRun, Problem
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.decision.patch import Constants, constants, patched_values
from rigdesign.diagnosis.decision.proposals import (
    NOTHING_NEXT,
    NextMeasurements,
    Offer,
    extras_of,
    next_measurements,
)
from rigdesign.diagnosis.decision.workflow import LEAST_RUNNING_POINTS, Diagnosis, diagnose
from rigdesign.diagnosis.library.build import build_library
from rigdesign.diagnosis.library.cache import library_of, stored_library
from rigdesign.diagnosis.library.candidates import Costs, spare_channels
from rigdesign.diagnosis.library.library import Library
from rigdesign.diagnosis.residual.metrology import inspected
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem, compare, plain
from rigdesign.diagnosis.residual.sensors import Stated
from rigdesign.measurement import Data, MeasurementSet, features, load_measurement
from rigdesign.measurement.comparison.compare import compare as comparison
from rigdesign.measurement.places import Places
from rigdesign.measurement.processing.baseline import HealthySet, at_all
from rigdesign.prediction.model import Channel, OperatingCondition, Prediction
from rigdesign.run.solver_errors import solver_errors

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Result:
    """A diagnosis with what it was made from."""

    case: Case
    measurement: MeasurementSet
    data: Data
    baseline: MeasurementSet | None
    problem: Problem
    effects: tuple[Effect, ...]
    diagnosis: Diagnosis
    calibration: Calibration
    next_measurements: NextMeasurements = NOTHING_NEXT


def diagnose_measurement(
    case: Case,
    folder: Path,
    *,
    calibration: Calibration = DEFAULT,
    propose: bool = True,
    say: Progress = lambda message: None,
) -> Result:
    """Diagnose a measurement set of a rig.

    propose : look for the next measurement where nothing is named, for which the model is run at points in addition

    Raises
    ------
    MeasurementError
        Data of which nothing can be used.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    measurement = load_measurement(folder, case)
    healthy = None if measurement.baseline is None else load_measurement(measurement.baseline, case)
    effects = _simplified(effects_of(case, channels=_channels(case, measurement)[0]), len(measurement.points))
    with solver_errors(case):
        data, residuals = read_residuals(case, measurement, effects, say)
        before = known = None
        if healthy is not None:
            data_before, before = read_residuals(case, healthy, effects, say)
            known = HealthySet(
                measurement=healthy, data=data_before, prediction=_predicted(data_before, before)
            )
        data = _compared(measurement, data, _predicted(data, residuals), known)
        problem = Problem(
            residuals=residuals,
            baseline=before,
            seed=measurement.hash,
            repeated=data.strength == "proven",
        )
        say("evaluating hypotheses")
        channels = tuple(entry.channel for entry in data.channels.values())
        rerun = FullRun(case=case, settings=data.settings, channels=channels, effects=effects, say=say)
        diagnosis = diagnose(problem, calibration, rerun)
        ahead = NOTHING_NEXT
        if propose:
            ahead = next_measurements(
                problem,
                diagnosis,
                lambda: _offer(case, measurement, data.settings, effects, say),
                calibration,
            )
    return Result(
        case=case,
        measurement=measurement,
        data=data,
        baseline=healthy,
        problem=problem,
        effects=effects,
        diagnosis=diagnosis,
        calibration=calibration,
        next_measurements=ahead,
    )


@dataclass(frozen=True, kw_only=True)
class Calibrated:
    """Constants of a case from a healthy set of its rig, and the values of the case that they change."""

    case: Case
    measurement: MeasurementSet
    constants: Constants
    title: str
    values: Mapping[str, Mapping[str, Any]]


def calibrate_case(
    case: Case,
    folder: Path,
    *,
    calibration: Calibration = DEFAULT,
    say: Progress = lambda message: None,
) -> Calibrated:
    """Fit the uncertain constants of a case to a set of its rig that is known to be healthy.

    Raises
    ------
    MeasurementError
        Data of which nothing can be used.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    measurement = load_measurement(folder, case)
    effects = effects_of(case, channels=_channels(case, measurement)[0])
    with solver_errors(case):
        residuals = read_residuals(case, measurement, effects, say)[1]
        say("fitting constants")
        fit = constants(plain(residuals, calibration.amplitudes, calibration.inflation), effects)
        reason = f"fitted to the healthy measurement {measurement.title!r} ({measurement.hash[:16]})"
        values = patched_values(case, [entry.fitted(reason) for entry in fit.entries])
    return Calibrated(
        case=case,
        measurement=measurement,
        constants=fit,
        title=f"{case.title}, constants fitted to a healthy set",
        values=values,
    )


def _predicted(data: Data, residuals: ResidualProblem) -> Prediction:
    """What the library has of the numbers of a set."""
    library = residuals.library
    return at_all(data, Prediction(features=residuals.features, values=library.base, error=library.error))


def _compared(
    measurement: MeasurementSet, data: Data, prediction: Prediction, healthy: HealthySet | None
) -> Data:
    """The data with what a comparison finds: exchanged channels, other units."""
    predicted = replace(data, usable=data.usable & np.isfinite(prediction.values))
    return replace(data, findings=comparison(measurement, predicted, prediction, healthy).findings)


def _simplified(effects: tuple[Effect, ...], points: int) -> tuple[Effect, ...]:
    """Effects as they are run: where no name can come of it, one run each of those of the power circuit."""
    if points >= LEAST_RUNNING_POINTS:
        return effects
    return tuple(replace(effect, linear=True) if effect.family.dynamic else effect for effect in effects)


def _offer(
    case: Case,
    measurement: MeasurementSet,
    settings: tuple[OperatingCondition, ...],
    effects: tuple[Effect, ...],
    say: Progress,
) -> Offer | None:
    """The points and sensors that could be added; None if the stored library of the rig has no such sensors.

    The model is run at the points when they are first asked for.
    """
    say("looking for the next measurement")
    channels = tuple(chain(*_channels(case, measurement)))
    library = stored_library(case, settings, channels, effects)
    if library is None:
        return None
    extras = extras_of(case, settings)
    points = tuple(extra.setting for extra in extras)
    more = library_of(
        case, points, channels, effects, lambda: build_library(case, points, channels, effects, say), say
    )
    return Offer(library=library.joined(more), extras=extras, costs=Costs(stated=measurement.costs))


def _channels(case: Case, measurement: MeasurementSet) -> tuple[tuple[Channel, ...], tuple[Channel, ...]]:
    """Channels of a set, and those it could have in addition."""
    channels = tuple(entry.channel for entry in measurement.channels.values())
    orders = max((channel.orders for channel in channels), key=len, default=())
    return channels, spare_channels(case, channels, orders)


def read_residuals(
    case: Case,
    measurement: MeasurementSet,
    effects: tuple[Effect, ...],
    say: Progress = lambda message: None,
) -> tuple[Data, ResidualProblem]:
    """Readings of a set held against the library of its rig, which is made where none is kept."""
    data = features(measurement)
    channels, spare = _channels(case, measurement)

    def build() -> Library:
        return build_library(case, data.settings, (*channels, *spare), effects, say)

    library = library_of(case, data.settings, channels, effects, build, say)
    known = inspected(effects, measurement.inspections, str(measurement.folder))
    return data, compare(
        data, library, known, stated_settings(measurement), mesh_orders(case), teeth_a_turn(case)
    )


def stated_settings(measurement: MeasurementSet) -> Mapping[tuple[str, str], Stated]:
    """Systematic uncertainties of the settings, by (kind, place)."""
    return {
        (sensor.quantity, sensor.place): Stated(offset=sensor.offset_sd, scale=sensor.scale_sd)
        for sensor in measurement.setting_sensors.values()
    }


HIGHEST = 40
"""Multiple of the mesh frequency up to which an order counts as one of a mesh."""


def mesh_orders(case: Case) -> frozenset[float]:
    """Orders of all meshes per turn of the reference gear; none without a drivetrain."""
    if case.drivetrain is None:
        return frozenset()
    orders = Places(case).mesh_orders.values()
    return frozenset(float(k * order) for order in orders for k in range(1, HIGHEST))


def teeth_a_turn(case: Case) -> int:
    """Of the reference gear."""
    gear = Places(case).counting_gear
    return case.gearboxes[gear.gearbox].gears[gear.part].teeth
