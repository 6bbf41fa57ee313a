"""`check --ranges`: every assumed input with a range at its two ends, one at a time, and what the verdicts are worth.

Every end starts from the converged stated rig and solves again what its input touches (`affected_parts`): nothing but
the checks for a limit, the coupling loop for heat and oil, the whole for what the loop is made of. Ends run in worker
processes like the points of a study.
"""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from rigdesign.base.worker_pool import DIED, compute_all, worker_count
from rigdesign.case.model import Case
from rigdesign.reanalysis.reference import Reference
from rigdesign.results.check import Checks, overall
from rigdesign.results.ranges import LeftOut, RangedInput, RangesResult, TemperatureRange
from rigdesign.results.result import RunResult
from rigdesign.uncertainty.plan import RangeEnd, plan
from rigdesign.uncertainty.point import FIDELITY, EndResult, solve_end, solve_stated
from rigdesign.uncertainty.verdicts import (
    Ranged,
    check_range,
    deciding,
    judged,
    moving_margins,
    ranged_checks,
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
    hottest = max((row.max_temperature_degC for row in result.thermal), default=0.0)
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
    hottest = max((row.max_temperature_degC for row in result.thermal), default=None)
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
