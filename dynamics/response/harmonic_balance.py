"""Periodic response of a rotating loop by harmonic balance with alternating frequency and time.

Unknowns are the harmonics of the approach in every mesh, the mean windup, the drive torque that balances all losses,
and the bracing twist that makes the asked mean torque. One period may be a mesh, a revolution or a hunting
cycle: the Newton matrix falls into one small block per residue class of harmonics if the tangent is
averaged over the meshes of the period, and stays exact when the period is one mesh.

Source: alternating frequency/time, Cameron & Griffin, J. Appl. Mech. 56 (1989) 149; applied to gear pairs
with contact loss by Kahraman & Blankenship, J. Appl. Mech. 64 (1997) 217.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsNotConverged
from dynamics.response.harmonic_equations import HarmonicEquations, HarmonicState, state_of
from dynamics.response.harmonic_problem import BalanceProblem, HarmonicSolution

STALL_LIMIT = 2e-3
"""Residual accepted when Newton stalls [-]: a damped contact force jumps at first touch, so that one sample
in or out of contact leaves a remainder that shrinks with the number of samples."""
MOST_ITERATIONS = 40
CHORD, FAST = 1e-3, 0.1
"""Residual below which the tangents of the step before serve again, as long as a step leaves a tenth of it [-]: those
of the pinion angle, left out of them, leave a hundredth in any case."""

Complex = NDArray[np.complex128]


def solve_periodic(
    problem: BalanceProblem,
    speed: float,
    start: HarmonicSolution,
    *,
    drag_torques: Mapping[str, float] | None = None,
    excitation: Complex | None = None,
    tolerance: float = 1e-5,
) -> HarmonicSolution:
    """Newton iteration from a start state, on its grid.

    Parameters
    ----------
    speed : mean speed of the drive freedom [rad/s]
    start : state whose coefficients are taken, brought to another grid by ``resample``
    drag_torques : by name of ``PortModel.drags`` [N m]
    excitation : (n_bodies, top + 1) one-sided harmonics of further torques on the mesh bodies [N m]
    tolerance : largest error of the approach over its mean, and of the torques over the asked one [-]

    Raises
    ------
    DynamicsNotConverged
        With the residual reached. A stalled iteration counts as converged below STALL_LIMIT; its residual stands
        in the result.
    """
    equations = HarmonicEquations(problem, start.grid, speed, drag_torques, excitation)
    state, step = state_of(start), None
    best = equations.solution(state, np.inf, 0)
    damp, previous = 1.0, np.inf
    for iteration in range(MOST_ITERATIONS):
        residual, reactions = equations.residual(state)
        error = equations.error(residual)
        if error < best.residual:
            best = equations.solution(state, error, iteration)
        if error < tolerance or (error > 0.9 * best.residual and iteration >= best.iterations + 3):
            break
        if step is not None and error > 1.5 * previous and damp > 1.0 / 16.0:
            damp *= 0.5
            state = state.plus(step, -damp)
            continue
        fast = error < FAST * previous
        previous, damp = error, 1.0
        try:
            solve = equations.newton.step_again if fast and error < CHORD else equations.newton.step
            step = HarmonicState(*solve(reactions, *residual))
        except np.linalg.LinAlgError:
            break
        state = state.plus(step)
    if best.residual < max(tolerance, STALL_LIMIT):
        return best
    raise DynamicsNotConverged(
        f"harmonic balance at {speed:.6g} rad/s: residual {best.residual:.2e} of the mean approach, limit "
        f"{max(tolerance, STALL_LIMIT):.0e}; start from a neighbouring speed or integrate in time"
    )
