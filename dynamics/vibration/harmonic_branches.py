"""Stable periodic responses at many speeds: walk, continuation round turning points, both branches of a jump.

First a walk over the speeds in the order given, each state from the one before. Where a mesh loses contact the
stability of what is found is tested. Speeds without a stable state are then sought along the branches: by arclength
from the nearest states on both sides, or, where there are none, from a speed at which the response is plain. Last a
walk the other way through the speeds with contact loss, which ends on the other branch where there are two.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.vibration.harmonic_balance import (
    STALL_LIMIT,
    BalanceProblem,
    HarmonicEquations,
    HarmonicGrid,
    HarmonicSolution,
    HarmonicState,
    MeshHarmonics,
    Residual,
    mesh_inputs,
    resample,
    state_of,
)
from dynamics.vibration.speed_continuation import HarmonicWalk

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


# Stability of a periodic response: Floquet exponents of growing motion, counted and named.
#
# A small change of the approach of the meshes, exp(s t) times a mesh-periodic function, obeys
#
#     [ I - G(s + i k W) T_kl ] x_l = 0 ,     T_kl = stiffness harmonic (k - l) + damping harmonic (k - l) (s + i l W)
#
# with G the approach per torque of the drivetrain, exact in all its modes, and W the mesh frequency. Exponents with a
# growth beyond ``GROWTH`` are zeros of the determinant right of a line Re s = growth; along that line, over one mesh
# frequency, the determinant turns by -2 pi for each of them, as G has no pole there. So they are counted by the phase
# of a determinant with as many rows as the approach has harmonics, however many modes the drivetrain has. The twist of
# the bracing and the motor torque are held.
#
# Sources: Hill's determinant (Nayfeh & Mook, Nonlinear Oscillations, 1979, 5.2.3); Nyquist criterion for periodic
# systems by harmonic transfer functions (Wereley, MIT thesis, 1990, 6.2).

Instability = Literal["fold", "period doubling", "second frequency"]

GROWTH = 2e-4
"""Growth rate per mesh frequency [rad/s per rad/s] that still counts as stable: 0.13 % per mesh period."""
STABILITY_HARMONICS = 16
"""Harmonics of the change at most [-]; 12 to 48 give the same counts on the prototype at 10 Nm."""
FEWEST, MOST = 12, 300
"""Points on half of the line at first, on each of its parts, and at most."""
TURN = 1.6
"""Largest turn of the determinant from point to point [rad]."""


def instability(equations: HarmonicEquations, solution: HarmonicSolution) -> tuple[int, Instability | None]:
    """Number of growing Floquet exponents of a mesh-periodic solution, and how the motion leaves it; 0, None: stable.

    ``fold``: one real exponent, the motion goes to another branch. ``period doubling``: an exponent at half the mesh
    frequency. ``second frequency``: a pair at a frequency of its own. Where several grow, the first of these names it.
    """
    _, reactions = equations.residual(state_of(solution))
    line = _Line(equations, reactions)
    share = 0.5 * np.concatenate([[0.0], np.geomspace(1e-4, 0.1, FEWEST), np.linspace(0.15, 1.0, FEWEST)])
    value = line.at(share)
    for _ in range(8):
        turn = np.angle(value[1:] / value[:-1])
        wide = np.flatnonzero(np.abs(turn) > TURN)
        if not wide.size or len(share) + 2 * wide.size > MOST:
            break
        cut = np.linspace(0.0, 1.0, 4)[1:-1]
        more = np.sort((share[wide, None] + cut * (share[wide + 1] - share[wide])[:, None]).ravel())
        place = np.searchsorted(share, more)
        share, value = np.insert(share, place, more), np.insert(value, place, line.at(more))
    turn = np.angle(value[1:] / value[:-1])
    # half the line holds half the turn of an exponent on its ends, the whole one of each pair elsewhere
    count = max(0, round(-float(turn.sum()) / np.pi))
    if not count:
        return 0, None
    # on both ends the determinant is real, and negative for an odd number of real exponents beyond
    if value[0].real < 0.0:
        return count, "fold"
    return count, "period doubling" if value[-1].real < 0.0 else "second frequency"


class _Line:
    """Determinant along Re s = growth."""

    def __init__(self, equations: HarmonicEquations, reactions: MeshHarmonics) -> None:
        problem, grid = equations.problem, equations.grid
        model, form = problem.model, problem.form
        self.mesh = equations.base * grid.cells
        reach = min(grid.harmonics, STABILITY_HARMONICS)
        self.order = np.arange(-reach, reach + 1)
        lag = np.subtract.outer(self.order, self.order)
        self.stiff, self.damp = reactions.per_approach[:, :, lag], reactions.per_rate[:, :, lag]
        bodies, inputs = model.dofs[: model.n_bodies], mesh_inputs(model)
        out = model.approach[:, :-1] @ form.velocity_shapes[bodies]
        into = problem.into[:, inputs]
        self.poles = form.poles
        self.shape = (model.n_meshes, *inputs.shape)
        self.residues = np.einsum("ai,imp->ampi", out, into).reshape(-1, form.poles.size)

    def at(self, share: Array) -> Complex:
        """Determinant (n,) at frequencies per mesh frequency (n,)."""
        s = self.mesh * (GROWTH + 1j * (share[:, None] + self.order))
        gain = (1.0 / (s.ravel()[:, None] - self.poles)) @ self.residues.T / s.ravel()[:, None]
        gain = gain.reshape(*s.shape, *self.shape)
        tangent = self.stiff + self.damp * s[:, None, None, None, :]
        n_meshes, n = self.shape[0], self.order.size
        block = np.einsum("fkamp,fmpkl->fakml", gain, tangent, optimize=True)
        size = n_meshes * n
        return np.asarray(np.linalg.det(np.eye(size) - block.reshape(-1, size, size)))


Drags = Callable[[float], Mapping[str, float] | None]

MOST_POINTS = 240
"""Points of a branch traced at most."""
FEW_HARMONICS = 40
"""Harmonics from which on fewer points are traced, as each takes the square of them: slow speeds. They can lose contact
too: the prototype at 10 Nm has K_V 2.95 at 736 rpm (62 harmonics) and no contact for 14 % of the time, as the march
finds. Traced over all points its speeds from 640 to 780 rpm give the same states and no second branch; those without a
state are left by period doubling or a second frequency, none by a fold."""
PLAIN = (1.2, 1.5, 2.0, 3.0, 0.8, 0.6, 0.4)
"""Shares of a speed at which a plain response is looked for."""
OTHER_BRANCH = 0.02
"""Least difference of the approach, over its mean, of states that are two [-]."""


@dataclass
class HarmonicStates:
    """States by index of the speed, those of a second stable branch, and the reason for each that is missing.

    not_mesh_periodic : where the branch is there, and left by a motion of another period: no turning point is to be
        passed
    """

    solved: dict[int, HarmonicSolution] = field(default_factory=dict)
    other: dict[int, HarmonicSolution] = field(default_factory=dict)
    reasons: dict[int, str] = field(default_factory=dict)
    not_mesh_periodic: set[int] = field(default_factory=set)
    unstable: set[int] = field(default_factory=set)
    """Where a response with contact loss that does not last was found."""


class BranchSearch:
    """Search for the stable states of a loop at asked speeds."""

    def __init__(
        self,
        walk: HarmonicWalk,
        problem: Callable[[float], BalanceProblem],
        drags: Drags,
        speeds: Array,
        start: HarmonicSolution | None = None,
    ) -> None:
        """Prepare a search.

        problem, drags : at a speed of the drive freedom [rad/s]; speeds : (n,) of it, in the order of the walk
        start : state near that of the first speed, from which the walk begins
        """
        self._start = start
        self._walk, self._problem, self._drags, self._speeds = walk, problem, drags, speeds
        self._over_speed = SpeedProblem(problem=problem, drags=drags)
        self._open: dict[int, bool] = {}
        self._unstable_states: dict[int, list[HarmonicSolution]] = {}
        self.states = HarmonicStates()

    def on_one_branch(self) -> HarmonicStates:
        """Stable states by two walks, from the first speed to the last and back, without a trace: for maps, where many
        are asked, and for a speed alone."""
        self._walk_over(range(len(self._speeds)))
        if len(self._speeds) > 1:
            self._walk_over(range(len(self._speeds) - 1, -1, -1))
        return self.states

    def run(self) -> HarmonicStates:
        """All states; a reason stays where no stable one is known."""
        solved = self.states.solved
        self._walk_over(range(len(self._speeds)))
        if self._walk.cells == 1:
            if self.states.reasons:
                self._trace_gaps()
            if any(self._open.values()):
                self._walk_back()
        if solved and len(solved) + len(self.states.not_mesh_periodic) < len(self._speeds):
            self._walk_over(range(len(self._speeds) - 1, -1, -1))
        return self.states

    def _walk_over(self, order: range) -> None:
        """Each speed that has no state yet from the state before it."""
        last = self._start
        for i in order:
            if i not in self.states.solved and i not in self.states.not_mesh_periodic:
                try:
                    self._keep(i, self._solved(i, last))
                except DynamicsNotConverged as reason:
                    self.states.reasons.setdefault(i, str(reason))
            last = self.states.solved.get(i, last)

    def _solved(self, i: int, last: HarmonicSolution | None) -> HarmonicSolution:
        speed = float(self._speeds[i])
        self._walk.take(self._problem(speed))
        return self._walk.solve(speed, self._drags(speed), last)

    def _keep(self, i: int, state: HarmonicSolution) -> None:
        """Keep a stable state; DynamicsNotConverged for one that is not."""
        if self._walk.cells == 1:
            self._open[i] = False
            known = self._unstable_states.setdefault(i, [])
            if any(self._same(state, other) for other in known):
                return
            reason = self._unstable(state, i)
            if reason:
                known.append(state)
                self.states.unstable.add(i)
                if "(fold" not in reason:
                    self.states.not_mesh_periodic.add(i)
                raise DynamicsNotConverged(reason)
        self.states.solved[i] = state
        self.states.reasons.pop(i, None)

    def _unstable(self, state: HarmonicSolution, i: int | None = None) -> str:
        """Why a state with contact loss does not last; empty for a stable one, and for one that keeps contact."""
        equations = self._over_speed.equations(state.grid, state.speed)
        loses = _loses_contact(equations, state)
        if i is not None:
            self._open[i] = loses
        if not loses:
            return ""
        count, way = instability(equations, state)
        if not count:
            return ""
        return (
            f"harmonic balance at {state.speed:.6g} rad/s: the response with contact loss that repeats in every mesh "
            f"is unstable ({way}, {count} growing exponent{'s' if count > 1 else ''}); integrate in time"
        )

    def _trace_gaps(self) -> None:
        """Trace the branches through the speeds that have no state, from what is next to them."""
        missing = sorted(
            set(self.states.reasons) - self.states.not_mesh_periodic, key=lambda i: self._speeds[i]
        )
        for gap in _runs(missing, self._speeds):
            for rising in (True, False):
                if all(i in self.states.solved or i in self.states.not_mesh_periodic for i in gap):
                    break
                start = self._next_to(gap, rising=rising)
                if start is not None:
                    self._trace(start, gap, rising=rising)

    def _next_to(self, gap: list[int], *, rising: bool) -> HarmonicSolution | None:
        """Nearest state below (rising) or above the gap; a plain one from outside the speeds if there is none."""
        edge = self._speeds[gap].min() if rising else self._speeds[gap].max()
        side = 1.0 if rising else -1.0
        known = [i for i in self.states.solved if side * (edge - self._speeds[i]) > 0.0]
        if known:
            return self.states.solved[min(known, key=lambda i: abs(float(self._speeds[i] - edge)))]
        for share in PLAIN:
            if (share < 1.0) == rising:
                speed = float(share * edge)
                self._walk.take(self._problem(speed))
                try:
                    state = self._walk.solve(speed, self._drags(speed), None)
                except DynamicsNotConverged:
                    continue
                if not self._unstable(state):
                    return state
        return None

    def _trace(self, start: HarmonicSolution, gap: list[int], *, rising: bool) -> None:
        speeds = self._speeds[gap]
        reach = 0.1 * (speeds.max() - speeds.min()) + 0.02 * speeds.max()
        low = min(start.speed, float(speeds.min())) - reach
        high = max(start.speed, float(speeds.max())) + reach
        fine = resample(start, replace(start.grid, samples=2 * start.grid.samples))
        trace = BranchTrace(self._over_speed, fine, rising=rising)
        most = int(MOST_POINTS * min(1.0, FEW_HARMONICS / start.grid.harmonics) ** 2)
        for place, state in crossings(trace.points((low, high), most, speeds), start, speeds):
            i = gap[place]
            if i in self.states.solved and i in self.states.other:
                continue
            speed = float(self._speeds[i])
            self._walk.take(self._problem(speed))
            try:
                solved = self._walk.solve_near(speed, self._drags(speed), state)
                if i not in self.states.solved:
                    self._keep(i, solved)
                elif not self._same(solved, self.states.solved[i]) and not self._unstable(solved):
                    self.states.other[i] = solved
            except DynamicsNotConverged as reason:
                self.states.reasons[i] = str(reason)

    def _walk_back(self) -> None:
        """The other way through neighbouring speeds with contact loss, from the state after them."""
        known = self.states.solved
        last: HarmonicSolution | None = None
        for i in range(len(self._speeds) - 1, -1, -1):
            if i not in known:
                continue
            if last is not None and self._open.get(i, False) and i not in self.states.other:
                speed = float(self._speeds[i])
                self._walk.take(self._problem(speed))
                try:
                    state = self._walk.solve_near(speed, self._drags(speed), last)
                    if not self._same(state, known[i]) and not self._unstable(state):
                        self.states.other[i] = state
                        last = state
                        continue
                except DynamicsNotConverged:
                    pass
            last = known[i]

    def _same(self, a: HarmonicSolution, b: HarmonicSolution) -> bool:
        """Whether two states at one speed are one."""
        problem = self._problem(a.speed)
        b = resample(b, a.grid)
        apart = problem.model.approach[:, :-1] @ (a.ports - b.ports)
        return bool(np.abs(apart[:, 1:]).sum(axis=1).max() < OTHER_BRANCH * problem.approach_scale)


def _loses_contact(equations: HarmonicEquations, state: HarmonicSolution) -> bool:
    """Whether a mesh is open, or pressed on its other flank, anywhere in the period."""
    _, reactions = equations.residual(state_of(state))
    mean = reactions.transmitted.mean(axis=1, keepdims=True)
    return bool((reactions.transmitted * np.sign(mean) <= 1e-9 * np.abs(mean)).any())


def _runs(indices: list[int], speeds: Array) -> list[list[int]]:
    """Indices, by rising speed, in groups of neighbours among all speeds."""
    rank = {int(i): place for place, i in enumerate(np.argsort(speeds))}
    groups: list[list[int]] = []
    for i in indices:
        if groups and rank[i] == rank[groups[-1][-1]] + 1:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


# Pseudo-arclength continuation of a periodic response over speed, round the turning points of its branch.
#
# State and speed are unknowns together; a step goes along the tangent of the branch, and Newton's method comes back to
# it in the plane across the tangent, so that a turning point, where no state exists at the next speed, is passed as any
# other. Gear pairs with backlash bend their resonance to lower speeds: a stable branch ends at each of two turning
# points, with an unstable one between.
#
# Sources: Keller, Numerical solution of bifurcation and nonlinear eigenvalue problems, in Rabinowitz (ed.),
# Applications of Bifurcation Theory, 1977; for harmonic balance with contact von Groll & Ewins, J. Sound Vib. 241
# (2001) 223; gear pairs: Kahraman & Singh, J. Sound Vib. 142 (1990) 49.

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
        self._solution, self._state = start, state_of(start)
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
        crawled, passed = 0, [self._solution.speed]
        for left in range(most - 1, -1, -1):
            if not limits[0] <= self._solution.speed <= limits[1] or not self._advance():
                return
            assert self._chord is not None
            yield TracedPoint(solution=self._solution, rising=self._chord.speed > 0.0)
            if asked is None:
                continue
            away = float(np.abs(asked - self._solution.speed).min())
            crawled = crawled + 1 if left * self._length * self._scale < away else 0
            passed = [*passed[-STANDING:], self._solution.speed]
            stands = len(passed) > STANDING and left * np.abs(np.diff(passed)).mean() < away
            if crawled >= CRAWLING or stands:
                return

    def _advance(self) -> bool:
        """One step; False where none is short enough."""
        tangent = self._direction()
        if tangent is None:
            return False
        while self._length >= LEAST_STEP:
            corrected = self._corrected(tangent)
            if corrected is not None:
                solution, iterations = corrected
                self._chord = _Tangent(
                    state_of(solution).plus(self._state, -1.0), solution.speed - self._solution.speed
                )
                self._solution, self._state, self._tangent = solution, state_of(solution), tangent
                if iterations <= EASY:
                    self._length = min(1.6 * self._length, MOST_STEP)
                return True
            self._length *= 0.5
        return False

    def _direction(self) -> _Tangent | None:
        """Tangent at the present point, along the last step: at a corner, where a contact opens, it may turn back."""
        equations = self._over_speed.equations(self._solution.grid, self._solution.speed)
        residual, reactions = equations.residual(self._state)
        try:
            along = equations.step(self._per_speed(equations, residual, self._state), reactions)
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
        speed_ahead = self._solution.speed + self._length * tangent.speed
        state, speed = ahead, speed_ahead
        best: tuple[HarmonicSolution, int] | None = None
        for iteration in range(MOST_ITERATIONS):
            if not 0.0 < speed < math.inf:
                return None
            equations = self._over_speed.equations(self._solution.grid, speed, band=speed_ahead)
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
        prediction: tuple[HarmonicState, float, float],
    ) -> tuple[HarmonicState, float] | None:
        """Newton step of state and speed by bordering: two solutions with one matrix."""
        ahead, speed_ahead, speed = prediction
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
        after = point.solution
        low, high = sorted((before.speed, after.speed))
        passed = np.flatnonzero((speeds > low) & (speeds <= high))
        for i in passed if after.speed > before.speed else passed[::-1]:
            share = (speeds[i] - before.speed) / (after.speed - before.speed)
            yield int(i), _between(before, after, float(share), float(speeds[i]))
        before = after


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
