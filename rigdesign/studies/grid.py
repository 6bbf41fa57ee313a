"""What a study varies: 'PATH=START:STOP:STEP' or 'PATH=v1,v2', and the grid of several of them."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import product

from rigdesign.base.errors import UsageError, shortened
from rigdesign.base.units import kind_of, number_match

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
