"""Newton steps on the torques of gear meshes within one step of the march.

At the angle that a mesh is predicted to reach its contact table is contracted to cubics over the approach
(``kernels.hold_path``); a Newton step on reach and rate then leaves out what bends within it. Only where that is too
much, where the approach leaves the cell of the table, or where a damper lets go of a flank is the mesh looked at again.
Meshes that share a shaft move each other; their tangents are swept until all torques agree. The state of a mesh is in
the mesh workspace ``space`` (``kernels.mesh_workspace``) from ``at`` on.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.contact_table import (
    V_BACKLASH,
    V_BODY,
    V_FLOOR,
    V_R1,
    V_R2,
    ContactTables,
)
from dynamics.kernels.held_flanks import HeldRows, find_place, hold_mesh, is_held
from dynamics.kernels.hold_path import sliding_at
from dynamics.kernels.mesh_workspace import (
    ANGLE,
    APART,
    APART_RATE,
    APPROACH,
    AT_RATE,
    AT_REACH,
    BENT,
    BENT_V,
    FILTERED,
    GIVEN,
    HELD_ANGLE,
    HIGH,
    INVERSE,
    LEAN,
    LOW,
    LOWER,
    MISSING,
    N_SPACE,
    NET,
    NET_V,
    NET_X,
    OFF,
    OFFSET,
    OFFSET_RATE,
    OTHER_BACK,
    OTHER_FRONT,
    OTHER_PRESSED,
    OTHER_RUBBED,
    PATH_TORQUE,
    PER_SPEED,
    PORT,
    PRESSED,
    PRESSED_V,
    PRESSED_X,
    RATE,
    REACH,
    REACTION,
    SHARE,
    SPEED,
    TANGENT_V,
    TANGENT_X,
    TAU,
    TEETH,
    TURN,
    UPPER,
)
from dynamics.kernels.press_rows import Pressing, Sums, advance_of, powers, press_rows, reversal_per_speed

Array = NDArray[np.float64]


Integers = NDArray[np.int64]


@inlined
def choose_friction(tables: ContactTables, space: Array, at: int, m: int, held: HeldRows) -> None:
    """Keep the friction of a mesh at its last speeds for the steps of a sample."""
    omega_1, omega_2 = space[at + SPEED], space[at + PORT + SPEED]
    sliding = sliding_at(tables, m, omega_1, omega_2)
    held.levels[m] = sliding.level
    space[at + LOWER], space[at + UPPER] = sliding.lower, sliding.upper
    space[at + PER_SPEED] = reversal_per_speed(tables.values, m, omega_1 + omega_2)


@inlined
def look_ahead(space: Array, at: int, values: Array, m: int, step: float) -> None:
    """Set reach and rate of a mesh at the end of the step from its speeds and turns, imposed ones included."""
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    turn = r_1 * space[at + TURN] - r_2 * space[at + PORT + TURN]
    reach = space[at + APPROACH] + turn + space[at + OFFSET] + step * space[at + OFFSET_RATE]
    rate = r_1 * space[at + SPEED] - r_2 * space[at + PORT + SPEED] + space[at + OFFSET_RATE]
    space[at + REACH], space[at + RATE] = reach, rate
    space[at + AT_REACH], space[at + AT_RATE] = reach, rate


@inlined
def _pressing(space: Array, at: int, values: Array, m: int, side: int) -> Pressing:
    """Return how the gears press a flank at the approach of the teeth and the rate at the end of the step."""
    sign = 1.0 - 2.0 * side
    beside = (
        sign
        * values[m, V_R1]
        * (space[at + ANGLE] + space[at + TURN] + space[at + LEAN] - space[at + HELD_ANGLE])
    )
    advance = advance_of(values, m, space[at + SPEED], space[at + PORT + SPEED], space[at + PER_SPEED])
    other = space[at + OTHER_FRONT + side]
    reach = sign * space[at + TEETH] - side * values[m, V_BACKLASH] + other * space[at + APART]
    rate = sign * space[at + RATE] + other * space[at + APART_RATE]
    return Pressing(sign, reach, rate, beside, advance, space[at + SPEED], space[at + PORT + SPEED])


@inlined
def _set_flank(space: Array, at: int, values: Array, m: int, sign: float, sums: Sums) -> None:
    """Set what a flank answers as the reaction of its mesh; derivatives over the approach of the teeth."""
    wheel = at + PORT
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    space[at + REACTION], space[wheel + REACTION] = -sign * r_1 * sums.a_1, sign * r_2 * sums.a_2
    space[at + TANGENT_X], space[wheel + TANGENT_X] = -r_1 * sums.a_1_x, r_2 * sums.a_2_x
    space[at + TANGENT_V], space[wheel + TANGENT_V] = -r_1 * sums.a_1_v, r_2 * sums.a_2_v
    space[at + PRESSED], space[at + PRESSED_X] = sums.force, sign * sums.force_x
    space[at + PRESSED_V], space[at + NET] = sign * sums.force_v, sign * sums.recorded
    space[at + NET_X], space[at + NET_V] = sums.force_x, sums.force_v
    space[at + FILTERED] = sign * sums.force
    space[at + BENT], space[at + BENT_V] = r_1 * abs(sums.curvature), r_1 * abs(sums.force_xv)
    space[at + OFF], space[at + SHARE] = -sign * sums.elastic, sums.stiffness
    space[at + PATH_TORQUE] = -sign * r_1 * (sums.a_1 - sums.force - sums.friction_1)
    other = space[at + OTHER_FRONT] if sign > 0.0 else space[at + OTHER_BACK]
    space[at + OTHER_PRESSED] = other * sums.force
    space[at + OTHER_RUBBED] = -other * sign * (r_1 * sums.friction_1 + r_2 * (sums.a_2 - sums.force))


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _add_back(tables: ContactTables, space: Array, at: int, m: int, held: HeldRows) -> None:
    """Add what the back flank answers to the reaction of a mesh whose front flank touches too."""
    values = tables.values
    wheel = at + PORT
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    first = held.first[m, 1] & POSITIVE
    pressing = _pressing(space, at, values, m, int(np.int64(1)))
    sums = press_rows(held.rows, first, held.counts[m, 1], values, m, pressing)
    space[at + REACTION] += r_1 * sums.a_1
    space[wheel + REACTION] -= r_2 * sums.a_2
    space[at + TANGENT_X] -= r_1 * sums.a_1_x
    space[wheel + TANGENT_X] += r_2 * sums.a_2_x
    space[at + TANGENT_V] -= r_1 * sums.a_1_v
    space[wheel + TANGENT_V] += r_2 * sums.a_2_v
    space[at + PRESSED] += sums.force
    space[at + PRESSED_X] -= sums.force_x
    space[at + PRESSED_V] -= sums.force_v
    space[at + NET] -= sums.recorded
    space[at + FILTERED] -= sums.force
    space[at + NET_X] += sums.force_x
    space[at + NET_V] += sums.force_v
    space[at + BENT] += r_1 * abs(sums.curvature)
    space[at + BENT_V] += r_1 * abs(sums.force_xv)
    space[at + OFF] += sums.elastic
    space[at + SHARE] += sums.stiffness
    space[at + PATH_TORQUE] += r_1 * (sums.a_1 - sums.force - sums.friction_1)
    other = space[at + OTHER_BACK]
    space[at + OTHER_PRESSED] += other * sums.force
    space[at + OTHER_RUBBED] += other * (r_1 * sums.friction_1 + r_2 * (sums.a_2 - sums.force))


@inlined
def _no_contact(space: Array, at: int) -> None:
    """Set the reaction of a mesh whose flanks do not touch."""
    wheel = at + PORT
    for port in (at, wheel):
        space[port + REACTION], space[port + TANGENT_X], space[port + TANGENT_V] = 0.0, 0.0, 0.0
    space[at + PRESSED], space[at + PRESSED_X], space[at + PRESSED_V] = 0.0, 0.0, 0.0
    space[at + NET], space[at + NET_X], space[at + NET_V] = 0.0, 0.0, 0.0
    space[at + FILTERED], space[at + PATH_TORQUE] = 0.0, 0.0
    space[at + OTHER_PRESSED], space[at + OTHER_RUBBED] = 0.0, 0.0
    space[at + BENT], space[at + BENT_V], space[at + OFF], space[at + SHARE] = 0.0, 0.0, 0.0, 0.0


@inlined
def look(tables: ContactTables, space: Array, at: int, m: int, held: HeldRows, again: bool) -> None:
    """Set reaction and derivatives of mesh ``m`` at its reach and rate, by the rows that are held for it."""
    values = tables.values
    wheel = at + PORT
    space[at + TEETH] = space[at + AT_REACH] - space[at + GIVEN]
    if again or not is_held(space, at, values, m):
        find_place(
            tables,
            space,
            at,
            m,
            held,
            space[at + ANGLE] + space[at + TURN] + space[at + LEAN],
            space[at + TEETH],
        )
        hold_mesh(tables, space, at, m, held)
    front, back = held.counts[m, 0] > 0, held.counts[m, 1] > 0
    if front or back:
        side = 0 if front else 1
        pressing = _pressing(space, at, values, m, side)
        first = held.first[m, side] & POSITIVE
        sums = press_rows(held.rows, first, held.counts[m, side], values, m, pressing)
        _set_flank(space, at, values, m, pressing.sign, sums)
    else:
        _no_contact(space, at)
    if front and back:
        _add_back(tables, space, at, m, held)
    body = values[m, V_BODY]
    if body > 0.0:
        share = 1.0 / (1.0 + body * space[at + SHARE])
        off = space[at + GIVEN] + body * space[at + OFF]
        space[at + SHARE], space[at + OFF] = share, share * off
        space[at + REACTION] += space[at + TANGENT_X] * share * off
        space[wheel + REACTION] += space[wheel + TANGENT_X] * share * off
        space[at + TANGENT_X] *= share
        space[wheel + TANGENT_X] *= share
    else:
        space[at + SHARE], space[at + OFF] = 1.0, 0.0


@inlined
def invert(space: Array, at: int, give: Array, own: int) -> None:
    """Keep the inverse of the Newton matrix of a mesh: one less derivative times what a torque gives in one step.

    ``give`` holds from ``own`` on the reach per torque of both ports and the rate per torque.
    """
    x_p, x_q, v_p, v_q = give[own], give[own + 1], give[own + 2], give[own + 3]
    x_1, x_2 = space[at + TANGENT_X], space[at + PORT + TANGENT_X]
    v_1, v_2 = space[at + TANGENT_V], space[at + PORT + TANGENT_V]
    g_11 = 1.0 - x_1 * x_p - v_1 * v_p
    g_12 = x_1 * x_q + v_1 * v_q
    g_21 = x_2 * x_p + v_2 * v_p
    g_22 = 1.0 - x_2 * x_q - v_2 * v_q
    scale = 1.0 / (g_11 * g_22 - g_12 * g_21)
    space[at + INVERSE], space[at + INVERSE + 1] = g_22 * scale, g_12 * scale
    space[at + INVERSE + 2], space[at + INVERSE + 3] = g_21 * scale, g_11 * scale


@inlined
def correct(space: Array, at: int, give: Array, first: int, n_meshes: int) -> float:
    """Bring the torques of a mesh to its tangent, all meshes moving with them; return how far off they were.

    ``give`` holds from ``first`` on what these torques give to each of the ``n_meshes``, as in ``invert``.
    """
    wheel = at + PORT
    dx, dv = space[at + REACH] - space[at + AT_REACH], space[at + RATE] - space[at + AT_RATE]
    e_1 = space[at + REACTION] + space[at + TANGENT_X] * dx + space[at + TANGENT_V] * dv - space[at + TAU]
    e_2 = (
        space[wheel + REACTION]
        + space[wheel + TANGENT_X] * dx
        + space[wheel + TANGENT_V] * dv
        - space[wheel + TAU]
    )
    d_1 = space[at + INVERSE] * e_1 + space[at + INVERSE + 1] * e_2
    d_2 = space[at + INVERSE + 2] * e_1 + space[at + INVERSE + 3] * e_2
    space[at + TAU] += d_1
    space[wheel + TAU] += d_2
    for m in range(n_meshes):
        to, given = (m * N_SPACE) & POSITIVE, first + 4 * m
        space[to + REACH] += give[given] * d_1 + give[given + 1] * d_2
        space[to + RATE] += give[given + 2] * d_1 + give[given + 3] * d_2
    return float(abs(e_1))


@inlined
def correct_alone(space: Array, at: int, give: Array, own: int) -> None:
    """Bring the torques of a mesh to its tangent where it was looked at, the others staying as they are."""
    wheel = at + PORT
    e_1, e_2 = space[at + REACTION] - space[at + TAU], space[wheel + REACTION] - space[wheel + TAU]
    d_1 = space[at + INVERSE] * e_1 + space[at + INVERSE + 1] * e_2
    d_2 = space[at + INVERSE + 2] * e_1 + space[at + INVERSE + 3] * e_2
    space[at + TAU] += d_1
    space[wheel + TAU] += d_2
    space[at + MISSING], space[wheel + MISSING] = d_1, d_2
    space[at + REACH] += give[own] * d_1 + give[own + 1] * d_2
    space[at + RATE] += give[own + 2] * d_1 + give[own + 3] * d_2


@inlined
def move_others(space: Array, at: int, give: Array, n_meshes: int, m: int) -> float:
    """Let the other meshes move mesh ``m`` by what ``correct_alone`` did to them; return the torque that it means."""
    dx, dv = 0.0, 0.0
    for n in range(n_meshes):
        if n != m:
            by, given = (n * N_SPACE) & POSITIVE, (4 * (n * n_meshes + m)) & POSITIVE
            d_1, d_2 = space[by + MISSING], space[by + PORT + MISSING]
            dx += give[given] * d_1 + give[given + 1] * d_2
            dv += give[given + 2] * d_1 + give[given + 3] * d_2
    space[at + REACH] += dx
    space[at + RATE] += dv
    return float(abs(space[at + TANGENT_X] * dx + space[at + TANGENT_V] * dv))


@inlined
def left_open(space: Array, at: int) -> float:
    """Bring approach of the teeth and recorded forces to the tangent; return the torque that may be off it [N m].

    Infinity where the held rows do not reach, or where a damper lets go of a flank.
    """
    dx, dv = space[at + REACH] - space[at + AT_REACH], space[at + RATE] - space[at + AT_RATE]
    moved = space[at + OFF] + space[at + SHARE] * dx
    pressed = space[at + PRESSED]
    teeth = space[at + TEETH] + moved
    space[at + TEETH], space[at + GIVEN] = teeth, space[at + REACH] - teeth
    change = space[at + NET_X] * moved + space[at + NET_V] * dv
    space[at + NET] += change
    space[at + FILTERED] += change
    after = pressed + space[at + PRESSED_X] * moved + space[at + PRESSED_V] * dv
    inside = space[at + LOW] <= teeth <= space[at + HIGH] and (after > 0.0) == (pressed > 0.0)
    left = space[at + BENT] * moved * moved + space[at + BENT_V] * abs(moved * dv)
    return float(left) if inside else np.inf


@inlined
def flank_powers(
    tables: ContactTables, space: Array, at: int, m: int, side: int, held: HeldRows
) -> tuple[float, float]:
    """Return friction and damping power of a flank at the end of the step, whose rows are held."""
    pressing = _pressing(space, at, tables.values, m, side)
    first = held.first[m, side] & POSITIVE
    sums = press_rows(held.rows, first, held.counts[m, side], tables.values, m, pressing)
    return powers(sums, tables.values, m, pressing, space[at + SPEED], space[at + PORT + SPEED])


# Meshes that move each other within one step of the march: their torques on all tangents together.

TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


@inlined
def meet_others(space: Array, values: Array, give: Array, n_meshes: int) -> bool:
    """Let the meshes move each other; return whether all torques are on their tangents."""
    together = True
    for m in range(n_meshes):
        at = (m * N_SPACE) & POSITIVE
        if move_others(space, at, give, n_meshes, m) > TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR]:
            together = False
    converged = together or _sweep_meshes(space, values, give, n_meshes)
    for m in range(n_meshes):
        at = (m * N_SPACE) & POSITIVE
        if left_open(space, at) > TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR]:
            converged = False
    return converged


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _sweep_meshes(space: Array, values: Array, give: Array, n_meshes: int) -> bool:
    """Bring all torques to the tangents of the meshes, one mesh after the other; return whether that was reached.

    Ends when all but the last mesh met the tolerance one after the other: the last is corrected since and moves the
    others by less still.
    """
    correction, agreed, m = 0, -1, 0
    for n in range(n_meshes):
        at = n * N_SPACE
        space[at + MISSING] -= space[at + TAU]
        space[at + PORT + MISSING] -= space[at + PORT + TAU]
    while agreed < n_meshes - 1 and correction < MOST_SWEEPS * n_meshes:
        at = (m * N_SPACE) & POSITIVE
        error = correct(space, at, give, (4 * m * n_meshes) & POSITIVE, n_meshes)
        agreed = agreed + 1 if error <= TOLERANCE * abs(space[at + TAU]) + values[m, V_FLOOR] else 0
        m = m + 1 if m + 1 < n_meshes else 0
        correction += 1
    for n in range(n_meshes):
        at = n * N_SPACE
        space[at + MISSING] += space[at + TAU]
        space[at + PORT + MISSING] += space[at + PORT + TAU]
    return agreed >= n_meshes - 1
