"""A converged operating point of a prediction, found by the coupling loop with Anderson acceleration."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.fixed_point import (
    Anderson,
    Differences,
    ScaledTolerance,
    next_state,
    ordered,
    scaled,
    solve_fixed_point,
    unrelaxed,
)
from rigdesign.coupling.iteration import IterationParts, IterationResult, PointProblem
from rigdesign.coupling.loop import last_step
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from thermal.fe.mesh import FloatArray

TOLERANCE = 1e-3
"""Largest change of the last iteration, in units of `state_vector.SCALES`: a millikelvin, a nanometre."""


@dataclass(frozen=True)
class ConvergedPoint:
    """A converged operating point with what its neighbours may use."""

    problem: PointProblem
    last: IterationResult
    differences: Differences
    residual: FloatArray
    """(n,) what the last iteration would still move, heats not relaxed, in units of `state_vector.SCALES`."""
    iterations: int


def converge_point(
    problem: PointProblem,
    near: ConvergedPoint | None = None,
    inverse: NDArray[np.floating] | None = None,
    *,
    start: CouplingState | None = None,
    tolerance: float = TOLERANCE,
) -> ConvergedPoint:
    """Iterate until no part of the coupling state moves by more than ``tolerance``.

    near : a converged point nearby, to start from; the initial state when left out
    inverse : (n, n) of `PointSensitivities` at that point: then each iteration is followed by a step of Newton's
        method with it
    start : coupling state to start from where there is no point nearby

    Raises
    ------
    NotConvergedError
        The iterations of `ScaledTolerance` are used up.
    NonFiniteResultError
        A loss, temperature, length or torque of an iteration is NaN or infinite.
    """
    given = start if near is None else near.last.coupling_state
    first = problem.initial if given is None else ordered(given, problem.initial)
    known = None if near is None or inverse is not None else near.differences
    step = last_step(problem, first, None if near is None else near.last)
    anderson = Anderson(step.start, known=known, inverse=inverse)
    last, residuals = solve_fixed_point(
        step.problem, anderson, ScaledTolerance(tolerance), step.start, step.before
    )
    return ConvergedPoint(step.problem, last, anderson.differences, anderson.residual, len(residuals))


def unrelaxed_vector(
    rig: Rig, done: IterationResult, parts: IterationParts, like: CouplingState
) -> FloatArray:
    """(n,) what an iteration hands on, heats not relaxed, names in the order of ``like``."""
    return scaled(ordered(unrelaxed(next_state(rig, done, parts), done), like))
