"""`check --ranges`: every assumed input with a range at its two ends, one at a time, and what the verdicts are worth.

Every end starts from the converged stated rig and solves again what its input touches (`case.fields.Effect`): nothing
but the checks for a limit, the coupling loop for heat and oil, the whole for what the loop is made of. Ends run in
worker processes like the points of a study.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from rigdesign.base.errors import CaseError, RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.worker_pool import DIED, compute_all, worker_count
from rigdesign.case.fields import AssumptionRecord, ModelPart, RangeEnds
from rigdesign.case.loader import changed_together
from rigdesign.case.model import Case
from rigdesign.checks import held_checks
from rigdesign.results.check import Check, Checks, Verdict, overall
from rigdesign.results.ranges import (
    CheckRange,
    LeftOut,
    RangedInput,
    RangeMargin,
    RangesResult,
    TemperatureRange,
)
from rigdesign.results.result import RunResult
from rigdesign.results.units import ZERO
from rigdesign.studies.modified_rig import Reanalysis, parts_of
from rigdesign.studies.reference_rig import (
    ReanalysisResult,
    Reference,
    reanalysed,
    result_of,
    solve_reference,
)

# Which assumed inputs are moved to the ends of their ranges.

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
    parts: tuple[ModelPart, ...]
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
        ends += _ends(case, record, record.range, tied_inputs(case, record))
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


def _ends(
    case: Case, record: AssumptionRecord, limits: RangeEnds, tied: tuple[str, ...]
) -> Iterator[RangeEnd]:
    before = case.model_dump()
    ends: tuple[End, End] = ("low", "high")
    for end, value in zip(ends, limits, strict=True):
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
    parts: tuple[ModelPart, ...] = ()
    """What was solved again."""
    error: str | None = None


def solve_stated(case: Case) -> tuple[Reference, EndResult]:
    """Solve the stated rig, and its checks."""
    reference, solved = solve_reference(case, FIDELITY)
    return reference, _end_result(result_of(solved, held_checks))


def solve_end(end: RangeEnd, *, reference: Reference) -> EndResult:
    """Solve one end; an error is an outcome that says what happened.

    The stated rig is made once in every process.
    """
    assert end.case is not None
    try:
        return _end_result(reanalysed(reference, Reanalysis(end.case, end.parts), held_checks))
    except RigdesignError as error:
        return EndResult(checks={}, max_temperature=None, error=str(error))
    except Exception as error:
        return EndResult(checks={}, max_temperature=None, error=f"{type(error).__name__}: {error}")


def _end_result(found: ReanalysisResult) -> EndResult:
    return EndResult(
        checks={check.id: _at_end(check) for check in found.checks},
        max_temperature=found.max_temperature_degC,
        parts=found.parts,
    )


def _at_end(check: Check) -> CheckAtEnd:
    return CheckAtEnd(value=check.value, margin=check.margin, distance=check.distance, verdict=check.verdict)


# Verdicts over ranges: margins of the run shifted by what every end changes, and what a check is worth then.
#
# An end is solved at quick fidelity, the run perhaps at another. What counts of an end is its difference from the
# stated rig at the same fidelity; added to the margin of the run, it leaves out what the size of the mesh does.

SOLVED_BY = 1e-9
"""Share of the value below which a difference of two solutions is round-off."""
LEAST_MOVE = 1e-3
"""Shift of the distance from which a pair of check and input is listed: of the order of the loop's tolerances."""


@dataclass(frozen=True, kw_only=True)
class Shifted:
    """A check of the run with one input at one end."""

    end: RangeEnd
    margin: float
    distance: float
    verdict: Verdict


@dataclass(frozen=True, kw_only=True)
class Ranged:
    """One check of the run with every end that was solved, and the ends it depends on that were not."""

    check: Check
    margin: float
    distance: float
    """Of the check as stated."""
    ends: tuple[Shifted, ...]
    unsolved: tuple[tuple[RangeEnd, str], ...]


