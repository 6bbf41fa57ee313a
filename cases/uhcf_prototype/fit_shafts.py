"""Find stepped shafts whose free-free torsional frequencies are those of P2, Table 2.

P2 prints twelve frequencies and no shaft dimension. This script looks for four plausible shafts of five
cylinders each that have these frequencies, all four at once, so that they also fit together as a rig.

What counts as shaft: the five cylinders (steel, no bore), the coupling flange at the coupling end, and the
gear body as a rigid ring on the middle cylinder. The gear sits on a spline of 1e6 Nm/rad with 1e3 Nms/rad
(P2, Table 1): its corner frequency is 159 Hz, so above 3.5 kHz the damper carries the gear along as if it
were shrunk on (damping ratio about 22 for the test pinion). It is therefore counted as rigidly attached.

Layout, outboard end first: journal, shoulder, gear seat, shoulder, journal with coupling end. Journals are
40 mm. Both shafts of a gearbox have their bearings in common planes, and the gear-to-gear distance of the
pinion line equals that of the wheel line, whose coupling is longer by the torque flange.

Twelve numbers are met with 40 free ones: the dimensions are an assumption that reproduces Table 2, not a
finding. `python cases/uhcf_prototype/fit_shafts.py` takes about half a minute, gives the same result every
time and prints a TOML fragment.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from dynamics.rotor.shaft import STEEL_DENSITY, Disc, Section, Shaft, free_frequencies

Array = NDArray[np.float64]

JOURNAL_DIAMETER = 40.0
BEARING_WIDTH = 30.0
COUPLING_LENGTH = {"pinion": 40.0, "wheel": 70.0}
"""Distance between the shaft ends [mm]: the wheel coupling holds the torque flange."""


@dataclass(frozen=True)
class Target:
    """One shaft of Table 2: frequencies [Hz], gear body diameter and width [mm], wanted flange inertia."""

    name: str
    line: str
    box: str
    frequencies: tuple[float, float, float]
    gear_diameter: float
    gear_width: float
    shortest_seat: float
    flange_inertia: float


TARGETS = (
    Target("test_pinion", "pinion", "test", (4022.7, 5657.2, 7776.4), 99.0, 7.0, 30.0, 0.35e-3),
    Target("test_wheel", "wheel", "test", (5926.7, 9482.0, 12831.0), 101.0, 15.0, 30.0, 0.45e-3),
    Target("reference_pinion", "pinion", "reference", (4887.5, 7763.9, 9646.9), 98.0, 40.0, 50.0, 0.35e-3),
    Target("reference_wheel", "wheel", "reference", (3563.9, 5092.0, 6895.0), 101.0, 40.0, 50.0, 0.45e-3),
)
LENGTHS, DIAMETERS, FLANGE = slice(0, 5), slice(5, 8), 8
SIZE = 9
"""Unknowns of a shaft: five lengths, three middle diameters [mm], flange inertia [1e-3 kg m2]."""


def gear_inertia(target: Target, seat_diameter: float) -> float:
    """Inertia of the solid steel ring between seat and gear diameter [kg m2] (diameters in mm)."""
    outer, bore = target.gear_diameter * 1e-3, seat_diameter * 1e-3
    return math.pi / 32.0 * STEEL_DENSITY * target.gear_width * 1e-3 * (outer**4 - bore**4)


def build(target: Target, p: Array, element_length: float) -> tuple[Shaft, float, float]:
    """Shaft from its unknowns, with the position [m] and inertia [kg m2] of its gear, coupling end last."""
    diameters = [JOURNAL_DIAMETER, *p[DIAMETERS], JOURNAL_DIAMETER]
    sections = tuple(
        Section(length=float(length) * 1e-3, outer_diameter=float(diameter) * 1e-3)
        for length, diameter in zip(p[LENGTHS], diameters)
    )
    end = math.fsum(section.length for section in sections)
    flange = Disc(name="coupling flange", position=end, inertia=float(p[FLANGE]) * 1e-3)
    shaft = Shaft(name=target.name, sections=sections, discs=(flange,), element_length=element_length)
    seat = float(p[0] + p[1] + 0.5 * p[2]) * 1e-3
    return shaft, seat, gear_inertia(target, float(p[6]))


def frequencies(target: Target, p: Array, element_length: float = 0.004) -> Array:
    """First three free-free frequencies [Hz] with the gear rigidly attached."""
    shaft, position, inertia = build(target, p, element_length)
    return free_frequencies(shaft, ((position, inertia),))


def split(x: Array) -> tuple[list[Array], Array]:
    """Unknowns of the four shafts and the four distances gear to bearing plane [mm]."""
    return [x[i * SIZE : (i + 1) * SIZE] for i in range(4)], x[4 * SIZE :]


def residuals(x: Array) -> Array:
    """Weighted misfit: frequencies (1e-4 counts 1), common planes, then a light pull to usual dimensions."""
    shafts, planes = split(x)
    usual_lengths, usual_diameters = np.array([45.0, 35.0, 45.0, 45.0, 60.0]), np.array([48.0, 52.0, 48.0])
    out = []
    spans = {"pinion": 0.0, "wheel": 0.0}
    for target, p in zip(TARGETS, shafts):
        out.append((frequencies(target, p) / np.array(target.frequencies) - 1.0) * 1e4)
        outboard, inboard = planes[:2] if target.box == "test" else planes[2:]
        half = 0.5 * p[2]
        room = np.array(
            [
                outboard - half - p[1],
                half + p[1] + p[0] - outboard,
                inboard - half - p[3],
                half + p[3] + p[4] - inboard,
            ]
        )
        out.append(np.minimum(room - 0.5 * BEARING_WIDTH, 0.0) * 10.0)
        spans[target.line] += half + p[3] + p[4]
        out.append((p[LENGTHS] - usual_lengths) / 40.0 * 0.1)
        out.append((p[DIAMETERS] - usual_diameters) / 15.0 * 0.1)
        out.append(np.array([math.log(p[FLANGE] * 1e-3 / target.flange_inertia) * 0.1]))
    gap = spans["pinion"] + COUPLING_LENGTH["pinion"] - spans["wheel"] - COUPLING_LENGTH["wheel"]
    out.append(np.array([gap * 10.0]))
    return np.concatenate(out)


def fit(starts: int = 6) -> Array:
    """Best of several fixed starting points; dimensions in mm rounded to 0.01, flange to 1e-6 kg m2."""
    lower, upper = [], []
    for target in TARGETS:
        lower += [30.0, 30.0, target.shortest_seat, 30.0, 30.0, 36.0, 36.0, 36.0, 0.10]
        upper += [140.0] * 5 + [65.0, 60.0, 65.0, 1.5]
    low, high = np.array([*lower, 50.0, 50.0, 50.0, 50.0]), np.array([*upper, 200.0, 200.0, 200.0, 200.0])
    draw = np.random.default_rng(2024)
    best, best_cost = low, math.inf
    for _ in range(starts):
        start = low + (high - low) * (0.15 + 0.5 * draw.random(low.size))
        found = least_squares(residuals, start, bounds=(low, high), max_nfev=150)
        if found.cost < best_cost:
            best, best_cost = np.asarray(found.x), float(found.cost)
    return rounded(best)


def rounded(x: Array) -> Array:
    """Lengths and diameters to even hundredths of a mm, so that half a seat is one too."""
    out = np.round(x / 0.02) * 0.02
    for i in range(4):
        out[i * SIZE + FLANGE] = round(x[i * SIZE + FLANGE], 3)
    return np.asarray(out)


def fragment(x: Array) -> str:
    """TOML of the four shafts in the order of the case file, with the resulting frequencies as comments.

    Shafts of the test gearbox run from the outboard end to the coupling, those of the reference gearbox from
    the coupling outwards, so that positions grow in one direction along either line.
    """
    shafts, planes = split(x)
    lines = ["# printed by fit_shafts.py"]
    for target, p in zip(TARGETS, shafts):
        diameters = [JOURNAL_DIAMETER, *p[DIAMETERS], JOURNAL_DIAMETER]
        pairs = list(zip(p[LENGTHS], diameters))
        total = float(sum(p[LENGTHS]))
        seat = float(p[0] + p[1] + 0.5 * p[2])
        outboard, inboard = planes[:2] if target.box == "test" else planes[2:]
        places = {"gear": seat, "outboard": seat - outboard, "inboard": seat + inboard, "flange": total}
        if target.box == "reference":
            pairs.reverse()
            places = {name: total - place for name, place in places.items()}
        got = frequencies(target, p, 0.001)
        worst = float(np.max(np.abs(got / np.array(target.frequencies) - 1.0)))
        lines += [
            "",
            f"# {target.name}: {', '.join(f'{f:.1f}' for f in got)} Hz, Table 2 within {worst:.2%}",
            "[[drivetrain.shafts]]",
            f'name = "{target.name}"',
            "sections = [",
            *(f'    {{ length = "{a:.2f} mm", outer_diameter = "{b:.2f} mm" }},' for a, b in pairs),
            "]",
            f'discs = [{{ name = "coupling flange", position = "{places["flange"]:.2f} mm", '
            f'inertia = "{p[FLANGE] * 1e-3:.6f} kg m^2" }}]',
            f'gear = {{ position = "{places["gear"]:.2f} mm", bore_diameter = "{p[6]:.2f} mm", '
            f'inertia = "{gear_inertia(target, float(p[6])):.6e} kg m^2" }}',
            f'bearings = [{{ name = "outboard", position = "{places["outboard"]:.2f} mm" }}, '
            f'{{ name = "inboard", position = "{places["inboard"]:.2f} mm" }}]',
        ]
    return "\n".join(lines)


if __name__ == "__main__":
    print(fragment(fit()))
