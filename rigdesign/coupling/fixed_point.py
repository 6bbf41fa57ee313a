"""The coupling loop: iterations at one operating point until nothing moves any more."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rigdesign.base.finite import require_finite
from rigdesign.coupling.acceleration import Acceleration
from rigdesign.coupling.convergence import Convergence, Residual, not_converged
from rigdesign.coupling.iteration import IterationResult, PointProblem, run_iteration
from rigdesign.coupling.relaxation import heat_residual
from rigdesign.coupling.state import CouplingState


@dataclass(frozen=True)
class Step:
    """One iteration of the loop."""

    state: CouplingState
    """What it started from."""
    done: IterationResult
    proposal: CouplingState
    residuals: tuple[Residual, ...]
    """Of all iterations so far."""
    final: bool
    """Whether it was solved in full."""


def iterations(
    problem: PointProblem,
    acceleration: Acceleration,
    convergence: Convergence,
    start: CouplingState,
    before: IterationResult | None = None,
) -> Iterator[Step]:
    """The iterations from a coupling state on, without end.

    before : iteration of a neighbouring point on the same meshes: first guess of fields and thermal expansion

    Raises
    ------
    NonFiniteResultError
        A loss, temperature, length or torque of an iteration is NaN or infinite.
    """
    state, done = start, before
    residuals: tuple[Residual, ...] = ()
    while True:
        final = convergence.final(residuals)
        done = run_iteration(problem, state, done, final=final)
        proposal = acceleration.proposal(problem, done)
        require_finite(proposal, f"stage {problem.point.stage}")
        residuals = (*residuals, Residual.between(state, proposal, heat_residual(problem, done)))
        yield Step(state, done, proposal, residuals, final)
        state = acceleration.following(proposal)


def solve_fixed_point(
    problem: PointProblem,
    acceleration: Acceleration,
    convergence: Convergence,
    start: CouplingState,
    before: IterationResult | None = None,
) -> tuple[IterationResult, Sequence[Residual]]:
    """Iterate until the criterion is reached: the last iteration and the residuals of all.

    Parameters
    ----------
    start : coupling state of the first iteration
    before : as in `iterations`

    Raises
    ------
    NotConvergedError
        The iterations of the criterion are used up; the message shows the residuals of the last ones.
    NonFiniteResultError
        As `iterations`.
    """
    residuals: Sequence[Residual] = ()
    for _, step in zip(
        range(convergence.iterations), iterations(problem, acceleration, convergence, start, before)
    ):
        residuals = step.residuals
        if step.final and convergence.reached(step.state, step.proposal, residuals[-1]):
            return step.done, residuals
    raise not_converged(problem.point, residuals, convergence)
