"""Speeds at which a mesh or shaft order meets a mode of the closed loop.

Crossings of isolated shafts (`modes.order_crossings`, P2's way) tell which shaft would oscillate alone; what is
measured on the rig are the modes of the assembled loop: couplings, meshes and the bracing close it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from dynamics.drivetrain.graph import Drivetrain
from dynamics.drivetrain.modes import LoopMode
from dynamics.drivetrain.power_loop import speed_ratios


@dataclass(frozen=True, kw_only=True)
class LoopCrossing:
    """An order that meets a mode of the closed loop.

    source : mesh or shaft whose order it is; kind : which of the two
    mode : number of the mode, 1 for the lowest that oscillates
    harmonic : of the mesh frequency, or order of the shaft speed
    speed : at which they meet, of the motor's shaft; own_speed : of the pinion of the mesh, or of the shaft [rad/s]
    gain : `LoopMode.mesh_gain` of the mesh [-]; 0 for a shaft, which excites by its errors only
    """

    source: str
    kind: Literal["mesh", "shaft"]
    mode: int
    harmonic: int
    frequency: float
    damping_ratio: float
    speed: float
    own_speed: float
    gain: float


@dataclass(frozen=True)
class _Order:
    """First order of a mesh or shaft: turns of its frequency per turn of the motor, own speed per motor speed."""

    source: str
    kind: Literal["mesh", "shaft"]
    cycles: float
    ratio: float
    mesh: int


def loop_crossings(
    drivetrain: Drivetrain,
    modes: Sequence[LoopMode],
    highest_speed: float,
    mesh_harmonics: int = 4,
    shaft_harmonics: int = 3,
) -> tuple[LoopCrossing, ...]:
    """All crossings up to a speed of the motor's shaft [rad/s], meshes first, each by speed: w = 2 pi f / (h c).

    c is the number of cycles of the order per turn of the motor's shaft. Modes without a frequency are left out.
    """
    oscillating = [mode for mode in modes if mode.frequency > 0.0]
    found = []
    for order in _orders(drivetrain):
        own = []
        harmonics = mesh_harmonics if order.kind == "mesh" else shaft_harmonics
        for number, mode in enumerate(oscillating, start=1):
            for harmonic in range(1, harmonics + 1):
                speed = 2.0 * math.pi * mode.frequency / (harmonic * order.cycles)
                if speed <= highest_speed:
                    own.append(
                        LoopCrossing(
                            source=order.source,
                            kind=order.kind,
                            mode=number,
                            harmonic=harmonic,
                            frequency=mode.frequency,
                            damping_ratio=mode.damping_ratio,
                            speed=speed,
                            own_speed=speed * order.ratio,
                            gain=float(mode.mesh_gain[order.mesh]) if order.kind == "mesh" else 0.0,
                        )
                    )
        found += sorted(own, key=lambda crossing: (crossing.speed, crossing.mode))
    return tuple(found)


def _orders(drivetrain: Drivetrain) -> Iterator[_Order]:
    ratios = speed_ratios(drivetrain)
    for index, mesh in enumerate(drivetrain.meshes):
        ratio = ratios[drivetrain.gear(mesh.pinion).shaft]
        yield _Order(mesh.name, "mesh", mesh.teeth[0] * ratio, ratio, index)
    for shaft in drivetrain.shafts:
        yield _Order(shaft.name, "shaft", ratios[shaft.name], ratios[shaft.name], -1)
