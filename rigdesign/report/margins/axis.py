"""A varied input as an axis: numbers with a unit, or names one after the other."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from rigdesign.base import units
from rigdesign.base.units import number_match
from rigdesign.report.numbers import number_text, unit_text
from rigdesign.studies.result import StudyPoint

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
