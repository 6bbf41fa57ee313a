"""Pseudo-arclength continuation of a periodic response over speed, round the turning points of its branch.

State and speed are unknowns together; a step goes along the tangent of the branch, and Newton's method comes back to
it in the plane across the tangent, so that a turning point, where no state exists at the next speed, is passed as any
other. Gear pairs with backlash bend their resonance to lower speeds: a stable branch ends at each of two turning
points, with an unstable one between.

Sources: Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems, in Rabinowitz (ed.), Applications
of Bifurcation Theory, 1977; for harmonic balance with contact von Groll & Ewins, J. Sound Vib. 241 (2001) 223; gear
pairs: Kahraman & Singh, J. Sound Vib. 142 (1990) 49.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.response.harmonic_balance import STALL_LIMIT
from dynamics.response.harmonic_equations import HarmonicEquations, HarmonicState, Residual, state_of
from dynamics.response.harmonic_newton import MeshHarmonics
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicGrid, HarmonicSolution

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

SPEED_SCALE = 0.1
"""Share of the speed that weighs as much as a change of the approach by its mean [-]."""
FIRST_STEP, LEAST_STEP, MOST_STEP = 0.05, 1e-4, 0.4
"""Lengths of a step [-]."""
MOST_ITERATIONS, EASY = 10, 4
"""Iterations of a step at most, and those up to which the next step is longer."""
ACCURACY = 1e-4
"""Residual up to which a step counts [-]; the shortest steps may stall at ``STALL_LIMIT``."""
SETTLED = 0.1 * ACCURACY
"""Residual at which a step is not improved any further [-]; states at asked speeds are solved anew from the trace."""
CRAWLING, STANDING = 10, 40
"""Steps in a row after which a trace is given up: too short to reach an asked speed, and with too little change of
speed for it, which a resonance passes in fewer."""
DIFFERENCE = 1e-6
"""Relative change of speed for derivatives over it [-]."""


@dataclass(frozen=True, kw_only=True)
class SpeedProblem:
    """What depends on the speed of the drive freedom [rad/s].

    problem : matrices and load; drags : drag torques by name; excitation : further torques on the mesh bodies
    """

    problem: Callable[[float], BalanceProblem]
    drags: Callable[[float], Mapping[str, float] | None] = lambda speed: None
    excitation: Callable[[float], Complex | None] = lambda speed: None

    def equations(self, grid: HarmonicGrid, speed: float, band: float | None = None) -> HarmonicEquations:
        """Equations at a speed, with the matrices of the speed ``band`` where it is given."""
        return HarmonicEquations(
            self.problem(speed if band is None else band),
            grid,
            speed,
            self.drags(speed),
            self.excitation(speed),
        )


@dataclass(frozen=True, kw_only=True)
class TracedPoint:
    """A state on a branch; ``rising`` : whether the speed grows along the way on which it was traced."""

    solution: HarmonicSolution
    rising: bool


@dataclass(frozen=True)
class _Tangent:
    """Way along the branch: change of the state and of the speed [rad/s]."""

    state: HarmonicState
    speed: float


class BranchTrace:
    """Steps along one branch."""

    def __init__(self, over_speed: SpeedProblem, start: HarmonicSolution, *, rising: bool) -> None:
        """Start at a solution, first towards higher or lower speeds.

        A step that finds no state within ``STALL_LIMIT`` is halved; below ``LEAST_STEP`` the trace ends.
        """
        self._over_speed = over_speed
        self._at, self._state = start, state_of(start)
        self._scale = SPEED_SCALE * start.speed
        self._weight = _weight(over_speed.problem(start.speed))
        self._tangent: _Tangent | None = None
        self._chord: _Tangent | None = None
        self._sense = 1.0 if rising else -1.0
        self._length = FIRST_STEP

    def points(
        self, limits: tuple[float, float], most: int, asked: Array | None = None
    ) -> Iterator[TracedPoint]:
        """Points of the branch until it leaves the limits of speed [rad/s], ends, or ``most`` were found.

        asked : speeds [rad/s] for which it is traced. Where a mesh chatters, tangents hold for the shortest steps only;
        a trace that gets on so slowly that the points left reach none of these speeds is given up.
        """
        crawled, passed = 0, [self._at.speed]
        for left in range(most - 1, -1, -1):
            if not limits[0] <= self._at.speed <= limits[1] or not self._advance():
                return
            assert self._chord is not None
            yield TracedPoint(solution=self._at, rising=self._chord.speed > 0.0)
            if asked is None:
                continue
            away = float(np.abs(asked - self._at.speed).min())
            crawled = crawled + 1 if left * self._length * self._scale < away else 0
            passed = [*passed[-STANDING:], self._at.speed]
            stands = len(passed) > STANDING and left * np.abs(np.diff(passed)).mean() < away
            if crawled >= CRAWLING or stands:
                return

    def _advance(self) -> bool:
        """One step; False where none is short enough."""
        tangent = self._direction()
        if tangent is None:
            return False
        while self._length >= LEAST_STEP:
            found = self._corrected(tangent)
            if found is not None:
                solution, iterations = found
                self._chord = _Tangent(
                    state_of(solution).plus(self._state, -1.0), solution.speed - self._at.speed
                )
                self._at, self._state, self._tangent = solution, state_of(solution), tangent
                if iterations <= EASY:
                    self._length = min(1.6 * self._length, MOST_STEP)
                return True
            self._length *= 0.5
        return False

    def _direction(self) -> _Tangent | None:
        """Tangent at the present point, along the last step: at a corner, where a contact opens, it may turn back."""
        here = self._over_speed.equations(self._at.grid, self._at.speed)
        residual, reactions = here.residual(self._state)
        try:
            along = here.step(self._per_speed(here, residual, self._state), reactions)
        except np.linalg.LinAlgError:
            return self._tangent
        size = math.sqrt(self._product(along, along) + 1.0 / self._scale**2)
        if not math.isfinite(size):
            return self._tangent
        sense = self._sense
        if self._chord is not None:
            ahead = self._product(along, self._chord.state) + self._chord.speed / self._scale**2
            sense = math.copysign(1.0, ahead)
        zero = HarmonicState(np.zeros_like(along.moving), np.zeros_like(along.rest), 0.0, 0.0)
        return _Tangent(zero.plus(along, sense / size), sense / size)

    def _corrected(self, tangent: _Tangent) -> tuple[HarmonicSolution, int] | None:
        """State a step ahead, in the plane across the tangent, and the iterations it took; None if there is none."""
        ahead = self._state.plus(tangent.state, self._length)
        speed_ahead = self._at.speed + self._length * tangent.speed
        state, speed = ahead, speed_ahead
        best: tuple[HarmonicSolution, int] | None = None
        for iteration in range(MOST_ITERATIONS):
            if not 0.0 < speed < math.inf:
                return None
            equations = self._over_speed.equations(self._at.grid, speed, band=speed_ahead)
            residual, reactions = equations.residual(state)
            error = equations.error(residual)
            if best is None or error < best[0].residual:
                best = equations.solution(state, error, iteration), iteration
            if (
                error < SETTLED
                or (error > 0.5 * best[0].residual and iteration >= best[1] + 2)
                or error > 1e3
            ):
                break
            move = self._move(equations, residual, reactions, state, tangent, (ahead, speed_ahead, speed))
            if move is None:
                break
            state, speed = state.plus(move[0]), speed + move[1]
        limit = ACCURACY if self._length > 4.0 * LEAST_STEP else STALL_LIMIT
        return best if best is not None and best[0].residual < limit else None

    def _move(
        self,
        equations: HarmonicEquations,
        residual: Residual,
        reactions: MeshHarmonics,
        state: HarmonicState,
        tangent: _Tangent,
        at: tuple[HarmonicState, float, float],
    ) -> tuple[HarmonicState, float] | None:
        """Newton step of state and speed by bordering: two solutions with one matrix."""
        ahead, speed_ahead, speed = at
        try:
            back = equations.step(residual, reactions)
            along = equations.step_again(self._per_speed(equations, residual, state), reactions)
        except np.linalg.LinAlgError:
            return None
        away = state.plus(ahead, -1.0).plus(back)
        off = self._product(tangent.state, away) + tangent.speed * (speed - speed_ahead) / self._scale**2
        slope = self._product(tangent.state, along) + tangent.speed / self._scale**2
        if slope == 0.0 or not math.isfinite(off / slope):
            return None
        change = -off / slope
        return back.plus(along, change), change

    def _per_speed(self, equations: HarmonicEquations, residual: Residual, state: HarmonicState) -> Residual:
        """Derivative of the residual over the speed, in the matrices of these equations."""
        step = DIFFERENCE * equations.speed
        speed = equations.speed + step
        other = HarmonicEquations(
            equations.problem, equations.grid, speed, self._over_speed.drags(speed), self._over_speed.excitation(speed)
        )  # fmt: skip
        return residual.per(other.residual(state)[0], step)

    def _product(self, a: HarmonicState, b: HarmonicState) -> float:
        """Scalar product of changes, 1 for a change of an approach by its mean."""
        weight = self._weight**2
        moving = 2.0 * (a.moving * b.moving.conj()).real.sum(axis=1)
        return float(weight @ (moving + a.rest[:-1] * b.rest[:-1]))


def _weight(problem: BalanceProblem) -> Array:
    """(n_bodies,) of a windup [1/rad]."""
    radius = np.abs(problem.model.approach[:, :-1]).max(axis=0)
    return np.asarray(radius / problem.approach_scale)


def crossings(
    trace: Iterator[TracedPoint], start: HarmonicSolution, speeds: Array
) -> Iterator[tuple[int, HarmonicSolution]]:
    """Where a trace from ``start`` passes asked speeds (n,) [rad/s]: index and state between two of its points."""
    before = start
    for point in trace:
        now = point.solution
        low, high = sorted((before.speed, now.speed))
        passed = np.flatnonzero((speeds > low) & (speeds <= high))
        for i in passed if now.speed > before.speed else passed[::-1]:
            share = (speeds[i] - before.speed) / (now.speed - before.speed)
            yield int(i), _between(before, now, float(share), float(speeds[i]))
        before = now


def _between(a: HarmonicSolution, b: HarmonicSolution, share: float, speed: float) -> HarmonicSolution:
    """Start at a speed between two solutions."""
    return replace(
        a,
        speed=speed,
        ports=(1.0 - share) * a.ports + share * b.ports,
        twist=(1.0 - share) * a.twist + share * b.twist,
        drive=(1.0 - share) * a.drive + share * b.drive,
        residual=math.inf,
        iterations=0,
    )
