"""One input at a time at both ends of its range: what each of them does to the checks."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rigdesign.studies.crossings import holds
from rigdesign.studies.ranges import InputRange
from rigdesign.studies.result import StudyPoint, Swing

if TYPE_CHECKING:
    from rigdesign.case import Case

LEAST_SWING = 1e-6
"""Change of a distance below which an input does not move a check."""
NOT_STATED = "as stated"
"""Shown for an input that the case leaves to its default, or that stands for several."""


def stated_values(case: "Case", ranges: Sequence[InputRange]) -> dict[str, str]:
    """What the case writes for every input."""
    written = {row.path: row.value for row in case.inputs}
    return {entry.path: written.get(entry.path, NOT_STATED) for entry in ranges}


def ends(ranges: Sequence[InputRange]) -> Iterator[tuple[InputRange, str]]:
    """Every range with its low end, then with its high one."""
    for entry in ranges:
        yield entry, entry.text(entry.low)
        yield entry, entry.text(entry.high)


def swings(
    ranges: Sequence[InputRange], points: Sequence[StudyPoint], checks: Sequence[str]
) -> Iterator[Swing]:
    """What each input does to each check; pairs that do not move are left out.

    points : the stated case, then the `ends`
    """
    stated, at_ends = points[0], points[1:]
    for number, entry in enumerate(ranges):
        low, high = at_ends[2 * number : 2 * number + 2]
        for identity in checks:
            if _moves(identity, stated, low, high):
                yield Swing(
                    check=identity,
                    path=entry.path,
                    low=low.values[entry.path],
                    high=high.values[entry.path],
                    distance_stated=_distance(stated, identity),
                    distance_low=_distance(low, identity),
                    distance_high=_distance(high, identity),
                )


def _moves(identity: str, stated: StudyPoint, low: StudyPoint, high: StudyPoint) -> bool:
    reference = _distance(stated, identity)
    for point in (low, high):
        found = _distance(point, identity)
        if holds(point.check(identity)) != holds(stated.check(identity)) or (found is None) != (
            reference is None
        ):
            return True
        if found is not None and reference is not None and abs(found - reference) > LEAST_SWING:
            return True
    return False


def _distance(point: StudyPoint, identity: str) -> float | None:
    check = point.check(identity)
    return None if check is None else check["distance"]
