"""Multigrid from the second-order space down to a handful of unknowns, as a preconditioner.

The second-order space is smoothed as thermal.fe.smoothing has it; below it stands the linear space on the same
cells, below that smoothed aggregation down to a dense factor. Everything is kept and done in single precision:
the iteration around it works in double precision and corrects it.
Sources: Adams, Brezina, Hu, Tuminaro, J. Comput. Phys. 188 (2003) 593 for the smoother; Saad, Iterative
Methods for Sparse Linear Systems, 2nd ed., ch. 13 for cycles.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import norm

from thermal.fe import kernels
from thermal.fe.aggregation import as_blocks, coarsen, inverse_points
from thermal.fe.arrays import FloatArray, IndexArray

# Products of sparse matrices with vectors, and matrices of small rank.

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
            factor.shape == others.shape and norm(factor - others) <= SAME * norm(others)
            for factor, others in pairs
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


# Smoothing by a polynomial in the scaled matrix, where flat cells tie nodes together too.
#
# A matrix is scaled by the inverse of its diagonal, blocks of 3 in elasticity. Where a cell is nearly flat its
# entries between a few nodes are as large as those on the diagonal: their difference is stiff, what they share
# is as soft as elsewhere, and no scaling node by node serves both. Such nodes form a group whose whole block is
# inverted. A mesh of 97,000 nodes with cells of quality down to 0.0006 then takes 12 iterations instead of 32,
# its expansion 22 instead of 61.
# Sources: Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., ch. 12 and 4.1.1; Adams, Brezina, Hu,
# Tuminaro, J. Comput. Phys. 188 (2003) 593.

SMOOTHED_RANGE = 10.0
"""Largest eigenvalue over the smallest one that the smoother damps; iterations hardly depend on it."""

TIED = 0.5
"""An entry ties two nodes if its size is above this share of the root of their diagonals' product."""

MOST_TIED = 16
"""Nodes of a group."""

RIDGE = 1e-5
"""Share added to the diagonal of a group, which may be a whole loose piece."""


class Scaling:
    """Inverse of the (block) diagonal of a matrix, and of the whole block of every group of tied nodes."""

    def __init__(self, matrix: Matrix) -> None:
        self._diagonal = _inverse_diagonal(matrix).astype(np.float32)
        self._groups = _inverse_groups(matrix)

    def __call__(self, residual: Numbers) -> Numbers:
        """(n,) product with a residual (n,) in single precision."""
        if self._diagonal.ndim == 1:
            y = self._diagonal * residual
        else:
            y = np.empty_like(residual)
            kernels.diagonal_product(self._diagonal, residual.reshape(-1, 3), y.reshape(-1, 3))
        if self._groups is not None:
            unknowns, inverse = self._groups
            y[unknowns] = inverse @ residual
        return np.asarray(y)


class Smoother:
    """Chebyshev iteration on the upper part of the spectrum of the (block) Jacobi-scaled matrix.

    product : of ``matrix`` in single precision; degree : of the polynomial
    """

    def __init__(self, matrix: Matrix, product: Product, degree: int) -> None:
        self._scaling = Scaling(matrix)
        self._degree = degree
        self.largest = 1.1 * largest_eigenvalue(product, self._scaling, matrix.shape[0])

    def __call__(self, product: Product | WithLowRank, x: Numbers | None, residual: Numbers) -> Numbers:
        """Improve ``x`` (zero if None), to which ``residual`` belongs."""
        bounds = (self.largest / SMOOTHED_RANGE, self.largest)
        return chebyshev(product, self._scaling, bounds, self._degree, x, residual)


def chebyshev(
    product: Product | WithLowRank,
    precondition: Callable[[Numbers], Numbers],
    bounds: tuple[float, float],
    degree: int,
    x: Numbers | None,
    residual: Numbers,
) -> Numbers:
    """Improve ``x`` by the polynomial that is smallest for eigenvalues of the preconditioned matrix in bounds.

    Source: Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., algorithm 12.1.
    """
    lower, upper = bounds
    centre, half = 0.5 * (upper + lower), 0.5 * (upper - lower)
    rho = half / centre
    step = precondition(residual)
    step *= np.float32(1.0 / centre)
    x = step.copy() if x is None else x + step
    for _ in range(degree - 1):
        residual = residual - product @ step
        following = 1.0 / (2.0 * centre / half - rho)
        step *= np.float32(following * rho)
        step += np.float32(2.0 * following / half) * precondition(residual)
        rho = following
        x += step
    return x


