"""Linear solvers: conjugate gradients and GMRES round the multigrid, and supports.

Source: Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., algorithms 9.1 and 9.6.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy import sparse

from thermal.errors import ThermalNotConverged
from thermal.fe import kernels
from thermal.fe.arrays import FloatArray, IndexArray
from thermal.fe.elements import SurfaceElements
from thermal.fe.multigrid import BoolArray, HeldMatrix, LowRank, Matrix, Product, TwoLevelMultigrid

__all__ = [
    "BoolArray",
    "HeldMatrix",
    "LinearSolution",
    "LowRank",
    "Matrix",
    "Operator",
    "Product",
    "TwoLevelMultigrid",
    "conjugate_gradient",
    "constrain",
    "gmres",
]

M = TypeVar("M", sparse.csr_array, sparse.bsr_array)
Operator = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class LinearSolution:
    """Solution (n,) with the residual 2-norms relative to the right-hand side, the start included."""

    values: FloatArray
    residuals: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """Number of iterations made."""
        return len(self.residuals) - 1


def constrain(matrix: M, fixed: BoolArray, *, overwrite: bool = False) -> M:
    """Replace rows and columns of ``fixed`` (n,) unknowns by their diagonal; in the input if ``overwrite``.

    A right-hand side that is zero there then gives a solution that is zero there.
    """
    if not fixed.any():
        return matrix
    data = matrix.data if overwrite else matrix.data.copy()
    block = matrix.blocksize[0] if isinstance(matrix, sparse.bsr_array) else 1
    kernels.hold(matrix.indptr, matrix.indices, data.reshape(-1, block, block), fixed.reshape(-1, block))
    return type(matrix)((data, matrix.indices, matrix.indptr), shape=matrix.shape)


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

    Raises ThermalNotConverged with the residual history after ``max_iterations``.
    """
    product_of = Product(matrix)
    x = np.zeros_like(load) if start is None else start.copy()
    scale = float(np.linalg.norm(load))
    if scale == 0.0:
        return LinearSolution(np.zeros_like(load), (0.0,))
    residual = load - product_of @ x
    residuals = [float(np.linalg.norm(residual)) / scale]
    direction = np.zeros_like(load)
    last = 1.0
    while residuals[-1] > tolerance:
        if len(residuals) > max_iterations:
            raise ThermalNotConverged(_stalled("conjugate gradients", residuals, tolerance), tuple(residuals))
        z = preconditioner(residual)
        product = float(residual @ z)
        direction = z + (product / last) * direction if len(residuals) > 1 else z
        last = product
        image = product_of @ direction
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

    Stops at ``tolerance`` times the 2-norm of ``load``. Raises ThermalNotConverged with the residual history.
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
            raise ThermalNotConverged(_stalled("GMRES", residuals, tolerance), tuple(residuals))
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


def _stalled(name: str, residuals: list[float], tolerance: float) -> str:
    return (
        f"{name}: relative residual {residuals[-1]:.3g} after {len(residuals) - 1} iterations is above "
        f"{tolerance:.3g}; check the mesh for flat cells and the supports or films for a loose body"
    )


# Columns of the small-rank part of a Jacobian: what one mean temperature does to a whole surface.

DIFFERENCE = 0.01
"""Half step of the central difference that gives the slope of a law [K]."""

Column = tuple[IndexArray, FloatArray]
"""Nodes and values of a sparse column; nodes may occur twice."""


def mean_of(surface: SurfaceElements) -> Column:
    """The area mean as a functional of the nodal temperatures [-]."""
    return surface.nodes, surface.shares[surface.nodes] / surface.area


def combined(parts: Sequence[tuple[float, Column]]) -> Column:
    """The sum of columns times a factor each."""
    nodes = np.concatenate([np.empty(0, dtype=np.int32), *(column[0] for _, column in parts)])
    values = np.concatenate([np.empty(0), *(factor * column[1] for factor, column in parts)])
    return nodes.astype(np.int32), values


def stack(columns: Sequence[Column], n_rows: int) -> sparse.csc_array:
    """(n_rows, len(columns)) matrix; values of equal nodes are added."""
    rows = np.concatenate([nodes for nodes, _ in columns])
    values = np.concatenate([values for _, values in columns])
    which = np.repeat(np.arange(len(columns)), [len(nodes) for nodes, _ in columns])
    return sparse.csc_array(sparse.coo_array((values, (rows, which)), shape=(n_rows, len(columns))))
