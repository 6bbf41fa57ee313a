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
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.modal_form import ModalForm
from dynamics.drivetrain.shaft_torque import ShaftTorques, harmonic_loads
from dynamics.drivetrain.static_loop import PortModel
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.force import evaluate_mesh

STALL_LIMIT = 2e-3
"""Residual accepted when Newton stalls [-]: a damped contact force jumps at first touch, so that one sample
in or out of contact leaves a remainder that shrinks with the number of samples."""

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


@dataclass(frozen=True)
class _Reactions:
    """Mesh torques over time and their cell-averaged tangents, as harmonics.

    torque : (n_bodies, top + 1) on each gear body, of all its meshes
    per_approach, per_rate : (n_meshes, 2, samples) of the torques on pinion and wheel, two-sided over one cell
    """

    torque: Complex
    per_approach: Complex
    per_rate: Complex
    transmitted: Array


@dataclass(frozen=True, kw_only=True)
class BalanceProblem:
    """Everything that stays the same over speed.

    torque : mean torque asked of ``control_mesh`` [N m], or None when ``twist`` [rad] is held instead
    shaft_torques : torques that swing with the turn of a shaft; ratios : (n,) speed of each freedom of the drivetrain
        per speed of the drive freedom
    """

    model: PortModel
    form: ModalForm
    torque: float | None
    twist: float | None = None
    control_mesh: int = 0
    shaft_torques: tuple[ShaftTorques, ...] = ()
    ratios: Array | None = None

    def driven(self, grid: HarmonicGrid, base: float) -> Complex:
        """Windup of the mesh bodies (n_bodies, top + 1) that the swinging torques would make without the meshes.

        Their angle is zero where that of the first pinion would be without windup.
        """
        n_bodies = self.model.n_bodies
        motion = np.zeros((n_bodies, grid.top + 1), complex)
        if self.ratios is None:
            return motion
        loads = harmonic_loads(self.shaft_torques, self.ratios, grid.cell_angle * grid.cells / (2.0 * np.pi))
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
        law = self.model.laws[self.control_mesh]
        torque = abs(self.torque) if self.torque else 1.0
        return max(torque, 1.0) / law.base_radius_1 / law.mean_stiffness


def solve_periodic(
    problem: BalanceProblem,
    grid: HarmonicGrid,
    speed: float,
    start: HarmonicSolution,
    *,
    drag_torques: Mapping[str, float] | None = None,
    excitation: Complex | None = None,
    tolerance: float = 1e-5,
    max_iterations: int = 40,
) -> HarmonicSolution:
    """Newton iteration from a start state.

    speed : mean speed of the drive freedom [rad/s]; start : state whose coefficients are taken, see
    ``resample``
    excitation : (n_bodies, top + 1) one-sided harmonics of further torques on the mesh bodies [N m]

    Raises DynamicsNotConverged with the residual reached. A stalled iteration counts as converged below
    STALL_LIMIT; its residual stands in the result.
    """
    model = problem.model
    base = speed * 2.0 * np.pi / (grid.cell_angle * grid.cells)
    omega = base * np.arange(1, grid.top + 1)
    n_bodies = model.n_bodies
    receptance = problem.form.receptance(np.asarray(omega, float), model.dofs[:n_bodies])
    drag = model.drag(speed, drag_torques)
    newton = _Newton(problem, grid, base, receptance)
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
    for iteration in range(max_iterations):
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
        if problem.torque is not None:
            asked = problem.torque - float(reactions.transmitted[problem.control_mesh].mean())
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


def resample(solution: HarmonicSolution, grid: HarmonicGrid) -> HarmonicSolution:
    """The same state on another grid: mesh harmonics are kept, the rest is dropped or zero."""
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


def _evaluate(model: PortModel, grid: HarmonicGrid, speed: float, base: float, ports: Complex) -> _Reactions:
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
    return _Reactions(harmonics, spectra[0], spectra[1], transmitted)