def _inverse_groups(matrix: Matrix) -> tuple[IndexArray, Product] | None:
    """Unknowns (k,) of all groups of tied nodes, and the (k, n) inverse of their blocks; None if there are none."""
    block = matrix.blocksize[0] if isinstance(matrix, sparse.bsr_array) else 1
    data: FloatArray = np.asarray(matrix.data, dtype=np.float64).reshape(-1, block, block)
    indptr, indices = _places(matrix)
    first, second, strength = kernels.tied_pairs(indptr, indices, data, TIED)
    if not len(first):
        return None
    order = np.argsort(-strength, kind="stable")
    label = kernels.joined(len(indptr) - 1, first[order], second[order], MOST_TIED)
    nodes = np.flatnonzero(label >= 0).astype(np.int32)
    nodes = nodes[np.argsort(label[nodes], kind="stable")]
    _, counts = np.unique(label[nodes], return_counts=True)
    starts = np.cumsum(counts) - counts
    parts: list[tuple[FloatArray, IndexArray, IndexArray]] = []
    for size in np.unique(counts):
        members = nodes[starts[counts == size][:, None] + np.arange(size)]
        dense = _inverses(kernels.group_blocks(indptr, indices, data, members))
        unknowns = (block * members[:, :, None] + np.arange(block)).reshape(len(members), -1)
        columns = np.broadcast_to(unknowns[:, None, :], dense.shape)
        parts.append((dense.ravel(), unknowns.ravel(), columns.ravel()))
    values, unknowns, columns = (np.concatenate(column) for column in zip(*parts, strict=True))
    width = np.concatenate([np.full(len(u), len(v) // len(u)) for v, u, _ in parts])
    start = np.append(0, np.cumsum(width)).astype(np.int32)
    inverse = sparse.csr_array((values, columns, start), shape=(len(unknowns), matrix.shape[0]))
    return unknowns, Product(inverse, np.float32)


def _inverses(blocks: FloatArray) -> FloatArray:
    """(k, n, n) inverses of symmetric positive (semi-)definite blocks."""
    diagonal = np.einsum("kii->ki", blocks)
    scale = np.sqrt(inverse_points(diagonal))
    pairs = scale[:, :, None] * scale[:, None, :]
    whole = pairs * blocks
    np.einsum("kii->ki", whole)[:] = 1.0 + RIDGE
    return np.asarray(pairs * np.linalg.inv(whole))


def _inverse_diagonal(matrix: Matrix) -> FloatArray:
    """Inverse of the diagonal (n,), or of the 3x3 diagonal blocks (n, 3, 3)."""
    if not (isinstance(matrix, sparse.bsr_array) and matrix.blocksize == (3, 3)):
        return inverse_points(matrix.diagonal())
    return np.asarray(np.linalg.inv(kernels.diagonal_blocks(*_places(matrix), matrix.data)))


def _places(matrix: Matrix) -> tuple[IndexArray, IndexArray]:
    """``indptr`` and ``indices`` in the one type that kernels are compiled for."""
    return matrix.indptr.astype(np.int32, copy=False), matrix.indices.astype(np.int32, copy=False)


def largest_eigenvalue(
    matrix: Product, scaling: Callable[[Numbers], Numbers], n: int, steps: int = 12
) -> float:
    """Largest eigenvalue of the scaled matrix (n, n), single precision, from a short Lanczos run with a fixed start."""
    v: Numbers = np.cos(1.0 + np.arange(n) * 2.399963).astype(np.float32)
    w = scaling(v)
    beta = _root_of_dot(v, w)
    v, w = v / beta, w / beta
    last = np.zeros_like(v)
    alphas: list[float] = []
    betas: list[float] = []
    for _ in range(min(steps, n)):
        u = matrix @ w - (betas[-1] * last if betas else np.float32(0.0))
        alpha = float(np.dot(u, w))
        u -= np.float32(alpha) * v
        z = scaling(u)
        alphas.append(alpha)
        beta = _root_of_dot(u, z)
        if beta < 1e-5 * alpha:
            break
        betas.append(float(beta))
        last, v, w = v, u / beta, z / beta
    k = len(alphas)
    small = np.diag(alphas) + np.diag(betas[: k - 1], 1) + np.diag(betas[: k - 1], -1)
    return float(np.linalg.eigvalsh(small)[-1])


def _root_of_dot(a: Numbers, b: Numbers) -> np.float32:
    return np.float32(np.sqrt(max(float(np.dot(a, b)), 0.0)))


DENSE = 600
"""Unknowns that a dense factor takes."""

COARSE_CYCLES = 3
"""Cycles over the linear space for one over the second-order space, which costs ten times as much."""

CYCLE_RANGE = (0.2, 1.05)
"""Eigenvalues of the linear matrix times one cycle: a symmetric cycle has none above 1."""

LOOSE = 1e-10
"""A mode of the last level costs no energy if its share of the largest diagonal entry is below this."""


@dataclass(eq=False)
class _Stage:
    """One level of the hierarchy below the second-order space and the way to the next."""

    product: Product
    smooth: Smoother
    up: Product
    down: Product


class AggregationHierarchy:
    """V-cycles of smoothed aggregation for the matrix of the linear space.

    matrix : symmetric positive definite, or semi-definite with ``modes`` on a piece as its only loose ones
    modes : (n, m) one constant (heat) or six rigid motions (elasticity), zero at held unknowns
    cycles : for one application
    """

    def __init__(self, matrix: Matrix, modes: FloatArray, cycles: int = COARSE_CYCLES) -> None:
        self._cycles = cycles
        self._stages: list[_Stage] = []
        blocks = as_blocks(matrix)
        while matrix.shape[0] > DENSE:
            product = Product(matrix, np.float32)
            smooth = Smoother(matrix, product, 2)
            by_point = inverse_points(matrix.diagonal()).astype(np.float32)
            coarser = coarsen(
                blocks,
                modes,
                largest_eigenvalue(product, partial(np.multiply, by_point), matrix.shape[0]),
                len(self._stages),
            )
            if not 0 < coarser.matrix.shape[0] < 0.7 * matrix.shape[0]:
                break
            up = sparse.csr_array(coarser.prolongation)
            self._stages.append(
                _Stage(
                    product,
                    smooth,
                    Product(up, np.float32),
                    Product(sparse.csr_array(up.T), np.float32),
                )
            )
            blocks, modes = coarser.matrix, coarser.modes
            matrix = sparse.csr_array(blocks)
        self._last = _dense_factor(matrix, modes)

    def __call__(self, residual: Numbers) -> Numbers:
        """Approximate solution (n,) for a right-hand side (n,)."""
        cycle = partial(self._cycle, level=0)
        if not self._stages:
            return cycle(residual)
        return chebyshev(self._stages[0].product, cycle, CYCLE_RANGE, self._cycles, None, residual)

    def _cycle(self, residual: Numbers, level: int) -> Numbers:
        if level == len(self._stages):
            return np.asarray(cho_solve(self._last, residual, check_finite=False))
        stage = self._stages[level]
        x = stage.smooth(stage.product, None, residual)
        x += stage.up @ self._cycle(stage.down @ (residual - stage.product @ x), level + 1)
        return stage.smooth(stage.product, x, residual - stage.product @ x)


def _dense_factor(matrix: Matrix, modes: FloatArray) -> tuple[FloatArray, bool]:
    """Cholesky factor of the last level, loose modes of every piece held by their own size."""
    dense = matrix.toarray()
    scale = float(np.abs(dense.diagonal()).max())
    _, piece = sparse.csgraph.connected_components(sparse.csr_array(matrix), directed=False)
    for number in range(int(piece.max()) + 1):
        members = np.flatnonzero(piece == number)
        vectors, sizes, _ = np.linalg.svd(modes[members], full_matrices=False)
        vectors = vectors[:, sizes > LOOSE * max(float(sizes.max(initial=0.0)), 1e-300)]
        energies, turns = np.linalg.eigh(vectors.T @ dense[np.ix_(members, members)] @ vectors)
        loose = (vectors @ turns)[:, energies < LOOSE * scale]
        dense[np.ix_(members, members)] += scale * loose @ loose.T
    return cho_factor(dense.astype(np.float64), lower=True)


class LinearSpace:
    """Approximate inverse on the linear space: cycles of aggregation, a small-rank part inverted round them.

    matrix : constrained, (n, n); fixed : (n,) unknowns held at zero
    modes : (n, m) see AggregationHierarchy
    """

    def __init__(self, matrix: Matrix, fixed: BoolArray, modes: FloatArray) -> None:
        self._free = (~fixed).astype(np.float32)
        self._cycles = AggregationHierarchy(matrix, modes * ~fixed[:, None])
        self._correction: tuple[FloatArray, FloatArray] | None = None

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Replace the small-rank part, inverted by the Woodbury identity."""
        self._correction = None
        if low_rank is None:
            return
        left = low_rank.left.toarray() * self._free[:, None]
        right = low_rank.right.toarray() * self._free[:, None]
        columns = [self._cycles(column.astype(np.float32)) for column in left.T]
        solved = np.stack(columns, axis=1).astype(np.float64)
        inner = np.eye(left.shape[1]) + right.T @ solved
        self._correction = (solved, np.asarray(np.linalg.solve(inner, right.T), dtype=np.float64))

    def cycle(self, residual: Numbers) -> Numbers:
        """Apply it to a residual (n,) in single precision, not far from 1 in size."""
        y = self._cycles(residual * self._free)
        if self._correction is not None:
            solved, inner = self._correction
            y = (y - solved @ (inner @ y)).astype(np.float32)
        return y * self._free


def _in_single(cycle: Callable[[Numbers], Numbers], residual: FloatArray) -> FloatArray:
    """Apply a cycle in single precision to a residual of any size."""
    size = float(np.abs(residual).max(initial=0.0))
    if size == 0.0:
        return np.zeros_like(residual)
    return np.asarray(size * cycle((residual / size).astype(np.float32)).astype(np.float64))


class HeldMatrix(NamedTuple):
    """A matrix whose rows and columns of held unknowns are their diagonal, see thermal.fe.solver.constrain."""

    matrix: Matrix
    fixed: BoolArray
    """(n,) unknowns held at zero."""


class TwoLevelMultigrid:
    """One symmetric cycle between a second-order matrix and the matrix of its linear sub-space.

    fine, coarse : of the two spaces, 1 or 3 unknowns per node; they may be singular by the ``modes`` on a piece
    prolongation : (n_nodes, n_corners) from FiniteElements
    modes : (n_coarse, m) that cost no energy but for supports: the constant for heat (the shifts if None),
        thermal.fe.aggregation.rigid_modes for elasticity
    degree : of the smoothing polynomial, before and after the linear space

    A small-rank part of the operator (`set_low_rank`) enters both levels; the cycle is then not symmetric.
    """

    def __init__(
        self,
        fine: HeldMatrix,
        coarse: HeldMatrix,
        prolongation: sparse.csr_array,
        modes: FloatArray | None = None,
        degree: int = 3,
    ) -> None:
        self._block = fine.matrix.shape[0] // prolongation.shape[0]
        if modes is None:
            modes = np.tile(np.eye(self._block), (prolongation.shape[1], 1))
        self._coarse = LinearSpace(
            coarse.matrix, coarse.fixed, modes
        )  # first: it needs most room while it is made
        self._fine = Product(fine.matrix, np.float32)
        self._smooth = Smoother(fine.matrix, self._fine, degree)
        self._down = sparse.csr_array(prolongation.T).astype(np.float32)
        self._up = prolongation.astype(np.float32)
        self._free = (~fine.fixed).astype(np.float32)
        self._low_rank: LowRank | None = None
        self._inverted: LowRank | None = None

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Replace the small-rank part; its coarse form is inverted by the Woodbury identity.

        The inverse of a part that differs by less than ``SAME`` serves again: it only guides the iteration.
        """
        self._low_rank = low_rank
        if low_rank is not None and self._inverted is not None and low_rank.near(self._inverted):
            return
        self._inverted = low_rank
        self._coarse.set_low_rank(None if low_rank is None else low_rank.under(self._down))

    def __call__(self, residual: FloatArray) -> FloatArray:
        """Apply the cycle to a residual (n,)."""
        return _in_single(self._cycle, residual)

    def _cycle(self, single: Numbers) -> Numbers:
        x = self._smooth(self._apply, None, single)
        x += self._coarse_correction(single - self._apply @ x)
        return self._smooth(self._apply, x, single - self._apply @ x)

    @property
    def _apply(self) -> Product | WithLowRank:
        return self._fine if self._low_rank is None else WithLowRank(self._fine, self._low_rank)

    def _coarse_correction(self, residual: Numbers) -> Numbers:
        shape = (-1, self._block)
        y = self._coarse.cycle((self._down @ residual.reshape(shape)).ravel())
        return (self._up @ y.reshape(shape)).ravel() * self._free
