"""Forces of a gear mesh from its contact table, for comparison with the sums over slices and for solvers."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.kernels.contact_table import ContactTables
from dynamics.kernels.reactions import MeshStates
from dynamics.kernels.table_reactions import table_reactions

Array = NDArray[np.float64]


class TableReaction(NamedTuple):
    """Reaction of one mesh at n states by its contact table, every field of shape (n,), as in ``MeshReaction``."""

    torque_1: Array
    torque_2: Array
    force_front: Array
    force_back: Array
    torque_1_per_approach: Array
    torque_2_per_approach: Array
    torque_1_per_rate: Array
    torque_2_per_rate: Array
    friction_power: Array
    damping_power: Array
    energy: Array
    tooth_approach: Array
    moment_front: Array
    """Derivative of the energy over the tilt of the front flanks [N m]; 0 on tables without tilt."""
    moment_back: Array


def evaluate_table(
    tables: ContactTables,
    theta_1: ArrayLike,
    approach: ArrayLike,
    omega_1: ArrayLike = 0.0,
    omega_2: ArrayLike = 0.0,
    *,
    tilts: tuple[ArrayLike, ArrayLike] = (0.0, 0.0),
    mesh: int = 0,
) -> TableReaction:
    """Return what a mesh of ``tables`` answers at n states, as ``dynamics.mesh.force.evaluate_mesh`` does.

    tilts : gap that closes per face width from mid-face in front and on the back, (n,) or scalar [rad]
    """
    columns = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(one, float)) for one in (theta_1, approach, omega_1, omega_2, *tilts))
    )
    states = MeshStates(*(np.ascontiguousarray(column) for column in columns[:4]))
    out = np.empty((len(columns[0]), len(TableReaction._fields)))
    table_reactions(tables, mesh, states, np.stack(columns[4:], axis=1), out)
    return TableReaction(*np.ascontiguousarray(out.T))
