"""Time integration by the modal propagator with the gear meshes as implicit nonlinear torques.

Arrays come from ``dynamics.vibration.propagator`` (discretised modes) and ``dynamics.tooth.contact_table`` (tables of
the mesh laws); names, units and validation live above.

Within a step the mesh torques are held as ``dynamics.vibration.propagator`` says, their newest value found implicitly.
A step guesses the torques (the parabola through the last three), looks at the meshes at the angles this guess leads to,
and takes a Newton step there (``mesh_solve``). Only where its remainder is too large are the meshes looked at again.
"""

from pathlib import Path

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, POSITIVE, inlined
from dynamics.kernels.contact_table import C_PAIRS, N_ROW, SCRATCH, V_R1, V_R2, ContactTables
from dynamics.kernels.drag import DragWork, brake, drags_on_ports, push_drags
from dynamics.kernels.flank_lookup import FlankRows, find_place, look_up_mesh
from dynamics.kernels.integration_data import Carried, Commands, Histories, Steps, Workspace
from dynamics.kernels.integrator_state import (
    MISSING,
    NEW,
    OLD,
    STEP,
    Meshes,
    aligned,
    aligned_zeros,
    torque_at,
)
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
    choose_friction,
    correct_alone,
    flank_powers,
    invert,
    look,
    look_ahead,
    meet_others,
)
from dynamics.kernels.wrench import (
    WrenchModes,
    forces_on_ports,
    gather_forces,
    give_to_ports,
    lean_pinions,
    part_flanks,
    push_forces,
    rubbed_beside,
    set_forces,
    set_sides,
)

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ITERATIONS = 12


def integrate(
    tables: ContactTables, modes: DiscreteModes, wrench: WrenchModes, commands: Commands, carried: Carried,
    steps: Steps, record: Histories,
) -> int:  # fmt: skip
    """Integrate over the samples of ``commands``; return the number of unconverged steps.

    Each step: outputs and modal state for the old torques; meshes looked at where these lead; Newton on the new mesh
    torques; drag torques at the new speeds; accounts.
    """
    n_meshes, n_rows, n_drags = len(tables.values), len(modes.rows), len(carried.drags)
    room = N_ROW * np.repeat(tables.counts[:, C_PAIRS], 2)
    work = Workspace(
        record=record,
        flanks=FlankRows(
            rows=aligned_zeros(int(room.sum()) + SCRATCH),
            counts=np.zeros((n_meshes, 2), np.int64),
            first=(np.cumsum(room) - room).reshape(n_meshes, 2),
            levels=np.zeros(n_meshes, np.int64),
            cells=np.zeros((n_meshes, 2), np.int64),
            sides=np.zeros(n_meshes, np.int64),
            knots=np.zeros(n_meshes, np.int64),
        ),
        bank=aligned(modes.bank),
        slow_outputs=np.zeros(modes.slow_outputs.shape[1]),
        ends=np.zeros(n_rows if len(carried.work) else len(carried.slow)),
        torques=np.zeros((2, 2 * n_meshes + n_drags + len(carried.wrench))),
        give=np.zeros(4 * n_meshes**2),
        meshes=np.zeros(n_meshes + 1, STEP),
        target=np.zeros(len(carried.slow)),
        fresh=np.zeros(len(carried.work)),
        beside=np.zeros(4 * n_meshes * wrench.every),
        mean_forces=np.zeros(len(carried.wrench)),
        drags=DragWork(np.zeros(n_drags), np.zeros(n_drags), np.zeros(n_drags), np.zeros(4 * n_meshes)),
    )
    return int(_integrate(tables, modes, wrench, commands, carried, work, steps))


def compiled() -> bool:
    """Whether the time integration lies compiled on disk."""
    return any(Path(_integrate.stats.cache_path).glob("time_integration._integrate-*.nbi"))


