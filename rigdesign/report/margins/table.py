"""Margins of the checks at every point of a study, as arrays."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rigdesign.base import units
from rigdesign.base.units import number_match
from rigdesign.report.numbers import number_text, unit_text
from rigdesign.results.check import status
from rigdesign.studies.result import StudyPoint

LEAST_MOVE = 0.1
"""Change of a margin over the study from which it counts as moved [% of the limit]."""


@dataclass(frozen=True, kw_only=True)
class CheckColumn:
    """What a check is called.

    by_definition : value and limit are both stated by the case
    """

    id: str
    title: str
    group: str
    by_definition: bool = False


@dataclass(frozen=True, kw_only=True)
class MarginTable:
    """Checks (columns) over points (rows).

    checks : one a column
    margin : distance to the limit [%], shape (points, checks); NaN where a check has no number
    own : margin in the unit of the check, linear in its value, shape (points, checks); NaN likewise
    fails : whether a limit that binds is missed, shape (points, checks)
    opens : whether the check could not be judged, shape (points, checks)
    computed : whether a point has a result, shape (points,)
    """

    checks: tuple[CheckColumn, ...]
    margin: NDArray[np.float64]
    own: NDArray[np.float64]
    fails: NDArray[np.bool_]
    opens: NDArray[np.bool_]
    computed: NDArray[np.bool_]

    @cached_property
    def always_failing(self) -> NDArray[np.bool_]:
        """Checks that fail at every computed point, shape (checks,)."""
        if not self.computed.any():
            return np.zeros(len(self.checks), dtype=bool)
        return np.asarray(self.fails[self.computed].all(axis=0), dtype=bool)

    @cached_property
    def undecided(self) -> NDArray[np.bool_]:
        """Checks that are open at some computed point, shape (checks,)."""
        return np.asarray(self.opens[self.computed].any(axis=0), dtype=bool)

    @property
    def verb(self) -> str:
        """What the checks do where no limit is missed: they pass only if each could be judged."""
        return "keeps its limits" if self.undecided.any() else "passes"

    @cached_property
    def moving(self) -> NDArray[np.bool_]:
        """Checks whose margin or verdict changes over the points, shape (checks,)."""
        margin, fails = self.margin[self.computed], self.fails[self.computed]
        if len(margin) == 0:
            return np.zeros(len(self.checks), dtype=bool)
        span = np.nan_to_num(_reduced(np.fmax, margin) - _reduced(np.fmin, margin))
        return np.asarray((span > LEAST_MOVE) | (fails.any(axis=0) & ~fails.all(axis=0)), dtype=bool)

    @cached_property
    def least(self) -> NDArray[np.float64]:
        """Smallest margin of every check over the points [%], shape (checks,); NaN where it has none."""
        return _reduced(np.fmin, self.margin) if len(self.margin) else np.full(len(self.checks), np.nan)

    def of(self, chosen: Sequence[int] | NDArray[np.bool_]) -> "MarginTable":
        """The table of some checks."""
        columns = np.flatnonzero(chosen) if isinstance(chosen, np.ndarray) else np.array(chosen, dtype=int)
        return replace(
            self,
            checks=tuple(self.checks[column] for column in columns),
            margin=self.margin[:, columns],
            own=self.own[:, columns],
            fails=self.fails[:, columns],
            opens=self.opens[:, columns],
        )

    def at(self, rows: NDArray[np.intp]) -> "MarginTable":
        """The table of some points, in the order of ``rows``."""
        return replace(
            self,
            margin=self.margin[rows],
            own=self.own[rows],
            fails=self.fails[rows],
            opens=self.opens[rows],
            computed=self.computed[rows],
        )

    def groups(self) -> dict[str, list[int]]:
        """Columns by group, in the order of the checks."""
        found: dict[str, list[int]] = {}
        for column, check in enumerate(self.checks):
            found.setdefault(check.group, []).append(column)
        return found

    @cached_property
    def by_definition(self) -> NDArray[np.bool_]:
        """Checks of a stated value against a stated limit, which decide nothing, shape (checks,)."""
        return np.array([check.by_definition for check in self.checks], dtype=bool)

    def nearest_first(self) -> list[int]:
        """Columns by smallest margin: those that move first, those by definition last, those without a number not."""
        known = [column for column in range(len(self.checks)) if not np.isnan(self.least[column])]
        return sorted(
            known,
            key=lambda column: (not self.moving[column], self.by_definition[column], self.least[column]),
        )

    def limiting(self) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """Column and margin [%] of the check that limits every point: a failing one before all others.

        Shapes (points,); -1 and NaN where no check has a number.
        """
        if not self.checks:
            return np.full(len(self.computed), -1), np.full(len(self.computed), np.nan)
        ranked = np.where(np.isnan(self.margin), np.inf, self.margin)
        ranked = np.where(self.fails & np.isfinite(ranked), np.minimum(ranked, 0.0) - 1e12, ranked)
        column = np.argmin(ranked, axis=1)
        margin = np.take_along_axis(self.margin, column[:, None], axis=1)[:, 0]
        return np.where(np.isnan(margin), -1, column), margin


def margin_table(points: Sequence[StudyPoint], identities: Sequence[str]) -> MarginTable:
    """Margins of the checks ``identities`` at all points."""
    column = {identity: number for number, identity in enumerate(identities)}
    shape = len(points), len(column)
    margin, own = np.full(shape, np.nan), np.full(shape, np.nan)
    fails, opens = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
    named: dict[str, CheckColumn] = {}
    for row, point in enumerate(points):
        for check in point.record.get("checks", ()):
            number = column.get(check["id"])
            if number is None:
                continue
            if check["id"] not in named:
                named[check["id"]] = CheckColumn(
                    id=check["id"],
                    title=check["title"],
                    group=check.get("group") or check["id"].partition(".")[0],
                    by_definition=bool(check.get("by_definition")),
                )
            fails[row, number] = status(check["verdict"], check.get("flags", ())) == "fail"
            opens[row, number] = check["verdict"] == "open"
            if check["distance"] is not None:
                margin[row, number] = 100.0 * check["distance"]
                own[row, number] = check["margin"]
    return MarginTable(
        checks=tuple(named[identity] for identity in identities),
        margin=margin,
        own=own,
        fails=fails,
        opens=opens,
        computed=np.array([not point.failed for point in points], dtype=bool),
    )


def _reduced(function: np.ufunc, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Over the points; NaN only where all are."""
    return np.asarray(function.reduce(values, axis=0), dtype=float)


