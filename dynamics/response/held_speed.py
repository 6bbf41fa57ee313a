"""Mean speed of a march that is held by corrections of motor torque and speed between its blocks."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.mesh.law import MeshLaw
from dynamics.response.initial_state import pinion_ratios

Array = NDArray[np.float64]

CORRECTED = 0.7
"""Share of the drift in speed that a correction of the motor torque takes away."""


class SpeedCorrection(NamedTuple):
    """What is added after a block: motor torque [N m], and sudden changes of all speeds (n,) [rad/s]."""

    drive_torque: float
    kick: Array


class HeldSpeed:
    """Brings the mean speed of the first pinion to the one asked for and keeps it there.

    ratios : (n,) speed of every freedom per speed of that pinion [-]
    inertia : motor torque per angular acceleration of that pinion [kg m2]
    """

    def __init__(self, system: LinearSystem, laws: Sequence[MeshLaw], speed: float) -> None:
        """speed : of the first pinion [rad/s]; raises DynamicsInputError as `pinion_ratios`."""
        self.ratios = pinion_ratios(system, laws)
        self.inertia = float(self.ratios @ system.inertia @ self.ratios) / float(
            self.ratios[system.drive_dof]
        )
        self._speed = speed
        self._before: float | None = None

    def drift(self, mean: float, span: float) -> float:
        """Acceleration [rad/s2] since the last correction, after a block of ``span`` [s] with a mean speed [rad/s]; 0
        before the first."""
        return 0.0 if self._before is None else (mean - self._before) / span

    def correction(self, mean: float, span: float) -> SpeedCorrection:
        """After a block, as of `drift`; it counts as made."""
        drift = self.drift(mean, span)
        # at the end of a block the rigid motion is half a block ahead of its mean
        kick = self._speed - mean - 0.5 * drift * span
        self._before = mean + kick
        return SpeedCorrection(-CORRECTED * self.inertia * drift, kick * self.ratios)