def ranged_checks(
    checks: Sequence[Check], stated: EndResult, ends: Sequence[tuple[RangeEnd, EndResult]]
) -> list[Ranged]:
    """Every check that applies with its shifts; checks of the run, ``stated`` and ``ends`` at quick fidelity."""
    found = []
    for check in checks:
        reference = stated.checks.get(check.id)
        margin, distance = check.margin, check.distance
        if margin is None or distance is None or reference is None or reference.margin is None:
            continue
        solved, unsolved = [], []
        for end, outcome in ends:
            at_end = outcome.checks.get(check.id)
            if outcome.error is not None:
                unsolved += [(end, outcome.error)] if end.path in check.assumptions else []
            elif at_end is not None and at_end.margin is not None:
                moved = margin + _difference(at_end.margin, reference.margin)
                solved.append(
                    Shifted(
                        end=end,
                        margin=moved,
                        distance=distance + _difference(at_end.distance, reference.distance),
                        verdict=_verdict(check, reference, at_end, moved),
                    )
                )
        ranged = Ranged(
            check=check, margin=margin, distance=distance, ends=tuple(solved), unsolved=tuple(unsolved)
        )
        found.append(ranged)
    return found


def _verdict(check: Check, reference: CheckAtEnd, at_end: CheckAtEnd, margin: float) -> Verdict:
    """Of a check whose margin is shifted to ``margin``."""
    verdict = check.verdict if at_end.verdict == reference.verdict else at_end.verdict
    if margin < 0.0:
        return "fail"
    return "pass" if verdict == "fail" else verdict


def _difference(at_end: float | None, reference: float | None) -> float:
    if at_end is None or reference is None:
        return 0.0
    change = at_end - reference
    return change if abs(change) > SOLVED_BY * max(abs(at_end), abs(reference)) else 0.0


def judged(ranged: Ranged) -> Check:
    """The check over the ranges: it passes only if it holds at every end, else it is open and names what decides it.

    A check that fails as stated stays failed; an end at which it would hold is named.
    """
    check = ranged.check
    if ranged.margin < 0.0:
        held = [end for end in ranged.ends if end.margin >= 0.0]
        return replace(
            check, reason=_joined(check.reason, [_words(end, check, "would hold") for end in held])
        )
    broken = [end for end in ranged.ends if end.margin < 0.0]
    doubts = [_words(end, check, "fails") for end in broken]
    doubts = [f"decided by assumption {text}" for text in doubts]
    doubts += [
        f"no result at {end.path} = {end.value}, on which it depends: {error.partition(chr(10))[0]}"
        for end, error in ranged.unsolved
    ]
    return replace(check, verdict="open", reason=_joined(check.reason, doubts)) if doubts else check


def _words(shifted: Shifted, check: Check, does: str) -> str:
    end, unit = shifted.end, "K" if check.unit == "degC" else check.unit
    return f"{end.path}: {does} at {end.value} (margin {shifted.margin:.4g} {unit})".replace(" -)", ")")


def _joined(*parts: str | list[str]) -> str:
    texts = [text for part in parts for text in ([part] if isinstance(part, str) else part)]
    return "; ".join(text for text in texts if text)


def check_range(ranged: Ranged, final: Check) -> CheckRange:
    """One line of the table of checks over all ranges."""
    check, margin = ranged.check, ranged.margin
    worst = min(ranged.ends, key=lambda end: end.margin, default=None)
    best = max(ranged.ends, key=lambda end: end.margin, default=None)
    worst = worst if worst is not None and worst.margin < margin else None
    best = best if best is not None and best.margin > margin else None
    lost: dict[str, float] = {}
    for end in ranged.ends:
        lost[end.end.path] = min(lost.get(end.end.path, 0.0), end.margin - margin)
    return CheckRange(
        check=check.id,
        unit=check.unit,
        verdict_stated=check.verdict,
        verdict=final.verdict,
        margin=margin,
        worst_margin=margin if worst is None else worst.margin,
        worst_path=None if worst is None else worst.end.path,
        worst_value=None if worst is None else worst.end.value,
        best_margin=margin if best is None else best.margin,
        best_path=None if best is None else best.end.path,
        distance=ranged.distance,
        worst_distance=min((end.distance for end in ranged.ends), default=ranged.distance),
        best_distance=max((end.distance for end in ranged.ends), default=ranged.distance),
        all_worst_margin=margin + sum(lost.values()),
        decided_by=tuple(deciding(ranged)),
    )


