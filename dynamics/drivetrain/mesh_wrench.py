"""Directions of mesh forces beside the line of action of the flank that carries.

The ports of a mesh (`LinearSystem.mesh_ports`) hold the torques of its gears and the lateral force that goes with a
normal force on the flanks that carry. What else the teeth press needs directions of its own: friction acts across the
line of action, the torque from the change of the path turns a gear alone, the other flank has another normal.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshWrench:
    """Rows on the freedoms of a system that see no rigid rotation, and no motion of both gears as one.

    turns : (n_meshes, 2, n) turns of pinion and wheel from their centre line less those of their ports [rad]
    slide : (n_meshes, n) slide of the pinion flank over the wheel's as both move along their centre line [m]
    tangents : (n_meshes,) of the working transverse pressure angles
    sides : (n_meshes,) flank on whose normal the ports see the gears: 1 in front, -1 on the back
    """

    turns: Array
    slide: Array
    tangents: Array
    sides: Array

    def friction_rows(self, laws: Sequence[MeshLaw]) -> Array:
        """(2 n_meshes, n) what torques of friction on pinion and wheel act on beside their ports: each with the
        force across the line of action that both make, their difference over the length T1T2 of the line."""
        found = []
        for turns, slide, side, law in zip(self.turns, self.slide, self.sides, laws, strict=True):
            across = side * slide / line_length(law)
            found += [turns[0] + across, turns[1] - across]
        return np.array(found)

    def loads(self, laws: Sequence[MeshLaw]) -> Array:
        """Columns (n, 3 n_meshes): both friction rows of every mesh, then slides."""
        return np.vstack((self.friction_rows(laws), self.slide)).T

    @property
    def displaced(self) -> Array:
        """Rows (2 n_meshes, n) of slides, then of turns of the pinions beyond those of their ports."""
        return np.vstack((self.slide, self.turns[:, 0]))

    def numbers(self, laws: Sequence[MeshLaw]) -> Array:
        """(n_meshes, 5) plain numbers for the march: side, torques on both friction rows per path torque on the
        pinion less that torque, twice the tangent of the pressure angle, force across per difference of torques."""
        found = []
        for side, tangent, law in zip(self.sides, self.tangents, laws, strict=True):
            length = line_length(law)
            part = tangent / (1.0 + tangent**2) / length
            found.append(
                [
                    side,
                    -part * law.base_radius_1,
                    part * law.base_radius_2,
                    2.0 * tangent,
                    -2.0 * side / length,
                ]
            )
        return np.array(found)


def line_length(law: MeshLaw) -> float:
    """Length T1T2 of the line of action between the base circles [m]."""
    return law.rolling_radius_1 + law.rolling_radius_2
