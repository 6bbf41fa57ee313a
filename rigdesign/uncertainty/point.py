"""The rig with one input at one end of its range: from the converged stated rig, only what the input touches again."""

from dataclasses import dataclass

from rigdesign.base.errors import RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.model import Case
from rigdesign.checks import held_checks
from rigdesign.reanalysis.affected_parts import Part, Reanalysis
from rigdesign.reanalysis.reference import (
    ReanalysisResult,
    Reference,
    reanalysed,
    result_of,
    solve_reference,
)
from rigdesign.results.check import Check, Verdict
from rigdesign.uncertainty.plan import RangeEnd

FIDELITY: Fidelity = "quick"
"""Size of the models of every end."""


@dataclass(frozen=True, kw_only=True)
class CheckAtEnd:
    """What a check says at one end, at quick fidelity."""

    value: float | None
    margin: float | None
    distance: float | None
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
    return reference, _outcome(result_of(solved, held_checks))


def solve_end(end: RangeEnd, *, reference: Reference) -> EndResult:
    """Solve one end; an error is an outcome that says what happened.

    The stated rig is made once in every process.
    """
    assert end.case is not None
    try:
        return _outcome(reanalysed(reference, Reanalysis(end.case, end.parts), held_checks))
    except RigdesignError as error:
        return EndResult(checks={}, max_temperature=None, error=str(error))
    except Exception as error:
        return EndResult(checks={}, max_temperature=None, error=f"{type(error).__name__}: {error}")


def _outcome(found: ReanalysisResult) -> EndResult:
    return EndResult(
        checks={check.id: _at_end(check) for check in found.checks},
        max_temperature=found.max_temperature_degC,
        parts=found.parts,
    )


def _at_end(check: Check) -> CheckAtEnd:
    return CheckAtEnd(value=check.value, margin=check.margin, distance=check.distance, verdict=check.verdict)
