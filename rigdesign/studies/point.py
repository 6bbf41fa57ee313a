"""One point of a study: from the solved base case where its inputs touch a part of the model only, else in full.

Every point starts from the base case and from no other point, so that its numbers depend on neither order nor
workers. What the base case is solved for once: meshes and their errors, the response over speed and the time run.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace

from threadpoolctl import threadpool_limits

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.json_text import to_plain
from rigdesign.case.model import Case
from rigdesign.checks import estimated_checks
from rigdesign.checks.rules import overall
from rigdesign.reanalysis.affected_parts import PARTS, parts_of, through_heat
from rigdesign.reanalysis.modified_rig import Modification, TimeRun, modified_rig
from rigdesign.reanalysis.reference import Reference, restored, solve_reference
from rigdesign.results.check import Check
from rigdesign.results.units import ZERO
from rigdesign.rig.model import build_rig
from rigdesign.rig.reuse import same_housings
from rigdesign.run.main import Progress, run_case
from rigdesign.run.solver_errors import solver_errors
from rigdesign.studies.result import Record

CHECK_KEYS = (
    "id", "title", "group", "value", "limit", "upper_limit", "unit", "comparison", "margin", "utilisation", "verdict",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class StudyBase:
    """What all points of a study start from; made once, sent to every worker.

    paths : inputs that the study varies; reference : of the base case, None where every point is solved in full
    """

    fidelity: Fidelity
    paths: tuple[str, ...]
    reference: Reference | None


def study_base(
    case: Case, fidelity: Fidelity, paths: Collection[str], say: Progress = lambda message: None
) -> StudyBase:
    """Solve the base case if points of these inputs can start from it.

    Raises
    ------
    CaseError, NotConvergedError
        As `run_case`: the base case itself has no result.
    """
    ordered = tuple(sorted(paths))
    if not all(_in_part(path) for path in ordered):
        return StudyBase(fidelity=fidelity, paths=ordered, reference=None)
    reference, _ = solve_reference(case, fidelity, say)
    return StudyBase(fidelity=fidelity, paths=ordered, reference=reference)


def _in_part(path: str) -> bool:
    return through_heat(path) or parts_of(path) != PARTS


def solve_study_point(case: Case, *, base: StudyBase) -> Record:
    """Checks of one point.

    A point with other housings, and one whose loop does not converge from the base case, is solved in full.

    Raises
    ------
    RigdesignError
        The point has no result.
    """
    if base.reference is not None:
        found = _modified(case, base, base.reference)
        if found is not None:
            return found
    result = run_case(case, base.fidelity)
    hottest = max((item.max_temperature_degC for item in result.thermal), default=None)
    return _record(result.checks, hottest)


def _modified(case: Case, base: StudyBase, reference: Reference) -> Record | None:
    """The point from the base case; None where its housings are other ones or the loop does not converge from there."""
    parts = tuple(part for part in PARTS if any(part in parts_of(path) for path in base.paths))
    time_run: TimeRun = "shifted" if all(_through_heat(path) for path in base.paths) else "marched"
    with solver_errors(case), threadpool_limits(limits=1):
        stated = restored(reference)
        if not same_housings(build_rig(case, base.fidelity), stated.rig):
            return None
        try:
            solved, _ = modified_rig(
                stated, Modification(case=case, parts=parts, time_run=time_run), reference.motor_losses
            )
        except NotConvergedError:
            return None
        solved = replace(solved, discretisation=reference.discretisation)
        hottest = max((found.highest - ZERO for found in solved.temperatures), default=None)
        return _record(estimated_checks(solved), hottest)


def _through_heat(path: str) -> bool:
    """Whether the time run need not be marched for this input: heat moves it, or nothing does."""
    return through_heat(path) or "time run" not in parts_of(path)


def _record(checks: Collection[Check], hottest: float | None) -> Record:
    rows = [{key: getattr(check, key) for key in CHECK_KEYS} for check in checks]
    record: Record = to_plain(
        {"verdict": overall(list(checks)), "max_temperature_degC": hottest, "checks": rows}
    )
    return record
