"""What gear meshes answer at given states by their contact tables: totals with tangents."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from dynamics.kernels.contact import LOOSE, inlined
from dynamics.kernels.contact_force import (
    Pressing,
    Sums,
    advance_of,
    contact_force,
    powers,
    reversal_per_speed,
)
from dynamics.kernels.contact_table import (
    C_PAIRS,
    N_ROW,
    SCRATCH,
    V_BACKLASH,
    V_BODY,
    V_R1,
    V_R2,
    V_TABULATED_BODY,
    ContactTables,
)
from dynamics.kernels.reactions import MeshStates
from dynamics.kernels.table_lookup import FlankState, Sliding, look_up_flank, sliding_at

Array = NDArray[np.float64]

MOST_STEPS = 40
CLOSE = 1e-13
"""Share of the greatest approach that is left open behind shared bodies."""


@inlined
def _press_side(
    tables: ContactTables, m: int, state: FlankState, sliding: Sliding, pressing: Pressing, rows: Array
) -> Sums:
    """Hold one flank at its state and sum it there."""
    first = int(np.int64(0))  # for a constant everything would be compiled once more
    rows_of = look_up_flank(tables, m, state, sliding, pressing.reach, rows, first)
    return contact_force(rows, first, rows_of.n, tables.values, m, pressing)


def table_reactions(tables: ContactTables, m: int, states: MeshStates, tilts: Array, out: Array) -> None:
    """Evaluate mesh ``m`` at many states.

    ``tilts`` (n, 2) of the front and the back flanks [rad]; ``out`` (n, 14) in the order of ``TableReaction``.
    """
    rows = np.zeros(N_ROW * int(tables.counts[m, C_PAIRS]) + SCRATCH)
    _table_reactions(tables, m, states, tilts, rows, out)


@njit(cache=True, fastmath=LOOSE, _nrt=False)  # type: ignore[call-overload]
def _table_reactions(
    tables: ContactTables, m: int, states: MeshStates, tilts: Array, rows: Array, out: Array
) -> None:
    """Do what ``table_reactions`` says, ``rows`` being room for the pairs of a flank."""
    values = tables.values
    r_1, r_2 = values[m, V_R1], values[m, V_R2]
    for n in range(out.shape[0]):
        omega_1, omega_2 = states.omega_1[n], states.omega_2[n]
        rate = r_1 * omega_1 - r_2 * omega_2
        sliding = sliding_at(tables, m, omega_1, omega_2)
        per_speed = reversal_per_speed(values, m, omega_1 + omega_2)
        advance = advance_of(values, m, omega_1, omega_2, per_speed)
        x = states.reach[n]
        y, low, high = x, -np.inf, np.inf
        share = 1.0
        if values[m, V_BODY] > 0.0:
            for _ in range(MOST_STEPS):
                net, stiffness = 0.0, 0.0
                for side in range(2):
                    sign = 1.0 - 2.0 * side
                    reach = sign * y - side * values[m, V_BACKLASH]
                    state = FlankState(side, states.theta_1[n], tilts[n, side])
                    sums = _press_side(
                        tables, m, state, sliding, Pressing(sign, reach, 0.0, 0.0, 0.0, 0.0, 0.0), rows
                    )
                    net += sign * sums.elastic
                    stiffness += sums.stiffness
                off = y + values[m, V_BODY] * net - x
                share = 1.0 / (1.0 + values[m, V_BODY] * stiffness)
                if off > 0.0:
                    high = y
                else:
                    low = y
                new = y - off * share
                if not low <= new <= high:
                    new = 0.5 * (low + high)
                moved = abs(new - y)
                y = new
                if moved <= CLOSE * abs(x):
                    break
        out[n] = 0.0
        for side in range(2):
            sign = 1.0 - 2.0 * side
            pressing = Pressing(
                sign, sign * y - side * values[m, V_BACKLASH], sign * rate, 0.0, advance, omega_1, omega_2
            )
            state = FlankState(side, states.theta_1[n], tilts[n, side])
            sums = _press_side(tables, m, state, sliding, pressing, rows)
            friction, damping = powers(sums, values, m, pressing, omega_1, omega_2)
            out[n, 0] -= sign * r_1 * sums.a_1
            out[n, 1] += sign * r_2 * sums.a_2
            out[n, 2 + side] += sums.force
            out[n, 4] -= r_1 * share * sums.a_1_x
            out[n, 5] += r_2 * share * sums.a_2_x
            out[n, 6] -= r_1 * sums.a_1_v
            out[n, 7] += r_2 * sums.a_2_v
            out[n, 8] += friction
            out[n, 9] += damping
            out[n, 10] += sums.energy
            out[n, 12 + side] = sums.moment
            out[n, 11] -= sign * values[m, V_TABULATED_BODY] * sums.elastic
        if values[m, V_BODY] > 0.0:
            out[n, 10] += 0.5 * (x - y) ** 2 / values[m, V_BODY]
        out[n, 11] += y
