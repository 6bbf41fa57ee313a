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
                for at, own in zip(inputs, tangent[mesh]):
                    coupled[row, :, mesh * n : (mesh + 1) * n] += gain[:, row, at, None] * own
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
