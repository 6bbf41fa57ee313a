"""Time integration of a drivetrain whose tooth contacts are solved from influence numbers in every step.

The contact of a mesh at one instant: forces of both gears from one potential.

At the place of the tooth pairs the points that the approach closes press on compliant flanks as in
``dynamics.kernels.loaded_contact``; here approach x and tilt kappa are given, which closes the gap of point i by
e_i = w_i (x + kappa z_i - g_i). The forces are those of the largest

    U = F' e - F' A F / 2 - sum H_i(F_i),  F >= 0,  H the integral of the local approach h = F (a - c ln F)

so that dU/dx = sum w F is the force along the line of action, dU/dkappa = sum w z F its moment over the face and
r_b1 dU/ds the torque that the change over the path puts on the pinion. Sets of points that touch are tried one after
the other, starting from those of the step before (primal-dual active set: Hintermueller, Ito and Kunisch, SIAM J.
Optim. 13, 2002).

The linear part is taken over a step exactly, mode by mode, under forces that are linear in it. The forces at the end of
the step are found by Newton's method on the motion of the meshes: what a force gives to the motion of its own step is
small, so that one look at the contacts is mostly enough.

Each mesh has the seven rows of ``dynamics.rotor.craig_bampton``: approach and tilt of both flanks, turns of both
gears and slide.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import sliding_direction

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

MOST_SETS = 30
"""Newton steps on the points that touch."""
CLOSED = 3e-12
"""Closing that may be left open at a point that touches [m]."""
LEAST_FORCE = 1e-6
"""Force with which a point comes in [N]."""


class PhaseTable(NamedTuple):
    """Points of a mesh that can touch somewhere in a base pitch; cubics (n_phases, 4, n_points), lowest power first.

    Built by ``tests.contact_in_loop.phase_tables``.
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


APPROACH, TILT, TURN_1, TURN_2, SLIDE, BACK_APPROACH, BACK_TILT = range(7)
N_ROWS = 7
MOST_LOOKS = 6
"""Looks at the contacts in one step."""
AGREED = 5e-4
"""Change of a mesh force by the last Newton step, over the mean force, with which a step ends: what it leaves is of its
square."""
# what is recorded of a mesh at each step
R_FORCE, R_OTHER_FORCE, R_MOMENT, R_APPROACH, R_TILT, R_ANGLE, R_SPEED, R_ENERGY = range(8)
N_RECORD = 8


class LoopedMesh(NamedTuple):
    """Plain numbers of one mesh; its flank that carries is in front where ``side`` is 1, else on the back."""

    base_radius_1: float
    base_radius_2: float
    offset: float
    """Imposed approach of the front flanks [m]."""
    backlash: float
    phase: float
    """Path position of pair 0 on the front flanks at no turn of the pinion [m]."""
    back_phase: float
    damp_time: float
    """Damping of the mesh over its stiffness [s]."""
    halves: float
    """Equal contacts side by side, of which the table holds one [-]."""
    friction: float
    reversal_speed: float
    mean_force: float
    """Transverse, by which errors are measured [N]."""
    mean_moment: float
    """Moment of the mean load over the face, counted in the shafts that the tables know of already [N m]."""
    side: float
    deviations_1: Array
    """Gap that each pinion tooth adds on the flank that carries (teeth,) [m]."""
    deviations_2: Array
    """The same of the wheel teeth, that of pair 0 first (teeth,) [m]."""


class HeldModes(NamedTuple):
    """Linear part over one step, for forces (n_rows,) that are linear in it; see ``tests.contact_in_loop.modes``.

    Modes are complex, one of each conjugate pair; as real numbers their real parts come first, then the imaginary ones.
    """

    decay: Complex
    """(n_modes,)"""
    pushed: Array
    """(2 n_modes, 2 n_rows) modes at the end per force at the start and at the end of the step."""
    seen: Array
    """(2 n_rows, 2 n_modes) motion in a step per mode at its start, and speed at its end."""
    given: Array
    """(2 n_rows, 2 n_rows) the same per force at the start, by all modes and by those left out, and at the end."""
    constant: Array
    """(2 n_modes,) modes at the end by loads that stay."""
    given_constant: Array
    """(2 n_rows,) motion and speed by loads that stay."""


class LoopedState(NamedTuple):
    """Carried from call to call."""

    modes: Array
    """(2 n_modes,)"""
    motion: Array
    """(n_rows,)"""
    forces: Array
    """(3, n_rows) of the last instants, latest first."""
    work: Array
    """(3,) work of the meshes on the drivetrain, of friction and of dampers [J]."""
    power: Array
    """(3,) the powers of the last instant [W]; NaN before the first step."""


