"""Frictionless contact of elastic points: gaps that close, forces that only press.

    v = w x - g - A F ,   v <= 0 where F = 0 ,   v = h(F) where F > 0 ,   sum w F = P or x given

with the local approach ``h(F) = F (a - c ln F)`` of each point, continued as a straight line where its derivative has
fallen to half of ``c``. In the unknown ``v``, ``F = h^-1(max(v, 0))``, this is one system of equations whose semismooth
Newton step is the linear system of the points in contact: quadratic convergence, and the end after finitely many
steps for a linear ``h`` (Qi and Sun, Math. Programming 58, 1993). What is local must not vanish against A: of a purely
linear problem part of the diagonal of A is counted as ``h``.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

CONVERGED, NO_CONVERGENCE, NOT_POSITIVE, NO_FORCE = 0, 1, 2, 3
MOST_STEPS = 200
FULL_STEPS = 40
"""Steps taken in full, a change of the points that touch included; halved after that where the residual grows."""
RESIDUAL = 1e-12
LEAST_SLOPE = 0.5
"""Least derivative of h in multiples of c."""


class ContactProblem(NamedTuple):
    """Elastic points that may touch; n of them."""

    compliance: Array
    """A, (n, n) symmetric, positive definite together with h [m/N]."""
    gap: Array
    """g, (n,) along the contact normals [m]."""
    weight: Array
    """w, (n,) closing of a gap per approach, above 0 [-]."""
    local: Array
    """(n, 2) a and c of the local approach h(F) = F (a - c ln F) with F in N [m/N]; c = 0: linear."""


class ContactSolution(NamedTuple):
    """Forces of the points and their approach."""

    force: Array
    """F, (n,) [N]."""
    closing: Array
    """v, (n,): local approach where positive, what is left of the gap where negative [m]."""
    approach: float
    """x [m]."""
    tangent: float
    """dP/dx with the points that touch [N/m]."""
    residual: float
    """Largest of the residuals, relative to closing and force [-]."""
    steps: int
    status: int


@njit(cache=True)
def _turning_force(a: float, c: float) -> float:
    """Force at which h becomes straight [N]."""
    return math.exp(min(a / c - 1.0 - LEAST_SLOPE, 690.0)) if c > 0.0 else np.inf


@njit(cache=True)
def local_approach(force: float, a: float, c: float) -> float:
    """Return h(F) [m]."""
    if force <= 0.0:
        return 0.0
    if c == 0.0:
        return a * force
    turn = _turning_force(a, c)
    if force <= turn:
        return force * (a - c * math.log(force))
    return turn * (a - c * math.log(turn)) + LEAST_SLOPE * c * (force - turn)


@njit(cache=True)
def _local_slope(force: float, a: float, c: float) -> float:
    """Return h'(F) [m/N]."""
    if c == 0.0:
        return a
    if force >= _turning_force(a, c):
        return LEAST_SLOPE * c
    return a - c - c * math.log(max(force, 1e-290))


@njit(cache=True)
def _local_force(closing: float, a: float, c: float, near: float) -> float:
    """Return the force whose local approach is ``closing`` [N]; ``near`` is one to start from.

    Newton in ln F, where ln h is increasing and concave: monotone after the first step.
    """
    if closing <= 0.0:
        return 0.0
    if c == 0.0:
        return closing / a
    turn = _turning_force(a, c)
    most = turn * (a - c * math.log(turn))
    if closing >= most:
        return turn + (closing - most) / (LEAST_SLOPE * c)
    last = math.log(turn)
    t = min(math.log(near), last) if near > 0.0 else last
    wanted = math.log(closing)
    for _ in range(60):
        local = a - c * t
        step = (t + math.log(local) - wanted) / (1.0 - c / local)
        t = min(t - step, last)
        if abs(step) < 1e-15 * max(1.0, abs(t)):
            break
    return math.exp(t)


