"""The page of effects, made from the catalogue: what can be named, with bounds and signature, and what waits."""

import sys
from collections.abc import Sequence
from pathlib import Path

from rigdesign.case import load_case
from rigdesign.case.model import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect, Parameter
from rigdesign.diagnosis.catalogue.not_modelled import WAITING
from rigdesign.diagnosis.decision.naming import display_scale
from rigdesign.diagnosis.residual.sensors import TIMES

HEAD = """# Effects that a diagnosis can name

Written by `python -m tests.builders.effects_page CASE ...`; do not edit by hand.

`rigdesign diagnose` names an effect of this page, a group that the data cannot separate, or nothing. An entry is named
`kind:place`. It changes the case, and the ordinary model computes what follows; bounds are physical limits,
the healthy spread is the scatter of healthy rigs. An effect that healthy rigs do not have is named from the size on
that matters. Effects whose signatures correlate above 0.95 form a group, and a named effect has to close the gap on
operating points that were held out. Which of them a measurement can detect and separate is in its report. Effects of
shafts that bend (unbalance, bow, flanges, cross joints, bearings and their supports) are evaluated where the set has
accelerations or shaft displacements.
"""

SENSORS = (
    ("sensor_offset:<channel>", "offset of a channel", "constant over all points"),
    (
        "sensor_scale:<channel>",
        "scale error of a channel; of a thermocouple of its excess over ambient (fin error)",
        "grows with the reading",
    ),
    ("torque_zero:<channel>", "zero of a torque or angle channel", "mean only, the same at any torque"),
    (
        "torque_lag:<channel>",
        "first-order lag of a torque cell or its amplifier that the measurement does not state",
        "orders fade and fall behind the more the higher their frequency, the mean stays",
    ),
    (
        "gauge_factor:<channel>",
        "gauge factor of a root gauge",
        "one gauge alone, in proportion to its strain",
    ),
    (
        "gauge_zero:<channel>, gauge_thermal_output:<channel>, gauge_centrifugal:<gear>",
        "zero of a root gauge, its thermal output, strain by rotation",
        "strain of the unloaded tooth alone: constant, with the oil temperature, with n^2 at all gauges of the gear",
    ),
    ("angle_zero", "index pulse offset", "phase of all orders shifted in proportion to the order"),
    (
        "inlet_offset:<stream>, inlet_scale:<stream>",
        "error of the inlet temperature of an oil stream",
        "all surfaces wetted by the stream, and its outlet",
    ),
    (
        "flow_offset:<stream>, flow_scale:<stream>",
        "error of the flow of an oil stream",
        "oil rise against losses",
    ),
    ("ambient", "error of the room temperature", "all outer surfaces of the housing"),
    (
        "speed_offset, speed_scale, torque_offset, torque_scale",
        "error of speed or torque",
        "losses and mesh orders together",
    ),
    ("swapped_channels:<a>,<b>", "two channels exchanged", "each fits the other's prediction"),
    (
        "swapped_points:<a>,<b>",
        "readings of two operating points exchanged",
        "each fits the other's prediction",
    ),
    (
        "unit:<channel>",
        "channel in another unit or with the wrong sign",
        "a factor or shift outside of sensor errors",
    ),
)
"""Entries of sensors and settings: name, words, signature."""


def effects_page(cases: Sequence[Case]) -> str:
    """The page in Markdown, from the entries that these cases have."""
    kinds: dict[str, tuple[Effect, set[str]]] = {}
    for case in cases:
        for effect in effects_of(case, channels=None):
            kinds.setdefault(effect.kind, (effect, set()))[1].add(case.name)
    lines = [HEAD, "## In the case\n"]
    lines += _table(
        (
            "kind",
            "example",
            "parameters and bounds",
            "healthy spread",
            "matters from",
            "how it shows",
            "cases that have it",
        ),
        [
            (
                f"`{kind}`",
                f"`{effect.name}`: {effect.title}",
                "; ".join(_bounds(parameter) for parameter in effect.parameters[:1]) + _more(effect),
                _size(effect, effect.healthy),
                _size(effect, effect.matters),
                effect.signature,
                ", ".join(case.name for case in cases if case.name in names),
            )
            for kind, (effect, names) in kinds.items()
        ],
    )
    sources = dict.fromkeys(
        parameter.source for effect, _ in kinds.values() for parameter in effect.parameters
    )
    lines.append(f"Bounds: {'; '.join(sources)}.\n")
    lines.append("## In the measurement\n")
    lines.append(
        f"Sizes up to {TIMES:g} times the stated systematic uncertainty are admitted. They do not change "
        "the case and are written to `measurement.patch.json`.\n"
    )
    lines += _table(("entry", "what", "how it shows"), [(f"`{name}`", *words) for name, *words in SENSORS])
    lines.append("## Not modelled yet\n")
    lines.append("Their effect is reported as located but unknown, or is not detected.\n")
    lines += _table(
        ("effect", "what", "how it shows", "what is required"),
        [(f"`{one.name}`", one.title, one.signature, one.lacks) for one in WAITING if one.name not in kinds],
    )
    return "\n".join(lines).rstrip() + "\n"


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return [*lines, *(f"| {' | '.join(row)} |" for row in rows), ""]


def _bounds(parameter: Parameter) -> str:
    scale, unit = display_scale(parameter.unit, parameter.factor)
    name = parameter.name.removesuffix(" along cosine")
    ends = f"{scale * parameter.low:.3g} to {scale * parameter.high:.3g}"
    return f"{name} x {ends}" if parameter.factor else f"{name} {ends} {unit}"


def _more(effect: Effect) -> str:
    """What an entry leaves open apart from its size."""
    if len(effect.parameters) == 2:
        return " along cosine and sine: phase free"
    return ", any tooth" if effect.any_tooth else ""


def _size(effect: Effect, size: float) -> str:
    """A size of the first parameter, a dash for zero."""
    if size == 0.0:
        return "–"
    parameter = effect.parameters[0]
    if parameter.factor:
        return f"{100.0 * size:.3g} %"
    scale, unit = display_scale(parameter.unit, False)
    return f"{scale * size:.3g} {unit}"


if __name__ == "__main__":
    sys.stdout.write(effects_page([load_case(Path(name)) for name in sys.argv[1:]]))
