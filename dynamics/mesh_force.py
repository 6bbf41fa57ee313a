"""Forces of a gear mesh from its law: totals and tangents for solvers, single tooth pairs for stresses.

``MeshLaw`` is packed once into flat tables (one row of numbers per mesh, one cell of a table beside the next)
and then evaluated by the compiled loops of ``dynamics.kernels``. Tables are interpolated linearly, the slopes
are those of the same straight pieces: value and derivative belong to one potential.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from dynamics import kernels
from dynamics.mesh_law import MeshLaw, check_mesh_law

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class PackedMeshes(NamedTuple):
    """Tables of all meshes of a drivetrain in the layout of ``dynamics.kernels``."""

    values: Array
    """(n_meshes, N_VALUES) plain numbers."""
    counts: Integers
    """(n_meshes, N_COUNTS) sizes and first rows in the tables below."""
    cells: Array
    """(n_cells, 4) stiffness and gap at the start of a cell and their change over it."""
    shifts: Array
    deviations: Array
    """(n_cells, 2) deviation of single teeth at the start of a cell and its change over it."""
    scales: Array
    offsets: Array
    """(n_meshes,) imposed approach [m]."""

    @property
    def tables(self) -> kernels.Tables:
        """The tables without the rows of single meshes."""
        return self.cells, self.shifts, self.deviations, self.scales


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
    """d torque_1 / d theta_1 at fixed approach and rate, friction levers held [N m/rad]."""
    torque_2_per_angle: Array
    friction_power: Array
    """Power lost by sliding, >= 0 [W]."""
    damping_power: Array
    """Power lost by mesh damping, >= 0 [W]."""
    energy: Array
    """Elastic energy of the tooth contacts [J]."""


@dataclass(frozen=True, kw_only=True)
class ToothForces:
    """Forces of single tooth pairs at n states; column c of row n is pair ``pair[n, c]``.

    pair : (n, n_pairs) index p; it joins pinion tooth p mod z1 with wheel tooth (p + tooth_offset_2) mod z2
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


def pack_meshes(laws: Sequence[MeshLaw], *, derivative_torques: bool = True) -> PackedMeshes:
    """Return the packed tables of all ``laws``.

    With ``derivative_torques=False`` the torques ``F de/dtheta`` and ``d^2 dk/dtheta / 2`` are left out: the
    negative control of the energy test, of no other use.

    Raises
    ------
    ValueError
        If a law is impossible (see ``check_mesh_law``).
    """
    values = np.zeros((len(laws), kernels.N_VALUES))
    counts = np.zeros((len(laws), kernels.N_COUNTS), np.int64)
    cells: list[Array] = []
    shifts: list[Array] = []
    deviations: list[Array] = []
    scales: list[Array] = []
    for mesh, law in enumerate(laws):
        check_mesh_law(law)
        n_slices, n_path = law.stiffness.shape
        length = law.path_step * (n_path - 1)
        least_gap = float(law.gap.min() + law.deviation_1.min() + law.deviation_2.min())
        individual = any(
            (
                len(law.scale_1) > 1,
                len(law.scale_2) > 1,
                bool(np.any(law.deviation_1)),
                bool(np.any(law.deviation_2)),
                bool(np.any(law.scale_1 != 1.0)),
                bool(np.any(law.scale_2 != 1.0)),
            )
        )
        reversal = max(law.friction_reversal_speed, 1e-9)
        values[mesh] = (
            law.base_radius_1, law.base_radius_2, law.base_pitch, law.phase, law.back_phase, law.backlash,
            law.path_start, 1.0 / law.path_step, law.damping / law.mean_stiffness, law.friction,
            law.rolling_radius_1, law.rolling_radius_2, 1.0 / reversal, least_gap, float(derivative_torques),
        )  # fmt: skip
        counts[mesh] = (
            n_slices, n_path - 1, sum(map(len, cells)), sum(map(len, shifts)), individual,
            law.teeth_1, law.teeth_2, law.tooth_offset_2,
            len(law.deviation_1), sum(map(len, deviations)),
            len(law.deviation_2), sum(map(len, deviations)) + len(law.deviation_1) * (n_path - 1),
            len(law.scale_1), sum(map(len, scales)),
            len(law.scale_2), sum(map(len, scales)) + len(law.scale_1),
            2 * n_slices * (int(length / law.base_pitch) + 2),
        )  # fmt: skip
        cells.append(np.hstack((_cells(law.stiffness), _cells(law.gap))))
        shifts.append(np.asarray(law.slice_shift, float))
        deviations.append(np.vstack((_cells(law.deviation_1), _cells(law.deviation_2))))
        scales.append(np.concatenate((law.scale_1, law.scale_2)).astype(float))
    return PackedMeshes(
        values=values,
        counts=counts,
        cells=np.vstack(cells),
        shifts=np.concatenate(shifts),
        deviations=np.vstack(deviations),
        scales=np.concatenate(scales),
        offsets=np.array([law.offset for law in laws], float),
    )


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

    Source: potential of ``dynamics.mesh_law``; Oh, Grosh, Barber, ASME J. Mech. Des. 2005, for the torques.
    """
    packed = law if isinstance(law, PackedMeshes) else pack_meshes([law])
    angle, reach, w_1, w_2 = _states(theta_1, approach, omega_1, omega_2)
    out = np.empty((len(angle), len(MeshReaction._fields)))
    kernels.mesh_reactions(
        packed.values[0], packed.counts[0], packed.tables,
        angle, reach, w_1, w_2, out,
    )  # fmt: skip
    return MeshReaction(*np.ascontiguousarray(out.T))


def tooth_forces(
    law: MeshLaw, theta_1: ArrayLike, approach: ArrayLike, omega_1: ArrayLike = 0.0, omega_2: ArrayLike = 0.0
) -> ToothForces:
    """Return the force of every tooth pair that can touch, with its identity and place on the path.

    Arguments as in ``evaluate_mesh``; with both speeds zero they are the elastic forces alone.
    """
    packed = pack_meshes([law])
    angle, reach, w_1, w_2 = _states(theta_1, approach, omega_1, omega_2)
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
    kernels.tooth_pair_forces(
        packed.values[0], packed.counts[0], packed.tables,
        angle, reach, w_1, w_2, lowest_any, force,
    )  # fmt: skip
    pair = lowest_any[:, None] + np.arange(n_pairs)
    return ToothForces(
        pair=pair,
        path=front[:, None] - pair * law.base_pitch,
        back_path=back[:, None] + pair * law.base_pitch,
        front=force[..., 0],
        back=force[..., 1],
    )


def _cells(table: Array) -> Array:
    """Return (rows * cells, 4): coefficients of the monotone cubic over the fraction of each cell."""
    if table.shape[1] == 2:
        return np.column_stack((table[:, 0], table[:, 1] - table[:, 0], np.zeros((len(table), 2))))
    cubic = PchipInterpolator(np.arange(table.shape[1]), table, axis=1)
    coefficients: Array = np.moveaxis(cubic.c[::-1], 0, -1)  # (n_cells, rows, 4)
    return np.ascontiguousarray(coefficients.swapaxes(0, 1).reshape(-1, 4))


def _states(*columns: ArrayLike) -> list[Array]:
    broadcast = np.broadcast_arrays(*(np.atleast_1d(np.asarray(column, float)) for column in columns))
    return [np.ascontiguousarray(column) for column in broadcast]
