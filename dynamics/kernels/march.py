"""March of the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.response.propagator`` (discretised modes) and ``dynamics.mesh.force`` (packed mesh laws);
names, units and validation live above.

A step guesses the mesh torques (straight on from the last two), lists the contacts at the angles this guess
leads to, and takes a Newton step with these contacts held (``mesh_solve``). Only where its remainder is too
large, or a kink of the mesh force lies within the correction, are the contacts summed again.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, Pressing, flank_powers, inlined
from dynamics.kernels.drag import DragWork, brake, drags_on_ports, push_drags
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
from dynamics.kernels.march_state import Carried, Commands, MarchRecord, Steps, Workspace
from dynamics.kernels.mesh_solve import (
    LEAST_GUARD,
    ListedContacts,
    behind_body,
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
from dynamics.kernels.mesh_tables import (
    BACKLASH,
    BODY,
    FLOOR,
    INDIVIDUAL,
    MOST,
    N_PHASE,
    POSITIVE,
    R1,
    R2,
    PackedMeshes,
)
from dynamics.kernels.mesh_workspace import (
    ANGLE,
    APPROACH,
    GUARD,
    MISSING,
    N_SPACE,
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

# compiled from sources f66db97d
Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ITERATIONS = 12
TOLERANCE = 1e-6
"""Share of a mesh torque that the iteration may leave open."""
MOST_SWEEPS = 50


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _account(meshes: PackedMeshes, carried: Carried, work: Workspace, step: float, share: float) -> None:
    """Add the work of one step, which ends at ``share`` of the sample, to the accounts.

    Powers are integrated by trapezoids. The march lets a mesh torque vary linearly over the step, so the
    work of the damping force is its trapezoid less ``step dF dv / 12`` (the mean of a straight line times a
    smooth curve), and so is that of a drag torque.
    """
    total, powers, damping, slow = carried.work, carried.powers, carried.damping, carried.slow
    drags, speeds = carried.drags, carried.speeds
    counts, space, ends, fresh = meshes.counts, work.space, work.ends, work.fresh
    n_meshes, n_slow = damping.shape[0], slow.shape[0]
    for m in range(n_meshes):
        table = meshes.phase_data if counts[m, INDIVIDUAL] == 0 else work.listed.contacts
        at = m * N_SPACE
        reach, rate = space[at + REACH], space[at + RATE]
        if space[at + BODY] > 0.0:
            reach = behind_body(space, at, meshes, m, reach, work.listed).approach
        lost, damped, pull = 0.0, 0.0, 0.0
        for side in range(2):
            if not can_touch(space, at, side):
                continue
            sign = 1.0 - 2.0 * side
            flank = chosen_flank(space, at, meshes, m, side, work.listed)
            pressing = Pressing(
                sign, sign * reach - side * space[at + BACKLASH], sign * rate, space[at + SPEED]
            )
            sliding, damping_power, force = flank_powers(table, flank, space, at, pressing)
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
    meshes: PackedMeshes, modes: DiscreteModes, commands: Commands, carried: Carried, steps: Steps,
    record: MarchRecord,
) -> int:  # fmt: skip
    """March over the samples of ``commands``; return the number of unconverged steps.

    Each step: outputs and modal state for the old torques; contacts chosen at the predicted angles; Newton on
    the new mesh torques with these contacts held; drag torques at the new speeds; accounts.
    """
    n_meshes, n_rows, n_drags = len(meshes.values), len(modes.rows), len(carried.drags)
    most = int(max(1, meshes.counts[:, MOST].max()))
    work = Workspace(
        record=record,
        listed=ListedContacts(
            contacts=np.zeros(2 * n_meshes * N_PHASE * most),
            found=np.zeros((n_meshes, 2), np.int64),
            no_pairs=np.empty((2, 0), np.int64),
        ),
        bank=modes.bank.copy(),
        slow_outputs=np.zeros(modes.slow_outputs.shape[1]),
        ends=np.zeros(n_rows if len(carried.work) else len(carried.slow)),
        torques=np.zeros((2, 2 * n_meshes + n_drags)),
        give=np.zeros(4 * n_meshes**2),
        space=np.pad(meshes.values, ((0, 1), (0, N_SPACE - meshes.values.shape[1]))).ravel(),
        target=np.zeros(len(carried.slow)),
        fresh=np.zeros(len(carried.work)),
        drags=DragWork(np.zeros(n_drags), np.zeros(n_drags), np.zeros(n_drags), np.zeros(4 * n_meshes)),
    )
    return int(_march(meshes, modes, commands, carried, work, steps))


@inlined
def _begin(space: Array, ports: Array, port_new: Array, give: Array) -> None:
    """Take over the state of the last call, and what the torques give to the meshes."""
    n_meshes = ports.shape[0]
    for m in range(n_meshes):
        at = m * N_SPACE
        for side in range(2):
            space[at + side * PORT + OLD], space[at + side * PORT + OLDER] = (
                ports[m, side],
                ports[m, 2 + side],
            )
        space[at + APPROACH], space[at + ANGLE], space[at + GUARD] = ports[m, 4], ports[m, 5], LEAST_GUARD
        for port in range(2 * n_meshes):
            for k in range(2):
                given_1, given_2 = port_new[port, 4 * m + k], port_new[port, 4 * m + 2 + k]
                place = 4 * (port // 2 * n_meshes + m) + 2 * (1 - k) + port % 2
                give[place] = space[at + R1] * given_1 - space[at + R2] * given_2


@inlined
def _end(space: Array, ports: Array) -> None:
    """Write the state for the next call."""
    for m in range(ports.shape[0]):
        at = m * N_SPACE
        for side in range(2):
            ports[m, side], ports[m, 2 + side] = (
                space[at + side * PORT + OLD],
                space[at + side * PORT + OLDER],
            )
        ports[m, 4], ports[m, 5] = space[at + APPROACH], space[at + ANGLE]


@inlined
def _guess(space: Array, n_meshes: int, by_slow: Array, first: int) -> None:
    """Begin a step: torques straight on from the last two, speeds and turns with what the slow inputs give."""
    for m in range(n_meshes):
        at, given = (m * N_SPACE) & POSITIVE, (first + 4 * m) & POSITIVE
        wheel = at + PORT
        space[at + TAU] = 2.0 * space[at + OLD] - space[at + OLDER]
        space[wheel + TAU] = 2.0 * space[wheel + OLD] - space[wheel + OLDER]
        space[at + SPEED], space[at + TURN] = by_slow[given], by_slow[given + 1]
        space[wheel + SPEED], space[wheel + TURN] = by_slow[given + 2], by_slow[given + 3]


@inlined
def _sweep_meshes(space: Array, give: Array, n_meshes: int) -> bool:
    """Bring all torques to the tangents of the meshes, one mesh after the other.

    Ends when all but the last mesh met the tolerance one after the other: the last is corrected since and
    moves the others by less still. Returns whether that was reached and no mesh is off its tangent by more.
    """
    correction, agreed, m = 0, -1, 0
    while agreed < n_meshes - 1 and correction < MOST_SWEEPS * n_meshes:
        at = (m * N_SPACE) & POSITIVE
        error = correct(space, at, give, (4 * m * n_meshes) & POSITIVE, n_meshes)
        agreed = agreed + 1 if error <= TOLERANCE * abs(space[at + TAU]) + space[at + FLOOR] else 0
        m = m + 1 if m + 1 < n_meshes else 0
        correction += 1
    converged = agreed >= n_meshes - 1
    for m in range(n_meshes):
        at = (m * N_SPACE) & POSITIVE
        if left_open(space, at) > TOLERANCE * abs(space[at + TAU]) + space[at + FLOOR]:
            converged = False
    return converged


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _march(
    meshes: PackedMeshes,
    modes: DiscreteModes,
    commands: Commands,
    carried: Carried,
    work: Workspace,
    steps: Steps,
) -> int:
    """Do what ``march`` says. No array is made here, so that none has to be counted in the loop (``_nrt``)."""
    step, substeps, history, samples = steps.step, steps.substeps, work.record.history, work.record.samples
    counts = meshes.counts
    blocks, further, links, through = modes.blocks, modes.further, modes.links, modes.through
    state, slow, listed = carried.state, carried.slow, work.listed
    bank, space, give, by_slow, torques = work.bank, work.space, work.give, work.slow_outputs, work.torques
    n_meshes, n_slow = counts.shape[0], slow.shape[0]
    drags, n_drags = carried.drags, carried.drags.shape[0]
    keeps_accounts = carried.work.shape[0] > 0
    n_outputs = 4 * n_meshes + modes.rows.shape[0]

    _begin(space, carried.ports, modes.port_new, give)
    put_state(blocks, state, bank)
    mean_torque = carried.controller[2]
    torque_share = space[R1] / substeps
    unconverged = 0
    now = 0
    for sample in range(commands.given.shape[0]):
        slow_targets(
            commands.given[sample],
            commands.control,
            carried.controller,
            carried.speeds[0],
            mean_torque,
            work.target,
        )
        by_slow[:] = 0.0
        hold_slow(modes.slow_outputs, slow, work.target, substeps, by_slow)
        for m in range(n_meshes):
            rate = (commands.offsets[sample, m] - carried.offset[m]) / (substeps * step)
            space[m * N_SPACE + OFFSET], space[m * N_SPACE + OFFSET_RATE] = carried.offset[m], rate
        mean_torque = 0.0
        for sub in range(substeps):
            slow_at = sub * n_outputs
            _guess(space, n_meshes, by_slow, slow_at)
            drags_on_ports(modes.drags, drags, work.drags.outputs, space)
            step_modes(blocks, further, links, bank, through, space)
            push_drags(modes.drags, blocks, drags, bank)
            converged = False
            attempt = 0
            while attempt < MOST_ITERATIONS and not converged:
                for m in range(n_meshes):
                    at = (m * N_SPACE) & POSITIVE
                    look_ahead(space, at, step)
                    if attempt == 0:
                        choose_contacts(space, at, step)
                        if counts[m, INDIVIDUAL] != 0:
                            list_individual(meshes, space, m, listed)
                    react(space, at, meshes, m, listed)
                    invert(space, at, give, (4 * m * (n_meshes + 1)) & POSITIVE)
                    space[at + MISSING], space[at + PORT + MISSING] = (
                        -space[at + TAU],
                        -space[at + PORT + TAU],
                    )
                converged = _sweep_meshes(space, give, n_meshes)
                for m in range(n_meshes):
                    at = (m * N_SPACE) & POSITIVE
                    space[at + MISSING] += space[at + TAU]
                    space[at + PORT + MISSING] += space[at + PORT + TAU]
                add_torques(links, 0, through, AT_END, space, MISSING)
                attempt += 1
            if n_drags:
                braked = brake(
                    commands.drags, modes.drags, blocks, bank, space, by_slow, slow_at + 4 * n_meshes + n_slow,
                    drags, work.drags,
                )  # fmt: skip
                converged = converged and braked
            if not converged:
                unconverged += 1
            for m in range(n_meshes):
                at = (m * N_SPACE) & POSITIVE
                space[at + OFFSET] += step * space[at + OFFSET_RATE]
                space[at + APPROACH] = space[at + REACH] - space[at + OFFSET]
                space[at + ANGLE] += space[at + TURN]
                history[m, 0, now] = space[at + NET]
                if history.shape[1] > 1:
                    history[m, 1, now] = space[at + REACH]
                    history[m, 2, now] = space[at + ANGLE]
                    history[m, 3, now] = space[at + RATE]
                    history[m, 4, now] = space[at + SPEED]
                    history[m, 5, now] = space[at + TAU]
            mean_torque += space[NET] * torque_share
            now += 1
            if keeps_accounts or sub == substeps - 1:
                for port in range(2 * n_meshes):
                    at = port // 2 * N_SPACE + port % 2 * PORT
                    torques[0, port], torques[1, port] = space[at + OLD], space[at + TAU]
                for d in range(n_drags):
                    torques[0, 2 * n_meshes + d] = drags[d] - work.drags.change[d]
                    torques[1, 2 * n_meshes + d] = drags[d]
                take_state(blocks, bank, state)
                end_rows(modes, state, torques, by_slow, slow_at + 4 * n_meshes, work.ends)
            if keeps_accounts:
                _account(meshes, carried, work, step, (sub + 1.0) / substeps)
            for m in range(n_meshes):
                at = (m * N_SPACE) & POSITIVE
                space[at + OLDER], space[at + OLD] = space[at + OLD], space[at + TAU]
                space[at + PORT + OLDER], space[at + PORT + OLD] = (
                    space[at + PORT + OLD],
                    space[at + PORT + TAU],
                )
        hold_slow(modes.slow_states, slow, work.target, substeps, state)
        put_state(blocks, state, bank)
        for k in range(n_slow):
            slow[k] = work.target[k]
            carried.speeds[k] = work.ends[k]
            samples[sample, k] = work.target[k]
            samples[sample, n_slow + k] = work.ends[k]
        for d in range(n_drags):
            samples[sample, 2 * n_slow + d] = drags[d]
        samples[sample, 2 * n_slow + n_drags] = space[ANGLE]
        for m in range(n_meshes):
            carried.offset[m] = commands.offsets[sample, m]
    _end(space, carried.ports)
    return unconverged
