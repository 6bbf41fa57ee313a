"""What a study varies: 'PATH=START:STOP:STEP' or 'PATH=v1,v2', and the grid of several of them."""

import csv
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import product
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from rigdesign.base import units
from rigdesign.base.errors import UsageError, shortened
from rigdesign.base.units import kind_of, number_match
from rigdesign.studies.assumed_ranges import tied_inputs

if TYPE_CHECKING:
    from rigdesign.case import Case
    from rigdesign.case.fields import RangeEnds

MAX_POINTS = 100_000
KELVIN_STEPS = {"degC", "°C", "celsius", "degree_Celsius"}
"""Temperatures in these units may be stepped in kelvin."""

EXAMPLE = (
    "write PATH=START:STOP:STEP ('gearboxes.test.oil.inlet_temperature=90 degC:140 degC:10 K') or PATH=v1,v2"
)


@dataclass(frozen=True)
class Variation:
    """One varied input.

    path : dotted path into the case
    values : what the case file would hold, in the order of the study (``"90 degC"``, ``"0.4"``); of a range its
        two ends
    distribution : of a sampled range, in words; empty for values that are listed
    """

    path: str
    values: tuple[str, ...]
    distribution: str = ""

    def numbers(self) -> tuple[list[float], str] | None:
        """Values as numbers with their common unit, or None for values that are not."""
        parts = [number_match(value) for value in self.values]
        units = {part[2] for part in parts if part}
        if not all(parts) or len(units) != 1:
            return None
        return [float(part[1]) for part in parts if part], units.pop()


def parse_variation(text: str) -> Variation:
    """Read one ``--vary`` argument.

    ``PATH=START:STOP:STEP`` counts from START to STOP, both included; STOP must lie a whole number of steps
    from START. ``PATH=v1,v2`` lists values; a value that holds a comma stands in double quotes. The unit stands
    at every number ('90 degC:140 degC:10 K', '90 degC,140 degC'), or once at the end ('90:140:10 degC',
    '90,140 degC'), or nowhere for a dimensionless input; a temperature in degC may be stepped in K.

    Raises
    ------
    UsageError
        If the text has no such form; names what was given and what is accepted.
    """
    path, equals, right = text.partition("=")
    path, right = path.strip(), right.strip()
    text = shortened(text)
    if not equals or not path or not right:
        raise UsageError(f"--vary '{text}': {'a value' if path else 'a path'} is missing; {EXAMPLE}")
    bounds = [number_match(part) for part in right.split(":")]
    if len(bounds) > 1 and all(bounds):
        values = _range(text, [(Decimal(part[1]), part[2]) for part in bounds if part])
    else:
        try:
            values = _in_last_unit(next(csv.reader([right], skipinitialspace=True)))
        except csv.Error as error:
            raise UsageError(f"--vary '{text}': {error}; {EXAMPLE}") from None
    if not all(values):
        raise UsageError(f"--vary '{text}': a value is empty; {EXAMPLE}")
    twice = [value for number, value in enumerate(values) if value in values[:number]]
    if twice:
        raise UsageError(
            f"--vary '{text}': the value {shortened(twice[0])} stands twice; give each value once"
        )
    return Variation(path, tuple(values))


def _in_last_unit(values: Sequence[str]) -> list[str]:
    """Listed values; a unit that stands at the last one only is that of all."""
    stripped = [value.strip() for value in values]
    *others, last = (number_match(value) for value in stripped)
    plain = all(other and not other[2] for other in others)
    if last is None or not last[2] or not plain or kind_of(stripped[-1]) is None:
        return stripped
    return [f"{value} {last[2]}" for value in stripped[:-1]] + [stripped[-1]]


