"""Ranges a study varies: 'PATH=LOW:HIGH', or those the case states for its assumed inputs."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rigdesign.base import units
from rigdesign.base.errors import UsageError, shortened
from rigdesign.base.units import number_match
from rigdesign.studies.grid import KELVIN_STEPS, Variation
from rigdesign.studies.range_plan import tied_inputs

if TYPE_CHECKING:
    from rigdesign.case import Case
    from rigdesign.case.assumptions import AssumptionRecord

ASSUMED = "assumed"
"""What --vary takes for every assumed input with a range."""
DIGITS = 6
"""Significant digits of a value, so that it is the same text, and the same point, on every machine."""
EXAMPLE = "write PATH=LOW:HIGH ('gearboxes.test.oil.inlet_temperature=90 degC:140 degC'), or --vary assumed"


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
        raise UsageError(f"a study varies nothing; {EXAMPLE}")
    return tuple(written)


def parse_range(case: "Case", text: str) -> InputRange:
    """Read ``PATH=LOW:HIGH``; the unit stands at both numbers, at the second, or nowhere."""
    path, equals, right = text.partition("=")
    path, text = path.strip(), shortened(text)
    if not equals or not path:
        raise UsageError(f"--vary '{text}': a {'range' if path else 'path'} is missing; {EXAMPLE}")
    bounds = [number_match(part) for part in right.split(":")]
    if len(bounds) != 2 or not all(bounds):
        raise UsageError(f"--vary '{text}': {_what_else(case, path, bounds)}; {EXAMPLE}")
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
            found.append(_assumed_range(case, record, tied))
    if not found:
        raise UsageError(
            f"--vary {ASSUMED}: case {case.name} states no assumed input with a range; write "
            'range = ["3 l/min", "8 l/min"] beside the value in the case, or give --vary PATH=LOW:HIGH'
        )
    return found


def _assumed_range(case: "Case", record: "AssumptionRecord", tied: tuple[str, ...]) -> InputRange:
    """Both ends in the unit of the lower one."""
    assert record.range is not None
    ends = [number_match(str(end)) for end in record.range]
    numbers = [(float(end[1]), end[2]) for end in ends if end]
    (low, unit), (high, other) = numbers
    if unit != other:
        kind = units.kind_of(record.range[0])
        assert kind is not None
        both = [units.show(units.parse(end, kind), kind, digits=12) for end in record.range]
        low, high = (float(text.partition(" ")[0]) for text in both)
        unit = both[0].partition(" ")[2]
    whole = case.input_kind(record.path) == "whole number"
    return InputRange(record.path, low, high, unit, whole=whole, together_with=tied)


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
