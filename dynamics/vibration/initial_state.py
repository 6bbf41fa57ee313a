"""Initial state of a time run: rigid rotation of the drivetrain, wound up by the torque that the loop carries."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import TRACE, LoopLoad, line_ratios
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh, pack_meshes
from dynamics.vibration.march_inputs import DriveState

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
    load_now = braked - system.damping @ (speed * ratios)
    winding = _Winding(system, laws, load_now if outer is None else load_now + outer)
    reach, twist = winding.solve(load.torque, load.twist)
    angles, drive = winding.freedoms(reach, twist)
    state = DriveState(angles=angles, speeds=speed * ratios, twist=twist)
    return WoundLoop(state, drive, winding.loop_stiffness(reach))


class _Winding:
    """Static equilibrium with the pinion of the first mesh held at angle 0, reduced to approaches and twist.

    The system is solved once, with springs for meshes and every freedom in units of its own stiffness. Newton's method
    is left with one row a mesh, ``approach = rest + compliance @ (force - spring * approach) + per_twist * twist``: its
    convergence does not depend on number and order of the freedoms.
    """

    def __init__(self, system: LinearSystem, laws: Sequence[MeshLaw], load: Array) -> None:
        self._laws = [law._replace(friction=0.0, damping=0.0) for law in laws]
        self._packed = [pack_meshes([law]) for law in self._laws]
        self._spring = np.array([law.mean_stiffness for law in laws])
        n, fixed = len(system.inertia), system.mesh_ports[0, 0]
        ports = np.zeros((len(laws), n + 1))
        for row, law, (pinion, wheel) in zip(ports, laws, system.mesh_ports):
            row[pinion], row[wheel] = law.base_radius_1, -law.base_radius_2
        matrix, right = np.zeros((n + 1, n + 1)), np.zeros((n + 1, len(laws) + 2))
        matrix[:n, :n] = system.stiffness
        matrix += ports.T @ (self._spring[:, None] * ports)
        unit = 1.0 / np.sqrt(np.abs(np.diag(matrix)[:n]))
        rows, columns = np.append(unit, 1.0 / unit[fixed]), np.append(unit, 1.0 / unit[system.drive_dof])
        # the last unknown is the motor torque, the last row holds the pinion
        matrix[system.drive_dof, n], matrix[n, fixed] = -1.0, 1.0
        right[:n, 0], right[:, 1:-1], right[:n, -1] = load, -ports.T, system.twist_load
        scaled = np.linalg.solve(rows[:, None] * matrix * columns, rows[:, None] * right)
        self._shares = columns[:, None] * scaled
        reach = ports @ self._shares
        self._rest, self._compliance, self._per_twist = reach[:, 0], reach[:, 1:-1], reach[:, -1]

    def solve(self, torque: float | None, twist: float | None) -> tuple[Array, float]:
        """Return approaches [m] and twist [rad] for a torque or a twist, Newton from springs in both directions."""
        spring = self._spring
        wanted, _ = self._step(np.zeros(len(spring)), spring, torque, twist)
        # the springs tell which flank carries what; start each contact at that force
        wanted *= spring
        scale = max(float(np.abs(wanted).max()), 1e-12 * float(spring.max()))
        reach = np.array([self._reach(mesh, f) for mesh, f in enumerate(wanted)])
        for _ in range(60):
            force, stiffness = self._contact(reach)
            asked, turned = self._step(force - stiffness * reach, stiffness, torque, twist)
            change = float(np.abs(asked - reach).max() * spring.max())
            limit = 1e-9 * scale + self._round_off(reach, force, turned)
            if change < limit:
                return asked, turned
            step = 20.0 * scale / stiffness
            reach = reach + np.clip(asked - reach, -step, step)
        raise DynamicsNotConverged(
            f"static state: tooth forces still change by {change:.2g} N after 60 steps, the largest is {scale:.3g} N, "
            f"limit {limit:.1g} N; where a flank stands open raise twist or torque"
        )

    def freedoms(self, reach: Array, twist: float) -> tuple[Array, float]:
        """Return the angles (n,) [rad] and the motor torque [N m] of a solution."""
        force = self._contact(reach)[0] - self._spring * reach
        unknowns = self._shares @ np.concatenate([[1.0], force, [twist]])
        return unknowns[:-1], float(unknowns[-1])

    def loop_stiffness(self, reach: Array) -> float:
        """Return d (torque of the first mesh) / d twist at a solution [N m/rad]."""
        _, stiffness = self._contact(reach)
        follow = np.eye(len(reach)) - self._compliance * (stiffness - self._spring)
        change = np.linalg.solve(follow, self._per_twist)
        return float(self._laws[0].base_radius_1 * stiffness[0] * change[0])

    def _step(
        self, preload: Array, stiffness: Array, torque: float | None, twist: float | None
    ) -> tuple[Array, float]:
        """Return approaches and twist with contact forces ``preload + stiffness * approach``."""
        n, turn = len(preload), float(np.abs(self._per_twist).max())
        matrix, right = np.eye(n + 1), np.zeros(n + 1)
        matrix[:n, :n] -= self._compliance * (stiffness - self._spring)
        right[:n] = self._rest + self._compliance @ preload
        matrix[:n, n] = -self._per_twist / (turn or 1.0)
        if twist is not None:
            right[n] = twist * (turn or 1.0)
        else:
            assert torque is not None
            matrix[n] = np.eye(1, n + 1)[0]
            right[n] = (torque / self._laws[0].base_radius_1 - preload[0]) / stiffness[0]
            if np.linalg.cond(matrix) > 1e12:
                raise DynamicsInputError(
                    "the bracing twist does not load the first mesh; twist a coupling between its shafts"
                )
        solution = np.asarray(np.linalg.solve(matrix, right), float)
        return solution[:n], float(solution[n] / (turn or 1.0))

    def _round_off(self, reach: Array, force: Array, twist: float) -> float:
        """Tooth force that a few last digits of the sums behind an approach make [N]."""
        sums = np.abs(self._rest) + np.abs(self._compliance) @ np.abs(force - self._spring * reach)
        sums += np.abs(self._per_twist * twist) + np.abs(reach) + [abs(law.offset) for law in self._laws]
        return 16.0 * float(np.finfo(float).eps * sums.max() * self._spring.max())

    def _contact(self, reach: Array) -> tuple[Array, Array]:
        """Return force and stiffness of every mesh; an open one keeps a trace of stiffness so that Newton moves it."""
        force, stiffness = np.zeros(len(reach)), np.zeros(len(reach))
        for mesh, (law, x) in enumerate(zip(self._laws, reach)):
            reaction = evaluate_mesh(self._packed[mesh], 0.0, x + law.offset, 0.0, 0.0)
            force[mesh] = reaction.force_front[0] - reaction.force_back[0]
            tangent = reaction.torque_2_per_approach[0] / law.base_radius_2
            stiffness[mesh] = max(tangent, TRACE * law.mean_stiffness)
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
