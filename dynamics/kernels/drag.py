"""Drag torques of bearings, windage, oil and seals within one step of the time integration.

Each is a function of the speed of its own place, evaluated at the end of the same step that it acts on, all drag
torques of a line together. A torque that is linear between the ends of a step works on a vibration of any frequency
without delay: the linear interpolation has a real, positive spectrum, so that what the modes answer to it stays
positive real, and a torque that opposes the motion takes energy from every mode, above the step rate too. Held over a
step, the same torque lags behind and feeds the modes near the step rate.

Source: passivity of sampled systems under a first-order hold, Desoer and Vidyasagar, Feedback Systems (1975), VI.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined, sliding_direction
from dynamics.kernels.contact_table import V_R1, V_R2
from dynamics.kernels.integrator_state import NEW, OLD, Meshes, torque_at
from dynamics.kernels.linear_step import BANK_AT, FOUR, STATE_AT, DragModes
from dynamics.kernels.modal_step import N_BANK, WIDTH

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ITERATIONS = 30
MOST_SWEEPS = 100
TOLERANCE = 1e-5
"""Share of a drag torque that the iteration may leave open."""


class DragLaws(NamedTuple):
    """Drag torque over speed; the same against both directions."""

    torque: Array
    """(n_drags, n_table) over the speed from 0, at equal distances [N m]."""
    per_step: Array
    """(n_drags,) distances of the table per speed [s/rad]."""
    creep: Array
    """(n_drags,) speed below which the torque goes smoothly through zero [rad/s]."""


class DragWork(NamedTuple):
    """Arrays that are written in every step."""

    change: Array
    """(n_drags,) of the drag torques in the step [N m]."""
    speed: Array
    """(n_drags,) of their places at its end [rad/s]."""
    damping: Array
    """(n_drags,) derivatives of the torques over these speeds [N m s/rad]."""
    outputs: Array
    """(2 n_ports,) what the torques give to the ports."""


@inlined
def _drag_at(laws: DragLaws, d: int, speed: float) -> tuple[float, float]:
    """Return the torque against ``speed`` and its derivative."""
    last = laws.torque.shape[1] - 1
    place = min(abs(speed) * laws.per_step[d], last - 1e-9)
    j = max(0, min(int(place), last - 1))
    rise = laws.torque[d, j + 1] - laws.torque[d, j]
    value = laws.torque[d, j] + (place - j) * rise
    damping = rise * laws.per_step[d] if abs(speed) * laws.per_step[d] < last else 0.0
    if abs(speed) >= laws.creep[d]:
        return (value, damping) if speed > 0.0 else (-value, damping)
    ratio = speed / laws.creep[d]
    direction = sliding_direction(ratio)
    return value * direction, damping * abs(direction) + value * 1.5 * (1.0 - ratio * ratio) / laws.creep[d]


@inlined
def _braked(laws: DragLaws, d: int, free: float, own: float, speed: float) -> tuple[float, float]:
    """Return the torque, and its derivative, of a drag whose place would rotate at ``free`` without it, by ``own`` per
    torque less.

    The speed lies between zero and ``free``, since the torque opposes it; Newton steps from ``speed`` stay there.
    """
    low, high = min(0.0, free), max(0.0, free)
    speed = min(max(speed, low), high)
    torque, damping = 0.0, 0.0
    for _ in range(MOST_ITERATIONS):
        torque, damping = _drag_at(laws, d, speed)
        new = speed - (speed + own * torque - free) / (1.0 + own * damping)
        change = damping * (min(max(new, low), high) - speed)
        speed = min(max(new, low), high)
        torque += change
        if abs(change) <= TOLERANCE * abs(torque):
            break
    return torque, damping


@inlined
def _outputs(per_torque: Array, torque: Array, total: Array) -> None:
    """Fill what drag torques give to the outputs of the ports, ``total`` (2 n_ports,)."""
    for m in range(total.shape[0] // 4):
        v_1, t_1, v_2, t_2 = 0.0, 0.0, 0.0, 0.0
        for d in range(torque.shape[0]):
            v_1 += per_torque[d, 4 * m] * torque[d]
            t_1 += per_torque[d, 4 * m + 1] * torque[d]
            v_2 += per_torque[d, 4 * m + 2] * torque[d]
            t_2 += per_torque[d, 4 * m + 3] * torque[d]
        total[4 * m], total[4 * m + 1], total[4 * m + 2], total[4 * m + 3] = v_1, t_1, v_2, t_2


@inlined
def drags_on_ports(drags: DragModes, torque: Array, total: Array, meshes: Meshes) -> None:
    """Add to speeds and turns of the ports what drag torques give that stay as they are over the step."""
    _outputs(drags.ports_held, torque, total)
    for m in range(total.shape[0] // 4):
        mesh = meshes[m & POSITIVE]
        mesh.pinion.speed += total[4 * m]
        mesh.pinion.turn += total[4 * m + 1]
        mesh.wheel.speed += total[4 * m + 2]
        mesh.wheel.turn += total[4 * m + 3]


@inlined
def _move_ports(drags: DragModes, change: Array, total: Array, values: Array, meshes: Meshes) -> None:
    """Add to ports and meshes what changes of the drag torques at the end of the step give."""
    _outputs(drags.ports_new, change, total)
    for m in range(total.shape[0] // 4):
        mesh = meshes[m & POSITIVE]
        speed_1, turn_1, speed_2, turn_2 = total[4 * m], total[4 * m + 1], total[4 * m + 2], total[4 * m + 3]
        mesh.pinion.speed += speed_1
        mesh.pinion.turn += turn_1
        mesh.wheel.speed += speed_2
        mesh.wheel.turn += turn_2
        mesh.reach += values[m, V_R1] * turn_1 - values[m, V_R2] * turn_2
        mesh.rate += values[m, V_R1] * speed_1 - values[m, V_R2] * speed_2


@inlined
def push_drags(drags: DragModes, blocks: Integers, torque: Array, bank: Array) -> None:
    """Add to the state after the step what the drag torques at its start give."""
    push = drags.push
    for four in range(drags.branches.shape[0]):
        block, d = drags.branches[four], (FOUR * four) & POSITIVE
        t_0, t_1, t_2, t_3 = torque[d], torque[d + 1], torque[d + 2], torque[d + 3]
        for group in range(drags.groups[four]):
            s = (blocks[block, STATE_AT] + 2 * WIDTH * group) & POSITIVE
            b = (blocks[block, BANK_AT] + N_BANK * WIDTH * group) & POSITIVE
            for i in range(2 * WIDTH):
                bank[b + i] += (
                    push[d, s + i] * t_0
                    + push[d + 1, s + i] * t_1
                    + push[d + 2, s + i] * t_2
                    + push[d + 3, s + i] * t_3
                )


@inlined
def _add_modes(drags: DragModes, blocks: Integers, bank: Array, load_speed: Array) -> None:
    """Add what the modes give to the speeds of the loads at the end of the step."""
    rows = drags.rows
    for four in range(drags.branches.shape[0]):
        block, d = drags.branches[four], (FOUR * four) & POSITIVE
        v_0, v_1, v_2, v_3 = 0.0, 0.0, 0.0, 0.0
        for group in range(drags.groups[four]):
            s = (blocks[block, STATE_AT] + 2 * WIDTH * group) & POSITIVE
            b = (blocks[block, BANK_AT] + N_BANK * WIDTH * group) & POSITIVE
            for i in range(2 * WIDTH):
                state = bank[b + i]
                v_0 += rows[d, s + i] * state
                v_1 += rows[d + 1, s + i] * state
                v_2 += rows[d + 2, s + i] * state
                v_3 += rows[d + 3, s + i] * state
        load_speed[d] += v_0
        load_speed[d + 1] += v_1
        load_speed[d + 2] += v_2
        load_speed[d + 3] += v_3


@inlined
def _add_input(inputs: Array, row: int, torque: float, load_speed: Array) -> None:
    """Add what one torque gives to the speeds of the loads."""
    for four in range(load_speed.shape[0] // FOUR):
        for i in range(FOUR):
            load_speed[FOUR * four + i] += inputs[row, FOUR * four + i] * torque


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _speeds(
    drags: DragModes, blocks: Integers, bank: Array, meshes: Meshes, torque: Array, by_slow: Array, first: int,
    speed: Array,
) -> None:  # fmt: skip
    """Fill the speeds at the end of the step, the drag torques staying as they are over it.

    ``by_slow`` holds from ``first`` on what the slow inputs give to the loads, which point against the motion.
    """
    n_drags = torque.shape[0]
    n_ports = (drags.inputs.shape[0] - n_drags) // 2
    for d in range(n_drags):
        speed[d] = by_slow[first + d]
    _add_modes(drags, blocks, bank, speed)
    for port in range(n_ports):
        _add_input(drags.inputs, port, torque_at(meshes, port, OLD), speed)
        _add_input(drags.inputs, n_ports + port, torque_at(meshes, port, NEW), speed)
    for d in range(n_drags):
        _add_input(drags.inputs, 2 * n_ports + d, torque[d], speed)
    for d in range(n_drags):
        speed[d] = -speed[d]


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _follow_drags(laws: DragLaws, through: Array, torque: Array, speed: Array, damping: Array) -> bool:
    """Set the drag torques to those of the speeds at hand where all places turn; return whether that does.

    It does if what the torques change of the speeds is too little for any of them.
    """
    n_drags = torque.shape[0]
    last = laws.torque.shape[1] - 1
    moved, turning = 0.0, True
    for d in range(n_drags):
        own, fast = through[d, d], abs(speed[d])
        damping[d] = 0.0
        if own != 0.0:
            place = min(fast * laws.per_step[d], last - 1e-9)
            j = max(0, min(int(place), last - 1))  # also for a run that left the finite numbers
            rise = laws.torque[d, j + 1] - laws.torque[d, j]
            value = laws.torque[d, j] + (place - j) * rise
            value = value if speed[d] > 0.0 else -value
            turning = turning and fast >= laws.creep[d]
            damping[d] = abs(rise) * laws.per_step[d]
            moved += own * abs(value - torque[d])
            torque[d] = value
    for d in range(n_drags):
        if damping[d] * moved > TOLERANCE * abs(torque[d]):
            turning = False
    return turning


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _iterate_drags(laws: DragLaws, through: Array, torque: Array, speed: Array, damping: Array) -> bool:
    """Iterate on all drag torques and their speeds; return whether they converged.

    ``through`` (n_drags, n_drags) speed of each load per torque. The drags are swept in turn; a sweep is the last if
    all that it moved cannot change a torque by more than its tolerance.
    """
    n_drags = torque.shape[0]
    for _ in range(MOST_SWEEPS):
        moved = 0.0
        for d in range(n_drags):
            own = through[d, d]
            if own == 0.0:  # no drag here
                continue
            new, damping[d] = _braked(laws, d, speed[d] + own * torque[d], own, speed[d])
            change = new - torque[d]
            torque[d] = new
            moved += own * abs(change)
            _add_input(through, d, -change, speed)
        converged = True
        for d in range(n_drags):
            if abs(damping[d]) * moved > TOLERANCE * abs(torque[d]):
                converged = False
        if converged:
            return True
    return False


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def brake(
    laws: DragLaws, drags: DragModes, blocks: Integers, bank: Array, values: Array, meshes: Meshes, by_slow: Array,
    first: int, torque: Array, work: DragWork,
) -> bool:  # fmt: skip
    """Set the drag torques at the end of a step whose mesh torques are known; return whether they converged.

    ``torque`` (n_drags,) goes from the start of the step to its end, by ``work.change``. What that changes of the
    approach within one step is left to the next for the meshes to answer.
    """
    change, speed = work.change, work.speed
    _speeds(drags, blocks, bank, meshes, torque, by_slow, first, speed)
    for d in range(torque.shape[0]):
        change[d] = -torque[d]
    converged = _follow_drags(laws, drags.each_other, torque, speed, work.damping)
    if not converged:
        for d in range(torque.shape[0]):
            torque[d] = -change[d]
        converged = _iterate_drags(laws, drags.each_other, torque, speed, work.damping)
    for d in range(torque.shape[0]):
        change[d] += torque[d]
    _move_ports(drags, change, work.outputs, values, meshes)
    return bool(converged)
