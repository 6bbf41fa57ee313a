"""What a march hands out: its steps and samples, and where the work went."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Block(NamedTuple):
    """One advance: internal steps and sample values."""

    force: Array
    """(n_meshes, n_steps) front minus back normal force in the transverse line of action [N]: of the law at full
    resolution, for extremes and contact loss."""
    acting_force: Array
    """(n_meshes, n_steps) the same of the filtered tables, which acts in the march (``dynamics.mesh.path_filter``) [N]:
    for spectra, as the law at full resolution, seen at the ends of steps, shows harmonics beyond half the step rate as
    slow oscillations."""
    approach: Array
    """(n_meshes, n_steps) approach including offsets [m]; no columns unless everything is recorded."""
    angle_1: Array
    """(n_meshes, n_steps) pinion angle [rad]."""
    rate: Array
    """(n_meshes, n_steps) approach rate [m/s]."""
    omega_1: Array
    """(n_meshes, n_steps) pinion speed [rad/s]."""
    torque_1: Array
    """(n_meshes, n_steps) generalized torque on the pinion body, friction included [N m]."""
    slow: Array
    """(n_samples, n_slow) motor torque [N m], twist [rad] and alternating torques [N m] at the end of each sample."""
    slow_speed: Array
    """(n_samples, n_slow) speed that each slow input works on: its power is input times this."""
    drags: Array
    """(n_samples, n_drags) drag torques [N m] at the end of each sample."""
    angle: Array
    """(n_samples,) angle of the pinion of the first mesh at the end of each sample [rad]."""
    sections: Array
    """(r, n_samples) torque of the springs that are watched at the end of each sample [N m]; no rows without them."""


class Accounts(NamedTuple):
    """Work since the start of a march [J]; losses are positive."""

    friction: Array
    """(n_meshes,) sliding friction of the teeth."""
    mesh_damping: Array
    """(n_meshes,)"""
    slow_work: Array
    """(n_slow,) work done on the drivetrain by motor, bracing and alternating torques."""
    drag: Array
    """(n_drags,)"""
    joint_damping: float
    circulation: float = 0.0
    """Of skew stiffness, as that of lubricant films: what it takes from a whirl, negative where it drives one."""

    def since(self, before: "Accounts") -> "Accounts":
        """Work since an earlier account."""
        return Accounts(
            self.friction - before.friction,
            self.mesh_damping - before.mesh_damping,
            self.slow_work - before.slow_work,
            self.drag - before.drag,
            self.joint_damping - before.joint_damping,
            self.circulation - before.circulation,
        )
