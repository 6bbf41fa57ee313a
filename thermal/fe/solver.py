"""Linear solvers: two-level multigrid as a preconditioner, conjugate gradients, GMRES, and a direct check.

The second-order space is smoothed by a Chebyshev polynomial in the (block) Jacobi-scaled matrix; the linear
space on the same mesh is factorised. Sources: Adams, Brezina, Hu, Tuminaro, J. Comput. Phys. 188 (2003) 593
for the smoother; Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., algorithms 9.1 and 9.6.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from thermal.fe.mesh import FloatArray

Matrix = sparse.csr_array | sparse.bsr_array
M = TypeVar("M", sparse.csr_array, sparse.bsr_array)
SMOOTHED_RANGE = 10.0
"""Largest eigenvalue over the smallest one that the smoother damps; iterations hardly depend on it."""

BoolArray = NDArray[np.bool_]
Operator = Callable[[FloatArray], FloatArray]


class NotConverged(RuntimeError):  # noqa: N818
    """An iteration that did not reach its tolerance; ``residuals`` holds its history."""

    def __init__(self, message: str, residuals: tuple[float, ...]) -> None:
        super().__init__(message)
        self.residuals = residuals


@dataclass(frozen=True)
class LinearSolution:
    """Solution (n,) with the residual 2-norms relative to the right-hand side, the start included."""

    values: FloatArray
    residuals: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """Number of iterations made."""
        return len(self.residuals) - 1


@dataclass(frozen=True)
class LowRank:
    """The sum of left_k right_k^T over k, as two (n, k) sparse matrices."""

    left: sparse.csc_array
    right: sparse.csc_array

    def __matmul__(self, x: FloatArray) -> FloatArray:
        return np.asarray(self.left @ (self.right.T @ x))


def constrain(matrix: M, fixed: BoolArray) -> M:
    """Replace rows and columns of ``fixed`` (n,) unknowns by their diagonal. The input is left as it is.

    A right-hand side that is zero there then gives a solution that is zero there.
    """
    if not fixed.any():
        return matrix
    if isinstance(matrix, sparse.bsr_array):
        return _constrain_blocks(matrix, fixed)
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    drop = (fixed[rows] | fixed[matrix.indices]) & (rows != matrix.indices)
    return sparse.csr_array((np.where(drop, 0.0, matrix.data), matrix.indices, matrix.indptr), matrix.shape)


def _constrain_blocks(matrix: sparse.bsr_array, fixed: BoolArray) -> sparse.bsr_array:
    of_node = fixed.reshape(-1, 3)
    rows = np.repeat(np.arange(len(of_node)), np.diff(matrix.indptr))
    some: BoolArray = np.asarray(of_node.any(axis=1))
    touched = np.flatnonzero(some[rows] | some[matrix.indices])
    data = matrix.data.copy()
    row, column = rows[touched], matrix.indices[touched]
    drop = of_node[row][:, :, None] | of_node[column][:, None, :]
    diagonal = (row == column)[:, None, None] & np.eye(3, dtype=np.bool_)
    data[touched] = np.where(drop & ~diagonal, 0.0, data[touched])
    return sparse.bsr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


class TwoLevelMultigrid:
    """One symmetric V-cycle between a second-order matrix and the matrix of its linear sub-space.

    fine, coarse : constrained matrices (see `constrain`), 1 or 3 unknowns per node
    prolongation : (n_nodes, n_corners) from FiniteElements
    fixed, fixed_coarse : unknowns held at zero in the two spaces
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
        degree: int = 3,
    ) -> None:
        self._fine = fine
        self._down = sparse.csr_array(prolongation.T)
        self._up = prolongation
        self._block = fine.shape[0] // prolongation.shape[0]
        self._free = ~fixed
        self._free_coarse = ~fixed_coarse
        self._inverse = _inverse_diagonal(fine)
        self._degree = degree
        self._largest = 1.05 * _largest_eigenvalue(fine, self._inverse)
        self._factor = splu(
            sparse.csc_array(coarse), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )  # fmt: skip
        self._low_rank: LowRank | None = None
        self._correction: tuple[FloatArray, FloatArray] | None = None

    def set_low_rank(self, low_rank: LowRank | None) -> None:
        """Replace the small-rank part; its coarse form is inverted by the Woodbury identity."""
        self._low_rank, self._correction = low_rank, None
        if low_rank is None:
            return
        left = (self._down @ low_rank.left).toarray() * self._free_coarse[:, None]
        right = (self._down @ low_rank.right).toarray() * self._free_coarse[:, None]
        solved = self._factor.solve(left)
        inner = np.eye(left.shape[1]) + right.T @ solved
        self._correction = (solved, np.linalg.solve(inner, right.T))

    def __call__(self, residual: FloatArray) -> FloatArray:
        """Apply the cycle to a residual (n,)."""
        x = self._smooth(np.zeros_like(residual), residual)
        x += self._coarse_correction(residual - self._apply(x))
        return self._smooth(x, residual - self._apply(x))

    def _apply(self, x: FloatArray) -> FloatArray:
        y = self._fine @ x
        return y if self._low_rank is None else y + self._low_rank @ x

    def _coarse_correction(self, residual: FloatArray) -> FloatArray:
        shape = (-1, self._block)
        coarse = (self._down @ residual.reshape(shape)).ravel() * self._free_coarse
        y = self._factor.solve(coarse)
        if self._correction is not None:
            solved, inner = self._correction
            y -= solved @ (inner @ y)
        return np.asarray((self._up @ y.reshape(shape)).ravel() * self._free)

    def _smooth(self, x: FloatArray, residual: FloatArray) -> FloatArray:
        """Chebyshev iteration on the upper part of the spectrum; ``residual`` belongs to ``x``."""
        upper = self._largest
        lower = upper / SMOOTHED_RANGE
        centre, half = 0.5 * (upper + lower), 0.5 * (upper - lower)
        rho = half / centre
        step = (self._inverse @ residual) / centre
        x = x + step
        for _ in range(self._degree - 1):
            residual = residual - self._apply(step)
            following = 1.0 / (2.0 * centre / half - rho)
            step = following * rho * step + (2.0 * following / half) * (self._inverse @ residual)
            rho = following
            x += step
        return x