def _error(problem: BalanceProblem, miss: Complex, balance: Array, asked: float) -> float:
    """Largest of: approach error over its mean, unbalanced torque and missed torque over the asked one."""
    model, scale = problem.model, problem.approach_scale
    moving = np.abs(miss).sum(axis=1)[_sides(model)] * model.base_radii
    torque = max(abs(problem.torque or 0.0), 1.0)
    return max(
        2.0 * float(moving.max()) / scale, float(np.max(np.abs(balance))) / torque, abs(asked) / torque
    )


def _sides(model: PortModel) -> NDArray[np.int64]:
    """(n_meshes, 2) ports of pinion and wheel."""
    return np.stack([model.pinions, model.wheels], axis=1)


class _Newton:
    """Newton steps of one speed: for each residue class of harmonics one block over the meshes."""

    def __init__(self, problem: BalanceProblem, grid: HarmonicGrid, base: float, receptance: Complex) -> None:
        self.problem, self.grid, self.base = problem, grid, base
        self.receptance = receptance
        self.sides = _sides(problem.model)
        approach = problem.model.approach[:, :-1]
        self.gain = np.einsum("mi,kij->kmj", approach, receptance)
        """(top, n_meshes, n_bodies) approach per port torque."""

    def step(
        self, reactions: _Reactions, miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """Changes of the harmonics (n_bodies, top), of the mean windup (n,), of drive torque and twist."""
        approach_miss = self.problem.model.approach[:, :-1] @ miss
        change, rest, drive, twist = self._meshing(reactions, approach_miss, balance, asked)
        grid = self.grid
        torque = np.zeros(miss.shape, complex)
        torque[:, grid.cells - 1 :: grid.cells] = change
        for residue in range(1, grid.cells // 2 + 1):
            self._sideband(reactions, approach_miss, residue, torque)
        return miss + np.einsum("kij,jk->ik", self.receptance, torque), rest, drive, twist

    def _tangent(self, reactions: _Reactions, order: NDArray[np.int64], omega: Array) -> Complex:
        """(n_meshes, 2, n, n): harmonics of pinion and wheel torque per harmonics of approach."""
        lag = np.subtract.outer(order, order)
        stiff, damp = reactions.per_approach[:, :, lag], reactions.per_rate[:, :, lag]
        return np.asarray(stiff + damp * (1j * omega))

    def _gain_at(self, index: NDArray[np.int64]) -> Complex:
        """(n_index, n_meshes, n_bodies) approach per torque at signed harmonics, zero at the mean."""
        gain = self.gain[np.maximum(np.abs(index) - 1, 0)]
        gain = np.where((index < 0)[:, None, None], gain.conj(), gain)
        gain[index == 0] = 0.0
        return np.asarray(gain)

    def _block(self, tangent: Complex, gain: Complex) -> Complex:
        """Identity less gain times tangent, ordered mesh by mesh: (n_meshes n, n_meshes n)."""
        n_meshes, n = self.problem.model.n_meshes, tangent.shape[-1]
        split = gain[:, :, self.sides]
        coupled = np.einsum("kamp,mpkl->akml", split, tangent, optimize=True)
        return np.asarray(np.eye(n_meshes * n) - coupled.reshape(n_meshes * n, n_meshes * n))

    def _on_bodies(self, tangent: Complex, approach: NDArray[np.complexfloating]) -> Complex:
        """Torque on every gear body (n_bodies, n) from the change of approach (n_meshes, n)."""
        torque = np.zeros((self.problem.model.n_bodies, approach.shape[1]), complex)
        np.add.at(torque, self.sides, np.einsum("mpkl,ml->mpk", tangent, approach))
        return torque

    def _meshing(
        self, reactions: _Reactions, approach_miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """Class of the mesh harmonics, solved with the mean windup, drive torque and twist."""
        model, grid = self.problem.model, self.grid
        n_meshes, size = model.n_meshes, model.ratios.size
        order = np.arange(-grid.harmonics, grid.harmonics + 1)
        n, mean = order.size, grid.harmonics
        omega = self.base * grid.cells * order
        tangent = self._tangent(reactions, order, np.asarray(omega, float))
        flat = np.arange(n_meshes) * n + mean
        total = n_meshes * n + size + 2
        matrix = np.zeros((total, total), complex)
        right = np.zeros(total, complex)
        matrix[: n_meshes * n, : n_meshes * n] = self._block(tangent, self._gain_at(order * grid.cells))
        at = order[mean + 1 :] * grid.cells - 1
        for m in range(n_meshes):
            right[m * n + mean + 1 : (m + 1) * n] = approach_miss[m, at]
            right[m * n : m * n + mean] = approach_miss[m, at].conj()[::-1]
        # the mean approach follows from the mean windup
        rest = n_meshes * n
        matrix[flat, :] = 0.0
        matrix[flat, flat] = 1.0
        matrix[flat, rest : rest + size] = -model.approach
        # balance of mean torques
        matrix[rest : rest + size, rest : rest + size] = model.stiffness
        for m in range(n_meshes):
            for side, body in enumerate(self.sides[m]):
                matrix[rest + body, m * n : (m + 1) * n] -= tangent[m, side, mean]
        matrix[rest + size - 1, rest + size] = -1.0
        matrix[rest : rest + size, rest + size + 1] = -model.twist
        right[rest : rest + size] = -balance
        # reference angle stays, torque of the control mesh or twist is met
        matrix[rest + size, rest + size - 1] = 1.0
        if self.problem.torque is None:
            matrix[rest + size + 1, rest + size + 1] = 1.0
        else:
            c = self.problem.control_mesh
            matrix[rest + size + 1, c * n : (c + 1) * n] = -tangent[c, 0, mean]
            right[rest + size + 1] = asked
        solution = _solve_paired(matrix, right, n_meshes, n)
        approach = solution[:rest].reshape(n_meshes, n)
        torque = self._on_bodies(tangent, approach)
        tail = solution[rest:].real
        return torque[:, mean + 1 :], tail[:size], float(tail[size]), float(tail[size + 1])

    def _sideband(self, reactions: _Reactions, miss: Complex, residue: int, torque: Complex) -> None:
        """Class of the harmonics ``residue + cells * j``: fills its places in ``torque`` (n_bodies, top)."""
        model, grid = self.problem.model, self.grid
        j = np.arange(-grid.harmonics, grid.harmonics)
        index = residue + grid.cells * j
        omega = self.base * index
        tangent = self._tangent(reactions, j, np.asarray(omega, float))
        block = self._block(tangent, self._gain_at(index))
        known = miss[:, np.abs(index) - 1]
        known = np.where(index < 0, known.conj(), known)
        approach = np.linalg.solve(block, known.ravel()).reshape(model.n_meshes, j.size)
        change = self._on_bodies(tangent, approach)
        positive = index > 0
        torque[:, index[positive] - 1] = change[:, positive]
        torque[:, -index[~positive] - 1] = change[:, ~positive].conj()


def _solve_paired(matrix: Complex, right: Complex, n_meshes: int, n: int) -> Complex:
    """Solution of a system for real motions, in real numbers: a quarter of the work.

    The first unknowns are ``n_meshes`` spectra of ``n`` signed harmonics, the rest are real. Harmonics of opposite
    sign are conjugate, a + ib and a - ib, and so are their equations: of each pair one is kept, as its real and
    imaginary part for a and b.
    """
    mean = n // 2
    start = np.arange(n_meshes)[:, None] * n + mean
    positive, negative = ((start + sign * np.arange(1, mean + 1)).ravel() for sign in (1, -1))
    single = np.append(start.ravel(), np.arange(n_meshes * n, len(right)))

    def of_parts(rows: Complex) -> Complex:
        after, before = rows[:, positive], rows[:, negative]
        return np.hstack([after + before, 1j * (after - before), rows[:, single]])

    pairs = of_parts(matrix[positive])
    real = np.vstack([pairs.real, pairs.imag, of_parts(matrix[single]).real])
    load = np.concatenate([right[positive].real, right[positive].imag, right[single].real])
    scale = np.abs(real).max(axis=1)
    cosine, sine, others = np.split(
        np.linalg.solve(real / scale[:, None], load / scale), [positive.size, 2 * positive.size]
    )
    solution = np.empty(len(right), complex)
    solution[positive], solution[negative], solution[single] = cosine + 1j * sine, cosine - 1j * sine, others
    return solution
