"""Response over speed and time run over the schedule of a settled rig, on other cores while heat is computed here."""

from collections.abc import Sequence
from functools import partial
from typing import Self

from dynamics.response import TimeResponse
from dynamics.response_curve import ResponseCurve
from rigdesign.assemble.curves import plan_curves
from rigdesign.assemble.dynamics import DynamicRun
from rigdesign.beside import Beside
from rigdesign.coupling import PointResult, governing_point
from rigdesign.ramp_run import run_ramp
from rigdesign.rig.model import Rig


class DynamicWork:
    """Starts at once; `result` waits for it. None of it needs more of the points than their warm gears.

    rig : the one on which the loop settled; points : every held point
    """

    def __init__(self, rig: Rig, points: Sequence[PointResult]) -> None:
        self._points = tuple(points)
        test = governing_point(points)
        assert test.setting is not None
        self._plan = plan_curves(rig, test.last)
        ramp = partial(run_ramp, rig, test.last, test.setting, test.last.feedback)
        self._works: Beside[TimeResponse | ResponseCurve] = Beside([ramp, *self._plan.works.values()])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._works.end()

    def result(self) -> DynamicRun:
        """Curves and time run.

        Raises
        ------
        NotConvergedError
            The motor does not reach a speed the schedule asks for.
        """
        ramp, *curves = self._works.results()
        assert isinstance(ramp, TimeResponse)
        found = [curve for curve in curves if isinstance(curve, ResponseCurve)]
        return DynamicRun(points=self._points, curves=self._plan.curves(found), ramp=ramp)
