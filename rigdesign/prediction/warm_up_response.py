"""Readings of a point that was not steady: the linearised rig marched exactly over the time it had run.

Close to a steady point the fields of all housings, with oils, films and losses following at once, obey

    C da/dt = -K (a - a_steady),    a(0) = room temperature,

with C the heat capacities on the reduced basis and 1/K the response of the coefficients to heat, the loop followed
(`rigdesign.prediction.sensitivities`). Its solution is a sum of exponentials, one a mode; the heat -C da/dt that still
goes into the bodies acts on the readings like any other heat. `rigdesign.coupling.warm_up` marches the model itself in
time steps, laws of films and losses as they are on the way.
"""

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from rigdesign.prediction.housing_sensitivities import HousingSensitivities
from rigdesign.prediction.sensitivities import PointSensitivities
from thermal.fe.mesh import FloatArray

AT_ONCE = 1e-5
"""Time constant over the longest one below which a mode has settled at once."""


class WarmUpResponse:
    """Warm-up of one converged steady point.

    point : its sensitivities; housings : those of all its housings, in the order of its fields
    room : temperature of all bodies at the start [K]
    rates : number of a reading that is a rate of change -> that of the temperature which changes
    """

    def __init__(
        self,
        point: PointSensitivities,
        housings: Sequence[HousingSensitivities],
        room: float,
        rates: Mapping[int, int],
    ) -> None:
        self._point, self._housings, self._room = point, housings, room
        self._of_rates, self._of_temperatures = list(rates), list(rates.values())

    @cached_property
    def _capacity(self) -> FloatArray:
        """(m, m) [J/K]"""
        return np.asarray(block_diag(*(housing.capacity() for housing in self._housings)))

    @cached_property
    def _answers(self) -> tuple[FloatArray, FloatArray]:
        """(m, m) of the coefficients and (f, m) of the readings per heat on each vector of the basis, loop followed."""
        parts = [housing.heat_responses() for housing in self._housings]
        unrelaxed = np.hstack([part.unrelaxed for part in parts])
        read = np.hstack([part.readings for part in parts])
        still = block_diag(*(part.coefficients for part in parts))
        coefficients = still + self._point.fields @ (self._point.inverse @ unrelaxed)
        return coefficients, self._point.followed(unrelaxed, read)

    def rise(self, time: float, derivative: int = 0) -> FloatArray:
        """(m,) coefficients less those of the steady point after ``time`` [s] from room temperature, or their first or
        second derivative by time."""
        times, vectors, shares = self._modes
        return np.asarray((vectors @ (shares * (-1.0 / times) ** derivative * np.exp(-time / times))).real)

    def change(self, time: float) -> FloatArray:
        """(f,) readings after ``time`` [s] from room temperature, less those of the steady point."""
        _, readings = self._answers
        found = -readings @ (self._capacity @ self.rise(time, 1))
        found[self._of_rates] = -(readings @ (self._capacity @ self.rise(time, 2)))[self._of_temperatures]
        return np.asarray(found)

    @cached_property
    def _modes(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Time constants (k,) [s] of C/K, their vectors (m, k), and what each has of the rise at the start (k,).

        A vector of the basis that stores next to no heat follows at once: its time constant is rounding, of either
        sign.
        """
        steady = np.concatenate([housing.coefficients for housing in self._housings])
        start = np.concatenate([housing.uniform(self._room) for housing in self._housings])
        coefficients, _ = self._answers
        times, vectors = np.linalg.eig(coefficients @ self._capacity)
        lasting = times.real > AT_ONCE * times.real.max()
        shares = np.linalg.solve(vectors, start - steady)
        return times[lasting], vectors[:, lasting], shares[lasting]
