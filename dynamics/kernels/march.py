"""March of the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.propagator`` (discretised modes) and ``dynamics.mesh_force`` (packed mesh laws);
names, units and validation live above.

A step guesses the mesh torques (straight on from the last two), lists the contacts at the angles this guess
leads to, and takes a Newton step with these contacts held (``mesh_solve``). Only where its remainder is too
large, or a kink of the mesh force lies within the correction, are the contacts summed again.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    BACKLASH,
    DAMP_TIME,
    FLOOR,
    GROUPS,
    LANES,
    LEAST_GAP,
    LOOSE,
    N_LIST,
    PER_DEPTH,
    R1,
    R2,
    PackedMeshes,
    flank_powers,
    list_flank,
)
from dynamics.kernels.linear_step import (
    DiscreteModes,
    advance_modes,
    end_rows,
    hold_slow,
    predict_ports,
    put_slow,
    slow_targets,
)
from dynamics.kernels.mesh_solve import (
    ANGLE,
    APPROACH,
    GIVE_V,
    GIVE_X,
    GUARD,
    LEAST_GUARD,
    N_MOTION,
    N_REACTION,
    NET,
    OFFSET,
    OFFSET_RATE,
    RATE,
    REACH,
    correct,
    invert,
    left_open,
    reach_and_rate,
    react,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ITERATIONS = 12
TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


class Orders(NamedTuple):
    """What a march is told, values at the end of each sample."""

    given: Array
    """(n_samples, 4) motor torque, twist, speed of the drive, torque of the first mesh."""
    offsets: Array
    """(n_samples, n_meshes) imposed approach."""
    control: Array
    """Proportional gain, integral gain per sample, torque limit (0: no control), share of the averaged speed;
    bracing gain per sample (0: no control), share of the averaged torque."""
    drags: Array
    """(n_drags, n_table) drag torque over speed."""
    per_drag_step: Array


class Carried(NamedTuple):
    """What a march carries on; every array is written."""

    state: Array
    """(n_states,) modal state."""
    ports: Array
    """(n_meshes, 6) tau_1, tau_2, both one step earlier, approach, pinion angle."""
    slow: Array
    """(n_slow,) motor torque, twist, drags."""
    offset: Array
    """(n_meshes,) imposed approach."""
    memory: Array
    """Integral of the speed controller, correction of the twist, then averages: torque, speed, asked torque."""
    speeds: Array
    """(n_slow,) speed of every slow input."""
    powers: Array
    """Last powers: friction and damping of each mesh, every slow input, joints; empty without accounts."""
    work: Array
    """Their integrals."""
    damping: Array
    """(n_meshes, 2) last damping force and approach rate."""


@njit(cache=True, fastmath=LOOSE)
def _account(
    carried: Carried, values: Array, contacts: Array, size: int, found: Integers, motion: Array,
    outputs: Array, ends: Array, fresh: Array, target: Array, share: float, step: float,
) -> None:  # fmt: skip
    """Add the work of one step to the accounts.

    Powers are integrated by trapezoids. The march lets a mesh torque vary linearly over the step, so the
    work of the damping force is its trapezoid less ``step dF dv / 12`` (the mean of a straight line times a
    smooth curve).
    """
    work, powers, damping, slow = carried.work, carried.powers, carried.damping, carried.slow
    n_meshes, n_slow = damping.shape[0], slow.shape[0]
    for m in range(n_meshes):
        lost, damped, pull = 0.0, 0.0, 0.0
        for side in range(2):
            if found[m, side] > 0:
                sign = 1.0 - 2.0 * side
                sliding, damping_power, force = flank_powers(
                    contacts, (2 * m + side) * size, found[m, side],
                    sign * motion[m, REACH] - side * values[m, BACKLASH], sign * motion[m, RATE],
                    sign * values[m, R1] * outputs[4 * m], values[m, DAMP_TIME], values[m, PER_DEPTH],
                )  # fmt: skip
                lost += sliding
                damped += damping_power
                pull += sign * force
        fresh[2 * m] = lost
        fresh[2 * m + 1] = damped
        work[2 * m + 1] -= step * (pull - damping[m, 0]) * (motion[m, RATE] - damping[m, 1]) / 12.0
        damping[m, 0] = pull
        damping[m, 1] = motion[m, RATE]
    for k in range(n_slow):
        fresh[2 * n_meshes + k] = (slow[k] + share * (target[k] - slow[k])) * ends[k]
    joints = 0.0
    for r in range(n_slow, ends.shape[0]):
        joints += ends[r] * ends[r]
    fresh[2 * n_meshes + n_slow] = joints
    for k in range(fresh.shape[0]):
        work[k] += 0.5 * step * (powers[k] + fresh[k])
        powers[k] = fresh[k]


class Workspace(NamedTuple):
    """Arrays a march writes into and forgets."""

    contacts: Array
    """Listed contacts of both flanks of every mesh."""
    found: Integers
    """(n_meshes, 2) how many."""
    no_pairs: Integers
    pulls: Array
    """(2, n_states) what slow inputs add to the modes in a step, and its change per step."""
    slow_outputs: Array
    """(2, n_outputs + n_rows) the same for the outputs."""
    outputs: Array
    """(n_outputs + 2,) speed and turn of every port; the last two belong to no port."""
    ends: Array
    """(n_rows,) the other outputs."""
    torques: Array
    """(3, n_ports + 1) torques of the ports: two steps back, one step back, now; the last stays zero."""
    motion: Array
    """(n_meshes, N_MOTION)"""
    reactions: Array
    """(n_meshes, N_REACTION)"""
    target: Array
    """(n_slow,) slow inputs at the end of the sample."""
    port_rows: Array
    """Those of the modes with the part of the slow inputs."""
    fresh: Array
    """Powers at the end of the step."""


def march(
    meshes: PackedMeshes, modes: DiscreteModes, orders: Orders, carried: Carried, step: float, substeps: int,
    history: Array, samples: Array,
) -> int:  # fmt: skip
    """March over ``len(orders.given)`` samples of ``substeps`` steps; return the number of unsettled steps.

    Each step: outputs and modal state for the old mesh torques; contacts listed at the predicted angles;
    Newton on the new torques with these contacts held; accounts. ``history`` (n_meshes, 1 or 6, steps):
    front - back force [, approach, pinion angle, approach rate, pinion speed, tau_1]; ``samples``
    (n_samples, 2 n_slow): slow inputs, then their speeds.
    """
    n_meshes, n_slow = len(meshes.values), len(carried.slow)
    n_states, n_rows = len(carried.state), len(modes.rows)
    size = int(max(1, meshes.counts[:, GROUPS].max())) * N_LIST * LANES
    work = Workspace(
        contacts=np.zeros(2 * n_meshes * size),
        found=np.zeros((n_meshes, 2), np.int64),
        no_pairs=np.empty((2, 0), np.int64),
        pulls=np.zeros((2, n_states)),
        slow_outputs=np.zeros((2, 4 * n_meshes + n_rows)),
        outputs=np.zeros(4 * n_meshes + 2),
        ends=np.zeros(n_rows),
        torques=np.zeros((3, 2 * n_meshes + 1)),
        motion=np.zeros((n_meshes, N_MOTION)),
        reactions=np.zeros((n_meshes, N_REACTION)),
        target=np.zeros(n_slow),
        port_rows=modes.port_rows.copy(),
        fresh=np.zeros(len(carried.work)),
    )
    return int(_march(meshes, modes, orders, carried, work, step, substeps, history, samples))


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _march(
    meshes: PackedMeshes, modes: DiscreteModes, orders: Orders, carried: Carried, work: Workspace, step: float,
    substeps: int, history: Array, samples: Array,
) -> int:  # fmt: skip
    """Do what ``march`` says. No array is made here, so that none has to be counted in the loop (``_nrt``)."""
    values, counts, starts, data = meshes.values, meshes.counts, meshes.phase_starts, meshes.phase_data
    contacts_in, least = meshes.phase_counts, meshes.phase_least
    cells, shifts, deviations, scales = meshes.cells, meshes.shifts, meshes.deviations, meshes.scales
    blocks, tables, slots = modes.blocks, modes.tables, modes.slots
    port_new = modes.port_new
    state, ports, slow = carried.state, carried.ports, carried.slow
    given, imposed = orders.given, orders.offsets
    keeps_accounts = carried.work.shape[0] > 0
    contacts, found, no_pairs, outputs, ends = (
        work.contacts,
        work.found,
        work.no_pairs,
        work.outputs,
        work.ends,
    )
    pull, pull_step, base, slope = work.pulls[0], work.pulls[1], work.slow_outputs[0], work.slow_outputs[1]
    tau_older, tau_old, tau = work.torques[0], work.torques[1], work.torques[2]
    motion, reactions, target, port_rows = work.motion, work.reactions, work.target, work.port_rows

    n_meshes, n_slow = values.shape[0], slow.shape[0]
    n_ports = 2 * n_meshes
    size = contacts.shape[0] // n_ports
    for m in range(n_meshes):
        p, q = 2 * m, 2 * m + 1
        tau_old[p], tau_old[q] = ports[m, 0], ports[m, 1]
        tau_older[p], tau_older[q] = ports[m, 2], ports[m, 3]
        motion[m, APPROACH], motion[m, ANGLE] = ports[m, 4], ports[m, 5]
        motion[m, GUARD] = LEAST_GUARD
        for port, k in ((p, 0), (q, 1)):
            given_1, given_2 = port_new[port, 2 * p : 2 * p + 2], port_new[port, 2 * q : 2 * q + 2]
            motion[m, GIVE_V + k] = values[m, R1] * given_1[0] - values[m, R2] * given_2[0]
            motion[m, GIVE_X + k] = values[m, R1] * given_1[1] - values[m, R2] * given_2[1]
    mean_torque = carried.memory[2]
    torque_share = values[0, R1] / substeps
    unsettled = 0
    at = 0
    for sample in range(given.shape[0]):
        slow_targets(
            given[sample], orders.control, orders.drags, orders.per_drag_step, carried.memory, carried.speeds,
            mean_torque, target,
        )  # fmt: skip
        hold_slow(modes, slow, target, substeps, pull, pull_step, base, slope)
        put_slow(blocks, base, slope, port_rows)
        for m in range(n_meshes):
            motion[m, OFFSET] = carried.offset[m]
            motion[m, OFFSET_RATE] = (imposed[sample, m] - carried.offset[m]) / (substeps * step)
        mean_torque = 0.0
        for sub in range(substeps):
            for port in range(n_ports):
                tau[port] = 2.0 * tau_old[port] - tau_older[port]
                state[slots[port]] = tau_old[port]
                state[slots[port] + 1] = tau[port]
            predict_ports(blocks, port_rows, state, sub, outputs)
            advance_modes(blocks, tables, state, pull, pull_step, sub)
            settled = False
            attempt = 0
            while attempt < MOST_ITERATIONS and not settled:
                for m in range(n_meshes):
                    reach, rate = reach_and_rate(values, motion, outputs, step, m)
                    motion[m, REACH], motion[m, RATE] = reach, rate
                    if attempt == 0:
                        theta = motion[m, ANGLE] + outputs[4 * m + 1]
                        ahead = 2.0 * step * abs(rate)
                        for side in range(2):
                            sign = 1.0 - 2.0 * side
                            pressed = sign * reach - side * values[m, BACKLASH] + ahead
                            found[m, side] = 0
                            if pressed > values[m, LEAST_GAP]:
                                found[m, side] = list_flank(
                                    values, counts, starts, contacts_in, least, data, cells, shifts, deviations,
                                    scales, m, sign, pressed, theta, outputs[4 * m], outputs[4 * m + 2], contacts,
                                    (2 * m + side) * size, no_pairs,
                                )  # fmt: skip
                    react(
                        values,
                        m,
                        contacts,
                        size,
                        found,
                        reach,
                        rate,
                        outputs[4 * m],
                        motion[m, GUARD],
                        reactions,
                    )
                    invert(reactions, motion, m)
                sweep = 0
                off = True
                while off and sweep < MOST_SWEEPS:
                    off = False
                    for m in range(n_meshes):
                        reach, rate = reach_and_rate(values, motion, outputs, step, m)
                        error = correct(reactions, motion, port_new, reach, rate, m, tau, outputs)
                        if n_meshes > 1 and error > TOLERANCE * abs(tau[2 * m]) + values[m, FLOOR]:
                            off = True
                    sweep += 1
                settled = not off
                for m in range(n_meshes):
                    reach, rate = reach_and_rate(values, motion, outputs, step, m)
                    left = left_open(reactions, motion, reach, rate, values[m, R1], values[m, DAMP_TIME], m)
                    if left > TOLERANCE * abs(tau[2 * m]) + values[m, FLOOR]:
                        settled = False
                attempt += 1
            if not settled:
                unsettled += 1
            for m in range(n_meshes):
                reach, rate = reach_and_rate(values, motion, outputs, step, m)
                motion[m, REACH], motion[m, RATE] = reach, rate
                motion[m, OFFSET] += step * motion[m, OFFSET_RATE]
                motion[m, APPROACH] = reach - motion[m, OFFSET]
                motion[m, ANGLE] += outputs[4 * m + 1]
                history[m, 0, at] = reactions[m, NET]
                if history.shape[1] > 1:
                    history[m, 1, at] = reach
                    history[m, 2, at] = motion[m, ANGLE]
                    history[m, 3, at] = rate
                    history[m, 4, at] = outputs[4 * m]
                    history[m, 5, at] = tau[2 * m]
            if keeps_accounts or sub == substeps - 1:
                end_rows(modes, state, tau_old, tau, base, slope, sub, ends)
            if keeps_accounts:
                share = (sub + 1.0) / substeps
                _account(
                    carried, values, contacts, size, found, motion, outputs, ends, work.fresh, target, share, step
                )  # fmt: skip
            for port in range(n_ports):
                tau_older[port] = tau_old[port]
                tau_old[port] = tau[port]
            mean_torque += reactions[0, NET] * torque_share
            at += 1
        for k in range(n_slow):
            slow[k] = target[k]
            carried.speeds[k] = ends[k]
            samples[sample, k] = target[k]
            samples[sample, n_slow + k] = ends[k]
        for m in range(n_meshes):
            carried.offset[m] = imposed[sample, m]
    for m in range(n_meshes):
        ports[m, 0], ports[m, 1] = tau_old[2 * m], tau_old[2 * m + 1]
        ports[m, 2], ports[m, 3] = tau_older[2 * m], tau_older[2 * m + 1]
        ports[m, 4], ports[m, 5] = motion[m, APPROACH], motion[m, ANGLE]
    return unsettled
