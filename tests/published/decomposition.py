"""P2's Figures 7 and 8 decomposed: what torsion, bending, corner gap and damping each do to K_V and torque amplitude.

Found by these rows:
 - Shafts that bend in the bearings of Table 1 are about as soft at the gears as the teeth: they lower every peak and
   move it up in speed.
 - The gap at the tip corners decides how hard deflected teeth come into mesh. Ours follows from the involutes. Twice
   it, with bending and a mesh damper on the closing rate of the contacts, gives 1.34, 1.24 and 1.22 in the three
   ranges, three times it 1.54, 1.28 and 1.29 (P2: above 1.5, 1.3, 1.2); neither bending nor gap nor damper does so
   alone. The reference gear, whose face comes into mesh gradually, stays at 1.00 at 12,000 rpm.
 - Modes in which the shafts of the test gears bend lie on the third and fourth mesh order between 750 and 1219 rpm, as
   P2 says, but raise K_V there by little: Table 1's 4e4 N s/m damp them.
 - Both halves of the double-helical gears, each under half of the torque, in place of the one that P2 models raise the
   largest K_V of the reference gear from 1.07 to 1.18 and change the test gear by 0.03.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from tests.published.prototype import Prototype
from tests.published.rows import Bound, PublishedQuantity, ValidationRow, compare
from tests.published.speed_sweeps import (
    FINE,
    MAIN,
    SUBCRITICAL,
    TOP_SPEED,
    SpeedSweep,
    bending_loop,
    closing,
    corner_gaps,
    damped,
    laws_of_both_halves,
    loop_modes_at,
    simulation_models,
    speed_sweep,
)

FIGURE_7, FIGURE_8 = "P2, Figure 7", "P2, Figure 8"
FIRST_RESONANCE = 1219.0
"""Speed below which P2 sees bending modes at work [rpm]."""
SLOWEST = 750.0
"""Lowest speed of P2's comparison [rpm]."""
TEETH = 99
BENDING_SHARE = 0.2
"""Of the strain energy of a mode, from which it counts as a bending mode of the shafts."""


@dataclass(frozen=True)
class Part:
    """One column: what the model has."""

    name: str
    text: str


PARTS = (
    Part("torsion", "shafts that only twist"),
    Part("torsion-corner-2", "shafts that only twist, twice the corner gap"),
    Part("bending", "six degrees of freedom with Table 1"),
    Part("corner-2", "six degrees of freedom, twice the corner gap"),
    Part("corner-3", "six degrees of freedom, three times the corner gap"),
    Part("damping-300", "six degrees of freedom, mesh damping 300 N s/m"),
    Part("corner-2-damping-300", "six degrees of freedom, twice the corner gap, mesh damping 300 N s/m"),
    Part("corner-2-closing-rate", "six degrees of freedom, twice the corner gap, damper on the closing rate"),
    Part("corner-3-closing-rate", "six degrees of freedom, three times the corner gap, damper on the closing rate"),
    Part("both-halves", "both halves of the double-helical gears"),
)  # fmt: skip


@dataclass(frozen=True)
class _Quantity:
    """A row of Figures 7 and 8: which mesh, where, what P2 prints."""

    name: str
    text: str
    mesh: int
    speeds: tuple[float, float]
    published: float | None
    printed: str
    bound: Bound | None = None
    amplitude: bool = False

    def of(self, sweep: SpeedSweep) -> tuple[float, str]:
        """Value and where it was found."""
        if self.amplitude:
            return sweep.amplitude(self.mesh, self.speeds)[0], ""
        value, speed = sweep.highest(self.mesh, self.speeds)
        return value, f"at {speed:.0f} rpm; "


QUANTITIES = (
    _Quantity("TG-sub", "K_V of the test gear, subcritical maximum", 0, SUBCRITICAL, 1.5, "above 1.5", "at least"),
    _Quantity("TG-main", "K_V of the test gear, main resonance", 0, MAIN, 1.3, "about 1.3"),
    _Quantity("TG-super", "K_V of the test gear, 12,000 rpm", 0, (TOP_SPEED, TOP_SPEED), 1.2, "about 1.2"),
    _Quantity("RG-main", "K_V of the reference gear, largest", 1, (SLOWEST, 4500.0), None, "no number"),
    _Quantity("RG-super", "K_V of the reference gear, 12,000 rpm", 1, (TOP_SPEED, TOP_SPEED), 1.008, "about 1.008"),
    _Quantity("TG-dM", "torque amplitude of the test gear, largest", 0, (SLOWEST, TOP_SPEED), 150.0,
              "up to about 150", None, True),
    _Quantity("RG-dM", "torque amplitude of the reference gear, largest", 1, (SLOWEST, TOP_SPEED), 50.0,
              "below 50", "at most", True),
)  # fmt: skip


