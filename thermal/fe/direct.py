"""Direct solution: the reference of the iterative solvers, and what is left where they stall.

PARDISO serves where pypardiso can be imported (an optional extra), SuperLU of scipy elsewhere; both give the
solution to rounding. A factor of a three-dimensional mesh fills up with about n^(4/3): fine for tens of
thousands of unknowns, too much for a million.
"""

from importlib.util import find_spec
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from thermal.errors import ThermalInputError
from thermal.fe.arrays import FloatArray

Backend = Literal["pardiso", "superlu"]


class DirectError(ThermalInputError):
    """A direct solver that is not there; the message names it and what to install."""


def available_backend() -> Backend:
    """PARDISO where it is installed, else SuperLU."""
    return "pardiso" if find_spec("pypardiso") is not None else "superlu"


def solve_direct(
    matrix: sparse.csr_array | sparse.bsr_array, load: FloatArray, backend: Backend | None = None
) -> FloatArray:
    """Solve a square regular system.

    matrix : (n, n); load : (n,) or (n, k); backend : the best one there if None
    Raises DirectError for a backend that is not installed.
    """
    chosen = available_backend() if backend is None else backend
    if chosen == "superlu":
        return np.asarray(splu(sparse.csc_array(matrix)).solve(load))
    if find_spec("pypardiso") is None:
        raise DirectError("direct solver 'pardiso' needs the package pypardiso; install it or use 'superlu'")
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver()
    try:
        return np.asarray(solver.solve(sparse.csr_matrix(sparse.csr_array(matrix)), np.asfortranarray(load)))
    finally:
        solver.free_memory(everything=True)
