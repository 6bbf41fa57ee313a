"""Where a check changes from held to broken between computed points."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from rigdesign.studies.grid import Variation
from rigdesign.studies.result import Crossing, Record, StudyPoint


@dataclass(frozen=True)
class CheckState:
    """A check at one value of an input: whether it holds, and its margin where it has one, in its unit."""

    value: float
    holds: bool
    margin: float | None


def holds(check: Record | None) -> bool | None:
    """Whether a check holds; None where there is no result or the check does not apply.

    A margin of at least 0 holds, also where contributors that are left out make the verdict open.
    """
    if check is None or check["verdict"] == "not applicable":
        return None
    return None if check["margin"] is None else bool(check["margin"] >= 0.0)


def check_states(identity: str, places: Sequence[tuple[float, StudyPoint]]) -> list[CheckState]:
    """A check over the values of an input, rising; points that say nothing of it are left out."""
    states = []
    for value, point in sorted(places, key=lambda place: place[0]):
        check = point.check(identity)
        if check is not None and (held := holds(check)) is not None:
            states.append(CheckState(value, held, check["margin"]))
    return states


def changes(states: Sequence[CheckState]) -> Iterator[tuple[CheckState, CheckState]]:
    """Neighbours of which one holds and one does not."""
    return ((left, right) for left, right in pairwise(states) if left.holds != right.holds)


def interpolated(left: CheckState, right: CheckState) -> float:
    """The value at which the margin is zero, by a straight line; halfway where a margin is missing.

    The margin follows the value of a check; its distance does not where the limit is a lower one.
    """
    if left.margin is None or right.margin is None:
        return 0.5 * (left.value + right.value)
    share = left.margin / (left.margin - right.margin)
    return left.value + min(max(share, 0.0), 1.0) * (right.value - left.value)


def crossings_over(
    variation: Variation, points: Sequence[StudyPoint], checks: Sequence[str]
) -> Iterator[Crossing]:
    """Crossings of every check along one varied input, for every combination of the others.

    Nothing for an input whose values are not numbers of one unit.
    """
    numbers = variation.numbers()
    if numbers is None:
        return
    value_of = dict(zip(variation.values, numbers[0], strict=True))
    rows: dict[tuple[tuple[str, str], ...], list[tuple[float, StudyPoint]]] = {}
    for point in points:
        others = tuple((path, text) for path, text in point.values.items() if path != variation.path)
        rows.setdefault(others, []).append((value_of[point.values[variation.path]], point))
    for identity in checks:
        for others, places in rows.items():
            for left, right in changes(check_states(identity, places)):
                yield Crossing(
                    check=identity,
                    path=variation.path,
                    value=interpolated(left, right),
                    low=left.value,
                    high=right.value,
                    unit=numbers[1],
                    holds="below" if left.holds else "above",
                    others=dict(others),
                )
