"""Newton steps on the torques of gear meshes within one step of the time integration.

At the angle that a mesh is predicted to reach its contact table is contracted to cubics over the approach
(``kernels.table_lookup``); a Newton step on reach and rate then leaves out what bends within it. Only where that is too
much, where the approach leaves the cell of the table, or where a damper lets go of a flank is the mesh looked at again.
Meshes that share a shaft move each other; their tangents are swept until all torques agree.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.contact_force import (
    Pressing,
    Sums,
    advance_of,
    contact_force,
    powers,
    reversal_per_speed,
)
from dynamics.kernels.contact_table import (
    V_BACKLASH,
    V_BODY,
    V_FLOOR,
    V_R1,
    V_R2,
    ContactTables,
)
from dynamics.kernels.flank_lookup import FlankRows, find_place, look_up_mesh, within_rows
from dynamics.kernels.integrator_state import Meshes, MeshStep
from dynamics.kernels.table_lookup import sliding_at

Array = NDArray[np.float64]


Integers = NDArray[np.int64]


@inlined
def choose_friction(tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows) -> None:
    """Keep the friction of a mesh at its last speeds for the steps of a sample."""
    omega_1, omega_2 = mesh.pinion.speed, mesh.wheel.speed
    sliding = sliding_at(tables, m, omega_1, omega_2)
    flanks.levels[m] = sliding.level
    mesh.lower, mesh.upper = sliding.lower, sliding.upper
    mesh.per_speed = reversal_per_speed(tables.values, m, omega_1 + omega_2)


@inlined
def look_ahead(mesh: MeshStep, values: Array, m: int, step: float) -> None:
    """Set reach and rate of a mesh at the end of the step from its speeds and turns, imposed ones included."""
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    turn = r_1 * mesh.pinion.turn - r_2 * mesh.wheel.turn
    reach = mesh.approach + turn + mesh.offset + step * mesh.offset_rate
    rate = r_1 * mesh.pinion.speed - r_2 * mesh.wheel.speed + mesh.offset_rate
    mesh.reach, mesh.rate = reach, rate
    mesh.reach_seen, mesh.rate_seen = reach, rate


@inlined
def _pressing(mesh: MeshStep, values: Array, m: int, side: int) -> Pressing:
    """Return how the gears press a flank at the approach of the teeth and the rate at the end of the step."""
    sign = 1.0 - 2.0 * side
    beside = sign * values[m, V_R1] * (mesh.angle + mesh.pinion.turn + mesh.lean - mesh.table_angle)
    advance = advance_of(values, m, mesh.pinion.speed, mesh.wheel.speed, mesh.per_speed)
    other = mesh.other_front if side == 0 else mesh.other_back
    reach = sign * mesh.teeth - side * values[m, V_BACKLASH] + other * mesh.apart
    rate = sign * mesh.rate + other * mesh.apart_rate
    return Pressing(sign, reach, rate, beside, advance, mesh.pinion.speed, mesh.wheel.speed)


@inlined
def _set_flank(mesh: MeshStep, values: Array, m: int, sign: float, sums: Sums) -> None:
    """Set what a flank answers as the reaction of its mesh; derivatives over the approach of the teeth."""
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    mesh.pinion.reaction, mesh.wheel.reaction = -sign * r_1 * sums.a_1, sign * r_2 * sums.a_2
    mesh.pinion.reaction_x, mesh.wheel.reaction_x = -r_1 * sums.a_1_x, r_2 * sums.a_2_x
    mesh.pinion.reaction_v, mesh.wheel.reaction_v = -r_1 * sums.a_1_v, r_2 * sums.a_2_v
    mesh.force, mesh.force_x = sums.force, sign * sums.force_x
    mesh.force_v, mesh.net = sign * sums.force_v, sign * sums.recorded
    mesh.net_x, mesh.net_v = sums.force_x, sums.force_v
    mesh.filtered = sign * sums.force
    mesh.bent, mesh.bent_v = r_1 * abs(sums.curvature), r_1 * abs(sums.force_xv)
    mesh.off, mesh.share = -sign * sums.elastic, sums.stiffness
    mesh.path_torque = -sign * r_1 * (sums.a_1 - sums.force - sums.friction_1)
    other = mesh.other_front if sign > 0.0 else mesh.other_back
    mesh.other_force = other * sums.force
    mesh.other_friction = -other * sign * (r_1 * sums.friction_1 + r_2 * (sums.a_2 - sums.force))


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _add_back(tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows) -> None:
    """Add what the back flank answers to the reaction of a mesh whose front flank touches too."""
    values = tables.values
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    first = flanks.first[m, 1] & POSITIVE
    pressing = _pressing(mesh, values, m, int(np.int64(1)))
    sums = contact_force(flanks.rows, first, flanks.counts[m, 1], values, m, pressing)
    mesh.pinion.reaction += r_1 * sums.a_1
    mesh.wheel.reaction -= r_2 * sums.a_2
    mesh.pinion.reaction_x -= r_1 * sums.a_1_x
    mesh.wheel.reaction_x += r_2 * sums.a_2_x
    mesh.pinion.reaction_v -= r_1 * sums.a_1_v
    mesh.wheel.reaction_v += r_2 * sums.a_2_v
    mesh.force += sums.force
    mesh.force_x -= sums.force_x
    mesh.force_v -= sums.force_v
    mesh.net -= sums.recorded
    mesh.filtered -= sums.force
    mesh.net_x += sums.force_x
    mesh.net_v += sums.force_v
    mesh.bent += r_1 * abs(sums.curvature)
    mesh.bent_v += r_1 * abs(sums.force_xv)
    mesh.off += sums.elastic
    mesh.share += sums.stiffness
    mesh.path_torque += r_1 * (sums.a_1 - sums.force - sums.friction_1)
    other = mesh.other_back
    mesh.other_force += other * sums.force
    mesh.other_friction += other * (r_1 * sums.friction_1 + r_2 * (sums.a_2 - sums.force))


@inlined
def _no_contact(mesh: MeshStep) -> None:
    """Set the reaction of a mesh whose flanks do not touch."""
    for port in (mesh.pinion, mesh.wheel):
        port.reaction, port.reaction_x, port.reaction_v = 0.0, 0.0, 0.0
    mesh.force, mesh.force_x, mesh.force_v = 0.0, 0.0, 0.0
    mesh.net, mesh.net_x, mesh.net_v = 0.0, 0.0, 0.0
    mesh.filtered, mesh.path_torque = 0.0, 0.0
    mesh.other_force, mesh.other_friction = 0.0, 0.0
    mesh.bent, mesh.bent_v, mesh.off, mesh.share = 0.0, 0.0, 0.0, 0.0


@inlined
def look(tables: ContactTables, mesh: MeshStep, m: int, flanks: FlankRows, again: bool) -> None:
    """Set reaction and derivatives of mesh ``m`` at its reach and rate, by the rows that were looked up for it."""
    values = tables.values
    mesh.teeth = mesh.reach_seen - mesh.given
    if again or not within_rows(mesh, values, m):
        find_place(
            tables,
            mesh,
            m,
            flanks,
            mesh.angle + mesh.pinion.turn + mesh.lean,
            mesh.teeth,
        )
        look_up_mesh(tables, mesh, m, flanks)
    front, back = flanks.counts[m, 0] > 0, flanks.counts[m, 1] > 0
    if front or back:
        side = 0 if front else 1
        pressing = _pressing(mesh, values, m, side)
        first = flanks.first[m, side] & POSITIVE
        sums = contact_force(flanks.rows, first, flanks.counts[m, side], values, m, pressing)
        _set_flank(mesh, values, m, pressing.sign, sums)
    else:
        _no_contact(mesh)
    if front and back:
        _add_back(tables, mesh, m, flanks)
    body = values[m, V_BODY]
    if body > 0.0:
        share = 1.0 / (1.0 + body * mesh.share)
        off = mesh.given + body * mesh.off
        mesh.share, mesh.off = share, share * off
        mesh.pinion.reaction += mesh.pinion.reaction_x * share * off
        mesh.wheel.reaction += mesh.wheel.reaction_x * share * off
        mesh.pinion.reaction_x *= share
        mesh.wheel.reaction_x *= share
    else:
        mesh.share, mesh.off = 1.0, 0.0


@inlined
def invert(mesh: MeshStep, give: Array, own: int) -> None:
    """Keep the inverse of the Newton matrix of a mesh: one less derivative times what a torque gives in one step.

    ``give`` holds from ``own`` on the reach per torque of both ports and the rate per torque.
    """
    x_p, x_q, v_p, v_q = give[own], give[own + 1], give[own + 2], give[own + 3]
    x_1, x_2 = mesh.pinion.reaction_x, mesh.wheel.reaction_x
    v_1, v_2 = mesh.pinion.reaction_v, mesh.wheel.reaction_v
    g_11 = 1.0 - x_1 * x_p - v_1 * v_p
    g_12 = x_1 * x_q + v_1 * v_q
    g_21 = x_2 * x_p + v_2 * v_p
    g_22 = 1.0 - x_2 * x_q - v_2 * v_q
    scale = 1.0 / (g_11 * g_22 - g_12 * g_21)
    mesh.inverse_11, mesh.inverse_12 = g_22 * scale, g_12 * scale
    mesh.inverse_21, mesh.inverse_22 = g_21 * scale, g_11 * scale


@inlined
def correct(meshes: Meshes, mesh: MeshStep, give: Array, first: int, n_meshes: int) -> float:
    """Bring the torques of a mesh to its tangent, all meshes moving with them; return how far off they were.

    ``give`` holds from ``first`` on what these torques give to each of the ``n_meshes``, as in ``invert``.
    """
    dx, dv = mesh.reach - mesh.reach_seen, mesh.rate - mesh.rate_seen
    e_1 = (
        mesh.pinion.reaction + mesh.pinion.reaction_x * dx + mesh.pinion.reaction_v * dv - mesh.pinion.torque
    )
    e_2 = mesh.wheel.reaction + mesh.wheel.reaction_x * dx + mesh.wheel.reaction_v * dv - mesh.wheel.torque
    d_1 = mesh.inverse_11 * e_1 + mesh.inverse_12 * e_2
    d_2 = mesh.inverse_21 * e_1 + mesh.inverse_22 * e_2
    mesh.pinion.torque += d_1
    mesh.wheel.torque += d_2
    for m in range(n_meshes):
        to, given = meshes[m & POSITIVE], first + 4 * m
        to.reach += give[given] * d_1 + give[given + 1] * d_2
        to.rate += give[given + 2] * d_1 + give[given + 3] * d_2
    return float(abs(e_1))


@inlined
def correct_alone(mesh: MeshStep, give: Array, own: int) -> None:
    """Bring the torques of a mesh to its tangent where it was looked at, the others staying as they are."""
    e_1, e_2 = mesh.pinion.reaction - mesh.pinion.torque, mesh.wheel.reaction - mesh.wheel.torque
    d_1 = mesh.inverse_11 * e_1 + mesh.inverse_12 * e_2
    d_2 = mesh.inverse_21 * e_1 + mesh.inverse_22 * e_2
    mesh.pinion.torque += d_1
    mesh.wheel.torque += d_2
    mesh.pinion.missing, mesh.wheel.missing = d_1, d_2
    mesh.reach += give[own] * d_1 + give[own + 1] * d_2
    mesh.rate += give[own + 2] * d_1 + give[own + 3] * d_2


@inlined
def move_others(meshes: Meshes, mesh: MeshStep, give: Array, n_meshes: int, m: int) -> float:
    """Let the other meshes move mesh ``m`` by what ``correct_alone`` did to them; return the torque that it means."""
    dx, dv = 0.0, 0.0
    for n in range(n_meshes):
        if n != m:
            by, given = meshes[n & POSITIVE], (4 * (n * n_meshes + m)) & POSITIVE
            d_1, d_2 = by.pinion.missing, by.wheel.missing
            dx += give[given] * d_1 + give[given + 1] * d_2
            dv += give[given + 2] * d_1 + give[given + 3] * d_2
    mesh.reach += dx
    mesh.rate += dv
    return float(abs(mesh.pinion.reaction_x * dx + mesh.pinion.reaction_v * dv))


@inlined
def left_open(mesh: MeshStep) -> float:
    """Bring approach of the teeth and recorded forces to the tangent; return the torque that may be off it [N m].

    Infinity where the rows do not reach, or where a damper lets go of a flank.
    """
    dx, dv = mesh.reach - mesh.reach_seen, mesh.rate - mesh.rate_seen
    moved = mesh.off + mesh.share * dx
    pressed = mesh.force
    teeth = mesh.teeth + moved
    mesh.teeth, mesh.given = teeth, mesh.reach - teeth
    change = mesh.net_x * moved + mesh.net_v * dv
    mesh.net += change
    mesh.filtered += change
    after = pressed + mesh.force_x * moved + mesh.force_v * dv
    inside = mesh.low <= teeth <= mesh.high and (after > 0.0) == (pressed > 0.0)
    left = mesh.bent * moved * moved + mesh.bent_v * abs(moved * dv)
    return float(left) if inside else np.inf


@inlined
def flank_powers(
    tables: ContactTables, mesh: MeshStep, m: int, side: int, flanks: FlankRows
) -> tuple[float, float]:
    """Return friction and damping power of a flank at the end of the step, by its rows."""
    pressing = _pressing(mesh, tables.values, m, side)
    first = flanks.first[m, side] & POSITIVE
    sums = contact_force(flanks.rows, first, flanks.counts[m, side], tables.values, m, pressing)
    return powers(sums, tables.values, m, pressing, mesh.pinion.speed, mesh.wheel.speed)


# Meshes that move each other within one step of the time integration: their torques on all tangents together.

TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


@inlined
def meet_others(meshes: Meshes, values: Array, give: Array, n_meshes: int) -> bool:
    """Let the meshes move each other; return whether all torques are on their tangents."""
    together = True
    for m in range(n_meshes):
        mesh = meshes[m & POSITIVE]
        if (
            move_others(meshes, mesh, give, n_meshes, m)
            > TOLERANCE * abs(mesh.pinion.torque) + values[m, V_FLOOR]
        ):
            together = False
    converged = together or _sweep_meshes(meshes, values, give, n_meshes)
    for m in range(n_meshes):
        mesh = meshes[m & POSITIVE]
        if left_open(mesh) > TOLERANCE * abs(mesh.pinion.torque) + values[m, V_FLOOR]:
            converged = False
    return converged


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _sweep_meshes(meshes: Meshes, values: Array, give: Array, n_meshes: int) -> bool:
    """Bring all torques to the tangents of the meshes, one mesh after the other; return whether that was reached.

    Ends when all but the last mesh met the tolerance one after the other: the last is corrected since and moves the
    others by less still.
    """
    correction, agreed, m = 0, -1, 0
    for n in range(n_meshes):
        mesh = meshes[n]
        mesh.pinion.missing -= mesh.pinion.torque
        mesh.wheel.missing -= mesh.wheel.torque
    while agreed < n_meshes - 1 and correction < MOST_SWEEPS * n_meshes:
        mesh = meshes[m & POSITIVE]
        error = correct(meshes, mesh, give, (4 * m * n_meshes) & POSITIVE, n_meshes)
        agreed = agreed + 1 if error <= TOLERANCE * abs(mesh.pinion.torque) + values[m, V_FLOOR] else 0
        m = m + 1 if m + 1 < n_meshes else 0
        correction += 1
    for n in range(n_meshes):
        mesh = meshes[n]
        mesh.pinion.missing += mesh.pinion.torque
        mesh.wheel.missing += mesh.wheel.torque
    return agreed >= n_meshes - 1
