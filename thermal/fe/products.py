"""Products of sparse matrices with vectors, and matrices of small rank."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import norm

from thermal.fe import kernels

Matrix = sparse.csr_array | sparse.bsr_array
BoolArray = NDArray[np.bool_]
Numbers = NDArray[np.floating]

SAME = 0.05
"""Relative change of a small-rank part up to which its inverse on the linear space is kept."""


class Product:
    """The product of a sparse matrix of scalars or 3x3 blocks with vectors, compiled.

    kind : type of the numbers; single precision makes a copy
    """

    def __init__(self, matrix: Matrix, kind: type[np.floating] = np.float64) -> None:
        self._blocks = isinstance(matrix, sparse.bsr_array) and matrix.blocksize == (3, 3)
        stored = matrix if self._blocks else sparse.csr_array(matrix)
        self._rows = stored.shape[0]
        self._data = stored.data.astype(kind, copy=False)
        self._indptr = stored.indptr.astype(np.uint32, copy=False)
        self._indices = stored.indices.astype(np.int32, copy=False).view(np.uint32)
        self.kind = kind

    def __matmul__(self, x: Numbers) -> Numbers:
        if x.ndim == 2:
            return np.stack([self @ np.ascontiguousarray(column) for column in x.T], axis=1)
        y = np.empty(self._rows, dtype=self.kind)
        indptr, indices = self._indptr, self._indices
        if self._blocks:
            kernels.block_product(indptr, indices, self._data, x.reshape(-1, 3), y.reshape(-1, 3))
        else:
            kernels.scalar_product(indptr, indices, self._data, x, y)
        return y


@dataclass(frozen=True)
class LowRank:
    """The sum of left_k right_k^T over k, as two (n, k) sparse matrices."""

    left: sparse.csc_array
    right: sparse.csc_array

    def near(self, other: "LowRank") -> bool:
        """Whether both factors differ from those of another by less than ``SAME`` of their size."""
        pairs = ((self.left, other.left), (self.right, other.right))
        return all(
            mine.shape == theirs.shape and norm(mine - theirs) <= SAME * norm(theirs)
            for mine, theirs in pairs
        )

    def under(self, down: sparse.csr_array) -> "LowRank":
        """The same part on a smaller space; down : (m, n) takes a residual there."""
        left, right = (sparse.csc_array(down @ factor) for factor in (self.left, self.right))
        return LowRank(left, right)

    def __matmul__(self, x: Numbers) -> Numbers:
        return np.asarray(self.left @ (self.right.T @ x))


class WithLowRank:
    """The sum of a product and a small-rank part."""

    def __init__(self, product: Product, low_rank: LowRank) -> None:
        self._product, self._low_rank = product, low_rank

    def __matmul__(self, x: Numbers) -> Numbers:
        return np.asarray(self._product @ x + (self._low_rank @ x).astype(x.dtype))
