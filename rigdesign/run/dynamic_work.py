"""Response over speed and time run over the schedule of a converged rig, in parallel with its heat."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from typing import Self

from dynamics.response.response_curve import ResponseCurve
from dynamics.response.time_response import TimeResponse
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.time_run import run_ramp
from rigdesign.records.curves import CurvePlan, plan_curves
from rigdesign.records.dynamics import DynamicRun
from rigdesign.rig.model import Rig
from thermal.fe.kernels import one_thread


class DynamicWork:
    """Starts at once; `result` waits for it. None of it needs more of the points than their warm gears.

    rig : the one on which the loop converged; one without a drivetrain has no dynamics
    points : every held point
    """

    def __init__(self, rig: Rig, points: Sequence[PointResult]) -> None:
        self._points = tuple(points)
        self._plan: CurvePlan | None = None
        self._run: DynamicRun | None = None
        works: list[Callable[[], TimeResponse | ResponseCurve]] = []
        if rig.drivetrain is not None:
            test = governing_point(points)
            assert test.setting is not None
            self._plan = plan_curves(rig, test.last)
            ramp = partial(run_ramp, rig, test.last, test.setting, test.last.coupling_state)
            works = [ramp, *self._plan.works.values()]
        self._works = BackgroundTasks(works)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._works.end()

    def sharing(self) -> AbstractContextManager[None]:
        """For what is computed here: on one thread while there is work on the other cores, else on all."""
        return one_thread() if self._works.running else nullcontext()

    def result(self) -> DynamicRun | None:
        """Curves and time run; None without a drivetrain.

        Raises
        ------
        NotConvergedError
            The motor does not hold the first stage of the schedule.
        """
        if self._run is None and self._plan is not None:
            ramp, *curves = self._works.results()
            assert isinstance(ramp, TimeResponse)
            found = [curve for curve in curves if isinstance(curve, ResponseCurve)]
            self._run = DynamicRun(points=self._points, curves=self._plan.curves(found), ramp=ramp)
        return self._run
