"""March of a drivetrain whose gear contacts are solved in every step (``kernels.looped_contact``).

The linear part is taken over a step exactly, mode by mode, under forces that are linear in it. The forces at the end of
the step are found by Newton's method on the motion of the meshes: what a force gives to the motion of its own step is
small, so that one look at the contacts is mostly enough.

Each mesh has the seven rows of ``dynamics.elastic_rig.wrench_rows``: approach and tilt of both flanks, turns of both
gears and slide.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.looped_contact import (
    ContactWork,
    FlankMotion,
    PhaseTable,
    contact_work,
    press_phase,
)

# compiled from sources 834b7ecd
Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Integers = NDArray[np.int64]

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
    """Linear part over one step, for forces (n_rows,) that are linear in it; see ``dynamics.response.held_modes``.

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
