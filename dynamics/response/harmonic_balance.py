"""Periodic response of a rotating loop by harmonic balance with alternating frequency and time.

The linear drivetrain enters exactly as receptance at the mesh bodies, harmonic by harmonic. The meshes, with
contact loss, friction, damping and the phase from the true pinion angle, are evaluated over time. Unknowns
are the harmonics of the approach in every mesh, the mean windup, the drive torque that balances all losses,
and the bracing twist that makes the asked mean torque. One period may be a mesh, a revolution or a hunting
cycle: the Newton matrix falls into one small block per residue class of harmonics if the tangent is
averaged over the meshes of the period, and stays exact when the period is one mesh.

Source: alternating frequency/time, Cameron & Griffin, J. Appl. Mech. 56 (1989) 149; applied to gear pairs
with contact loss by Kahraman & Blankenship, J. Appl. Mech. 64 (1997) 217.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.static_loop import PortModel
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.force import evaluate_mesh
from dynamics.response.harmonic_newton import HarmonicNewton, MeshHarmonics, mesh_sides
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid, HarmonicSolution

STALL_LIMIT = 2e-3
"""Residual accepted when Newton stalls [-]: a damped contact force jumps at first touch, so that one sample
in or out of contact leaves a remainder that shrinks with the number of samples."""
MOST_ITERATIONS = 40

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


def solve_periodic(
    problem: BalanceProblem,
    speed: float,
    start: HarmonicSolution,
    *,
    drag_torques: Mapping[str, float] | None = None,
    excitation: Complex | None = None,
    tolerance: float = 1e-5,
) -> HarmonicSolution:
    """Newton iteration from a start state, on its grid.

    Parameters
    ----------
    speed : mean speed of the drive freedom [rad/s]
    start : state whose coefficients are taken, brought to another grid by ``resample``
    drag_torques : by name of ``PortModel.drags`` [N m]
    excitation : (n_bodies, top + 1) one-sided harmonics of further torques on the mesh bodies [N m]
    tolerance : largest error of the approach over its mean, and of the torques over the asked one [-]

    Raises
    ------
    DynamicsNotConverged
        With the residual reached. A stalled iteration counts as converged below STALL_LIMIT; its residual stands
        in the result.
    """
    model, grid = problem.model, start.grid
    base = speed * 2.0 * np.pi / (grid.cell_angle * grid.cells)
    omega = base * np.arange(1, grid.top + 1)
    n_bodies = model.n_bodies
    receptance = problem.form.receptance(np.asarray(omega, float), model.dofs[:n_bodies])
    drag = model.drag(speed, drag_torques)
    newton = HarmonicNewton(problem, grid, base, receptance)
    driven = problem.driven(grid, base)[:, 1:]
    lead = np.arange(1, grid.top + 1) * (base / speed / float(model.ratios[model.pinions[0]]))
    ports, twist, drive = start.ports.copy(), start.twist, start.drive
    rest = np.zeros(n_bodies + 1)
    rest[:n_bodies] = ports[:, 0].real
    best = HarmonicSolution(
        grid=grid, speed=speed, ports=ports, twist=twist, drive=drive, residual=np.inf, iterations=0
    )
    damp, previous = 1.0, np.inf
    step: tuple[Complex, Array, float, float] | None = None
    for iteration in range(MOST_ITERATIONS):
        ports[:, 0] = rest[:n_bodies]
        reactions = _evaluate(model, grid, speed, base, ports)
        torque = reactions.torque if excitation is None else reactions.torque + excitation
        miss = np.einsum("kij,jk->ik", receptance, torque[:, 1:]) - ports[:, 1:]
        if driven.any():
            miss += driven * np.exp(1j * lead * rest[model.pinions[0]])
        load = np.append(torque[:, 0].real, 0.0)
        balance = model.stiffness @ rest - load - model.twist * twist - drag
        balance[-1] -= drive
        asked = 0.0
        if problem.load.torque is not None:
            asked = problem.load.torque - float(reactions.transmitted[problem.load.control_mesh].mean())
        error = _error(problem, miss, balance, asked)
        if error < best.residual:
            best = HarmonicSolution(
                grid=grid, speed=speed, ports=ports.copy(), twist=twist, drive=drive, residual=error,
                iterations=iteration,
            )  # fmt: skip
        if error < tolerance or (error > 0.9 * best.residual and iteration >= best.iterations + 3):
            break
        if step is not None and error > 1.5 * previous and damp > 1.0 / 16.0:
            damp *= 0.5
            ports[:, 1:] -= damp * step[0]
            rest, drive, twist = rest - damp * step[1], drive - damp * step[2], twist - damp * step[3]
            continue
        previous, damp = error, 1.0
        try:
            step = newton.step(reactions, miss, balance, asked)
        except np.linalg.LinAlgError:
            break
        ports[:, 1:] += step[0]
        rest, drive, twist = rest + step[1], drive + step[2], twist + step[3]
    if best.residual < max(tolerance, STALL_LIMIT):
        return best
    raise DynamicsNotConverged(
        f"harmonic balance at {speed:.6g} rad/s: residual {best.residual:.2e} of the mean approach, limit "
        f"{max(tolerance, STALL_LIMIT):.0e}; start from a neighbouring speed or integrate in time"
    )


def in_time(ports: Complex, base: float, count: int) -> tuple[Array, Array]:
    """Windup [rad] and its rate [rad/s], (n_bodies, count), from one-sided coefficients ``ports``."""
    order = np.arange(ports.shape[1])
    motion = np.fft.irfft(ports, count, axis=1) * count
    rate = np.fft.irfft(1j * base * order * ports, count, axis=1) * count
    return motion, rate


def motion_of_mesh(
    model: PortModel, m: int, speed: float, drive_angle: Array, motion: Array, rate: Array
) -> tuple[Array, Array, Array, Array]:
    """Angle of the pinion [rad], approach [m] and speeds of both gears [rad/s] of mesh ``m``, each (n,).

    drive_angle : (n,) of the drive freedom at its mean ``speed``; motion, rate : (n_bodies, n) as of `in_time`
    """
    p, w = int(model.pinions[m]), int(model.wheels[m])
    radius_1, radius_2 = model.base_radii[m]
    return (
        model.ratios[p] * drive_angle + motion[p],
        radius_1 * motion[p] - radius_2 * motion[w] + model.offsets[m],
        model.ratios[p] * speed + rate[p],
        model.ratios[w] * speed + rate[w],
    )


def _evaluate(
    model: PortModel, grid: HarmonicGrid, speed: float, base: float, ports: Complex
) -> MeshHarmonics:
    count = grid.count
    drive_angle = np.arange(count, dtype=np.float64) * (grid.cell_angle * grid.cells / count)
    motion, rate = in_time(ports, base, count)
    torque = np.zeros((model.n_bodies, count))
    tangents = np.empty((2, model.n_meshes, 2, grid.samples))
    transmitted = np.empty((model.n_meshes, count))
    for m, packed in enumerate(model.packed):
        reaction = evaluate_mesh(packed, *motion_of_mesh(model, m, speed, drive_angle, motion, rate))
        torque[model.pinions[m]] += reaction.torque_1
        torque[model.wheels[m]] += reaction.torque_2
        transmitted[m] = model.base_radii[m, 0] * (reaction.force_front - reaction.force_back)
        for row, value in (
            ((0, m, 0), reaction.torque_1_per_approach),
            ((0, m, 1), reaction.torque_2_per_approach),
            ((1, m, 0), reaction.torque_1_per_rate),
            ((1, m, 1), reaction.torque_2_per_rate),
        ):
            tangents[row] = value.reshape(grid.cells, grid.samples).mean(axis=0)
    harmonics = np.fft.rfft(torque, axis=1)[:, : grid.top + 1] / count
    spectra = np.fft.fft(tangents, axis=3) / grid.samples
    return MeshHarmonics(harmonics, spectra[0], spectra[1], transmitted)


def _error(problem: BalanceProblem, miss: Complex, balance: Array, asked: float) -> float:
    """Largest of: approach error over its mean, unbalanced torque and missed torque over the asked one."""
    model, scale = problem.model, problem.approach_scale
    moving = np.abs(miss).sum(axis=1)[mesh_sides(model)] * model.base_radii
    torque = max(abs(problem.load.torque or 0.0), 1.0)
    return max(
        2.0 * float(moving.max()) / scale, float(np.max(np.abs(balance))) / torque, abs(asked) / torque
    )
