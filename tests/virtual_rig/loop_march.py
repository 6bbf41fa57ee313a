"""March of the loop through time: exact flow of the linear circuit, kicked by the tooth pairs (numba).

One step is the free motion of the damped modes over dt, exact, and an impulse of all contacts between: a symmetric
splitting, of second order at the kicks. Contacts see their path position from the mean rotation.
"""

import numpy as np
from numba import njit

PINION, WHEEL = 0, 1
# numbers of one mesh
RATE, PITCH, START, STEP, OFFSET, DAMP, MU, ARM_1, ARM_2, HERTZ, DEEP, BACK_GAP, BACK_STIFF, N_NUMBERS = (
    range(14)
)


@njit(cache=True, fastmath=True)
def pairs_at(place, m, numbers, tables):
    """First and last pair of mesh ``m`` that stand within the tables.

    place : path run through since zero angle, growing [m]; pair p stands at place - p pitch (front flank), or mirrored
    """
    pitch, start = numbers[m, PITCH], numbers[m, START]
    reach = (tables.shape[1] - 1) * numbers[m, STEP]
    if numbers[m, RATE] > 0.0:
        return int(np.ceil((place - start - reach) / pitch)), int(np.floor((place - start) / pitch))
    return int(np.ceil((start - place) / pitch)), int(np.floor((start + reach - place) / pitch))


@njit(cache=True, fastmath=True)
def pair_at(p, place, m, numbers, tables, tooth_gap, tooth_scale, tooth_slope, counts, shift):
    """Pair ``p``: path position, place in the tables (whole, fraction), stiffness of all slices, gap of its teeth."""
    pitch, start, step = numbers[m, PITCH], numbers[m, START], numbers[m, STEP]
    n_path = tables.shape[1]
    forward = numbers[m, RATE] > 0.0
    s = place - p * pitch if forward else place + p * pitch
    at = (s - start) / step
    i = min(int(at), n_path - 2)
    f = at - i
    one = p % counts[m, 0]
    # the back of a tooth meets the tooth of the wheel that comes after the one in front of it
    two = (p + shift[m] if forward else p + shift[m] + 1) % counts[m, 1]
    k = (1.0 - f) * tables[m, i] + f * tables[m, i + 1]
    k *= tooth_scale[m, 0, one] * tooth_scale[m, 1, two]
    run = 2.0 * at / (n_path - 1) - 1.0
    own = tooth_gap[m, 0, one] + tooth_gap[m, 1, two]
    own -= 0.5 * run * (tooth_slope[m, 0, one] - tooth_slope[m, 1, two])
    return s, i, f, k, own


@njit(cache=True, fastmath=True)
def pair_force(x, v, place, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift):
    """Normal force of mesh ``m`` [N] and the sums of force times friction arm on pinion and wheel [N m].

    x, v : approach and its rate with all deviations that belong to the rotation [m], [m/s]
    place : path run through since zero angle, growing [m]
    """
    n_slices = gaps.shape[1]
    force = 0.0
    torque_1 = 0.0
    torque_2 = 0.0
    first, last = pairs_at(place, m, numbers, tables)
    for p in range(first, last + 1):
        s, i, f, k, own = pair_at(
            p, place, m, numbers, tables, tooth_gap, tooth_scale, tooth_slope, counts, shift
        )
        k /= n_slices
        pair = 0.0
        for j in range(n_slices):
            depth = x - own - (1.0 - f) * gaps[m, j, i] - f * gaps[m, j, i + 1]
            if depth > 0.0:
                harder = 1.0 + numbers[m, HERTZ] * (depth - numbers[m, DEEP]) / (depth + numbers[m, DEEP])
                soft = depth / (depth + 1e-6)
                push = k * harder * (depth + numbers[m, DAMP] * soft * v)
                if push > 0.0:
                    pair += push
        if pair > 0.0:
            force += pair
            slide = s / (abs(s) + 2e-4)
            torque_1 += pair * slide * (numbers[m, ARM_1] + s)
            torque_2 += pair * slide * (numbers[m, ARM_2] - s)
    behind = -x - numbers[m, BACK_GAP]
    if behind > 0.0:
        force -= numbers[m, BACK_STIFF] * behind
    return force, torque_1 * numbers[m, MU], torque_2 * numbers[m, MU]


@njit(cache=True, fastmath=True)
def pair_energy(x, place, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift):
    """Elastic energy [J] of the working flanks of mesh ``m``: integral of `pair_force` over the approach at rest."""
    n_slices = gaps.shape[1]
    hertz, deep = numbers[m, HERTZ], numbers[m, DEEP]
    energy = 0.0
    first, last = pairs_at(place, m, numbers, tables)
    for p in range(first, last + 1):
        _, i, f, k, own = pair_at(
            p, place, m, numbers, tables, tooth_gap, tooth_scale, tooth_slope, counts, shift
        )
        for j in range(n_slices):
            depth = x - own - (1.0 - f) * gaps[m, j, i] - f * gaps[m, j, i + 1]
            if depth > 0.0:
                square = 0.5 * depth * depth
                harder = square - 2.0 * deep * depth + 2.0 * deep * deep * np.log1p(depth / deep)
                energy += k / n_slices * (square + hertz * harder)
    return energy


