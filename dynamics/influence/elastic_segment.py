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

    Both halves of a spur gear are the same: loads are parted into what is alike on them and what is opposite.
    """
    n = len(segment.points)
    forces = np.asarray(loads.T.toarray()).reshape(n, 3, -1)
    free = np.ones((n, 3), dtype=bool)
    free[segment.bore] = False
    free[:, 2] &= not plane_strain
    mirror = segment.mirror
    if mirror is None or plane_strain:
        moved = _solved(segment, material, np.ones(n, dtype=bool), [(free, forces)])[0]
        return moved.reshape(3 * n, -1)
    upper, turned_over = segment.points[:, 2] > -segment.slack, np.array([1.0, 1.0, -1.0])[:, None]
    middle = mirror == np.arange(n)
    systems = []
    for sign, held in ((1.0, [2]), (-1.0, [0, 1])):  # in the middle plane
        moves = free.copy()
        moves[np.ix_(middle, held)] = False
        share = 0.5 * (forces + sign * turned_over * forces[mirror])
        share[middle] *= 0.5  # the other half has the other half of it
        systems.append((moves, share))
    alike, opposite = _solved(segment, material, upper, systems)
    moved = alike + opposite
    source = mirror[~upper]
    moved[~upper] = turned_over * (alike[source] - opposite[source])
    return moved.reshape(3 * n, -1)


def _solved(
    segment: GearSegment,
    material: Elastic,
    kept: NDArray[np.bool_],
    systems: list[tuple[NDArray[np.bool_], Array]],
) -> list[Array]:
    """Displacements (n_nodes, 3, n_loads) of the part of a segment whose nodes are kept; 0 elsewhere.

    systems : which freedoms (n_nodes, 3) move, and forces (n_nodes, 3, n_loads)
    """
    number = np.cumsum(kept, dtype=np.int32) - np.int32(1)
    cells = number[segment.cells[kept[segment.cells].all(axis=1)]]
    level = Level.of(segment.points[kept], cells, HEXAHEDRON_20)
    blocks = level.elasticity(np.full(len(cells), material.young), np.full(len(cells), material.poisson))
    stiffness = sparse.csr_array(level.block_matrix(blocks).tocsr())
    straight = segment.straight[kept]
    solutions = []
    for moves, forces in systems:
        moving = np.flatnonzero(moves[kept])
        _, first = np.unique(moving // 3, return_index=True)
        reduced = sparse.csr_array(stiffness[moving][:, moving])
        factor = DirectFactor(reduced, straight[moving[first] // 3], first)
        moved = np.zeros(forces.shape)
        moved[kept[:, None] & moves] = factor(forces[kept[:, None] & moves])
        solutions.append(moved)
    return solutions
