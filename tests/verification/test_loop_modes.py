"""Modes of the closed loop and their crossings against computations that share nothing with ours.

Frequencies: shafts as continua (dynamic stiffness of every cylinder, exact in the frequency), natural frequencies
counted by the sign changes of the assembled matrix (Wittrick and Williams, Q. J. Mech. Appl. Math. 24, 1971, 263).
Damping: the companion matrix of the assembled rig in a general eigenvalue solver.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import eigvals

from dynamics.rotor.graph import Drivetrain, assemble
from dynamics.rotor.torsional_modes import closed_matrices, loop_crossings, loop_modes
from dynamics.tooth.law import MeshLaw
from tests.builders.rig import prototype, prototype_laws

HIGHEST = 6e3
RPM = math.pi / 30.0


def undamped() -> tuple[Drivetrain, tuple[MeshLaw, MeshLaw]]:
    """The prototype with short elements and without any damper."""
    rig = prototype(element_length=0.004)
    laws = prototype_laws(friction=0.0, damping=0.0)
    rig = replace(
        rig,
        gears=tuple(replace(gear, damping=0.0) for gear in rig.gears),
        couplings=tuple(replace(coupling, damping=0.0) for coupling in rig.couplings),
    )
    return rig, laws


class Continuum:
    """Dynamic stiffness D(w) of the closed loop: a node at every step, disc, gear seat and end of its shafts."""

    def __init__(self, rig: Drivetrain, laws: tuple[MeshLaw, ...]) -> None:
        self.nodes: dict[tuple[str, int], int] = {}
        self.cylinders: list[tuple[int, int, float, float, float, float]] = []
        self.inertia: dict[int, float] = {}
        self.springs: list[tuple[dict[int, float], float]] = []
        for shaft in rig.shafts:
            steps = np.cumsum([0.0, *(section.length for section in shaft.sections)])
            places = {float(step) for step in steps} | {disc.position for disc in shaft.discs}
            places |= {gear.position for gear in rig.gears if gear.shaft == shaft.name}
            places |= {rig.motor.position} if rig.motor.shaft == shaft.name else set()
            ordered = sorted({round(1e6 * place) for place in places})
            for low, high in pairwise(ordered):
                middle = 0.5e-6 * (low + high)
                section = shaft.sections[int(np.searchsorted(steps, middle)) - 1]
                polar = math.pi * (section.outer_diameter**4 - section.inner_diameter**4) / 32.0
                ends = self.node(shaft.name, 1e-6 * low), self.node(shaft.name, 1e-6 * high)
                self.cylinders.append((*ends, 1e-6 * (high - low), polar, shaft.shear_modulus, shaft.density))
            for disc in shaft.discs:
                self.add(self.node(shaft.name, disc.position), disc.inertia)
        bodies = {}
        for gear in rig.gears:
            bodies[gear.name] = self.nodes.setdefault((gear.name, 0), len(self.nodes))
            self.add(bodies[gear.name], gear.inertia)
            self.springs.append(
                ({bodies[gear.name]: 1.0, self.node(gear.shaft, gear.position): -1.0}, gear.stiffness)
            )
        for coupling in rig.couplings:
            first, second = coupling.shafts
            a, b = self.node(first, rig.shaft(first).length), self.node(second, 0.0)
            self.springs.append(({a: 1.0, b: -1.0}, coupling.stiffness))
        self.add(self.node(rig.motor.shaft, rig.motor.position), rig.motor.inertia)
        for mesh, law in zip(rig.meshes, laws):
            ports = {bodies[mesh.pinion]: mesh.base_radii[0], bodies[mesh.wheel]: -mesh.base_radii[1]}
            self.springs.append((ports, law.mean_stiffness))

    def node(self, shaft: str, place: float) -> int:
        return self.nodes.setdefault((shaft, round(1e6 * place)), len(self.nodes))

    def add(self, node: int, inertia: float) -> None:
        self.inertia[node] = self.inertia.get(node, 0.0) + inertia

    def below(self, frequency: float) -> int:
        """How many natural frequencies lie below one [Hz]; every cylinder is far shorter than half a wave."""
        omega = 2.0 * math.pi * frequency
        matrix = np.zeros((len(self.nodes),) * 2)
        for a, b, length, polar, shear, density in self.cylinders:
            angle = omega * length * math.sqrt(density / shear)
            assert angle < math.pi
            scale = shear * polar / length * angle
            matrix[a, a] += scale / math.tan(angle)
            matrix[b, b] += scale / math.tan(angle)
            matrix[a, b] -= scale / math.sin(angle)
            matrix[b, a] -= scale / math.sin(angle)
        for node, inertia in self.inertia.items():
            matrix[node, node] -= omega**2 * inertia
        for ports, stiffness in self.springs:
            shape = np.zeros(len(self.nodes))
            shape[list(ports)] = list(ports.values())
            matrix += stiffness * np.outer(shape, shape)
        return int(np.sum(np.linalg.eigvalsh(matrix) < 0.0))

    def frequency(self, number: int, high: float) -> float:
        """The natural frequency with ``number`` others below it, by bisection."""
        low = 1e-3
        while high - low > 1e-3:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.below(middle) <= number else (low, middle)
        return 0.5 * (low + high)


def test_modes_of_the_closed_loop_are_those_of_continuous_shafts() -> None:
    """0.1 % to 6 kHz with elements of 4 mm, and as many modes."""
    rig, laws = undamped()
    found = [mode.frequency for mode in loop_modes(rig, laws, HIGHEST) if mode.frequency > 0.0]
    exact = Continuum(rig, laws)
    rigid = exact.below(1.0)
    assert rigid == 1
    assert exact.below(HIGHEST) - rigid == len(found) >= 6
    assert found == pytest.approx([exact.frequency(rigid + i, HIGHEST) for i in range(len(found))], rel=1e-3)


def test_the_loop_is_not_its_shafts() -> None:
    """Its lowest mode lies far below the lowest of the isolated shafts, 3564 Hz."""
    lowest = loop_modes(prototype(), prototype_laws(), HIGHEST)[1]
    assert lowest.frequency < 1000.0
    assert lowest.largest.split("/")[0] in {shaft.name for shaft in prototype().shafts}


def test_damping_ratios_are_those_of_the_companion_matrix() -> None:
    rig, laws = prototype(linear_drag=7e-4), prototype_laws()
    inertia, damping, stiffness = closed_matrices(assemble(rig), laws)
    n = len(inertia)
    companion = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [-np.linalg.solve(inertia, stiffness), -np.linalg.solve(inertia, damping)],
        ]
    )
    poles = eigvals(companion)
    poles = poles[(poles.imag > 1e-6 * np.abs(poles)) & (np.abs(poles) < 2.0 * math.pi * HIGHEST)]
    poles = poles[np.argsort(np.abs(poles))]
    modes = [mode for mode in loop_modes(rig, laws, HIGHEST) if mode.frequency > 0.0]
    assert [mode.frequency for mode in modes] == pytest.approx(np.abs(poles) / (2.0 * math.pi), rel=1e-6)
    assert [mode.damping_ratio for mode in modes] == pytest.approx(-poles.real / np.abs(poles), rel=1e-4)


def test_an_order_has_the_frequency_of_the_mode_where_it_meets_it() -> None:
    """z n h of a mesh, n h of a shaft; the wheels turn at 99/102 of the motor's line or faster by it."""
    rig, laws = prototype(), prototype_laws()
    modes = loop_modes(rig, laws, HIGHEST)
    top = 12000.0 * RPM
    found = loop_crossings(rig, modes, top)
    swinging = [mode for mode in modes if mode.frequency > 0.0]
    for crossing in found:
        assert 0.0 < crossing.speed <= top
        cycles = 99 if crossing.kind == "mesh" else 1
        met = crossing.own_speed / (2.0 * math.pi) * cycles * crossing.harmonic
        assert met == pytest.approx(swinging[crossing.mode - 1].frequency, rel=1e-12)
        assert crossing.damping_ratio == swinging[crossing.mode - 1].damping_ratio
    # the motor is on a wheel: pinions turn 102/99 times as fast
    pinion = next(c for c in found if c.source == "test")
    assert pinion.own_speed == pytest.approx(102.0 / 99.0 * pinion.speed)
    expected = sum(
        mode.frequency / (99 * h) * 2.0 * math.pi * 99.0 / 102.0 <= top
        for mode in swinging
        for h in (1, 2, 3, 4)
    )
    assert sum(c.source == "test" for c in found) == expected > 10
    # no shaft order reaches the lowest mode: three turns at 12,000 rpm are 600 Hz
    shafts = [c for c in loop_crossings(rig, modes, 5.0 * top) if c.kind == "shaft"]
    assert shafts and all(c.gain == 0.0 for c in shafts)
