"""The rig with one input at one end of its range: from the converged stated rig, only what the input touches again."""

from dataclasses import dataclass

from threadpoolctl import threadpool_limits

from rigdesign.base.errors import RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.checks import held_checks
from rigdesign.reanalysis.affected_parts import Part
from rigdesign.reanalysis.modified_rig import Modification, modified_rig
from rigdesign.reanalysis.reference import Reference, restored, solve_reference
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.results.units import ZERO
from rigdesign.results.verdict import Verdict
from rigdesign.run.solver_errors import solver_errors
from rigdesign.uncertainty.plan import RangeEnd

FIDELITY: Fidelity = "quick"
"""Size of the models of every end."""


@dataclass(frozen=True, kw_only=True)
class CheckAtEnd:
    """What a check says at one end, at quick fidelity."""

    value: float | None
    margin: float | None
    utilisation: float | None
    verdict: Verdict


@dataclass(frozen=True, kw_only=True)
class EndResult:
    """What came of one end: checks by id and the highest temperature of all housings, or the error."""

    checks: dict[str, CheckAtEnd]
    max_temperature: float | None
    """[degC]"""
    parts: tuple[Part, ...] = ()
    """What was solved again."""
    error: str | None = None


def solve_stated(case: Case) -> tuple[Reference, EndResult]:
    """Solve the stated rig, and its checks."""
    reference, solved = solve_reference(case, FIDELITY)
    return reference, _outcome(solved, ())


def solve_end(end: RangeEnd, *, reference: Reference) -> EndResult:
    """Solve one end; an error is an outcome that says what happened.

    The stated rig is made once in every process.
    """
    assert end.case is not None
    modification = Modification(case=end.case, parts=end.parts)
    try:
        with solver_errors(end.case), threadpool_limits(limits=1):
            solved, parts = modified_rig(restored(reference), modification, reference.motor_losses)
            return _outcome(solved, parts)
    except RigdesignError as error:
        return EndResult(checks={}, max_temperature=None, error=str(error))
    except Exception as error:
        return EndResult(checks={}, max_temperature=None, error=f"{type(error).__name__}: {error}")


def _outcome(solved: SolvedRig, parts: tuple[Part, ...]) -> EndResult:
    return EndResult(
        checks={check.id: _at_end(check) for check in held_checks(solved)},
        max_temperature=max((found.highest - ZERO for found in solved.temperatures), default=None),
        parts=parts,
    )


def _at_end(check: Check) -> CheckAtEnd:
    return CheckAtEnd(
        value=check.value, margin=check.margin, utilisation=check.utilisation, verdict=check.verdict
    )