# A varied input as an axis: numbers with a unit, or names one after the other.

READ_OFF = 20.0
"""Part of the distance of two computed points to which a value between them is stated."""


@dataclass(frozen=True)
class StudyAxis:
    """The values of one input over the points of a study.

    path : of the input in the case
    texts : every value once, ascending where they are numbers, else in their order
    positions : of the texts, in ``unit``; 0, 1, 2 … for names
    unit : of the numbers; empty for a dimensionless input and for names
    numeric : whether the values are numbers, between which one may interpolate
    """

    path: str
    texts: tuple[str, ...]
    positions: tuple[float, ...]
    unit: str
    numeric: bool

    @property
    def name(self) -> str:
        """The input in words."""
        return input_name(self.path)

    @property
    def label(self) -> str:
        """Name and unit for an axis of a figure."""
        return f"{self.name} [{unit_text(self.unit)}]" if self.unit else self.name

    def position(self, point: StudyPoint) -> float:
        """Where a point stands on the axis."""
        return self._places[point.values[self.path]]

    @cached_property
    def _places(self) -> dict[str, float]:
        return dict(zip(self.texts, self.positions, strict=True))

    def text(self, position: float) -> str:
        """A computed position with its unit, or the name that stands there."""
        if not self.numeric:
            return value_shown(self.texts[round(position)])
        return f"{number_text(position, 6)} {unit_text(self.unit)}".strip()

    def shown(self, text: str) -> str:
        """A value as printed: ``60 degC`` as 60 °C, with all its digits."""
        return value_shown(text)

    def read_off(self, position: float, held: float, beyond: float) -> str:
        """A value between the computed points ``held`` and ``beyond``, with the digits that their distance allows.

        Rounded to the side of ``held``, on which the checks hold, though not past it.
        """
        bracket = abs(beyond - held)
        if bracket == 0.0:
            return self.text(position)
        step = 10.0 ** math.floor(math.log10(bracket / READ_OFF) + 0.5)
        down = held <= beyond
        whole = math.floor(position / step + 1e-9) if down else math.ceil(position / step - 1e-9)
        if (whole * step < held) if down else (whole * step > held):
            return self.text(held)
        decimals = max(0, -math.floor(math.log10(step) + 0.5))
        return f"{whole * step:.{decimals}f} {unit_text(self.unit)}".strip().replace("-", "\u2212")


