"""Complex modes of the linear drivetrain between its gear meshes, with its inputs and velocity outputs.

The system is brought to a real-mode basis, the exact rigid modes of the shaft lines and the elastic modes of each
branch, in scaled coordinates ``s = (v, Omega eta)`` with modal velocities ``v``: half its
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

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.kernels import FOUR
from dynamics.rotor.linear_system import LinearSystem, real_modes
from dynamics.tooth.law import MeshLaw

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DEFAULT_CUTOFF = 50e3
"""Modes above this frequency [Hz] keep their static effect only."""


UNBRAKED = 2e-3
"""Share of the damping of a mode that drag torques add at most where they are left out of it [-]."""
PARTING = 1e-9
"""Share by which the damping is raised where two modes coincide [-]."""


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
    springs : (n - n_lines,) stiffness of each elastic mode over its squared frequency: 1, but for one that a film holds
    n_meshes, n_slow, n_drags : numbers of meshes, of slow loads and of drag torques
    n_circulating : number of the last outputs, in fours: speeds and displacements a', b, b', a whose a' b - b' a is
        what skew stiffness takes [W]
    drag_branches : (n_drags / 4,) branch of each four of drag torques
    wrench_outputs : (5 n_meshes, n_modes) speeds on the rows of ``MeshWrench.loads``, then slides and turns of pinions
        beyond those of their ports; no rows without them
    wrench_through, wrench_through_rate : (5 n_meshes, n_inputs) as ``through`` and ``through_rate``
    wrench_numbers : (n_meshes, 5) see ``MeshWrench.numbers``
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
    springs: Array
    inertia: Array
    mesh_ports: NDArray[np.int64]
    n_lines: int
    n_meshes: int
    n_slow: int
    n_drags: int
    n_circulating: int
    drag_branches: NDArray[np.int64]
    wrench_outputs: ComplexArray
    wrench_through: Array
    wrench_through_rate: Array
    wrench_numbers: Array
    dropped: int


def modal_model(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    loads: Array,
    drags: Array | None = None,
    *,
    cutoff: float = DEFAULT_CUTOFF,
    drag_damping: Array | None = None,
) -> ModalModel:
    """Solve the complex eigenproblem of the drivetrain without its meshes.

    Parameters
    ----------
    laws : base radii of each mesh, in the order of ``system.mesh_ports``
    loads : (n, n_slow) torque on each freedom per unit of each slow input [-]
    drags : (n, n_drags) the same of each drag torque, from ``drag_loads``; none when left out
    cutoff : modes above this frequency keep their static effect only [Hz]; ``inf`` keeps all
    drag_damping : (n_drags,) steepest rise of each drag torque over the speed [N m s/rad]: modes
        whose own damping is far above what it adds give way to the drags statically alone; all move when left out

    Raises
    ------
    ValueError
        If shapes disagree; as DynamicsInputError if a line is not free to rotate or torn, or a drag torque acts on
        lines that nothing but a mesh ties together.
    DefectiveModes
        If two complex modes coincide.
    """
    n = len(system.inertia)
    drags = np.zeros((n, 0)) if drags is None else drags
    slow_and_drags = np.column_stack((loads, drags))
    beside = system.mesh_wrench
    wrench = np.zeros((n, 0)) if beside is None else beside.loads(laws)
    _check(system, laws, slow_and_drags)
    inner = system.coordinates
    of_branches, squared, frequencies, n_lines = _branch_shapes(system)
    damping = of_branches.T @ inner.damping @ of_branches
    damping[np.abs(damping) < 1e-13 * max(np.abs(damping).max(), 1e-300)] = 0.0
    m = n - n_lines
    matrix = np.zeros((n + m, n + m))
    matrix[:n, :n] = -damping
    matrix[n_lines:n, n:] = -np.diag(squared[n_lines:] / frequencies[n_lines:])
    matrix[n:, n_lines:n] = np.diag(frequencies[n_lines:])
    skew = 0.5 * (inner.stiffness - inner.stiffness.T)
    if skew.any():
        elastic = of_branches[:, n_lines:]
        matrix[n_lines:n, n:] -= elastic.T @ skew @ (elastic / frequencies[n_lines:])
    branch_of = inner.branches[np.argmax(np.abs(of_branches), axis=0)]
    shapes = inner.freedoms @ of_branches
    of_state = np.concatenate((branch_of, branch_of[n_lines:]))
    groups = _groups(shapes.T @ np.column_stack((_port_columns(system), drags)), branch_of)
    in_order = np.argsort(groups, kind="stable")
    solved = [_branch_modes(matrix, np.flatnonzero(of_state == branch), n) for branch in in_order]
    values = np.concatenate([eigenvalues for eigenvalues, _, _ in solved])
    vectors = np.hstack([right for _, right, _ in solved])
    inverse = np.vstack([left for _, _, left in solved])
    branches = np.repeat(groups[in_order], [len(eigenvalues) for eigenvalues, _, _ in solved])
    branch_of = groups[branch_of]
    weights = np.where(values.imag > 0.0, 2.0, 1.0)

    forcing = np.zeros((n + m, 2 * len(laws) + slow_and_drags.shape[1] + wrench.shape[1]))
    forcing[:n] = shapes.T @ np.column_stack((_port_columns(system), slow_and_drags, wrench))
    modal_forcing = inverse @ forcing
    pressed = _without_rounding(modal_forcing[:, forcing.shape[1] - wrench.shape[1] :])
    skew_rows = _skew_rows(system)
    displaced = np.zeros((0, n)) if beside is None else beside.displaced
    velocity = np.vstack((wrench.T, displaced, _velocity_rows(system, slow_and_drags), skew_rows)) @ shapes
    seen = (velocity @ vectors[:n]) * weights
    n_wrench = wrench.shape[1] + len(displaced)
    moved = np.r_[wrench.shape[1] : n_wrench, len(seen) - len(skew_rows) + 1 : len(seen) : 2]
    seen[moved] /= np.where(values == 0.0, np.inf, values)
    modal_forcing[:, forcing.shape[1] - wrench.shape[1] :] = pressed
    in_motion = np.ones(modal_forcing.shape, bool)
    free = np.zeros(len(values), bool)
    if drag_damping is not None and drags.shape[1]:
        first = 2 * len(laws) + loads.shape[1]
        of_drags = slice(first, first + drags.shape[1])
        rows = slice(n_wrench + first + 2 * len(laws), n_wrench + first + 2 * len(laws) + drags.shape[1])
        added = drag_damping @ np.abs(seen[rows] * modal_forcing[:, of_drags].T) / weights
        free = added < UNBRAKED * np.abs(values.real)
        in_motion[free, of_drags] = False
        seen[rows, free] = 0.0
    if free.any() or pressed.size:
        # those that drags brake stand first in their branch, those that only tooth forces beside the ports move last
        order = np.lexsort((np.arange(len(values)), pressed.any(axis=1), free, branches))
        values, branches, weights = values[order], branches[order], weights[order]
        vectors, inverse = vectors[:, order], inverse[order]
        modal_forcing, in_motion, seen = modal_forcing[order], in_motion[order], seen[:, order]
    of_wrench, seen = seen[:n_wrench], seen[n_wrench:]
    # branches that no load moves at all stand still
    pushed = np.bincount(branches, weights=np.abs(modal_forcing).max(axis=1))[branches] > 0.0
    keep = (np.abs(values) <= 2.0 * np.pi * cutoff) & pushed
    left = np.unique(branches[keep])
    in_motion[~keep] = False
    # what modes that do not move with an input do of it statically, and with some delay
    lost = np.where(in_motion, 0.0, modal_forcing)
    static = -lost / np.where(np.abs(lost).max(axis=1) > 0.0, values, 1.0)[:, None]
    delayed = static / np.where(np.abs(lost).max(axis=1) > 0.0, values, 1.0)[:, None]
    ports = system.mesh_ports.ravel()
    return ModalModel(
        eigenvalues=values[keep],
        branches=np.searchsorted(left, branches[keep]),
        port_branches=np.searchsorted(left, [branch_of[np.argmax(np.abs(shapes[port]))] for port in ports]),
        inputs=np.where(in_motion, modal_forcing, 0.0)[keep],
        outputs=seen[:, keep],
        through=(seen @ static).real,
        through_rate=(seen @ delayed).real,
        to_modes=inverse[keep],
        to_scaled=vectors[:, keep] * weights[keep],
        scaled_through=((vectors * weights) @ static).real,
        shapes=shapes,
        frequencies=frequencies,
        springs=squared[n_lines:] / frequencies[n_lines:] ** 2,
        inertia=np.asarray(system.inertia, float),
        mesh_ports=system.mesh_ports,
        n_lines=n_lines,
        n_meshes=len(laws),
        n_slow=loads.shape[1],
        n_drags=drags.shape[1],
        n_circulating=len(skew_rows),
        drag_branches=np.searchsorted(left, _drag_branches(shapes, branch_of, drags)),
        wrench_outputs=of_wrench[:, keep],
        wrench_through=(of_wrench @ static).real,
        wrench_through_rate=(of_wrench @ delayed).real,
        wrench_numbers=np.zeros((0, 5)) if beside is None else beside.numbers(laws),
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
    diagonal = np.diag(system.inertia)
    if not np.all(diagonal > 0.0):
        worst = int(np.argmin(diagonal))
        raise DynamicsInputError(
            f"inertia of {system.dofs[worst]} is {diagonal[worst]} kg m2, must be positive"
        )
    scale = max(float(np.abs(system.stiffness).max()), 1e-300)
    for shape in system.rigid.T:
        if np.abs(system.stiffness @ shape).max() > 1e-8 * scale:
            named = system.dofs[int(np.argmax(np.abs(shape)))]
            raise DynamicsInputError(
                f"the line of {named} is not free to rotate: its stiffness rows sum to more than 1e-8 of the largest; "
                "only meshes and dampers may hold a line"
            )


def _branch_shapes(system: LinearSystem) -> tuple[Array, Array, Array, int]:
    """Return mass-normalised modes of every branch in the coordinates of the system, exact rigid ones first, their
    omega^2, the circular frequencies that scale them, and the number of rigid ones."""
    inner = system.coordinates
    n = len(inner.inertia)
    rigid: list[Array] = []
    elastic: list[Array] = []
    squared: list[Array] = []
    frequencies: list[Array] = []
    for branch in np.unique(inner.branches):
        members = np.flatnonzero(inner.branches == branch)
        of_branch = np.ix_(members, members)
        stiffness = inner.stiffness[of_branch]
        modes = real_modes(inner.inertia[of_branch], stiffness, inner.rigid[members])
        if np.array_equal(stiffness, stiffness.T) and np.any(modes.squared[modes.n_rigid :] <= 0.0):
            raise DynamicsInputError(
                f"the line of {_named(system, members[0])} is torn: a part of it is held by no stiffness; join it or "
                "make it a line"
            )
        block = np.zeros((n, len(members)))
        block[members] = modes.shapes
        rigid.append(block[:, : modes.n_rigid])
        elastic.append(block[:, modes.n_rigid :])
        squared.append(modes.squared[modes.n_rigid :])
        frequencies.append(modes.frequencies[modes.n_rigid :])
    n_rigid = sum(block.shape[1] for block in rigid)
    none = np.zeros(n_rigid)
    return (
        np.hstack((*rigid, *elastic)),
        np.concatenate((none, *squared)),
        np.concatenate((none, *frequencies)),
        n_rigid,
    )


def _groups(moved: Array, branch_of: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the group of every branch: those that one port or drag torque moves together are marched as one.

    moved : (n, k) modes per unit of each; branch_of : (n,) branch of each mode
    """
    count = int(branch_of.max()) + 1
    tied = np.eye(count, dtype=bool)
    for column in np.abs(moved).T:
        together = np.unique(branch_of[column > 1e-9 * column.max()])
        tied[np.ix_(together, together)] = True
    return np.asarray(connected_components(tied, directed=False)[1], np.int64)


