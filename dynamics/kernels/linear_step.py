"""One step of the modes of a drivetrain between its gear meshes.

Arrays come from ``dynamics.propagator``. The modes are sorted by shaft line (``branch``: lines that damping
ties together), because a port, the place where a mesh acts on its line, sees the modes of its own branch only.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, sliding_direction

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

WIDTH = 16
"""Modes beside each other in the tables: enough that the compiler makes vector instructions of a loop over them."""
N_TABLE = 6
# columns of DiscreteModes.blocks
STATE_AT, GROUPS, OCTETS, PORT_A, PORT_B, SLOT_A, SLOT_B, CLOCK_AT, TABLE_AT, ROWS_AT, IS_FIRST = range(11)
N_BLOCK = 11


class DiscreteModes(NamedTuple):
    """Modes at one step length; see ``dynamics.propagator.discretise``.

    The modal state ``w`` obeys ``w' = decay w + inputs tau + slow``. It is laid out branch by branch: groups of
    WIDTH real parts and WIDTH imaginary parts, filled up with zeros, then slots for what else the outputs of the
    branch depend on: torque of each of its ports at start and end of the step, one, steps since the last
    sample, a zero. Port ``2 m`` is the pinion of mesh ``m``, ``2 m + 1`` its wheel, port ``2 n_meshes`` stands for
    none. The outputs of port ``p`` are its speed (``2 p``) and the angle it turns in the step (``2 p + 1``).
    """

    blocks: Integers
    """(n_blocks, N_BLOCK) for every two ports of a branch: first state, groups, states with slots in eights, both
    ports, the slots of their old torques, slot of the one, first entries in ``tables`` and ``port_rows``, and
    whether it is the first block of its branch, which alone holds decay and pull (a further one: decay one)."""
    slots: Integers
    """(n_ports,) state that holds the old torque of each port; the new one stands behind it."""
    tables: Array
    """Flat, per block and group: decay, inputs of both ports, each real then imaginary, WIDTH wide."""
    port_rows: Array
    """Flat, per block: speed and turn of both ports over the states and slots of the branch, before a step; the
    part of the slow inputs is left open."""
    port_new: Array
    """(n_ports, n_outputs) outputs of the ports per mesh torque at the end of the step."""
    rows: Array
    """(n_rows, n_states) speed of every slow input, then joint rates whose squares are losses, over the states
    at the end of the step."""
    through_old: Array
    """(n_ports, n_rows) these per mesh torque at the start of the step."""
    through_new: Array
    """The same at its end."""
    slow_inputs: Array
    """(n_slow, n_states)"""
    slow_old: Array
    """(n_outputs + n_rows, n_slow)"""
    slow_new: Array


@njit(cache=True, fastmath=LOOSE)
def slow_targets(
    given: Array, control: Array, drags: Array, per_drag_step: Array, memory: Array, speeds: Array, torque: float,
    target: Array,
) -> None:  # fmt: skip
    """Fill the slow inputs at the end of a sample: controlled motor torque and twist, drags at their speed."""
    target[0] = given[0]
    if control[2] > 0.0:
        memory[3] += control[3] * (speeds[0] - memory[3])
        error = given[2] - memory[3]
        wish = given[0] + control[0] * error + memory[0]
        target[0] = min(max(wish, -control[2]), control[2])
        if target[0] == wish or error * wish < 0.0:
            memory[0] += control[1] * error
    if control[4] > 0.0:
        memory[2] += control[5] * (torque - memory[2])
        memory[4] += control[5] * (given[3] - memory[4])
        memory[1] += control[4] * (memory[4] - memory[2])
    target[1] = given[1] + memory[1]
    last = drags.shape[1] - 1
    for i in range(drags.shape[0]):
        speed = -speeds[2 + i]
        place = min(abs(speed) * per_drag_step[i], last - 1e-9)
        j = max(0, min(int(place), last - 1))
        value = drags[i, j] + (place - j) * (drags[i, j + 1] - drags[i, j])
        target[2 + i] = value * sliding_direction(speed)


@njit(cache=True, fastmath=LOOSE)
def hold_slow(
    modes: DiscreteModes, slow: Array, target: Array, substeps: int, pull: Array, pull_step: Array, base: Array,
    slope: Array,
) -> None:  # fmt: skip
    """Prepare what the slow inputs, linear over the sample, add to modes and outputs in each step."""
    pull[:] = 0.0
    pull_step[:] = 0.0
    base[:] = 0.0
    slope[:] = 0.0
    for k in range(slow.shape[0]):
        change = (target[k] - slow[k]) / substeps
        for i in range(pull.shape[0]):
            pull[i] += modes.slow_inputs[k, i] * slow[k]
            pull_step[i] += modes.slow_inputs[k, i] * change
        for r in range(base.shape[0]):
            base[r] += modes.slow_old[r, k] * slow[k] + modes.slow_new[r, k] * (slow[k] + change)
            slope[r] += (modes.slow_old[r, k] + modes.slow_new[r, k]) * change


@njit(cache=True, fastmath=LOOSE)
def put_slow(blocks: Integers, base: Array, slope: Array, rows: Array) -> None:
    """Enter into ``port_rows`` what the slow inputs add to the outputs of the ports."""
    for block in range(blocks.shape[0]):
        span = 8 * blocks[block, OCTETS]
        at = blocks[block, ROWS_AT] + blocks[block, CLOCK_AT] - blocks[block, STATE_AT]
        for side in range(2):
            port = blocks[block, PORT_A + side]
            for k in range(2):
                known = 2 * port + k < base.shape[0]
                rows[at + (2 * side + k) * span] = base[2 * port + k] if known else 0.0
                rows[at + (2 * side + k) * span + 1] = slope[2 * port + k] if known else 0.0


@njit(cache=True, fastmath=LOOSE, inline="always")
def predict_ports(blocks: Integers, rows: Array, state: Array, sub: int, outputs: Array) -> None:
    """Fill ``outputs`` with speed and turn of every port; states and slots stand at the start of the step."""
    for block in range(blocks.shape[0]):
        n = 8 * (blocks[block, OCTETS] & POSITIVE)
        first = blocks[block, STATE_AT] & POSITIVE
        at = blocks[block, ROWS_AT] & POSITIVE
        state[blocks[block, CLOCK_AT]] = 1.0
        state[blocks[block, CLOCK_AT] + 1] = sub
        s_0 = 0.0
        s_1 = 0.0
        s_2 = 0.0
        s_3 = 0.0
        for i in range(n):
            w = state[first + i]
            s_0 += rows[at + i] * w
            s_1 += rows[at + n + i] * w
            s_2 += rows[at + 2 * n + i] * w
            s_3 += rows[at + 3 * n + i] * w
        a = blocks[block, PORT_A] & POSITIVE
        b = blocks[block, PORT_B] & POSITIVE
        outputs[2 * b] = s_2
        outputs[2 * b + 1] = s_3
        outputs[2 * a] = s_0
        outputs[2 * a + 1] = s_1


@njit(cache=True, fastmath=LOOSE, inline="always")
def advance_modes(
    blocks: Integers, tables: Array, state: Array, pull: Array, pull_step: Array, sub: int
) -> None:
    """Take the modal state over one step, port torques at its start in their slots."""
    for block in range(blocks.shape[0]):
        t_a = state[blocks[block, SLOT_A]]
        t_b = state[blocks[block, SLOT_B]]
        once = float(blocks[block, IS_FIRST])
        more = once * sub
        first = blocks[block, STATE_AT] & POSITIVE
        table = blocks[block, TABLE_AT] & POSITIVE
        for group in range(blocks[block, GROUPS]):
            s = first + 2 * WIDTH * group
            t = table + N_TABLE * WIDTH * group
            for i in range(WIDTH):
                real, imag = state[s + i], state[s + WIDTH + i]
                decay_r, decay_i = tables[t + i], tables[t + WIDTH + i]
                push = once * pull[s + i] + more * pull_step[s + i]
                push += tables[t + 2 * WIDTH + i] * t_a + tables[t + 4 * WIDTH + i] * t_b
                turn = once * pull[s + WIDTH + i] + more * pull_step[s + WIDTH + i]
                turn += tables[t + 3 * WIDTH + i] * t_a + tables[t + 5 * WIDTH + i] * t_b
                state[s + i] = decay_r * real - decay_i * imag + push
                state[s + WIDTH + i] = decay_i * real + decay_r * imag + turn


@njit(cache=True, fastmath=LOOSE)
def end_rows(
    modes: DiscreteModes, state: Array, tau_old: Array, tau: Array, base: Array, slope: Array, sub: int, values: Array
) -> None:  # fmt: skip
    """Fill the outputs that are no port's at the end of a step, ``state`` standing there."""
    first = base.shape[0] - values.shape[0]
    for r in range(values.shape[0]):
        total = base[first + r] + sub * slope[first + r]
        for i in range(state.shape[0]):
            total += modes.rows[r, i] * state[i]
        for p in range(modes.through_old.shape[0]):
            total += modes.through_old[p, r] * tau_old[p] + modes.through_new[p, r] * tau[p]
        values[r] = total
