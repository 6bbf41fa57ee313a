"""Multigrid from the second-order space down to a handful of unknowns, as a preconditioner.

The second-order space is smoothed by a Chebyshev polynomial in the (block) Jacobi-scaled matrix; below it
stands the linear space on the same cells, below that smoothed aggregation down to a dense factor. Everything
is kept and done in single precision: the iteration around it works in double precision and corrects it.
Sources: Adams, Brezina, Hu, Tuminaro, J. Comput. Phys. 188 (2003) 593 for the smoother; Saad, Iterative
Methods for Sparse Linear Systems, 2nd ed., ch. 13 for cycles.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import norm

from thermal.fe import kernels
from thermal.fe.aggregation import as_blocks, coarsen, inverse_points
from thermal.fe.shapes import FloatArray

Matrix = sparse.csr_array | sparse.bsr_array
BoolArray = NDArray[np.bool_]
Numbers = NDArray[np.floating]

SMOOTHED_RANGE = 10.0
"""Largest eigenvalue over the smallest one that the smoother damps; iterations hardly depend on it."""

DENSE = 600
"""Unknowns that a dense factor takes."""

COARSE_CYCLES = 3
"""Cycles over the linear space for one over the second-order space, which costs ten times as much."""

CYCLE_RANGE = (0.2, 1.05)
"""Eigenvalues of the linear matrix times one cycle: a symmetric cycle has none above 1."""

SAME = 0.05
"""Relative change of a small-rank part up to which its inverse on the linear space is kept."""

LOOSE = 1e-10
"""A mode of the last level costs no energy if its share of the largest diagonal entry is below this."""


class Product:
    """The product of a sparse matrix of scalars or 3x3 blocks with vectors, compiled.

    kind : type of the numbers; single precision makes a copy
    """

    def __init__(self, matrix: Matrix, kind: type[np.floating] = np.float64) -> None:
        self._matrix = matrix
        self._blocks = isinstance(matrix, sparse.bsr_array) and matrix.blocksize == (3, 3)
        if not self._blocks:
            self._matrix = sparse.csr_array(matrix)
        self._data = self._matrix.data.astype(kind, copy=False)
        self._indptr = self._matrix.indptr.astype(np.uint32, copy=False)
        self._indices = self._matrix.indices.astype(np.int32, copy=False).view(np.uint32)
        self.kind = kind

    def __matmul__(self, x: Numbers) -> Numbers:
        if x.ndim == 2:
            return np.stack([self @ np.ascontiguousarray(column) for column in x.T], axis=1)
        y = np.empty(self._matrix.shape[0], dtype=self.kind)
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

    def __matmul__(self, x: Numbers) -> Numbers:
        return np.asarray(self.left @ (self.right.T @ x))


class _WithLowRank:
    """The sum of a product and a small-rank part."""

    def __init__(self, product: Product, low_rank: LowRank) -> None:
        self._product, self._low_rank = product, low_rank

    def __matmul__(self, x: Numbers) -> Numbers:
        return np.asarray(self._product @ x + (self._low_rank @ x).astype(x.dtype))


class Smoother:
    """Chebyshev iteration on the upper part of the spectrum of the (block) Jacobi-scaled matrix.

    product : of ``matrix`` in single precision; degree : of the polynomial
    """

    def __init__(self, matrix: Matrix, product: Product, degree: int) -> None:
        self._single = _inverse_diagonal(matrix).astype(np.float32)
        self._degree = degree
        self.largest = 1.1 * _largest_eigenvalue(product, self._single)

    def __call__(self, product: Product | _WithLowRank, x: Numbers | None, residual: Numbers) -> Numbers:
        """Improve ``x`` (zero if None), to which ``residual`` belongs."""
        bounds = (self.largest / SMOOTHED_RANGE, self.largest)
        return _chebyshev(product, partial(scaled, self._single), bounds, self._degree, x, residual)


def _chebyshev(
    product: Product | _WithLowRank,
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
            coarser = coarsen(blocks, modes, _largest_eigenvalue(product, by_point), len(self._stages))
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
        return _chebyshev(self._stages[0].product, cycle, CYCLE_RANGE, self._cycles, None, residual)

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
        mine = np.flatnonzero(piece == number)
        vectors, sizes, _ = np.linalg.svd(modes[mine], full_matrices=False)
        vectors = vectors[:, sizes > LOOSE * max(float(sizes.max(initial=0.0)), 1e-300)]
        energies, turns = np.linalg.eigh(vectors.T @ dense[np.ix_(mine, mine)] @ vectors)
        loose = (vectors @ turns)[:, energies < LOOSE * scale]
        dense[np.ix_(mine, mine)] += scale * loose @ loose.T
    return cho_factor(dense.astype(np.float64), lower=True)


def scaled(inverse: Numbers, residual: Numbers) -> Numbers:
    """Product with an inverse diagonal (n,) or inverse diagonal blocks (n, 3, 3)."""
    if inverse.ndim == 1:
        return inverse * residual
    y = np.empty_like(residual)
    kernels.diagonal_product(inverse, residual.reshape(-1, 3), y.reshape(-1, 3))
    return y


def _inverse_diagonal(matrix: Matrix) -> FloatArray:
    """Inverse of the diagonal (n,), or of the 3x3 diagonal blocks (n, 3, 3)."""
    if not (isinstance(matrix, sparse.bsr_array) and matrix.blocksize == (3, 3)):
        return inverse_points(matrix.diagonal())
    return np.asarray(np.linalg.inv(kernels.diagonal_blocks(matrix.indptr, matrix.indices, matrix.data)))


def _largest_eigenvalue(matrix: Product, inverse: Numbers, steps: int = 12) -> float:
    """Largest eigenvalue of inverse @ matrix, single precision, from a short Lanczos run with a fixed start."""
    n = inverse.shape[0] * (1 if inverse.ndim == 1 else 3)
    v: Numbers = np.cos(1.0 + np.arange(n) * 2.399963).astype(np.float32)
    w = scaled(inverse, v)
    beta = _root_of_dot(v, w)
    v, w = v / beta, w / beta
    last = np.zeros_like(v)
    alphas: list[float] = []
    betas: list[float] = []
    for _ in range(min(steps, n)):
        u = matrix @ w - (betas[-1] * last if betas else np.float32(0.0))
        alpha = float(np.dot(u, w))
        u -= np.float32(alpha) * v
        z = scaled(inverse, u)
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


class TwoLevelMultigrid:
    """One symmetric cycle between a second-order matrix and the matrix of its linear sub-space.

    fine, coarse : constrained matrices (see thermal.fe.solver.constrain), 1 or 3 unknowns per node; they may
        be singular by the ``modes`` on a piece
    prolongation : (n_nodes, n_corners) from FiniteElements
    fixed, fixed_coarse : unknowns held at zero in the two spaces
    modes : (n_coarse, m) that cost no energy but for supports: the constant for heat (the shifts if None),
        thermal.fe.aggregation.rigid_modes for elasticity
    degree : of the smoothing polynomial, before and after the linear space

    A small-rank part of the operator (`set_low_rank`) enters both levels; the cycle is then not symmetric.
    """

    def __init__(
        self,
        fine: Matrix,
        coarse: Matrix,
        prolongation: sparse.csr_array,
        fixed: BoolArray,
        fixed_coarse: BoolArray,
        modes: FloatArray | None = None,
        degree: int = 3,
    ) -> None:
        self._fine = Product(fine, np.float32)
        self._smooth = Smoother(fine, self._fine, degree)
        self._down = sparse.csr_array(prolongation.T).astype(np.float32)
        self._up = prolongation.astype(np.float32)
        self._block = fine.shape[0] // prolongation.shape[0]
        self._free = (~fixed).astype(np.float32)
        self._free_coarse = (~fixed_coarse).astype(np.float32)
        if modes is None:
            modes = np.tile(np.eye(self._block), (prolongation.shape[1], 1))
        self._coarse = AggregationHierarchy(coarse, modes * ~fixed_coarse[:, None])
        self._low_rank: LowRank | None = None
        self._inverted: LowRank | None = None
        self._correction: tuple[FloatArray, FloatArray] | None = None

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Replace the small-rank part; its coarse form is inverted by the Woodbury identity.

        The inverse of a part that differs by less than ``SAME`` serves again: it only guides the iteration.
        """
        self._low_rank = low_rank
        if low_rank is None:
            self._inverted = self._correction = None
            return
        if self._inverted is not None and low_rank.near(self._inverted):
            return
        self._inverted = low_rank
        left = (self._down @ low_rank.left).toarray() * self._free_coarse[:, None]
        right = (self._down @ low_rank.right).toarray() * self._free_coarse[:, None]
        columns = [self._coarse(column.astype(np.float32)) for column in left.T]
        solved = np.stack(columns, axis=1).astype(np.float64)
        inner = np.eye(left.shape[1]) + right.T @ solved
        self._correction = (solved, np.linalg.solve(inner, right.T))

    def __call__(self, residual: FloatArray) -> FloatArray:
        """Apply the cycle to a residual (n,)."""
        size = float(np.abs(residual).max(initial=0.0))
        if size == 0.0:
            return np.zeros_like(residual)
        single = (residual / size).astype(np.float32)
        x = self._smooth(self._apply, None, single)
        x += self._coarse_correction(single - self._apply @ x)
        x = self._smooth(self._apply, x, single - self._apply @ x)
        return np.asarray(size * x.astype(np.float64))

    @property
    def _apply(self) -> Product | _WithLowRank:
        return self._fine if self._low_rank is None else _WithLowRank(self._fine, self._low_rank)

    def _coarse_correction(self, residual: Numbers) -> Numbers:
        shape = (-1, self._block)
        coarse = (self._down @ residual.reshape(shape)).ravel() * self._free_coarse
        y = self._coarse(coarse)
        if self._correction is not None:
            solved, inner = self._correction
            y = (y - solved @ (inner @ y)).astype(np.float32)
        return (self._up @ y.reshape(shape)).ravel() * self._free
