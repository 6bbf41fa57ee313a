"""One operating point of a rig, solved by the coupling loop to the tolerances of its case."""

from collections.abc import Sequence
from dataclasses import dataclass

from rigdesign.coupling.acceleration import Acceleration, Anderson, Differences, PlainRelaxation
from rigdesign.coupling.braced_loop import BracingState
from rigdesign.coupling.convergence import CaseTolerances, Residual
from rigdesign.coupling.fixed_point import solve_fixed_point
from rigdesign.coupling.iteration import IterationResult, PointProblem
from rigdesign.coupling.oil_circuits import demand_setpoints
from rigdesign.coupling.rig_heat import demand_loss_maps
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.warm_up import last_step
from rigdesign.rig.model import Rig


@dataclass(frozen=True, kw_only=True)
class PointResult:
    """The converged state of one operating point."""

    point: OperatingPoint
    last: IterationResult
    setting: BracingState | None
    residuals: tuple[Residual, ...]
    differences: Differences | None = None
    """Secants of the iterations, with which a neighbouring point starts; of an Anderson acceleration only."""


def governing_point(points: Sequence[PointResult]) -> PointResult:
    """The held point that speaks for the rig where only one can: most torque, of equals the fastest, then the last.

    Checks do not ask it: they take the worst over all held points.
    """
    return max(reversed(points), key=lambda result: (abs(result.point.torque), result.point.speed))


def solve_point(
    rig: Rig,
    point: OperatingPoint,
    *,
    start: CouplingState | None = None,
    before: IterationResult | None = None,
    freeze: frozenset[str] = frozenset(),
    acceleration: Acceleration | None = None,
) -> PointResult:
    """Repeat the iteration until temperatures, lengths and torques stay within the tolerances of the case.

    Parameters
    ----------
    start : coupling state of a neighbouring point; that of the rig before it turns when left out
    before : last iteration of a neighbouring point on the same meshes: first guess of fields and thermal expansion
    freeze : arrows of the loop that are cut, by field of `CouplingState`: they keep their initial values
    acceleration : left out, plain relaxation; Anderson's for a rig with oil circuits, whose heaters may be at a limit

    Raises
    ------
    NotConvergedError
        The iterations of the case are used up; the message shows the residuals of the last ones.
    NonFiniteResultError
        A loss, temperature, length or torque of an iteration is NaN or infinite.
    SetpointNotHeldError
        A supply temperature of an oil circuit that is demanded as hard and is not held.
    CaseError
        A machine whose loss map does not hold the torque that the losses ask of it.
    """
    problem = PointProblem.braced(rig, point, freeze=freeze)
    begin = problem.initial if start is None else start.freeze(freeze, problem.initial)
    step = last_step(problem, begin, before)
    steps = acceleration or (Anderson(step.start) if rig.oil_circuits else PlainRelaxation())
    last, residuals = solve_fixed_point(
        step.problem,
        steps,
        CaseTolerances(rig.case.numerics),
        step.start,
        step.before,
    )
    demand_setpoints(rig, last)
    demand_loss_maps(rig, last)
    return PointResult(
        point=point,
        last=last,
        setting=problem.bracing,
        residuals=tuple(residuals),
        differences=steps.differences if isinstance(steps, Anderson) else None,
    )
