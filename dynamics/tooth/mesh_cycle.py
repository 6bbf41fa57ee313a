"""Results of a loaded contact over one mesh cycle."""

from dataclasses import dataclass
from functools import cached_property
from math import cos
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from dynamics.tooth.compliance import LocalContact
from dynamics.tooth.points import ContactPoints

Array = NDArray[np.float64]


Flags = NDArray[np.bool_]
Number = TypeVar("Number", np.float64, np.bool_)


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactPattern:
    """What a flank has seen over its way through the mesh, (n_path, n_face).

    path : (n_path,) path position at mid-face, growing [m]; face : (n_face,) from mid-face [m]
    roll : roll length of the contact on this flank [m]
    pressure : Hertzian, 0 where the flank does not touch [Pa]; half_width : of the contact [m]
    line_load : normal force per length of the contact line [N/m]
    edge : where a tip edge of either gear carries; the pressure there is that of its radius
    """

    path: Array
    face: Array
    roll: Array
    pressure: Array
    half_width: Array
    line_load: Array
    edge: Flags

    def path_at(self, base_helix_angle: float) -> Array:
        """Path positions (n_path, n_face) at the face positions themselves, by the helix angle [rad] [m]."""
        return np.asarray(self.path[:, None] - self.face * np.tan(base_helix_angle))

    @property
    def touched(self) -> Flags:
        """Where the flank carries load."""
        return np.asarray(self.pressure > 0.0)

    @property
    def centre(self) -> tuple[float, float]:
        """Centre of the load on the flank: roll length and face position [m]."""
        total = float(self.line_load.sum())
        roll = float((self.line_load * self.roll).sum()) / total
        return roll, float((self.line_load * self.face).sum()) / total


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshCycle:
    """Loaded contact over one base pitch; arrays over points are (n_positions, n_pairs, n_face).

    mesh_force : transverse force P = T_2 / r_b2 [N]
    points : potential contact points with positions, gaps and directions
    local : local approach of the points
    force : normal force of each point [N]
    closing : local approach where it carries, what is left of the gap along the normal where negative [m]
    approach : (n_positions,) of the gears along the transverse line of action, the transmission error [m]
    tangent_stiffness : (n_positions,) dP/dx at a fixed rotation [N/m]
    """

    mesh_force: float
    points: ContactPoints
    local: LocalContact
    force: Array
    closing: Array
    approach: Array
    tangent_stiffness: Array

    # -- load ------------------------------------------------------------------------------------------------
    @cached_property
    def line_load(self) -> Array:
        """Normal force per length of the contact line [N/m]."""
        return np.asarray(self.force / self.local.length)

    @cached_property
    def load_share(self) -> Array:
        """Share of each tooth pair in the mesh force (n_positions, n_pairs) [-]."""
        return np.asarray((self.points.weight * self.force).sum(axis=2) / self.mesh_force)

    @property
    def torques(self) -> tuple[Array, Array]:
        """Torque of the normal forces on pinion and wheel (n_positions,) [N m].

        That of the wheel is P r_b2; that of the pinion differs from P r_b1 where a corner of the wheel or of the
        pinion touches off the line of action.
        """
        slant = cos(self.points.pair.base_helix_angle)
        first, second = (slant * (lever * self.force).sum(axis=(1, 2)) for lever in self.points.place.lever)
        return first, second

    # -- transmission error and stiffness ----------------------------------------------------------------------
    @cached_property
    def unloaded_approach(self) -> Array:
        """Approach at which the first point touches (n_positions,) [m]: transmission error of the flanks alone."""
        return np.asarray(self.points.gap.min(axis=(1, 2)))

    @property
    def peak_to_peak(self) -> float:
        """Peak to peak of the transmission error [m]."""
        return float(np.ptp(self.approach))

    @property
    def secant_stiffness(self) -> Array:
        """Force per approach since first contact (n_positions,) [N/m]."""
        return np.asarray(self.mesh_force / (self.approach - self.unloaded_approach))

    # -- contact ---------------------------------------------------------------------------------------------
    @cached_property
    def contact_ratio(self) -> float:
        """Mean number of tooth pairs in contact under load [-]."""
        return contact_ratio_of(self.closing.max(axis=2))

    @cached_property
    def half_width(self) -> Array:
        """Half width of the contact [m]."""
        return self.local.half_width(self.force)

    @cached_property
    def pressure(self) -> Array:
        """Largest Hertzian pressure of each point [Pa]; at an edge that of its radius."""
        return self.local.pressure(self.force)

    @property
    def flank_pressure(self) -> float:
        """Largest Hertzian pressure away from tip edges [Pa]; 0 if edges carry everything."""
        return float(np.where(self.edge_contact, 0.0, self.pressure).max())

    @property
    def early(self) -> Flags:
        """Points that carry ahead of the path of contact, at the tip corner of the wheel."""
        return np.asarray(self._at_corner & (self.points.path < self._middle))

    @property
    def late(self) -> Flags:
        """Points that carry behind the path of contact, at the tip corner of the pinion."""
        return np.asarray(self._at_corner & (self.points.path > self._middle))

    @property
    def _at_corner(self) -> Flags:
        return np.asarray((self.force > 0.0) & (self.points.place.corner > 0))

    @property
    def _middle(self) -> float:
        """Middle of the path [m]."""
        limits = self.points.pair.path
        return 0.5 * (limits.start + limits.end)

    @property
    def edge_contact(self) -> Flags:
        """Points that carry at a tip corner or within a half width of a tip edge."""
        near = self._at_corner
        points = self.points
        for roll, tip, base in zip(points.place.roll, points.tips, points.pair.base_radii, strict=True):
            near = near | ((tip.roll**2 - roll**2) / (2.0 * base) < self.half_width)
        return np.asarray(near & (self.force > 0.0))

    def pattern(self, gear: Literal[0, 1]) -> ContactPattern:
        """Contact pattern on the flank of the pinion (0) or the wheel (1), all tooth pairs alike."""
        points = self.points
        path = (points.position[:, None] - points.pair.base_pitch * points.pairs).T[::-1].ravel()
        return ContactPattern(
            path=path,
            face=points.grid.position,
            roll=self._in_turn(points.place.roll[gear]),
            pressure=self._in_turn(self.pressure),
            half_width=self._in_turn(self.half_width),
            line_load=self._in_turn(self.line_load),
            edge=self._in_turn(self.edge_contact),
        )

    def _in_turn(self, table: NDArray[Number]) -> NDArray[Number]:
        """Values of one tooth pair from entering to leaving, (n_pairs n_positions, n_face)."""
        return table.swapaxes(0, 1)[::-1].reshape(-1, table.shape[2])

    # -- load factors ------------------------------------------------------------------------------------------
    @property
    def face_load_factor(self) -> float:
        """K_Hbeta: largest over mean line load over the face, each taken over the mesh cycle [-].

        Source: ISO 6336-1:2006, 7.2.1; in a helical gear every face position meets the whole path, so that the mean
        over the cycle leaves the distribution over the face.
        """
        grid = self.points.grid
        over_face = self.force.sum(axis=(0, 1)) / grid.width
        return float(over_face.max() / (over_face @ grid.width) * grid.face_width)

    @property
    def largest_pair_force(self) -> float:
        """Largest part of the mesh force on one tooth pair [N]."""
        return float(self.load_share.max()) * self.mesh_force

    def transverse_load_factor(self, ideal: "MeshCycle") -> float:
        """K_Halpha: largest force on a tooth pair over that of flanks without deviations, at least 1 [-].

        ideal : cycle of the same pair and force whose pitch and profile are free from deviations, modifications kept
        Source: definition in ISO 6336-1:2006, 8.1.
        """
        return max(1.0, self.largest_pair_force / ideal.largest_pair_force)


