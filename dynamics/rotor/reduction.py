"""Reduced elastic rig: real modes up to a cutoff and static shapes of the ports, one basis for all speeds.

Kept modes are exact. What the left-out modes add to the static flexibility of chosen rows (bearings, mesh points,
dampers, drive) is kept as further shapes (residual attachment, MacNeal 1971, Rubin 1975), made mass-orthonormal and
diagonal in stiffness. Any change of stiffness at those rows is therefore exact at rest. The basis does not depend on
speed, so a state carries over from one speed to the next without projection.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, eigh, qr, solve_triangular
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from dynamics.rotor.assembly import ElasticModel, tilt_rows
from dynamics.rotor.beam import DIRECTIONS
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.graph import SplineLoss, spline_losses
from dynamics.rotor.shaft import DrivetrainError

# Real modes of the undamped rig at rest with a symmetric reference stiffness of its bearings.
#
# The blocks of freedoms that mass and stiffness tie (torsion, axial motion and the two bending planes of each shaft
# line, unless a housing joins them) are solved one by one, so a mode is exactly zero outside its block. The rigid
# motions that the rig leaves free are exact by construction: frequency 0, shape from the connections alone, taken out
# before the eigenproblem (K r = 0 is asserted to rounding, never computed as an eigenvalue).

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class RealModes:
    """Complete mass-orthonormal basis, rigid motions first in the order of the model, then by frequency.

    shapes : (n, n), one mode a column; squared : (n,) omega^2, exactly 0 for the rigid ones [1/s2]
    block : (n,) index of the block of freedoms of each mode; reference : bearing -> symmetric stiffness (5, 5) in it
    """

    shapes: Array
    squared: Array
    n_rigid: int
    block: NDArray[np.int64]
    reference: dict[str, Array]


def real_modes(model: ElasticModel, bearings: Mapping[str, BearingCoefficients]) -> RealModes:
    """Modes with the symmetric part of these bearing stiffnesses.

    Raises DrivetrainError for a bearing without coefficients, or stiffnesses that leave a shaft unheld.
    """
    RunningState(bearings=bearings).check(model)
    reference = {name: _symmetric_part(name, value) for name, value in bearings.items()}
    stiffness = model.stiffness
    for name, matrix in reference.items():
        rows = csr_array(model.ports[name])
        stiffness = stiffness + rows.T @ csr_array(matrix) @ rows
    stiffness = csr_array(stiffness)
    stiffness.eliminate_zeros()
    count, block_of = connected_components(abs(stiffness) + abs(model.mass), directed=False)
    rigid = np.array([motion.shape for motion in model.rigid]).reshape(-1, model.size).T
    shapes, squared, block = (
        np.zeros((model.size, model.size)),
        np.zeros(model.size),
        np.zeros(model.size, int),
    )
    filled, first = 0, np.zeros(rigid.shape[1], int)
    for i in range(count):
        index = np.flatnonzero(block_of == i)
        touching = np.flatnonzero(np.abs(rigid[index]).sum(axis=0) > 0.0)
        motions = rigid[np.ix_(index, touching)]
        values, vectors = _block_modes(
            model.mass[index][:, index].toarray(), stiffness[index][:, index].toarray(), motions
        )
        columns = np.arange(filled, filled + index.size)
        shapes[np.ix_(index, columns)] = vectors
        squared[columns], block[columns] = values, i
        first[touching] = columns[: touching.size]
        filled += index.size
    elastic = np.setdiff1d(np.arange(model.size), first)
    if elastic.size and not squared[elastic].min() > 0.0:
        raise DrivetrainError(
            f"bearings leave a shaft unheld: smallest omega^2 = {squared[elastic].min():.6g} 1/s2: must be above 0; "
            "give the reference bearings a positive stiffness"
        )
    sequence = np.concatenate([first, elastic[np.argsort(squared[elastic], kind="stable")]])
    return RealModes(
        shapes=shapes[:, sequence],
        squared=squared[sequence],
        n_rigid=first.size,
        block=block[sequence],
        reference=reference,
    )


def _symmetric_part(name: str, coefficients: BearingCoefficients) -> Array:
    whole = coefficients.padded()[0]
    part = np.asarray(0.5 * (whole + whole.T))
    if not np.linalg.eigvalsh(part[:2, :2])[0] > 0.0:
        raise DrivetrainError(
            f"bearing {name!r}: symmetric part of its lateral stiffness has eigenvalues "
            f"{np.linalg.eigvalsh(part[:2, :2])} N/m: must be above 0 in the reference state of the modes; give a "
            "typical positive stiffness there, states may differ from it"
        )
    return part


def _block_modes(mass: Array, stiffness: Array, rigid: Array) -> tuple[Array, Array]:
    """omega^2 and mass-orthonormal modes of one block, its rigid motions (m, r) first and exact."""
    lower = cholesky(mass, lower=True)
    half = solve_triangular(lower, stiffness, lower=True)
    scaled = solve_triangular(lower, half.T, lower=True)
    scaled = 0.5 * (scaled + scaled.T)
    count = rigid.shape[1]
    if not count:
        values, vectors = eigh(scaled)
        return values, solve_triangular(lower.T, vectors)
    rest = qr(lower.T @ rigid)[0][:, count:]
    values, vectors = eigh(rest.T @ scaled @ rest)
    exact = rigid / np.sqrt(np.einsum("ir,ij,jr->r", rigid, mass, rigid))
    return (
        np.concatenate([np.zeros(count), values]),
        np.hstack([exact, solve_triangular(lower.T, rest @ vectors)]),
    )


Complex = NDArray[np.complex128]
DEPENDENT = 1e-6
"""Singular value, relative to the largest, below which a static shape is a combination of the others."""


@dataclass(frozen=True)
class SplineDamper:
    """Damper on the twist row . q of a spline, row (n,); what it does is `SplineLoss`."""

    row: Array
    loss: SplineLoss


def spline_dampers(model: ElasticModel) -> tuple[SplineDamper, ...]:
    """Of every spline with a loss factor, rows on all freedoms of the model."""
    return tuple(
        SplineDamper(model.joint(loss.gear, "spline").row("turn"), loss)
        for loss in spline_losses(model.rig.drivetrain)
    )


@dataclass(frozen=True)
class ReducedMatrices:
    """Dense M (unity), C with gyroscopics and K with cross-coupling at one running state, each (n, n)."""

    mass: Array
    damping: Array
    stiffness: Array

    def response(self, loads: Array | Complex, frequency: float) -> Complex:
        """Coordinates (n, k) under harmonic loads (n, k) of an angular frequency [rad/s]."""
        dynamic = self.stiffness - frequency**2 * self.mass + 1j * frequency * self.damping
        return np.asarray(np.linalg.solve(dynamic, np.asarray(loads, complex)))


@dataclass(frozen=True, kw_only=True)
class ReducedElasticRig:
    """A rig in mass-orthonormal coordinates eta, q = basis eta; the rigid motions come first.

    basis : (n_full, n); squared : (n,) omega^2 with the reference bearings, 0 for the rigid ones [1/s2]
    damping, gyroscopic, circulation : (n, n) without bearings; the latter two per reference speed, G skew
    drag : (n, n) linear drag of the bearings
    ports : bearing -> (5, n); reference : bearing -> (5, 5) stiffness inside ``squared``
    components : (n,) index of the group of coordinates that anything but a mesh can tie
    attached : (n,) coordinates that stand for static shapes and not for modes
    """

    model: ElasticModel
    basis: Array
    squared: Array
    n_rigid: int
    damping: Array
    gyroscopic: Array
    circulation: Array
    drag: Array
    ports: dict[str, Array]
    reference: dict[str, Array]
    components: NDArray[np.int64]
    attached: NDArray[np.bool_]

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.squared.size

    @property
    def inertia(self) -> Array:
        """(n,) ones: the coordinates are mass-orthonormal."""
        return np.ones(self.size)

    @cached_property
    def rigid(self) -> Array:
        """(n, n_rigid) rigid motions: the first unit vectors."""
        return np.eye(self.size)[:, : self.n_rigid]

    @cached_property
    def spline_dampers(self) -> tuple[SplineDamper, ...]:
        """Dampers of splines with a loss factor, rows (n,) on the coordinates, exactly zero on rigid motions."""
        dampers = []
        for damper in spline_dampers(self.model):
            row = self.rows(damper.row)
            row[: self.n_rigid] = 0.0
            dampers.append(SplineDamper(row, damper.loss))
        return tuple(dampers)

    def rows(self, full: Array) -> Array:
        """Rows (..., n_full) on the freedoms as rows (..., n) on the coordinates; loads likewise."""
        return np.asarray(full @ self.basis)

    def matrices(self, state: RunningState) -> ReducedMatrices:
        """M, C and K at a running state; raises DrivetrainError as `RunningState.check`."""
        state.check(self.model)
        stiffness = np.diag(self.squared) + state.speed * self.circulation
        damping = self.damping + self.drag + state.speed * self.gyroscopic
        for name, coefficients in state.bearings.items():
            rows = self.ports[name]
            bearing_stiffness, bearing_damping = coefficients.padded()
            stiffness += rows.T @ (bearing_stiffness - self.reference[name]) @ rows
            damping += rows.T @ bearing_damping @ rows
        for damper in self.spline_dampers:
            damping += damper.loss.damping(state.speed) * np.outer(damper.row, damper.row)
        for spring in state.springs:
            row = self.rows(spring.row)
            stiffness += spring.stiffness * np.outer(row, row)
            damping += spring.damping * np.outer(row, row)
        return ReducedMatrices(np.eye(self.size), damping, stiffness)


def reduce_rig(
    model: ElasticModel,
    bearings: Mapping[str, BearingCoefficients],
    cutoff: float | None = None,
    rows: Array | None = None,
) -> ReducedElasticRig:
    """Reduced rig with all modes up to a frequency and static shapes for rows.

    bearings : reference state, as typical as can be; its symmetric part makes the modes
    cutoff : highest frequency of the modes [Hz]; None keeps all of them, an exact change of coordinates
    rows : (m, n_full) motions at which static flexibility must be exact; `port_rows_of` unless given

    Raises DrivetrainError for a bearing without coefficients or a reference that leaves a shaft unheld.
    """
    modes = real_modes(model, bearings)
    n = model.size
    limit = np.inf if cutoff is None else (2.0 * np.pi * cutoff) ** 2
    kept = modes.squared <= limit
    basis, squared, block = modes.shapes[:, kept], modes.squared[kept], modes.block[kept]
    attached = np.zeros(squared.size, bool)
    if not kept.all():
        wanted = port_rows_of(model) if rows is None else rows
        shapes, values, blocks = _attachments(modes, ~kept, wanted)
        basis, squared = np.hstack([basis, shapes]), np.concatenate([squared, values])
        block = np.concatenate([block, blocks])
        attached = np.concatenate([attached, np.ones(values.size, bool)])
        order = np.argsort(squared, kind="stable")
        basis, squared, block, attached = basis[:, order], squared[order], block[order], attached[order]
    freedom = np.argmax(np.abs(basis), axis=0)
    rigid = modes.n_rigid
    return ReducedElasticRig(
        model=model,
        basis=basis,
        squared=squared,
        n_rigid=rigid,
        damping=_free_of_rigid(basis.T @ (model.damping @ basis), rigid),
        gyroscopic=_free_of_rigid(basis.T @ (model.gyroscopic @ basis), rigid),
        circulation=_free_of_rigid(basis.T @ (model.circulation @ basis), rigid),
        drag=basis.T @ (model.drag[:, None] * basis),
        ports={name: port @ basis for name, port in model.ports.items()},
        reference=modes.reference,
        components=_components(model, n)[freedom],
        attached=attached,
    )


def port_rows_of(model: ElasticModel) -> Array:
    """(m, n) motions at which something acts from outside the modes: bearings, gears, dampers of joints, motor."""
    rows = list(model.ports.values())
    rows += [model.rows(gear.name) for gear in model.rig.drivetrain.gears]
    rows += [model.rows("motor")[[DIRECTIONS.index("turn")]]]
    for joint in model.joints:
        damped = np.flatnonzero(np.abs(joint.damping).sum(axis=1) > 0.0)
        rows.append(joint.rows[damped])
    rows += [damper.row[None, :] for damper in spline_dampers(model)]
    rows.append(tilt_rows(model))
    return np.vstack(rows)


def _attachments(
    modes: RealModes, left_out: NDArray[np.bool_], rows: Array
) -> tuple[Array, Array, NDArray[np.int64]]:
    """Static shapes of rows from the modes left out, block by block: shapes, omega^2, block."""
    shapes, values, blocks = [], [], []
    for block in np.unique(modes.block[left_out]):
        index = np.flatnonzero(left_out & (modes.block == block))
        squared, vectors = modes.squared[index], modes.shapes[:, index]
        flexibility = (rows @ vectors).T / squared[:, None]
        size = np.linalg.norm(flexibility, axis=0)
        used = size > 0.0
        if not used.any():
            continue
        left, weight, _ = np.linalg.svd(flexibility[:, used] / size[used], full_matrices=False)
        left = left[:, weight > DEPENDENT * weight[0]]
        eigenvalues, turned = np.linalg.eigh(left.T @ (squared[:, None] * left))
        shapes.append(vectors @ (left @ turned))
        values.append(eigenvalues)
        blocks.append(np.full(eigenvalues.size, block))
    if not shapes:
        return np.zeros((rows.shape[1], 0)), np.zeros(0), np.zeros(0, int)
    return np.hstack(shapes), np.concatenate(values), np.concatenate(blocks)


def _free_of_rigid(matrix: Array, n_rigid: int) -> Array:
    """The same without the rounding that forces inside the rig leave on its rigid motions."""
    scale = float(np.abs(matrix).max(initial=0.0))
    edge = max(
        float(np.abs(matrix[:n_rigid]).max(initial=0.0)), float(np.abs(matrix[:, :n_rigid]).max(initial=0.0))
    )
    assert edge <= 1e-6 * scale, "a force inside the rig acts on a rigid motion"
    matrix[:n_rigid] = 0.0
    matrix[:, :n_rigid] = 0.0
    return matrix


def _components(model: ElasticModel, size: int) -> NDArray[np.int64]:
    """Group of every freedom that matrices and bearings can tie, meshes left out."""
    pattern = abs(model.mass) + abs(model.stiffness) + abs(model.damping)
    pattern = pattern + abs(model.gyroscopic) + abs(model.circulation)
    for name, port in model.ports.items():
        used = port if name in model.rig.axially_locating else port[[0, 1, 3, 4]]
        touched = csr_array(np.abs(used).sum(axis=0)[None, :])
        pattern = pattern + touched.T @ touched
    return np.asarray(connected_components(pattern, directed=False)[1], dtype=np.int64)
