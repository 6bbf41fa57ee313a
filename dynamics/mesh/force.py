"""Forces of a gear mesh from its law: totals and tangents for solvers, single tooth pairs for stresses.

A law is packed once (``dynamics.mesh.tables``) and evaluated by the compiled loops of ``dynamics.kernels``.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics import kernels
from dynamics.kernels import PackedMeshes
from dynamics.mesh.law import MeshLaw
from dynamics.mesh.tables import pack_meshes

__all__ = ["MeshReaction", "PackedMeshes", "ToothForces", "evaluate_mesh", "pack_meshes", "tooth_forces"]

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class MeshReaction(NamedTuple):
    """Reaction of one mesh at n states, every field of shape (n,)."""

    torque_1: Array
    """Generalized torque on the pinion body, friction and damping included [N m]."""
    torque_2: Array
    """The same on the wheel body [N m]."""
    force_front: Array
    """Sum of normal forces on the front flanks, in the transverse line of action, >= 0 [N]."""
    force_back: Array
    """The same on the back flanks, >= 0 [N]."""
    torque_1_per_approach: Array
    """d torque_1 / d approach [N]; d force / d approach is its negative over r_b1 when levers are ideal."""
    torque_2_per_approach: Array
    torque_1_per_rate: Array
    """d torque_1 / d (d approach / dt) [N s]."""
    torque_2_per_rate: Array
    torque_1_per_angle: Array
    """d torque_1 / d theta_1 at fixed approach, rate and speeds [N m/rad]."""
    torque_2_per_angle: Array
    friction_power: Array
    """Power lost by sliding, >= 0 [W]."""
    damping_power: Array
    """Power lost by mesh damping, >= 0 [W]."""
    energy: Array
    """Elastic energy of the tooth contacts and of the shared bodies [J]."""
    tooth_approach: Array
    """Approach that the tooth pairs see: that of the gears less what the shared bodies give [m]."""
    path_torque: Array
    """Part of torque_1 from the change of gaps and stiffness over the path [N m]."""
    force_per_approach: Array
    """d (force_front - force_back) / d approach [N/m]."""
    force_per_rate: Array
    """The same over the rate of the approach [N s/m]."""


@dataclass(frozen=True, kw_only=True)
class ToothForces:
    """Forces of single tooth pairs at n states; column c of row n is pair ``pair[n, c]``.

    pair : (n, n_pairs) index p; it joins pinion tooth p mod z1 with wheel tooth (p + tooth_offset_2) mod z2 in front,
        with the one after it on the back
    path : (n, n_pairs) front-flank path position at the middle of the face width (slice_shift = 0) [m]
    back_path : (n, n_pairs) the same on the back flank [m]
    front, back : (n, n_pairs, n_slices) normal force of each slice in the transverse line of action [N]
    """

    pair: Integers
    path: Array
    back_path: Array
    front: Array
    back: Array

    def of_pair(self, pair: int) -> tuple[Array, Array]:
        """Return (path, front force over the whole face) of one pair at the m states that list it."""
        rows, columns = np.nonzero(self.pair == pair)
        return self.path[rows, columns], self.front[rows, columns].sum(axis=-1)


def evaluate_mesh(
    law: MeshLaw | PackedMeshes,
    theta_1: ArrayLike,
    approach: ArrayLike,
    omega_1: ArrayLike,
    omega_2: ArrayLike,
) -> MeshReaction:
    """Return torques, forces, tangents and powers of one mesh at n states.

    Parameters
    ----------
    law : the mesh law, or ``pack_meshes([law])`` where the same law is evaluated many times
    theta_1 : (n,) rotation of the pinion [rad]
    approach : (n,) r_b1 theta_1 - r_b2 theta_2 + offset [m]
    omega_1, omega_2 : (n,) or scalar angular speeds [rad/s]; the approach rate is r_b1 omega_1 - r_b2 omega_2

    Source: potential of ``dynamics.mesh.law``; Oh, Grosh, Barber, ASME J. Mech. Des. 2005, for the torques.
    """
    packed = law if isinstance(law, PackedMeshes) else pack_meshes([law])
    states = _states(theta_1, approach, omega_1, omega_2)
    out = np.empty((len(states.theta_1), len(MeshReaction._fields)))
    kernels.mesh_reactions(packed, states, out)
    return MeshReaction(*np.ascontiguousarray(out.T))


def tooth_forces(
    law: MeshLaw, theta_1: ArrayLike, approach: ArrayLike, omega_1: ArrayLike = 0.0, omega_2: ArrayLike = 0.0
) -> ToothForces:
    """Return the force of every tooth pair that can touch, with its identity and place on the path.

    Arguments as in ``evaluate_mesh``; with both speeds zero they are the elastic forces alone.
    """
    packed = pack_meshes([law], over_phase=False)
    states = _states(theta_1, approach, omega_1, omega_2)
    angle = states.theta_1
    length = law.path_step * (law.stiffness.shape[1] - 1)
    low, high = float(law.slice_shift.min()), float(law.slice_shift.max())
    front = law.phase + law.base_radius_1 * angle
    back = law.back_phase - law.base_radius_1 * angle
    lowest = np.floor((front - high - law.path_start - length) / law.base_pitch).astype(np.int64)
    behind = np.floor(-(back + high - law.path_start) / law.base_pitch).astype(np.int64)
    n_pairs = int((length + high - low) / law.base_pitch) + 3
    lowest_any = np.minimum(lowest, behind)
    n_pairs += int(np.max(np.abs(lowest - behind), initial=0))
    force = np.zeros((len(angle), n_pairs, len(law.slice_shift), 2))
    kernels.tooth_pair_forces(packed, states, lowest_any, force)
    pair = lowest_any[:, None] + np.arange(n_pairs)
    return ToothForces(
        pair=pair,
        path=front[:, None] - pair * law.base_pitch,
        back_path=back[:, None] + pair * law.base_pitch,
        front=force[..., 0],
        back=force[..., 1],
    )


def _states(*columns: ArrayLike) -> kernels.MeshStates:
    broadcast = np.broadcast_arrays(*(np.atleast_1d(np.asarray(column, float)) for column in columns))
    return kernels.MeshStates(*(np.ascontiguousarray(column) for column in broadcast))
