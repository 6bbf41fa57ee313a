"""Verdicts over ranges: margins of the run shifted by what every end changes, and what a check is worth then.

An end is solved at quick fidelity, the run perhaps at another. What counts of an end is its difference from the
stated rig at the same fidelity; added to the margin of the run, it leaves out what the size of the mesh does.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from rigdesign.results.check import Check, Verdict
from rigdesign.results.ranges import CheckRange, RangeMargin
from rigdesign.uncertainty.plan import RangeEnd
from rigdesign.uncertainty.point import CheckAtEnd, EndResult

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
    ends: tuple[Shifted, ...]
    unsolved: tuple[tuple[RangeEnd, str], ...]


def ranged_checks(
    checks: Sequence[Check], stated: EndResult, ends: Sequence[tuple[RangeEnd, EndResult]]
) -> list[Ranged]:
    """Every check that applies with its shifts; checks of the run, ``stated`` and ``ends`` at quick fidelity."""
    found = []
    for check in checks:
        reference = stated.checks.get(check.id)
        if check.margin is None or reference is None or reference.margin is None:
            continue
        solved, unsolved = [], []
        for end, outcome in ends:
            at_end = outcome.checks.get(check.id)
            if outcome.error is not None:
                unsolved += [(end, outcome.error)] if end.path in check.assumptions else []
            elif at_end is not None and at_end.margin is not None:
                solved.append(_shifted(check, reference, at_end, end))
        found.append(Ranged(check=check, ends=tuple(solved), unsolved=tuple(unsolved)))
    return found


def _shifted(check: Check, reference: CheckAtEnd, at_end: CheckAtEnd, end: RangeEnd) -> Shifted:
    assert check.margin is not None and check.distance is not None
    margin = check.margin + _difference(at_end.margin, reference.margin)
    distance = check.distance + _difference(at_end.distance, reference.distance)
    verdict = check.verdict if at_end.verdict == reference.verdict else at_end.verdict
    if margin < 0.0:
        verdict = "fail"
    elif verdict == "fail":
        verdict = "pass"
    return Shifted(end=end, margin=margin, distance=distance, verdict=verdict)


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
    assert check.margin is not None
    if check.margin < 0.0:
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
    check = ranged.check
    assert check.margin is not None
    worst = min(ranged.ends, key=lambda end: end.margin, default=None)
    best = max(ranged.ends, key=lambda end: end.margin, default=None)
    worst = worst if worst is not None and worst.margin < check.margin else None
    best = best if best is not None and best.margin > check.margin else None
    lost: dict[str, float] = {}
    for end in ranged.ends:
        lost[end.end.path] = min(lost.get(end.end.path, 0.0), end.margin - check.margin)
    return CheckRange(
        check=check.id,
        unit=check.unit,
        verdict_stated=check.verdict,
        verdict=final.verdict,
        margin=check.margin,
        worst_margin=check.margin if worst is None else worst.margin,
        worst_path=None if worst is None else worst.end.path,
        worst_value=None if worst is None else worst.end.value,
        best_margin=check.margin if best is None else best.margin,
        best_path=None if best is None else best.end.path,
        distance=check.distance,
        worst_distance=min((end.distance for end in ranged.ends), default=check.distance),
        best_distance=max((end.distance for end in ranged.ends), default=check.distance),
        all_worst_margin=check.margin + sum(lost.values()),
        decided_by=tuple(deciding(ranged)),
    )


def deciding(ranged: Ranged) -> list[str]:
    """Inputs of which one end changes whether the check holds."""
    assert ranged.check.margin is not None
    holds = ranged.check.margin >= 0.0
    return list(dict.fromkeys(end.end.path for end in ranged.ends if (end.margin >= 0.0) != holds))


def moving_margins(ranged: Ranged) -> list[RangeMargin]:
    """The inputs that move the check, the strongest first."""
    check = ranged.check
    assert check.distance is not None
    by_path: dict[str, dict[str, Shifted]] = {}
    for end in ranged.ends:
        by_path.setdefault(end.end.path, {})[end.end.end] = end
    moves = {
        path: max(abs(end.distance - check.distance) for end in ends.values())
        for path, ends in by_path.items()
    }
    listed = [path for path in by_path if moves[path] > LEAST_MOVE]
    return [
        _margin(check, path, by_path[path]) for path in sorted(listed, key=lambda path: (-moves[path], path))
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