def _range(text: str, bounds: list[tuple[Decimal, str]]) -> list[str]:
    if len(bounds) == 2:
        raise UsageError(
            f"--vary '{text}': 2 numbers between colons make a range, a grid needs a step as well "
            "(START:STOP:STEP); or add --sample lhs:200, --tornado or --boundary"
        )
    if len(bounds) != 3:
        raise UsageError(f"--vary '{text}': {len(bounds)} numbers between colons, 3 are needed; {EXAMPLE}")
    unit = _common_unit(text, [unit for _, unit in bounds])
    start, stop, step = (number for number, _ in bounds)
    if step == 0 or (stop - start) * step < 0:
        remedy = "give a step other than zero" if step == 0 else "change the sign of the step"
        raise UsageError(f"--vary '{text}': a step of {step} never leads from {start} to {stop}; {remedy}")
    steps = (stop - start) / step
    if steps != steps.to_integral_value():
        last = start + steps.to_integral_value(rounding="ROUND_FLOOR") * step
        raise UsageError(
            f"--vary '{text}': STOP {stop} is {steps:.4g} steps from START, a whole number is needed; "
            f"stop at {last} or {last + step}"
        )
    if steps >= MAX_POINTS:
        raise UsageError(f"--vary '{text}': {steps + 1} values, at most {MAX_POINTS}; take a longer step")
    return [f"{_plain(start + n * step)} {unit}".strip() for n in range(int(steps) + 1)]


def _common_unit(text: str, units: list[str]) -> str:
    """The unit of all values: given everywhere alike, or once at the end."""
    start, stop, step = units
    if not start and not stop:
        return step
    if start != stop or (step not in ("", start) and not (step == "K" and start in KELVIN_STEPS)):
        given = ", ".join(unit or "none" for unit in units)
        raise UsageError(
            f"--vary '{text}': units {given}; START, STOP and STEP need the same unit "
            "(a step in K for temperatures in degC), or one unit at the end"
        )
    return start


def _plain(number: Decimal) -> str:
    return f"{number.normalize():f}"


def combinations(variations: Sequence[Variation]) -> list[tuple[str, ...]]:
    """Every combination of the values, the last variation running fastest.

    Raises
    ------
    UsageError
        If nothing is varied, a path stands twice or the grid is larger than ``MAX_POINTS``.
    """
    if not variations:
        raise UsageError(f"a study varies nothing; {EXAMPLE}")
    paths = [variation.path for variation in variations]
    twice = [path for number, path in enumerate(paths) if path in paths[:number]]
    if twice:
        raise UsageError(f"--vary {shortened(twice[0])} stands twice; give all its values in one --vary")
    size = 1
    for variation in variations:
        size *= len(variation.values)
    if size > MAX_POINTS:
        raise UsageError(f"{size} points in the grid, at most {MAX_POINTS}; vary fewer values")
    return list(product(*(variation.values for variation in variations)))


# Points spread over a unit cube: Latin hypercube, Sobol sequence, and the design of Sobol indices.

Array = NDArray[np.float64]
SAMPLE = re.compile(r"\s*(lhs|sobol)\s*:\s*(\d{1,9})\s*")
SAMPLE_EXAMPLE = "write --sample lhs:200 or --sample sobol:256"


@dataclass(frozen=True)
class Sample:
    """What ``--sample`` asks for: a kind of design and its number of points."""

    kind: Literal["lhs", "sobol"]
    size: int


def parse_sample(text: str) -> Sample:
    """Read ``lhs:N`` or ``sobol:N``.

    Raises
    ------
    UsageError
        Another text, fewer than 2 points, too many, or a number for Sobol that is no power of two.
    """
    found = SAMPLE.fullmatch(text)
    if found is None:
        raise UsageError(f"--sample {shortened(text)}: no such design; {SAMPLE_EXAMPLE}")
    size = int(found[2])
    if not 2 <= size <= MAX_POINTS:
        raise UsageError(f"--sample {text}: {size} points, 2 to {MAX_POINTS} are possible; {SAMPLE_EXAMPLE}")
    if found[1] == "lhs":
        return Sample("lhs", size)
    if size & (size - 1):
        below = 1 << (size.bit_length() - 1)
        raise UsageError(
            f"--sample {text}: a Sobol sequence is even only with a power of two; write sobol:{below} or "
            f"sobol:{2 * below}"
        )
    return Sample("sobol", size)


def unit_points(sample: Sample, inputs: int, seed: int) -> Array:
    """Points of a design in [0, 1), (size, inputs); the same for the same seed.

    Latin hypercube: McKay, Beckman, Conover, Technometrics 21 (1979); Sobol: scrambled (Owen).
    """
    rng = np.random.default_rng(seed)
    if sample.kind == "lhs":
        return np.asarray(qmc.LatinHypercube(inputs, rng=rng).random(sample.size))
    return np.asarray(qmc.Sobol(inputs, rng=rng).random(sample.size))


