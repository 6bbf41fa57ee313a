"""Loads that alternate with a shaft, at any instant of a march: unbalance, bow, run-out, ripple, couplings out of line.

They stand at the angle of their shaft line and grow with its speed. Both are those of the line turning as one body, by
its angular momentum: its vibration is left out.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.periodic_load import PeriodicLoad

Array = NDArray[np.float64]


class TurningLoads:
    """Loads of a system, n of them, evaluated together; all its ``periodic_loads`` when none are named.

    dofs : (n,) freedom whose angle and speed count for each
    """

    def __init__(self, system: LinearSystem, loads: Sequence[PeriodicLoad] | None = None) -> None:
        """Read the loads and the momentum of the lines of a system."""
        loads = system.periodic_loads if loads is None else loads
        parts = [(i, part) for i, load in enumerate(loads) for part in load.parts]
        self.dofs = np.array([load.dof for load in loads], np.int64)
        self._own = np.array([i for i, _ in parts], np.int64)
        self._order = np.array([part.order for _, part in parts])
        self._phase = np.array([part.phase for _, part in parts])
        self._power = np.array([part.speed_power for _, part in parts], float)
        amplitude = np.array([part.amplitude for _, part in parts])
        self._amplitude = np.zeros((len(parts), len(loads)))
        self._amplitude[np.arange(len(parts)), self._own] = amplitude
        momentum = system.inertia @ system.rigid
        lines = np.linalg.solve(system.rigid.T @ momentum, momentum.T)
        self._line_speeds = system.rigid[self.dofs] @ lines

    def speeds(self, speeds: Array) -> Array:
        """(n,) speed of the line of each load at its freedom, from those of all freedoms [rad/s]; angles likewise."""
        return np.asarray(self._line_speeds @ speeds)

    def values(self, angles: Array, speeds: Array) -> Array:
        """(..., n) value of each load at angles [rad] and speeds [rad/s] of its line (..., n)."""
        own = self._own
        waves = np.cos(self._order * angles[..., own] - self._phase) * speeds[..., own] ** self._power
        return np.asarray(waves @ self._amplitude)


class FollowingLoads:
    """Turning loads of a march stretch by stretch, at the angles and speeds that the lines of the rig really have.

    A line goes on at the acceleration that it had over the last stretch. What its angle missed by then is made up in
    equal parts over the next one, so that no load jumps.
    """

    def __init__(self, loads: TurningLoads, angles: Array) -> None:
        """Begin at the angles (n_freedoms,) of all freedoms [rad] at which the loads stand at 0."""
        self._loads = loads
        self._zero = loads.speeds(angles)
        self._angle = np.zeros_like(self._zero)
        self._speed = np.zeros_like(self._zero)
        self._elapsed = 0.0

    def ahead(self, angles: Array, speeds: Array, times: Array) -> Array:
        """(k, n) values of the loads at times (k,) after this instant [s], of which the last ends the stretch.

        angles, speeds : of all freedoms at this instant [rad], [rad/s]
        """
        angle, speed = self._loads.speeds(angles) - self._zero, self._loads.speeds(speeds)
        acceleration = (speed - self._speed) / self._elapsed if self._elapsed else np.zeros_like(speed)
        missed, since = angle - self._angle, times[:, None]
        way = angle + since * (speed + 0.5 * since * acceleration) - missed * (1.0 - since / times[-1])
        self._angle, self._speed, self._elapsed = way[-1], speed, float(times[-1])
        return self._loads.values(way, speed + since * acceleration)


def acting(loads: Sequence[PeriodicLoad]) -> list[PeriodicLoad]:
    """Those of loads that are not zero."""
    return [load for load in loads if np.any(load.load) and any(part.amplitude for part in load.parts)]