def deciding(ranged: Ranged) -> list[str]:
    """Inputs of which one end changes whether the check holds."""
    holds = ranged.margin >= 0.0
    return list(dict.fromkeys(end.end.path for end in ranged.ends if (end.margin >= 0.0) != holds))


def moving_margins(ranged: Ranged) -> list[RangeMargin]:
    """The inputs that move the check, the strongest first."""
    by_path: dict[str, dict[str, Shifted]] = {}
    for end in ranged.ends:
        by_path.setdefault(end.end.path, {})[end.end.end] = end
    moves = {
        path: max(abs(end.distance - ranged.distance) for end in ends.values())
        for path, ends in by_path.items()
    }
    listed = [path for path in by_path if moves[path] > LEAST_MOVE]
    return [
        _margin(ranged.check, path, by_path[path])
        for path in sorted(listed, key=lambda path: (-moves[path], path))
    ]


def _margin(check: Check, path: str, ends: Mapping[str, Shifted]) -> RangeMargin:
    low, high = ends.get("low"), ends.get("high")
    return RangeMargin(
        check=check.id,
        path=path,
        unit=check.unit,
        margin_low=None if low is None else low.margin,
        margin_high=None if high is None else high.margin,
        distance_low=None if low is None else low.distance,
        distance_high=None if high is None else high.distance,
        verdict_low=None if low is None else low.verdict,
        verdict_high=None if high is None else high.verdict,
    )


Count = Callable[[int, int, str], None]
"""Called with ends done, ends in all, and which was the last."""


def with_ranges(
    case: Case,
    result: RunResult,
    *,
    workers: int | None = None,
    progress: Callable[[str], None] | None = None,
    count: Count | None = None,
) -> RunResult:
    """The result of a run with its verdicts over the ranges of the assumed inputs.

    A check passes only if it holds at both ends of every range, else it is open and says which assumption decides
    it. An end without a result (an invalid case, an iteration that does not converge) makes the checks that depend on
    its input warn.

    Parameters
    ----------
    case : the case of ``result``
    workers : processes, one thread each; None for one per core
    progress : called with what is being computed
    count : called after every end

    Raises
    ------
    UsageError
        ``workers`` below 1.
    NotConvergedError
        The stated rig does not converge at quick fidelity.
    """
    processes, began = worker_count(workers), time.perf_counter()
    ends, left = plan(case, result.checks)
    wanted = [end for end in ends if end.case is not None and not end.same]
    say = progress or (lambda line: None)
    say(f"stated rig at {FIDELITY} fidelity")
    reference, stated = solve_stated(case)
    solved = _solve(wanted, reference, processes, count or (lambda done, whole, path: None), say)
    outcomes = [_outcome(end, stated, solved) for end in ends]
    found = joined(result, stated, list(zip(ends, outcomes, strict=True)), left)
    return replace(found, timings_s={**result.timings_s, "ranges": round(time.perf_counter() - began, 3)})


def _solve(
    ends: Sequence[RangeEnd],
    reference: Reference,
    workers: int,
    count: Count,
    say: Callable[[str], None],
) -> dict[tuple[str, str], EndResult]:
    """Results by path and end; the longest ones first, so that no worker waits for another at the end."""
    order = sorted(ends, key=lambda end: -len(end.parts))
    found: dict[tuple[str, str], EndResult] = {}
    work = partial(solve_end, reference=reference)
    for index, outcome in compute_all(work, order, workers, say):
        end = order[index]
        found[end.path, end.end] = outcome or EndResult(checks={}, max_temperature=None, error=DIED)
        count(len(found), len(order), f"{end.path} = {end.value}")
    return found


def _outcome(end: RangeEnd, stated: EndResult, solved: dict[tuple[str, str], EndResult]) -> EndResult:
    if end.same:
        return stated
    if end.case is None:
        return EndResult(checks={}, max_temperature=None, error=end.error)
    return solved[end.path, end.end]


