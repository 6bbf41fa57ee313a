"""Smoothed aggregation: the levels below the linear space, for heat and for elasticity.

Nodes are grouped; on every group the modes that cost (nearly) no energy, one constant for heat and six rigid
motions for elasticity, become the unknowns of the next level, smoothed once so that they fit together.
Source: Vanek, Mandel, Brezina, Computing 56 (1996) 179.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from thermal.fe import kernels
from thermal.fe.arrays import FloatArray, IndexArray

STRONG = 0.08
"""An entry couples two nodes if its size is above this share of the root of their diagonals' product; half of
it on every further level."""

DEPENDENT = 1e-8
"""A mode adds nothing to a group if less than this share of it is left independent of the others."""

NOTHING = 1e-12
"""A diagonal entry below this share of the largest is rounding."""


Blocks = sparse.bsr_array
"""A matrix of blocks, unknowns per node by unknowns per node (or per group)."""


@dataclass(frozen=True, eq=False)
class CoarserLevel:
    """The next level.

    prolongation : (n, n_coarse); matrix : (n_coarse, n_coarse); modes : (n_coarse, m)
    """

    prolongation: Blocks
    matrix: Blocks
    modes: FloatArray


def coarsen(matrix: Blocks, modes: FloatArray, scaled_largest: float, level: int) -> CoarserLevel:
    """Make the next level of a symmetric positive (semi-)definite matrix.

    matrix : (n, n) in square blocks, one per pair of nodes; modes : (n, m) that the next level must hold
    scaled_largest : largest eigenvalue of the matrix scaled by its diagonal; level : 0 for the first
    """
    sizes = np.linalg.norm(matrix.data, axis=(1, 2))
    on_diagonal = _diagonal_places(matrix)
    diagonal = sizes[on_diagonal]
    rows = _rows(matrix)
    limit = (STRONG * 0.5**level) ** 2
    strong = sizes**2 > limit * diagonal[rows] * diagonal[matrix.indices]
    group = kernels.aggregates(matrix.indptr, matrix.indices, strong)
    alone = (group < 0) & np.any(modes.reshape(len(group), -1) != 0.0, axis=1)
    group[alone] = group.max(initial=-1) + 1 + np.arange(np.count_nonzero(alone), dtype=np.int32)
    tentative, coarse_modes = _tentative(group, modes, matrix.blocksize[0])
    points = np.einsum("kii->ki", matrix.data[on_diagonal])
    inverse = (4.0 / 3.0 / scaled_largest) * inverse_points(points)
    slope = sparse.bsr_array(matrix @ tentative)
    slope.data *= inverse[_rows(slope)][:, :, None]
    prolongation = sparse.bsr_array(tentative - slope)
    coarse = sparse.bsr_array(prolongation.T @ sparse.bsr_array(matrix @ prolongation))
    coarse.sort_indices()
    on_diagonal = _diagonal_places(coarse)
    diagonal = np.einsum("kii->ki", coarse.data)[on_diagonal]
    places, number = np.nonzero(diagonal == 0.0)
    coarse.data[on_diagonal[places], number, number] = diagonal.max(initial=1.0)
    return CoarserLevel(prolongation, coarse, coarse_modes)


def inverse_points(diagonal: FloatArray) -> FloatArray:
    """Inverse of diagonal entries; zero for those that are zero but for rounding: loose pieces of one group."""
    sound = diagonal > NOTHING * diagonal.max(initial=0.0)
    return np.asarray(np.divide(1.0, diagonal, out=np.zeros_like(diagonal), where=sound))


def as_blocks(matrix: sparse.csr_array | Blocks) -> Blocks:
    """The matrix in blocks, of size 1 if it has none."""
    return matrix if isinstance(matrix, sparse.bsr_array) else sparse.bsr_array(matrix, blocksize=(1, 1))


def _rows(matrix: Blocks) -> NDArray[np.int64]:
    """(nnz,) block row of every block."""
    return np.repeat(np.arange(len(matrix.indptr) - 1), np.diff(matrix.indptr))


def _diagonal_places(matrix: Blocks) -> NDArray[np.int64]:
    """(n_nodes,) place of every diagonal block."""
    return np.flatnonzero(_rows(matrix) == matrix.indices)


def _tentative(group: IndexArray, modes: FloatArray, block: int) -> tuple[Blocks, FloatArray]:
    """Modes made orthonormal on every group: prolongation (n, m n_groups), and modes of the next level."""
    n_groups, m = int(group.max(initial=-1)) + 1, modes.shape[1]
    owner = np.repeat(group, block)
    inside = np.flatnonzero(owner >= 0)
    owner = owner[inside]
    basis = modes[inside].copy()
    coarse = np.zeros((n_groups, m, m))
    for k in range(m):
        size = _group_sum(owner, basis[:, k] ** 2, n_groups)
        for _ in range(2):
            for j in range(k):
                share = _group_sum(owner, basis[:, j] * basis[:, k], n_groups)
                basis[:, k] -= share[owner] * basis[:, j]
                coarse[:, j, k] += share
        left = np.sqrt(_group_sum(owner, basis[:, k] ** 2, n_groups))
        kept = left > DEPENDENT * np.sqrt(size)
        coarse[:, k, k] = np.where(kept, left, 0.0)
        scale = np.divide(1.0, left, out=np.zeros_like(left), where=kept)
        basis[:, k] *= scale[owner]
    start = np.append(0, np.cumsum(group >= 0)).astype(np.int32)
    blocks = (basis.reshape(-1, block, m), group[group >= 0], start)
    return sparse.bsr_array(blocks, shape=(len(modes), m * n_groups)), coarse.reshape(-1, m)


def _group_sum(owner: NDArray[np.int32], values: FloatArray, n_groups: int) -> FloatArray:
    return np.asarray(np.bincount(owner, values, minlength=n_groups), dtype=np.float64)


def rigid_modes(points: FloatArray) -> FloatArray:
    """(3 n, 6) three shifts and three turns about the middle, each of size 1; points : (n, 3)."""
    arm = points - points.mean(axis=0)
    modes = np.zeros((len(points), 3, 6))
    modes[:, :, :3] = np.eye(3)
    for axis in range(3):
        modes[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arm)
    flat = modes.reshape(-1, 6)
    size = np.linalg.norm(flat, axis=0)
    return np.asarray(flat / np.where(size > 0.0, size, 1.0))