def _named(system: LinearSystem, coordinate: int) -> str:
    """Name of the freedom that moves most with a coordinate."""
    return system.dofs[int(np.argmax(np.abs(system.coordinates.freedoms[:, coordinate])))]


def _branch_modes(
    matrix: Array, members: NDArray[np.int64], n: int
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return eigenvalues (one of each pair, slow ones first), right and left vectors of some states alone.

    The first ``n`` states are velocities. Two modes that coincide, as those of a critical damper do, are parted by a
    little more damping.
    """
    block, moving = matrix[np.ix_(members, members)], np.ix_(members < n, members < n)
    for more in (0.0, PARTING, 100.0 * PARTING):
        parted = block.copy()
        parted[moving] *= 1.0 + more
        values, vectors = np.linalg.eig(parted)
        try:
            inverse = np.linalg.inv(vectors)
        except np.linalg.LinAlgError:
            condition = np.inf
            continue
        condition = float(np.linalg.norm(vectors, 1) * np.linalg.norm(inverse, 1))
        if condition < 1e12:
            break
    else:
        raise DefectiveModes(
            f"complex modes: condition number {condition:.1e} of the eigenvectors, limit 1e12; two modes coincide, "
            "change a joint damping by a part in 1e4"
        )
    half = np.flatnonzero(values.imag >= 0.0)
    half = half[np.lexsort((values[half].imag, np.abs(values[half])))]
    right = np.zeros((len(matrix), len(half)), complex)
    left = np.zeros((len(half), len(matrix)), complex)
    right[members] = vectors[:, half]
    left[:, members] = inverse[half]
    return values[half], right, left


def _without_rounding(forcing: ComplexArray) -> ComplexArray:
    """Forcing without what rounding leaves of modes that do not move with an input."""
    largest = np.abs(forcing).max(axis=0, initial=1e-300, keepdims=True)
    return np.where(np.abs(forcing) < 1e-10 * largest, 0.0, forcing)


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
        motion = moved[:, FOUR * four : FOUR * (four + 1)].max(axis=1)
        lines = np.unique(branch_of[motion > 1e-9 * motion.max()])
        if len(lines) > 1:
            raise DynamicsInputError(
                f"drag torques {FOUR * four} to {FOUR * four + 3} act on {len(lines)} shaft lines that only a mesh "
                "ties together, limit 1: let each line begin a new four"
            )
        branches[four] = lines[0]
    return branches


def _velocity_rows(system: LinearSystem, loads: Array) -> Array:
    """Rows of velocity outputs: two per mesh port, one per load, then square roots of the joint loss."""
    ports = np.repeat(_port_columns(system).T, 2, axis=0)
    squares, vectors = scipy.linalg.eigh(0.5 * (system.damping + system.damping.T))
    lossy = squares > 1e-13 * max(float(squares.max()), 1e-300)
    return np.vstack((ports, loads.T, (vectors[:, lossy] * np.sqrt(squares[lossy])).T))


def _skew_rows(system: LinearSystem) -> Array:
    """Rows a, b, b, a over the freedoms in fours: the sum of a b' - b a' is the skew part of the stiffness."""
    skew = 0.5 * (system.stiffness - system.stiffness.T)
    scale = np.abs(system.stiffness).max(initial=0.0)
    if np.abs(skew).max(initial=0.0) <= 1e-13 * scale:
        return np.zeros((0, len(skew)))
    # i S is Hermitian: its positive eigenvalues s with vectors b + i a give S = sum of 2 s (a b' - b a')
    values, vectors = scipy.linalg.eigh(1j * skew)
    acting = values > 1e-13 * scale
    rows = vectors[:, acting].T * np.sqrt(2.0 * values[acting])[:, None]
    return np.stack((rows.imag, rows.real, rows.real, rows.imag), axis=1).reshape(-1, len(skew))
