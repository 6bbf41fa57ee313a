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
from thermal.fe.shapes import FloatArray, IndexArray

STRONG = 0.08
"""An entry couples two nodes if its size is above this share of the root of their diagonals' product; half of
it on every further level."""

DEPENDENT = 1e-8
"""A mode adds nothing to a group if less than this share of it is left beside the others."""


@dataclass(frozen=True, eq=False)
class CoarserLevel:
    """The next level.

    prolongation : (n, n_coarse); matrix : (n_coarse, n_coarse); modes : (n_coarse, m)
    """

    prolongation: sparse.csr_array
    matrix: sparse.csr_array
    modes: FloatArray


def coarsen(
    matrix: sparse.csr_array, modes: FloatArray, block: int, scaled_largest: float, level: int
) -> CoarserLevel:
    """Make the next level of a symmetric positive (semi-)definite matrix.

    matrix : (n, n) with ``block`` unknowns per node; modes : (n, m) that the next level must hold
    scaled_largest : largest eigenvalue of the matrix scaled by its diagonal; level : 0 for the first
    """
    nodes = _node_strengths(matrix, block)
    diagonal = nodes.diagonal()
    rows = np.repeat(np.arange(len(diagonal)), np.diff(nodes.indptr))
    limit = (STRONG * 0.5**level) ** 2
    strong = nodes.data**2 > limit * np.abs(diagonal[rows] * diagonal[nodes.indices])
    group = kernels.aggregates(nodes.indptr, nodes.indices, strong)
    tentative, coarse_modes = _tentative(group, modes, block)
    inverse = 1.0 / np.where(matrix.diagonal() > 0.0, matrix.diagonal(), 1.0)
    slope = sparse.csr_array(matrix @ tentative)
    slope.data *= np.repeat((4.0 / 3.0 / scaled_largest) * inverse, np.diff(slope.indptr))
    prolongation = sparse.csr_array(tentative - slope)
    coarse = sparse.csr_array(prolongation.T @ sparse.csr_array(matrix @ prolongation))
    empty = coarse.diagonal() == 0.0
    if empty.any():
        coarse = sparse.csr_array(coarse + sparse.diags_array(empty.astype(np.float64)))
    return CoarserLevel(prolongation, coarse, coarse_modes)


def _node_strengths(matrix: sparse.csr_array, block: int) -> sparse.csr_array:
    """(n_nodes, n_nodes) size of the coupling between two nodes."""
    if block == 1:
        return matrix
    blocks = sparse.bsr_array(matrix, blocksize=(block, block))
    sizes = np.linalg.norm(blocks.data, axis=(1, 2))
    n = len(blocks.indptr) - 1
    return sparse.csr_array((sizes, blocks.indices, blocks.indptr), shape=(n, n))


def _tentative(group: IndexArray, modes: FloatArray, block: int) -> tuple[sparse.csr_array, FloatArray]:
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
    columns = (m * owner[:, None] + np.arange(m)).ravel()
    shape = (len(modes), m * n_groups)
    entries = sparse.coo_array((basis.ravel(), (np.repeat(inside, m), columns)), shape=shape)
    return sparse.csr_array(entries), coarse.reshape(-1, m)


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