def joined(
    result: RunResult, stated: EndResult, ends: list[tuple[RangeEnd, EndResult]], left: list[LeftOut]
) -> RunResult:
    """The result with its verdicts over the ends; ``stated`` and the outcomes at the fidelity of the ends."""
    ranged = {entry.check.id: entry for entry in ranged_checks(result.checks, stated, ends)}
    checks = [judged(ranged[check.id]) if check.id in ranged else check for check in result.checks]
    ranges = RangesResult(
        fidelity=FIDELITY,
        method=_method(ends),
        inputs=_inputs(ends, list(ranged.values()), _offset(result, stated)),
        checks=[check_range(ranged[check.id], check) for check in checks if check.id in ranged],
        margins=[row for entry in ranged.values() for row in moving_margins(entry)],
        max_temperature=_temperatures(result, stated, ends),
        left_out=left,
    )
    return replace(result, checks=Checks(checks), verdict=overall(checks), ranges=ranges)


def _offset(result: RunResult, stated: EndResult) -> float:
    """Highest temperature of the run above that of the stated rig at the fidelity of the ends [K]."""
    hottest = max((row.max_temperature - ZERO for row in result.thermal), default=0.0)
    return 0.0 if stated.max_temperature is None else hottest - stated.max_temperature


def _plus(value: float | None, offset: float) -> float | None:
    return None if value is None else value + offset


def _inputs(ends: list[tuple[RangeEnd, EndResult]], ranged: list[Ranged], offset: float) -> list[RangedInput]:
    by_path: dict[str, dict[str, tuple[RangeEnd, EndResult]]] = {}
    for end, outcome in ends:
        by_path.setdefault(end.path, {})[end.end] = (end, outcome)
    changes = {path: [entry.check.id for entry in ranged if path in deciding(entry)] for path in by_path}
    rows = []
    for path, both in by_path.items():
        (low, at_low), (high, at_high) = both["low"], both["high"]
        parts = dict.fromkeys((*at_low.parts, *at_high.parts))
        rows.append(
            RangedInput(
                path=path,
                together_with=low.together_with,
                stated=low.stated,
                low=low.value,
                high=high.value,
                solved_again=tuple(parts),
                max_temperature_low_degC=_plus(at_low.max_temperature, offset),
                max_temperature_high_degC=_plus(at_high.max_temperature, offset),
                low_error=at_low.error,
                high_error=at_high.error,
                changes=tuple(changes[path]),
            )
        )
    return rows


def _temperatures(
    result: RunResult, stated: EndResult, ends: list[tuple[RangeEnd, EndResult]]
) -> TemperatureRange | None:
    """Range of the highest temperature: that of the run, shifted by what every end changes."""
    hottest = max((row.max_temperature - ZERO for row in result.thermal), default=None)
    if hottest is None or stated.max_temperature is None:
        return None
    shifts = {
        (end.path, end.end): outcome.max_temperature - stated.max_temperature
        for end, outcome in ends
        if outcome.max_temperature is not None
    }
    warmer: dict[str, float] = {}
    for (path, _), shift in shifts.items():
        warmer[path] = max(warmer.get(path, 0.0), shift)
    low = min(shifts.items(), key=lambda item: item[1], default=(("", ""), 0.0))
    high = max(shifts.items(), key=lambda item: item[1], default=(("", ""), 0.0))
    return TemperatureRange(
        stated_degC=hottest,
        low_degC=hottest + min(low[1], 0.0),
        low_path=low[0][0] if low[1] < 0.0 else None,
        high_degC=hottest + max(high[1], 0.0),
        high_path=high[0][0] if high[1] > 0.0 else None,
        all_high_degC=hottest + sum(warmer.values()),
    )


def _method(ends: list[tuple[RangeEnd, EndResult]]) -> str:
    """What was done for how many ends, in words."""
    solved = [(end, outcome) for end, outcome in ends if end.case is not None and not end.same]
    kinds = Counter(
        "+".join(outcome.parts) or "checks only" for _, outcome in solved if outcome.error is None
    )
    failed = sum(outcome.error is not None for _, outcome in ends)
    same = sum(end.same for end, _ in ends)
    words = ", ".join(f"{number} {kind}" for kind, number in sorted(kinds.items()))
    return (
        f"{len(ends)} ends of {len(ends) // 2} ranges, one input at a time, solved at {FIDELITY} fidelity from the "
        f"converged stated rig; solved again: {words or 'none'}; {same} ends are the stated value, {failed} have no "
        "result. Between the ends nothing is solved: a margin that is least inside a range is not seen"
    )
