"""From the name of an explanation to what is said of it: effect, tooth, sizes with unit and interval.

A harmonic that is fitted by its parts along cosine and sine is reported by amplitude and phase as well. Sizes are
rounded once, here: what a report says is what a patch writes.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import atan2, exp, hypot, isfinite, log, pi

from rigdesign.diagnosis.catalogue.effects import Effect, Parameter
from rigdesign.diagnosis.residual.hypotheses import UNKNOWN
from rigdesign.diagnosis.residual.sensors import SensorError, index_pulse_offset
from rigdesign.diagnosis.statistics.evidence import NORMAL_95, Evidence, Size

DIGITS = 6
"""Significant digits of a fitted size."""

PARTS = (" along cosine", " along sine")
"""How the names of the two parameters of a harmonic end."""

INPUT_UNITS = {"speed": "rad/s", "torque": "N m", "flow": "m3/s"}
"""Kind of a setting -> unit of its error."""

Interval = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Value:
    """One number that is reported of an effect.

    interval : 95 %; open : it ends on a physical bound, the size may be larger
    factor : neutral at one; phase : an angle on the circle, its interval may pass zero
    """

    name: str
    value: float
    unit: str
    interval: Interval
    open: bool = False
    factor: bool = False


@dataclass(frozen=True, kw_only=True)
class Sized:
    """An explanation with its sizes.

    name : of the entry, ``single_pitch:test.pinion``; explanation : with tooth or order, ``single_pitch:test.pinion/7``
    values : of the entry's parameters, as a patch writes them; ends : their intervals
    shown : what is reported: amplitude and phase of a harmonic, then its parts
    """

    name: str
    explanation: str
    title: str
    entry: Effect | SensorError
    tooth: int | None
    values: tuple[float, ...]
    ends: tuple[Interval, ...]
    shown: tuple[Value, ...]

    @property
    def kind(self) -> str:
        """The part of the name before its place."""
        return self.name.split(":")[0].split("/")[0]

    @property
    def coordinates(self) -> tuple[float, ...]:
        """Of the entry's parameters, as a hypothesis has them."""
        parameters = _parameters(self.entry)
        return tuple(
            log(value) if p.factor else value for p, value in zip(parameters, self.values, strict=True)
        )


class Names:
    """Finds what an explanation of one diagnosis stands for."""

    def __init__(self, effects: Sequence[Effect], errors: Sequence[SensorError]) -> None:
        self._effects = {effect.name: effect for effect in effects}
        self._errors = {error.name: error for error in errors}

    def entry(self, explanation: str) -> tuple[Effect | SensorError, int | None] | None:
        """Entry and tooth; None for what has no entry: unknown causes, exchanged channels, wrong units, pairs."""
        entry = self._effects.get(explanation) or self._errors.get(explanation)
        if entry is not None:
            return entry, None
        name, _, tooth = explanation.rpartition("/")
        effect = self._effects.get(name)
        if effect is None or not effect.any_tooth or not tooth.isdigit():
            return None
        return effect, int(tooth)

    def plain(self, explanation: str) -> str:
        """The explanation without its tooth: one name for all teeth of a gear."""
        entry_and_tooth = self.entry(explanation)
        return explanation if entry_and_tooth is None else entry_and_tooth[0].name

    def title_of(self, evidence: Evidence) -> str:
        """Of an explanation at its best fit; of a pair both."""
        return " and ".join(self.title(name, *sizes[:1]) for name, sizes in evidence.members)

    def title(self, explanation: str, size: float = 0.0) -> str:
        """In words; of an effect at any order without the order; ``size``: of what has no entry, by its sign."""
        entry_and_tooth = self.entry(explanation)
        if entry_and_tooth is None:
            of_orders = next(
                (effect.title for effect in self._effects.values() if effect.claim == explanation), ""
            )
            return of_orders.rpartition(", ")[0] or _without_entry(explanation, size)
        entry, tooth = entry_and_tooth
        return entry.title if tooth is None else f"{entry.title}: tooth {tooth}"

    def sized(self, explanation: str, sizes: Sequence[float], ends: Sequence[Interval]) -> Sized:
        """With coordinates and their intervals.

        Raises ValueError for an explanation without an entry.
        """
        entry_and_tooth = self.entry(explanation)
        if entry_and_tooth is None:
            raise ValueError(f"explanation {explanation} has no size; only entries of the catalogue have one")
        entry, tooth = entry_and_tooth
        parameters = _parameters(entry)
        values = tuple(_value(p, size) for p, size in zip(parameters, sizes, strict=True))
        limits = tuple(_ends(p, pair) for p, pair in zip(parameters, ends, strict=True))
        return Sized(
            name=entry.claim if isinstance(entry, Effect) else entry.name,
            explanation=explanation,
            title=self.title(explanation),
            entry=entry,
            tooth=tooth,
            values=values,
            ends=limits,
            shown=_shown(entry, parameters, values, limits),
        )


