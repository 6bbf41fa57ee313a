"""A rig calibrated from files: healthy sets of it, the values they give, and what they say of each other."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rigdesign.base.errors import MeasurementError, UsageError
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.cross_validation import Problem
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.rig_calibration.estimate import FEWEST, MOST, RigFit, estimate
from rigdesign.diagnosis.run import read_residuals
from rigdesign.measurement import MeasurementSet, load_measurement
from rigdesign.prediction.model import met_again
from rigdesign.run.solver_errors import solver_errors

Progress = Callable[[str], None]


# Every healthy set diagnosed with the others: whether a calibration keeps quiet on sets that it has not seen.
#
# A set is diagnosed against the model and with every other one as baseline. The calibration is that of the other sets
# where at least two remain, the shipped one otherwise.

QUIET = frozenset({"within_noise", "too_small", "data_insufficient"})
"""Verdicts that are right for a healthy set; every other one is an alarm."""


@dataclass(frozen=True, kw_only=True)
class HealthySet:
    """A set of a rig that is known to be healthy.

    name : for tables, the name of its folder; seed, repeated : as of a `Problem`
    """

    name: str
    residuals: ResidualProblem
    seed: str
    repeated: bool


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """A set as the others see it.

    baseline : name of the set it is held against, None against the model; calibrated_by : names of the sets that its
        calibration is from, none for the shipped one
    chi_square : whitened square per number with that calibration, and before : with the shipped one
    """

    name: str
    baseline: str | None
    calibrated_by: tuple[str, ...]
    verdict: str
    named: tuple[str, ...]
    reason: str
    numbers: int
    chi_square: float
    before: float

    @property
    def alarm(self) -> bool:
        """Whether a healthy set is said to have an effect, or wrong data."""
        return self.verdict not in QUIET


def leave_one_out(
    sets: Sequence[HealthySet],
    shipped: Calibration,
    whole: RigFit,
    say: Progress = lambda message: None,
) -> tuple[LeftOut, ...]:
    """All sets, each against the model and against every other one.

    whole : the fit to all sets, from whose amplitudes the searches start
    """
    rows = []
    for healthy_set in sets:
        others = [other for other in sets if other is not healthy_set]
        say(f"set {healthy_set.name} with the others")
        calibration, by = shipped, tuple[str, ...]()
        if len(others) >= FEWEST:
            start = whole.calibration.amplitudes
            calibration = estimate([other.residuals for other in others], shipped, start).calibration
            by = tuple(other.name for other in others)
        rows += [_left_out(healthy_set, other, calibration, by, shipped) for other in (None, *others)]
    return tuple(rows)


def odd_sets(rows: Sequence[LeftOut]) -> tuple[str, ...]:
    """Names of the sets that do not look like the others: an alarm with more than half of them as baseline.

    Counted while the set is left out of the calibration; of two sets the data do not say which of them is off.
    """
    odd = []
    for name in dict.fromkeys(row.name for row in rows):
        of_set = [row for row in rows if row.name == name and row.baseline is not None]
        if sum(row.alarm for row in of_set) > len(of_set) / 2.0:
            odd.append(name)
    return tuple(odd)


def _left_out(
    healthy_set: HealthySet,
    other: HealthySet | None,
    calibration: Calibration,
    by: tuple[str, ...],
    shipped: Calibration,
) -> LeftOut:
    problem = Problem(
        residuals=healthy_set.residuals,
        baseline=None if other is None else other.residuals,
        seed=healthy_set.seed,
        repeated=healthy_set.repeated,
    )
    diagnosis = diagnose(problem, calibration)
    square = diagnosis.whitened_square
    before = square if calibration is shipped else _with(problem, diagnosis.kept, shipped)
    return LeftOut(
        name=healthy_set.name,
        baseline=None if other is None else other.name,
        calibrated_by=by,
        verdict=diagnosis.decision.verdict,
        named=diagnosis.decision.named,
        reason=diagnosis.decision.reason,
        numbers=len(diagnosis.kept),
        chi_square=square / len(diagnosis.kept),
        before=before / len(diagnosis.kept),
    )


def _with(problem: Problem, kept: Sequence[int], calibration: Calibration) -> float:
    """Whitened square of the numbers kept with another calibration."""
    if problem.baseline is None:
        return replace(problem, residuals=problem.residuals.rows(kept)).space(calibration).chi_square
    return problem.space(calibration).rows(kept).chi_square


LEAST_AGAIN = 3
"""Operating points that each two sets have to share: as many as a diagnosis needs."""


@dataclass(frozen=True, kw_only=True)
class RigCalibration:
    """A rig as its healthy sets have it; names : of the sets, in their order."""

    case: Case
    measurements: tuple[MeasurementSet, ...]
    names: tuple[str, ...]
    fit: RigFit
    left_out: tuple[LeftOut, ...]

    @property
    def odd(self) -> tuple[str, ...]:
        """Names of sets that do not look like the others."""
        return odd_sets(self.left_out)


def calibrate_rig(
    case: Case,
    folders: Sequence[Path],
    *,
    shipped: Calibration = DEFAULT,
    say: Progress = lambda message: None,
) -> RigCalibration:
    """Drift, channels and model error of a rig from two to four healthy sets of it.

    A baseline that a set names is not used: every set is held against every other one.

    Raises
    ------
    UsageError
        Fewer or more sets, or one of them twice.
    MeasurementError
        Data of which nothing can be used, or sets that share fewer than `LEAST_AGAIN` operating points.
    CaseError, NotConvergedError, MissingLibraryError
        As ``run_case``.
    """
    if not FEWEST <= len(folders) <= MOST:
        raise UsageError(
            f"healthy sets: {len(folders)} given, {FEWEST} to {MOST} are needed; "
            "a single set fits the constants of the case with --constants"
        )
    measurements = tuple(load_measurement(folder, case) for folder in folders)
    names = _names(measurements)
    _check_shared(measurements, names)
    read = [entry.channel for measurement in measurements for entry in measurement.channels.values()]
    effects = effects_of(case, channels=read)
    sets = []
    with solver_errors(case):
        for name, measurement in zip(names, measurements, strict=True):
            data, residuals = read_residuals(case, measurement, effects, say)
            repeated = data.strength == "proven"
            sets.append(HealthySet(name=name, residuals=residuals, seed=measurement.hash, repeated=repeated))
        say("fitting drift and model error")
        fit = estimate([healthy_set.residuals for healthy_set in sets], shipped)
        left_out = leave_one_out(sets, shipped, fit, say)
    return RigCalibration(case=case, measurements=measurements, names=names, fit=fit, left_out=left_out)


def _names(measurements: Sequence[MeasurementSet]) -> tuple[str, ...]:
    """Folder of each set, with the folder above where two are called the same."""
    hashes: dict[str, MeasurementSet] = {}
    for measurement in measurements:
        if measurement.hash in hashes:
            raise UsageError(
                f"{measurement.folder}: the same readings as {hashes[measurement.hash].folder}; "
                "give each healthy set once"
            )
        hashes[measurement.hash] = measurement
    folders = [measurement.folder.resolve() for measurement in measurements]
    short = [folder.name for folder in folders]
    return tuple(
        name if short.count(name) == 1 else f"{folder.parent.name}/{name}"
        for folder, name in zip(folders, short, strict=True)
    )


def _check_shared(measurements: Sequence[MeasurementSet], names: Sequence[str]) -> None:
    """Sets without common points say nothing of a drift."""
    for place, measurement in enumerate(measurements):
        for other, name in zip(measurements[:place], names[:place], strict=True):
            again = len(met_again(measurement.settings, other.settings)) - 1
            if again < LEAST_AGAIN:
                raise MeasurementError(
                    f"operating points that {names[place]} and {name} share: {again}, at least {LEAST_AGAIN} are "
                    "needed; run the same points in every healthy set"
                )
