"""What a study computes: the design asked for, and the points it makes of a case."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import ceil, log2
from typing import TYPE_CHECKING

from rigdesign.base.errors import CaseError, UsageError
from rigdesign.studies.grid import (
    ASSUMED,
    MAX_POINTS,
    InputRange,
    Variation,
    combinations,
    parse_ranges,
    parse_variation,
    require_number,
    tolerance_in,
)
from rigdesign.studies.result import CheckSelection, Design, StudyPoint, check_ids, declared_ids
from rigdesign.studies.statistics import CheckState, changes, check_states, ends, stated_values

if TYPE_CHECKING:
    from rigdesign.case import Case

# The value of one input at which checks change from held to broken, by bisection.
#
# A few points over the range come first; every pair of neighbours of which one holds and one does not is halved until
# it is as narrow as the tolerance. A check whose margin turns between three points that agree is looked at where a
# parabola through them turns, so that a limit broken only between two points is found unless it is narrower than the
# first points see.

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


@dataclass(frozen=True, kw_only=True)
class StudyDesign:
    """What a study varies and how its points are chosen; a grid of listed values where nothing else is asked for.

    vary : a grid takes ``"PATH=START:STOP:STEP"`` or ``"PATH=v1,v2"``; every other design takes ranges,
        ``"PATH=LOW:HIGH"``, or ``"assumed"`` for every assumed input with a range
    sample : ``"lhs:N"`` Latin hypercube, ``"sobol:N"`` Sobol sequence; uniform between the ends, independent
    seed : of a sampled design
    indices : Sobol indices, N * (inputs + 2) points; with ``sample="sobol:N"``
    tornado : every range at both ends, one at a time
    boundary : the values of one range at which checks change from held to broken, by bisection
    tolerance : of these values (``"0.5 K"``); 1/200 of the range where left out
    checks : patterns on the ids of the checks the study is read for, as `CheckSelection` takes them
    """

    vary: tuple[str, ...]
    sample: str | None = None
    seed: int = 0
    indices: bool = False
    tornado: bool = False
    boundary: bool = False
    tolerance: str | None = None
    checks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what contradicts itself.

        Raises
        ------
        UsageError
            Two designs at once, or an option of another one.
        """
        asked = [
            name
            for name, given in (
                ("--sample", self.sample is not None), ("--tornado", self.tornado), ("--boundary", self.boundary)
            )
            if given
        ]  # fmt: skip
        if len(asked) > 1:
            raise UsageError(f"{' and '.join(asked)}: a study has one design; run one study for each")
        if self.indices and not (self.sample or "").strip().startswith("sobol"):
            raise UsageError("--indices: Sobol indices need a Sobol sequence; add --sample sobol:256")
        if self.tolerance is not None and not self.boundary:
            raise UsageError("--tolerance: the tolerance of a boundary search; add --boundary")
        if self.seed < 0:
            raise UsageError(f"--seed {self.seed}: below 0; write a whole number from 0")


