"""One period of a harmonic solution in time: motions, torques and losses of every mesh."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.static_loop import PortModel
from dynamics.mesh.force import evaluate_mesh
from dynamics.response.harmonic_equations import in_time, motion_of_mesh
from dynamics.response.harmonic_problem import HarmonicSolution

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Waveform:
    """One period in time at the mean speed of the drive freedom.

    time : (n,) [s]; angle : (n_meshes, n) pinion angle; approach [m], omega_1, omega_2 [rad/s] : the same
    shape torque : (n_meshes, n) torque transmitted at the pinion, r_b1 (front - back force) [N m]
    touching : (n_meshes, n) False where no flank carries; friction_power, damping_power : (n_meshes,) mean
    [W]
    """

    time: Array
    angle: Array
    approach: Array
    omega_1: Array
    omega_2: Array
    torque: Array
    touching: NDArray[np.bool_]
    friction_power: Array
    damping_power: Array


def waveform(model: PortModel, solution: HarmonicSolution, samples: int | None = None) -> Waveform:
    """Mesh motions and torques over one period of a harmonic solution.

    model : the loop that was solved
    samples : per mesh period; default those of the grid
    """
    grid, speed = solution.grid, solution.speed
    count = grid.cells * (samples or grid.samples)
    base = speed * 2.0 * np.pi / (grid.cell_angle * grid.cells)
    time = np.arange(count, dtype=np.float64) * (2.0 * np.pi / base / count)
    motion, rate = in_time(solution.ports, base, count)
    shape = (model.n_meshes, count)
    angle, approach, omega_1, omega_2, torque = (np.empty(shape) for _ in range(5))
    touching = np.empty(shape, bool)
    friction, damping = np.empty(model.n_meshes), np.empty(model.n_meshes)
    for m, packed in enumerate(model.packed):
        moving = motion_of_mesh(model, m, speed, speed * time, motion, rate)
        angle[m], approach[m], omega_1[m], omega_2[m] = moving
        reaction = evaluate_mesh(packed, *moving)
        torque[m] = model.base_radii[m, 0] * (reaction.force_front - reaction.force_back)
        touching[m] = (reaction.force_front > 0.0) | (reaction.force_back > 0.0)
        friction[m], damping[m] = reaction.friction_power.mean(), reaction.damping_power.mean()
    return Waveform(
        time=time, angle=angle, approach=approach, omega_1=omega_1, omega_2=omega_2,
        torque=torque, touching=touching, friction_power=friction, damping_power=damping,
    )  # fmt: skip
