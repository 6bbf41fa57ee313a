"""study.html: the answer, its pictures, where every check and group passes, and every point."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from rigdesign.base.version import __version__
from rigdesign.report.figures import study
from rigdesign.report.figures.drawing import NumberedFigures
from rigdesign.report.figures.study import indices_figure, region_figure, scatter_figure, tornado_figure
from rigdesign.report.margins.passing_range import StudyAnswer, by_check, passing, slices
from rigdesign.report.margins.regions import region_map
from rigdesign.report.margins.table import MarginTable
from rigdesign.studies.result import StudyPoint, StudyResult

if TYPE_CHECKING:
    from markupsafe import Markup
    from matplotlib.figure import Figure

# The pictures of a study page, chosen by its design and the number of its inputs.

MOST_PAIRS = 15
"""Pair maps on one page: those of six inputs."""
MOST_SCATTER = 8
"""Inputs with a scatter plot."""
MOST_CHECKS = 6
"""Checks with a tornado plot or a plot of indices, the nearest to their limits first."""
MOST_CURVES = 8
"""Checks of a group in its plot."""

T = TypeVar("T")


@dataclass(frozen=True)
class Picture:
    """A figure as SVG with its caption."""

    svg: "Markup"
    caption: str


@dataclass
class StudyPictures:
    """What is drawn of a study.

    main : one picture over the whole width, or several small ones
    groups : margins by group over one input
    tornado, indices : one picture a check
    """

    main: list[Picture] = field(default_factory=list)
    groups: list[Picture] = field(default_factory=list)
    tornado: list[Picture] = field(default_factory=list)
    indices: list[Picture] = field(default_factory=list)

    @property
    def first(self) -> Picture | None:
        """The main picture, which stands alone as study.svg."""
        return next(iter([*self.main, *self.tornado, *self.indices]), None)


def study_pictures(found: StudyResult, answer: StudyAnswer) -> StudyPictures:
    """Draw a study: curves of one input, a map of two, maps of all pairs of a grid, scatter plots of samples."""
    pictures, svg = StudyPictures(), NumberedFigures()
    if not answer.selected.computed.any():
        return pictures
    if len(answer.axes) == 1 and len(found.points) > 1:
        _curves(pictures, svg, found, answer)
    elif len(found.points) > 1 and found.design != "one at a time":
        if found.design in ("grid", "boundary"):
            _maps(pictures, svg, found, answer)
        if not pictures.main:
            _scatter(pictures, svg, found, answer)
    _draw_each(pictures.tornado, svg, by_check(answer, found.swings), tornado_figure, TORNADO)
    _draw_each(pictures.indices, svg, by_check(answer, found.indices), indices_figure, INDICES)
    return pictures


def _curves(pictures: StudyPictures, svg: NumberedFigures, found: StudyResult, answer: StudyAnswer) -> None:
    axis = answer.axes[0]
    positions = [axis.position(point) for point in found.points]
    main = study.margins_figure(answer, positions)
    if main is None:
        return
    drawn = study.drawn_columns(answer.selected)
    said = (
        "The checks that move, the nearest to their limit first"
        if answer.selected.moving.any()
        else NOTHING_MOVES
    )
    if len(drawn) > study.NAMED_CURVES:
        said += f"; {len(drawn) - study.NAMED_CURVES} more that move stand in the plots by group"
    if answer.passing and answer.passing.ranges:
        but = " but what fails at every point" if answer.always.checks else ""
        said += f". Green: range in which every check passes{but}, its end on a straight line between computed points"
    pictures.main.append(
        Picture(svg(main, f"Margins over {axis.label}"), f"{said}. Below zero a limit is broken.")
    )
    nearest = answer.selected.nearest_first()
    for group, columns in answer.selected.groups().items():
        chosen = [column for column in nearest if column in columns and answer.selected.moving[column]]
        if chosen:
            figure = study.group_figure(answer, positions, chosen[:MOST_CURVES])
            more = len(chosen) - MOST_CURVES
            caption = f"{more} more with a larger margin are not drawn." if more > 0 else ""
            pictures.groups.append(
                Picture(svg(figure, f"Margins of the group {group} over {axis.label}"), caption)
            )


def _maps(pictures: StudyPictures, svg: NumberedFigures, found: StudyResult, answer: StudyAnswer) -> None:
    pairs = list(combinations(answer.axes, 2))
    for pair in pairs[:MOST_PAIRS]:
        regions = region_map(pair, found.points, answer.deciding) if answer.rest.checks else None
        if regions is None:
            continue
        figure = region_figure(pair, regions, answer.deciding, small=len(pairs) > 1)
        others = " and ".join(axis.name for axis in answer.axes if axis not in pair)
        caption = f"At the worst of the computed values of {others}." if others else MAP
        description = f"Limiting check over {pair[0].label} and {pair[1].label}"
        pictures.main.append(Picture(svg(figure, description), caption))


def _scatter(pictures: StudyPictures, svg: NumberedFigures, found: StudyResult, answer: StudyAnswer) -> None:
    """Margins over every input; of many inputs over those along which the smallest margin changes most."""
    if not answer.rest.checks:
        return
    positions = {axis.path: [axis.position(point) for point in found.points] for axis in answer.axes}
    axes = list(answer.axes)
    if len(axes) > MOST_SCATTER:
        _, margins = answer.deciding.limiting()
        axes.sort(key=lambda axis: -abs(_rank_correlation(positions[axis.path], margins)))
    for axis in axes[:MOST_SCATTER]:
        figure = scatter_figure(axis, positions[axis.path], answer.deciding)
        pictures.main.append(Picture(svg(figure, f"Smallest margin over {axis.label}"), ""))


def _rank_correlation(positions: Sequence[float], margins: NDArray[np.float64]) -> float:
    """Spearman's, over the points with a margin; 0 where it is not defined."""
    known = np.isfinite(margins)
    if known.sum() < 3 or np.ptp(np.asarray(positions)[known]) == 0.0 or np.ptp(margins[known]) == 0.0:
        return 0.0
    from scipy.stats import spearmanr

    return float(spearmanr(np.asarray(positions)[known], margins[known]).statistic)


def _draw_each(
    pictures: list[Picture],
    svg: NumberedFigures,
    records: Iterable[tuple[str, list[T]]],
    draw: Callable[[str, Sequence[T]], "Figure | None"],
    description: str,
) -> None:
    """One picture a check, in the order of ``records``, as many as a page has room for."""
    for title, chosen in records:
        figure = draw(title, chosen)
        if figure is not None:
            pictures.append(Picture(svg(figure, f"{description}, {title}"), ""))
        if len(pictures) == MOST_CHECKS:
            return


TORNADO = "Margin with one input at its ends"
INDICES = "Sobol indices"
NOTHING_MOVES = "No margin of the selected checks changes; drawn are the nearest to their limit"
MAP = (
    "Colour and letter: the check with the smallest margin; hatched: a check fails; thick line: zero margin; thin "
    "lines: smallest margin in percent. Margins are linear between computed points."
)


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
