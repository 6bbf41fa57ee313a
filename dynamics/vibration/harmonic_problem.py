"""What a harmonic balance solves: the loop with its load, the grid of frequencies and samples, the coefficients."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.linear_system import ModalForm
from dynamics.rotor.parts import PeriodicLoad, harmonic_loads
from dynamics.rotor.static_loop import LoopLoad, PortModel

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class HarmonicGrid:
    """Frequencies and samples of one period.

    cells : mesh periods in the period; harmonics : per mesh frequency; samples : per mesh period
    cell_angle : rotation of the drive freedom over one mesh period [rad]
    """

    cells: int
    harmonics: int
    samples: int
    cell_angle: float

    @property
    def top(self) -> int:
        """Highest harmonic of the base frequency."""
        return self.cells * self.harmonics

    @property
    def count(self) -> int:
        """Samples in the period."""
        return self.cells * self.samples


@dataclass(frozen=True, kw_only=True)
class HarmonicSolution:
    """Coefficients of a periodic state, ``q(t) = sum over k of q_k exp(i k w t)``, k from -top to top.

    ports : (n_bodies, top + 1) one-sided windup of the gear bodies that mesh [rad]
    twist [rad], drive [N m]; residual : largest error of the approach over its mean; iterations : Newton
    steps
    """

    grid: HarmonicGrid
    speed: float
    ports: Complex
    twist: float
    drive: float
    residual: float
    iterations: int


@dataclass(frozen=True, kw_only=True)
class BalanceProblem:
    """Everything that stays the same over speed.

    load : mean torque asked of a mesh, or the twist that is held
    periodic_loads : of the drivetrain, that alternate with the rotation of a shaft
    ratios : (n,) speed of each freedom of the drivetrain per speed of the drive freedom
    """

    model: PortModel
    form: ModalForm
    load: LoopLoad
    periodic_loads: tuple[PeriodicLoad, ...] = ()
    ratios: Array | None = None

    @cached_property
    def into(self) -> Complex:
        """(n_states, n_inputs) modal loads of unit torques on the inputs of the meshes (`mesh_inputs`)."""
        return self.form.into(self.model.loads)

    def driven(self, grid: HarmonicGrid, base: float) -> Complex:
        """Windup of the mesh bodies (n_bodies, top + 1) that the periodic loads would make without the meshes.

        Their angle is zero where that of the first pinion would be without windup.
        """
        n_bodies = self.model.n_bodies
        motion = np.zeros((n_bodies, grid.top + 1), complex)
        if self.ratios is None:
            return motion
        turns = grid.cell_angle * grid.cells / (2.0 * np.pi)
        loads = harmonic_loads(self.periodic_loads, self.ratios, turns, turns * base)
        for harmonic, load in loads.items():
            if harmonic <= grid.top:
                loaded = np.flatnonzero(load)
                dofs = np.concatenate((self.model.dofs[:n_bodies], loaded))
                gain = self.form.receptance(np.array([harmonic * base]), dofs)[0, :n_bodies, n_bodies:]
                motion[:, harmonic] = 0.5 * gain @ load[loaded]
        return motion

    @property
    def approach_scale(self) -> float:
        """Approach that counts as one [m]: a mesh under 1 % of the nominal torque at least."""
        law = self.model.laws[self.load.control_mesh]
        torque = abs(self.load.torque) if self.load.torque else 1.0
        return max(torque, 1.0) / law.base_radius_1 / law.mean_stiffness


def resample(solution: HarmonicSolution, grid: HarmonicGrid) -> HarmonicSolution:
    """The same state on another grid: mesh harmonics are kept, the rest is dropped or zero.

    Its residual is infinite and its iterations are 0: it is a start, not a solution.
    """
    ports = np.zeros((solution.ports.shape[0], grid.top + 1), complex)
    if solution.grid.cells == grid.cells:
        count = min(solution.grid.top, grid.top) + 1
        ports[:, :count] = solution.ports[:, :count]
    else:
        count = min(solution.grid.harmonics, grid.harmonics) + 1
        ports[:, : count * grid.cells : grid.cells] = solution.ports[:, :: solution.grid.cells][:, :count]
    return HarmonicSolution(
        grid=grid, speed=solution.speed, ports=ports, twist=solution.twist, drive=solution.drive,
        residual=np.inf, iterations=0,
    )  # fmt: skip