def from_fit(names: Names, sizes: Sequence[Size]) -> tuple[Sized, ...]:
    """The named effects of a joint fit, in its order."""
    by_effect: dict[str, list[Size]] = {}
    for size in sizes:
        by_effect.setdefault(size.effect, []).append(size)
    return tuple(
        names.sized(effect, [size.coordinate for size in group], [size.interval for size in group])
        for effect, group in by_effect.items()
    )


def from_evidence(names: Names, evidence: Evidence, signature_error: Mapping[str, float]) -> Sized:
    """An explanation at its own best fit, as if it were the only one; the interval as that of a joint fit."""
    entry_and_tooth = names.entry(evidence.hypothesis.name)
    if entry_and_tooth is None:
        raise ValueError(f"explanation {evidence.hypothesis.name} has no size")
    entry = entry_and_tooth[0]
    kind = entry.kind if isinstance(entry, Effect) else entry.name.split(":")[0]
    width = signature_error.get(kind.split("/")[0], signature_error.get("", 0.25))
    whole = hypot(*evidence.coordinates)
    ends = []
    for parameter, size, deviation in zip(
        _parameters(entry), evidence.coordinates, evidence.deviations, strict=True
    ):
        half = NORMAL_95 * hypot(deviation, width * whole)
        low, high = parameter.bounds
        ends.append((max(size - half, low), min(size + half, high)))
    return names.sized(evidence.hypothesis.name, evidence.coordinates, ends)


def size_value(names: Names, explanation: str, coordinate: float) -> float | None:
    """A size in the coordinate of an entry as the value of its parameter; None where there is none."""
    entry_and_tooth = names.entry(explanation)
    if entry_and_tooth is None or not isfinite(coordinate):
        return None
    try:
        return _value(_parameters(entry_and_tooth[0])[0], coordinate)
    except OverflowError:
        return None


def parameter_of(names: Names, explanation: str) -> Parameter | None:
    """The parameter a detectable size belongs to; of a harmonic its amplitude."""
    entry_and_tooth = names.entry(explanation)
    if entry_and_tooth is None:
        return None
    first = _parameters(entry_and_tooth[0])[0]
    return Parameter(
        name=_amplitude_name(first.name), unit=first.unit, low=first.low, high=first.high,
        source=first.source, factor=first.factor,
    )  # fmt: skip


def rounded(value: float) -> float:
    """A size as it is reported."""
    return float(f"{value:.{DIGITS}g}") + 0.0


def _value(parameter: Parameter, coordinate: float) -> float:
    return rounded(exp(coordinate) if parameter.factor else coordinate)


def _ends(parameter: Parameter, pair: Interval) -> Interval:
    return _value(parameter, pair[0]), _value(parameter, pair[1])


def _parameters(entry: Effect | SensorError) -> tuple[Parameter, ...]:
    if isinstance(entry, Effect):
        return entry.parameters
    name = "share" if not entry.unit else "error"
    unit = entry.unit if entry.unit != "SI" else INPUT_UNITS.get(entry.name.split("_")[0], "")
    return (Parameter(name=name, unit=unit, low=-entry.bound, high=entry.bound, source="stated uncertainty"),)


