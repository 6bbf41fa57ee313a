"""Newton steps on the torques of gear meshes within one step of the march.

Between its kinks (a contact that closes, opens or reaches full damping) the force of a mesh is bilinear in
reach and rate: a Newton step solves it but for a known remainder. Meshes that share a shaft move each other;
their tangents are swept until all torques agree, without summing the contacts again. The state of a
mesh is in the mesh workspace ``space`` (``kernels.mesh_workspace``) from ``at`` on.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, Flank, Pressed, Pressing, inlined, press_flank
from dynamics.kernels.flank_contacts import (
    ContactState,
    ContactTable,
    flank_in_phase,
    flank_on_path,
    list_on_path,
)
from dynamics.kernels.mesh_tables import (
    BACKLASH,
    BODY,
    DAMP_TIME,
    INDIVIDUAL,
    JAMMED,
    LEAST_GAP,
    N_PHASE,
    POSITIVE,
    R1,
    R2,
    PackedMeshes,
)
from dynamics.kernels.mesh_workspace import (
    AHEAD,
    ANGLE,
    APPROACH,
    AT_RATE,
    AT_REACH,
    CHOSEN_1,
    CHOSEN_2,
    CHOSEN_ANGLE,
    CHOSEN_REACH,
    CURVED,
    GIVEN,
    GUARD,
    INVERSE,
    KINKED,
    N_SPACE,
    NET,
    NET_V,
    NET_X,
    OFFSET,
    OFFSET_RATE,
    PORT,
    RATE,
    REACH,
    REACTION,
    SPEED,
    TANGENT_V,
    TANGENT_X,
    TAU,
    TOOTH_SHARE,
    TURN,
)
from dynamics.kernels.shared_body import Flanks, ToothApproach, no_contacts, tooth_approach

# compiled from sources f66db97d
Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LEAST_GUARD = 1e-15
"""Least distance to a kink that is looked at [m]."""


class ListedContacts(NamedTuple):
    """Contacts of the meshes with individual teeth, listed anew in every step."""

    contacts: Array
    """Room for the tables of both flanks of every mesh."""
    found: Integers
    """(n_meshes, 2) contacts in them."""
    no_pairs: Integers
    """(2, 0): tooth pair and slice of a contact are not asked for."""


@inlined
def look_ahead(space: Array, at: int, step: float) -> None:
    """Set reach and rate of a mesh at the end of the step from its speeds and turns, imposed ones included."""
    r_1, r_2 = space[at + R1], space[at + R2]
    turn = r_1 * space[at + TURN] - r_2 * space[at + PORT + TURN]
    reach = space[at + APPROACH] + turn + space[at + OFFSET] + step * space[at + OFFSET_RATE]
    rate = r_1 * space[at + SPEED] - r_2 * space[at + PORT + SPEED] + space[at + OFFSET_RATE]
    space[at + REACH], space[at + RATE] = reach, rate
    space[at + AT_REACH], space[at + AT_RATE] = reach, rate


@inlined
def choose_contacts(space: Array, at: int, step: float) -> None:
    """Keep the state at which the contacts of a mesh are chosen for this step."""
    space[at + CHOSEN_ANGLE] = space[at + ANGLE] + space[at + TURN]
    space[at + CHOSEN_1], space[at + CHOSEN_2] = space[at + SPEED], space[at + PORT + SPEED]
    space[at + CHOSEN_REACH], space[at + AHEAD] = space[at + REACH], 2.0 * step * abs(space[at + RATE])


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def list_individual(meshes: PackedMeshes, space: Array, m: int, listed: ListedContacts) -> None:
    """List the contacts of a mesh with individual teeth at the angle chosen for this step."""
    counts, contacts = meshes.counts, listed.contacts
    stride = contacts.shape[0] // (2 * N_PHASE * counts.shape[0])
    for side in range(2):
        table = ContactTable(contacts, (2 * m + side) * N_PHASE * stride, stride, listed.no_pairs)
        angle = space[m * N_SPACE + CHOSEN_ANGLE]
        listed.found[m, side] = list_on_path(space, m * N_SPACE, meshes, m, 1.0 - 2.0 * side, angle, table)


@inlined
def _within(space: Array, at: int, side: int) -> float:
    """Return the reach up to which contacts of a flank are looked for in this step."""
    within = (1.0 - 2.0 * side) * space[at + CHOSEN_REACH] - side * space[at + BACKLASH] + space[at + AHEAD]
    return float(within + space[at + JAMMED])


@inlined
def can_touch(space: Array, at: int, side: int) -> bool:
    """Return whether a flank comes within reach of its least gap in this step."""
    return bool(_within(space, at, side) > space[at + LEAST_GAP])


@inlined
def chosen_flank(
    space: Array, at: int, meshes: PackedMeshes, m: int, side: int, listed: ListedContacts
) -> Flank:
    """Return the contacts of a flank that were chosen for this step."""
    sign = 1.0 - 2.0 * side
    omega_1, omega_2 = space[at + CHOSEN_1], space[at + CHOSEN_2]
    if meshes.counts[m, INDIVIDUAL] == 0:
        state = ContactState(sign, _within(space, at, side), space[at + CHOSEN_ANGLE], omega_1, omega_2)
        return flank_in_phase(space, at, meshes, m, state)
    stride = listed.contacts.shape[0] // (2 * N_PHASE * meshes.counts.shape[0])
    table = ContactTable(listed.contacts, (2 * m + side) * N_PHASE * stride, stride, listed.no_pairs)
    return flank_on_path(space, at, table, listed.found[m, side], omega_1, omega_2)


@inlined
def _press_side(space: Array, at: int, side: int, table: Array, flank: Flank) -> Pressed:
    """Sum the contacts of one flank where the mesh was last looked at."""
    sign = 1.0 - 2.0 * side
    reach = sign * (space[at + AT_REACH] - space[at + GIVEN]) - side * space[at + BACKLASH]
    pressing = Pressing(sign, reach, sign * space[at + AT_RATE], space[at + SPEED])
    return press_flank(table, flank, space, at, pressing, space[at + GUARD])


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def behind_body(
    space: Array, at: int, meshes: PackedMeshes, m: int, reach: float, listed: ListedContacts
) -> ToothApproach:
    """Return what the teeth see of a reach of the gears, from the contacts chosen for this step."""
    front, back = no_contacts(), no_contacts()
    if can_touch(space, at, 0):
        front = chosen_flank(space, at, meshes, m, 0, listed)
    if can_touch(space, at, 1):
        back = chosen_flank(space, at, meshes, m, 1, listed)
    table = meshes.phase_data if meshes.counts[m, INDIVIDUAL] == 0 else listed.contacts
    start = reach - space[at + GIVEN]
    teeth: ToothApproach = tooth_approach(table, Flanks(front, back), space, at, reach, start)
    return teeth


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _react_on_both(space: Array, at: int, table: Array, front: Flank, back: Flank) -> None:
    """Set the reaction of a mesh where both flanks can touch."""
    _react_on(space, at, table, 0, front, back)
    wheel = at + PORT
    sums = _press_side(space, at, 1, table, back)
    r_1, r_2 = space[at + R1], space[at + R2]
    space[at + REACTION] += r_1 * sums.a_1
    space[wheel + REACTION] -= r_2 * sums.a_2
    share = space[at + TOOTH_SHARE]
    space[at + TANGENT_X] -= r_1 * share * sums.a_1_x
    space[wheel + TANGENT_X] += r_2 * share * sums.a_2_x
    space[at + TANGENT_V] -= r_1 * sums.a_1_v
    space[wheel + TANGENT_V] += r_2 * sums.a_2_v
    space[at + NET] -= sums.force
    space[at + NET_X] += share * sums.force_x
    space[at + NET_V] += sums.force_v
    space[at + KINKED] += sums.kinked
    space[at + CURVED] += sums.curved


@inlined
def _react_on(space: Array, at: int, table: Array, side: int, flank: Flank, other: Flank) -> None:
    """Set the reaction of a mesh of which one flank presses; the other flank counts for the body only."""
    wheel = at + PORT
    sign = 1.0 - 2.0 * side
    share = 1.0
    if space[at + BODY] > 0.0:
        flanks = Flanks(flank, other) if side == 0 else Flanks(other, flank)
        reach = space[at + AT_REACH]
        teeth = tooth_approach(table, flanks, space, at, reach, reach - space[at + GIVEN])
        share, space[at + GIVEN] = teeth.share, reach - teeth.approach
    space[at + TOOTH_SHARE] = share
    sums = _press_side(space, at, side, table, flank)
    r_1, r_2 = space[at + R1], space[at + R2]
    space[at + REACTION], space[wheel + REACTION] = -sign * r_1 * sums.a_1, sign * r_2 * sums.a_2
    space[at + TANGENT_X] = -r_1 * share * sums.a_1_x
    space[wheel + TANGENT_X] = r_2 * share * sums.a_2_x
    space[at + TANGENT_V], space[wheel + TANGENT_V] = -r_1 * sums.a_1_v, r_2 * sums.a_2_v
    space[at + NET], space[at + NET_X] = sign * sums.force, share * sums.force_x
    space[at + NET_V] = sums.force_v
    space[at + KINKED], space[at + CURVED] = sums.kinked, sums.curved


@inlined
def react(space: Array, at: int, meshes: PackedMeshes, m: int, listed: ListedContacts) -> None:
    """Set reaction and derivatives of mesh ``m`` at its last state, from the contacts chosen for this step."""
    wheel = at + PORT
    front, back = can_touch(space, at, 0), can_touch(space, at, 1)
    if not (front or back):
        for port in (at, wheel):
            space[port + REACTION], space[port + TANGENT_X], space[port + TANGENT_V] = 0.0, 0.0, 0.0
        space[at + NET], space[at + NET_X], space[at + NET_V] = 0.0, 0.0, 0.0
        space[at + KINKED], space[at + CURVED] = 0.0, 0.0
        return
    table = meshes.phase_data if meshes.counts[m, INDIVIDUAL] == 0 else listed.contacts
    side = 0 if front else 1
    flank = chosen_flank(space, at, meshes, m, side, listed)
    if front and back:
        _react_on_both(space, at, table, flank, chosen_flank(space, at, meshes, m, 1, listed))
    else:
        _react_on(space, at, table, side, flank, no_contacts())


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
def left_open(space: Array, at: int) -> float:
    """Bring the force of a mesh to its tangent; return the torque by which the mesh can be off it [N m].

    The mesh force is bilinear in reach and rate, which leaves ``curved dx dv``, unless a kink lies within: then up
    to the stiffness of its contacts times ``dx``, and infinity where kinks were looked for in a smaller range.
    """
    dx, dv = space[at + REACH] - space[at + AT_REACH], space[at + RATE] - space[at + AT_RATE]
    space[at + NET] += space[at + NET_X] * dx + space[at + NET_V] * dv
    moved = abs(dx) + space[at + DAMP_TIME] * abs(dv)
    looked_at = moved <= space[at + GUARD]
    space[at + GUARD] = max(2.0 * moved, 0.9 * space[at + GUARD], LEAST_GUARD)
    left = space[at + R1] * (space[at + KINKED] * moved + space[at + CURVED] * abs(dx * dv))
    return float(left) if looked_at else np.inf