@njit(cache=True)
def _factorise(matrix: Array) -> bool:
    """Cholesky factor in place, lower half; False if the matrix is not positive definite."""
    n = len(matrix)
    for j in range(n):
        for k in range(j):
            factor = matrix[j, k]
            for i in range(j, n):
                matrix[i, j] -= matrix[i, k] * factor
        if not matrix[j, j] > 0.0:
            return False
        scale = 1.0 / math.sqrt(matrix[j, j])
        for i in range(j, n):
            matrix[i, j] *= scale
    return True


@njit(cache=True)
def _solve(factor: Array, right: Array) -> None:
    """Solve with the Cholesky factor, in place."""
    n = len(right)
    for i in range(n):
        total = right[i]
        for k in range(i):
            total -= factor[i, k] * right[k]
        right[i] = total / factor[i, i]
    for i in range(n - 1, -1, -1):
        total = right[i]
        for k in range(i + 1, n):
            total -= factor[k, i] * right[k]
        right[i] = total / factor[i, i]


@njit(cache=True)
def _uncoupled(problem: ContactProblem, force: float) -> float:
    """Approach of points that do not know of each other, to start from [m]."""
    n = len(problem.gap)
    stiffness, opens = np.empty(n), problem.gap / problem.weight
    for i in range(n):
        slope = _local_slope(force / n, problem.local[i, 0], problem.local[i, 1])
        stiffness[i] = problem.weight[i] / (problem.compliance[i, i] + slope)
    total, moment, x = 0.0, 0.0, np.inf
    for _ in range(n):
        i = 0  # the next to touch
        for k in range(1, n):
            if opens[k] < opens[i]:
                i = k
        if opens[i] >= x:
            break
        total += stiffness[i] * problem.weight[i]
        moment += stiffness[i] * problem.weight[i] * opens[i]
        x = (force + moment) / total
        opens[i] = np.inf
    return x


@njit(cache=True)
def _residuals(
    problem: ContactProblem, closing: Array, forces: Array, x: float, wanted: float, left: Array
) -> tuple[float, float]:
    """Write w x - g - A F - v into ``left``; return merit and what is missing of the force, both relative.

    ``wanted`` : force, or nan where the approach is given.
    """
    n, scale, total = len(forces), 1e-300, 0.0
    for i in range(n):
        total += problem.weight[i] * forces[i]
        left[i] = problem.weight[i] * x - problem.gap[i]
        scale = max(scale, abs(closing[i]))
        if forces[i] > 0.0:
            scale = max(scale, abs(left[i]))
    for j in range(n):
        if forces[j] > 0.0:
            for i in range(n):
                left[i] -= problem.compliance[j, i] * forces[j]
    most = 0.0
    for i in range(n):
        left[i] -= closing[i]
        most = max(most, abs(left[i]))
    missing = 0.0 if math.isnan(wanted) else (wanted - total) / wanted
    return most / scale, missing


@njit(cache=True)
def _direction(
    problem: ContactProblem,
    closing: Array,
    forces: Array,
    left: Array,
    missing: float,
    held: bool,
    step: Array,
) -> tuple[float, float, int]:
    """Newton step of the closings into ``step``; return that of the approach, the tangent and a status.

    missing : force that is to be added [N]; held : the approach stays
    """
    n, m = len(forces), 0
    touching = np.empty(n, np.int64)
    for i in range(n):
        if closing[i] > 0.0:
            touching[m] = i
            m += 1
    if m == 0:
        if held:
            _copy(left, step)
            return 0.0, 0.0, CONVERGED
        return 0.0, 0.0, NO_FORCE
    matrix, by_rest, by_approach = np.empty((m, m)), np.empty(m), np.empty(m)
    for p in range(m):
        i = touching[p]
        by_rest[p], by_approach[p] = left[i], problem.weight[i]
        for q in range(p, m):
            matrix[q, p] = problem.compliance[touching[q], i]
        matrix[p, p] += _local_slope(forces[i], problem.local[i, 0], problem.local[i, 1])
    if not _factorise(matrix):
        return 0.0, 0.0, NOT_POSITIVE
    _solve(matrix, by_rest)
    _solve(matrix, by_approach)
    tangent, pressed = 0.0, 0.0
    for p in range(m):
        tangent += problem.weight[touching[p]] * by_approach[p]
        pressed += problem.weight[touching[p]] * by_rest[p]
    dx = 0.0 if held else (missing - pressed) / tangent
    for i in range(n):
        step[i] = left[i] + problem.weight[i] * dx
    for p in range(m):
        more = by_rest[p] + dx * by_approach[p]
        for i in range(n):
            step[i] -= problem.compliance[touching[p], i] * more
    return dx, tangent, CONVERGED


