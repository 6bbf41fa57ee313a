"""A mesh law under a constant force over one mesh cycle: what its tables say at rest."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.mesh.force import evaluate_mesh, pack_meshes, tooth_forces
from dynamics.mesh.law import MeshLaw

Array = NDArray[np.float64]

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

    Past the ends of the tables pairs carry nothing, see ``dynamics.mesh.flank.reach_beyond``. Raises DynamicsInputError
    for a force that is not positive, DynamicsNotConverged where no pair touches at the widest gap of the tables.
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