def _inverse_diagonal(matrix: Matrix) -> Matrix:
    """Inverse of the diagonal, or of the 3x3 diagonal blocks."""
    if not isinstance(matrix, sparse.bsr_array):
        return sparse.csr_array(sparse.diags_array(1.0 / matrix.diagonal()))
    n = len(matrix.indptr) - 1
    rows = np.repeat(np.arange(n), np.diff(matrix.indptr))
    blocks = np.linalg.inv(matrix.data[rows == matrix.indices])
    return sparse.bsr_array((blocks, np.arange(n), np.arange(n + 1)), shape=matrix.shape)


def _largest_eigenvalue(matrix: Matrix, inverse: Matrix, steps: int = 12) -> float:
    """Largest eigenvalue of inverse @ matrix from a short Lanczos run with a fixed start."""
    n = matrix.shape[0]
    v = np.cos(1.0 + np.arange(n) * 2.399963)
    w = inverse @ v
    beta = np.sqrt(v @ w)
    v, w = v / beta, w / beta
    last = np.zeros(n)
    alphas: list[float] = []
    betas: list[float] = []
    for _ in range(min(steps, n)):
        u = matrix @ w - (betas[-1] * last if betas else 0.0)
        alpha = float(u @ w)
        u -= alpha * v
        z = inverse @ u
        alphas.append(alpha)
        beta = float(np.sqrt(max(u @ z, 0.0)))
        if beta < 1e-10 * alpha:
            break
        betas.append(beta)
        last, v, w = v, u / beta, z / beta
    k = len(alphas)
    small = np.diag(alphas) + np.diag(betas[: k - 1], 1) + np.diag(betas[: k - 1], -1)
    return float(np.linalg.eigvalsh(small)[-1])


