"""Equations of a harmonic balance at one speed: what a periodic state leaves of them.

The linear drivetrain enters exactly as receptance at the mesh bodies, harmonic by harmonic. Friction and the change of
gaps over the path act on rows of their own beside the ports (`MeshWrench`), across the line of action. The meshes, with
contact loss, friction, damping and the phase from the true pinion angle, are evaluated over time (alternating frequency
and time: Cameron & Griffin, J. Appl. Mech. 56 (1989) 149).
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.static_loop import PortModel
from dynamics.mesh.force import MeshReaction, evaluate_mesh
from dynamics.response.harmonic_newton import (
    HarmonicNewton,
    MeshHarmonics,
    mesh_inputs,
    mesh_sides,
    moved_by,
)
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid, HarmonicSolution

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


class HarmonicState(NamedTuple):
    """Unknowns: harmonics of the windup (n_bodies, top) [rad], mean windup (n,) [rad], drive [N m], twist [rad]."""

    moving: Complex
    rest: Array
    drive: float
    twist: float

    def plus(self, step: "HarmonicState", share: float = 1.0) -> "HarmonicState":
        """This state and a share of a step."""
        return HarmonicState(
            self.moving + share * step.moving,
            self.rest + share * step.rest,
            self.drive + share * step.drive,
            self.twist + share * step.twist,
        )

    def ports(self) -> Complex:
        """One-sided windup of the mesh bodies (n_bodies, top + 1) [rad]."""
        return np.hstack([self.rest[:-1, None].astype(complex), self.moving])


class Residual(NamedTuple):
    """What is left: of the harmonics (n_bodies, top) [rad], mean torques (n,) [N m], asked torque [N m]."""

    miss: Complex
    balance: Array
    asked: float

    def per(self, other: "Residual", difference: float) -> "Residual":
        """Derivative over a variable that differs by ``difference`` in ``other``."""
        return Residual(
            (other.miss - self.miss) / difference,
            (other.balance - self.balance) / difference,
            (other.asked - self.asked) / difference,
        )


def state_of(solution: HarmonicSolution) -> HarmonicState:
    """Unknowns of a solution; the drive freedom is where it leads."""
    rest = np.append(solution.ports[:, 0].real, 0.0)
    return HarmonicState(solution.ports[:, 1:].copy(), rest, solution.drive, solution.twist)


class HarmonicEquations:
    """Equations at one speed on one grid.

    base : lowest frequency [rad/s]; receptance : (top, n_bodies, n_inputs) [rad/(N m)], inputs of `mesh_inputs`
    newton : solves the linearised equations
    """

    def __init__(
        self,
        problem: BalanceProblem,
        grid: HarmonicGrid,
        speed: float,
        drag_torques: Mapping[str, float] | None = None,
        excitation: Complex | None = None,
    ) -> None:
        """Prepare; ``excitation`` (n_bodies, top + 1) are one-sided harmonics of further torques on the mesh bodies."""
        model = problem.model
        self.problem, self.grid, self.speed, self.excitation = problem, grid, speed, excitation
        self.base = speed * 2.0 * np.pi / (grid.cell_angle * grid.cells)
        order = np.arange(1, grid.top + 1)
        bodies = model.dofs[: model.n_bodies]
        omega = np.asarray(self.base * order, float)
        self.receptance = problem.form.receptance_to(omega, bodies, problem.into)
        self._inputs = mesh_inputs(model)
        self.newton = HarmonicNewton(problem, grid, self.base, self.receptance)
        self._drag = model.drag(speed, drag_torques)
        self._driven = problem.driven(grid, self.base)[:, 1:]
        self._lead = order * (self.base / speed / float(model.ratios[model.pinions[0]]))

    def residual(self, state: HarmonicState) -> tuple[Residual, MeshHarmonics]:
        """What a state leaves of the equations, and its mesh torques."""
        model, load = self.problem.model, self.problem.load
        reactions = self._evaluate(state.ports())
        torque = reactions.torque
        if self.excitation is not None:
            torque = torque.copy()
            torque[: model.n_bodies] += self.excitation
        miss = moved_by(self.receptance, torque[:, 1:]) - state.moving
        if self._driven.any():
            miss += self._driven * np.exp(1j * self._lead * state.rest[model.pinions[0]])
        mean = model.at_rest @ torque[:, 0].real
        balance = model.stiffness @ state.rest - mean - model.twist * state.twist - self._drag
        balance[-1] -= state.drive
        asked = 0.0
        if load.torque is not None:
            asked = load.torque - float(reactions.transmitted[load.control_mesh].mean())
        return Residual(miss, balance, asked), reactions

    def error(self, residual: Residual) -> float:
        """Largest of: approach error over its mean, unbalanced torque and missed torque over the asked one."""
        model, scale = self.problem.model, self.problem.approach_scale
        moving = np.abs(residual.miss).sum(axis=1)[mesh_sides(model)] * model.base_radii
        torque = max(abs(self.problem.load.torque or 0.0), 1.0)
        return max(
            2.0 * float(moving.max()) / scale,
            float(np.max(np.abs(residual.balance))) / torque,
            abs(residual.asked) / torque,
        )

    def step(self, residual: Residual, reactions: MeshHarmonics) -> HarmonicState:
        """Newton step that takes a residual away; LinAlgError where the linearised equations are singular."""
        return HarmonicState(*self.newton.step(reactions, *residual))

    def step_again(self, residual: Residual, reactions: MeshHarmonics) -> HarmonicState:
        """The same for another residual, by the matrix of the step before."""
        return HarmonicState(*self.newton.step_again(reactions, *residual))

    def solution(self, state: HarmonicState, error: float, iterations: int) -> HarmonicSolution:
        """A state as a solution."""
        return HarmonicSolution(
            grid=self.grid, speed=self.speed, ports=state.ports(), twist=state.twist, drive=state.drive,
            residual=error, iterations=iterations,
        )  # fmt: skip

    def _evaluate(self, ports: Complex) -> MeshHarmonics:
        model, grid = self.problem.model, self.grid
        count = grid.count
        drive_angle = np.arange(count, dtype=np.float64) * (grid.cell_angle * grid.cells / count)
        motion, rate = in_time(ports, self.base, count)
        torque = np.zeros((self.receptance.shape[2], count))
        tangents = np.empty((2, *self._inputs.shape, grid.samples))
        transmitted = np.empty((model.n_meshes, count))
        for m, packed in enumerate(model.packed):
            moving = motion_of_mesh(model, m, self.speed, drive_angle, motion, rate)
            reaction = evaluate_mesh(packed, *moving)
            transmitted[m] = model.base_radii[m, 0] * (reaction.force_front - reaction.force_back)
            acting = input_torques(model, m, reaction)
            for k, (at, (value, *slopes)) in enumerate(zip(self._inputs[m], acting)):
                torque[at] += value
                for kind, slope in enumerate(slopes):
                    tangents[kind, m, k] = slope.reshape(grid.cells, grid.samples).mean(axis=0)
        harmonics = np.fft.rfft(torque, axis=1)[:, : grid.top + 1] / count
        spectra = np.fft.fft(tangents, axis=3) / grid.samples
        return MeshHarmonics(harmonics, spectra[0], spectra[1], transmitted)


def input_torques(model: PortModel, m: int, reaction: MeshReaction) -> tuple[tuple[Array, Array, Array], ...]:
    """Torque on each input of mesh ``m`` (`mesh_inputs`), and what it changes by per approach and per its rate, (n,)
    each; of friction without the change of the path torque."""
    ports = (
        (reaction.torque_1, reaction.torque_1_per_approach, reaction.torque_1_per_rate),
        (reaction.torque_2, reaction.torque_2_per_approach, reaction.torque_2_per_rate),
    )
    if len(model.loads) == model.n_bodies:
        return ports
    normal = reaction.force_front - reaction.force_back, reaction.force_per_approach, reaction.force_per_rate
    beside = []
    for port, radius, share, sign in zip(ports, model.base_radii[m], model.path_shares[m], (1.0, -1.0)):
        value, per_approach, per_rate = (
            own + sign * radius * force for own, force in zip(port, normal, strict=True)
        )
        beside.append((value + share * reaction.path_torque, per_approach, per_rate))
    return (*ports, *beside)


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
