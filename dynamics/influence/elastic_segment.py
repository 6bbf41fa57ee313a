"""Elastic solution of a gear segment held on its bore, for many loads on one factor of its stiffness."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from dynamics.influence.segment import GearSegment
from thermal.fe.direct_factor import DirectFactor
from thermal.fe.levels import Level
from thermal.fe.reference_elements import HEXAHEDRON_20

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Elastic:
    """Isotropic material of a gear: Young's modulus [Pa] and Poisson's ratio [-]."""

    young: float
    poisson: float


def solve_segment(
    segment: GearSegment, material: Elastic, loads: sparse.csr_array, plane_strain: bool = False
) -> Array:
    """Displacements (3 n_nodes, n_loads) [m] under loads (n_loads, 3 n_nodes) [N].

    plane_strain : no displacement along z
    """
    n, cells = len(segment.points), len(segment.cells)
    level = Level.of(segment.points, segment.cells, HEXAHEDRON_20)
    blocks = level.elasticity(np.full(cells, material.young), np.full(cells, material.poisson))
    stiffness = sparse.csr_array(level.block_matrix(blocks).tocsr())
    free = np.ones((n, 3), dtype=bool)
    free[segment.bore] = False
    if plane_strain:
        free[:, 2] = False
    moving = np.flatnonzero(free)
    factor = DirectFactor(sparse.csr_array(stiffness[moving][:, moving]), segment.straight[free.any(axis=1)])
    found = np.zeros((3 * n, loads.shape[0]))
    found[moving] = factor(loads.T.tocsr()[moving].toarray())
    return found
