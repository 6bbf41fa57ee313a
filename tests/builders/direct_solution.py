"""Solution by SuperLU, which no solver of the product uses: the reference of theirs."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu


def solve_direct(
    matrix: sparse.csr_array | sparse.bsr_array, load: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Solve a square regular system (n, n) for (n,) or (n, k)."""
    return np.asarray(splu(sparse.csc_array(matrix)).solve(load))