def conjugate_gradient(
    matrix: Matrix,
    load: FloatArray,
    preconditioner: Operator,
    *,
    start: FloatArray | None = None,
    tolerance: float = 1e-10,
    max_iterations: int = 200,
) -> LinearSolution:
    """Solve a symmetric positive definite system to ``tolerance`` times the 2-norm of ``load``.

    Raises NotConverged with the residual history after ``max_iterations``.
    """
    x = np.zeros_like(load) if start is None else start.copy()
    scale = float(np.linalg.norm(load))
    if scale == 0.0:
        return LinearSolution(np.zeros_like(load), (0.0,))
    residual = load - matrix @ x
    residuals = [float(np.linalg.norm(residual)) / scale]
    direction = np.zeros_like(load)
    last = 1.0
    while residuals[-1] > tolerance:
        if len(residuals) > max_iterations:
            raise NotConverged(_stalled("conjugate gradients", residuals, tolerance), tuple(residuals))
        z = preconditioner(residual)
        product = float(residual @ z)
        direction = z + (product / last) * direction if len(residuals) > 1 else z
        last = product
        image = matrix @ direction
        length = product / float(direction @ image)
        x += length * direction
        residual -= length * image
        residuals.append(float(np.linalg.norm(residual)) / scale)
    return LinearSolution(x, tuple(residuals))


def gmres(
    operator: Operator,
    load: FloatArray,
    preconditioner: Operator,
    *,
    tolerance: float = 1e-10,
    max_iterations: int = 100,
) -> LinearSolution:
    """Solve a general system by right-preconditioned GMRES without restart, starting from zero.

    Stops at ``tolerance`` times the 2-norm of ``load``. Raises NotConverged with the residual history.
    """
    scale = float(np.linalg.norm(load))
    if scale == 0.0:
        return LinearSolution(np.zeros_like(load), (0.0,))
    basis = [load / scale]
    images: list[FloatArray] = []
    hessenberg = np.zeros((max_iterations + 1, max_iterations))
    residuals = [1.0]
    weights: FloatArray = np.zeros(0)
    while residuals[-1] > tolerance:
        k = len(images)
        if k == max_iterations:
            raise NotConverged(_stalled("GMRES", residuals, tolerance), tuple(residuals))
        images.append(preconditioner(basis[k]))
        w = operator(images[k])
        for i, v in enumerate(basis):
            hessenberg[i, k] = v @ w
            w = w - hessenberg[i, k] * v
        hessenberg[k + 1, k] = np.linalg.norm(w)
        target = np.zeros(k + 2)
        target[0] = 1.0
        weights = np.asarray(np.linalg.lstsq(hessenberg[: k + 2, : k + 1], target)[0])
        residuals.append(float(np.linalg.norm(hessenberg[: k + 2, : k + 1] @ weights - target)))
        if hessenberg[k + 1, k] == 0.0:
            break
        basis.append(w / hessenberg[k + 1, k])
    x = scale * sum((c * z for c, z in zip(weights, images, strict=True)), np.zeros_like(load))
    return LinearSolution(x, tuple(residuals))


def solve_direct(matrix: Matrix, load: FloatArray) -> FloatArray:
    """Solve by sparse LU: the check of the iterative solvers, too slow for large meshes."""
    return np.asarray(splu(sparse.csc_array(matrix)).solve(load))


def _stalled(name: str, residuals: list[float], tolerance: float) -> str:
    return (
        f"{name}: relative residual {residuals[-1]:.3g} after {len(residuals) - 1} iterations is above "
        f"{tolerance:.3g}; check the mesh for flat cells and the supports or films for a loose body"
    )