@njit(cache=True)
def taken_up(approach, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift):
    """Energy (n_cycle,) [J] that the pairs take up as the gears turn by a step round each sample, the approach held.

    approach (n_cycle,): with all deviations that belong to the rotation [m]
    """
    found = np.zeros(approach.shape[0])
    for n in range(approach.shape[0]):
        place = numbers[m, OFFSET] + numbers[m, RATE] * n
        for way in (-1.0, 1.0):
            found[n] += way * pair_energy(
                approach[n],
                place + 0.5 * way * numbers[m, RATE],
                m,
                numbers,
                tables,
                gaps,
                tooth_gap,
                tooth_scale,
                tooth_slope,
                counts,
                shift,
            )
    return found


@njit(cache=True, fastmath=True)
def march(
    n_steps, first_step, dt, state, rho, flow, read_x, read_v, kick, rho_x, rho_kick, still, outer, outer_rate,
    preload, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift, record,
):  # fmt: skip
    """March ``n_steps`` from the periodic sample ``first_step``; state (n_modes) and rho (2,) are changed.

    flow (n_modes,) complex: exp(lambda dt); read_x, read_v (n_meshes, n_modes) complex
    kick (3 n_meshes, n_modes) complex: answer to a unit impulse of normal force, friction on pinion, on wheel
    rho : relative turning of the two lines and its rate; rho_x (n_meshes,), rho_kick (3 n_meshes,)
    still (n_meshes,): approach in the static state; outer, outer_rate (n_meshes, n_cycle): what rotation imposes
    preload (3 n_meshes,): forces of the static state
    record (4 n_meshes, n_cycle): forces, then the approach of every mesh; written when not empty
    """
    n_meshes, n_cycle = outer.shape
    n_modes = state.shape[0]
    forces = np.zeros(3 * n_meshes)
    writing = record.shape[1] > 0
    worst = 0.0
    for step in range(n_steps):
        n = (first_step + step) % n_cycle
        turns = first_step + step
        for m in range(n_meshes):
            x = still[m] + rho_x[m] * rho[0] + outer[m, n]
            v = rho_x[m] * rho[1] + outer_rate[m, n]
            for k in range(n_modes):
                x += read_x[m, k].real * state[k].real - read_x[m, k].imag * state[k].imag
                v += read_v[m, k].real * state[k].real - read_v[m, k].imag * state[k].imag
            place = numbers[m, OFFSET] + numbers[m, RATE] * turns
            force, on_1, on_2 = pair_force(
                x, v, place, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift
            )
            forces[3 * m] = force
            forces[3 * m + 1] = on_1
            forces[3 * m + 2] = on_2
            worst = max(worst, abs(x))
            if writing:
                record[3 * n_meshes + m, n] = x
        if writing:
            for i in range(3 * n_meshes):
                record[i, n] = forces[i]
        for k in range(n_modes):
            change = 0.0 + 0.0j
            for i in range(3 * n_meshes):
                change += kick[i, k] * (forces[i] - preload[i])
            state[k] = flow[k] * (state[k] + dt * change)
        for i in range(3 * n_meshes):
            rho[1] += dt * rho_kick[i] * (forces[i] - preload[i])
        rho[0] += dt * rho[1]
        if not worst < 1e-2:
            return worst
    return worst


@njit(cache=True)
def mean_approach(
    target, n_phases, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift
):
    """Means over one base pitch under a constant force: approach [m], stiffness [N/m], friction torques [N m]."""
    total = 0.0
    slope = 0.0
    on_1 = 0.0
    on_2 = 0.0
    way = 1.0 if numbers[m, RATE] > 0.0 else -1.0
    for n in range(n_phases):
        place = numbers[m, OFFSET] + way * numbers[m, PITCH] * n / n_phases
        low, high = -1e-4, 5e-4
        for _ in range(45):
            middle = 0.5 * (low + high)
            force = pair_force(
                middle,
                0.0,
                place,
                m,
                numbers,
                tables,
                gaps,
                tooth_gap,
                tooth_scale,
                tooth_slope,
                counts,
                shift,
            )[0]
            if force > target:
                high = middle
            else:
                low = middle
        total += low
        _, rub_1, rub_2 = pair_force(
            low, 0.0, place, m, numbers, tables, gaps, tooth_gap, tooth_scale, tooth_slope, counts, shift
        )
        on_1 += rub_1
        on_2 += rub_2
        up = pair_force(
            low + 2e-8,
            0.0,
            place,
            m,
            numbers,
            tables,
            gaps,
            tooth_gap,
            tooth_scale,
            tooth_slope,
            counts,
            shift,
        )[0]
        down = pair_force(
            low - 2e-8,
            0.0,
            place,
            m,
            numbers,
            tables,
            gaps,
            tooth_gap,
            tooth_scale,
            tooth_slope,
            counts,
            shift,
        )[0]
        slope += (up - down) / 4e-8
    return total / n_phases, slope / n_phases, on_1 / n_phases, on_2 / n_phases