@njit(cache=True)
def _tooth_gaps(mesh: LoopedMesh, table: PhaseTable, path: float, gaps: Array) -> None:
    """Write what the teeth of each point add to its gap."""
    gone = math.floor((path - table.start) / table.pitch)
    n_1, n_2 = len(mesh.deviations_1), len(mesh.deviations_2)
    for i in range(len(gaps)):
        number = table.pair[i] + gone
        gaps[i] = mesh.deviations_1[number % n_1] + mesh.deviations_2[number % n_2]


@njit(cache=True)
def _look(
    mesh: LoopedMesh, table: PhaseTable, work: tuple[ContactWork, ContactWork], gaps: Array, motion: Array,
    speeds: Array, answer: Array, stiff: Array, shares: Array,
) -> bool:  # fmt: skip
    """Write what a mesh answers: ``answer`` (7,) forces on its rows, ``stiff`` (2, 4) N and M per approach and tilt and
    per their rates on both flanks, ``shares`` (3,) stored energy, power of friction and of dampers.
    """
    ended = True
    answer[:] = 0.0
    shares[:] = 0.0
    for flank in range(2):
        side = 1.0 if flank == 0 else -1.0
        first = APPROACH if flank == 0 else BACK_APPROACH
        carries = side == mesh.side
        mirrored = 1.0 if carries else -1.0  # face positions of the flank that does not carry
        if flank == 0:
            reach = motion[APPROACH] + mesh.offset
            path = mesh.phase + mesh.base_radius_1 * motion[TURN_1]
        else:
            reach = motion[BACK_APPROACH] - mesh.offset - mesh.backlash
            path = mesh.back_phase - mesh.base_radius_1 * motion[TURN_1]
        if carries:
            _tooth_gaps(mesh, table, path, gaps)
        else:
            gaps[:] = 0.0
        omega_1, omega_2 = side * speeds[TURN_1], side * speeds[TURN_2]
        tilt = mirrored * motion[first + 1]
        found = press_phase(
            table, FlankMotion(path, reach, tilt, omega_1, omega_2), gaps, mesh.reversal_speed, work[flank]
        )
        ended = ended and found.ended
        rate, swing = speeds[first], mirrored * speeds[first + 1]
        damped = mesh.damp_time * (found.stiffness * rate + found.by_tilt * swing)
        damped_moment = mesh.damp_time * (found.by_tilt * rate + found.tilting * swing)
        if found.force + damped < 0.0:
            damped, damped_moment = -found.force, -found.moment
        halves, friction = mesh.halves, mesh.halves * mesh.friction
        moment = halves * (found.moment + damped_moment) - (mesh.mean_moment if carries else 0.0)
        answer[first] = -halves * (found.force + damped)
        answer[first + 1] = -mirrored * moment
        answer[SLIDE] -= friction * found.rubbed
        answer[TURN_1] -= side * (halves * mesh.base_radius_1 * found.per_path + friction * found.lever_1)
        answer[TURN_2] += side * friction * found.lever_2
        stiff[flank, 0], stiff[flank, 1] = halves * found.stiffness, halves * mirrored * found.by_tilt
        stiff[flank, 2], stiff[flank, 3] = halves * found.tilting, halves * found.force
        shares[0] += halves * found.energy
        shares[1] += friction * (found.lever_1 * omega_1 - found.lever_2 * omega_2)
        shares[1] += friction * found.rubbed * speeds[SLIDE]
        shares[2] += halves * (damped * rate + damped_moment * swing)
    return ended


@njit(cache=True)
def _newton(meshes: tuple[LoopedMesh, ...], stiff: Array, new: Array, error: Array, change: Array) -> None:
    """Write the change of the forces (n_rows,) that takes ``error`` away, with what it does to the motion.

    new : (2 n_rows, n_rows) motion and speed at the end of the step per force there

    Only the rows of approach and tilt answer to motion at once; the others follow in the next look.
    """
    n_rows = len(error)
    active = np.empty(n_rows, np.int64)
    gain = np.zeros((n_rows, n_rows))
    n = 0
    for m in range(len(meshes)):
        for flank in range(2):
            if stiff[m, flank, 0] <= 0.0:
                continue
            first = N_ROWS * m + (APPROACH if flank == 0 else BACK_APPROACH)
            for row in range(2):
                active[n] = first + row
                for j in range(n_rows):
                    total = 0.0
                    for column in range(2):
                        k = stiff[m, flank, row + column]
                        moved = new[first + column, j]
                        rate = new[n_rows + first + column, j]
                        total -= k * (moved + meshes[m].damp_time * rate)
                    gain[n, j] = total
                n += 1
    change[:] = error
    matrix, right = np.zeros((n, n)), np.zeros(n)
    for p in range(n):
        right[p] = error[active[p]]
        for j in range(n_rows):
            right[p] += gain[p, j] * error[j]
        for q in range(n):
            right[p] -= gain[p, active[q]] * error[active[q]]
            matrix[p, q] = (1.0 if p == q else 0.0) - gain[p, active[q]]
    solved = np.linalg.solve(matrix, right)
    for p in range(n):
        change[active[p]] = solved[p]


