"""Which assumed inputs are moved to the ends of their ranges."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from rigdesign.base.errors import CaseError, RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.case.assumptions import AssumptionRecord
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.checks import held_checks
from rigdesign.results.check import Check, Verdict
from rigdesign.results.ranges import LeftOut
from rigdesign.studies.modified_rig import Part, Reanalysis, parts_of
from rigdesign.studies.reference_rig import (
    ReanalysisResult,
    Reference,
    reanalysed,
    result_of,
    solve_reference,
)

End = Literal["low", "high"]

ALIKE = ("diameter", "width", "diametral_clearance")
"""What the bearings of one shaft have in common (`case.surfaces`)."""


@dataclass(frozen=True, kw_only=True)
class RangeEnd:
    """One assumed input at one end of its range.

    value, stated : as the case writes them; case : None where that is no valid case, ``error`` then says why
    same : the end is the stated value
    """

    path: str
    together_with: tuple[str, ...]
    end: End
    value: str
    stated: str
    parts: tuple[Part, ...]
    case: Case | None
    error: str | None = None
    same: bool = False


def plan(case: Case, checks: Sequence[Check]) -> tuple[list[RangeEnd], list[LeftOut]]:
    """Both ends of every range that decides something, in the order of the case; and the inputs left out."""
    ends: list[RangeEnd] = []
    left: list[LeftOut] = []
    decisive = {path for check in checks for path in check.assumptions}
    moved: set[str] = set()
    for record in case.assumptions:
        if record.range is None or record.path in moved:
            continue
        if record.path not in decisive:
            left.append(LeftOut(path=record.path, reason="no check that applies depends on it"))
            continue
        ends += _ends(case, record, tied_inputs(case, record))
        moved |= {end_path for end in ends[-2:] for end_path in (end.path, *end.together_with)}
    return ends, left


def tied_inputs(case: Case, record: AssumptionRecord) -> tuple[str, ...]:
    """Paths that have the value of ``record`` in every valid case: the other bearings of its shaft, if so ranged."""
    names = record.path.split(".")
    if len(names) != 5 or names[2] != "bearings" or names[4] not in ALIKE:
        return ()
    bearings = case.gearboxes[names[1]].bearings
    alike = {
        f"gearboxes.{names[1]}.bearings.{other}.{names[4]}"
        for other, bearing in bearings.items()
        if bearing.shaft == bearings[names[3]].shaft and other != names[3]
    }
    same = (record.value, record.range)
    return tuple(r.path for r in case.assumptions if r.path in alike and (r.value, r.range) == same)


def _ends(case: Case, record: AssumptionRecord, tied: tuple[str, ...]) -> Iterator[RangeEnd]:
    assert record.range is not None
    before = case.model_dump()
    ends: tuple[End, End] = ("low", "high")
    for end, value in zip(ends, record.range, strict=True):
        changed, error = None, None
        try:
            changed = changed_together(case, dict.fromkeys((record.path, *tied), value))
        except CaseError as fault:
            error = str(fault)
        yield RangeEnd(
            path=record.path,
            together_with=tied,
            end=end,
            value=str(value),
            stated=record.value,
            parts=parts_of(record.path),
            case=changed,
            error=error,
            same=changed is not None and changed.model_dump() == before,
        )


# The rig with one input at one end of its range: from the converged stated rig, only what the input touches again.

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
