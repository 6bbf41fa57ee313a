"""Where the checks hold over one varied input: ranges, what limits them, and the sentence that says so."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rigdesign.report.margins.axis import StudyAxis
from rigdesign.report.margins.table import MarginTable
from rigdesign.report.numbers import number_text

Cause = Literal["end", "crossing", "no result"]


@dataclass(frozen=True, kw_only=True)
class RangeEnd:
    """An end of a range in which all checks hold.

    value : position on the axis
    cause : the study ends there, a check begins to fail, or the next point has no result
    check : column of the check that begins to fail first
    held, beyond : the computed points between which it begins to fail
    """

    value: float
    cause: Cause
    check: int = -1
    held: float = 0.0
    beyond: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PassRange:
    """A range of an input in which all checks hold."""

    low: RangeEnd
    high: RangeEnd


@dataclass(frozen=True, kw_only=True)
class Passing:
    """Where the checks of a table hold over one input.

    outcome : everywhere, in some ranges, nowhere, or no point has a result
    ranges : ascending; empty for names on the axis
    sentence : the answer without its subject: ``passes up to 118 °C; the limiting check is …``
    """

    outcome: Literal["everywhere", "partly", "nowhere", "no result"]
    ranges: tuple[PassRange, ...]
    sentence: str


def passing(axis: StudyAxis, positions: Sequence[float], table: MarginTable) -> Passing:
    """Where the checks of ``table`` hold along ``axis``; ``positions`` of its points in any order."""
    order = np.argsort(np.asarray(positions), kind="stable")
    x, sorted_table = np.asarray(positions, dtype=float)[order], table.at(order)
    holds = sorted_table.computed & ~sorted_table.fails.any(axis=1)
    if not sorted_table.computed.any():
        return Passing(outcome="no result", ranges=(), sentence="no point has a result")
    if not holds.any():
        return Passing(outcome="nowhere", ranges=(), sentence=_nowhere(axis, x, sorted_table))
    ranges = _ranges(x, sorted_table, holds) if axis.numeric else ()
    if holds.all():
        return Passing(outcome="everywhere", ranges=ranges, sentence=_everywhere(axis, x, sorted_table))
    if not axis.numeric:
        return Passing(outcome="partly", ranges=(), sentence=_names(axis, x, sorted_table, holds))
    return Passing(outcome="partly", ranges=ranges, sentence=_partly(axis, ranges, sorted_table))


def _ranges(x: np.ndarray, table: MarginTable, holds: np.ndarray) -> tuple[PassRange, ...]:
    found = []
    first = 0
    for place in range(len(x)):
        if not holds[place]:
            continue
        if place == 0 or not holds[place - 1]:
            first = place
        if place == len(x) - 1 or not holds[place + 1]:
            low = _end(x, table, first, first - 1)
            found.append(PassRange(low=low, high=_end(x, table, place, place + 1)))
    return tuple(found)


def _end(x: np.ndarray, table: MarginTable, held: int, beyond: int) -> RangeEnd:
    """The end of a range towards the point ``beyond`` the last one that holds."""
    if not 0 <= beyond < len(x):
        return RangeEnd(value=float(x[held]), cause="end")
    if not table.computed[beyond]:
        return RangeEnd(value=float(x[held]), cause="no result")
    places = {
        int(column): _crossing(x, table, held, beyond, int(column))
        for column in np.flatnonzero(table.fails[beyond])
    }
    check = min(places, key=lambda column: abs(places[column] - float(x[held])))
    return RangeEnd(
        value=places[check], cause="crossing", check=check, held=float(x[held]), beyond=float(x[beyond])
    )


def _crossing(x: np.ndarray, table: MarginTable, held: int, beyond: int, column: int) -> float:
    """Where the margin of a check is zero between two points, on a straight line in the unit of the check.

    The last point that holds where the check has no number there.
    """
    start, end = float(x[held]), float(x[beyond])
    inside, outside = table.own[held, column], table.own[beyond, column]
    if np.isnan(inside) or np.isnan(outside) or inside <= 0.0 or outside >= 0.0:
        return start
    return start + (end - start) * float(inside / (inside - outside))


def _everywhere(axis: StudyAxis, x: np.ndarray, table: MarginTable) -> str:
    if len(x) == 1:
        return _at_one(axis, x, table)
    span = f", from {axis.text(x[0])} to {axis.text(x[-1])}" if axis.numeric else ""
    nearest = table.nearest_first()
    if not nearest:
        return f"{table.verb} at every point{span}"
    check = nearest[0]
    if not table.moving[check]:
        return f"{table.verb} at every point{span}; no margin changes"
    at = axis.text(x[int(np.nanargmin(table.margin[:, check]))])
    left = f"{number_text(table.least[check], 2)} % of its limit left at {at}"
    if len(table.checks) == 1:
        return f"{table.verb} at every point{span}; {left}"
    others = np.delete(table.least, check)
    of_those = "of the checks that move, " if np.nanmin(others, initial=np.inf) < table.least[check] else ""
    return (
        f"{table.verb} at every point{span}; {of_those}nearest to its limit is {_named(table, check)}, {left}"
    )


def _at_one(axis: StudyAxis, x: np.ndarray, table: MarginTable) -> str:
    """The answer of a single point that holds."""
    where = f"{table.verb} at {axis.text(x[0])}"
    nearest = [column for column in table.nearest_first() if not table.by_definition[column]]
    if not nearest:
        return where
    left = f"{number_text(table.least[nearest[0]], 2)} % of its limit left"
    if len(table.checks) == 1:
        return f"{where}; {left}"
    return f"{where}; nearest to its limit is {_named(table, nearest[0])}, {left}"


def _nowhere(axis: StudyAxis, x: np.ndarray, table: MarginTable) -> str:
    counts = table.fails[table.computed].sum(axis=0)
    worst = sorted(np.flatnonzero(counts).tolist(), key=lambda column: (-counts[column], table.least[column]))
    total = int(table.computed.sum())
    where = "at every point" if len(x) > 1 else f"at {axis.text(x[0])}"
    if len(table.checks) == 1:
        return f"fails {where}"
    named = [
        _named(table, column) + (f" ({counts[column]} of {total} points)" if total > 1 else "")
        for column in worst[:2]
    ]
    more = f" and {len(worst) - 2} more" if len(worst) > 2 else ""
    return f"fails {where}, because of {', '.join(named)}{more}"


def _names(axis: StudyAxis, x: np.ndarray, table: MarginTable, holds: np.ndarray) -> str:
    """The answer for an input whose values are names."""
    limiting, _ = table.limiting()
    good = ", ".join(axis.text(position) for position in x[holds])
    bad = [
        f"{axis.text(x[place])} ({_named(table, int(limiting[place]))})"
        for place in np.flatnonzero(table.computed & ~holds)
    ]
    none = [axis.text(position) for position in x[~table.computed]]
    parts = [f"{table.verb} with {good}"]
    parts += [f"fails with {', '.join(bad)}"] if bad else []
    parts += [f"no result with {', '.join(none)}"] if none else []
    return "; ".join(parts)


def _partly(axis: StudyAxis, ranges: Sequence[PassRange], table: MarginTable) -> str:
    said = " and ".join(_range_text(axis, item) for item in ranges)
    causes = []
    for end, side in (
        (end, side) for item in ranges for end, side in ((item.low, "low"), (item.high, "high"))
    ):
        if end.cause == "crossing" and len(table.checks) > 1:
            several = len(ranges) > 1 or ranges[0].low.cause == ranges[0].high.cause
            where = f" {'below' if side == 'low' else 'above'} {_end_text(axis, end)}" if several else ""
            causes.append(f"the limiting check{where} is {_named(table, end.check)}")
        if end.cause == "no result":
            causes.append(
                f"the point {'before' if side == 'low' else 'after'} {axis.text(end.value)} has no result"
            )
    return "; ".join([f"{table.verb} {said}", *dict.fromkeys(causes)])


def _range_text(axis: StudyAxis, item: PassRange) -> str:
    """``up to 118 °C``, ``from 80 °C``, ``from 80 °C to 118 °C``; ``at 100 °C`` for a single point."""
    low, high = _end_text(axis, item.low), _end_text(axis, item.high)
    if item.low.cause == "end" and item.high.cause != "end":
        return f"up to {high}"
    if item.high.cause == "end" and item.low.cause != "end":
        return f"from {low}"
    return f"at {low}" if low == high else f"from {low} to {high}"


def _end_text(axis: StudyAxis, end: RangeEnd) -> str:
    if end.cause != "crossing":
        return axis.text(end.value)
    return axis.read_off(end.value, end.held, end.beyond)


def _named(table: MarginTable, column: int) -> str:
    return quoted(table.checks[column].title) if column >= 0 else "a check without a number"


def quoted(title: str) -> str:
    """The title of a check within a sentence; titles hold commas."""
    return f"“{title}”"
