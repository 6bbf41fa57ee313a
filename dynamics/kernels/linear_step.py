"""One step of the modes of a drivetrain between its gear meshes.

Arrays come from ``dynamics.vibration.propagator``. The modes are sorted by shaft line (``branch``: lines that damping
ties together), because a port, the place where a mesh acts on its line, sees the modes of its own branch only.
One pass over the modes gives the outputs of two ports and takes the modes over the step.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.integrator_state import NEW, OLD, Meshes, move_port, torque_at
from dynamics.kernels.modal_step import N_BANK, WIDTH, advance_modes

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

FOUR = 4
"""Drag torques in a group, for the same reason."""
# columns of DiscreteModes.blocks
STATE_AT, BANK_AT, HOME_AT, GROUPS, PORT_A, PORT_B, THROUGH_AT = range(7)
# columns of DiscreteModes.links
TO_A, TO_B, FROM_C, FROM_D, LINK_AT = range(5)
# first entry of the outputs per torque at the start and at the end of the step, in a link of DiscreteModes.through
AT_START, AT_END = 0, 8


class DragModes(NamedTuple):
    """How drag torques act on modes, ports and each other in one step, in the layout of ``DiscreteModes``.

    Drag torques of one branch come in groups of FOUR, the last group filled up with zeros.
    """

    branches: Integers
    """(n_drags / 4,) row of ``DiscreteModes.blocks`` with the modes of each four."""
    groups: Integers
    """(n_drags / 4,) first groups of these modes that each four acts on; the others do without drag."""
    push: Array
    """(n_drags, n_states) state after the step per drag torque at its start."""
    rows: Array
    """(n_drags, n_states) speed of the load of each drag over the states at the end of the step."""
    inputs: Array
    """(2 n_ports + n_drags, n_drags) speed of the load of each drag (second) per mesh torque at the start of the step,
    at its end, and per drag torque that stays over the step."""
    each_other: Array
    """(n_drags, n_drags) speed of the load of a drag (second) per drag torque (first) at the end of the step."""
    ports_held: Array
    """(n_drags, 2 n_ports) outputs of the ports per drag torque that stays over the step."""
    ports_new: Array
    """The same per drag torque at the end of the step."""


class DiscreteModes(NamedTuple):
    """Modes at one step length and number of steps per sample; see ``dynamics.vibration.propagator.discretise``.

    The modal state ``w`` leaves out what follows the torques of the ports at once, so that ``w' = decay w + inputs
    tau`` in each step, ``tau`` being these torques at its start; what the slow inputs give is added once per sample,
    and to the outputs in each step. Per branch the state holds groups of WIDTH real parts and WIDTH imaginary parts,
    filled up with zeros. Port ``2 m`` is the pinion of mesh ``m``, ``2 m + 1`` its wheel, port ``2 n_meshes`` stands
    for none. The outputs of port ``p`` are its speed (``2 p``) and the angle it turns in the step (``2 p + 1``). Blocks
    and links name a port by its number.
    """

    blocks: Integers
    """(n_branches, 7) for two ports of every branch: first state, first entry in the bank, the same of the block that
    holds the state, groups, both ports, first entry in ``through`` of what their own torques give."""
    further: Integers
    """(n, 7) the other ports of branches with more than two."""
    bank: Array
    """Flat, per block and group: N_BANK rows; the rows of the state are filled by a time integration."""
    links: Integers
    """(n_links, 5) two ports, two ports of the same branch that act on them, first entry in ``through``; ports that
    act on themselves first, in the order of ``blocks``."""
    through: Array
    """Flat, per link: outputs (4) per torque (2) at the start of the step, then at its end."""
    port_new: Array
    """(n_ports, n_outputs) outputs of the ports per mesh torque at the end of the step."""
    rows: Array
    """(n_rows, n_states) speed of every slow input and drag, joint rates whose squares are losses, then what skew
    stiffness takes, over the states at the end of the step."""
    circulating: int
    """Number of the last of these rows, in fours: a', b, b', a of a power a' b - b' a."""
    through_old: Array
    """(n_ports + n_drags, n_rows) these per mesh and drag torque at the start of the step."""
    through_new: Array
    """The same at its end."""
    slow_outputs: Array
    """(2 n_slow, substeps * (n_outputs + n_rows)) what each slow input gives in every step of a sample, per value
    at its start, then per change in a step."""
    slow_states: Array
    """(2 n_slow, n_states) the same for the state at the end of the sample."""
    drags: DragModes


@njit(cache=True, fastmath=LOOSE)
def slow_targets(
    given: Array, control: Array, controller: Array, speed: float, torque: float, target: Array
) -> None:
    """Fill the slow inputs at the end of a sample: controlled motor torque and twist, then what is given."""
    target[0] = given[0]
    if control[2] > 0.0:
        controller[3] += control[3] * (speed - controller[3])
        error = given[2] - controller[3]
        wish = given[0] + control[0] * error + controller[0]
        target[0] = min(max(wish, -control[2]), control[2])
        if target[0] == wish or error * wish < 0.0:
            controller[0] += control[1] * error
    if control[5] > 0.0:
        controller[2] += control[5] * (torque - controller[2])
        controller[4] += control[5] * (given[3] - controller[4])
        controller[1] += control[4] * (controller[4] - controller[2])
    target[1] = given[1] + controller[1]
    for k in range(2, target.shape[0]):
        target[k] = given[2 + k]


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def hold_slow(responses: Array, slow: Array, target: Array, substeps: int, total: Array) -> None:
    """Add to ``total`` (n,) what the slow inputs, linear over the sample, give by ``responses`` (2 n_slow, n)."""
    n = total.shape[0]
    for k in range(slow.shape[0]):
        change = (target[k] - slow[k]) / substeps
        for i in range(n):
            total[i] += responses[2 * k, i] * slow[k] + responses[2 * k + 1, i] * change


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def put_state(blocks: Integers, state: Array, bank: Array) -> None:
    """Enter the modal state into the bank."""
    for block in range(blocks.shape[0]):
        for group in range(blocks[block, GROUPS]):
            s = (blocks[block, STATE_AT] + 2 * WIDTH * group) & POSITIVE
            b = (blocks[block, BANK_AT] + N_BANK * WIDTH * group) & POSITIVE
            for i in range(2 * WIDTH):
                bank[b + i] = state[s + i]


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def take_state(blocks: Integers, bank: Array, state: Array) -> None:
    """Copy the modal state out of the bank."""
    for block in range(blocks.shape[0]):
        for group in range(blocks[block, GROUPS]):
            s = (blocks[block, STATE_AT] + 2 * WIDTH * group) & POSITIVE
            b = (blocks[block, BANK_AT] + N_BANK * WIDTH * group) & POSITIVE
            for i in range(2 * WIDTH):
                state[s + i] = bank[b + i]


@inlined
def _given(through: Array, t: int, c: float, d: float) -> tuple[float, float, float, float]:
    """Return speed and turn of two ports that two torques give by a link."""
    return (
        through[t] * c + through[t + 1] * d,
        through[t + 2] * c + through[t + 3] * d,
        through[t + 4] * c + through[t + 5] * d,
        through[t + 6] * c + through[t + 7] * d,
    )


@inlined
def add_torques(links: Integers, first: int, through: Array, part: int, meshes: Meshes, kind: int) -> None:
    """Add to speeds and turns what the torques of a ``kind`` give by the links from ``first`` on.

    ``part`` says when in the step they act.
    """
    for link in range(first, links.shape[0]):
        c = torque_at(meshes, links[link, FROM_C], kind)
        d = torque_at(meshes, links[link, FROM_D], kind)
        speed_a, turn_a, speed_b, turn_b = _given(through, (links[link, LINK_AT] & POSITIVE) + part, c, d)
        move_port(meshes, links[link, TO_B], speed_b, turn_b)
        move_port(meshes, links[link, TO_A], speed_a, turn_a)


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _look(further: Integers, block: int, bank: Array, meshes: Meshes) -> None:
    """Add the modes' part of the outputs of further ports."""
    number_a, number_b = further[block, PORT_A], further[block, PORT_B]
    mesh_a, mesh_b = meshes[(number_a >> 1) & POSITIVE], meshes[(number_b >> 1) & POSITIVE]
    a = mesh_a.wheel if number_a & 1 else mesh_a.pinion
    b = mesh_b.wheel if number_b & 1 else mesh_b.pinion
    for group in range(further[block, GROUPS]):
        home = further[block, HOME_AT] + N_BANK * WIDTH * group
        g = further[block, BANK_AT] + N_BANK * WIDTH * group
        for i in range(WIDTH):
            real, imag = bank[home + i], bank[home + WIDTH + i]
            row_a, row_b = g + 8 * WIDTH + i, g + 12 * WIDTH + i
            a.speed += bank[row_a] * real + bank[row_a + WIDTH] * imag
            b.speed += bank[row_b] * real + bank[row_b + WIDTH] * imag
            row_a, row_b = row_a + 2 * WIDTH, row_b + 2 * WIDTH
            a.turn += bank[row_a] * real + bank[row_a + WIDTH] * imag
            b.turn += bank[row_b] * real + bank[row_b + WIDTH] * imag


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _push(further: Integers, block: int, bank: Array, meshes: Meshes) -> None:
    """Add the torques of further ports to the state after the step."""
    t_a = torque_at(meshes, further[block, PORT_A], OLD)
    t_b = torque_at(meshes, further[block, PORT_B], OLD)
    for group in range(further[block, GROUPS]):
        home = further[block, HOME_AT] + N_BANK * WIDTH * group
        g = further[block, BANK_AT] + N_BANK * WIDTH * group
        for i in range(2 * WIDTH):
            bank[home + i] += bank[g + 4 * WIDTH + i] * t_a + bank[g + 6 * WIDTH + i] * t_b


