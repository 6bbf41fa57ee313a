"""March of the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.response.propagator`` (discretised modes) and ``dynamics.mesh.force`` (packed mesh laws);
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
    FLOOR,
    INDIVIDUAL,
    LOOSE,
    MOST,
    N_PHASE,
    POSITIVE,
    R1,
    R2,
    PackedMeshes,
    flank_powers,
    inlined,
)
from dynamics.kernels.drag import DragLaws, DragWork, brake, drags_on_ports, push_drags
from dynamics.kernels.linear_step import (
    AT_END,
    DiscreteModes,
    add_torques,
    end_rows,
    hold_slow,
    put_state,
    slow_targets,
    step_modes,
    take_state,
)
from dynamics.kernels.mesh_solve import (
    LEAST_GUARD,
    can_touch,
    choose_contacts,
    chosen_flank,
    correct,
    invert,
    left_open,
    list_individual,
    look_ahead,
    react,
)
from dynamics.kernels.mesh_workspace import (
    ANGLE,
    APPROACH,
    GUARD,
    MISSING,
    N_BOOK,
    NET,
    OFFSET,
    OFFSET_RATE,
    OLD,
    OLDER,
    PORT,
    RATE,
    REACH,
    SPEED,
    TAU,
    TURN,
)

# compiled from sources 896f0027
Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ITERATIONS = 12
TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


class Orders(NamedTuple):
    """What a march is told, values at the end of each sample."""

    given: Array
    """(n_samples, 4 + n_given) motor torque, twist, speed of the drive, torque of the first mesh, then the other slow
    inputs."""
    offsets: Array
    """(n_samples, n_meshes) imposed approach."""
    control: Array
    """Proportional gain, integral gain per sample, torque limit (0: no control), share of the averaged speed;
    bracing gain per sample (0: no control), share of the averaged torque."""
    drags: DragLaws


class Carried(NamedTuple):
    """What a march carries on; every array is written."""

    state: Array
    """(n_states,) modal state."""
    ports: Array
    """(n_meshes, 6) tau_1, tau_2, both one step earlier, approach, pinion angle."""
    slow: Array
    """(n_slow,) motor torque, twist, torques that are given."""
    drags: Array
    """(n_drags,) drag torques."""
    offset: Array
    """(n_meshes,) imposed approach."""
    controller: Array
    """Integral of the speed controller, correction of the twist, then averages: torque, speed, asked torque."""
    speeds: Array
    """(n_slow + n_drags,) speed of the load of every slow input and drag."""
    powers: Array
    """Last powers: friction and damping of each mesh, every slow input, every drag, joints; empty without accounts."""
    work: Array
    """Their integrals."""
    damping: Array
    """(n_meshes, 2) last damping force and approach rate."""


class Workspace(NamedTuple):
    """Arrays a march writes into and forgets."""

    contacts: Array
    """Room for the tables of both flanks of every mesh with individual teeth."""
    found: Integers
    """(n_meshes, 2) contacts in them."""
    no_pairs: Integers
    bank: Array
    """That of the modes with the state in it."""
    slow_outputs: Array
    """Flat (substeps, n_outputs + n_rows): what the slow inputs give in each step of the sample."""
    ends: Array
    """(n_rows,) the outputs of no port; without accounts those of the slow inputs alone."""
    torques: Array
    """(2, n_ports + n_drags) torques of ports and drags at start and end of a step."""
    give: Array
    """Flat (n_meshes, n_meshes, 4): reach of another mesh per torque of both ports of one at the end of the step,
    then its rate."""
    book: Array
    """Flat (n_meshes + 1, N_BOOK), see ``kernels.book``."""
    target: Array
    """(n_slow,) slow inputs at the end of the sample."""
    fresh: Array
    """Powers at the end of the step."""
    drags: DragWork


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _account(meshes: PackedMeshes, carried: Carried, work: Workspace, step: float, share: float) -> None:
    """Add the work of one step, which ends at ``share`` of the sample, to the accounts.

    Powers are integrated by trapezoids. The march lets a mesh torque vary linearly over the step, so the
    work of the damping force is its trapezoid less ``step dF dv / 12`` (the mean of a straight line times a
    smooth curve), and so is that of a drag torque.
    """
    total, powers, damping, slow = carried.work, carried.powers, carried.damping, carried.slow
    drags, speeds = carried.drags, carried.speeds
    counts, book, ends, fresh = meshes.counts, work.book, work.ends, work.fresh
    n_meshes, n_slow = damping.shape[0], slow.shape[0]
    for m in range(n_meshes):
        table = meshes.phase_data if counts[m, INDIVIDUAL] == 0 else work.contacts
        at = m * N_BOOK
        reach, rate = book[at + REACH], book[at + RATE]
        lost, damped, pull = 0.0, 0.0, 0.0
        for side in range(2):
            if not can_touch(book, at, side):
                continue
            sign = 1.0 - 2.0 * side
            flank = chosen_flank(
                book, at, counts, meshes.phase_starts, meshes.phase_least, m, side, work.contacts, work.found
            )  # fmt: skip
            sliding, damping_power, force = flank_powers(
                table, flank, book, at, sign, sign * reach - side * book[at + BACKLASH], sign * rate,
                book[at + SPEED],
            )  # fmt: skip
            lost += sliding
            damped += damping_power
            pull += sign * force
        fresh[2 * m] = lost
        fresh[2 * m + 1] = damped
        total[2 * m + 1] -= step * (pull - damping[m, 0]) * (rate - damping[m, 1]) / 12.0
        damping[m, 0] = pull
        damping[m, 1] = rate
    for k in range(n_slow):
        fresh[2 * n_meshes + k] = (slow[k] + share * (work.target[k] - slow[k])) * ends[k]
    n_inputs = n_slow + drags.shape[0]
    for d in range(drags.shape[0]):
        k = n_slow + d
        fresh[2 * n_meshes + k] = drags[d] * ends[k]
        total[2 * n_meshes + k] -= step * work.drags.change[d] * (ends[k] - speeds[k]) / 12.0
        speeds[k] = ends[k]
    joints = 0.0
    for r in range(n_inputs, ends.shape[0]):
        joints += ends[r] * ends[r]
    fresh[2 * n_meshes + n_inputs] = joints
    for k in range(fresh.shape[0]):
        total[k] += 0.5 * step * (powers[k] + fresh[k])
        powers[k] = fresh[k]


def march(
    meshes: PackedMeshes, modes: DiscreteModes, orders: Orders, carried: Carried, step: float, substeps: int,
    history: Array, samples: Array,
) -> int:  # fmt: skip
    """March over ``len(orders.given)`` samples of ``substeps`` steps; return the number of unsettled steps.

    Each step: outputs and modal state for the old torques; contacts chosen at the predicted angles; Newton on
    the new mesh torques with these contacts held; drag torques at the new speeds; accounts. ``history`` (n_meshes, 1
    or 6, steps): front - back force [, approach, pinion angle, approach rate, pinion speed, tau_1]; ``samples``
    (n_samples, 2 n_slow + n_drags + 1): slow inputs, their speeds, drag torques, angle of the first pinion.
    """
    n_meshes, n_rows, n_drags = len(meshes.values), len(modes.rows), len(carried.drags)
    most = int(max(1, meshes.counts[:, MOST].max()))
    work = Workspace(
        contacts=np.zeros(2 * n_meshes * N_PHASE * most),
        found=np.zeros((n_meshes, 2), np.int64),
        no_pairs=np.empty((2, 0), np.int64),
        bank=modes.bank.copy(),
        slow_outputs=np.zeros(modes.slow_outputs.shape[1]),
        ends=np.zeros(n_rows if len(carried.work) else len(carried.slow)),
        torques=np.zeros((2, 2 * n_meshes + n_drags)),
        give=np.zeros(4 * n_meshes**2),
        book=np.pad(meshes.values, ((0, 1), (0, N_BOOK - meshes.values.shape[1]))).ravel(),
        target=np.zeros(len(carried.slow)),
        fresh=np.zeros(len(carried.work)),
        drags=DragWork(np.zeros(n_drags), np.zeros(n_drags), np.zeros(n_drags), np.zeros(4 * n_meshes)),
    )
    return int(_march(meshes, modes, orders, carried, work, step, substeps, history, samples))


@inlined
def _begin(book: Array, ports: Array, port_new: Array, give: Array) -> None:
    """Take over what was carried from the last call, and what the torques give to the meshes."""
    n_meshes = ports.shape[0]
    for m in range(n_meshes):
        at = m * N_BOOK
        for side in range(2):
            book[at + side * PORT + OLD], book[at + side * PORT + OLDER] = ports[m, side], ports[m, 2 + side]
        book[at + APPROACH], book[at + ANGLE], book[at + GUARD] = ports[m, 4], ports[m, 5], LEAST_GUARD
        for port in range(2 * n_meshes):
            for k in range(2):
                given_1, given_2 = port_new[port, 4 * m + k], port_new[port, 4 * m + 2 + k]
                place = 4 * (port // 2 * n_meshes + m) + 2 * (1 - k) + port % 2
                give[place] = book[at + R1] * given_1 - book[at + R2] * given_2


@inlined
def _end(book: Array, ports: Array) -> None:
    """Carry on what the next call takes over."""
    for m in range(ports.shape[0]):
        at = m * N_BOOK
        for side in range(2):
            ports[m, side], ports[m, 2 + side] = book[at + side * PORT + OLD], book[at + side * PORT + OLDER]
        ports[m, 4], ports[m, 5] = book[at + APPROACH], book[at + ANGLE]


@inlined
def _guess(book: Array, n_meshes: int, by_slow: Array, first: int) -> None:
    """Begin a step: torques straight on from the last two, speeds and turns with what the slow inputs give."""
    for m in range(n_meshes):
        at, given = (m * N_BOOK) & POSITIVE, (first + 4 * m) & POSITIVE
        wheel = at + PORT
        book[at + TAU] = 2.0 * book[at + OLD] - book[at + OLDER]
        book[wheel + TAU] = 2.0 * book[wheel + OLD] - book[wheel + OLDER]
        book[at + SPEED], book[at + TURN] = by_slow[given], by_slow[given + 1]
        book[wheel + SPEED], book[wheel + TURN] = by_slow[given + 2], by_slow[given + 3]


@inlined
def _agree(book: Array, give: Array, n_meshes: int) -> bool:
    """Bring all torques to the tangents of the meshes in turn, told where these stand.

    Ends when all but the last mesh were found in agreement one after the other: the last is corrected since and
    moves the others by less still. Returns whether that was reached and the meshes can be trusted to be there.
    """
    turn, agreed, m = 0, -1, 0
    while agreed < n_meshes - 1 and turn < MOST_SWEEPS * n_meshes:
        at = (m * N_BOOK) & POSITIVE
        error = correct(book, at, give, (4 * m * n_meshes) & POSITIVE, n_meshes)
        agreed = agreed + 1 if error <= TOLERANCE * abs(book[at + TAU]) + book[at + FLOOR] else 0
        m = m + 1 if m + 1 < n_meshes else 0
        turn += 1
    settled = agreed >= n_meshes - 1
    for m in range(n_meshes):
        at = (m * N_BOOK) & POSITIVE
        if left_open(book, at) > TOLERANCE * abs(book[at + TAU]) + book[at + FLOOR]:
            settled = False
    return settled


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _march(
    meshes: PackedMeshes, modes: DiscreteModes, orders: Orders, carried: Carried, work: Workspace, step: float,
    substeps: int, history: Array, samples: Array,
) -> int:  # fmt: skip
    """Do what ``march`` says. No array is made here, so that none has to be counted in the loop (``_nrt``)."""
    counts, starts, least, data = meshes.counts, meshes.phase_starts, meshes.phase_least, meshes.phase_data
    blocks, further, links, through = modes.blocks, modes.further, modes.links, modes.through
    state, slow, contacts, found = carried.state, carried.slow, work.contacts, work.found
    bank, book, give, by_slow, torques = work.bank, work.book, work.give, work.slow_outputs, work.torques
    n_meshes, n_slow = counts.shape[0], slow.shape[0]
    drags, n_drags = carried.drags, carried.drags.shape[0]
    keeps_accounts = carried.work.shape[0] > 0
    n_outputs = 4 * n_meshes + modes.rows.shape[0]

    _begin(book, carried.ports, modes.port_new, give)
    put_state(blocks, state, bank)
    mean_torque = carried.controller[2]
    torque_share = book[R1] / substeps
    unsettled = 0
    now = 0
    for sample in range(orders.given.shape[0]):
        slow_targets(
            orders.given[sample],
            orders.control,
            carried.controller,
            carried.speeds[0],
            mean_torque,
            work.target,
        )
        by_slow[:] = 0.0
        hold_slow(modes.slow_outputs, slow, work.target, substeps, by_slow)
        for m in range(n_meshes):
            rate = (orders.offsets[sample, m] - carried.offset[m]) / (substeps * step)
            book[m * N_BOOK + OFFSET], book[m * N_BOOK + OFFSET_RATE] = carried.offset[m], rate
        mean_torque = 0.0
        for sub in range(substeps):
            slow_at = sub * n_outputs
            _guess(book, n_meshes, by_slow, slow_at)
            drags_on_ports(modes.drags, drags, work.drags.outputs, book)
            step_modes(blocks, further, links, bank, through, book)
            push_drags(modes.drags, blocks, drags, bank)
            settled = False
            attempt = 0
            while attempt < MOST_ITERATIONS and not settled:
                for m in range(n_meshes):
                    at = (m * N_BOOK) & POSITIVE
                    look_ahead(book, at, step)
                    if attempt == 0:
                        choose_contacts(book, at, step)
                        if counts[m, INDIVIDUAL] != 0:
                            list_individual(meshes, book, m, contacts, found, work.no_pairs)
                    react(book, at, counts, starts, least, data, m, contacts, found)
                    invert(book, at, give, (4 * m * (n_meshes + 1)) & POSITIVE)
                    book[at + MISSING], book[at + PORT + MISSING] = -book[at + TAU], -book[at + PORT + TAU]
                settled = _agree(book, give, n_meshes)
                for m in range(n_meshes):
                    at = (m * N_BOOK) & POSITIVE
                    book[at + MISSING] += book[at + TAU]
                    book[at + PORT + MISSING] += book[at + PORT + TAU]
                add_torques(links, 0, through, AT_END, book, MISSING)
                attempt += 1
            if n_drags:
                braked = brake(
                    orders.drags, modes.drags, blocks, bank, book, by_slow, slow_at + 4 * n_meshes + n_slow,
                    drags, work.drags,
                )  # fmt: skip
                settled = settled and braked
            if not settled:
                unsettled += 1
            for m in range(n_meshes):
                at = (m * N_BOOK) & POSITIVE
                book[at + OFFSET] += step * book[at + OFFSET_RATE]
                book[at + APPROACH] = book[at + REACH] - book[at + OFFSET]
                book[at + ANGLE] += book[at + TURN]
                history[m, 0, now] = book[at + NET]
                if history.shape[1] > 1:
                    history[m, 1, now] = book[at + REACH]
                    history[m, 2, now] = book[at + ANGLE]
                    history[m, 3, now] = book[at + RATE]
                    history[m, 4, now] = book[at + SPEED]
                    history[m, 5, now] = book[at + TAU]
            mean_torque += book[NET] * torque_share
            now += 1
            if keeps_accounts or sub == substeps - 1:
                for port in range(2 * n_meshes):
                    at = port // 2 * N_BOOK + port % 2 * PORT
                    torques[0, port], torques[1, port] = book[at + OLD], book[at + TAU]
                for d in range(n_drags):
                    torques[0, 2 * n_meshes + d] = drags[d] - work.drags.change[d]
                    torques[1, 2 * n_meshes + d] = drags[d]
                take_state(blocks, bank, state)
                end_rows(modes, state, torques, by_slow, slow_at + 4 * n_meshes, work.ends)
            if keeps_accounts:
                _account(meshes, carried, work, step, (sub + 1.0) / substeps)
            for m in range(n_meshes):
                at = (m * N_BOOK) & POSITIVE
                book[at + OLDER], book[at + OLD] = book[at + OLD], book[at + TAU]
                book[at + PORT + OLDER], book[at + PORT + OLD] = book[at + PORT + OLD], book[at + PORT + TAU]
        hold_slow(modes.slow_states, slow, work.target, substeps, state)
        put_state(blocks, state, bank)
        for k in range(n_slow):
            slow[k] = work.target[k]
            carried.speeds[k] = work.ends[k]
            samples[sample, k] = work.target[k]
            samples[sample, n_slow + k] = work.ends[k]
        for d in range(n_drags):
            samples[sample, 2 * n_slow + d] = drags[d]
        samples[sample, 2 * n_slow + n_drags] = book[ANGLE]
        for m in range(n_meshes):
            carried.offset[m] = orders.offsets[sample, m]
    _end(book, carried.ports)
    return unsettled