def part_sweeps(prototype: Prototype) -> dict[str, SpeedSweep]:
    """Response over speed at 180 N m by name of the part, in the order of `PARTS`."""
    models = simulation_models(prototype)
    laws = [model.law for model in models]
    twice, thrice = corner_gaps(models, 2.0), corner_gaps(models, 3.0)
    loop = bending_loop(prototype.bending)
    runs = {
        "torsion": (laws, None),
        "torsion-corner-2": (twice, None),
        "bending": (laws, loop),
        "corner-2": (twice, loop),
        "corner-3": (thrice, loop),
        "damping-300": (damped(laws, 300.0), loop),
        "corner-2-damping-300": (damped(twice, 300.0), loop),
        "corner-2-closing-rate": (closing(twice), loop),
        "corner-3-closing-rate": (closing(thrice), loop),
        "both-halves": (laws_of_both_halves(prototype), bending_loop(prototype.both_halves)),
    }
    return {
        part.name: speed_sweep(prototype, runs[part.name][0], FINE, drivetrain=runs[part.name][1])
        for part in PARTS
    }


def decomposition_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """Every quantity of Figures 7 and 8 with every part, and the bending modes that P2 names."""
    sweeps = part_sweeps(prototype)
    for quantity in QUANTITIES:
        for part in PARTS:
            sweep = sweeps[part.name]
            value, where = quantity.of(sweep)
            yield compare(
                PublishedQuantity(
                    id=f"P2-part-{quantity.name}-{part.name}",
                    text=f"{quantity.text}: {part.text}",
                    source=FIGURE_7 if quantity.amplitude else FIGURE_8,
                    value=quantity.published,
                    printed=quantity.printed,
                    bound=quantity.bound,
                    unit="N m" if quantity.amplitude else "1",
                ),
                value,
                "predicted",
                assumptions=f"{where}a column of the decomposition, no goal{sweep.left_out(quantity.speeds)}",
            )
    yield from _bending_modes(prototype, sweeps)


def _bending_modes(prototype: Prototype, sweeps: dict[str, SpeedSweep]) -> Iterator[ValidationRow]:
    """Modes of the test shafts in bending on the third and fourth mesh order below the first resonance."""
    laws = [model.law for model in simulation_models(prototype)]
    modes = loop_modes_at(prototype.bending, 0.5 * (SLOWEST + FIRST_RESONANCE), laws)
    raised = sweeps["bending"].highest(0, (SLOWEST, FIRST_RESONANCE))[0]
    twisted = sweeps["torsion"].highest(0, (SLOWEST, FIRST_RESONANCE))[0]
    for order, word in ((3, "third"), (4, "fourth")):
        found = []
        for mode in modes:
            speed = 60.0 * mode.frequency / (order * TEETH)
            bent = sum(
                share
                for part, share in mode.energy.items()
                if part.startswith("test_") and part.endswith(" bending")
            )
            if SLOWEST <= speed <= FIRST_RESONANCE and bent >= BENDING_SHARE:
                found.append((speed, mode.frequency, mode.damping_ratio))
        listed = ", ".join(f"{f:.0f} Hz at {n:.0f} rpm, damping ratio {d:.2f}" for n, f, d in found)
        yield compare(
            PublishedQuantity(
                id=f"P2-bending-{order}",
                text=f"bending modes of the test shafts on the {word} mesh order between 750 and 1219 rpm",
                source="P2, text",
                printed="the 3rd and 4th f_z excite bending modes up to the first resonance",
                unit="1",
            ),
            float(len(found)),
            "predicted",
            assumptions=f"{listed or 'none'}; at least a fifth of the strain energy in bending of these shafts. "
            f"Highest K_V there {raised:.3f} with bending, {twisted:.3f} with shafts that only twist",
        )
