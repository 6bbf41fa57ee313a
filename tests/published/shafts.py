"""Rows of the drivetrain's audits: torsional frequencies, order crossings, damping, sampling.

Found by these rows:
 - P2's resonance 4 of the reference gear belongs to 4705 rpm by its own Table 2, above its "no resonances
   above 4000 rpm"; first-order crossings go on to 5847 rpm.
 - 40 kHz are 2.02 samples per mesh period at 12,000 rpm: the second mesh harmonic is above half the sample
   rate.
 - Crossings and response peaks follow from the frequencies of Table 2, to which the shafts are fitted: that they
   agree is no prediction.
 - The dampers of Table 1 bridge splines and couplings above 160 and 77 Hz (damping ratios of 9 to 22):
   these joints are rigid at every speed, so their stiffness cannot show and their damping is no detail.
 - One mesh damping for both gears is a damping ratio of about 0.12 in the test and 0.02 in the reference
   mesh.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.graph import Drivetrain
from dynamics.rotor.shaft import free_frequencies
from dynamics.rotor.torsional_modes import damping_audit, sampling_audit
from tests.published.prototype import RPM, Prototype
from tests.published.rows import Gate, PublishedQuantity, ValidationRow, Window, compare
from tests.published.speed_sweeps import TOP_SPEED, simulation_laws

Array = NDArray[np.float64]


def shaft_frequencies(drivetrain: Drivetrain, count: int = 3) -> dict[str, Array]:
    """First free-free torsional frequencies [Hz] of every shaft with its discs and gear bodies.

    A gear body counts as rigid with its shaft: the damper of a spline usually is far above its corner
    frequency there (see ``damping_audit``), and a stiff spline without damper hardly differs.
    """
    bodies: dict[str, list[tuple[float, float]]] = {shaft.name: [] for shaft in drivetrain.shafts}
    for gear in drivetrain.gears:
        bodies[gear.shaft].append((gear.position, gear.inertia))
    return {
        shaft.name: free_frequencies(shaft, tuple(bodies[shaft.name]), count) for shaft in drivetrain.shafts
    }


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """Speed at which a mesh order meets a natural frequency of a shaft.

    mesh, shaft : names; mode : 1, 2, 3 ...; frequency [Hz]; harmonic of the mesh frequency
    speed : of the pinion of that mesh [rad/s]
    """

    mesh: str
    shaft: str
    mode: int
    frequency: float
    harmonic: int
    speed: float


def order_crossings(
    drivetrain: Drivetrain,
    frequencies: Mapping[str, Array],
    highest_speed: float,
    harmonics: int = 3,
) -> tuple[Crossing, ...]:
    """All crossings up to a pinion speed [rad/s], by mesh, then by speed: 2 pi f / (z1 h).

    A shaft is crossed by the meshes whose pinion or wheel sits on it.
    """
    found = []
    for mesh in drivetrain.meshes:
        for shaft in (drivetrain.gear(mesh.pinion).shaft, drivetrain.gear(mesh.wheel).shaft):
            for mode, frequency in enumerate(frequencies[shaft], start=1):
                for harmonic in range(1, harmonics + 1):
                    speed = 2.0 * math.pi * float(frequency) / (mesh.teeth[0] * harmonic)
                    if speed <= highest_speed:
                        found.append(
                            Crossing(
                                mesh=mesh.name, shaft=shaft, mode=mode, frequency=float(frequency),
                                harmonic=harmonic, speed=speed,
                            )
                        )  # fmt: skip
    order = {mesh.name: i for i, mesh in enumerate(drivetrain.meshes)}
    return tuple(sorted(found, key=lambda c: (order[c.mesh], c.speed, c.shaft)))


TABLE_2 = {
    "test_pinion": (4022.7, 5657.2, 7776.4),
    "test_wheel": (5926.7, 9482.0, 12831.0),
    "reference_pinion": (4887.5, 7763.9, 9646.9),
    "reference_wheel": (3563.9, 5092.0, 6895.0),
}
"""Torsional frequencies [Hz]."""
SHAFT_PARAMETERS = 10
"""Free inputs of each shaft that were fitted to Table 2 (fit_shafts.py); what follows from it depends on them too."""

# (id, speed in rpm that follows from Table 2, shaft, mode, harmonic of the mesh frequency, P2's words)
CROSSINGS = (
    ("TG-2", 1219.0, "test_pinion", 1, 2, "test gear, resonance 2"),
    ("TG-3", 1796.0, "test_wheel", 1, 2, "test gear, resonance 3"),
    ("RG-1", 1481.0, "reference_pinion", 1, 2, "reference gear, resonance 1"),
    ("RG-2-wheel", 1543.0, "reference_wheel", 2, 2, "reference gear, resonance 2, wheel"),
    ("RG-2-h2", 2353.0, "reference_pinion", 2, 2, "reference gear, resonance 2, pinion by 2 f_z"),
    ("RG-2-h3", 1568.0, "reference_pinion", 2, 3, "reference gear, resonance 2, pinion by 3 f_z"),
    ("RG-3-h1", 2962.0, "reference_pinion", 1, 1, "reference gear, resonance 3, by f_z"),
    ("RG-3-h2", 2923.0, "reference_pinion", 3, 2, "reference gear, resonance 3, third mode by 2 f_z"),
    ("RG-4", 4705.0, "reference_pinion", 2, 1, "reference gear, resonance 4"),
)
REMARKS = {
    "RG-3-h1": "; P2 prints TG pinion, by the frequencies it must read RG pinion",
    "RG-4": "; contradicts P2's 'no resonances above 4000 rpm'",
}


def shaft_rows(prototype: Prototype) -> Iterator[ValidationRow]:
    """Table 2, the crossing list, damping ratios and the sampling audit."""
    drivetrain = prototype.simulated.drivetrain
    assert drivetrain is not None
    frequencies = shaft_frequencies(drivetrain)
    for shaft, printed in TABLE_2.items():
        for mode, published in enumerate(printed, start=1):
            yield compare(
                PublishedQuantity(
                    id=f"P2-T2-{shaft}-{mode}",
                    text=f"torsional frequency {mode}, shaft {shaft}",
                    source="P2, Table 2",
                    value=published,
                    unit="Hz",
                ),
                float(frequencies[shaft][mode - 1]),
                "fitted",
                Gate(0.02),
                free_parameters=SHAFT_PARAMETERS,
                assumptions="sections of the shafts are assumed and fitted to this table (fit_shafts.py)",
            )
    crossings = order_crossings(drivetrain, frequencies, TOP_SPEED * RPM)
    for identity, speed, shaft, mode, harmonic, text in CROSSINGS:
        yield compare(
            PublishedQuantity(
                id=f"P2-cross-{identity}",
                text=f"order crossing, {text}",
                source="P2, text and Table 2",
                value=speed,
                unit="rpm",
            ),
            _crossing(crossings, shaft, mode, harmonic) / RPM,
            "fitted",
            Gate(0.02),
            free_parameters=SHAFT_PARAMETERS,
            assumptions=f"60 f / (99 h), mode {mode} of shaft {shaft}, h = {harmonic}: follows from Table 2, to "
            f"which the shafts are fitted{REMARKS.get(identity, '')}",
        )
    highest = max((c for c in crossings if c.harmonic == 1), key=lambda crossing: crossing.speed)
    yield compare(
        PublishedQuantity(
            id="P2-cross-highest",
            text="highest crossing of a shaft frequency by f_z",
            source="P2, Table 2",
            printed="no resonances above 4000 rpm",
            unit="rpm",
        ),
        highest.speed / RPM,
        "fitted",
        free_parameters=SHAFT_PARAMETERS,
        assumptions=f"mode {highest.mode} of shaft {highest.shaft}; a crossing is no resonance yet, the "
        "response rows P2-free say what it does",
    )
    yield from _damping(prototype)
    audit = sampling_audit(drivetrain, _drive_speed(prototype), 40e3)[0]
    yield compare(
        PublishedQuantity(
            id="P2-sampling",
            text="samples per mesh period at 40 kHz and 12,000 rpm",
            source="P2, dynamic simulation",
            printed="tooth meshing reproduced with sufficient accuracy",
            unit="1",
        ),
        audit.samples_per_mesh,
        "arithmetic",
        Window(2.015, 2.025),
        assumptions=f"f_z = {audit.mesh_frequency:.0f} Hz; enough for one harmonic and no waveform; as an "
        "integration step it makes 68 % error, so the tool steps at least 8 times finer",
    )


def _crossing(crossings: Sequence[Crossing], shaft: str, mode: int, harmonic: int) -> float:
    """Speed [rad/s] of one entry of the crossing list."""
    return next(c.speed for c in crossings if (c.shaft, c.mode, c.harmonic) == (shaft, mode, harmonic))


def _drive_speed(prototype: Prototype) -> float:
    return prototype.simulated.drive_speed(TOP_SPEED * RPM)


def _damping(prototype: Prototype) -> Iterator[ValidationRow]:
    drivetrain = prototype.simulated.drivetrain
    assert drivetrain is not None
    records = damping_audit(drivetrain, simulation_laws(prototype))
    for record in records:
        joint = f"{record.kind} {record.name}"
        name = f"P2-damping-{record.kind}-{record.name}".replace(" ", "-")
        yield compare(
            PublishedQuantity(
                id=name,
                text=f"damping ratio, {joint}",
                source="P2, Table 1",
                printed="only a small influence of the damping values",
                unit="1",
            ),
            record.damping_ratio,
            "arithmetic",
            assumptions=f"corner frequency {record.corner_frequency:.3g} Hz, undamped it would resonate at "
            f"{record.own_frequency:.4g} Hz"
            + (": the damper makes the joint rigid" if record.warning else ""),
        )
