"""First-order response of all operating points of a reduced rig: to its housings, to heat sources, to what is set."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property, partial

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
from rigdesign.prediction.warm_up_response import WarmUpResponse
from thermal.fe.mesh import FloatArray


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
