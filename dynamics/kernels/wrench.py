"""Tooth forces beside the ports of the meshes in the time integration: friction and the other flank.

The ports of a mesh carry the torques of its gears with a lateral force along the normal of the flanks that carry. What
these torques have beyond the normal force, and what the other flanks press, acts on rows of its own
(``dynamics.rotor.linear_system``): two rows of friction in every step, the slide of the flanks while the others
touch. They change smoothly and move the ports little: for the modes they are linear over an interval of a few steps,
from the mean of the steps before; for the ports they stay.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.contact_table import V_BACKLASH, V_FRICTION, V_R1, V_R2
from dynamics.kernels.integrator_state import NEW, OLD, Meshes, torque_at
from dynamics.kernels.linear_step import BANK_AT, FOUR, GROUPS, STATE_AT
from dynamics.kernels.modal_step import N_BANK, WIDTH, dot_modes, push_modes

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

# columns of WrenchModes.pieces
PIECE_FOUR, PIECE_BLOCK, PIECE_FIRST, PIECE_GROUPS, PIECE_AT = range(5)
# columns of WrenchModes.numbers
SIDE, PATH_1, PATH_2, SPREAD, ACROSS = range(5)


class WrenchModes(NamedTuple):
    """How tooth forces beside the ports act in an interval of steps, in the layout of ``linear_step.DiscreteModes``.

    The n friction rows, two a mesh, are filled up with zeros to groups of FOUR. Forces stand in one flat array: on the
    friction rows (n,), then on the slide of every mesh. No rows where gears only rotate.
    """

    pieces: Integers
    """(n_pieces, 5) four of the rows, row of ``DiscreteModes.blocks``, first group of modes that it moves, groups,
    place in ``push``."""
    push: Array
    """Flat, per piece and group (FOUR, 2 WIDTH): state after the interval per force on a friction row at its start."""
    slide_push: Array
    """(n_meshes, n_states) the same of slides, for all modes."""
    held: Array
    """(n + n_meshes, every 2 n_ports) outputs of the ports in each step of an interval per force that stays."""
    rows: Array
    """Flat (5 n_meshes, n_states) over the states at the end of the step: speeds on the friction rows, two a mesh, on
    the slides; the slides themselves, and turns of the pinions from the centre line beyond those of their ports."""
    by_torque: Array
    """(2, n_ports, 5 n_meshes) the same per mesh torque at the start and at the end of the step."""
    by_force: Array
    """(n + n_meshes, 5 n_meshes) per force that stays over the step."""
    numbers: Array
    """(n_meshes, 5) ``MeshWrench.numbers``."""
    n_rows: int
    """n"""
    every: int
    """Steps in an interval."""


@inlined
def give_to_ports(wrench: WrenchModes, forces: Array, outputs: Array) -> None:
    """Fill ``outputs`` (every 2 n_ports,): what the forces give to the ports in each step of the interval."""
    held, size = wrench.held, outputs.shape[0]
    f_0, f_1, f_2, f_3 = forces[0], forces[1], forces[2], forces[3]
    for k in range(size):
        outputs[k] = held[0, k] * f_0 + held[1, k] * f_1 + held[2, k] * f_2 + held[3, k] * f_3
    for d in range(FOUR, forces.shape[0]):
        force = forces[d]
        if force != 0.0:
            for k in range(size):
                outputs[k] += held[d, k] * force


@inlined
def forces_on_ports(outputs: Array, part: int, n_meshes: int, meshes: Meshes) -> None:
    """Add to speeds and turns of the ports what was filled for one step of the interval."""
    for m in range(n_meshes):
        mesh, out = meshes[m & POSITIVE], (4 * (part * n_meshes + m)) & POSITIVE
        mesh.pinion.speed += outputs[out]
        mesh.pinion.turn += outputs[out + 1]
        mesh.wheel.speed += outputs[out + 2]
        mesh.wheel.turn += outputs[out + 3]


@inlined
def push_forces(wrench: WrenchModes, blocks: Integers, forces: Array, bank: Array) -> None:
    """Add to the state after the step what the forces at its start give."""
    pieces = wrench.pieces
    for piece in range(pieces.shape[0]):
        block, d = pieces[piece, PIECE_BLOCK], (FOUR * pieces[piece, PIECE_FOUR]) & POSITIVE
        f_0, f_1, f_2, f_3 = forces[d], forces[d + 1], forces[d + 2], forces[d + 3]
        b = (blocks[block, BANK_AT] + N_BANK * WIDTH * pieces[piece, PIECE_FIRST]) & POSITIVE
        push_modes(
            bank, b, wrench.push, pieces[piece, PIECE_AT], pieces[piece, PIECE_GROUPS], f_0, f_1, f_2, f_3
        )
    n = wrench.n_rows
    for m in range(wrench.numbers.shape[0]):
        if forces[n + m] != 0.0:
            _push_slide(wrench.slide_push, blocks, m, forces[n + m], bank)


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _push_slide(push: Array, blocks: Integers, m: int, force: float, bank: Array) -> None:
    """Do the same for the slide of a mesh whose other flanks touch."""
    for block in range(blocks.shape[0]):
        for group in range(blocks[block, GROUPS]):
            s = (blocks[block, STATE_AT] + 2 * WIDTH * group) & POSITIVE
            b = (blocks[block, BANK_AT] + N_BANK * WIDTH * group) & POSITIVE
            for i in range(2 * WIDTH):
                bank[b + i] += push[m, s + i] * force


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def wrench_motion(
    wrench: WrenchModes, blocks: Integers, bank: Array, meshes: Meshes, forces: Array, row: int
) -> float:
    """Return what a row of ``WrenchModes.rows`` sees at the end of the step, without what slow inputs gave since the
    start of the sample."""
    total = 0.0
    n_states = wrench.slide_push.shape[1]
    for block in range(blocks.shape[0]):
        first = blocks[block, BANK_AT] & POSITIVE
        at = (row * n_states + blocks[block, STATE_AT]) & POSITIVE
        total += dot_modes(bank, first, wrench.rows, at, blocks[block, GROUPS])
    for port in range(wrench.by_torque.shape[1]):
        total += wrench.by_torque[0, port, row] * torque_at(meshes, port, OLD)
        total += wrench.by_torque[1, port, row] * torque_at(meshes, port, NEW)
    for d in range(forces.shape[0]):
        total += wrench.by_force[d, row] * forces[d]
    return float(total)


@inlined
def gather_forces(wrench: WrenchModes, values: Array, meshes: Meshes, mean: Array) -> None:
    """Add the forces at the end of a step, whose mesh torques are known, to those of the interval."""
    numbers, n = wrench.numbers, wrench.n_rows
    for m in range(numbers.shape[0]):
        mesh = meshes[m & POSITIVE]
        path, normal = mesh.path_torque, mesh.filtered
        mean[2 * m] += mesh.pinion.torque + values[m, V_R1] * normal + numbers[m, PATH_1] * path
        mean[2 * m + 1] += mesh.wheel.torque - values[m, V_R2] * normal + numbers[m, PATH_2] * path
        mean[n + m] += numbers[m, SPREAD] * mesh.other_force + numbers[m, ACROSS] * mesh.other_friction


@inlined
def set_forces(wrench: WrenchModes, forces: Array, mean: Array) -> None:
    """Set the forces at the end of an interval to the mean over its steps."""
    share = 1.0 / wrench.every
    for d in range(forces.shape[0]):
        forces[d], mean[d] = share * mean[d], 0.0


@inlined
def set_sides(wrench: WrenchModes, meshes: Meshes) -> None:
    """Say which flanks are the others."""
    for m in range(wrench.numbers.shape[0]):
        mesh = meshes[m & POSITIVE]
        front = wrench.numbers[m, SIDE] < 0.0
        mesh.other_front, mesh.other_back = (1.0, 0.0) if front else (0.0, 1.0)


@inlined
def part_flanks(
    wrench: WrenchModes, values: Array, blocks: Integers, bank: Array, meshes: Meshes, forces: Array, step: float,
    last: bool,
) -> None:  # fmt: skip
    """Set by how much the gears stand closer on the other flanks than on those that carry, at the end of the next
    step: in every step while these touch, at the ``last`` step of a sample where they are no farther apart than half
    the backlash."""
    n_meshes = wrench.numbers.shape[0]
    for m in range(n_meshes):
        mesh = meshes[m & POSITIVE]
        touches = mesh.other_force > 0.0
        side, backlash = wrench.numbers[m, SIDE], values[m, V_BACKLASH]
        reach = mesh.apart - side * mesh.teeth - (backlash if side > 0.0 else 0.0)
        if touches or (last and reach > -0.5 * backlash):
            per_slide, rate = -wrench.numbers[m, SPREAD], 0.0
            place = per_slide * wrench_motion(wrench, blocks, bank, meshes, forces, 3 * n_meshes + m)
            if touches:
                rate = per_slide * wrench_motion(wrench, blocks, bank, meshes, forces, 2 * n_meshes + m)
            mesh.apart, mesh.apart_rate = place + step * rate, rate


@inlined
def lean_pinions(
    wrench: WrenchModes, blocks: Integers, bank: Array, meshes: Meshes, forces: Array, steps: int
) -> None:
    """Set by how much the pinions turn from the centre line beyond their ports, and how it goes on as in the last
    ``steps``; these turns give the place of a flank on its path."""
    n_meshes = wrench.numbers.shape[0]
    for m in range(n_meshes):
        mesh = meshes[m & POSITIVE]
        now = wrench_motion(wrench, blocks, bank, meshes, forces, 4 * n_meshes + m)
        # the rate that was taken led from the last turn to that which stands
        before = mesh.lean - steps * mesh.lean_rate
        mesh.lean, mesh.lean_rate = now, (now - before) / steps


@inlined
def rubbed_beside(
    wrench: WrenchModes, values: Array, blocks: Integers, bank: Array, meshes: Meshes, forces: Array, m: int
) -> float:
    """Return what friction of a mesh takes on its rows beside the ports [W]."""
    n_meshes = wrench.numbers.shape[0]
    if values[m, V_FRICTION] == 0.0:
        return 0.0
    mesh = meshes[m & POSITIVE]
    torque_1 = mesh.pinion.torque + values[m, V_R1] * mesh.filtered - mesh.path_torque
    torque_2 = mesh.wheel.torque - values[m, V_R2] * mesh.filtered
    across = wrench.numbers[m, ACROSS] * mesh.other_friction
    power = torque_1 * wrench_motion(wrench, blocks, bank, meshes, forces, 2 * m)
    power += torque_2 * wrench_motion(wrench, blocks, bank, meshes, forces, 2 * m + 1)
    if across != 0.0:
        power += across * wrench_motion(wrench, blocks, bank, meshes, forces, 2 * n_meshes + m)
    return float(-power)
