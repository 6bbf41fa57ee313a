"""Contact forces beyond first order over the cycle of a gear with unequal teeth.

Over the turns after which the same tooth of the gear stands at the same place of the mesh period, the true torques of
the teeth along the motion found so far, less the tangents times its change, are forces on the linear equations that
give the next motion: Newton's method with the tangent of the equal teeth, accelerated. Gears of the same cycle are
taken together; gears of different cycles each alone, so that their joint effect beyond first order is left
out.
"""

from collections.abc import Sequence
from math import gcd
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from dynamics.mesh.force import evaluate_mesh
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.tables import pack_meshes
from dynamics.orders.hill_system import ClassSolution, MeshPeriodic
from dynamics.orders.tooth_excitation import Motion
from dynamics.orders.tooth_forcing import ToothForcing
from dynamics.response.harmonic_equations import input_torques

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

REACH = 12
"""Mesh harmonics on both sides in the corrections."""
CONVERGED = 1e-2
"""Change of the approach, relative to its whole deviation, at which the corrections end [-]."""
HISTORY = 8
"""Earlier answers that the next motion is combined from (Anderson)."""


class CycleForces(NamedTuple):
    """Forces of the gears of one cycle on the linear equations, tooth deviations included.

    cells : mesh periods in the cycle; spectrum : (n_meshes, k, cells n) two-sided, order j / cells of the cell at j
    change : by which the approach still moved in the last step, relative to its whole deviation [-]
    """

    cells: int
    spectrum: Complex
    change: float

    def of_class(self, residue: float, number: Integers) -> Complex:
        """Forces of a class (n_meshes, k, n_number); zero where the cycle has no such orders."""
        share = residue * self.cells
        if abs(share - round(share)) > 1e-6:
            return np.zeros((*self.spectrum.shape[:2], number.size), complex)
        place = number * self.cells + round(share)
        inside = np.abs(place) < self.spectrum.shape[-1] // 2
        return np.asarray(np.where(inside, self.spectrum[..., place % self.spectrum.shape[-1]], 0.0))


