"""Stability of a periodic response: Floquet exponents of growing motion, counted and named.

A small change of the approach of the meshes, exp(s t) times a mesh-periodic function, obeys

    [ I - G(s + i k W) T_kl ] x_l = 0 ,     T_kl = stiffness harmonic (k - l) + damping harmonic (k - l) (s + i l W)

with G the approach per torque of the drivetrain, exact in all its modes, and W the mesh frequency. Exponents with a
growth beyond ``GROWTH`` are zeros of the determinant right of a line Re s = growth; along that line, over one mesh
frequency, the determinant turns by -2 pi for each of them, as G has no pole there. So they are counted by the phase of
a determinant with as many rows as the approach has harmonics, however many modes the drivetrain has. The twist of the
bracing and the motor torque are held.

Sources: Hill's determinant (Nayfeh & Mook, Nonlinear Oscillations, 1979, 5.2.3); Nyquist criterion for periodic
systems by harmonic transfer functions (Wereley, MIT thesis, 1990, 6.2).
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.response.harmonic_equations import HarmonicEquations, state_of
from dynamics.response.harmonic_newton import MeshHarmonics, mesh_inputs
from dynamics.response.harmonic_problem import HarmonicSolution

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Instability = Literal["fold", "period doubling", "second frequency"]

GROWTH = 2e-4
"""Growth rate per mesh frequency [rad/s per rad/s] that still counts as stable: 0.13 % per mesh period."""
STABILITY_HARMONICS = 16
"""Harmonics of the change at most [-]; 12 to 48 give the same counts on the prototype at 10 Nm."""
FEWEST, MOST = 12, 300
"""Points on half of the line at first, on each of its parts, and at most."""
TURN = 1.6
"""Largest turn of the determinant from point to point [rad]."""


def instability(equations: HarmonicEquations, solution: HarmonicSolution) -> tuple[int, Instability | None]:
    """Number of growing Floquet exponents of a mesh-periodic solution, and how the motion leaves it; 0, None: stable.

    ``fold``: one real exponent, the motion goes to another branch. ``period doubling``: an exponent at half the mesh
    frequency. ``second frequency``: a pair at a frequency of its own. Where several grow, the first of these names it.
    """
    _, reactions = equations.residual(state_of(solution))
    line = _Line(equations, reactions)
    share = 0.5 * np.concatenate([[0.0], np.geomspace(1e-4, 0.1, FEWEST), np.linspace(0.15, 1.0, FEWEST)])
    value = line.at(share)
    for _ in range(8):
        turn = np.angle(value[1:] / value[:-1])
        wide = np.flatnonzero(np.abs(turn) > TURN)
        if not wide.size or len(share) + 2 * wide.size > MOST:
            break
        cut = np.linspace(0.0, 1.0, 4)[1:-1]
        more = np.sort((share[wide, None] + cut * (share[wide + 1] - share[wide])[:, None]).ravel())
        place = np.searchsorted(share, more)
        share, value = np.insert(share, place, more), np.insert(value, place, line.at(more))
    turn = np.angle(value[1:] / value[:-1])
    # half the line holds half the turn of an exponent on its ends, the whole one of each pair elsewhere
    count = max(0, round(-float(turn.sum()) / np.pi))
    if not count:
        return 0, None
    # on both ends the determinant is real, and negative for an odd number of real exponents beyond
    if value[0].real < 0.0:
        return count, "fold"
    return count, "period doubling" if value[-1].real < 0.0 else "second frequency"


class _Line:
    """Determinant along Re s = growth."""

    def __init__(self, equations: HarmonicEquations, reactions: MeshHarmonics) -> None:
        problem, grid = equations.problem, equations.grid
        model, form = problem.model, problem.form
        self.mesh = equations.base * grid.cells
        reach = min(grid.harmonics, STABILITY_HARMONICS)
        self.order = np.arange(-reach, reach + 1)
        lag = np.subtract.outer(self.order, self.order)
        self.stiff, self.damp = reactions.per_approach[:, :, lag], reactions.per_rate[:, :, lag]
        bodies, inputs = model.dofs[: model.n_bodies], mesh_inputs(model)
        out = model.approach[:, :-1] @ form.velocity_shapes[bodies]
        into = problem.into[:, inputs]
        self.poles = form.poles
        self.shape = (model.n_meshes, *inputs.shape)
        self.residues = np.einsum("ai,imp->ampi", out, into).reshape(-1, form.poles.size)

    def at(self, share: Array) -> Complex:
        """Determinant (n,) at frequencies per mesh frequency (n,)."""
        s = self.mesh * (GROWTH + 1j * (share[:, None] + self.order))
        gain = (1.0 / (s.ravel()[:, None] - self.poles)) @ self.residues.T / s.ravel()[:, None]
        gain = gain.reshape(*s.shape, *self.shape)
        tangent = self.stiff + self.damp * s[:, None, None, None, :]
        n_meshes, n = self.shape[0], self.order.size
        block = np.einsum("fkamp,fmpkl->fakml", gain, tangent, optimize=True)
        size = n_meshes * n
        return np.asarray(np.linalg.det(np.eye(size) - block.reshape(-1, size, size)))