@inlined
def _begin(
    meshes: Meshes, values: Array, carried: Carried, port_new: Array, give: Array, step: float
) -> None:
    """Take over the state of the last call, and what the torques give to the meshes."""
    ports, offset = carried.ports, carried.offset
    n_meshes = ports.shape[0]
    for m in range(n_meshes):
        mesh = meshes[m]
        for side in range(2):
            acting = mesh.pinion if side == 0 else mesh.wheel
            acting.torque_old, acting.torque_older = ports[m, side], ports[m, 2 + side]
            acting.torque_oldest = ports[m, 4 + side]
        mesh.approach, mesh.angle = ports[m, 6], ports[m, 7]
        mesh.given, mesh.given_old = ports[m, 8], ports[m, 9]
        mesh.pinion.speed, mesh.wheel.speed = ports[m, 10], ports[m, 11]
        # rates that are straight on, or the first hold is repeated
        mesh.pinion.turn = mesh.pinion.turn_old = step * ports[m, 10]
        rate = values[m, V_R1] * ports[m, 10] - values[m, V_R2] * ports[m, 11]
        mesh.teeth = ports[m, 6] + offset[m] - ports[m, 8]
        mesh.teeth_old = mesh.teeth - step * rate
        for port in range(2 * n_meshes):
            for k in range(2):
                given_1, given_2 = port_new[port, 4 * m + k], port_new[port, 4 * m + 2 + k]
                place = 4 * (port // 2 * n_meshes + m) + 2 * (1 - k) + port % 2
                give[place] = values[m, V_R1] * given_1 - values[m, V_R2] * given_2


@inlined
def _end(meshes: Meshes, ports: Array) -> None:
    """Write the state for the next call."""
    for m in range(ports.shape[0]):
        mesh = meshes[m]
        for side in range(2):
            port = mesh.pinion if side == 0 else mesh.wheel
            ports[m, side], ports[m, 2 + side] = port.torque_old, port.torque_older
            ports[m, 4 + side] = port.torque_oldest
        ports[m, 6], ports[m, 7] = mesh.approach, mesh.angle
        ports[m, 8], ports[m, 9] = mesh.given, mesh.given_old
        ports[m, 10], ports[m, 11] = mesh.pinion.speed, mesh.wheel.speed


@inlined
def _guess(tables: ContactTables, meshes: Meshes, flanks: FlankRows, by_slow: Array, first: int) -> None:
    """Begin a step: the parabola through the last three torques, speeds and turns with what the slow inputs give.

    The meshes are looked up where angle and approach go straight on.
    """
    for m in range(tables.values.shape[0]):
        mesh, given = meshes[m & POSITIVE], (first + 4 * m) & POSITIVE
        mesh.pinion.torque = (
            3.0 * (mesh.pinion.torque_old - mesh.pinion.torque_older) + mesh.pinion.torque_oldest
        )
        mesh.wheel.torque = 3.0 * (mesh.wheel.torque_old - mesh.wheel.torque_older) + mesh.wheel.torque_oldest
        turned = mesh.pinion.turn
        mesh.lean += mesh.lean_rate
        angle = mesh.angle + 2.0 * turned - mesh.pinion.turn_old + mesh.lean
        teeth = 2.0 * mesh.teeth - mesh.teeth_old
        mesh.pinion.turn_old, mesh.teeth_old = turned, mesh.teeth
        find_place(tables, mesh, m, flanks, angle, teeth)
        mesh.pinion.speed, mesh.pinion.turn = by_slow[given], by_slow[given + 1]
        mesh.wheel.speed, mesh.wheel.turn = by_slow[given + 2], by_slow[given + 3]
        last = mesh.given
        mesh.given = 2.0 * last - mesh.given_old
        mesh.given_old = last
    for m in range(tables.values.shape[0]):
        look_up_mesh(tables, meshes[m & POSITIVE], m, flanks)


@inlined
def _next_step(meshes: Meshes, n_meshes: int) -> None:
    """Let the torques of the step be old ones."""
    for m in range(n_meshes):
        mesh = meshes[m & POSITIVE]
        for port in (mesh.pinion, mesh.wheel):
            port.torque_oldest, port.torque_older = port.torque_older, port.torque_old
            port.torque_old = port.torque


@inlined
def _keep_torques(meshes: Meshes, n_meshes: int, drags: Array, change: Array, torques: Array) -> None:
    """Fill the torques at start and end of the step, see ``end_rows``."""
    n_ports = 2 * n_meshes
    for port in range(n_ports):
        torques[0, port], torques[1, port] = torque_at(meshes, port, OLD), torque_at(meshes, port, NEW)
    for d in range(drags.shape[0]):
        torques[0, n_ports + d], torques[1, n_ports + d] = drags[d] - change[d], drags[d]


@inlined
def _keep_forces(forces: Array, torques: Array) -> None:
    """Fill the forces beside the ports into the end of the torques of ``end_rows``."""
    first = torques.shape[0] - forces.shape[0]
    for d in range(forces.shape[0]):
        torques[first + d] = forces[d]


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def _integrate(
    tables: ContactTables,
    modes: DiscreteModes,
    wrench: WrenchModes,
    commands: Commands,
    carried: Carried,
    work: Workspace,
    steps: Steps,
) -> int:
    """Do what ``integrate`` says. No array is made here, so that none has to be counted in the loop (``_nrt``)."""
    step, substeps, history, samples = steps.step, steps.substeps, work.record.history, work.record.samples
    states = work.record.states
    values = tables.values
    blocks, further, links, through = modes.blocks, modes.further, modes.links, modes.through
    state, slow = carried.state, carried.slow
    bank, meshes, give, by_slow, torques = work.bank, work.meshes, work.give, work.slow_outputs, work.torques
    n_meshes, n_slow = values.shape[0], slow.shape[0]
    drags, n_drags = carried.drags, carried.drags.shape[0]
    keeps_accounts = carried.work.shape[0] > 0
    n_outputs = 4 * n_meshes + modes.rows.shape[0]

    _begin(meshes, values, carried, modes.port_new, give, step)
    put_state(blocks, state, bank)
    forces = carried.wrench
    presses_beside = forces.shape[0] > 0
    if presses_beside:
        set_sides(wrench, meshes)
    for m in range(n_meshes):
        mesh = meshes[m]
        mesh.apart, mesh.apart_rate = carried.apart[0, m], carried.apart[1, m]
        mesh.lean, mesh.lean_rate = carried.apart[2, m], carried.apart[3, m]
    mean_torque = carried.controller[2]
    torque_share = values[0, V_R1] / substeps
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
            mesh = meshes[m & POSITIVE]
            mesh.offset, mesh.offset_rate = carried.offset[m], rate
            choose_friction(tables, mesh, m, work.flanks)
        mean_torque = 0.0
        for sub in range(substeps):
            slow_at = sub * n_outputs
            _guess(tables, meshes, work.flanks, by_slow, slow_at)
            if n_drags:
                drags_on_ports(modes.drags, drags, work.drags.outputs, meshes)
            if presses_beside:
                part = sub % wrench.every
                if part == 0:
                    give_to_ports(wrench, forces, work.beside)
                forces_on_ports(work.beside, part, n_meshes, meshes)
            step_modes(blocks, further, links, bank, through, meshes)
            if n_drags:
                push_drags(modes.drags, blocks, drags, bank)
            interval_ends = presses_beside and (sub + 1) % wrench.every == 0
            if interval_ends:
                push_forces(wrench, blocks, forces, bank)
            converged = False
            attempt = 0
            while attempt < MOST_ITERATIONS and not converged:
                for m in range(n_meshes):
                    mesh = meshes[m & POSITIVE]
                    look_ahead(mesh, values, m, step)
                    look(tables, mesh, m, work.flanks, attempt > 0)
                for m in range(n_meshes):
                    mesh = meshes[m & POSITIVE]
                    invert(mesh, give, (4 * m * (n_meshes + 1)) & POSITIVE)
                    correct_alone(mesh, give, (4 * m * (n_meshes + 1)) & POSITIVE)
                converged = meet_others(meshes, values, give, n_meshes)
                add_torques(links, 0, through, AT_END, meshes, MISSING)
                attempt += 1
            if n_drags:
                braked = brake(
                    commands.drags, modes.drags, blocks, bank, values, meshes, by_slow, slow_at + 4 * n_meshes + n_slow,
                    drags, work.drags,
                )  # fmt: skip
                converged = converged and braked
            if not converged:
                unconverged += 1
            kept = keeps_accounts or sub == substeps - 1
            if kept:
                _keep_forces(forces, torques[0])
            if presses_beside:
                gather_forces(wrench, values, meshes, work.mean_forces)
            if interval_ends:
                set_forces(wrench, forces, work.mean_forces)
            if kept:
                _keep_forces(forces, torques[1])
                _keep_torques(meshes, n_meshes, drags, work.drags.change, torques)
                take_state(blocks, bank, state)
                end_rows(modes, state, torques, by_slow, slow_at + 4 * n_meshes, work.ends)
            if keeps_accounts:  # while the angles are those of the start of the step
                account(tables, modes, wrench, carried, work, step, (sub + 1.0) / substeps)
            if interval_ends:
                last = sub == substeps - 1
                part_flanks(wrench, values, blocks, bank, meshes, forces, step, last)
                if last or wrench.every == 1:
                    lean_pinions(wrench, blocks, bank, meshes, forces, 1 if wrench.every == 1 else substeps)
            for m in range(n_meshes):
                mesh = meshes[m & POSITIVE]
                mesh.offset += step * mesh.offset_rate
                mesh.approach = mesh.reach - mesh.offset
                mesh.angle += mesh.pinion.turn
                history[m, 0, now] = mesh.net
                history[m, 1, now] = mesh.filtered
                if history.shape[1] > 2:
                    history[m, 2, now] = mesh.reach
                    history[m, 3, now] = mesh.angle
                    history[m, 4, now] = mesh.rate
                    history[m, 5, now] = mesh.pinion.speed
                    history[m, 6, now] = mesh.pinion.torque
            mean_torque += meshes[0].net * torque_share
            now += 1
            _next_step(meshes, n_meshes)
        hold_slow(modes.slow_states, slow, work.target, substeps, state)
        put_state(blocks, state, bank)
        for k in range(n_slow):
            slow[k] = work.target[k]
            carried.speeds[k] = work.ends[k]
            samples[sample, k] = work.target[k]
            samples[sample, n_slow + k] = work.ends[k]
        for d in range(n_drags):
            samples[sample, 2 * n_slow + d] = drags[d]
        samples[sample, 2 * n_slow + n_drags] = meshes[0].angle
        if states.shape[0] > 0:
            for i in range(state.shape[0]):
                states[sample, i] = state[i]
            for port in range(2 * n_meshes):
                states[sample, state.shape[0] + port] = torque_at(meshes, port, OLD)
            for d in range(forces.shape[0]):
                states[sample, state.shape[0] + 2 * n_meshes + d] = forces[d]
        for m in range(n_meshes):
            carried.offset[m] = commands.offsets[sample, m]
    for m in range(n_meshes):
        mesh = meshes[m]
        carried.apart[0, m], carried.apart[1, m] = mesh.apart, mesh.apart_rate
        carried.apart[2, m], carried.apart[3, m] = mesh.lean, mesh.lean_rate
    _end(meshes, carried.ports)
    return unconverged


# Work and losses of one step.


@njit(cache=True, fastmath=LOOSE, error_model="numpy", _nrt=False)  # type: ignore[call-overload]
def account(
    tables: ContactTables, modes: DiscreteModes, wrench: WrenchModes, carried: Carried, work: Workspace, step: float,
    share: float,
) -> None:  # fmt: skip
    """Add the work of one step, which ends at ``share`` of the sample, to the accounts.

    Powers are integrated by the cubic through their last four values. A drag torque, which
    varies linearly over the step, works by its trapezoid less ``step dF dv / 12`` (the mean of a straight line times a
    smooth curve).
    """
    total, powers, slow = carried.work, carried.powers, carried.slow
    drags, speeds = carried.drags, carried.speeds
    meshes, ends, fresh = work.meshes, work.ends, work.fresh
    n_meshes, n_slow = tables.values.shape[0], slow.shape[0]
    for m in range(n_meshes):
        lost, damped = 0.0, 0.0
        for side in range(2):
            if work.flanks.counts[m, side] > 0:
                sliding, damping = flank_powers(tables, meshes[m & POSITIVE], m, side, work.flanks)
                lost += sliding
                damped += damping
        if carried.wrench.shape[0]:
            lost += rubbed_beside(wrench, tables.values, modes.blocks, work.bank, meshes, carried.wrench, m)
        fresh[2 * m], fresh[2 * m + 1] = lost, damped
    for k in range(n_slow):
        fresh[2 * n_meshes + k] = (slow[k] + share * (work.target[k] - slow[k])) * ends[k]
    n_inputs = n_slow + drags.shape[0]
    joints, taken, first = 0.0, 0.0, ends.shape[0] - modes.circulating
    for r in range(n_inputs, first):
        joints += ends[r] * ends[r]
    for r in range(first, ends.shape[0], 4):
        taken += ends[r] * ends[r + 1] - ends[r + 2] * ends[r + 3]
    fresh[2 * n_meshes + n_inputs], fresh[2 * n_meshes + n_inputs + 1] = joints, taken
    for d in range(drags.shape[0]):
        k = 2 * n_meshes + n_slow + d
        fresh[k] = drags[d] * ends[n_slow + d]
        change = work.drags.change[d] * (ends[n_slow + d] - speeds[n_slow + d])
        total[k] += step * (0.5 * (powers[0, k] + fresh[k]) - change / 12.0)
        speeds[n_slow + d] = ends[n_slow + d]
        powers[0, k] = fresh[k]
    for k in range(fresh.shape[0]):
        if 2 * n_meshes + n_slow <= k < 2 * n_meshes + n_inputs:
            continue
        done = (9.0 * fresh[k] + 19.0 * powers[0, k] - 5.0 * powers[1, k] + powers[2, k]) / 24.0
        # the first two steps know no more than two powers
        total[k] += step * (done if powers[2, k] == powers[2, k] else 0.5 * (fresh[k] + powers[0, k]))
        powers[2, k], powers[1, k], powers[0, k] = powers[1, k], powers[0, k], fresh[k]