def cycle_forces(loop: MeshPeriodic, forcing: ToothForcing, steps: int) -> tuple[CycleForces, ...]:
    """Forces beyond first order of every group of gears with unequal teeth.

    loop : motion with equal teeth and its tangents
    forcing : forces of the tooth deviations, first order
    steps : corrections at most, at least 1; they end when the approach changes by less than CONVERGED
    """
    groups: dict[int, list[tuple[int, int]]] = {}
    for m, side in forcing.gears:
        teeth = (forcing.laws[m].teeth_1, forcing.laws[m].teeth_2)[side]
        groups.setdefault(teeth // gcd(teeth, int(loop.meshes[m])), []).append((m, side))
    return tuple(_Cycle(loop, forcing, cells, gears).run(steps) for cells, gears in groups.items())


class _Cycle:
    """The loop over one cycle, sampled in phi."""

    def __init__(
        self, loop: MeshPeriodic, forcing: ToothForcing, cells: int, gears: list[tuple[int, int]]
    ) -> None:
        self.loop, self.cells = loop, cells
        self.reach = min(REACH, (loop.samples - 1) // 4)
        self.n = loop.samples
        self.packed = [
            pack_meshes([_with_teeth(loop.ideal[m], forcing.laws[m], gears, m)])
            for m in range(len(loop.ideal))
        ]
        self.waves = np.tile(loop.waves, cells)
        cell = np.repeat(np.arange(cells), self.n) * 2.0 * np.pi
        self.base = []
        for law, meshes, motion in zip(loop.ideal, loop.meshes, loop.motions):
            angle, *others = (np.tile(values, cells) for values in motion)
            self.base.append(Motion(angle + cell * (meshes / law.teeth_1), *others))
        known = np.empty((*loop.inputs.shape, self.n))
        for m, packed in enumerate(loop.packed):
            reaction = evaluate_mesh(packed, *(values[: self.n] for values in self.base[m]))
            known[m] = [torque for torque, *_ in input_torques(loop.model, m, reaction)]
        self.known = np.tile(known, cells)
        number = np.arange(-self.reach, self.reach + 1)
        self.number = number
        classes = np.arange(cells // 2 + 1) / cells
        self.systems = loop.classes(classes.tolist(), self.reach)
        self.first = np.zeros((classes.size, *loop.inputs.shape, number.size), complex)
        for m, side in gears:
            self.first[:, m] += forcing.of_cycle(m, side, cells, number)

    def run(self, steps: int) -> CycleForces:
        """Correct the forces until the motion stays, at most so many times."""
        count = self.cells * self.n
        order = np.fft.fftfreq(count, 1.0 / count) / self.cells
        shift = np.exp(-1j * order * self.loop.cell_order * self.loop.start) / count
        classes = np.arange(self.cells // 2 + 1) / self.cells
        motion = self._answer(self.first)
        mixing = _Mixing()
        result = CycleForces(self.cells, np.zeros(0, complex), np.inf)
        for _ in range(steps):
            spectrum = np.fft.fft(self._beyond(*motion), axis=-1) * shift
            result = CycleForces(self.cells, spectrum, 0.0)
            answer = self._answer([result.of_class(float(residue), self.number) for residue in classes])
            moved, whole = (float(np.abs(values).max()) for values in (answer[0] - motion[0], answer[0]))
            result = result._replace(change=moved / max(whole, 1e-300))
            if result.change < CONVERGED:
                break
            motion = mixing.next(motion, answer)
        return result

    def _answer(self, forces: Sequence[Complex] | Complex) -> Array:
        """Motion that forces of every class (n_classes, n_meshes, k, n_number) make, see `_in_time`."""
        nothing = np.zeros((self.loop.n_inputs, self.number.size), complex)
        return self._in_time(
            [system.solve(of_class, nothing) for system, of_class in zip(self.systems, forces)]
        )

    def _in_time(self, found: Sequence[ClassSolution]) -> Array:
        """Changes of approach, its rate, pinion angle and pinion speed over the cycle (4, n_meshes, count)."""
        loop, count = self.loop, self.cells * self.n
        spectra = np.zeros((4, len(loop.ideal), count), complex)
        for j, (system, solution) in enumerate(zip(self.systems, found)):
            place = self.number * self.cells + j
            values = np.stack(
                (
                    solution.approach,
                    1j * system.omega * solution.approach,
                    solution.angle,
                    1j * system.omega * solution.angle,
                )
            )
            spectra[..., place % count] = values
            if j > 0 and 2 * j != self.cells:
                spectra[..., -place % count] = values.conj()
        order = np.fft.fftfreq(count, 1.0 / count) / self.cells
        shifted = spectra * np.exp(1j * order * loop.cell_order * loop.start)
        return np.asarray(np.fft.ifft(shifted, axis=-1).real * count)

    def _beyond(self, approach: Array, rate: Array, angle: Array, speed: Array) -> Array:
        """True torques less those of equal teeth and tangents times change (n_meshes, k, count)."""
        forces = np.empty(self.known.shape)
        for m, (law, packed) in enumerate(zip(self.loop.ideal, self.packed)):
            theta_1, reach, omega_1, omega_2 = self.base[m]
            slower = (law.base_radius_1 * speed[m] - rate[m]) / law.base_radius_2
            reaction = evaluate_mesh(
                packed, theta_1 + angle[m], reach + approach[m], omega_1 + speed[m], omega_2 + slower
            )
            forces[m] = [torque for torque, *_ in input_torques(self.loop.model, m, reaction)]
        linear = (
            self.waves[0] * approach[:, None] + self.waves[1] * rate[:, None] + self.waves[2] * angle[:, None]
        )
        return np.asarray(forces - self.known - linear)


class _Mixing:
    """Next motion from the ones before and their answers (D. G. Anderson, J. ACM 12, 1965).

    Where a tooth is much weaker than the mean the plain step comes closer by a share only.
    """

    def __init__(self) -> None:
        self._before: list[tuple[Array, Array]] = []

    def next(self, motion: Array, answer: Array) -> Array:
        """Combination of the answers whose approach would be missed least."""
        miss = (answer - motion)[0].ravel()
        self._before = [*self._before, (answer, miss)][-HISTORY:]
        if len(self._before) == 1:
            return answer
        steps = np.array([miss - old for _, old in self._before[:-1]])
        shares = np.linalg.lstsq(steps @ steps.T, steps @ miss, rcond=1e-10)[0]
        return np.asarray(
            answer - sum(share * (answer - old) for share, (old, _) in zip(shares, self._before[:-1]))
        )


def _with_teeth(ideal: MeshLaw, law: MeshLaw, gears: list[tuple[int, int]], m: int) -> MeshLaw:
    """The law in which only the teeth of some gears deviate from their mean."""
    if (m, 0) in gears:
        ideal = ideal._replace(
            deviation_1=_from_mean(law.deviation_1), back_deviation_1=_from_mean(law.back_deviation_1),
            scale_1=law.scale_1 / law.scale_1.mean(),
        )  # fmt: skip
    if (m, 1) in gears:
        ideal = ideal._replace(
            deviation_2=_from_mean(law.deviation_2), back_deviation_2=_from_mean(law.back_deviation_2),
            scale_2=law.scale_2 / law.scale_2.mean(),
        )  # fmt: skip
    return ideal


@overload
def _from_mean(table: Array) -> Array: ...


@overload
def _from_mean(table: None) -> None: ...


def _from_mean(table: Array | None) -> Array | None:
    """What each tooth deviates from the mean of all."""
    return None if table is None else np.asarray(table - table.mean(axis=0))
