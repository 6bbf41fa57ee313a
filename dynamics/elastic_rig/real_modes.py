"""Real modes of the undamped rig at rest with a symmetric reference stiffness of its bearings.

The blocks of freedoms that mass and stiffness tie (torsion, axial motion and the two bending planes of each shaft line,
unless a housing joins them) are solved one by one, so a mode is exactly zero outside its block. The rigid motions that
the rig leaves free are exact by construction: frequency 0, shape from the connections alone, taken out before the
eigenproblem (K r = 0 is asserted to rounding, never computed as an eigenvalue).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, eigh, qr, solve_triangular
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from dynamics.drivetrain.shaft import DrivetrainError
from dynamics.elastic_rig.assembly import ElasticModel
from dynamics.elastic_rig.running_state import BearingCoefficients, RunningState

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
        own = rigid[np.ix_(index, touching)]
        values, vectors = _block_modes(
            model.mass[index][:, index].toarray(), stiffness[index][:, index].toarray(), own
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
