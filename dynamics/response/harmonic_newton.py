"""Newton steps of the harmonic balance: one small block of equations per residue class of harmonics."""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve

from dynamics.drivetrain.static_loop import PortModel
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


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
        self._factors: _Paired | None = None
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

    def _tangent(self, reactions: MeshHarmonics, order: NDArray[np.int64], omega: Array) -> Complex:
        """(n_meshes, k, n, n): harmonics of the torques on its inputs per harmonics of approach."""
        n = order.size
        lags = np.arange(1 - n, n)
        stiff, damp = (
            sliding_window_view(spectrum[:, :, lags], n, axis=2)[..., ::-1]
            for spectrum in (reactions.per_approach, reactions.per_rate)
        )
        return np.asarray(stiff + damp * (1j * omega))

    def _gain_at(self, index: NDArray[np.int64]) -> Complex:
        """(n_index, n_meshes, n_inputs) approach per torque at signed harmonics, zero at the mean."""
        gain = self.gain[np.maximum(np.abs(index) - 1, 0)]
        gain = np.where((index < 0)[:, None, None], gain.conj(), gain)
        gain[index == 0] = 0.0
        return np.asarray(gain)

    def _block(self, tangent: Complex, gain: Complex) -> Complex:
        """Identity less gain times tangent, ordered mesh by mesh: (n_meshes n, n_meshes n)."""
        n_meshes, n = self.problem.model.n_meshes, tangent.shape[-1]
        block = np.eye(n_meshes * n, dtype=complex)
        for row in range(n_meshes):
            for mesh, inputs in enumerate(self.inputs):
                coupled = sum(gain[:, row, at, None] * own for at, own in zip(inputs, tangent[mesh]))
                block[row * n : (row + 1) * n, mesh * n : (mesh + 1) * n] -= coupled
        return block

    def _torques(self, tangent: Complex, approach: NDArray[np.complexfloating]) -> Complex:
        """Torque on every input (n_inputs, n) from the change of approach (n_meshes, n)."""
        torque = np.zeros((self.receptance.shape[2], approach.shape[1]), complex)
        np.add.at(torque, self.inputs, np.einsum("mpkl,ml->mpk", tangent, approach))
        return torque

    def _meshing(
        self, reactions: MeshHarmonics, approach_miss: Complex, balance: Array, asked: float
    ) -> tuple[Complex, Array, float, float]:
        """Class of the mesh harmonics, solved with the mean windup, drive torque and twist."""
        model, grid = self.problem.model, self.grid
        n_meshes, size = model.n_meshes, model.ratios.size
        order = np.arange(-grid.harmonics, grid.harmonics + 1)
        n, mean = order.size, grid.harmonics
        rest = n_meshes * n
        if self._factors is None or self._known is None:
            self._known, matrix = self._linearised(reactions, order)
            self._factors = _Paired(matrix, n_meshes, n)
        tangent = self._known
        right = np.zeros(rest + size + 2, complex)
        at = order[mean + 1 :] * grid.cells - 1
        for m in range(n_meshes):
            right[m * n + mean + 1 : (m + 1) * n] = approach_miss[m, at]
            right[m * n : m * n + mean] = approach_miss[m, at].conj()[::-1]
        right[rest : rest + size] = -balance
        if self.problem.load.torque is not None:
            right[rest + size + 1] = asked
        solution = self._factors.solve(right)
        approach = solution[:rest].reshape(n_meshes, n)
        torque = self._torques(tangent, approach)
        tail = solution[rest:].real
        return torque[:, mean + 1 :], tail[:size], float(tail[size]), float(tail[size + 1])

    def _linearised(self, reactions: MeshHarmonics, order: NDArray[np.int64]) -> tuple[Complex, Complex]:
        """Tangents of the meshes and matrix of the equations of `_meshing`."""
        model, grid = self.problem.model, self.grid
        n_meshes, size, n, mean = model.n_meshes, model.ratios.size, order.size, grid.harmonics
        omega = self.base * grid.cells * order
        tangent = self._tangent(reactions, order, np.asarray(omega, float))
        flat = np.arange(n_meshes) * n + mean
        total = n_meshes * n + size + 2
        matrix = np.zeros((total, total), complex)
        matrix[: n_meshes * n, : n_meshes * n] = self._block(tangent, self._gain_at(order * grid.cells))
        # the mean approach follows from the mean windup
        rest = n_meshes * n
        matrix[flat, :] = 0.0
        matrix[flat, flat] = 1.0
        matrix[flat, rest : rest + size] = -model.approach
        # balance of mean torques
        matrix[rest : rest + size, rest : rest + size] = model.stiffness
        for m in range(n_meshes):
            for own, at in zip(tangent[m], self.inputs[m]):
                at_rest = np.outer(model.at_rest[:, at], own[mean])
                matrix[rest : rest + size, m * n : (m + 1) * n] -= at_rest
        matrix[rest + size - 1, rest + size] = -1.0
        matrix[rest : rest + size, rest + size + 1] = -model.twist
        # reference angle stays, torque of the control mesh or twist is met
        matrix[rest + size, rest + size - 1] = 1.0
        if self.problem.load.torque is None:
            matrix[rest + size + 1, rest + size + 1] = 1.0
        else:
            c = self.problem.load.control_mesh
            matrix[rest + size + 1, c * n : (c + 1) * n] = -tangent[c, 0, mean]
        return tangent, matrix

    def _sideband(self, reactions: MeshHarmonics, miss: Complex, residue: int, torque: Complex) -> None:
        """Class of the harmonics ``residue + cells * j``: fills its places in ``torque`` (n_inputs, top)."""
        model, grid = self.problem.model, self.grid
        j = np.arange(-grid.harmonics, grid.harmonics)
        index = residue + grid.cells * j
        omega = self.base * index
        tangent = self._tangent(reactions, j, np.asarray(omega, float))
        block = self._block(tangent, self._gain_at(index))
        known = miss[:, np.abs(index) - 1]
        known = np.where(index < 0, known.conj(), known)
        approach = np.linalg.solve(block, known.ravel()).reshape(model.n_meshes, j.size)
        change = self._torques(tangent, approach)
        positive = index > 0
        torque[:, index[positive] - 1] = change[:, positive]
        torque[:, -index[~positive] - 1] = change[:, ~positive].conj()


