"""Initial state of a time run: rigid rotation of the drivetrain, wound up by the torque that the loop carries."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import line_ratios
from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.mesh.force import evaluate_mesh, pack_meshes
from dynamics.mesh.law import MeshLaw
from dynamics.response.march_inputs import DriveState

Array = NDArray[np.float64]


def pinion_ratios(system: LinearSystem, laws: Sequence[MeshLaw]) -> Array:
    """Return the speed of every freedom per speed of the pinion of the first mesh, shape (n,) [-].

    Raises DynamicsInputError if a mesh closes a loop with another ratio or a line is reached by no mesh.
    """
    ratios = line_ratios(system, laws)
    for mesh, (law, (pinion, wheel)) in enumerate(zip(laws, system.mesh_ports)):
        slip = ratios[pinion] * law.base_radius_1 - ratios[wheel] * law.base_radius_2
        if abs(slip) > 1e-9 * abs(ratios[pinion] * law.base_radius_1):
            raise DynamicsInputError(
                f"mesh {mesh} cannot turn with the others: r_b1 omega_1 - r_b2 omega_2 = {slip:.3e} m/s "
                "per rad/s of the drive, limit 0; correct tooth numbers or base radii"
            )
    scaled: Array = ratios / ratios[system.mesh_ports[0, 0]]
    return scaled


class WoundLoop(NamedTuple):
    """Initial state of a time run."""

    state: DriveState
    drive_torque: float
    """Of the motor, balances linear damping and drag torques [N m]."""
    loop_stiffness: float
    """Change of the torque of the first mesh per twist [N m/rad]."""


def wound_state(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    load: LoopLoad,
    drag_torques: Mapping[str, float] | None = None,
    outer: Array | None = None,
) -> WoundLoop:
    """Rigid rotation, wound up by the load of the loop.

    Newton's method on windup, motor torque and twist with the contacts at the angle 0, tooth friction left out.

    Parameters
    ----------
    speed : of the pinion of the first mesh [rad/s]
    load : torque of the first mesh, or bracing twist
    drag_torques : by name of ``system.drag_loads`` [N m]
    outer : (n,) further load on each freedom, none when left out

    Raises
    ------
    DynamicsInputError
        If the load is that of another mesh, the lines cannot turn together, or the bracing does not load the first
        mesh.
    DynamicsNotConverged
        If the static state is not found, for instance because the twist leaves the flanks open.
    """
    if load.control_mesh != 0:
        raise DynamicsInputError(
            f"control_mesh = {load.control_mesh}: time integration controls mesh 0; use harmonic balance alone"
        )
    ratios = pinion_ratios(system, laws)
    braked = sum(
        (value * system.drag_loads[name] for name, value in (drag_torques or {}).items()),
        np.zeros(len(ratios)),
    )
    winding = _Winding(system, laws, ratios, speed, braked if outer is None else braked + outer)
    unknowns = winding.solve(load.torque, load.twist)
    n = len(system.inertia)
    state = DriveState(angles=unknowns[:n], speeds=speed * ratios, twist=float(unknowns[n + 1]))
    return WoundLoop(state, float(unknowns[n]), winding.loop_stiffness(unknowns))


class _Winding:
    """Static equilibrium in (angles, motor torque, twist) with the pinion of the first mesh held at angle 0."""

    def __init__(
        self,
        system: LinearSystem,
        laws: Sequence[MeshLaw],
        ratios: Array,
        speed: float,
        load: Array,
    ) -> None:
        self._laws = [law._replace(friction=0.0, damping=0.0) for law in laws]
        self._packed = [pack_meshes([law]) for law in self._laws]
        n = len(system.inertia)
        self._n = n
        self._approach = np.zeros((len(laws), n))
        for row, law, (pinion, wheel) in zip(self._approach, laws, system.mesh_ports):
            row[pinion], row[wheel] = law.base_radius_1, -law.base_radius_2
        self._load = load - system.damping @ (speed * ratios)
        self._linear = np.zeros((n + 2, n + 2))
        self._linear[:n, :n] = system.stiffness
        self._linear[system.drive_dof, n] = -1.0
        self._linear[:n, n + 1] = -system.twist_load
        self._linear[n, system.mesh_ports[0, 0]] = 1.0

    def solve(self, torque: float | None, twist: float | None) -> Array:
        """Return the unknowns for a torque or a twist, Newton from the solution with springs in both directions."""
        force, stiffness = np.zeros(len(self._laws)), np.array([law.mean_stiffness for law in self._laws])
        reach = np.zeros(len(self._laws))
        scale = 0.0
        for _ in range(60):
            unknowns = self._step(force - stiffness * reach, stiffness, torque, twist)
            asked = self._approach @ unknowns[: self._n]
            if scale == 0.0:
                # the first solution tells which flank carries what; start each contact at that force
                wanted = stiffness * asked
                reach = np.array([self._reach(mesh, f) for mesh, f in enumerate(wanted)])
                scale = max(float(np.abs(wanted).max()), 1e-12 * float(stiffness.max()))
            else:
                if np.abs(asked - reach).max() * float(stiffness.max()) < 1e-9 * scale:
                    return unknowns
                step = asked - reach
                limit = 20.0 * scale / stiffness
                reach = reach + np.clip(step, -limit, limit)
            force, stiffness = self._contact(reach)
        raise DynamicsNotConverged(
            "static state: contact forces still change by "
            f"{np.abs(asked - reach).max() * stiffness.max() / scale:.1e} of the largest, limit 1e-9; "
            "the twist leaves the flanks open: raise twist or torque"
        )

    def loop_stiffness(self, unknowns: Array) -> float:
        """Return d (torque of the first mesh) / d twist at a solution [N m/rad]."""
        reach = self._approach @ unknowns[: self._n]
        _, stiffness = self._contact(reach)
        change = self._step(np.zeros(len(reach)), stiffness, None, 1.0, unloaded=True)
        return float(self._laws[0].base_radius_1 * stiffness[0] * (self._approach[0] @ change[: self._n]))

    def _step(
        self,
        preload: Array,
        stiffness: Array,
        torque: float | None,
        twist: float | None,
        *,
        unloaded: bool = False,
    ) -> Array:
        """Solve with contact forces ``preload + stiffness * approach``."""
        n = self._n
        matrix, right = self._linear.copy(), np.zeros(n + 2)
        matrix[:n, :n] += self._approach.T @ (stiffness[:, None] * self._approach)
        right[:n] = -self._approach.T @ preload + (0.0 if unloaded else self._load)
        if twist is not None:
            matrix[n + 1, n + 1], right[n + 1] = 1.0, twist
        else:
            assert torque is not None
            radius = self._laws[0].base_radius_1
            matrix[n + 1, :n] = stiffness[0] * self._approach[0]
            right[n + 1] = torque / radius - preload[0]
        try:
            solution = np.asarray(np.linalg.solve(matrix, right), float)
        except np.linalg.LinAlgError:
            raise DynamicsInputError(
                "the bracing twist does not load the first mesh; give a twist_load that winds it"
            ) from None
        return solution

    def _contact(self, reach: Array) -> tuple[Array, Array]:
        """Return force and stiffness of every mesh; an open one keeps a trace of stiffness so that Newton moves it."""
        force, stiffness = np.zeros(len(reach)), np.zeros(len(reach))
        for mesh, (law, x) in enumerate(zip(self._laws, reach)):
            reaction = evaluate_mesh(self._packed[mesh], 0.0, x + law.offset, 0.0, 0.0)
            force[mesh] = reaction.force_front[0] - reaction.force_back[0]
            tangent = reaction.torque_2_per_approach[0] / law.base_radius_2
            stiffness[mesh] = max(tangent, 1e-3 * law.mean_stiffness)
        return force, stiffness

    def _reach(self, mesh: int, force: float) -> float:
        """Approach at which a mesh carries ``force``, by bisection between both flanks."""
        law = self._laws[mesh]
        spread = float(law.gap.max() + law.deviation_1.max() + law.deviation_2.max())
        spread += 20.0 * abs(force) / law.mean_stiffness
        low, high = -law.offset - law.backlash - spread, -law.offset + spread
        for _ in range(100):
            middle = 0.5 * (low + high)
            reaction = evaluate_mesh(self._packed[mesh], 0.0, middle + law.offset, 0.0, 0.0)
            if reaction.force_front[0] - reaction.force_back[0] < force:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)
