"""Loaded contact of a gear pair, quasi-static, over one mesh cycle.

The potential contact points of all tooth pairs press on compliant flanks: at approach x (transverse line of action,
at a given rotation of the pinion) the gap of a point closes by w x along its normal, forces along it only press,

    w x - w g - A F - h(F) <= 0 ,  F >= 0 ,  one of them 0 ;   sum w F = P = T_2 / r_b2

A: influence numbers of both gears with neighbouring teeth, h: local approach, w = cos(beta_b) lever_2 / r_b2, by which
force and approach belong together (virtual work) also where a tip corner's force leaves the line of action.
Source: gears.md g; Conry and Seireg, ASME J. Eng. Ind. 95 (1973) 1115.
"""

from dataclasses import dataclass, replace
from math import nan

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.gear.pair import GearPair
from dynamics.kernels.loaded_contact import (
    CONVERGED,
    NO_CONVERGENCE,
    NOT_POSITIVE,
    ContactProblem,
    ContactSolution,
    press_points,
)
from dynamics.tooth.compliance import SOFT_EDGES, EdgeModel, FlankCompliance, LocalContact, LocalModel
from dynamics.tooth.corner import TipEnd
from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.points import ContactPoints, FaceGrid, FlankGap, contact_points, no_gap

Flags = NDArray[np.bool_]

FIRST_REACH = 0.05
"""Approach that is looked for first, in normal modules."""
MOST_REACH = 0.8
"""Largest approach, in normal modules."""
FAILURES = {
    NO_CONVERGENCE: "Newton's method did not end; refine the positions or check the gap",
    NOT_POSITIVE: "the compliance of the touching points is not positive definite; build the influence numbers anew",
}


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadedMesh:
    """A gear pair whose contact under load can be asked for.

    gears : compliance of pinion and wheel
    grid : positions over the common face width
    gap : of the flanks beyond the involutes, see ``FlankGap``
    tips : ends of both flanks; None: those of the pair
    edges : how tip edges act
    n_positions : of a mesh cycle
    """

    pair: GearPair
    gears: tuple[FlankCompliance, FlankCompliance]
    grid: FaceGrid
    gap: FlankGap = no_gap
    tips: tuple[TipEnd, TipEnd] | None = None
    edges: EdgeModel = SOFT_EDGES
    n_positions: int = 64

    def cycle(self, force: float) -> MeshCycle:
        """Contact over one mesh cycle under a transverse mesh force P = T_2 / r_b2 [N].

        Raises DynamicsInputError for a force that is not positive, DynamicsNotConverged where the teeth would have to
        approach by more than 0.8 modules or a position has no solution; the message names it.
        """
        if not (force > 0.0 and np.isfinite(force)):
            raise DynamicsInputError(
                f"mesh force = {force} N must be positive; give the amount, the pair is loaded on its front flanks"
            )
        reach, most = FIRST_REACH * self.pair.normal_module, MOST_REACH * self.pair.normal_module
        while True:
            points = self.points(reach)
            needed = np.inf
            if np.all(np.isfinite(points.gap).any(axis=(1, 2))):
                cycle = self._pressed(points, force)
                needed = float(np.max(cycle.approach)) - min(float(np.min(points.gap)), 0.0)
                if needed <= reach:
                    return cycle
            reach = 2.0 * reach if np.isinf(needed) else max(2.0 * reach, 1.2 * needed)
            if reach > most:
                raise DynamicsNotConverged(
                    f"mesh force = {force:.4g} N: the teeth would have to approach by {1e6 * reach:.0f} um, limit "
                    f"{1e6 * most:.0f} um; reduce the load or the gap of the flanks"
                )

    def points(self, reach: float, n_positions: int | None = None, beyond: int = 0) -> ContactPoints:
        """Potential contact points for approaches up to ``reach`` [m]; arguments as in `contact_points`."""
        return contact_points(
            self.pair,
            self.grid,
            gap=self.gap,
            tips=self.tips,
            n_positions=self.n_positions if n_positions is None else n_positions,
            beyond=beyond,
            reach=reach,
        )

    def _pressed(self, points: ContactPoints, force: float) -> MeshCycle:
        model = LocalModel(
            pair=self.pair,
            gears=self.gears,
            tips=points.tips,
            edges=self.edges,
            line_load=force / self.grid.face_width,
        )
        widths = np.broadcast_to(self.grid.width, points.path.shape)
        local = model.at(points.place, widths)
        shape = points.path.shape
        forces, closing = np.zeros(shape), np.full(shape, -np.inf)
        approach, tangent = np.empty(shape[0]), np.empty(shape[0])
        near = np.zeros(shape[1:])
        for k in range(shape[0]):
            within = np.isfinite(points.gap[k])
            problem = self._problem(points, local, k, within)
            start = near[within]
            solution = press_points(problem, force, nan if k == 0 else approach[k - 1], start)
            if solution.status != CONVERGED:
                solution = press_points(problem, force, nan, np.zeros(len(start)))
            self._require(solution, points, k, force)
            near = np.zeros(shape[1:])
            near[within] = solution.force
            forces[k], closing[k][within] = near, solution.closing
            approach[k], tangent[k] = solution.approach, solution.tangent
        return MeshCycle(
            mesh_force=force,
            points=points,
            local=local,
            force=forces,
            closing=closing,
            approach=approach,
            tangent_stiffness=tangent,
        )

    def _problem(self, points: ContactPoints, local: LocalContact, k: int, within: Flags) -> ContactProblem:
        """Contact problem of the points within reach at position k."""
        rows, columns = np.nonzero(within)
        face, number = self.grid.position[columns], points.pairs[rows]
        place = points.place
        # pinion teeth that come later stand behind the loaded flank, wheel teeth before it
        compliance = self.gears[0].matrix(place.roll[0][k][within], face, -number)
        compliance = compliance + self.gears[1].matrix(place.roll[1][k][within], face, number)
        weight = points.weight[k][within]
        return ContactProblem(
            np.ascontiguousarray(compliance),
            weight * points.gap[k][within],
            weight,
            np.ascontiguousarray(local.law[k][within]),
        )

    def _require(self, solution: ContactSolution, points: ContactPoints, k: int, force: float) -> None:
        if solution.status != CONVERGED:
            raise DynamicsNotConverged(
                f"contact at position {k} of {len(points.position)} (path {1e3 * points.position[k]:.4f} mm) under "
                f"{force:.4g} N: residual {solution.residual:.1e} after {solution.steps} steps, limit 1e-12: "
                + FAILURES.get(solution.status, "no point can take the force; check gap and reach")
            )


