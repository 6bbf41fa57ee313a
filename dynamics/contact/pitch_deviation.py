"""Load sharing of tooth pairs of which every second one stands ahead by a base pitch deviation: K_Halpha."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dynamics.contact.loaded_mesh import LoadedMesh
from dynamics.contact.mesh_cycle import MeshCycle
from dynamics.contact.points import FlankGap

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
POSITIONS = 32
"""Of the mesh cycle at which the highest share is looked for; twice as many find the same."""


def every_second_ahead(gap: FlankGap, deviation: float, first: int) -> FlankGap:
    """The gap of flanks [m] whose tooth pairs ``first``, ``first`` + 2, ... stand ahead by a deviation [m]."""

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        return gap(pair, face, path, rolls) - np.where((pair - first) % 2 == 0, deviation, 0.0)

    return of_points


def transverse_load_factor(mesh: LoadedMesh, ideal: MeshCycle, deviation: float) -> float:
    """K_Halpha: largest force on a tooth pair, each second one ahead, over that of equal pitches, at least 1 [-].

    ideal : cycle of the mesh as it is; deviation : difference of the base pitches of both gears, run in, f_pb - y_alpha
    along the transverse line of action [m]

    The pairs beside the one that is ahead are taken to stand back by all of it: the worst run of pitches that the
    deviation allows. Raises as `LoadedMesh.cycle`.
    Source: definition in ISO 6336-1:2006, 8.1; the deviation is that of its 8.3.2.
    """
    if deviation <= 0.0:
        return 1.0
    return max(
        replace(mesh, gap=every_second_ahead(mesh.gap, deviation, first), n_positions=POSITIONS)
        .cycle(ideal.mesh_force)
        .transverse_load_factor(ideal)
        for first in (0, 1)
    )