@njit(cache=True)
def _turn_modes(modes: HeldModes, state: Array, pushed: Array) -> None:
    """Take the modes over a step."""
    n = len(modes.decay)
    for k in range(n):
        real, imag = state[k], state[n + k]
        decay = modes.decay[k]
        state[k] = decay.real * real - decay.imag * imag + pushed[k] + modes.constant[k]
        state[n + k] = decay.real * imag + decay.imag * real + pushed[n + k] + modes.constant[n + k]


@njit(cache=True)
def _keep(
    meshes: tuple[LoopedMesh, ...], forces: Array, moved: Array, shares: Array, record: Array, now: int
) -> None:
    """Record the meshes at the end of a step, as their flanks that carry see them."""
    n_rows = len(forces)
    for m in range(len(meshes)):
        first = N_ROWS * m
        carries, other = first + APPROACH, first + BACK_APPROACH
        if meshes[m].side < 0.0:
            carries, other = other, carries
        tilted = carries + 1
        record[m, R_FORCE, now] = -forces[carries]
        record[m, R_OTHER_FORCE, now] = -forces[other]
        record[m, R_MOMENT, now] = -forces[tilted]
        record[m, R_APPROACH, now] = moved[carries] + meshes[m].side * meshes[m].offset
        record[m, R_TILT, now] = moved[tilted]
        record[m, R_ANGLE, now] = moved[first + TURN_1]
        record[m, R_SPEED, now] = moved[n_rows + first + TURN_1]
        record[m, R_ENERGY, now] = shares[m, 0]


@njit(cache=True)
def looped_march(
    meshes: tuple[LoopedMesh, ...], tables: tuple[PhaseTable, ...], modes: HeldModes, state: LoopedState, step: float,
    record: Array,
) -> int:  # fmt: skip
    """March ``record.shape[2]`` steps; ``record`` (n_meshes, N_RECORD, n_steps). Return how many did not converge.

    A motion that leaves the finite numbers ends the march; the record is NaN from there on.
    """
    n_meshes, n_rows = len(meshes), len(state.motion)
    works = [(contact_work(tables[m]), contact_work(tables[m])) for m in range(n_meshes)]
    gaps = [np.zeros(tables[m].gap.shape[2]) for m in range(n_meshes)]
    forces, force = np.zeros(2 * n_rows), np.zeros(n_rows)
    error, change, answer = np.zeros(n_rows), np.zeros(n_rows), np.zeros(n_rows)
    stiff, shares = np.zeros((n_meshes, 2, 4)), np.zeros((n_meshes, 3))
    old, new = np.ascontiguousarray(modes.given[:, :n_rows]), np.ascontiguousarray(modes.given[:, n_rows:])
    unconverged = 0
    power = np.zeros(3)
    for now in range(record.shape[2]):
        last = state.forces[0]
        led = modes.seen @ state.modes + old @ last + modes.given_constant
        led[:n_rows] += state.motion
        force[:] = 3.0 * (last - state.forces[1]) + state.forces[2]
        converged, looks = False, 0
        while not converged and looks < MOST_LOOKS:
            moved = led + new @ force
            if not np.all(np.isfinite(moved)):
                record[:, :, now:] = np.nan
                return unconverged
            converged = True
            for m in range(n_meshes):
                rows = slice(N_ROWS * m, N_ROWS * (m + 1))
                speeds = moved[n_rows + N_ROWS * m : n_rows + N_ROWS * (m + 1)]
                ended = _look(
                    meshes[m],
                    tables[m],
                    works[m],
                    gaps[m],
                    moved[rows],
                    speeds,
                    answer[rows],
                    stiff[m],
                    shares[m],
                )
                converged = converged and ended
            error[:] = answer - force
            _newton(meshes, stiff, new, error, change)
            for m in range(n_meshes):
                for i in (APPROACH, BACK_APPROACH):
                    if abs(change[N_ROWS * m + i]) > AGREED * meshes[m].mean_force:
                        converged = False
            force += change
            looks += 1
        if not converged:
            unconverged += 1
        moved += new @ change
        forces[:n_rows], forces[n_rows:] = last, force
        _turn_modes(modes, state.modes, modes.pushed @ forces)
        power[0] = np.dot(force, moved[n_rows:])
        power[1], power[2] = np.sum(shares[:, 1]), np.sum(shares[:, 2])
        for i in range(3):
            state.work[i] += 0.0 if math.isnan(state.power[i]) else 0.5 * step * (state.power[i] + power[i])
            state.power[i] = power[i]
        _keep(meshes, force, moved, shares, record, now)
        state.motion[:] = moved[:n_rows]
        state.forces[2], state.forces[1] = state.forces[1], state.forces[0]
        state.forces[0] = force
    return unconverged
