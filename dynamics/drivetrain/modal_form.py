"""Exact complex-modal form of a linear system with rigid modes and strong dampers.

The undamped real modes come first, with the rigid mode of every free line kept exact (frequency 0, shape 1
on the line). In that basis rigid displacements leave the state, only their velocity stays, so the state
matrix has no defective pole; dampers of any strength are real poles of it. Nothing is truncated here.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, eigh

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


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

    def receptance(self, omega: Array, dofs: NDArray[np.int64]) -> Complex:
        """Displacement per torque between some freedoms at frequencies above zero.

        omega : (n_omega,) [rad/s], all > 0; dofs : (n_dofs,). Returns (n_omega, n_dofs, n_dofs) [rad/(N m)].
        """
        out = self.velocity_shapes[dofs]
        into = self.loads[:, dofs]
        s = 1j * np.asarray(omega)
        gain = 1.0 / (s[:, None] - self.poles)
        mobility = np.einsum("im,wm,mj->wij", out, gain, into, optimize=True)
        return np.asarray(mobility / s[:, None, None])


def modal_form(inertia: Array, damping: Array, stiffness: Array, lines: NDArray[np.int64]) -> ModalForm:
    """Complex modes of a system whose freedoms of one line turn freely together.

    inertia : (n,) [kg m2]; damping, stiffness : (n, n) [N m s/rad], [N m/rad]; lines : (n,) index of the
    line. A line that stiffness ties to ground or to another line has no rigid mode and is found by itself.
    """
    root = np.sqrt(inertia)
    basis, squared, n_rigid = _real_modes(root, stiffness, lines)
    modal_damping = basis.T @ (damping / np.outer(root, root)) @ basis
    n = root.size
    n_elastic = n - n_rigid
    frequency = np.sqrt(squared[n_rigid:])
    # states: frequency * elastic displacement, elastic velocity, rigid velocity (all of one unit)
    order = np.concatenate([np.arange(n_rigid, n), np.arange(n_rigid)])
    state = np.zeros((n_elastic + n, n_elastic + n))
    state[:n_elastic, n_elastic : 2 * n_elastic] = np.diag(frequency)
    state[n_elastic : 2 * n_elastic, :n_elastic] = -np.diag(frequency)
    state[n_elastic:, n_elastic:] = -modal_damping[np.ix_(order, order)]
    poles, right = eig(state)
    left = np.linalg.inv(right)
    shape = (basis[:, order] / root[:, None]) @ right[n_elastic:]
    load = left[:, n_elastic:] @ (basis[:, order] / root[:, None]).T
    return ModalForm(
        poles=poles,
        velocity_shapes=shape,
        loads=np.asarray(load, complex),
        rigid=basis[:, :n_rigid] / root[:, None],
    )


def _real_modes(root: Array, stiffness: Array, lines: NDArray[np.int64]) -> tuple[Array, Array, int]:
    """Orthonormal real modes in mass-scaled coordinates, exact rigid ones first: basis, omega^2, n_rigid."""
    scale = float(np.max(np.diag(stiffness), initial=1e-300))
    candidates = _rigid_candidates(lines, stiffness, scale)
    rigid = root[:, None] * candidates
    if rigid.shape[1]:
        rigid = np.linalg.qr(rigid)[0]
    scaled = stiffness / np.outer(root, root)
    whole = np.linalg.qr(np.hstack([rigid, np.eye(root.size)]))[0] if rigid.shape[1] else np.eye(root.size)
    rest = whole[:, rigid.shape[1] :]
    squared, vectors = eigh(rest.T @ scaled @ rest)
    basis = np.hstack([rigid, rest @ vectors])
    return basis, np.concatenate([np.zeros(rigid.shape[1]), np.maximum(squared, 0.0)]), rigid.shape[1]


def _rigid_candidates(lines: NDArray[np.int64], stiffness: Array, scale: float) -> Array:
    """(n, n_rigid) combinations of whole lines that the stiffness does not resist."""
    names = np.unique(lines)
    whole = (lines[:, None] == names).astype(float)
    resisted = whole.T @ stiffness @ whole
    values, vectors = np.linalg.eigh(resisted)
    return np.asarray(whole @ vectors[:, np.abs(values) < 1e-9 * scale])
