"""Newton steps on the torques of gear meshes within one step of the march.

Between its kinks (a contact that closes, opens or reaches full damping) the force of a mesh is bilinear in
reach and rate: a Newton step solves it but for a known remainder. Meshes that share a shaft move each other;
their tangents are swept until all torques agree, without listing or summing the contacts again.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import BACKLASH, DAMP_TIME, LOOSE, PER_DEPTH, R1, R2, press_flank

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LEAST_GUARD = 1e-15
"""Least distance to a kink that is looked at [m]."""
# columns of a mesh's reaction: torques, their slopes over reach and rate, force and its slopes, then bounds
TAU_1, TAU_2, TAU_1_X, TAU_2_X, TAU_1_V, TAU_2_V, NET, NET_X, NET_V, KINKED, CURVED = range(11)
N_REACTION = 11
# columns of a mesh's motion: approach, pinion angle, imposed approach and its rate at the start of the step;
# reach and rate as last evaluated; distance within which kinks are looked for; reach and rate given per torque
# (2 each); inverse of the Newton matrix (4)
APPROACH, ANGLE, OFFSET, OFFSET_RATE, REACH, RATE, GUARD, GIVE_X, GIVE_V, INVERSE = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    9,
    11,
)
N_MOTION = 15


@njit(cache=True, fastmath=LOOSE, inline="always")
def reach_and_rate(values: Array, motion: Array, outputs: Array, step: float, m: int) -> tuple[float, float]:
    """Return approach and approach rate of mesh ``m`` at the end of the step, imposed ones included."""
    r_1, r_2 = values[m, R1], values[m, R2]
    o = 4 * m
    turn = r_1 * outputs[o + 1] - r_2 * outputs[o + 3]
    reach = motion[m, APPROACH] + turn + motion[m, OFFSET] + step * motion[m, OFFSET_RATE]
    return reach, r_1 * outputs[o] - r_2 * outputs[o + 2] + motion[m, OFFSET_RATE]


@njit(cache=True, fastmath=LOOSE, inline="always")
def react(
    values: Array, m: int, contacts: Array, size: int, found: Integers, reach: float, rate: float, omega_1: float,
    guard: float, reactions: Array,
) -> None:  # fmt: skip
    """Fill row ``m`` of ``reactions`` from both flanks, listed in parts ``2 m`` and ``2 m + 1`` of ``contacts``."""
    r_1, r_2 = values[m, R1], values[m, R2]
    t_1, t_2, x_1, x_2, v_1, v_2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    net, net_x, net_v, kinked, curved = 0.0, 0.0, 0.0, 0.0, 0.0
    for side in range(2):
        if found[m, side] == 0:
            continue
        sign = 1.0 - 2.0 * side
        flank = press_flank(
            contacts, (2 * m + side) * size, found[m, side], sign * reach - side * values[m, BACKLASH], sign * rate,
            sign * r_1 * omega_1, values[m, DAMP_TIME], values[m, PER_DEPTH], guard,
        )  # fmt: skip
        t_1 -= sign * flank.a_1
        t_2 += sign * flank.a_2
        x_1 -= flank.a_1_x
        x_2 += flank.a_2_x
        v_1 -= flank.a_1_v
        v_2 += flank.a_2_v
        net += sign * flank.force
        net_x += flank.force_x
        net_v += flank.force_v
        kinked += flank.kinked
        curved += flank.curved
    reactions[m, TAU_1] = r_1 * t_1
    reactions[m, TAU_2] = r_2 * t_2
    reactions[m, TAU_1_X] = r_1 * x_1
    reactions[m, TAU_2_X] = r_2 * x_2
    reactions[m, TAU_1_V] = r_1 * v_1
    reactions[m, TAU_2_V] = r_2 * v_2
    reactions[m, NET] = net
    reactions[m, NET_X] = net_x
    reactions[m, NET_V] = net_v
    reactions[m, KINKED] = kinked
    reactions[m, CURVED] = curved


@njit(cache=True, fastmath=LOOSE, inline="always")
def invert(reactions: Array, motion: Array, m: int) -> None:
    """Keep the inverse of the Newton matrix of mesh ``m``: one less slope times what a torque gives in one step."""
    x_p, x_q, v_p, v_q = motion[m, GIVE_X], motion[m, GIVE_X + 1], motion[m, GIVE_V], motion[m, GIVE_V + 1]
    x_1, x_2 = reactions[m, TAU_1_X], reactions[m, TAU_2_X]
    v_1, v_2 = reactions[m, TAU_1_V], reactions[m, TAU_2_V]
    g_11 = 1.0 - x_1 * x_p - v_1 * v_p
    g_12 = x_1 * x_q + v_1 * v_q
    g_21 = x_2 * x_p + v_2 * v_p
    g_22 = 1.0 - x_2 * x_q - v_2 * v_q
    scale = 1.0 / (g_11 * g_22 - g_12 * g_21)
    motion[m, INVERSE] = g_22 * scale
    motion[m, INVERSE + 1] = g_12 * scale
    motion[m, INVERSE + 2] = g_21 * scale
    motion[m, INVERSE + 3] = g_11 * scale


@njit(cache=True, fastmath=LOOSE, inline="always")
def correct(
    reactions: Array, motion: Array, through: Array, reach: float, rate: float, m: int, tau: Array, outputs: Array
) -> float:  # fmt: skip
    """Bring the torques of mesh ``m`` to its tangent at ``reach`` and ``rate``; return how far off they were."""
    p, q = 2 * m, 2 * m + 1
    dx, dv = reach - motion[m, REACH], rate - motion[m, RATE]
    e_1 = reactions[m, TAU_1] + reactions[m, TAU_1_X] * dx + reactions[m, TAU_1_V] * dv - tau[p]
    e_2 = reactions[m, TAU_2] + reactions[m, TAU_2_X] * dx + reactions[m, TAU_2_V] * dv - tau[q]
    d_1 = motion[m, INVERSE] * e_1 + motion[m, INVERSE + 1] * e_2
    d_2 = motion[m, INVERSE + 2] * e_1 + motion[m, INVERSE + 3] * e_2
    tau[p] += d_1
    tau[q] += d_2
    for r in range(through.shape[1]):
        outputs[r] += through[p, r] * d_1 + through[q, r] * d_2
    return float(abs(e_1))


@njit(cache=True, fastmath=LOOSE, inline="always")
def left_open(
    reactions: Array, motion: Array, reach: float, rate: float, r_1: float, damp_time: float, m: int
) -> float:
    """Bring the force of mesh ``m`` to its tangent; return the torque by which the mesh can be off it [N m].

    The mesh force is bilinear in reach and rate, which leaves ``curved dx dv``, unless a kink lies within: then up
    to the stiffness of its contacts times ``dx``, and infinity where kinks were looked for in a smaller range.
    """
    dx, dv = reach - motion[m, REACH], rate - motion[m, RATE]
    reactions[m, NET] += reactions[m, NET_X] * dx + reactions[m, NET_V] * dv
    moved = abs(dx) + damp_time * abs(dv)
    looked_at = moved <= motion[m, GUARD]
    motion[m, GUARD] = max(2.0 * moved, 0.9 * motion[m, GUARD], LEAST_GUARD)
    left = r_1 * (reactions[m, KINKED] * moved + reactions[m, CURVED] * abs(dx * dv))
    return float(left) if looked_at else np.inf
