"""First-order response of all operating points of a reduced rig: to its housings, to heat sources, to what is set."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial

import numpy as np
from scipy.linalg import block_diag

from rigdesign.base.errors import UsageError
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.base.units import show
from rigdesign.case.model import Case
from rigdesign.prediction.condition_steps import moved_conditions
from rigdesign.prediction.converged_point import ConvergedPoint
from rigdesign.prediction.housing_sensitivities import (
    HousingSensitivities,
    field_derivatives,
    stream_sources,
)
from rigdesign.prediction.housings import ReducedField
from rigdesign.prediction.readings import rate_rows
from rigdesign.prediction.reduced_rig import ReducedRig
from rigdesign.prediction.sensitivities import PointSensitivities, SensitivityNumbers
from thermal.fe.mesh import FloatArray

# Readings of a point that was not steady: the linearised rig marched exactly over the time it had run.
#
# Close to a steady point the fields of all housings, with oils, films and losses following at once, obey
#
#     C da/dt = -K (a - a_steady),    a(0) = room temperature,
#
# with C the heat capacities on the reduced basis and 1/K the response of the coefficients to heat, the loop followed
# (`rigdesign.prediction.sensitivities`). Its solution is a sum of exponentials, one a mode; the heat -C da/dt that
# still goes into the bodies acts on the readings like any other heat. `rigdesign.coupling.warm_up` marches the model
# itself in time steps, laws of films and losses as they are on the way.

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


class FirstOrderModel:
    """Sensitivities of converged points, made when they are first asked for.

    converged : the points of all operating conditions of ``reduced``, one at least
    """

    def __init__(self, reduced: ReducedRig, converged: Sequence[ConvergedPoint]) -> None:
        self._reduced, self._converged = reduced, tuple(converged)

    @property
    def known(self) -> bool:
        """Whether the sensitivities of the points have been made."""
        return "points" in self.__dict__

    def prepare(self) -> None:
        """Make the sensitivities of the points."""
        _ = self.points

    @cached_property
    def points(self) -> list[PointSensitivities]:
        """Sensitivities of every point, found on all cores.

        Raises
        ------
        UsageError
            A case whose points are not steady: their sensitivities depend on the whole warm-up.
        """
        time = self._reduced.stated.case.ambient.warming_time
        if time is not None:
            raise UsageError(
                f"ambient.warming_time = {show(time, 'time')}: first-order predictions start from steady points; leave "
                "it out, a diagnosis finds the time itself (not_steady)"
            )
        made = partial(PointSensitivities, reads=self._reduced.reads)
        with BackgroundTasks([partial(_numbers_at, made, point) for point in self._converged]) as tasks:
            numbers = tasks.results()
        return [made(point, known=known) for point, known in zip(self._converged, numbers)]

    @cached_property
    def _housings(self) -> list[list[HousingSensitivities]]:
        """Of every point, one for each of its housings."""
        housings, reads = self._reduced.housings, self._reduced.reads
        derivatives = field_derivatives(self._converged[0], housings, reads)
        return [
            [
                HousingSensitivities(point, field, housings.bases[name].reduced, derivatives[name])
                for name, field in point.last.fields.items()
                if isinstance(field, ReducedField)
            ]
            for point in self.points
        ]

    @cached_property
    def _warm_ups(self) -> list[WarmUpResponse]:
        """Of every point."""
        return [
            WarmUpResponse(
                point, housings, point.problem.rig.case.ambient.temperature, rate_rows(self._reduced.channels)
            )
            for point, housings in zip(self.points, self._housings)
        ]

    def warming(self, times: Sequence[float | None]) -> list[FloatArray]:
        """By point: (f,) readings after a time [s] from room temperature; None for a steady point."""
        return [
            point.readings if time is None else point.readings + warm_up.change(time)
            for point, warm_up, time in zip(self.points, self._warm_ups, times)
        ]

    def links(self) -> list[dict[str, FloatArray]]:
        """By point: name -> (f,) derivative by the logarithm of a conductance."""
        return [_merged(part.links() for part in housings) for housings in self._housings]

    def sources(self) -> list[dict[str, FloatArray]]:
        """By point: name -> (f,) response per watt [1/W]."""
        return [
            _merged(part.sources(self._reduced.reads) for part in housings) | stream_sources(point)
            for point, housings in zip(self.points, self._housings)
        ]

    def inputs(self, case: Case) -> list[dict[tuple[str, str], FloatArray]]:
        """By point: (kind, place) -> (f,) derivative by a value of its operating condition."""
        return [
            {
                key: (point.changed(self._reduced.changed_problem(self._reduced.stated, moved)).readings
                      - point.readings) / step
                for key, (moved, step) in moved_conditions(case, condition).items()
            }
            for point, condition in zip(self.points, self._reduced.conditions)
        ]  # fmt: skip


def _numbers_at(
    made: Callable[[ConvergedPoint], PointSensitivities], point: ConvergedPoint
) -> SensitivityNumbers:
    return made(point).numbers


def _merged(parts: Iterable[dict[str, FloatArray]]) -> dict[str, FloatArray]:
    """The entries of all housings of a point."""
    return {name: values for part in parts for name, values in part.items()}