@njit(cache=True)
def _copy(values: Array, into: Array) -> None:
    """Entry by entry: what numba makes of ``into[:] = values`` takes seconds to compile, for its error message."""
    for i in range(len(values)):
        into[i] = values[i]


@njit(cache=True)
def _forces(problem: ContactProblem, closing: Array, forces: Array) -> None:
    """Bring the forces to the closings."""
    for i in range(len(forces)):
        forces[i] = _local_force(closing[i], problem.local[i, 0], problem.local[i, 1], forces[i])


@njit(cache=True)
def _start(problem: ContactProblem, x: float, near: Array) -> tuple[Array, Array]:
    """Forces and closings to start from: the forces given, or those of points that do not know of each other."""
    n, warm = len(near), False
    closing, forces = np.empty(n), np.empty(n)
    for i in range(n):
        forces[i] = near[i]
        warm = warm or near[i] > 0.0
    for i in range(n):
        a, c = problem.local[i, 0], problem.local[i, 1]
        over = problem.weight[i] * x - problem.gap[i]
        if not warm:
            forces[i] = max(over, 0.0) / (problem.compliance[i, i] + a)
        closing[i] = local_approach(forces[i], a, c) if forces[i] > 0.0 else min(over, 0.0)
    return closing, forces


@njit(cache=True)
def press_points(problem: ContactProblem, force: float, approach: float, near: Array) -> ContactSolution:
    """Solve for forces and approach.

    Parameters
    ----------
    force : P [N], above 0, or nan with the approach given
    approach : x [m] if ``force`` is nan; otherwise where to start, nan without a start
    near : (n,) forces to start from [N]; zero without a start

    Returns a solution whose ``status`` is CONVERGED, NO_CONVERGENCE, NOT_POSITIVE (the compliance of the points that
    touch is not positive definite) or NO_FORCE (no point can take the force).
    """
    n, held = len(near), math.isnan(force)
    x = approach
    if not held and math.isnan(approach):
        x = _uncoupled(problem, force)
    closing, forces = _start(problem, x, near)
    left, step = np.empty(n), np.empty(n)
    trial, trial_forces, trial_left = np.empty(n), np.empty(n), np.empty(n)
    worst, missing = _residuals(problem, closing, forces, x, force, left)
    status, steps = NO_CONVERGENCE, 0
    while steps < MOST_STEPS and not (worst <= RESIDUAL and abs(missing) <= RESIDUAL):
        lacking = 0.0 if held else missing * force
        dx, _, status = _direction(problem, closing, forces, left, lacking, held, step)
        if status != CONVERGED:
            break
        status = NO_CONVERGENCE
        part, merit = 1.0, worst + abs(missing)
        for _ in range(1 if steps < FULL_STEPS else 12):
            for i in range(n):
                trial[i] = closing[i] + part * step[i]
            _copy(forces, trial_forces)
            _forces(problem, trial, trial_forces)
            now, lack = _residuals(problem, trial, trial_forces, x + part * dx, force, trial_left)
            if now + abs(lack) < (1.0 - 1e-4 * part) * merit or now + abs(lack) < 10.0 * RESIDUAL:
                break
            part *= 0.5
        _copy(trial, closing)
        _copy(trial_forces, forces)
        _copy(trial_left, left)
        x, worst, missing = x + part * dx, now, lack
        steps += 1
    if worst <= RESIDUAL and abs(missing) <= RESIDUAL:
        status = CONVERGED
    _, tangent, _ = _direction(problem, closing, forces, left, 0.0, True, step)
    return ContactSolution(forces, closing, x, tangent, max(worst, abs(missing)), steps, status)
