"""Work and losses of one step of the march."""

from numba import njit

from dynamics.kernels.contact import LOOSE
from dynamics.kernels.contact_table import ContactTables
from dynamics.kernels.linear_step import DiscreteModes
from dynamics.kernels.march_state import Carried, Workspace
from dynamics.kernels.mesh_solve import flank_powers
from dynamics.kernels.mesh_workspace import N_SPACE
from dynamics.kernels.wrench import WrenchModes, rubbed_beside

# compiled from sources 815a2749


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
    space, ends, fresh = work.space, work.ends, work.fresh
    n_meshes, n_slow = tables.values.shape[0], slow.shape[0]
    for m in range(n_meshes):
        lost, damped = 0.0, 0.0
        for side in range(2):
            if work.held.counts[m, side] > 0:
                sliding, damping = flank_powers(tables, space, m * N_SPACE, m, side, work.held)
                lost += sliding
                damped += damping
        if carried.wrench.shape[0]:
            lost += rubbed_beside(wrench, tables.values, modes.blocks, work.bank, space, carried.wrench, m)
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
