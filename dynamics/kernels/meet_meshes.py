"""Meshes that move each other within one step of the march: their torques on all tangents together."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, inlined
from dynamics.kernels.contact_table import V_FLOOR
from dynamics.kernels.mesh_solve import correct, left_open, move_others
from dynamics.kernels.mesh_tables import POSITIVE
from dynamics.kernels.mesh_workspace import MISSING, N_SPACE, PORT, TAU

# compiled from sources 815a2749
Array = NDArray[np.float64]

TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


@inlined
def meet_others(space: Array, values: Array, give: Array, n_meshes: int) -> bool:
    """Let the meshes move each other; return whether all torques are on their tangents."""
    together = True
    for m in range(n_meshes):
        at = (m * N_SPACE) & POSITIVE
        if move_others(space, at, give, n_meshes, m) > TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR]:
            together = False
    converged = together or _sweep_meshes(space, values, give, n_meshes)
    for m in range(n_meshes):
        at = (m * N_SPACE) & POSITIVE
        if left_open(space, at) > TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR]:
            converged = False
    return converged


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _sweep_meshes(space: Array, values: Array, give: Array, n_meshes: int) -> bool:
    """Bring all torques to the tangents of the meshes, one mesh after the other; return whether that was reached.

    Ends when all but the last mesh met the tolerance one after the other: the last is corrected since and moves the
    others by less still.
    """
    correction, agreed, m = 0, -1, 0
    for n in range(n_meshes):
        at = n * N_SPACE
        space[at + MISSING] -= space[at + TAU]
        space[at + PORT + MISSING] -= space[at + PORT + TAU]
    while agreed < n_meshes - 1 and correction < MOST_SWEEPS * n_meshes:
        at = (m * N_SPACE) & POSITIVE
        error = correct(space, at, give, (4 * m * n_meshes) & POSITIVE, n_meshes)
        agreed = agreed + 1 if error <= TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR] else 0
        m = m + 1 if m + 1 < n_meshes else 0
        correction += 1
    for n in range(n_meshes):
        at = n * N_SPACE
        space[at + MISSING] += space[at + TAU]
        space[at + PORT + MISSING] += space[at + PORT + TAU]
    return agreed >= n_meshes - 1
