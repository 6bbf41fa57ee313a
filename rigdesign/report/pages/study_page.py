"""study.html: the answer, its pictures, where every check and group passes, and every point."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rigdesign.base.version import __version__
from rigdesign.report.margins.answer import StudyAnswer, slices
from rigdesign.report.margins.passing import passing
from rigdesign.report.margins.table import MarginTable
from rigdesign.report.pages.study_pictures import MAP, StudyPictures
from rigdesign.studies.result import StudyPoint, StudyResult

MOST_ROWS = 2000
"""Points listed on the page; results.csv has all."""
MOST_CELLS = 40_000
"""Values of inputs listed on the page."""
MOST_NAMED = 3
"""Inputs by whose values a point is named; with more it has its number."""


@dataclass(frozen=True, kw_only=True)
class PassRow:
    """Where a check or a group passes.

    least : smallest margin over the points [%], NaN without a number
    note : why it does not limit the study, empty where it may
    passes : in words
    failing : points at which it fails
    """

    name: str
    id: str
    group: str
    least: float
    at: str
    passes: str
    failing: int
    moves: bool
    note: str = ""


@dataclass(frozen=True, kw_only=True)
class PointRow:
    """A point in the table: its values, what limits it and by how much."""

    values: tuple[tuple[str, float | None], ...]
    """Text, and the number to sort by."""
    point: StudyPoint
    outcome: str
    limiting: str
    margin: float | None


def study_page(study: StudyResult, answer: StudyAnswer, pictures: StudyPictures) -> str:
    """The page as one self-contained document."""
    from rigdesign.report.pages.report import environment

    return (
        environment()
        .get_template("study.html.j2")
        .render(
            case=study.case,
            study=study,
            answer=answer,
            outcome=_outcome(answer),
            pictures=pictures,
            map_note=MAP,
            groups=_group_rows(study.points, answer),
            checks=_check_rows(study.points, answer),
            slices=slices(study.points, answer) if study.design == "grid" else None,
            titles={check.id: check.title for check in answer.selected.checks},
            names={axis.path: axis.name for axis in answer.axes},
            heated=any(point.record.get("max_temperature_degC") is not None for point in study.points),
            failed=[point for point in study.points if point.failed],
            rows=_point_rows(study.points, answer)[: min(MOST_ROWS, MOST_CELLS // len(answer.axes))],
            numbered=len(answer.axes) > MOST_NAMED,
            tool_version=__version__,
        )
    )


def _outcome(answer: StudyAnswer) -> str:
    """Colour of the banner: of a pass where all selected checks pass everywhere, of a fail where some always fail."""
    computed = answer.selected.computed
    if not computed.any():
        return "fail"
    holds = ~answer.rest.fails[computed].any(axis=1)
    if holds.all() and not answer.always.checks:
        return "open" if answer.rest.undecided.any() else "pass"
    return "open" if holds.any() else "fail"


def _group_rows(points: Sequence[StudyPoint], answer: StudyAnswer) -> list[PassRow]:
    table = answer.selected
    rows = [_pass_row(points, answer, table.of(columns), group) for group, columns in table.groups().items()]
    return sorted(rows, key=_nearest)


def _check_rows(points: Sequence[StudyPoint], answer: StudyAnswer) -> list[PassRow]:
    table = answer.selected
    rows = [
        _pass_row(points, answer, table.of([column]), check.title, check.id)
        for column, check in enumerate(table.checks)
        if not np.isnan(table.least[column])
    ]
    return sorted(rows, key=_nearest)


def _nearest(row: PassRow) -> tuple[bool, bool, bool, float]:
    return np.isnan(row.least), not row.moves, bool(row.note), row.least


def _pass_row(
    points: Sequence[StudyPoint], answer: StudyAnswer, table: MarginTable, name: str, identity: str = ""
) -> PassRow:
    least, at = _least(points, answer, table.of(table.moving) if table.moving.any() else table)
    at = at if table.moving.any() or np.isnan(least) or len(points) == 1 else "every point"
    passes = ""
    if len(answer.axes) == 1:
        axis = answer.axes[0]
        rest = table.of(~table.always_failing)
        if identity or not table.always_failing.any():
            passes = passing(axis, [axis.position(point) for point in points], table).sentence
        else:
            number = int(table.always_failing.sum())
            where = "at every point" if len(points) > 1 else ""
            passes = f"{number} {'check fails' if number == 1 else 'checks fail'} {where}".rstrip()
            if rest.checks:
                found = passing(axis, [axis.position(point) for point in points], rest)
                passes += f"; the rest {found.sentence}"
    return PassRow(
        name=name,
        id=identity,
        group=table.checks[0].group,
        least=least,
        at=at,
        passes=passes,
        failing=int(table.fails[table.computed].any(axis=1).sum()),
        moves=bool(table.moving.any()),
        note=_note(table, len(points)),
    )


def _note(table: MarginTable, points: int) -> str:
    if np.isnan(table.least).all():
        return "no check with a number"
    if table.by_definition[~np.isnan(table.least)].all():
        return "a stated value against a stated limit"
    return "" if points == 1 or table.moving.any() else "not changed by this study"


def _least(points: Sequence[StudyPoint], answer: StudyAnswer, table: MarginTable) -> tuple[float, str]:
    """Smallest margin [%] of a table and the point where it is."""
    smallest = np.fmin.reduce(table.margin, axis=1)
    if np.isnan(smallest).all():
        return float("nan"), ""
    row = int(np.nanargmin(smallest))
    if len(answer.axes) > MOST_NAMED:
        return float(smallest[row]), f"point {row + 1}"
    return float(smallest[row]), ", ".join(axis.shown(points[row].values[axis.path]) for axis in answer.axes)


def _point_rows(points: Sequence[StudyPoint], answer: StudyAnswer) -> list[PointRow]:
    columns, margins = answer.deciding.limiting()

    def values(point: StudyPoint) -> tuple[tuple[str, float | None], ...]:
        return tuple(
            (axis.shown(point.values[axis.path]), axis.position(point) if axis.numeric else None)
            for axis in answer.axes
        )

    rows: list[Any] = list(zip(points, columns.tolist(), margins.tolist(), answer.rest.fails, strict=True))
    opens = [bool(row.any()) for row in answer.rest.opens]
    return [
        PointRow(
            values=values(point),
            point=point,
            outcome="fails" if fails.any() else "open" if undecided else "passes",
            limiting=answer.deciding.checks[column].title if column >= 0 else "",
            margin=margin if column >= 0 else None,
        )
        for (point, column, margin, fails), undecided in zip(rows, opens, strict=True)
    ]