@dataclass(frozen=True)
class DesignPoint:
    """A point to compute.

    values : of all varied inputs, as a table shows them
    changes : what is changed in the case
    """

    values: Mapping[str, str]
    changes: Mapping[str, str]


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A design for a case.

    points : known before anything is computed
    ranges : what is varied, except in a grid
    search : of a boundary
    """

    kind: Design
    method: str
    variations: Sequence[Variation]
    points: Sequence[DesignPoint]
    selection: CheckSelection
    ranges: Sequence[InputRange] = ()
    search: BoundarySearch | None = None
    indices: bool = False
    seed: int = 0

    def require_checks(self, case: "Case") -> None:
        """Refuse a pattern that matches no check of any point, known before one is computed.

        Raises
        ------
        UsageError
            With the nearest ids.
        """
        named = [variation.path for variation in self.variations if variation.numbers() is None]
        of_names = {tuple(point.values[path] for path in named): point for point in self.points}
        cases = [case]
        for point in of_names.values() if named else ():
            with suppress(CaseError):
                cases.append(case.with_values(point.changes))
        self.selection.of(list(dict.fromkeys(identity for each in cases for identity in declared_ids(each))))

    def more(self, points: Sequence[StudyPoint]) -> list[DesignPoint]:
        """Points to compute after those computed; only a boundary search has some."""
        if self.search is None:
            return []
        texts = self.search.next(points, self.selection.of(check_ids(points)))
        return [_moved([self.search.entry], [text]) for text in texts]

    def left(self, points: Sequence[StudyPoint]) -> int:
        """Points that will be chosen after those computed and chosen by now, about."""
        return 0 if self.search is None else self.search.left(points, self.selection.of(check_ids(points)))


def planned(case: "Case", design: StudyDesign) -> Plan:
    """The points of a design.

    Raises
    ------
    UsageError
        A ``vary`` or ``sample`` that cannot be read or does not fit the design, too many points.
    CaseError
        A path that does not exist.
    """
    maker: Callable[[Case, StudyDesign], Plan] = _grid
    if design.sample is not None:
        maker = _sampled
    elif design.tornado:
        maker = _tornado
    elif design.boundary:
        maker = _boundary
    return maker(case, design)


def _grid(case: "Case", design: StudyDesign) -> Plan:
    if ASSUMED in (text.strip() for text in design.vary):
        raise UsageError(
            "--vary assumed: ranges, of which a grid is not made; add --sample lhs:200 or --tornado"
        )
    variations = [parse_variation(text) for text in design.vary]
    for variation, text in zip(variations, design.vary, strict=True):
        require_number(case, variation, text)
    paths = [variation.path for variation in variations]
    points = [dict(zip(paths, values, strict=True)) for values in combinations(variations)]
    return Plan(
        kind="grid",
        method=_listed(len(points), len(paths)),
        variations=variations,
        points=[DesignPoint(values, values) for values in points],
        selection=CheckSelection(design.checks),
    )


def _listed(points: int, inputs: int) -> str:
    """How the points of a grid were chosen."""
    if points == 1:
        return "1 point"
    return f"{points} points, every {'combination of the listed values' if inputs > 1 else 'listed value'}"


def _sampled(case: "Case", design: StudyDesign) -> Plan:
    from rigdesign.studies.grid import parse_sample, saltelli_points, unit_points

    sample = parse_sample(design.sample or "")
    ranges = parse_ranges(case, design.vary)
    size = sample.size * (len(ranges) + 2 if design.indices else 1)
    if size > MAX_POINTS:
        raise UsageError(f"{size} points, at most {MAX_POINTS}; take a smaller sample or vary fewer inputs")
    if design.indices:
        shares = saltelli_points(sample.size, len(ranges), design.seed)
        how = (
            f"{size} points for Sobol indices ({sample.size} for each of {len(ranges)} inputs and twice more)"
        )
    else:
        shares = unit_points(sample, len(ranges), design.seed)
        how = f"{size} points of a {'Latin hypercube' if sample.kind == 'lhs' else 'Sobol sequence'}"
    points = [
        _moved(ranges, [entry.at(float(share)) for entry, share in zip(ranges, row, strict=True)])
        for row in shares
    ]
    return Plan(
        kind="latin hypercube" if sample.kind == "lhs" else "sobol",
        method=f"{how}, seed {design.seed}; every input is uniform between the ends of its range and independent "
        "of the others",
        variations=[entry.variation for entry in ranges],
        points=points,
        selection=CheckSelection(design.checks),
        ranges=ranges,
        indices=design.indices,
        seed=design.seed,
    )


def _tornado(case: "Case", design: StudyDesign) -> Plan:
    ranges = parse_ranges(case, design.vary)
    stated = stated_values(case, ranges)
    points = [DesignPoint(stated, {})]
    points += [DesignPoint({**stated, entry.path: text}, entry.changes(text)) for entry, text in ends(ranges)]
    return Plan(
        kind="one at a time",
        method=f"the case as stated and {_ends_of(len(ranges))}",
        variations=[entry.variation for entry in ranges],
        points=points,
        selection=CheckSelection(design.checks),
        ranges=ranges,
    )


def _ends_of(inputs: int) -> str:
    if inputs == 1:
        return "one input at both ends of its range"
    return f"{inputs} inputs at both ends of their ranges, one at a time"


def _boundary(case: "Case", design: StudyDesign) -> Plan:
    ranges = parse_ranges(case, design.vary)
    if len(ranges) != 1:
        raise UsageError(
            f"--boundary: {len(ranges)} inputs are varied, a boundary is sought over one; give one range"
        )
    entry = ranges[0]
    width = entry.width / DEFAULT_PARTS if design.tolerance is None else tolerance_in(entry, design.tolerance)
    tolerance = max(width, 1.0) if entry.whole else width
    search = BoundarySearch(entry, tolerance)
    return Plan(
        kind="boundary",
        method=f"bisection between {entry.text(entry.low)} and {entry.text(entry.high)} to {tolerance:.3g} "
        f"{'K' if entry.unit == 'degC' else entry.unit}".rstrip(),
        variations=[entry.variation],
        points=[_moved(ranges, [text]) for text in search.first()],
        selection=CheckSelection(design.checks),
        ranges=ranges,
        search=search,
    )


def _moved(ranges: Sequence[InputRange], texts: Sequence[str]) -> DesignPoint:
    values: dict[str, str] = {}
    changes: dict[str, str] = {}
    for entry, text in zip(ranges, texts, strict=True):
        values[entry.path] = text
        changes.update(entry.changes(text))
    return DesignPoint(values, changes)
