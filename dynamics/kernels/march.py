"""March of the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.propagator`` (discretised modes) and ``dynamics.mesh_force`` (packed mesh laws);
names, units and validation live above.

The modal state ``w`` (real parts, then imaginary parts) obeys ``w' = decay w + inputs tau + slow``. Outputs
at the end of a step are ``rows w + through_old tau + through_new tau_new``: of each mesh approach rate,
pinion speed and the steps of approach and pinion angle, then the speed of every slow input, then joint
rates whose squares are losses.
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
    INDIVIDUAL,
    LANES,
    LEAST_GAP,
    LOOSE,
    N_LIST,
    PER_DEPTH,
    PER_R2,
    R1,
    R2,
    PackedMeshes,
    list_by_phase,
    list_on_path,
    sliding_direction,
    sum_flank,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

N_TABLE = 10
MOST_ITERATIONS = 12
TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""


class DiscreteModes(NamedTuple):
    """Modes at one step length; see ``dynamics.propagator.discretise``.

    A modal vector is laid out in groups of LANES real parts and LANES imaginary parts, filled up with zeros.
    """

    tables: Array
    """(n_pairs, n_groups N_TABLE LANES) for every two meshes: decay (2 rows), inputs of their four torques, real
    parts and imaginary parts."""
    rows: Array
    """(n_rows, n_states) outputs per modal vector; rows filled up with zeros to a multiple of 4."""
    through_old: Array
    """(2 n_meshes, n_rows) outputs per mesh torque at the start of the step."""
    through_new: Array
    """The same at its end."""
    slow_inputs: Array
    """(n_slow, n_states)"""
    slow_old: Array
    """(n_outputs, n_slow), without filling rows."""
    slow_new: Array


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
def _slow_targets(
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
def _hold_slow(
    slow_inputs: Array, slow_old: Array, slow_new: Array, slow: Array, target: Array, substeps: int, pull: Array,
    pull_step: Array, base: Array, slope: Array,
) -> None:  # fmt: skip
    """Prepare what the slow inputs, linear over the sample, add to modes and outputs in each step."""
    pull[:] = 0.0
    pull_step[:] = 0.0
    base[:] = 0.0
    slope[:] = 0.0
    for k in range(slow.shape[0]):
        change = (target[k] - slow[k]) / substeps
        for i in range(pull.shape[0]):
            pull[i] += slow_inputs[k, i] * slow[k]
            pull_step[i] += slow_inputs[k, i] * change
        for r in range(slow_old.shape[0]):
            base[r] += slow_old[r, k] * slow[k] + slow_new[r, k] * (slow[k] + change)
            slope[r] += (slow_old[r, k] + slow_new[r, k]) * change


@njit(cache=True, fastmath=LOOSE, inline="always")
def _predict(rows: Array, x: Array, outputs: Array, wanted: int) -> None:
    """Fill the first ``wanted`` outputs at the end of the step, ``x`` holding state, torques and slow inputs."""
    for quad in range((wanted + 3) // 4):
        r = 4 * quad
        s_0 = 0.0
        s_1 = 0.0
        s_2 = 0.0
        s_3 = 0.0
        for i in range(x.shape[0]):
            s_0 += rows[r, i] * x[i]
            s_1 += rows[r + 1, i] * x[i]
            s_2 += rows[r + 2, i] * x[i]
            s_3 += rows[r + 3, i] * x[i]
        outputs[r] = s_0
        outputs[r + 1] = s_1
        outputs[r + 2] = s_2
        outputs[r + 3] = s_3


@njit(cache=True, fastmath=LOOSE, inline="always")
def _advance(tables: Array, x: Array, n_groups: int, torques: int, pull: Array, pull_step: Array) -> None:
    """Take the modal state at the head of ``x`` over one step; old mesh torques stand in ``x`` from ``torques`` on.

    The first pair of meshes lets the state decay and the slow inputs pull, further pairs add their torques.
    """
    for pair in range(tables.shape[0]):
        t_0, t_1 = x[torques + 4 * pair], x[torques + 4 * pair + 1]
        t_2, t_3 = x[torques + 4 * pair + 2], x[torques + 4 * pair + 3]
        first = 1.0 if pair == 0 else 0.0
        for group in range(n_groups):
            a = N_TABLE * LANES * group
            b = 2 * LANES * group
            for i in range(LANES):
                real, imag = x[b + i], x[b + LANES + i]
                decay_r, decay_i = tables[pair, a + i], tables[pair, a + LANES + i]
                push = pull[b + i] * first
                push += tables[pair, a + 2 * LANES + i] * t_0 + tables[pair, a + 3 * LANES + i] * t_1
                push += tables[pair, a + 4 * LANES + i] * t_2 + tables[pair, a + 5 * LANES + i] * t_3
                turn = pull[b + LANES + i] * first
                turn += tables[pair, a + 6 * LANES + i] * t_0 + tables[pair, a + 7 * LANES + i] * t_1
                turn += tables[pair, a + 8 * LANES + i] * t_2 + tables[pair, a + 9 * LANES + i] * t_3
                x[b + i] = decay_r * real - decay_i * imag + push
                x[b + LANES + i] = decay_i * real + decay_r * imag + turn
    for i in range(pull.shape[0]):
        pull[i] += pull_step[i]


@njit(cache=True, fastmath=LOOSE, inline="always")
def _react(
    values: Array, m: int, contacts: Array, size: int, found: Integers, reach: float, rate: float, omega_1: float,
    reactions: Array,
) -> None:  # fmt: skip
    """Fill row ``m`` of ``reactions``: tau_1, tau_2, their slopes over approach (2) and rate (2), net force,
    friction power, damping power, damping force of both flanks, listed in parts ``2 m`` and ``2 m + 1``."""
    r_1, r_2, damp_time = values[m, R1], values[m, R2], values[m, DAMP_TIME]
    t_1, t_2, x_1, x_2, v_1, v_2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    net, lost, damped, pull = 0.0, 0.0, 0.0, 0.0
    for side in range(2):
        if found[m, side] == 0:
            continue
        sign = 1.0 - 2.0 * side
        force, a_1, a_2, k_1, k_2, c_1, c_2, friction_power, damping_power, damping = sum_flank(
            contacts, (2 * m + side) * size, found[m, side], sign * reach - side * values[m, BACKLASH], sign * rate,
            sign * r_1 * omega_1, damp_time, values[m, PER_DEPTH],
        )  # fmt: skip
        t_1 -= sign * a_1
        t_2 += sign * a_2
        x_1 -= k_1
        x_2 += k_2
        v_1 -= c_1
        v_2 += c_2
        net += sign * force
        lost += friction_power
        damped += damping_power
        pull += sign * damping
    reactions[m, 0] = r_1 * t_1
    reactions[m, 1] = r_2 * t_2
    reactions[m, 2] = r_1 * x_1
    reactions[m, 3] = r_2 * x_2
    reactions[m, 4] = r_1 * v_1
    reactions[m, 5] = r_2 * v_2
    reactions[m, 6] = net
    reactions[m, 7] = lost
    reactions[m, 8] = damped
    reactions[m, 9] = pull


@njit(cache=True, fastmath=LOOSE, inline="always")
def _correct(reactions: Array, through: Array, m: int, tau: Array, outputs: Array) -> float:
    """Newton step on the two torques of mesh ``m``; return by how much the contact may still move them [N m].

    The correction moves the approach by the compliance of one step, a share ``gain`` of what it would need;
    what can be wrong after it (another set of contacts, another mesh) is that share of the correction.
    """
    row = 4 * m
    q = 2 * m
    x_1, x_2, v_1, v_2 = reactions[m, 2], reactions[m, 3], reactions[m, 4], reactions[m, 5]
    g_11 = x_1 * through[q, row + 2] + v_1 * through[q, row]
    g_12 = x_1 * through[q + 1, row + 2] + v_1 * through[q + 1, row]
    g_21 = x_2 * through[q, row + 2] + v_2 * through[q, row]
    g_22 = x_2 * through[q + 1, row + 2] + v_2 * through[q + 1, row]
    e_1 = reactions[m, 0] - tau[q]
    e_2 = reactions[m, 1] - tau[q + 1]
    scale = 1.0 / ((1.0 - g_11) * (1.0 - g_22) - g_12 * g_21)
    d_1 = ((1.0 - g_22) * e_1 + g_12 * e_2) * scale
    d_2 = ((1.0 - g_11) * e_2 + g_21 * e_1) * scale
    tau[q] += d_1
    tau[q + 1] += d_2
    for mesh in range(reactions.shape[0]):
        for r in range(4):
            outputs[4 * mesh + r] += through[q, 4 * mesh + r] * d_1 + through[q + 1, 4 * mesh + r] * d_2
    return float((abs(g_11) + abs(g_12) + abs(g_21) + abs(g_22)) * (abs(e_1) + abs(e_2)))


@njit(cache=True, fastmath=LOOSE)
def _account(
    work: Array, powers: Array, fresh: Array, damping: Array, slow: Array, target: Array, share: float, step: float,
    n_rows: int, outputs: Array, reactions: Array, rates: Array,
) -> None:  # fmt: skip
    """Add the work of one step to the accounts.

    Powers are integrated by trapezoids. The march lets a mesh torque vary linearly over the step, so the
    work of the damping force is its trapezoid less ``step dF dv / 12`` (the mean of a straight line times a
    smooth curve).
    """
    n_meshes, n_slow = damping.shape[0], slow.shape[0]
    first = 4 * n_meshes
    for m in range(n_meshes):
        fresh[2 * m] = reactions[m, 7]
        fresh[2 * m + 1] = reactions[m, 8]
    for k in range(n_slow):
        fresh[2 * n_meshes + k] = (slow[k] + share * (target[k] - slow[k])) * outputs[first + k]
    joints = 0.0
    for r in range(first + n_slow, n_rows):
        joints += outputs[r] * outputs[r]
    fresh[2 * n_meshes + n_slow] = joints
    for k in range(fresh.shape[0]):
        work[k] += 0.5 * step * (powers[k] + fresh[k])
        powers[k] = fresh[k]
    for m in range(n_meshes):
        change = (reactions[m, 9] - damping[m, 0]) * (rates[m] - damping[m, 1])
        work[2 * m + 1] -= step * change / 12.0
        damping[m, 0] = reactions[m, 9]
        damping[m, 1] = rates[m]


@njit(cache=True, fastmath=LOOSE)
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
    # fields once into plain names: reading them in the loop would count references
    values, counts, starts, data = meshes.values, meshes.counts, meshes.phase_starts, meshes.phase_data
    contacts_in, least = meshes.phase_counts, meshes.phase_least
    cells, shifts, deviations, scales = meshes.cells, meshes.shifts, meshes.deviations, meshes.scales
    mode_tables, through = modes.tables, modes.through_new
    state, ports, slow, powers, damping = (
        carried.state,
        carried.ports,
        carried.slow,
        carried.powers,
        carried.damping,
    )
    account = carried.work
    given, imposed = orders.given, orders.offsets

    n_meshes, n_slow, n_rows = values.shape[0], slow.shape[0], modes.slow_new.shape[0]
    first_slow = 4 * n_meshes
    most = 1
    for m in range(n_meshes):
        most = max(most, counts[m, GROUPS])
    size = most * N_LIST * LANES
    contacts = np.zeros(2 * n_meshes * size)
    found = np.zeros((n_meshes, 2), np.int64)
    no_pairs = np.empty((2, 0), np.int64)
    pull, pull_step = np.zeros(state.shape[0]), np.zeros(state.shape[0])
    base, slope = np.zeros(modes.rows.shape[0]), np.zeros(modes.rows.shape[0])
    outputs = np.zeros(modes.rows.shape[0])
    # state, old torques (of an even number of meshes), predicted torques, slow inputs: one row per output
    n_states = state.shape[0]
    n_groups = n_states // (2 * LANES)
    old_at = n_states
    new_at = old_at + 4 * mode_tables.shape[0]
    slow_at = new_at + 2 * n_meshes
    x = np.zeros(slow_at + 2)
    rows = np.zeros((modes.rows.shape[0], slow_at + 2))
    rows[:, :n_states] = modes.rows
    for q in range(2 * n_meshes):
        rows[:, old_at + q] = modes.through_old[q]
        rows[:, new_at + q] = through[q]
    x[:n_states] = state
    x[slow_at] = 1.0
    tau, target, fresh = np.zeros(2 * n_meshes), np.zeros(n_slow), np.zeros(account.shape[0])
    reactions, rates, reaches = np.zeros((n_meshes, 10)), np.zeros(n_meshes), np.zeros(n_meshes)
    offset, offset_rate = np.zeros(n_meshes), np.zeros(n_meshes)
    mean_torque = carried.memory[2]
    unsettled = 0
    at = 0
    for sample in range(given.shape[0]):
        _slow_targets(
            given[sample], orders.control, orders.drags, orders.per_drag_step, carried.memory, carried.speeds,
            mean_torque, target,
        )  # fmt: skip
        _hold_slow(
            modes.slow_inputs, modes.slow_old, modes.slow_new, slow, target, substeps, pull, pull_step, base, slope
        )  # fmt: skip
        rows[:, slow_at] = base
        rows[:, slow_at + 1] = slope
        for m in range(n_meshes):
            offset[m] = carried.offset[m]
            offset_rate[m] = (imposed[sample, m] - carried.offset[m]) / (substeps * step)
        mean_torque = 0.0
        for sub in range(substeps):
            share = (sub + 1.0) / substeps
            wanted = n_rows if account.shape[0] > 0 or sub == substeps - 1 else first_slow
            for m in range(n_meshes):
                for k in range(2):
                    x[old_at + 2 * m + k] = ports[m, k]
                    tau[2 * m + k] = 2.0 * ports[m, k] - ports[m, 2 + k]
                    x[new_at + 2 * m + k] = tau[2 * m + k]
            x[slow_at + 1] = sub
            _predict(rows, x, outputs, wanted)
            _advance(mode_tables, x, n_groups, old_at, pull, pull_step)
            settled = False
            attempt = 0
            while attempt < MOST_ITERATIONS and not settled:
                settled = True
                for m in range(n_meshes):
                    rate = outputs[4 * m] + offset_rate[m]
                    omega_1 = outputs[4 * m + 1]
                    reach = ports[m, 4] + outputs[4 * m + 2] + offset[m] + step * offset_rate[m]
                    rates[m] = rate
                    reaches[m] = reach
                    if attempt == 0:
                        theta = ports[m, 5] + outputs[4 * m + 3]
                        omega_2 = (values[m, R1] * omega_1 - rate) * values[m, PER_R2]
                        ahead = 2.0 * step * abs(rate)
                        for side in range(2):
                            sign = 1.0 - 2.0 * side
                            part = (2 * m + side) * size
                            found[m, side] = 0
                            pressed = sign * reach - side * values[m, BACKLASH] + ahead
                            if pressed <= values[m, LEAST_GAP]:
                                continue
                            if counts[m, INDIVIDUAL] != 0:
                                found[m, side] = list_on_path(
                                    values, counts, cells, shifts, deviations, scales, m, sign, theta, omega_1,
                                    omega_2, contacts, part, no_pairs,
                                )  # fmt: skip
                            else:
                                found[m, side] = list_by_phase(
                                    values, counts, starts, contacts_in, least, data, m, sign, pressed, theta,
                                    omega_1, omega_2, contacts, part,
                                )  # fmt: skip
                    _react(values, m, contacts, size, found, reach, rate, omega_1, reactions)
                    open_error = _correct(reactions, through, m, tau, outputs)
                    if open_error > TOLERANCE * abs(reactions[m, 0]) + values[m, FLOOR]:
                        settled = False
                attempt += 1
            if not settled:
                unsettled += 1
            for m in range(n_meshes):
                ports[m, 2] = ports[m, 0]
                ports[m, 3] = ports[m, 1]
                ports[m, 0] = tau[2 * m]
                ports[m, 1] = tau[2 * m + 1]
                ports[m, 4] += outputs[4 * m + 2]
                ports[m, 5] += outputs[4 * m + 3]
                offset[m] += step * offset_rate[m]
                history[m, 0, at] = reactions[m, 6]
                if history.shape[1] > 1:
                    history[m, 1, at] = reaches[m]
                    history[m, 2, at] = ports[m, 5]
                    history[m, 3, at] = rates[m]
                    history[m, 4, at] = outputs[4 * m + 1]
                    history[m, 5, at] = reactions[m, 0]
            for r in range(first_slow, wanted):
                for q in range(2 * n_meshes):
                    outputs[r] += through[q, r] * (tau[q] - x[new_at + q])
            if account.shape[0] > 0:
                _account(
                    account, powers, fresh, damping, slow, target, share, step, n_rows, outputs, reactions, rates
                )  # fmt: skip
            mean_torque += reactions[0, 6] * values[0, R1] / substeps
            at += 1
        for k in range(n_slow):
            slow[k] = target[k]
            carried.speeds[k] = outputs[first_slow + k]
            samples[sample, k] = target[k]
            samples[sample, n_slow + k] = outputs[first_slow + k]
        for m in range(n_meshes):
            carried.offset[m] = imposed[sample, m]
    state[:] = x[:n_states]
    return unsettled
