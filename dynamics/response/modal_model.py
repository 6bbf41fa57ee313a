"""Complex modes of the linear drivetrain between its gear meshes, with its inputs and velocity outputs.

The torsional system is brought to a real-mode basis, one exact rigid mode per shaft line and the elastic
modes of each line, in scaled coordinates ``s = (v, Omega eta)`` with modal velocities ``v``: half its
square is the energy. The rigid angles stand outside (no double zero is left), the complex eigenproblem of
``s' = A s + B u`` is solved once, and only then are fast modes dropped; what they do statically stays as
feedthrough. Real modes come before the complex ones because unscaled complex eigenvectors of free-free shafts
drift.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.kernels import FOUR
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DEFAULT_CUTOFF = 50e3
"""Modes above this frequency [Hz] keep their static effect only."""


class DefectiveModes(DynamicsNotConverged):
    """The complex modes of the drivetrain are no basis (two of them coincide)."""


@dataclass(frozen=True, kw_only=True)
class ModalModel:
    """Complex modes of the linear part with inputs (mesh torques, slow loads, drag torques) and velocity outputs.

    eigenvalues : (n_modes,) kept, one of each conjugate pair [1/s]
    branches : (n_modes,) index of the branch (lines tied by damping) a mode belongs to, not decreasing
    port_branches : (2 n_meshes,) branch of each mesh port
    inputs : (n_modes, n_inputs) modal forcing per unit input
    outputs : (n_rows, n_modes) velocity outputs; rows as in ``row_names``
    through : (n_rows, n_inputs) output of the dropped modes per unit input
    through_rate : (n_rows, n_inputs) the same per unit change of the input per second [s]
    to_modes : (n_modes, n_states) kept left eigenvectors, scaled coordinates -> modal state
    to_scaled : (n_states, n_modes) right eigenvectors
    scaled_through : (n_states, n_inputs) static part of the dropped modes
    shapes : (n, n) real modes, mass-normalised, rigid ones first
    frequencies : (n,) undamped circular frequencies of the lines [rad/s]
    n_meshes, n_slow, n_drags : numbers of meshes, of slow loads and of drag torques
    drag_branches : (n_drags / 4,) branch of each four of drag torques
    dropped : number of eigenvalues left out
    """

    eigenvalues: ComplexArray
    branches: NDArray[np.int64]
    port_branches: NDArray[np.int64]
    inputs: ComplexArray
    outputs: ComplexArray
    through: Array
    through_rate: Array
    to_modes: ComplexArray
    to_scaled: ComplexArray
    scaled_through: Array
    shapes: Array
    frequencies: Array
    inertia: Array
    mesh_ports: NDArray[np.int64]
    n_lines: int
    n_meshes: int
    n_slow: int
    n_drags: int
    drag_branches: NDArray[np.int64]
    dropped: int


def modal_model(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    loads: Array,
    drags: Array | None = None,
    *,
    cutoff: float = DEFAULT_CUTOFF,
) -> ModalModel:
    """Solve the complex eigenproblem of the drivetrain without its meshes.

    Parameters
    ----------
    laws : base radii of each mesh, in the order of ``system.mesh_ports``
    loads : (n, n_slow) torque on each freedom per unit of each slow input [-]
    drags : (n, n_drags) the same of each drag torque, from ``drag_loads``; none when left out
    cutoff : modes above this frequency keep their static effect only [Hz]; ``inf`` keeps all

    Raises
    ------
    ValueError
        If shapes disagree; as DynamicsInputError if the damping is not symmetric, a line is not free to rotate, or a
        drag torque acts on lines that nothing but a mesh ties together.
    DefectiveModes
        If two complex modes coincide.
    """
    n = len(system.inertia)
    drags = np.zeros((n, 0)) if drags is None else drags
    slow_and_drags = np.column_stack((loads, drags))
    _check(system, laws, slow_and_drags)
    shapes, frequencies, n_lines = _line_modes(system)
    damping = shapes.T @ system.damping @ shapes
    damping[np.abs(damping) < 1e-13 * max(np.abs(damping).max(), 1e-300)] = 0.0
    m = n - n_lines
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n] = -damping
    matrix[n_lines:n, n:] = -np.diag(frequencies[n_lines:])
    matrix[n:, n_lines:n] = np.diag(frequencies[n_lines:])
    branch_of = _branches(system, shapes, damping)
    of_state = np.concatenate((branch_of, branch_of[n_lines:]))
    solved = [_branch_modes(matrix, np.flatnonzero(of_state == branch)) for branch in np.unique(branch_of)]
    values = np.concatenate([own for own, _, _ in solved])
    vectors = np.hstack([right for _, right, _ in solved])
    inverse = np.vstack([left for _, _, left in solved])
    branches = np.repeat(np.arange(len(solved)), [len(own) for own, _, _ in solved])
    weights = np.where(values.imag > 0.0, 2.0, 1.0)

    forcing = np.zeros((n + m, 2 * len(laws) + slow_and_drags.shape[1]))
    forcing[:n] = shapes.T @ np.column_stack((_port_columns(system), slow_and_drags))
    modal_forcing = inverse @ forcing
    velocity = _velocity_rows(system, slow_and_drags) @ shapes
    seen = (velocity @ vectors[:n]) * weights
    keep = np.abs(values) <= 2.0 * np.pi * cutoff
    lost, lost_forcing = values[~keep], modal_forcing[~keep]
    static = -lost_forcing / lost[:, None]
    delayed = -lost_forcing / lost[:, None] ** 2
    ports = system.mesh_ports.ravel()
    return ModalModel(
        eigenvalues=values[keep],
        branches=branches[keep],
        port_branches=np.array([branch_of[np.argmax(np.abs(shapes[port]))] for port in ports], np.int64),
        inputs=modal_forcing[keep],
        outputs=seen[:, keep],
        through=(seen[:, ~keep] @ static).real,
        through_rate=(seen[:, ~keep] @ delayed).real,
        to_modes=inverse[keep],
        to_scaled=vectors[:, keep] * weights[keep],
        scaled_through=((vectors[:, ~keep] * weights[~keep]) @ static).real,
        shapes=shapes,
        frequencies=frequencies,
        inertia=np.asarray(system.inertia, float),
        mesh_ports=system.mesh_ports,
        n_lines=n_lines,
        n_meshes=len(laws),
        n_slow=loads.shape[1],
        n_drags=drags.shape[1],
        drag_branches=_drag_branches(shapes, branch_of, drags),
        dropped=int(np.count_nonzero(~keep)),
    )


def _check(system: LinearSystem, laws: Sequence[MeshLaw], loads: Array) -> None:
    n = len(system.inertia)
    if system.mesh_ports.shape != (len(laws), 2):
        raise ValueError(
            f"mesh_ports has shape {system.mesh_ports.shape}, but {len(laws)} mesh laws were given: one per mesh"
        )
    if loads.ndim != 2 or loads.shape[0] != n:
        raise ValueError(f"loads has shape {loads.shape}, expected ({n}, number of slow inputs)")
    if not np.all(system.inertia > 0.0):
        worst = int(np.argmin(system.inertia))
        raise DynamicsInputError(
            f"inertia of {system.dofs[worst]} is {system.inertia[worst]} kg m2, must be positive"
        )
    scale = max(float(np.abs(system.damping).max()), 1e-300)
    if np.abs(system.damping - system.damping.T).max() > 1e-9 * scale:
        raise DynamicsInputError(
            "damping matrix is not symmetric; joints and bearings act equally on both sides"
        )


def _line_modes(system: LinearSystem) -> tuple[Array, Array, int]:
    """Return mass-normalised modes of every line, exact rigid ones first, and their circular frequencies."""
    n = len(system.inertia)
    lines = np.unique(system.lines)
    rigid = np.zeros((n, len(lines)))
    elastic: list[Array] = []
    frequencies: list[Array] = []
    for column, line in enumerate(lines):
        members = np.flatnonzero(system.lines == line)
        others = np.flatnonzero(system.lines != line)
        stiffness = system.stiffness[np.ix_(members, members)]
        largest = max(float(np.abs(stiffness).max()), 1e-300)
        if others.size and np.abs(system.stiffness[np.ix_(members, others)]).max() > 0.0:
            raise DynamicsInputError(
                f"stiffness couples line {line} to another line; only meshes may do that"
            )
        if np.abs(stiffness.sum(axis=1)).max() > 1e-8 * largest:
            raise DynamicsInputError(
                f"line {line} is not free to rotate: its stiffness rows sum to more than 1e-8"
            )
        root = np.sqrt(system.inertia[members])
        uniform = root / np.linalg.norm(root)
        rigid[members, column] = uniform / root
        if len(members) == 1:
            continue
        # an orthonormal basis of everything but the rigid motion keeps the rigid mode exact
        basis = scipy.linalg.null_space(uniform[None, :])
        reduced = basis.T @ (stiffness / np.outer(root, root)) @ basis
        squares, vectors = scipy.linalg.eigh(0.5 * (reduced + reduced.T))
        if squares[0] <= 0.0:
            raise DynamicsInputError(
                f"line {line} is torn: a part of it is held by no stiffness; join it or make it a line"
            )
        block = np.zeros((n, len(members) - 1))
        block[members] = (basis @ vectors) / root[:, None]
        elastic.append(block)
        frequencies.append(np.sqrt(squares))
    shapes = np.hstack((rigid, *elastic))
    return shapes, np.concatenate((np.zeros(len(lines)), *frequencies)), len(lines)


def _branches(system: LinearSystem, shapes: Array, damping: Array) -> NDArray[np.int64]:
    """Return (n,) the branch of every real mode: lines between which nothing but a mesh acts are apart."""
    lines, line_of = np.unique(system.lines, return_inverse=True)
    line_of_mode = line_of[np.argmax(np.abs(shapes), axis=0)]
    tied = np.zeros((len(lines), len(lines)), bool)
    first, second = np.nonzero(damping)
    tied[line_of_mode[first], line_of_mode[second]] = True
    _, branch_of_line = connected_components(tied, directed=False)
    return np.asarray(branch_of_line[line_of_mode], np.int64)


def _branch_modes(
    matrix: Array, members: NDArray[np.int64]
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return eigenvalues (one of each pair, slow ones first), right and left vectors of some states alone."""
    values, vectors = scipy.linalg.eig(matrix[np.ix_(members, members)])
    condition = float(np.linalg.cond(vectors))
    if not condition < 1e12:
        raise DefectiveModes(
            f"complex modes: condition number {condition:.1e} of the eigenvectors, limit 1e12; two modes coincide, "
            "change a joint damping by a part in 1e4"
        )
    inverse = np.linalg.inv(vectors)
    half = np.flatnonzero(values.imag >= 0.0)
    half = half[np.lexsort((values[half].imag, np.abs(values[half])))]
    right = np.zeros((len(matrix), len(half)), complex)
    left = np.zeros((len(half), len(matrix)), complex)
    right[members] = vectors[:, half]
    left[:, members] = inverse[half]
    return values[half], right, left


