"""A point that was not steady: the coupled loop marched from room temperature over the time the rig had run.

Solids take up heat; oils, films, losses and the vibration are quasi-steady: at every time step they are those of its
temperatures. All steps but the last are solved here, to a loose tolerance: what is left over moves the temperatures
after it by far less. The last one is solved by whoever asks, as a steady point would be.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from rigdesign.coupling.acceleration import Anderson, Differences
from rigdesign.coupling.convergence import ScaledTolerance
from rigdesign.coupling.fixed_point import solve_fixed_point
from rigdesign.coupling.iteration import IterationResult, PointProblem
from rigdesign.coupling.point_losses import STORED
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.state_vector import scaled, unscaled
from rigdesign.rig.model import Rig
from thermal.transient.backward_differences import STEPS, WarmingBody, step_lengths

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
