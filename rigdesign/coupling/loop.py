"""One operating point of a rig, solved by the coupling loop to the tolerances of its case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from rigdesign.coupling.fixed_point import (
    Acceleration,
    Anderson,
    CaseTolerances,
    Differences,
    PlainRelaxation,
    Residual,
    ScaledTolerance,
    scaled,
    solve_fixed_point,
    unscaled,
)
from rigdesign.coupling.iteration import IterationResult, PointProblem
from rigdesign.coupling.located_loss import STORED
from rigdesign.coupling.oil_circuits import demand_loss_maps, demand_setpoints
from rigdesign.coupling.preloaded_loop import BracingState
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.model import Rig
from thermal.transient.time_steps import STEPS, WarmingBody, step_lengths


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


# A point that was not steady: the coupled loop marched from room temperature over the time the rig had run.
#
# Solids take up heat; oils, films, losses and the vibration are quasi-steady: at every time step they are those of its
# temperatures. All steps but the last are solved here, to a loose tolerance: what is left over moves the temperatures
# after it by far less. The last one is solved by whoever asks, as a steady point would be.

TOLERANCE = ScaledTolerance(0.1)
"""Of the steps before the last: a tenth of a kelvin of an oil, a watt of a heat; rates of change need it."""


@dataclass(frozen=True)
class LastStep:
    """The last step of a warm-up: its problem, the coupling state to start from, the iteration before."""

    problem: PointProblem
    start: CouplingState
    before: IterationResult | None


def last_step(
    problem: PointProblem, start: CouplingState, before: IterationResult | None, count: int = STEPS
) -> LastStep:
    """The problem of a point itself where the case calls it steady, else that of the last step of its warm-up.

    start, before : coupling state and iteration of a neighbouring point, for a steady one
    count : time steps

    Raises
    ------
    NotConvergedError, NonFiniteResultError
        As `solve_fixed_point`.
    """
    time = problem.rig.case.ambient.warming_time
    if time is None or not problem.rig.models:
        return LastStep(problem, start, before)
    bodies = _at_room_temperature(problem.rig)
    state, earlier = problem.initial, None
    done: IterationResult | None = None
    known: Differences | None = None
    lengths = step_lengths(time, count).tolist()
    for number, length in enumerate(lengths[:-1]):
        here = _over(problem, bodies, length)
        guess = state if earlier is None else _ahead(earlier, state, length / lengths[number - 1])
        anderson = Anderson(guess, known=known)
        done, _ = solve_fixed_point(here, anderson, TOLERANCE, guess, done)
        known = anderson.differences
        earlier, state = None if number == 0 else state, done.coupling_state
        bodies = {name: body.after(done.fields[name].temperature, length) for name, body in bodies.items()}
    return LastStep(_over(problem, bodies, lengths[-1]), state, done)


def _at_room_temperature(rig: Rig) -> dict[str, WarmingBody]:
    """Every housing as it starts."""
    return {
        name: WarmingBody(
            {body: m.density * m.heat_capacity for body, m in rig.body_materials(name).items()},
            rig.case.ambient.temperature,
        )
        for name in rig.models
    }


def _over(problem: PointProblem, bodies: Mapping[str, WarmingBody], length: float) -> PointProblem:
    return replace(problem, stored={name: body.step(length, STORED) for name, body in bodies.items()})


def _ahead(earlier: CouplingState, latest: CouplingState, ratio: float) -> CouplingState:
    """The coupling state one step further on a straight line; ``ratio``: of this step to the one before."""
    return unscaled((1.0 + ratio) * scaled(latest) - ratio * scaled(earlier), latest)
