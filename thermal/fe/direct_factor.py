"""Sparse factors of one Jacobian, a preconditioner for all those near it.

A time run solves hundreds of systems that differ little. On a small mesh the factors of one of them, with its
small-rank part inverted by the Woodbury identity, solve the others in three to five iterations.
"""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from thermal.fe.mesh import FloatArray
from thermal.fe.solver import LowRank

MOST_NODES = 40_000
"""Nodes up to which factors cost less than multigrid: their fill grows faster than the mesh."""


class DirectFactor:
    """LU factors of a symmetric positive definite matrix (n, n), pivots on the diagonal."""

    def __init__(self, matrix: sparse.csr_array) -> None:
        self._factor = splu(
            sparse.csc_array(matrix),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        self._correction: tuple[FloatArray, FloatArray] | None = None

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Set the small-rank part of the operator."""
        self._correction = None
        if low_rank is None:
            return
        solved = np.asarray(self._factor.solve(low_rank.left.toarray()))
        right = low_rank.right.T
        inner = np.eye(solved.shape[1]) + right @ solved
        self._correction = (solved, np.linalg.solve(inner, right.toarray()))

    def __call__(self, residual: FloatArray) -> FloatArray:
        """Solve for one right-hand side (n,)."""
        y = np.asarray(self._factor.solve(residual))
        if self._correction is None:
            return y
        solved, inner = self._correction
        return np.asarray(y - solved @ (inner @ y))