# Load sharing of tooth pairs of which every second one stands ahead by a base pitch deviation: K_Halpha.

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
POSITIONS = 32
"""Of the mesh cycle at which the highest share is looked for; twice as many find the same."""


def every_second_ahead(gap: FlankGap, deviation: float, first: int) -> FlankGap:
    """The gap of flanks [m] whose tooth pairs ``first``, ``first`` + 2, ... stand ahead by a deviation [m]."""

    def of_points(pair: Integers, face: Array, path: Array, rolls: tuple[Array, Array]) -> Array:
        return gap(pair, face, path, rolls) - np.where((pair - first) % 2 == 0, deviation, 0.0)

    return of_points


def transverse_load_factor(mesh: LoadedMesh, ideal: MeshCycle, deviation: float) -> float:
    """K_Halpha: largest force on a tooth pair, each second one ahead, over that of equal pitches, at least 1 [-].

    ideal : cycle of the mesh as it is; deviation : difference of the base pitches of both gears, run in, f_pb - y_alpha
    along the transverse line of action [m]

    The pairs beside the one that is ahead are taken to stand back by all of it: the worst run of pitches that the
    deviation allows. Raises as `LoadedMesh.cycle`.
    Source: definition in ISO 6336-1:2006, 8.1; the deviation is that of its 8.3.2.
    """
    if deviation <= 0.0:
        return 1.0
    return max(
        replace(mesh, gap=every_second_ahead(mesh.gap, deviation, first), n_positions=POSITIONS)
        .cycle(ideal.mesh_force)
        .transverse_load_factor(ideal)
        for first in (0, 1)
    )
