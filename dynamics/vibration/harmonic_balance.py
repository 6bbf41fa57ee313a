"""Periodic response of a rotating loop by harmonic balance with alternating frequency and time.

Unknowns are the harmonics of the approach in every mesh, the mean windup, the drive torque that balances all losses,
and the bracing twist that makes the asked mean torque. One period may be a mesh, a revolution or a hunting
cycle: the Newton matrix falls into one small block per residue class of harmonics if the tangent is
averaged over the meshes of the period, and stays exact when the period is one mesh.

Source: alternating frequency/time, Cameron & Griffin, J. Appl. Mech. 56 (1989) 149; applied to gear pairs
with contact loss by Kahraman & Blankenship, J. Appl. Mech. 64 (1997) 217.
"""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.linear_system import ModalForm
from dynamics.rotor.parts import PeriodicLoad, harmonic_loads
from dynamics.rotor.static_loop import LoopLoad, PortModel
from dynamics.tooth.mesh_force import MeshReaction, evaluate_mesh

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]


# What a harmonic balance solves: the loop with its load, the grid of frequencies and samples, the coefficients.


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


# Newton steps of the harmonic balance: one small block of equations per residue class of harmonics.


@dataclass(frozen=True)
class MeshHarmonics:
    """Mesh torques over time and their cell-averaged tangents, as harmonics.

    torque : (n_inputs, top + 1) on each gear body, of all its meshes, then of friction beside the ports (`mesh_inputs`)
    per_approach, per_rate : (n_meshes, k, samples) of the torques on the inputs of each mesh, two-sided over one cell
    transmitted : (n_meshes, count) torque at the pinion over the period [N m]
    """

    torque: Complex
    per_approach: Complex
    per_rate: Complex
    transmitted: Array


def mesh_sides(model: PortModel) -> NDArray[np.int64]:
    """(n_meshes, 2) ports of pinion and wheel."""
    return np.stack([model.pinions, model.wheels], axis=1)


def mesh_inputs(model: PortModel) -> NDArray[np.int64]:
    """(n_meshes, k) inputs of each mesh: ports of pinion and wheel and, where gears do not only rotate, its friction
    beside them; these are counted after the bodies."""
    beside = np.arange(model.n_bodies, len(model.loads)).reshape(model.n_meshes, -1)
    return np.hstack([mesh_sides(model), beside])


def moved_by(receptance: Complex, torque: Complex) -> Complex:
    """Harmonics (n_bodies, top) of motion under those of torque, receptance (top, n_bodies, n_inputs)."""
    return np.asarray((receptance @ torque.T[:, :, None])[:, :, 0].T)


