"""The answer of a study in a sentence, for its page and the terminal."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Literal, TypeVar

import numpy as np

from rigdesign.report.margins.table import MarginTable, StudyAxis, input_name, margin_table, study_axis
from rigdesign.report.numbers import number_text
from rigdesign.studies.result import CheckSelection, SobolIndex, StudyPoint, StudyResult, Swing, check_ids

# Where the checks hold over one varied input: ranges, what limits them, and the sentence that says so.

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


MOST_SLICES = 40
"""Values of a second input that are listed one by one."""
MOST_NAMED = 3
"""Checks named in a sentence."""


@dataclass(frozen=True, kw_only=True)
class StudyAnswer:
    """What the selected checks do over the points.

    axes : the varied inputs
    selected : all selected checks
    always : those that fail at every computed point, named apart so that they hide no other
    rest : the others, to which the answer belongs
    deciding : those of the rest that the study moves; where it moves none, those that are not met by definition
    passing : where the rest holds; None with several inputs
    sentences : the answer, to be read in this order
    """

    axes: tuple[StudyAxis, ...]
    selected: MarginTable
    always: MarginTable
    rest: MarginTable
    deciding: MarginTable
    passing: Passing | None
    sentences: tuple[str, ...]


def study_answer(study: StudyResult) -> StudyAnswer:
    """Read the points of a study for the checks it is read for.

    Raises
    ------
    UsageError
        If a pattern of the selection matches no check of the study.
    """
    points, selection = study.points, study.checks
    axes = tuple(study_axis(path, points) for path in (points[0].values if points else ()))
    selected = margin_table(points, selection.of(check_ids(points)))
    always, rest = selected.of(selected.always_failing), selected.of(~selected.always_failing)
    found = None
    if len(axes) == 1:
        found = passing(axes[0], [axes[0].position(point) for point in points], rest)
    sentences = _sentences(selection, always, rest, found)
    return StudyAnswer(
        axes=axes,
        selected=selected,
        always=always,
        rest=rest,
        deciding=_deciding(rest),
        passing=found,
        sentences=sentences,
    )


def _deciding(rest: MarginTable) -> MarginTable:
    for chosen in (rest.moving, ~rest.by_definition):
        if chosen.any():
            return rest.of(chosen)
    return rest


@dataclass(frozen=True, kw_only=True)
class Slices:
    """Where one of two inputs passes at every value of the other.

    along : the input whose range is given, one of numbers where there is one
    over : the other input
    rows : value of ``over`` and where the checks pass along ``along``
    """

    along: StudyAxis
    over: StudyAxis
    rows: tuple[tuple[str, str], ...]


def slices(points: Sequence[StudyPoint], answer: StudyAnswer) -> Slices | None:
    """The ranges of one input at every value of the other; None with another number of inputs."""
    if len(answer.axes) != 2 or not answer.rest.checks:
        return None
    along, over = sorted(answer.axes, key=lambda axis: not axis.numeric)
    rows: dict[str, list[int]] = {text: [] for text in over.texts}
    for number, point in enumerate(points):
        rows[point.values[over.path]].append(number)
    if len(rows) > MOST_SLICES or any(len(numbers) < 2 for numbers in rows.values()):
        return None
    said = [
        passing(along, [along.position(points[row]) for row in numbers], answer.rest.at(np.array(numbers)))
        for numbers in rows.values()
    ]
    texts = (over.shown(text) for text in rows)
    return Slices(
        along=along, over=over, rows=tuple(zip(texts, (found.sentence for found in said), strict=True))
    )


def _sentences(
    selection: CheckSelection, always: MarginTable, rest: MarginTable, found: Passing | None
) -> tuple[str, ...]:
    if not rest.computed.any():
        return ("No point has a result.",)
    said = []
    if always.checks:
        verb = "fails" if len(always.checks) == 1 else "fail"
        said.append(f"{_listed(always)} {verb} {_at_all(always)}.")
    if not rest.checks:
        return tuple(said)
    subject = _subject(selection, always, rest)
    if rest.undecided.any():
        said.append(_undecided(rest))
    if found is None:
        holds = rest.computed & ~rest.fails.any(axis=1)
        said.append(f"{subject} {rest.verb} at {_share(int(holds.sum()), int(rest.computed.sum()))}.")
    else:
        said.append(f"{subject} {found.sentence}.")
    missing = int((~rest.computed).sum())
    if missing:
        said.append(
            f"{missing} of {len(rest.computed)} points {'has' if missing == 1 else 'have'} no result."
        )
    return tuple(said)


def _undecided(rest: MarginTable) -> str:
    """Which checks could not be judged, and at how many points nothing passes for that."""
    undecided, opens = rest.of(rest.undecided), rest.opens[rest.computed]
    number, total = int(opens.any(axis=1).sum()), len(opens)
    head = "No point passes" if number == total else f"{_share(number, total).capitalize()} do not pass"
    return f"{head}: {_listed(undecided)} {'is' if len(undecided.checks) == 1 else 'are'} open, not judged."


def _subject(selection: CheckSelection, always: MarginTable, rest: MarginTable) -> str:
    if always.checks:
        return "Everything else"
    if selection.selects_all:
        return "Everything"
    return quoted(rest.checks[0].title) if len(rest.checks) == 1 else "Every selected check"


def _share(number: int, total: int) -> str:
    if total == 1:
        return "no point" if number == 0 else "the only point that has a result"
    if number in (0, total):
        return "no point" if number == 0 else f"all {total} points"
    return f"{number} of {total} points"


def _at_all(table: MarginTable) -> str:
    if int(table.computed.sum()) > 1:
        return "at every point"
    return "at the only point" + (" with a result" if len(table.computed) > 1 else "")


def _listed(table: MarginTable) -> str:
    named = [quoted(check.title) for check in table.checks[:MOST_NAMED]]
    more = len(table.checks) - len(named)
    *first, last = [*named, f"{more} more"] if more else named
    return f"{', '.join(first)} and {last}" if first else last


# What every input does to the checks, in lines for the terminal: Sobol indices and margins at the ends of an input.

MOST_CHECKS = 3
"""Checks with a line, the nearest to their limits first."""
MOST_INPUTS = 3
"""Inputs in a line, the strongest first."""

Influence = TypeVar("Influence", SobolIndex, Swing)


def by_check(answer: StudyAnswer, records: Iterable[Influence]) -> Iterator[tuple[str, list[Influence]]]:
    """Title and records of every selected check, the nearest to its limit first; what always fails comes last."""
    found: dict[str, list[Influence]] = {}
    for record in records:
        found.setdefault(record.check, []).append(record)
    for table in (answer.rest, answer.always):
        for column in table.nearest_first():
            check = table.checks[column]
            if check.id in found:
                yield check.title, found[check.id]


def influence_lines(study: StudyResult, answer: StudyAnswer) -> list[str]:
    """Headings and lines of the indices and of the ends of the inputs; none of a design without them."""
    lines = []
    indices = list(islice(by_check(answer, study.indices), MOST_CHECKS))
    if indices:
        lines.append("Total Sobol index of every input, with its 95 % interval:")
        lines += [f"  {title}: {_shares(chosen)}" for title, chosen in indices]
    swings = [(title, _ends(chosen)) for title, chosen in by_check(answer, study.swings)]
    moved = [(title, text) for title, text in swings if text][:MOST_CHECKS]
    if moved:
        lines.append("Margin at the lower and at the upper end of every input, the others as stated:")
        lines += [f"  {title}: {text}" for title, text in moved]
    return lines


def _shares(indices: Sequence[SobolIndex]) -> str:
    ordered = sorted(indices, key=lambda index: -index.total)[:MOST_INPUTS]
    return ", ".join(
        f"{input_name(index.path)} {index.total:.2f} ({index.total_interval[0]:.2f} to {index.total_interval[1]:.2f})"
        for index in ordered
    )


def _ends(swings: Sequence[Swing]) -> str:
    """Margins [%] at both ends of the inputs that move the check; empty where none does."""
    found = []
    for swing in swings:
        low, high = swing.distance_low, swing.distance_high
        if low is not None and high is not None and not swing.distance_stated == low == high:
            ends = (number_text(100.0 * end, 3) for end in (low, high))
            found.append((abs(high - low), f"{input_name(swing.path)} {' and '.join(ends)} %"))
    return ", ".join(text for _, text in sorted(found, key=lambda item: -item[0])[:MOST_INPUTS])
