"""Elastic solution of a gear segment held on its bore, for many loads on one factor of its stiffness."""

from dataclasses import dataclass
from math import tan

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from dynamics.gear.tooth_form import ToothForm
from dynamics.tooth.influence_numbers import STANDARD, GearBody, SectionDivision
from dynamics.tooth.segment import GearSegment
from thermal.fe.direct_factor import DirectFactor
from thermal.fe.elements import Level
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
    for sign, fixed in ((1.0, [2]), (-1.0, [0, 1])):  # in the middle plane
        moves = free.copy()
        moves[np.ix_(middle, fixed)] = False
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


# Cold gear that influence numbers are wanted of.

FACE_POSITIONS = 11
"""Positions over the face."""
NEAR_ENDS = 0.6
"""How much closer they stand near the ends of the face, where lines of contact end and edges press: 0 all alike, 1 as
the points of Chebyshev.

With eleven, interpolated by cubic splines, the mesh stiffness is within 0.5 % and the highest root stress within 4 % of
those of 17 positions, on spur and helical gears, crowned and misaligned by up to 30 um over the face
(tests/verification/test_face_positions.py).
"""


@dataclass(frozen=True, kw_only=True)
class GearModel:
    """Cold gear that influence numbers are wanted of.

    form : outline of its teeth; body : under them; material : of the gear
    face_width : that carries [m]; n_face : positions over it, planes between layers of bricks, closer near its ends
    division : elements of the section
    plane_strain : a slice far from the ends, one layer thick, alike over the face: for quick work
    """

    form: ToothForm
    body: GearBody
    material: Elastic
    face_width: float
    n_face: int = FACE_POSITIONS
    division: SectionDivision = STANDARD
    plane_strain: bool = False

    @property
    def face(self) -> Array:
        """(n_face,) positions from mid-face; both ends of a slice [m]."""
        even = np.linspace(-1.0, 1.0, 2 if self.plane_strain else self.n_face)
        closer = np.sin(0.5 * np.pi * even)
        return np.asarray(0.5 * self.face_width * (even + NEAR_ENDS * (closer - even)))

    @property
    def lead(self) -> float:
        """Turn of the section per z of the model [rad/m]; that of a slice is not counted."""
        return (
            0.0
            if self.plane_strain
            else tan(abs(self.form.gear.helix_angle)) / self.form.gear.reference_radius
        )
