"""Exact complex-modal form of a linear system with rigid modes and strong dampers.

The undamped real modes come first, with the rigid mode of every free line kept exact (frequency 0). In that basis
rigid displacements leave the state, only their velocity stays, so the state matrix has no defective pole; dampers of
any strength are real poles of it. Nothing is truncated here.
"""

from dataclasses import dataclass
from hashlib import sha256

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve_triangular

from thermal.fe.kept_results import kept_as

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

SLOWEST = 1.0
"""Least frequency that scales a displacement [rad/s]: films may leave a motion without stiffness of its own."""


@dataclass(frozen=True, kw_only=True)
class ModalForm:
    """Poles and mode shapes of ``M q'' + C q' + K q = f``.

    poles : (n_states,) eigenvalues of the state matrix [1/s]; 2 n_elastic + n_rigid of them
    shapes : (n, n_states) displacement shape of each pole; a rigid velocity state has its velocity / pole
    velocity_shapes : (n, n_states) velocity shape of each pole
    loads : (n_states, n) modal load of a unit torque on each freedom
    rigid : (n, n_rigid) mass-normalised rigid shapes
    """

    poles: Complex
    velocity_shapes: Complex
    loads: Complex
    rigid: Array

    def seen(self, freedoms: Array) -> "ModalForm":
        """The same in other freedoms (n, n_coordinates) per coordinate."""
        return ModalForm(
            poles=self.poles,
            velocity_shapes=times(freedoms, self.velocity_shapes),
            loads=times(freedoms, self.loads.T).T,
            rigid=freedoms @ self.rigid,
        )

    def receptance(self, omega: Array, dofs: NDArray[np.int64]) -> Complex:
        """Displacement per torque between some freedoms at frequencies above zero.

        omega : (n_omega,) [rad/s], all > 0; dofs : (n_dofs,). Returns (n_omega, n_dofs, n_dofs) [rad/(N m)].
        """
        return self.receptance_to(omega, dofs, self.loads[:, dofs])

    def into(self, rows: Array) -> Complex:
        """(n_states, k) modal loads of unit loads on rows (k, n) of all freedoms."""
        return times(rows, self.loads.T).T

    def receptance_to(self, omega: Array, dofs: NDArray[np.int64], into: Complex) -> Complex:
        """Displacement of some freedoms per modal loads ``into`` (n_states, k), (n_omega, n_dofs, k)."""
        out = self.velocity_shapes[dofs]
        s = 1j * np.asarray(omega)
        gain = 1.0 / (s[:, None] - self.poles)
        mobility = (out * gain[:, None, :]) @ into
        return np.asarray(mobility / s[:, None, None])


def times(matrix: Array, motion: Complex) -> Complex:
    """A real matrix times complex columns or a vector, without a complex copy of the matrix."""
    return np.asarray(matrix @ motion.real + 1j * (matrix @ motion.imag))


def modal_form(inertia: Array, damping: Array, stiffness: Array, rigid: Array) -> ModalForm:
    """Complex modes of a system with rigid shapes.

    inertia, damping, stiffness : (n, n) [kg m2], [N m s/rad], [N m/rad]; damping may have a gyroscopic, stiffness a
    skew part, which does not act on rigid motion
    rigid : (n, n_shapes) candidates; only the combinations of them that the stiffness does not resist are rigid, so
    that a line that is tied to ground or to another by a mesh has none
    """
    modes = real_modes(inertia, stiffness, rigid)
    n, n_rigid = modes.shapes.shape[0], modes.n_rigid
    n_elastic = n - n_rigid
    # states: frequency * elastic displacement, elastic velocity, rigid velocity (all of one unit)
    shapes = np.roll(modes.shapes, -n_rigid, axis=1)
    frequency = modes.frequencies[n_rigid:]
    state = np.zeros((n_elastic + n, n_elastic + n))
    state[:n_elastic, n_elastic : 2 * n_elastic] = np.diag(frequency)
    squared = modes.squared[n_rigid:]
    state[n_elastic : 2 * n_elastic, :n_elastic] = -np.diag(squared / frequency)
    state[n_elastic:, n_elastic:] = -shapes.T @ damping @ shapes
    skew = 0.5 * (stiffness - stiffness.T)
    if skew.any():
        state[n_elastic : 2 * n_elastic, :n_elastic] -= (
            shapes[:, :n_elastic].T @ skew @ (shapes[:, :n_elastic] / frequency)
        )
    poles, right = np.linalg.eig(state)  # numpy's, a quarter faster than scipy's
    loads = np.vstack((np.zeros((n_elastic, n)), shapes.T))
    return ModalForm(
        poles=np.asarray(poles, complex),
        velocity_shapes=times(shapes, right[n_elastic:]),
        loads=np.asarray(np.linalg.solve(right, loads), complex),
        rigid=modes.shapes[:, :n_rigid],
    )


def known_modal_form(inertia: Array, damping: Array, stiffness: Array, rigid: Array) -> ModalForm:
    """As `modal_form`; matrices met before are not solved again: of systems that differ in one bearing or shaft all
    branches but one are the same."""
    matrices = (inertia, damping, stiffness, rigid)
    content = sha256(b"".join(repr(one.shape).encode() + one.tobytes() for one in matrices)).digest()
    return kept_as((modal_form, content), lambda: modal_form(*matrices))


@dataclass(frozen=True, kw_only=True)
class RealModes:
    """Mass-normalised real modes of the symmetric part of the stiffness, undamped.

    shapes : (n, n), the rigid ones first
    squared : (n,) omega^2, exactly 0 for these [1/s2]; below 0 where the symmetric part of a film pushes
    frequencies : (n,) [rad/s] that scale the displacements, 0 for the rigid ones, else sqrt(|omega^2|), not below
        `SLOWEST`
    """

    shapes: Array
    squared: Array
    frequencies: Array
    n_rigid: int


def real_modes(inertia: Array, stiffness: Array, rigid: Array) -> RealModes:
    """Real modes with exact rigid ones; arguments as of ``modal_form``."""
    root = np.linalg.cholesky(inertia)
    symmetric = 0.5 * (stiffness + stiffness.T)
    scaled = solve_triangular(root, solve_triangular(root, symmetric, lower=True).T, lower=True)
    still = root.T @ _not_resisted(rigid, symmetric)
    n, n_rigid = still.shape
    whole = np.linalg.qr(still, mode="complete")[0] if n_rigid else np.eye(n)
    rest = whole[:, n_rigid:]
    reduced = rest.T @ scaled @ rest
    squares, vectors = eigh(0.5 * (reduced + reduced.T))
    basis = np.hstack([whole[:, :n_rigid], rest @ vectors])
    return RealModes(
        shapes=np.asarray(solve_triangular(root, basis, lower=True, trans="T"), float),
        squared=np.concatenate([np.zeros(n_rigid), squares]),
        frequencies=np.concatenate([np.zeros(n_rigid), np.maximum(np.sqrt(np.abs(squares)), SLOWEST)]),
        n_rigid=n_rigid,
    )


def _not_resisted(rigid: Array, stiffness: Array) -> Array:
    """(n, n_rigid) combinations of the candidates that the stiffness does not resist."""
    scale = float(np.max(np.diag(stiffness), initial=1e-300))
    rigid = rigid[:, np.any(rigid != 0.0, axis=0)]
    values, vectors = np.linalg.eigh(rigid.T @ stiffness @ rigid)
    return np.asarray(rigid @ vectors[:, np.abs(values) < 1e-9 * scale])
