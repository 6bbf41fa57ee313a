"""Every healthy set diagnosed with the others: whether a calibration keeps quiet on sets that it has not seen.

A set is diagnosed against the model and with every other one as baseline. The calibration is that of the other sets
where at least two remain, the shipped one otherwise.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from rigdesign.diagnosis.decision.defaults import Calibration
from rigdesign.diagnosis.decision.problem import Problem
from rigdesign.diagnosis.decision.workflow import diagnose
from rigdesign.diagnosis.residual.residual_problem import ResidualProblem
from rigdesign.diagnosis.rig_calibration.estimate import FEWEST, RigFit, estimate

QUIET = frozenset({"within_noise", "too_small", "data_insufficient"})
"""Verdicts that are right for a healthy set; every other one is an alarm."""

Progress = Callable[[str], None]


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
    for one in sets:
        others = [other for other in sets if other is not one]
        say(f"set {one.name} with the others")
        calibration, by = shipped, tuple[str, ...]()
        if len(others) >= FEWEST:
            start = whole.calibration.amplitudes
            calibration = estimate([other.residuals for other in others], shipped, start).calibration
            by = tuple(other.name for other in others)
        rows += [_left_out(one, other, calibration, by, shipped) for other in (None, *others)]
    return tuple(rows)


def odd_sets(rows: Sequence[LeftOut]) -> tuple[str, ...]:
    """Names of the sets that do not look like the others: an alarm with more than half of them as baseline.

    Counted while the set is left out of the calibration; of two sets the data do not say which of them is off.
    """
    odd = []
    for name in dict.fromkeys(row.name for row in rows):
        own = [row for row in rows if row.name == name and row.baseline is not None]
        if sum(row.alarm for row in own) > len(own) / 2.0:
            odd.append(name)
    return tuple(odd)


def _left_out(
    one: HealthySet,
    other: HealthySet | None,
    calibration: Calibration,
    by: tuple[str, ...],
    shipped: Calibration,
) -> LeftOut:
    problem = Problem(
        residuals=one.residuals,
        baseline=None if other is None else other.residuals,
        seed=one.seed,
        repeated=one.repeated,
    )
    found = diagnose(problem, calibration)
    square = found.whitened_square
    before = square if calibration is shipped else _with(problem, found.kept, shipped)
    return LeftOut(
        name=one.name,
        baseline=None if other is None else other.name,
        calibrated_by=by,
        verdict=found.decision.verdict,
        named=found.decision.named,
        reason=found.decision.reason,
        numbers=len(found.kept),
        chi_square=square / len(found.kept),
        before=before / len(found.kept),
    )


def _with(problem: Problem, kept: Sequence[int], calibration: Calibration) -> float:
    """Whitened square of the numbers kept with another calibration."""
    if problem.baseline is None:
        return replace(problem, residuals=problem.residuals.rows(kept)).space(calibration).chi_square
    return problem.space(calibration).rows(kept).chi_square
