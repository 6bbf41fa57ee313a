"""March of the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.propagator`` (discretised modes) and ``dynamics.mesh_force`` (packed mesh laws); names,
units and validation live above.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import (
    BACKLASH,
    CAPACITY,
    DAMP_TIME,
    LEAST_GAP,
    LOOSE,
    N_LIST,
    R1,
    R2,
    Tables,
    list_contacts,
    sliding_direction,
    sum_flank,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@njit(cache=True, fastmath=LOOSE)
def _flanks(
    values: Array,
    counts: Integers,
    contacts: Array,
    filled: Integers,
    reach: float,
    rate: float,
    omega_1: float,
) -> tuple[float, float, float, float, float, float, float, float, float]:
    """Sum both listed flanks of one mesh.

    Returns (tau_1, tau_2, d tau_1/dx, d tau_2/dx, d tau_1/dv, d tau_2/dv, front - back force, friction power,
    damping power).
    """
    damp_time = values[DAMP_TIME]
    tau_1, tau_2, x_1, x_2, v_1, v_2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    net, friction_power, damping_power = 0.0, 0.0, 0.0
    for side in range(2):
        if filled[side] == 0:
            continue
        sign = 1.0 - 2.0 * side
        force, a_1, a_2, k_1, k_2, k_d, lost, damped = sum_flank(
            contacts[side],
            0,
            filled[side],
            sign * reach - side * values[BACKLASH],
            sign * rate,
            sign * values[R1] * omega_1,
            damp_time,
        )
        tau_1 -= sign * a_1
        tau_2 += sign * a_2
        x_1 -= k_1 + k_d
        x_2 += k_2
        v_1 -= k_1
        v_2 += k_2
        net += sign * force
        friction_power += lost
        damping_power += damped
    r_1 = values[R1]
    r_2 = values[R2]
    return (
        r_1 * tau_1, r_2 * tau_2, r_1 * x_1, r_2 * x_2, r_1 * damp_time * v_1, r_2 * damp_time * v_2,
        net, friction_power, damping_power,
    )  # fmt: skip


@njit(cache=True, fastmath=LOOSE)
def _dot(row: Array, state: Array) -> float:
    total = 0.0
    for i in range(state.shape[0]):
        total += row[i] * state[i]
    return total


@njit(cache=True, fastmath=LOOSE)
def _slow_inputs(
    given: Array,
    speeds: Array,
    control: Array,
    memory: Array,
    drags: Array,
    per_drag_step: Array,
    torque: float,
    target: Array,
) -> None:
    """Fill ``target`` with the slow inputs at the end of a sample: motor, bracing, drags (order of ``loads``).

    ``given``: (3 + n) commanded motor torque, bracing, speed and asked torque; ``control``: (proportional, integral
    share per sample, torque limit, bracing gain, averaging share); ``memory``: (integral, bracing, mean torque).
    """
    if control[2] > 0.0:
        error = given[2] - speeds[0]
        wish = given[0] + control[0] * error + memory[0]
        target[0] = min(max(wish, -control[2]), control[2])
        if target[0] == wish or error * wish < 0.0:
            memory[0] += control[1] * error
    else:
        target[0] = given[0]
    if control[3] > 0.0:
        memory[2] += control[4] * (torque - memory[2])
        memory[1] += control[3] * (given[3] - memory[2])
    target[1] = given[1] + memory[1]
    last = drags.shape[1] - 1
    for i in range(drags.shape[0]):
        speed = -speeds[2 + i]
        place = min(abs(speed) * per_drag_step[i], last - 1e-9)
        j = int(place)
        value = drags[i, j] + (place - j) * (drags[i, j + 1] - drags[i, j])
        target[2 + i] = value * sliding_direction(speed)


@njit(cache=True, fastmath=LOOSE)
def march(
    values: Array, counts: Integers, tables: Tables, floor: Array, decay: Array, inputs: Array, rows: Array,
    through_old: Array, through_new: Array, slow_inputs: Array, slow_old: Array, slow_new: Array, step: float,
    substeps: int, given: Array, offsets: Array, control: Array, drags: Array, per_drag_step: Array,
    state: Array, ports: Array, slow: Array, offset: Array, memory: Array, powers: Array, work: Array,
    history: Array, samples: Array,
) -> int:  # fmt: skip
    """March the modal state over ``len(given)`` samples of ``substeps`` steps; returns the unsettled steps.

    The modal state ``w`` (real parts, then imaginary parts) obeys ``w' = decay w + inputs tau + slow``, the
    outputs at the end of a step are ``rows w + through_old tau + through_new tau_new``: of each mesh approach
    rate, pinion speed and the steps of approach and pinion angle, then the speed of every slow input, then the
    joint rates whose squares are losses. ``ports`` (n_meshes, 6): tau_1, tau_2, both one step earlier,
    approach, pinion angle. ``work``: friction, damping of each mesh, work of each slow input, joint loss;
    ``powers`` the same at the last step. ``state, ports, slow, offset, memory, powers, work`` are carried on.
    ``history`` (n_meshes, 1 or 6, steps): front - back force [, approach, pinion angle, approach rate, pinion
    speed, tau_1]; ``samples`` (n_samples, 2 n_slow): slow inputs, then their speeds.
    """
    n_meshes = values.shape[0]
    n_inputs = 2 * n_meshes
    n_slow = slow.shape[0]
    n_rows = rows.shape[0]
    n_modes = decay.shape[1]
    first_slow = 4 * n_meshes
    n_kept = history.shape[1]
    capacity = 1
    for m in range(n_meshes):
        capacity = max(capacity, counts[m, CAPACITY])
    contacts = np.zeros((n_meshes, 2, N_LIST, capacity))
    filled = np.zeros((n_meshes, 2), np.int64)
    no_pairs = np.empty((2, 0), np.int64)
    outputs = np.zeros(n_rows)
    base = np.zeros(n_rows)
    slope = np.zeros(n_rows)
    pull = np.zeros(2 * n_modes)
    pull_step = np.zeros(2 * n_modes)
    tau = np.zeros(n_inputs)
    tau_old = np.zeros(n_inputs)
    target = np.zeros(n_slow)
    speeds = np.zeros(n_slow)
    fresh = np.zeros(powers.shape[0])
    unsettled = 0
    at = 0
    mean_torque = 0.0
    for k in range(n_slow):
        speeds[k] = powers[powers.shape[0] - n_slow + k]
    n_power = powers.shape[0] - n_slow
    for sample in range(given.shape[0]):
        _slow_inputs(given[sample], speeds, control, memory, drags, per_drag_step, mean_torque, target)
        for i in range(2 * n_modes):
            pull[i] = 0.0
            pull_step[i] = 0.0
        for k in range(n_slow):
            change = (target[k] - slow[k]) / substeps
            for i in range(2 * n_modes):
                pull[i] += slow_inputs[k, i] * slow[k]
                pull_step[i] += slow_inputs[k, i] * change
        for r in range(n_rows):
            base[r] = 0.0
            slope[r] = 0.0
            for k in range(n_slow):
                change = (target[k] - slow[k]) / substeps
                base[r] += slow_old[r, k] * slow[k] + slow_new[r, k] * (slow[k] + change)
                slope[r] += (slow_old[r, k] + slow_new[r, k]) * change
        mean_torque = 0.0
        for sub in range(substeps):
            share = (sub + 1.0) / substeps
            for m in range(n_meshes):
                tau_old[2 * m] = ports[m, 0]
                tau_old[2 * m + 1] = ports[m, 1]
                tau[2 * m] = 2.0 * ports[m, 0] - ports[m, 2]
                tau[2 * m + 1] = 2.0 * ports[m, 1] - ports[m, 3]
            wanted = n_rows if n_power > 0 or sub == substeps - 1 else first_slow
            for r in range(wanted):
                total = base[r] + sub * slope[r] + _dot(rows[r], state)
                for k in range(n_inputs):
                    total += through_old[r, k] * tau_old[k]
                outputs[r] = total
            for i in range(n_modes):
                real = decay[0, i] * state[i] - decay[1, i] * state[n_modes + i] + pull[i]
                imag = decay[1, i] * state[i] + decay[0, i] * state[n_modes + i] + pull[n_modes + i]
                state[i] = real
                state[n_modes + i] = imag
                pull[i] += pull_step[i]
                pull[n_modes + i] += pull_step[n_modes + i]
            for m in range(n_meshes):
                first = tau_old[2 * m]
                second = tau_old[2 * m + 1]
                for i in range(2 * n_modes):
                    state[i] += inputs[2 * m, i] * first + inputs[2 * m + 1, i] * second
            settled = False
            for attempt in range(12):
                worst = 0.0
                for m in range(n_meshes):
                    row = 4 * m
                    rate = outputs[row] + (offsets[sample, m] - offset[m]) / (substeps * step)
                    omega_1 = outputs[row + 1]
                    x = ports[m, 4] + outputs[row + 2]
                    for k in range(n_inputs):
                        rate += through_new[row, k] * tau[k]
                        omega_1 += through_new[row + 1, k] * tau[k]
                        x += through_new[row + 2, k] * tau[k]
                    reach = x + offset[m] + share * (offsets[sample, m] - offset[m])
                    if attempt == 0:
                        theta = ports[m, 5] + outputs[row + 3]
                        for k in range(n_inputs):
                            theta += through_new[row + 3, k] * tau[k]
                        omega_2 = (values[m, R1] * omega_1 - rate) / values[m, R2]
                        margin = values[m, LEAST_GAP] - 2.0 * step * abs(rate)
                        for side in range(2):
                            sign = 1.0 - 2.0 * side
                            filled[m, side] = 0
                            if sign * reach - side * values[m, BACKLASH] > margin:
                                filled[m, side] = list_contacts(
                                    values[m], counts[m], tables, sign, theta, omega_1, omega_2, 0,
                                    contacts[m, side], no_pairs,
                                )  # fmt: skip
                    t_1, t_2, x_1, x_2, v_1, v_2, net, lost, damped = _flanks(
                        values[m], counts[m], contacts[m], filled[m], reach, rate, omega_1
                    )
                    # Newton on the two torques of this mesh, the other meshes follow by iteration
                    q = 2 * m
                    a = 1.0 - x_1 * through_new[row + 2, q] - v_1 * through_new[row, q]
                    b = -x_1 * through_new[row + 2, q + 1] - v_1 * through_new[row, q + 1]
                    c = -x_2 * through_new[row + 2, q] - v_2 * through_new[row, q]
                    d = 1.0 - x_2 * through_new[row + 2, q + 1] - v_2 * through_new[row, q + 1]
                    e_1 = t_1 - tau[q]
                    e_2 = t_2 - tau[q + 1]
                    determinant = 1.0 / (a * d - b * c)
                    tau[q] += (d * e_1 - b * e_2) * determinant
                    tau[q + 1] += (a * e_2 - c * e_1) * determinant
                    worst = max(worst, abs(e_1) - 1e-9 * abs(t_1) - floor[m])
                    history[m, 0, at] = net
                    if n_kept > 1:
                        history[m, 1, at] = reach
                        history[m, 3, at] = rate
                        history[m, 4, at] = omega_1
                        history[m, 5, at] = t_1
                    fresh[2 * m] = lost
                    fresh[2 * m + 1] = damped
                if worst <= 0.0:
                    settled = True
                    break
            if not settled:
                unsettled += 1
            for m in range(n_meshes):
                x = outputs[4 * m + 2]
                theta = outputs[4 * m + 3]
                for k in range(n_inputs):
                    x += through_new[4 * m + 2, k] * tau[k]
                    theta += through_new[4 * m + 3, k] * tau[k]
                ports[m, 2] = tau_old[2 * m]
                ports[m, 3] = tau_old[2 * m + 1]
                ports[m, 0] = tau[2 * m]
                ports[m, 1] = tau[2 * m + 1]
                ports[m, 4] += x
                ports[m, 5] += theta
                if n_kept > 1:
                    history[m, 2, at] = ports[m, 5]
            mean_torque += history[0, 0, at] * values[0, R1] / substeps
            for r in range(first_slow, wanted):
                for k in range(n_inputs):
                    outputs[r] += through_new[r, k] * tau[k]
            if n_power > 0:
                joint = 0.0
                for r in range(first_slow + n_slow, n_rows):
                    joint += outputs[r] * outputs[r]
                for k in range(n_slow):
                    applied = slow[k] + share * (target[k] - slow[k])
                    fresh[n_inputs + k] = applied * outputs[first_slow + k]
                fresh[n_inputs + n_slow] = joint
                for k in range(n_power):
                    work[k] += 0.5 * step * (powers[k] + fresh[k])
                    powers[k] = fresh[k]
            at += 1
        for k in range(n_slow):
            slow[k] = target[k]
            speeds[k] = outputs[first_slow + k]
            powers[n_power + k] = speeds[k]
            samples[sample, k] = slow[k]
            samples[sample, n_slow + k] = speeds[k]
        for m in range(n_meshes):
            offset[m] = offsets[sample, m]
    return unsettled
