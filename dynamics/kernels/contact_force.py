"""Contact forces of a flank at its place on the path, from the rows of ``kernels.table_lookup``."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.kernels.contact import POSITIVE, inlined, sliding_direction
from dynamics.kernels.contact_table import (
    N_ROW,
    R_CLOSING,
    R_CURVES,
    R_FRICTION,
    R_GAIN,
    R_GAP_CURVE,
    R_GAP_SLOPE,
    R_MOMENT,
    R_SLOPES,
    R_START,
    V_CLOSING,
    V_DAMP_TIME,
    V_DERIVATIVE,
    V_HALF_PITCH,
    V_MU_1,
    V_MU_2,
    V_PER_REVERSAL,
    V_R1,
    V_R2,
    V_REVERSAL,
    V_ROLL_1,
    V_ROLL_2,
    V_SPUR,
)

Array = NDArray[np.float64]


class Pressing(NamedTuple):
    """How the gears press a flank, seen from this flank."""

    sign: float
    """+1 in front, -1 on the back."""
    reach: float
    """Approach of the teeth less the play [m]."""
    rate: float
    """Rate of the approach of the gears [m/s]."""
    beside: float
    """Path position less that of the rows, a small part of a cell [m]."""
    advance: float
    """By how much sliding reverses further along the path than without vibration [m]."""
    omega_1: float
    """Speeds of pinion and wheel [rad/s]."""
    omega_2: float


class Sums(NamedTuple):
    """What the contacts of a flank do together at one path position."""

    force: float
    """Normal force with damping [N]."""
    elastic: float
    """Without [N]."""
    a_1: float
    """Torque on the pinion per base radius [N]."""
    a_2: float
    force_x: float
    """Derivatives over the approach of the teeth; that of the elastic force second."""
    stiffness: float
    a_1_x: float
    a_2_x: float
    force_v: float
    """Derivatives over the rate."""
    a_1_v: float
    a_2_v: float
    friction_1: float
    """Part of a_1 by friction [N]; that of a_2 is a_2 less the force."""
    damped: float
    """Part of a_1 by dampers on the slope of the gap [N]."""
    energy: float
    """Elastic energy [J]."""
    recorded: float
    """Force of the law at full resolution, with damping [N]."""
    curvature: float
    """Half the second derivative of the elastic force over the approach [N/m^2]."""
    force_xv: float
    """Mixed second derivative of the force over approach and rate [N s/m^2]."""
    moment: float
    """Tilting moment, 0 on tables without tilt [N m]."""


@inlined
def reversal_per_speed(values: Array, m: int, both: float) -> float:
    """Return how far the reversal moves per speed of sliding at the sum of both speeds [s]; 0 about standstill."""
    least = 1e-3 / (values[m, V_HALF_PITCH] * values[m, V_PER_REVERSAL])
    return 1.0 / both if abs(both) > least else 0.0


@inlined
def advance_of(values: Array, m: int, omega_1: float, omega_2: float, per_speed: float) -> float:
    """Return by how much sliding reverses further along the path than without vibration, half a pitch at most [m]."""
    ahead = (values[m, V_ROLL_2] * omega_2 - values[m, V_ROLL_1] * omega_1) * per_speed
    ahead = ahead - values[m, V_REVERSAL] if per_speed != 0.0 else 0.0
    most = values[m, V_HALF_PITCH]
    ahead = ahead if ahead < most else most
    return ahead if ahead > -most else -most


@inlined
def contact_force(rows: Array, first: int, n: int, values: Array, m: int, pressing: Pressing) -> Sums:
    """Sum the rows of a flank at an approach and a rate.

    Force of a pair ``N = max(0, F + c h v)``, clipped by its damper alone; a_1 = N + dW/ds and friction, a_2 = N and
    friction.
    """
    sign, reach, rate, beside = pressing.sign, pressing.reach, pressing.rate, pressing.beside
    damp_time, derivative = values[m, V_DAMP_TIME], values[m, V_DERIVATIVE]
    mu_1 = sign * values[m, V_MU_1]
    mu_2 = sign * values[m, V_MU_2]
    total, elastic, a_1, a_2 = 0.0, 0.0, 0.0, 0.0
    force_x, stiffness, a_1_x, a_2_x = 0.0, 0.0, 0.0, 0.0
    force_v, a_1_v, a_2_v = 0.0, 0.0, 0.0
    friction_1, damped, energy, recorded = 0.0, 0.0, 0.0, 0.0
    curvature, force_xv = 0.0, 0.0
    tilting = 0.0
    for p in range(n):
        r = (first + N_ROW * p) & POSITIVE
        d = reach - rows[r + R_START]
        f_1, f_2 = rows[r + 2], rows[r + 3]
        s, c = r + R_SLOPES, r + R_CURVES
        k = f_1 + 2.0 * d * f_2
        slope = rows[r + R_GAP_SLOPE]
        per_path = rows[s + 1] + d * (rows[s + 2] + d * rows[s + 3])
        along_x = per_path - k * slope
        force = rows[r + 1] + d * (f_1 + d * f_2)
        own = force + beside * along_x
        along = rows[s] + d * (rows[s + 1] + d * (0.5 * rows[s + 2] + d * rows[s + 3] / 3.0)) - force * slope
        bent = rows[c] + d * (rows[c + 1] + d * (0.5 * rows[c + 2] + d * rows[c + 3] / 3.0))
        along += beside * (bent - slope * (per_path + along_x) - force * rows[r + R_GAP_CURVE])
        weight_x = damp_time * rows[r + 5]
        weight = damp_time * rows[r + 4] + d * weight_x
        weight = weight if weight > 0.0 else 0.0
        damping, damping_x, turned, turned_x, turned_v = weight * rate, weight_x * rate, 0.0, 0.0, 0.0
        if values[m, V_CLOSING] > 0.0:
            q = r + R_CLOSING
            weight_x = rows[q + 3]
            weight = rows[q + 2] + d * weight_x
            damping = rows[q] + d * rows[q + 1] + weight * rate
            damping_x = rows[q + 1] + weight_x * rate
            turned_v = rows[q + 6] + d * rows[q + 7]
            turned = rows[q + 4] + d * rows[q + 5] + turned_v * rate
            turned_x = rows[q + 5] + rows[q + 7] * rate
        normal, normal_x, normal_v = own + damping, k + damping_x, weight
        if normal < 0.0 and damping < 0.0:
            # the damper takes no more than the elastic force; a trace of pull is the potential's
            part = own / damping if own > 0.0 else 0.0
            turned, turned_x, turned_v = -part * turned, 0.0, 0.0
            normal = own if own < 0.0 else 0.0
            normal_x, normal_v = k if own < 0.0 else 0.0, 0.0
        q, g = r + R_FRICTION, r + R_GAIN
        lever_1_x = mu_1 * (rows[q + 1] + pressing.advance * rows[g + 1])
        lever_2_x = mu_2 * (rows[q + 3] + pressing.advance * rows[g + 3])
        lever_1 = mu_1 * (rows[q] + pressing.advance * rows[g]) + d * lever_1_x
        lever_2 = mu_2 * (rows[q + 2] + pressing.advance * rows[g + 2]) + d * lever_2_x
        if values[m, V_SPUR] > 0.0:
            roll_1, roll_2 = values[m, V_ROLL_1] + rows[q], values[m, V_ROLL_2] - rows[q]
            sliding = pressing.omega_1 * roll_1 - pressing.omega_2 * roll_2
            direction = sliding_direction(sliding * values[m, V_PER_REVERSAL])
            lever_1, lever_2 = mu_1 * direction * roll_1, mu_2 * direction * roll_2
            lever_1_x, lever_2_x = 0.0, 0.0
        total += normal
        elastic += own
        stiffness += k
        force_x += normal_x
        force_v += normal_v
        a_1 += normal * (1.0 + lever_1) + derivative * along + turned
        a_2 += normal * (1.0 + lever_2)
        a_1_x += normal_x * (1.0 + lever_1) + normal * lever_1_x + derivative * along_x + turned_x
        a_2_x += normal_x * (1.0 + lever_2) + normal * lever_2_x
        a_1_v += normal_v * (1.0 + lever_1) + turned_v
        a_2_v += normal_v * (1.0 + lever_2)
        friction_1 += normal * lever_1
        damped += turned
        full = normal + rows[r + 6] + d * rows[r + 7]
        recorded += full if full > 0.0 else 0.0
        curvature += f_2
        force_xv += weight_x
        energy += rows[r] + d * (rows[r + 1] + d * (0.5 * f_1 + d * f_2 / 3.0))
        t = r + R_MOMENT
        tilting += rows[t] + d * (rows[t + 1] + d * (0.5 * rows[t + 2] + d * rows[t + 3] / 3.0))
    return Sums(
        total, elastic, a_1, a_2, force_x, stiffness, a_1_x, a_2_x, force_v, a_1_v, a_2_v, friction_1, damped, energy,
        recorded, curvature, force_xv, tilting,
    )  # fmt: skip


@inlined
def powers(
    sums: Sums, values: Array, m: int, pressing: Pressing, omega_1: float, omega_2: float
) -> tuple[float, float]:
    """Return friction and damping power of one flank."""
    lever_2 = values[m, V_R2] * (sums.a_2 - sums.force)
    friction = pressing.sign * (values[m, V_R1] * sums.friction_1 * omega_1 - lever_2 * omega_2)
    path_speed = pressing.sign * values[m, V_R1] * omega_1
    return friction, (sums.force - sums.elastic) * pressing.rate + sums.damped * path_speed