class HarmonicNewton:
    """Newton steps of one speed: for each residue class of harmonics one block over the meshes."""

    def __init__(self, problem: BalanceProblem, grid: HarmonicGrid, base: float, receptance: Complex) -> None:
        self.problem, self.grid, self.base = problem, grid, base
        self.receptance = receptance
        self._factors: _Factors | None = None
        self._known: Complex | None = None
        self.inputs = mesh_inputs(problem.model)
        approach = problem.model.approach[:, :-1]
        self.gain = approach @ receptance
        """(top, n_meshes, n_inputs) approach per torque."""

    def step(
        self, reactions: MeshHarmonics, miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """Changes of the harmonics (n_bodies, top), of the mean windup (n,), of drive torque and twist."""
        self._factors = None
        return self._stepped(reactions, miss, balance, asked)

    def step_again(
        self, reactions: MeshHarmonics, miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """The same with the tangents of the last step where the period is one mesh: a chord, its matrix known."""
        if self.grid.cells > 1:
            self._factors = None
        return self._stepped(reactions, miss, balance, asked)

    def _stepped(
        self, reactions: MeshHarmonics, miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        approach_miss = self.problem.model.approach[:, :-1] @ miss
        change, rest, drive, twist = self._meshing(reactions, approach_miss, balance, asked)
        grid = self.grid
        torque = np.zeros((self.receptance.shape[2], grid.top), complex)
        torque[:, grid.cells - 1 :: grid.cells] = change
        for residue in range(1, grid.cells // 2 + 1):
            self._sideband(reactions, approach_miss, residue, torque)
        return miss + moved_by(self.receptance, torque), rest, drive, twist

    def _tangent(
        self, reactions: MeshHarmonics, rows: NDArray[np.int64], columns: NDArray[np.int64], omega: Array
    ) -> Complex:
        """(n_meshes, k, r, n): harmonics ``rows`` (r,) of the torques on its inputs per harmonics ``columns`` (n,) of
        approach, both running on by one; omega : (n,) [rad/s] of the columns."""
        lags = np.arange(rows[0] - columns[-1], rows[-1] - columns[0] + 1)
        stiff, damp = (
            sliding_window_view(spectrum[:, :, lags], columns.size, axis=2)[..., ::-1]
            for spectrum in (reactions.per_approach, reactions.per_rate)
        )
        return np.asarray(stiff + damp * (1j * omega))

    def _gain_at(self, index: NDArray[np.int64]) -> Complex:
        """(n_index, n_meshes, n_inputs) approach per torque at signed harmonics, zero at the mean."""
        gain = self.gain[np.maximum(np.abs(index) - 1, 0)]
        gain = np.where((index < 0)[:, None, None], gain.conj(), gain)
        gain[index == 0] = 0.0
        return np.asarray(gain)

    def _coupled(self, tangent: Complex, gain: Complex) -> Complex:
        """(n_meshes, r, n_meshes n) approach of each mesh at harmonics of ``gain`` (r, n_meshes, n_inputs) per approach
        of all, by tangents (n_meshes, k, r, n)."""
        n_meshes, n = self.problem.model.n_meshes, tangent.shape[-1]
        coupled = np.zeros((n_meshes, len(gain), n_meshes * n), complex)
        for row in range(n_meshes):
            for mesh, inputs in enumerate(self.inputs):
                for column, slope in zip(inputs, tangent[mesh]):
                    coupled[row, :, mesh * n : (mesh + 1) * n] += gain[:, row, column, None] * slope
        return coupled

    def _torques(self, tangent: Complex, approach: NDArray[np.complexfloating]) -> Complex:
        """Torque on every input (n_inputs, r) from the change of approach (n_meshes, n)."""
        torque = np.zeros((self.receptance.shape[2], tangent.shape[2]), complex)
        np.add.at(torque, self.inputs, (tangent @ approach[:, None, :, None])[..., 0])
        return torque

    def _meshing(
        self, reactions: MeshHarmonics, approach_miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """Class of the mesh harmonics, solved with the mean windup, drive torque and twist."""
        grid = self.grid
        n_meshes, size, top = self.problem.model.n_meshes, self.problem.model.ratios.size, grid.harmonics
        if self._factors is None or self._known is None:
            self._known, matrix = self._linearised(reactions)
            self._factors = _Factors(matrix)
        miss = approach_miss[:, grid.cells - 1 :: grid.cells][:, :top].ravel()
        singles = np.concatenate([np.zeros(n_meshes), -balance, [0.0, 0.0]])
        if self.problem.load.torque is not None:
            singles[-1] = asked
        solution = self._factors.solve(np.concatenate([miss.real, miss.imag, singles]))
        cosine, sine, rest = np.split(solution, [n_meshes * top, 2 * n_meshes * top])
        moving = (cosine + 1j * sine).reshape(n_meshes, top)
        approach = np.hstack([moving[:, ::-1].conj(), rest[:n_meshes, None], moving])
        tail = rest[n_meshes:]
        return self._torques(self._known, approach), tail[:size], float(tail[size]), float(tail[size + 1])

    def _linearised(self, reactions: MeshHarmonics) -> tuple[Complex, Array]:
        """Tangents at the positive harmonics, and matrix of the equations of `_meshing`.

        Motions are real: harmonics of opposite sign are conjugate, a + ib and a - ib, and so are their equations. Of
        each pair the one of the positive harmonic is kept, as its real and imaginary part for a and b: a quarter of
        the work. Unknowns: a of all meshes, b of all meshes, mean approaches, mean windup, drive torque and twist.
        """
        model, grid = self.problem.model, self.grid
        n_meshes, size, top = model.n_meshes, model.ratios.size, grid.harmonics
        order = np.arange(-top, top + 1)
        omega = np.asarray(self.base * grid.cells * order, float)
        whole = self._tangent(reactions, order[top:], order, omega)
        mean, tangent = whole[:, :, 0], whole[:, :, 1:]
        pairs = n_meshes * top
        matrix = np.zeros((2 * pairs + n_meshes + size + 2,) * 2)
        coupled = self._coupled(tangent, self._gain_at(order[top + 1 :] * grid.cells))
        moving = -self._by_parts(coupled.reshape(pairs, n_meshes, order.size))
        known = 2 * pairs + n_meshes
        matrix[:pairs, :known], matrix[pairs : 2 * pairs, :known] = moving.real, moving.imag
        diagonal = np.arange(2 * pairs + n_meshes)
        matrix[diagonal, diagonal] += 1.0
        # the mean approach follows from the mean windup
        matrix[2 * pairs : known, known : known + size] = -model.approach
        # balance of mean torques
        rest = slice(known, known + size)
        acting = np.zeros((size, n_meshes, order.size), complex)
        for m in range(n_meshes):
            acting[:, m] = model.at_rest[:, self.inputs[m]] @ mean[m]
        matrix[rest, :known] = -self._by_parts(acting).real
        matrix[rest, rest] = model.stiffness
        matrix[known + size - 1, known + size] = -1.0
        matrix[rest, known + size + 1] = -model.twist
        # reference angle stays, torque of the control mesh or twist is met
        matrix[known + size, known + size - 1] = 1.0
        if self.problem.load.torque is None:
            matrix[known + size + 1, known + size + 1] = 1.0
        else:
            control = np.zeros((1, n_meshes, order.size), complex)
            control[0, self.problem.load.control_mesh] = -mean[self.problem.load.control_mesh, 0]
            matrix[known + size + 1, :known] = self._by_parts(control).real[0]
        return tangent, matrix

    def _by_parts(self, rows: Complex) -> Complex:
        """Rows (r, n_meshes, n) per signed harmonics as rows (r, n_meshes n) per a, b and mean of `_linearised`."""
        top = self.grid.harmonics
        after, before = rows[:, :, top + 1 :], rows[:, :, top - 1 :: -1]
        parts = after + before, 1j * (after - before), rows[:, :, top]
        return np.hstack([part.reshape(len(rows), -1) for part in parts])

    def _sideband(self, reactions: MeshHarmonics, miss: Complex, residue: int, torque: Complex) -> None:
        """Class of the harmonics ``residue + cells * j``: fills its places in ``torque`` (n_inputs, top)."""
        model, grid = self.problem.model, self.grid
        j = np.arange(-grid.harmonics, grid.harmonics)
        index = residue + grid.cells * j
        omega = self.base * index
        tangent = self._tangent(reactions, j, j, np.asarray(omega, float))
        block = -self._coupled(tangent, self._gain_at(index)).reshape(model.n_meshes * j.size, -1)
        block.flat[:: len(block) + 1] += 1.0
        known = miss[:, np.abs(index) - 1]
        known = np.where(index < 0, known.conj(), known)
        approach = np.linalg.solve(block, known.ravel()).reshape(model.n_meshes, j.size)
        change = self._torques(tangent, approach)
        positive = index > 0
        torque[:, index[positive] - 1] = change[:, positive]
        torque[:, -index[~positive] - 1] = change[:, ~positive].conj()


class _Factors:
    """A system of real equations, factorised once, each equation scaled by its largest factor."""

    def __init__(self, matrix: Array) -> None:
        """Raises LinAlgError for a singular matrix."""
        self._scale = np.abs(matrix).max(axis=1)
        if not self._scale.all():  # a mesh that carries the torque does not touch
            raise np.linalg.LinAlgError("singular matrix")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LinAlgWarning)
            self._factors = lu_factor(matrix / self._scale[:, None], overwrite_a=True, check_finite=False)
        if not np.all(np.diag(self._factors[0])):
            raise np.linalg.LinAlgError("singular matrix")

    def solve(self, right: Array) -> Array:
        """Unknowns for a right-hand side."""
        return np.asarray(lu_solve(self._factors, right / self._scale, check_finite=False))


STALL_LIMIT = 2e-3
"""Residual accepted when Newton stalls [-]: a damped contact force jumps at first touch, so that one sample
in or out of contact leaves a remainder that shrinks with the number of samples."""
MOST_ITERATIONS = 40
CHORD, FAST = 1e-3, 0.1
"""Residual below which the tangents of the step before serve again, as long as a step leaves a tenth of it [-]: those
of the pinion angle, left out of them, leave a hundredth in any case."""


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
    equations = HarmonicEquations(problem, start.grid, speed, drag_torques, excitation)
    state, step = state_of(start), None
    best = equations.solution(state, np.inf, 0)
    damp, previous = 1.0, np.inf
    for iteration in range(MOST_ITERATIONS):
        residual, reactions = equations.residual(state)
        error = equations.error(residual)
        if error < best.residual:
            best = equations.solution(state, error, iteration)
        if error < tolerance or (error > 0.9 * best.residual and iteration >= best.iterations + 3):
            break
        if step is not None and error > 1.5 * previous and damp > 1.0 / 16.0:
            damp *= 0.5
            state = state.plus(step, -damp)
            continue
        fast = error < FAST * previous
        previous, damp = error, 1.0
        try:
            solve = equations.newton.step_again if fast and error < CHORD else equations.newton.step
            step = HarmonicState(*solve(reactions, *residual))
        except np.linalg.LinAlgError:
            break
        state = state.plus(step)
    if best.residual < max(tolerance, STALL_LIMIT):
        return best
    raise DynamicsNotConverged(
        f"harmonic balance at {speed:.6g} rad/s: residual {best.residual:.2e} of the mean approach, limit "
        f"{max(tolerance, STALL_LIMIT):.0e}; start from a neighbouring speed or integrate in time"
    )


# Equations of a harmonic balance at one speed: what a periodic state leaves of them.
#
# The linear drivetrain enters exactly as receptance at the mesh bodies, harmonic by harmonic. Friction and the change
# of gaps over the path act on rows of their own beside the ports (`MeshWrench`), across the line of action. The meshes,
# with contact loss, friction, damping and the phase from the true pinion angle, are evaluated over time (alternating
# frequency and time: Cameron & Griffin, J. Appl. Mech. 56 (1989) 149).


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
            for k, (row, (value, *slopes)) in enumerate(zip(self._inputs[m], acting)):
                torque[row] += value
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
            torque + sign * radius * force for torque, force in zip(port, normal, strict=True)
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
