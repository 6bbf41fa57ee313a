"""Analytic compliance of the teeth of one gear: Weber and Banaschek's tooth, sliced over the face.

Slices bend on their own or are tied to their neighbours by shear springs: an elastic foundation under a string, whose
deflection under a load of some width fades with exp(-z / coupling length) along the face. Under an even load, springs
or none, every slice deflects as the plane tooth does.
"""

from dataclasses import dataclass
from functools import cached_property
from math import cos

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.gear.pair import GearPair
from dynamics.tooth.mesh_laws import Body, tooth_compliance
from dynamics.tooth.points import FaceGrid

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

USUAL_COUPLING = 1.5
"""Coupling length in normal modules by which a load of narrow width is felt along a tooth (1 to 2)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SliceCompliance:
    """Compliance of the teeth of gear ``index`` of a pair (0 pinion) on the positions of a face grid.

    coupling_length : along the face [m]; 0: slices do not know of each other
    body : half plane under every tooth, or the ring of Sainsot et al. on the bore

    Neighbouring teeth do not know of each other. Raises DynamicsInputError for a negative coupling length or a point
    that is not on the face grid.
    """

    pair: GearPair
    index: int
    grid: FaceGrid
    coupling_length: float = 0.0
    body: Body = "half_plane"
    n_profile: int = 161

    def __post_init__(self) -> None:
        if not self.coupling_length >= 0.0:
            raise DynamicsInputError(
                f"coupling_length = {self.coupling_length} m must not be negative; give 0 for free slices"
            )

    @property
    def tip_roll(self) -> float:
        """Roll length at the tip circle [m]."""
        gear = self.pair.gears[self.index]
        return gear.roll_length(gear.tip_radius)

    @cached_property
    def _table(self) -> tuple[Array, Array, Array]:
        """Roll lengths (n_profile,) [m], compliance per contact length [m2/N] and depth of the axis [m] there."""
        gear, slant = self.pair.gears[self.index], cos(self.pair.base_helix_angle)
        lowest = max(0.5 * gear.roll_length(gear.form_radius), 0.02 * self.tip_roll)
        roll = np.linspace(lowest, self.tip_roll, self.n_profile)
        tooth, body, depth = tooth_compliance(self.pair, self.index, roll / slant, body=self.body)
        return roll, tooth + body, depth

    @cached_property
    def _spread(self) -> Array:
        """(n_f, n_f) share of a force in the line load that bends each slice [1/m]."""
        width, steps = self.grid.width, np.diff(self.grid.position)
        springs = np.diag(width)
        for k, step in enumerate(steps):
            springs[k : k + 2, k : k + 2] += (
                self.coupling_length**2 / step * np.array([[1.0, -1.0], [-1.0, 1.0]])
            )
        inverse = np.linalg.inv(springs)
        return np.asarray(0.5 * (inverse + inverse.T))

    def matrix(self, roll: Array, face: Array, tooth: Integers) -> Array:
        """Compliance (n, n) between points, see `FlankCompliance` [m/N]."""
        grid = self.grid.position
        cell = np.argmin(np.abs(face[:, None] - grid), axis=1)
        if np.any(np.abs(face - grid[cell]) > 1e-9 * self.grid.face_width):
            raise DynamicsInputError(
                "a contact point is not on the face grid of its compliance; give both the same grid"
            )
        table, compliance, _ = self._table
        root = np.sqrt(np.interp(roll, table, compliance) * cos(self.pair.base_helix_angle))
        same_tooth = tooth[:, None] == tooth
        return np.asarray(np.where(same_tooth, np.outer(root, root) * self._spread[np.ix_(cell, cell)], 0.0))

    def depth(self, roll: Array) -> Array:
        """Depth of the tooth axis under the flank, shape of ``roll`` [m]."""
        table, _, depth = self._table
        return np.asarray(np.interp(roll, table, depth))

    def excess(self, roll: Array) -> Array:
        """None: Weber's half space is all of the local approach."""
        return np.zeros_like(roll)

    @property
    def edge_counted(self) -> bool:
        """Not in the half space."""
        return False