# Contact ratio: mean number of tooth pairs that touch, in the limit of no load and under load.

TOUCHING = 1e-12
"""Gap that counts as contact without load [m]: the rounding of the geometry."""


def contact_ratio_of(closing: Array) -> float:
    """Mean number of pairs in contact over a mesh cycle [-].

    closing : (n_positions, n_pairs) of each tooth pair, contact where positive; the last pair came into mesh last, so
        that the columns follow each other. Entering and leaving are interpolated between the positions.
    """
    course = closing.T[::-1].ravel()
    touching = course > 0.0
    part = np.where(touching, 1.0, 0.0)
    before, after = course[:-1], course[1:]
    cross = (touching[:-1] != touching[1:]) & np.isfinite(before) & np.isfinite(after)
    # trapezium over the steps, each counted by the part of it that is in contact
    steps = 0.5 * (part[:-1] + part[1:])
    inside = np.maximum(before[cross], after[cross])
    steps[cross] = inside / (inside - np.minimum(before[cross], after[cross]))
    return float(steps.sum() / closing.shape[0])


def unloaded_contact_ratio(points: ContactPoints, separation: float = TOUCHING) -> float:
    """Contact ratio in the limit of no load, modifications and deviations of the flanks included [-].

    points : over a mesh cycle, a thousand positions or more
    separation : gap that counts as contact [m]

    Pairs touch whose gap is the smallest of all at their position; unmodified flanks do so all over their path.
    Flanks with crowning hand over from pair to pair, which is a contact ratio of 1.
    """
    gap = points.gap.min(axis=2)
    nearest, second = np.partition(gap, 1, axis=1)[:, :2].T[:, :, None]
    # against the nearest other pair: a hand-over crosses zero for both at one place
    return contact_ratio_of(separation + np.where(gap > nearest, nearest, second) - gap)