def _port_columns(system: LinearSystem) -> Array:
    columns = np.zeros((len(system.inertia), 2 * len(system.mesh_ports)))
    for mesh, (pinion, wheel) in enumerate(system.mesh_ports):
        columns[pinion, 2 * mesh] = 1.0
        columns[wheel, 2 * mesh + 1] = 1.0
    return columns


def _drag_branches(shapes: Array, branch_of: NDArray[np.int64], drags: Array) -> NDArray[np.int64]:
    """Return (n_drags / 4,) the branch of every four of drag torques."""
    moved = np.abs(shapes.T @ drags)
    branches = np.zeros(drags.shape[1] // FOUR, np.int64)
    for four in range(len(branches)):
        own = moved[:, FOUR * four : FOUR * (four + 1)].max(axis=1)
        found = np.unique(branch_of[own > 1e-9 * own.max()])
        if len(found) > 1:
            raise DynamicsInputError(
                f"drag torques {FOUR * four} to {FOUR * four + 3} act on {len(found)} shaft lines that only a mesh "
                "ties together, limit 1: let each line begin a new four"
            )
        branches[four] = found[0]
    return branches


def _velocity_rows(system: LinearSystem, loads: Array) -> Array:
    """Rows of velocity outputs: two per mesh port, one per load, then square roots of the joint loss."""
    ports = np.repeat(_port_columns(system).T, 2, axis=0)
    squares, vectors = scipy.linalg.eigh(system.damping)
    lossy = squares > 1e-13 * max(float(squares.max()), 1e-300)
    return np.vstack((ports, loads.T, (vectors[:, lossy] * np.sqrt(squares[lossy])).T))