@inlined
def step_modes(
    blocks: Integers, further: Integers, links: Integers, bank: Array, through: Array, meshes: Meshes
) -> None:
    """Add to speeds and turns what modes and torques give and take the modes over the step.

    Ports beyond the first two of a branch look at its modes before and push them after that pass.
    """
    for block in range(further.shape[0]):
        _look(further, block, bank, meshes)
    # what the torques give is known before the modes are: nothing waits for its sums
    for block in range(blocks.shape[0]):
        a, b = blocks[block, PORT_A] & POSITIVE, blocks[block, PORT_B] & POSITIVE
        t = blocks[block, THROUGH_AT] & POSITIVE
        now = _given(through, t + AT_END, torque_at(meshes, a, NEW), torque_at(meshes, b, NEW))
        start = _given(through, t + AT_START, torque_at(meshes, a, OLD), torque_at(meshes, b, OLD))
        move_port(meshes, b, now[2] + start[2], now[3] + start[3])
        move_port(meshes, a, now[0] + start[0], now[1] + start[1])
    for block in range(blocks.shape[0]):
        a, b = blocks[block, PORT_A] & POSITIVE, blocks[block, PORT_B] & POSITIVE
        first = blocks[block, BANK_AT] & POSITIVE
        speed_a, turn_a, speed_b, turn_b = advance_modes(
            bank, first, blocks[block, GROUPS], torque_at(meshes, a, OLD), torque_at(meshes, b, OLD)
        )
        move_port(meshes, b, speed_b, turn_b)
        move_port(meshes, a, speed_a, turn_a)
    for block in range(further.shape[0]):
        _push(further, block, bank, meshes)
    if links.shape[0] > blocks.shape[0]:
        add_torques(links, blocks.shape[0], through, AT_START, meshes, OLD)
        add_torques(links, blocks.shape[0], through, AT_END, meshes, NEW)


@njit(cache=True, fastmath=LOOSE)
def end_rows(
    modes: DiscreteModes, state: Array, torques: Array, slow: Array, first: int, values: Array
) -> None:
    """Fill the outputs that are no port's at the end of a step, ``state`` standing there.

    ``torques`` (2, n_ports + n_drags) at start and end of the step; ``slow`` holds from ``first`` on what the slow
    inputs give.
    """
    for r in range(values.shape[0]):
        total = slow[first + r]
        for i in range(state.shape[0]):
            total += modes.rows[r, i] * state[i]
        for p in range(torques.shape[1]):
            total += modes.through_old[p, r] * torques[0, p] + modes.through_new[p, r] * torques[1, p]
        values[r] = total