def saltelli_points(size: int, inputs: int, seed: int) -> Array:
    """The design of first-order and total indices, (size * (inputs + 2), inputs).

    Two independent samples A and B, then for every input A with that input from B, as in Saltelli et al., Computer
    Physics Communications 181 (2010) 259, table 2.
    """
    both = np.asarray(qmc.Sobol(2 * inputs, rng=np.random.default_rng(seed)).random(size))
    first, second = both[:, :inputs], both[:, inputs:]
    mixed = []
    for number in range(inputs):
        page = first.copy()
        page[:, number] = second[:, number]
        mixed.append(page)
    return np.concatenate([first, second, *mixed])


# Ranges a study varies: 'PATH=LOW:HIGH', or those the case states for its assumed inputs.

ASSUMED = "assumed"
"""What --vary takes for every assumed input with a range."""
DIGITS = 6
"""Significant digits of a value, so that it is the same text, and the same point, on every machine."""
RANGE_EXAMPLE = (
    "write PATH=LOW:HIGH ('gearboxes.test.oil.inlet_temperature=90 degC:140 degC'), or --vary assumed"
)


@dataclass(frozen=True)
class InputRange:
    """One input and the range it is varied over, uniform between the ends.

    path : dotted path into the case
    low, high : ends in ``unit``, as the case file would hold them
    whole : whole numbers only, every one of them as likely
    together_with : paths that must have the same value
    """

    path: str
    low: float
    high: float
    unit: str
    whole: bool = False
    together_with: tuple[str, ...] = ()

    @property
    def width(self) -> float:
        """Distance of the ends in ``unit``."""
        return self.high - self.low

    @property
    def variation(self) -> Variation:
        """The range as a study reports it."""
        distribution = "uniform over the whole numbers" if self.whole else "uniform between the ends"
        return Variation(self.path, (self.text(self.low), self.text(self.high)), distribution)

    def text(self, value: float) -> str:
        """``value`` as the case file would hold it."""
        number = str(round(value)) if self.whole else f"{value:.{DIGITS}g}"
        return f"{number} {self.unit}".strip()

    def at(self, share: float) -> str:
        """The value at a share of the range, 0 to 1."""
        if self.whole:
            return self.text(min(self.low + int(share * (self.width + 1)), self.high))
        return self.text(self.low + share * self.width)

    def number(self, text: str) -> float:
        """The number in a text of this range."""
        found = number_match(text)
        assert found is not None
        return float(found[1])

    def changes(self, text: str) -> dict[str, str]:
        """The values of the case that make the input ``text``."""
        return dict.fromkeys((self.path, *self.together_with), text)


def parse_ranges(case: "Case", texts: Sequence[str]) -> tuple[InputRange, ...]:
    """Read the ``--vary`` arguments of a study over ranges; a range that is written goes before an assumed one.

    Raises
    ------
    UsageError
        A text that is no range, an input that holds no number, a path that stands twice, a case without ranges.
    CaseError
        A path that does not exist.
    """
    written = [parse_range(case, text) for text in texts if text.strip() != ASSUMED]
    paths = [entry.path for entry in written]
    twice = [path for number, path in enumerate(paths) if path in paths[:number]]
    if twice:
        raise UsageError(f"--vary {shortened(twice[0])} stands twice; give it one range")
    if any(text.strip() == ASSUMED for text in texts):
        written += [entry for entry in assumed_ranges(case) if entry.path not in paths]
    if not written:
        raise UsageError(f"a study varies nothing; {RANGE_EXAMPLE}")
    return tuple(written)


