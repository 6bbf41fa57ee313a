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
from scipy import sparse
from scipy.linalg import cho_factor, cho_solve

from thermal.fe.aggregation import as_blocks, coarsen, inverse_points
from thermal.fe.arrays import FloatArray
from thermal.fe.products import BoolArray, LowRank, Matrix, Numbers, Product, WithLowRank
from thermal.fe.smoothing import Smoother, chebyshev, largest_eigenvalue

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
        mine = np.flatnonzero(piece == number)
        vectors, sizes, _ = np.linalg.svd(modes[mine], full_matrices=False)
        vectors = vectors[:, sizes > LOOSE * max(float(sizes.max(initial=0.0)), 1e-300)]
        energies, turns = np.linalg.eigh(vectors.T @ dense[np.ix_(mine, mine)] @ vectors)
        loose = (vectors @ turns)[:, energies < LOOSE * scale]
        dense[np.ix_(mine, mine)] += scale * loose @ loose.T
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
