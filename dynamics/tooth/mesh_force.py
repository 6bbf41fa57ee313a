"""Forces of a gear mesh from its law: totals and tangents for solvers, single tooth pairs for stresses.

A law is packed once (``dynamics.tooth.packed_laws``) and evaluated by the compiled loops of ``dynamics.kernels``.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics import kernels
from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.kernels import PackedMeshes
from dynamics.kernels.contact_table import ContactTables
from dynamics.kernels.reactions import MeshStates
from dynamics.kernels.table_reactions import table_reactions
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.packed_laws import pack_meshes

Array = NDArray[np.float64]


__all__ = ["MeshReaction", "PackedMeshes", "ToothForces", "evaluate_mesh", "pack_meshes", "tooth_forces"]

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

    Source: potential of ``dynamics.tooth.law``; Oh, Grosh, Barber, ASME J. Mech. Des. 2005, for the torques.
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


# A mesh law under a constant force over one mesh cycle: what its tables say at rest.

MOST_STEPS = 60
CLOSED = 1e-12
"""Share of the force that may be left open."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StaticCycle:
    """A mesh under a constant force, gears at rest.

    force : in the transverse line of action [N]
    theta : (n,) rotation of the pinion [rad]; approach : (n,) of the gears, the transmission error [m]
    tangent_stiffness : (n,) dP/dx at a fixed rotation [N/m]
    path : (n, n_pairs) path position of the pairs at mid-face [m]
    slice_force : (n, n_pairs, n_slices) in the transverse line of action [N]
    """

    force: float
    theta: Array
    approach: Array
    tangent_stiffness: Array
    path: Array
    slice_force: Array

    @property
    def load_share(self) -> Array:
        """Share of each pair in the force (n, n_pairs) [-]."""
        return np.asarray(self.slice_force.sum(axis=2) / self.force)

    @property
    def mean_slice_force(self) -> float:
        """Mean force of a slice that carries, weighted by the force [N]."""
        return float((self.slice_force**2).sum() / self.slice_force.sum())


def static_cycle(law: MeshLaw, force: float, n: int = 64, start: float | None = None) -> StaticCycle:
    """The law under ``force`` on its front flanks at n rotations over one base pitch.

    start : path position of pair 0 at mid-face at the first rotation [m]; None: the start of the grid

    Past the ends of the tables pairs carry nothing, see ``dynamics.tooth.mesh_laws.reach_beyond``. Raises
    DynamicsInputError for a force that is not positive, DynamicsNotConverged where no pair touches at the widest gap of
    the tables.
    """
    if not (force > 0.0 and np.isfinite(force)):
        raise DynamicsInputError(f"force = {force} N must be positive; the front flanks are loaded")
    first = law.path_start if start is None else start
    theta = (first - law.phase + law.base_pitch * np.arange(n) / n) / law.base_radius_1
    packed = pack_meshes([law])
    # the force bends upwards over the approach: from above, Newton's steps stay there
    highest = float(np.minimum(law.gap[:, 0], law.gap[:, -1]).max())
    approach = np.full(n, highest + force * law.body_compliance)
    for _ in range(MOST_STEPS):
        reaction = evaluate_mesh(packed, theta, approach, 0.0, 0.0)
        off = reaction.force_front - force
        tangent = reaction.torque_2_per_approach / law.base_radius_2
        if not np.all(tangent > 0.0):
            break
        approach = approach - off / tangent
        round_off = 4.0 * float(np.finfo(float).eps * (tangent * np.abs(approach)).max())
        if float(np.abs(off).max()) <= CLOSED * force + round_off:
            teeth = tooth_forces(law, theta, approach)
            return StaticCycle(
                force=force,
                theta=theta,
                approach=approach,
                tangent_stiffness=tangent,
                path=teeth.path,
                slice_force=teeth.front,
            )
    raise DynamicsNotConverged(
        f"mesh law under {force:.4g} N at rest: {float(np.abs(off).max()):.3g} N are left open at an approach of "
        f"{1e6 * float(approach.max()):.0f} um, the tables end at {1e6 * highest:.0f} um; check gap and stiffness"
    )


# Forces of a gear mesh from its contact table, for comparison with the sums over slices and for solvers.


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
    """Return what a mesh of ``tables`` answers at n states, as ``dynamics.tooth.mesh_force.evaluate_mesh`` does.

    tilts : gap that closes per face width from mid-face in front and on the back, (n,) or scalar [rad]
    """
    columns = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(state, float)) for state in (theta_1, approach, omega_1, omega_2, *tilts))
    )
    states = MeshStates(*(np.ascontiguousarray(column) for column in columns[:4]))
    out = np.empty((len(columns[0]), len(TableReaction._fields)))
    table_reactions(tables, mesh, states, np.stack(columns[4:], axis=1), out)
    return TableReaction(*np.ascontiguousarray(out.T))
