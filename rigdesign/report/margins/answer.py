"""The answer of a study in a sentence, for its page and the terminal."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rigdesign.report.margins.axis import StudyAxis, study_axis
from rigdesign.report.margins.passing import Passing, passing, quoted
from rigdesign.report.margins.table import MarginTable, margin_table
from rigdesign.studies.result import StudyPoint, StudyResult, check_ids
from rigdesign.studies.selection import CheckSelection

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
