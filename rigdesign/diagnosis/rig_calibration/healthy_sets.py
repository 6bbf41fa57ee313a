"""A rig calibrated from files: healthy sets of it, the values they give, and what they say of each other."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rigdesign.base.errors import MeasurementError, UsageError
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.decision.defaults import DEFAULT, Calibration
from rigdesign.diagnosis.rig_calibration.estimate import FEWEST, MOST, RigFit, estimate
from rigdesign.diagnosis.rig_calibration.leave_one_out import HealthySet, LeftOut, leave_one_out, odd_sets
from rigdesign.diagnosis.run import read_residuals
from rigdesign.measurement import MeasurementSet, load_measurement
from rigdesign.prediction.met_again import met_again
from rigdesign.run.solver_errors import solver_errors

Progress = Callable[[str], None]

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
    read = [entry.channel for one in measurements for entry in one.channels.values()]
    effects = effects_of(case, channels=read)
    sets = []
    with solver_errors(case):
        for name, one in zip(names, measurements, strict=True):
            data, residuals = read_residuals(case, one, effects, say)
            repeated = data.strength == "proven"
            sets.append(HealthySet(name=name, residuals=residuals, seed=one.hash, repeated=repeated))
        say("fitting drift and model error")
        fit = estimate([one.residuals for one in sets], shipped)
        left_out = leave_one_out(sets, shipped, fit, say)
    return RigCalibration(case=case, measurements=measurements, names=names, fit=fit, left_out=left_out)


def _names(measurements: Sequence[MeasurementSet]) -> tuple[str, ...]:
    """Folder of each set, with the folder above where two are called the same."""
    hashes: dict[str, MeasurementSet] = {}
    for one in measurements:
        if one.hash in hashes:
            raise UsageError(
                f"{one.folder}: the same readings as {hashes[one.hash].folder}; give each healthy set once"
            )
        hashes[one.hash] = one
    folders = [one.folder.resolve() for one in measurements]
    short = [folder.name for folder in folders]
    return tuple(
        name if short.count(name) == 1 else f"{folder.parent.name}/{name}"
        for folder, name in zip(folders, short, strict=True)
    )


def _check_shared(measurements: Sequence[MeasurementSet], names: Sequence[str]) -> None:
    """Sets without common points say nothing of a drift."""
    for place, one in enumerate(measurements):
        for other, name in zip(measurements[:place], names[:place], strict=True):
            again = len(met_again(one.settings, other.settings)) - 1
            if again < LEAST_AGAIN:
                raise MeasurementError(
                    f"operating points that {names[place]} and {name} share: {again}, at least {LEAST_AGAIN} are "
                    "needed; run the same points in every healthy set"
                )