def value_shown(text: str) -> str:
    """A value as printed, with all its digits: ``60 degC`` as 60 °C; a name as it stands."""
    match = number_match(text)
    return text if match is None else f"{match[1]} {unit_text(match[2])}".strip()


def input_name(path: str) -> str:
    """An input in words: its path without the first name where that says little.

    A ``*`` stands for every part of its kind: ``gearboxes.*.oil.flow`` is the oil flow of every gearbox.
    """
    head, _, rest = path.partition(".")
    if "*" not in path:
        return (rest if head == "gearboxes" and rest else path).replace("_", " ").replace(".", " ")
    phrases: list[str] = []
    words: list[str] = []
    for part in path.split("."):
        if "*" not in part:
            words.append(part)
            continue
        *owner, kind = words or ["parts"]
        owner = [word for word in owner if word not in ("gearboxes", "drivetrain")]
        phrases += [" ".join(owner)] if owner else []
        phrases.append(f"every {_singular(kind)}" if part == "*" else f"every {_singular(kind)} {part}")
        words = []
    phrases += [" ".join(words)] if words else []
    return " of ".join(reversed(phrases)).replace("_", " ")


def _singular(plural: str) -> str:
    """The name of one part of a table: ``gearboxes``, ``bearings``, ``bought_parts``."""
    for ending in ("xes", "shes"):
        if plural.endswith(ending):
            return plural.removesuffix("es")
    return plural.removesuffix("s")


def study_axis(path: str, points: Sequence[StudyPoint]) -> StudyAxis:
    """The axis of an input over all points.

    Numbers stand in the unit of the first value. Values in several units of one kind are converted; anything else is
    a list of names.
    """
    texts = tuple(dict.fromkeys(point.values[path] for point in points))
    numbers = _numbers(texts)
    if numbers is None:
        return StudyAxis(path, texts, tuple(float(place) for place in range(len(texts))), "", numeric=False)
    positions, unit = numbers
    ordered = sorted(zip(positions, texts, strict=True))
    return StudyAxis(path, tuple(t for _, t in ordered), tuple(p for p, _ in ordered), unit, numeric=True)


def _numbers(texts: Sequence[str]) -> tuple[list[float], str] | None:
    """Numbers and their unit, None for values that are no numbers of one kind."""
    found = [number_match(text) for text in texts]
    if not all(found) or not found:
        return None
    parts = [(float(match[1]), match[2]) for match in found if match]
    unit = parts[0][1]
    if all(other == unit for _, other in parts):
        return [number for number, _ in parts], unit
    kind = units.kind_of(texts[0])
    if kind is None or any(units.kind_of(text) is None for text in texts):
        return None
    try:
        values = [units.parse(text, kind) for text in texts]
        return [units.display(value, kind, unit) for value in values], unit
    except (units.QuantityError, KeyError):
        return None
