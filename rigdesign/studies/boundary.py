"""The value of one input at which checks change from held to broken, by bisection.

A few points over the range come first; every pair of neighbours of which one holds and one does not is halved until
it is as narrow as the tolerance. A check whose margin turns between three points that agree is looked at where a
parabola through them turns, so that a limit broken only between two points is found unless it is narrower than the
first points see.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, log2

from rigdesign.studies.crossings import CheckState, changes, check_states
from rigdesign.studies.grid import Variation
from rigdesign.studies.ranges import InputRange
from rigdesign.studies.result import StudyPoint

FIRST_INTERVALS = 8
"""Equal parts of the range whose ends are computed first."""
DEFAULT_PARTS = 200
"""The range over the tolerance, where none is given."""


@dataclass(frozen=True)
class BoundarySearch:
    """Values to compute next from those computed, so that the search does not depend on the order of points.

    entry : the varied range
    tolerance : width of a bracket that is narrow enough, in the unit of the range
    """

    entry: InputRange
    tolerance: float

    def first(self) -> list[str]:
        """Values to begin with."""
        shares = [number / FIRST_INTERVALS for number in range(FIRST_INTERVALS + 1)]
        texts = [self.entry.text(self.entry.low + share * self.entry.width) for share in shares]
        return list(dict.fromkeys(texts))

    def next(self, points: Sequence[StudyPoint], checks: Sequence[str]) -> list[str]:
        """Values that narrow a bracket or may find a new one; empty when all are narrow enough."""
        places = self._places(points)
        known = {text for point in points for text in point.values.values()}
        wanted: dict[str, None] = {}
        for identity in checks:
            states = check_states(identity, places)
            for value in (*self._midpoints(states), *self._turns(states)):
                wanted.setdefault(self.entry.text(value))
        return [text for text in wanted if text not in known]

    def left(self, points: Sequence[StudyPoint], checks: Sequence[str]) -> int:
        """Points the open brackets still need, about: those of several checks in one place count once."""
        places = self._places(points)
        widths = {
            (left.value, right.value): (right.value - left.value) / self.tolerance
            for identity in checks
            for left, right in changes(check_states(identity, places))
        }
        return sum(ceil(log2(width)) for width in widths.values() if width > 1.0)

    def variation(self, points: Sequence[StudyPoint]) -> Variation:
        """The values computed, rising."""
        texts = {point.values[self.entry.path] for point in points}
        return Variation(self.entry.path, tuple(sorted(texts, key=self.entry.number)))

    def _places(self, points: Sequence[StudyPoint]) -> list[tuple[float, StudyPoint]]:
        return [(self.entry.number(point.values[self.entry.path]), point) for point in points]

    def _midpoints(self, states: Sequence[CheckState]) -> Iterator[float]:
        for left, right in changes(states):
            if right.value - left.value > self.tolerance * (1.0 + 1e-9):
                yield 0.5 * (left.value + right.value)

    def _turns(self, states: Sequence[CheckState]) -> Iterator[float]:
        """Where a margin that turns between points on one side of the limit may reach over it."""
        for left, middle, right in zip(states, states[1:], states[2:], strict=False):
            if left.holds == middle.holds == right.holds:
                turn = _turn(left, middle, right)
                if turn is not None and self._apart(turn, left, middle, right):
                    yield turn

    def _apart(self, value: float, *states: CheckState) -> bool:
        return all(abs(value - state.value) > self.tolerance for state in states)


def _turn(left: CheckState, middle: CheckState, right: CheckState) -> float | None:
    """Value at which the parabola through three points turns beyond the limit; None where it does not."""
    if left.margin is None or middle.margin is None or right.margin is None:
        return None
    first = (middle.margin - left.margin) / (middle.value - left.value)
    second = (right.margin - middle.margin) / (right.value - middle.value)
    curvature = (second - first) / (right.value - left.value)
    if (curvature > 0.0) != left.holds or curvature == 0.0:
        return None  # bends away from the limit
    turn = 0.5 * (left.value + middle.value) - 0.5 * first / curvature
    if not left.value < turn < right.value:
        return None
    reached = left.margin + (turn - left.value) * (first + curvature * (turn - middle.value))
    return turn if (reached < 0.0) == left.holds else None