def _shown(
    entry: Effect | SensorError,
    parameters: Sequence[Parameter],
    values: Sequence[float],
    ends: Sequence[Interval],
) -> tuple[Value, ...]:
    plain = tuple(
        Value(
            name=parameter.name, value=value, unit=parameter.unit, interval=pair, factor=parameter.factor,
            open=any(_meets(end, limit) for end, limit in zip(pair, (parameter.low, parameter.high))),
        )
        for parameter, value, pair in zip(parameters, values, ends)
    )  # fmt: skip
    if len(parameters) != 2 or not parameters[0].name.endswith(PARTS[0]):
        return plain
    along, across = values
    halves = [max(high - value, value - low) for value, (low, high) in zip(values, ends)]
    amplitude, phase = _polar(_amplitude_name(parameters[0].name), parameters[0].unit, along, across, halves)
    if isinstance(entry, Effect) and entry.doubled:
        return (amplitude, phase, _twice(entry.doubled, amplitude), *plain)
    return (amplitude, phase, *plain)


def _meets(end: float, limit: float) -> bool:
    """Whether an interval ends on a bound; zero, where an effect begins, leaves nothing open."""
    return limit != 0.0 and abs(end - limit) <= 1e-5 * abs(limit)


def _polar(name: str, unit: str, along: float, across: float, halves: Sequence[float]) -> tuple[Value, Value]:
    """Amplitude and phase of along cos x + across sin x, their intervals by first order."""
    size = hypot(along, across)
    angle = atan2(across, along) % (2.0 * pi)
    if size == 0.0:
        reach = hypot(*halves)
        return (
            Value(name=name, value=0.0, unit=unit, interval=(0.0, rounded(reach))),
            Value(name="phase", value=0.0, unit="rad", interval=(0.0, rounded(2.0 * pi))),
        )
    half = hypot(along / size * halves[0], across / size * halves[1])
    turn = pi if half >= size else min(pi, hypot(across / size * halves[0], along / size * halves[1]) / size)
    return (
        Value(
            name=name, value=rounded(size), unit=unit,
            interval=(rounded(max(0.0, size - half)), rounded(size + half)),
        ),
        Value(
            name="phase", value=rounded(angle), unit="rad", interval=(rounded(angle - turn), rounded(angle + turn))
        ),
    )  # fmt: skip


def _twice(name: str, amplitude: Value) -> Value:
    """Peak to valley, as a drawing and the case have it."""
    low, high = amplitude.interval
    return Value(
        name=name, value=rounded(2.0 * amplitude.value), unit=amplitude.unit,
        interval=(rounded(2.0 * low), rounded(2.0 * high)),
    )  # fmt: skip


def _amplitude_name(name: str) -> str:
    return name.removesuffix(PARTS[0]).removesuffix(PARTS[1])


def _without_entry(explanation: str, size: float) -> str:
    """Words for what has no entry."""
    kind, _, rest = explanation.partition(":")
    if kind == "unknown":
        return f"not in the catalogue: {in_words(rest.strip(), size)}"
    first, _, second = rest.partition(",")
    if kind == "swapped_channels":
        return f"channels {first} and {second} exchanged"
    if kind == "swapped_points":
        return f"operating points {first} and {second} exchanged"
    if angle := index_pulse_offset(explanation):
        return f"index pulse offset by {angle}"
    if kind == "unit":
        channel, _, misread = rest.partition(" (")
        return f"{channel} in another unit or sign: {misread.removesuffix(')')}"
    return explanation


_SCALES = {
    "m": (1e6, "um"),
    "m3/s": (6e4, "l/min"),
    "rad/s": (30.0 / pi, "rpm"),
    "rad": (180.0 / pi, "deg"),
    "kg m": (1e6, "g mm"),
}
"""Unit of the catalogue -> factor to, and unit of what an engineer reads."""