class _Paired:
    """A system for real motions in real numbers, a quarter of the work, factorised once.

    The first unknowns are ``n_meshes`` spectra of ``n`` signed harmonics, the rest are real. Harmonics of opposite
    sign are conjugate, a + ib and a - ib, and so are their equations: of each pair one is kept, as its real and
    imaginary part for a and b.
    """

    def __init__(self, matrix: Complex, n_meshes: int, n: int) -> None:
        """Raises LinAlgError for a singular matrix."""
        mean = n // 2
        start = np.arange(n_meshes)[:, None] * n + mean
        positive, negative = ((start + sign * np.arange(1, mean + 1)).ravel() for sign in (1, -1))
        single = np.append(start.ravel(), np.arange(n_meshes * n, len(matrix)))

        def of_parts(rows: Complex) -> Complex:
            after, before = rows[:, positive], rows[:, negative]
            return np.hstack([after + before, 1j * (after - before), rows[:, single]])

        pairs = of_parts(matrix[positive])
        real = np.vstack([pairs.real, pairs.imag, of_parts(matrix[single]).real])
        self._positive, self._negative, self._single = positive, negative, single
        self._scale = np.abs(real).max(axis=1)
        if not self._scale.all():  # a mesh that carries the torque does not touch
            raise np.linalg.LinAlgError("singular matrix")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LinAlgWarning)
            self._factors = lu_factor(real / self._scale[:, None], check_finite=False)
        if not np.all(np.diag(self._factors[0])):
            raise np.linalg.LinAlgError("singular matrix")

    def solve(self, right: Complex) -> Complex:
        """Unknowns for a right-hand side."""
        load = np.concatenate(
            [right[self._positive].real, right[self._positive].imag, right[self._single].real]
        )
        found = lu_solve(self._factors, load / self._scale, check_finite=False)
        size = self._positive.size
        cosine, sine, others = np.split(found, [size, 2 * size])
        solution = np.empty(len(right), complex)
        solution[self._positive], solution[self._negative] = cosine + 1j * sine, cosine - 1j * sine
        solution[self._single] = others
        return solution