def parse_range(case: "Case", text: str) -> InputRange:
    """Read ``PATH=LOW:HIGH``; the unit stands at both numbers, at the second, or nowhere."""
    path, equals, right = text.partition("=")
    path, text = path.strip(), shortened(text)
    if not equals or not path:
        raise UsageError(f"--vary '{text}': a {'range' if path else 'path'} is missing; {RANGE_EXAMPLE}")
    bounds = [number_match(part) for part in right.split(":")]
    if len(bounds) != 2 or not all(bounds):
        raise UsageError(f"--vary '{text}': {_what_else(case, path, bounds)}; {RANGE_EXAMPLE}")
    (low, first), (high, unit) = ((float(part[1]), part[2]) for part in bounds if part)
    if first not in ("", unit):
        raise UsageError(
            f"--vary '{text}': units {first} and {unit or 'none'}; give LOW and HIGH the same unit, or one unit at "
            "the end"
        )
    if not low < high:
        raise UsageError(f"--vary '{text}': LOW {low:g} is not below HIGH {high:g}; exchange or correct them")
    kind = case.input_kind(path)
    if kind == "other":
        raise UsageError(_no_number(text, path))
    found = InputRange(path, low, high, unit, whole=kind == "whole number")
    if found.whole and not (low.is_integer() and high.is_integer()):
        raise UsageError(f"--vary '{text}': {path} holds whole numbers; give whole LOW and HIGH")
    if kind is None:
        case.with_values(found.changes(found.text(low)))  # says which paths are near
    return found


def _what_else(case: "Case", path: str, bounds: Sequence[object]) -> str:
    if case.input_kind(path) == "other":
        return _no_number("", path)
    if len(bounds) == 3 and all(bounds):
        return "a step makes a grid, this study takes a range; leave the step out"
    return "no range of two numbers"


def _no_number(text: str, path: str) -> str:
    where = f"--vary '{text}': " if text else ""
    return (
        f"{where}{shortened(path)} holds a name or a choice, which has no range; list its values in a grid: "
        f"--vary '{shortened(path)}=v1,v2'"
    )


def require_number(case: "Case", variation: Variation, text: str) -> None:
    """Raise UsageError for numbers from START to STOP where the case holds a name."""
    stepped = ":" in text.partition("=")[2] and variation.numbers() is not None
    if stepped and case.input_kind(variation.path) == "other":
        raise UsageError(_no_number(shortened(text), variation.path))


def assumed_ranges(case: "Case") -> Iterable[InputRange]:
    """The ranges the case states for its assumed inputs, inputs that must agree together."""
    moved: set[str] = set()
    found = []
    for record in case.assumptions:
        if record.range is not None and record.path not in moved:
            tied = tied_inputs(case, record)
            moved |= {record.path, *tied}
            found.append(_assumed_range(case, record.path, record.range, tied))
    if not found:
        raise UsageError(
            f"--vary {ASSUMED}: case {case.name} states no assumed input with a range; write "
            'range = ["3 l/min", "8 l/min"] beside the value in the case, or give --vary PATH=LOW:HIGH'
        )
    return found


def _assumed_range(case: "Case", path: str, limits: "RangeEnds", tied: tuple[str, ...]) -> InputRange:
    """Both ends in the unit of the lower one."""
    ends = [number_match(str(end)) for end in limits]
    numbers = [(float(end[1]), end[2]) for end in ends if end]
    (low, unit), (high, other) = numbers
    if unit != other:
        kind = units.kind_of(limits[0])
        assert kind is not None
        both = [units.show(units.parse(end, kind), kind, digits=12) for end in limits]
        low, high = (float(text.partition(" ")[0]) for text in both)
        unit = both[0].partition(" ")[2]
    whole = case.input_kind(path) == "whole number"
    return InputRange(path, low, high, unit, whole=whole, together_with=tied)


def tolerance_in(entry: InputRange, text: str) -> float:
    """A tolerance as a number in the unit of a range; temperatures in degC take kelvin.

    Raises
    ------
    UsageError
        A text that is no number above zero, or one in another unit.
    """
    found = number_match(text)
    unit = "" if found is None else found[2]
    kelvin = unit == "K" and entry.unit in KELVIN_STEPS
    if found is None or not (unit in ("", entry.unit) or kelvin) or float(found[1]) <= 0.0:
        shown = "K" if entry.unit in KELVIN_STEPS else entry.unit
        raise UsageError(
            f"--tolerance {shortened(text)}: no distance between two values of {entry.path}; write a number above "
            f"0 such as '{f'{entry.width / 200:.3g} {shown}'.strip()}'"
        )
    return float(found[1])