def display_scale(unit: str, factor: bool) -> tuple[float, str]:
    """Factor to the unit in which a size is read, and that unit; a share is read in percent."""
    if factor:
        return 1.0, ""
    return _SCALES.get(unit, (1.0, unit)) if unit else (100.0, "%")


def formatted(value: Value) -> str:
    """``run-out F_r 24.1 um (22.0 to 26.2)``."""
    scale, unit = display_scale(value.unit, value.factor)
    numbers = [f"{scale * amount:.3g}" for amount in (value.value, *value.interval)]
    number = f"x {numbers[0]}" if value.factor else f"{numbers[0]} {unit}"
    bound = ", open at a bound" if value.open else ""
    return f"{value.name} {number} ({numbers[1]} to {numbers[2]}{bound})"


# Unmodelled causes in the words of a test engineer: a heat source, a heat path, an order nobody stated.

LAWS = {
    "constant": "the same at all operating points",
    "~n": "growing with the speed",
    "~n2": "growing with the square of the speed",
    "~T": "growing with the torque",
    "~T n": "growing with torque and speed",
    "~T above ambient": "growing with the temperature above ambient",
}
"""Law of a cause as `rigdesign.diagnosis.residual.hypotheses` writes it -> in words."""

PLACES = {
    "body": "in {0}",
    "rim": "in gear {0}",
    "bore": "in the bore of bearing {0}",
    "film": "in the oil film of bearing {0}",
    "oil": "in the oil {0}",
}
"""Kind of a place of heat -> in words."""

_HEAT = re.compile(r"(heat|heat unpaid) at (\w+):(.+?) (constant|~T n|~n2|~n)$")
_NEAR = re.compile(r"heat near (.+?) (constant|~T above ambient)$")
_PIPE = re.compile(r"heat in the (supply|drain) of (.+?) constant$")
_ORDER = re.compile(r"order (\S+) of (.+?) (constant|~n2|~T)$")


def in_words(cause: str, size: float = 0.0) -> str:
    """``heat unpaid at body:test.n2 ~n2`` -> what an engineer would call it; as it is where it is of no known kind.

    size : fitted amount, by its sign heat or cooling; 0 where it is not known
    """
    more, less = size > 0.0, size < 0.0
    if match := _HEAT.match(cause):
        kind, place, where, law = match.groups()
        source = f"{'cooling' if less else 'heat'} from outside the drive"
        if kind == "heat":
            source = "less power loss than modelled" if less else "power loss"
        return f"{source} {PLACES.get(place, 'at {0}').format(where)}, {LAWS[law]}"
    if match := _NEAR.match(cause):
        source = "heat source" if more else "draught" if less else "heat source or draught"
        return f"{source} near thermocouple {match[1]}, {LAWS[match[2]]}"
    if match := _PIPE.match(cause):
        return f"{'cooling' if less else 'heat'} in the {match[1]} line of {match[2]}"
    if match := _ORDER.match(cause):
        return f"order {match[1]} of {match[2]} without a known source, {LAWS[match[3]]}"
    if cause.startswith("conductance "):
        compared = "better than" if more else "worse than" if less else "other than"
        return f"heat path {compared} modelled: {_path(cause.removeprefix('conductance '))}"
    return cause


def place_of(cause: str) -> str:
    """Where a cause is, whatever its law: heat whether the motor pays for it or not, an order of a channel."""
    bare = cause.removeprefix(UNKNOWN)
    if match := _HEAT.match(bare):
        return f"{UNKNOWN}heat at {match[2]}:{match[3]}"
    if match := _NEAR.match(bare):
        return f"{UNKNOWN}heat near {match[1]}"
    if match := _ORDER.match(bare):
        return f"{UNKNOWN}order {match[1]} of {match[2]}"
    return cause


def _path(link: str) -> str:
    """``film:test.outer_warm`` -> film at test.outer_warm; ``contact:test.a|b`` -> contact from test.a to b."""
    kind, _, place = link.partition(":")
    first, _, second = place.partition("|")
    kind = kind.replace("_", " ")
    return f"{kind} from {first} to {second}" if second else f"{kind} at {first}"
