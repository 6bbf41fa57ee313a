"""Contact of a mesh from influence numbers at one instant of a march: forces of both gears from one potential.

At the place of the tooth pairs the points that the approach closes press on compliant flanks as in
``kernels.loaded_contact``; here approach x and tilt kappa are given, which closes the gap of point i by
e_i = w_i (x + kappa z_i - g_i). The forces are those of the largest

    U = F' e - F' A F / 2 - sum H_i(F_i),  F >= 0,  H the integral of the local approach h = F (a - c ln F)

so that dU/dx = sum w F is the force along the line of action, dU/dkappa = sum w z F its moment over the face and
r_b1 dU/ds the torque that the change over the path puts on the pinion. Sets of points that touch are tried one after
the other, starting from those of the step before (primal-dual active set: Hintermueller, Ito and Kunisch, SIAM J.
Optim. 13, 2002).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import sliding_direction

# compiled from sources 834b7ecd
Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_SETS = 30
"""Newton steps on the points that touch."""
CLOSED = 3e-12
"""Closing that may be left open at a point that touches [m]."""
LEAST_FORCE = 1e-6
"""Force with which a point comes in [N]."""


class PhaseTable(NamedTuple):
    """Points of a mesh that can touch somewhere in a base pitch; cubics (n_phases, 4, n_points), lowest power first.

    Built by ``dynamics.contact.phase_tables``.
    """

    start: float
    """Path position of pair 0 at mid-face at the first place [m]."""
    pitch: float
    """Transverse base pitch [m]."""
    pair: Integers
    """Number of the pair that each point is of (n_points,)."""
    later: Integers
    """(n_points,) point of the next pair at the same face position, -1 where there is none."""
    sooner: Integers
    """The same of the pair before."""
    face: Array
    """Face position of each point (n_points,) from mid-face [m]."""
    gap: Array
    """g, along the transverse line of action [m]."""
    weight: Array
    """w, closing along the normal per approach [-]."""
    local: Array
    """a of the local approach [m/N]."""
    reach_1: Array
    """Lever of friction about the pinion [m]."""
    reach_2: Array
    """The same about the wheel [m]."""
    compliance: Array
    """A, (n_phases, n_points, n_points, 4) [m/N]."""
    local_log: Array
    """c of the local approach (n_points,) [m/N]."""


class FlankMotion(NamedTuple):
    """How the gears stand to each other on one flank, counted in the direction that closes it."""

    path: float
    """Path position of pair 0 [m]."""
    approach: float
    tilt: float
    omega_1: float
    omega_2: float


class ContactWork(NamedTuple):
    """Memory of the contact of one flank, with the forces of the last step."""

    force: Array
    """F, (n_points,) [N]."""
    pitches: Integers
    """(1,) base pitches that pair 0 has gone."""
    closing: Array
    """(n_points,) [m]"""
    matrix: Array
    """(n_points, n_points) [m/N]"""
    factor: Array
    vectors: Array
    """(6, n_points)"""
    points: Integers
    """(2, n_points) those that may touch, those that do."""


class Pressed(NamedTuple):
    """What a flank answers."""

    force: float
    """N = dU/dx [N]."""
    moment: float
    """dU/dkappa [N m]."""
    per_path: float
    """dU/ds [N]."""
    energy: float
    stiffness: float
    """dN/dx [N/m]."""
    by_tilt: float
    """dN/dkappa [N]."""
    tilting: float
    """dM/dkappa [N m]."""
    lever_1: float
    """Sum of forces, direction of sliding and lever about the pinion, per friction [N m]."""
    lever_2: float
    rubbed: float
    """Sum of forces and direction of sliding, per friction [N]."""
    ended: bool


@njit(cache=True)
def contact_work(table: PhaseTable) -> ContactWork:
    """Return memory for the contact of a flank without force."""
    n = table.gap.shape[2]
    return ContactWork(
        np.zeros(n), np.zeros(1, np.int64), np.zeros(n), np.zeros((n, n)), np.zeros((n, n)), np.zeros((6, n)),
        np.zeros((2, n), np.int64),
    )  # fmt: skip


@njit(cache=True)
def _cubic(table: Array, k: int, t: float, i: int) -> float:
    return float(table[k, 0, i] + t * (table[k, 1, i] + t * (table[k, 2, i] + t * table[k, 3, i])))


@njit(cache=True)
def _slope(table: Array, k: int, t: float, i: int) -> float:
    return float(table[k, 1, i] + t * (2.0 * table[k, 2, i] + t * 3.0 * table[k, 3, i]))


@njit(cache=True)
def _carry_on(table: PhaseTable, work: ContactWork, pitches: int) -> None:
    """Hand the forces on to the same teeth where the pairs have gone on by a pitch."""
    moved = pitches - work.pitches[0]
    if moved != 0:
        before = work.vectors[0]
        before[:] = work.force
        to = table.later if moved > 0 else table.sooner
        for i in range(len(before)):
            work.force[i] = before[to[i]] if to[i] >= 0 and abs(moved) == 1 else 0.0
        work.pitches[0] = pitches


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _close(
    table: PhaseTable, motion: FlankMotion, deviations: Array, work: ContactWork, k: int, t: float
) -> int:
    """Write the closings without forces; return how many points they close, which are listed in ``work.points``."""
    n = table.gap.shape[2]
    count = 0
    for i in range(n):
        w, g = _cubic(table.weight, k, t, i), _cubic(table.gap, k, t, i)
        e = w * (motion.approach + motion.tilt * table.face[i] - g - deviations[i])
        work.closing[i] = e
        if e > 0.0:
            work.points[0, count] = i
            count += 1
        else:
            work.force[i] = 0.0
    candidates = work.points[0]
    for p in range(count):
        i = candidates[p]
        for q in range(p + 1):
            j = candidates[q]
            value = _cubic_2(table.compliance, k, t, i, j)
            work.matrix[p, q] = value
            work.matrix[q, p] = value
    return count


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _cubic_2(table: Array, k: int, t: float, i: int, j: int) -> float:
    return float(
        table[k, i, j, 0] + t * (table[k, i, j, 1] + t * (table[k, i, j, 2] + t * table[k, i, j, 3]))
    )


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _factorise(matrix: Array, m: int) -> None:
    """Cholesky factor of the leading (m, m) in place, row by row, with the inverse of its diagonal on the diagonal."""
    for i in range(m):
        for j in range(i):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = total * matrix[j, j]
        total = matrix[i, i]
        for k in range(i):
            total -= matrix[i, k] * matrix[i, k]
        matrix[i, i] = 1.0 / math.sqrt(max(total, 1e-300))


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _solve(factor: Array, m: int, right: Array) -> None:
    """Solve with the factor, in place."""
    for i in range(m):
        total = right[i]
        for k in range(i):
            total -= factor[i, k] * right[k]
        right[i] = total * factor[i, i]
    for i in range(m - 1, -1, -1):
        value = right[i] * factor[i, i]
        right[i] = value
        for k in range(i):
            right[k] -= factor[i, k] * value


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _find_forces(table: PhaseTable, work: ContactWork, count: int, k: int, t: float) -> int:
    """Bring the forces to the closings; return how many points touch, whose Newton matrix stays factorised, or -1.

    ``work.vectors[0]`` : local slope; [1] : what is left open; [2] : step, by place in the list of touching points
    """
    candidates, touching, force = work.points[0], work.points[1], work.force
    left, step = work.vectors[1], work.vectors[2]
    for _ in range(MOST_SETS):
        # what is open at every point that may touch
        for p in range(count):
            left[p] = work.closing[candidates[p]]
        for q in range(count):
            f = force[candidates[q]]
            if f > 0.0:
                for p in range(count):
                    left[p] -= work.matrix[q, p] * f
        m, worst = 0, 0.0
        for p in range(count):
            i = candidates[p]
            f, c = force[i], table.local_log[i]
            if f <= 0.0:
                if left[p] <= CLOSED:
                    continue
                f = LEAST_FORCE
                force[i] = f
                worst = np.inf
            a = _cubic(table.local, k, t, i)
            logarithm = math.log(f)
            left[p] -= f * (a - c * logarithm)
            worst = max(worst, abs(left[p]))
            work.vectors[0, m] = max(a - c - c * logarithm, 0.5 * c)
            touching[m] = p
            m += 1
        for p in range(m):
            for q in range(p + 1):
                work.factor[p, q] = work.matrix[touching[p], touching[q]]
            work.factor[p, p] += work.vectors[0, p]
            step[p] = left[touching[p]]
        _factorise(work.factor, m)
        if worst <= CLOSED:
            return m
        _solve(work.factor, m, step)
        for p in range(m):
            i = candidates[touching[p]]
            changed = force[i] + step[p]
            if changed < 0.0:
                # the logarithm is steep near zero: down by steps before a point is let go
                changed = (
                    0.0 if force[i] <= 2.0 * LEAST_FORCE or -step[p] > 4.0 * force[i] else 0.25 * force[i]
                )
            force[i] = changed
    return -1


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def press_phase(
    table: PhaseTable, motion: FlankMotion, deviations: Array, reversal_speed: float, work: ContactWork
) -> Pressed:
    """Return what a flank answers to a motion.

    deviations : (n_points,) gap that the teeth of a point add [m]
    reversal_speed : sliding speed over which friction changes its direction [m/s]
    """
    along = (motion.path - table.start) / table.pitch
    pitches = math.floor(along)
    phases = table.gap.shape[0]
    place = (along - pitches) * phases
    k = min(int(place), phases - 1)
    t = place - k
    _carry_on(table, work, int(pitches))
    count = _close(table, motion, deviations, work, k, t)
    if count == 0:
        return Pressed(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, True)
    m = _find_forces(table, work, count, k, t)
    ended = m >= 0
    m = max(m, 0)
    return _answer(table, motion, deviations, reversal_speed, work, m, ended, k, t)


@njit(cache=True, fastmath={"contract", "reassoc", "nsz", "arcp"})
def _answer(
    table: PhaseTable, motion: FlankMotion, deviations: Array, reversal_speed: float, work: ContactWork, m: int,
    ended: bool, k: int, t: float,
) -> Pressed:  # fmt: skip
    """Sum the forces of the points that touch."""
    candidates, touching = work.points[0], work.points[1]
    straight, tilted = work.vectors[3], work.vectors[4]
    total, moment, per_path, energy = 0.0, 0.0, 0.0, 0.0
    lever_1, lever_2, rubbed = 0.0, 0.0, 0.0
    for p in range(m):
        i = candidates[touching[p]]
        f, w, z = work.force[i], _cubic(table.weight, k, t, i), table.face[i]
        straight[p], tilted[p] = w, w * z
        total += w * f
        moment += w * z * f
        a, c, logarithm = _cubic(table.local, k, t, i), table.local_log[i], math.log(max(f, 1e-290))
        open_ = work.closing[i] / w
        per_path += f * (open_ * _slope(table.weight, k, t, i) - w * _slope(table.gap, k, t, i))
        per_path -= 0.5 * f * f * _slope(table.local, k, t, i)
        energy += f * work.closing[i] - 0.5 * f * f * (a - c * logarithm) - 0.25 * c * f * f
        reach_1, reach_2 = _cubic(table.reach_1, k, t, i), _cubic(table.reach_2, k, t, i)
        sliding = motion.omega_1 * reach_1 - motion.omega_2 * reach_2
        direction = w * f * sliding_direction(sliding / reversal_speed)
        lever_1 += direction * reach_1
        lever_2 += direction * reach_2
        rubbed += direction
        for q in range(m):
            j = candidates[touching[q]]
            both = 0.5 * f * work.force[j]
            energy -= both * work.matrix[touching[p], touching[q]]
            if q <= p:
                changes = table.compliance[k, i, j, 1] + t * (
                    2.0 * table.compliance[k, i, j, 2] + t * 3.0 * table.compliance[k, i, j, 3]
                )
                per_path -= both * changes * (1.0 if q == p else 2.0)
    per_path *= table.gap.shape[0] / table.pitch
    by_straight, by_tilted = work.vectors[0], work.vectors[5]
    for p in range(m):
        by_straight[p], by_tilted[p] = straight[p], tilted[p]
    _solve(work.factor, m, by_straight)
    _solve(work.factor, m, by_tilted)
    stiffness, by_tilt, tilting = 0.0, 0.0, 0.0
    for p in range(m):
        stiffness += straight[p] * by_straight[p]
        by_tilt += tilted[p] * by_straight[p]
        tilting += tilted[p] * by_tilted[p]
    return Pressed(
        total, moment, per_path, energy, stiffness, by_tilt, tilting, lever_1, lever_2, rubbed, ended
    )
