"""How the next coupling state follows from the iterations so far: plain relaxation, Anderson acceleration, Newton.

An acceleration proposes a coupling state after every iteration; the distance between the proposal and the state the
iteration started from is the residual of the loop. From the proposals so far it finds the state of the next iteration.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rigdesign.coupling.iteration import IterationResult, PointProblem
from rigdesign.coupling.relaxation import next_state, unrelaxed
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.state_vector import FloatArray, ordered, scaled, unscaled

DEPTH = 12
"""Differences that Anderson acceleration keeps."""
RANK_TOLERANCE = 1e-9
"""Relative size of a singular value of the differences below which a direction is left out."""


class Acceleration(Protocol):
    """The way from one iteration to the next."""

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The coupling state that an iteration asks for."""

    def following(self, proposal: CouplingState) -> CouplingState:
        """The coupling state of the next iteration, after this proposal."""


class PlainRelaxation:
    """Fixed-point iteration: every proposal is the next state, heats relaxed by what the oil can take up."""

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The next state as the iteration gives it."""
        return _relaxed_state(problem, done)

    def following(self, proposal: CouplingState) -> CouplingState:
        """The proposal."""
        return proposal


@dataclass(frozen=True)
class Differences:
    """Secants of earlier iterations, in units of `state_vector.SCALES`; one column a pair of iterations, (n, k)."""

    states: FloatArray
    """Of the coupling states they started from."""
    proposals: FloatArray
    """Of what they proposed."""

    @classmethod
    def of(cls, states: Sequence[FloatArray], proposals: Sequence[FloatArray], size: int) -> "Differences":
        """From vectors (n,), n = ``size``."""
        columns = [np.array(part).T if part else np.empty((size, 0)) for part in (states, proposals)]
        return cls(*columns)


class Anderson:
    """Anderson acceleration, a multi-secant quasi-Newton method; with a known inverse on top of Newton's method.

    Differences of a neighbouring case serve as well as its own, so that a changed case needs two or three iterations
    from the point it is near to.

    start : coupling state of the first iteration
    known : differences of a neighbouring point
    inverse : (n, n) inverse of 1 - G, G the sensitivity of an iteration to its coupling state: then the proposals are
        steps of Newton's method with it
    depth : differences that are kept

    Source: Walker, Ni, SIAM J. Numer. Anal. 49 (2011) 1715.
    """

    def __init__(
        self,
        start: CouplingState,
        *,
        known: Differences | None = None,
        inverse: NDArray[np.floating] | None = None,
        depth: int = DEPTH,
    ) -> None:
        self._names, self._x = start, scaled(start)
        self._inverse, self._depth = inverse, depth
        self._states = [] if known is None else list(known.states.T)
        self._proposals = [] if known is None else list(known.proposals.T)
        self._proposal = self._x
        self._before: tuple[FloatArray, FloatArray] | None = None
        self.residual = np.zeros_like(self._x)
        """(n,) what the last iteration would still move, heats not relaxed, in units of `state_vector.SCALES`."""

    @property
    def differences(self) -> Differences:
        """Those kept, for a neighbouring point."""
        return Differences.of(self._states, self._proposals, len(self._x))

    def proposal(self, problem: PointProblem, done: IterationResult) -> CouplingState:
        """The relaxed next state, or a step of Newton's method."""
        after = _relaxed_state(problem, done)
        self.residual = scaled(ordered(unrelaxed(after, done), self._names)) - self._x
        if self._inverse is None:
            step = scaled(ordered(after, self._names)) - self._x
        else:
            step = np.asarray(self._inverse @ self.residual)
        self._proposal = self._x + step
        if self._before is not None:
            self._states = [*self._states, self._x - self._before[0]][-self._depth :]
            self._proposals = [*self._proposals, self._proposal - self._before[1]][-self._depth :]
        return unscaled(self._proposal, self._names)

    def following(self, proposal: CouplingState) -> CouplingState:
        """Where the differences say that nothing would move."""
        self._before = self._x, self._proposal
        self._x = _secant_step(self._x, self._proposal, self.differences)
        return unscaled(self._x, self._names)


def _relaxed_state(problem: PointProblem, done: IterationResult) -> CouplingState:
    """What an iteration hands on, frozen arrows at their initial values."""
    return next_state(problem.rig, done, problem.parts).freeze(problem.freeze, problem.initial)


def _secant_step(x: FloatArray, proposal: FloatArray, differences: Differences) -> FloatArray:
    """(n,) least-squares zero of the residual in the span of the differences."""
    if not differences.states.size:
        return proposal
    residuals = differences.proposals - differences.states
    size = np.linalg.norm(residuals, axis=0)
    kept = size > 0.0
    share = np.linalg.lstsq(residuals[:, kept] / size[kept], proposal - x, rcond=RANK_TOLERANCE)[0]
    return np.asarray(proposal - (differences.proposals[:, kept] / size[kept]) @ share)
