"""The loop seen from its meshes: stiffness reduced to the mesh bodies, and the quasi-static state over
rotation.

Rotating slowly, the loop finds at every angle the windup of its shafts that balances the tooth forces. The
reduced stiffness, the bracing twist and the drag torques are also the constant part of the harmonic balance.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import PackedMeshes, evaluate_mesh, pack_meshes
from dynamics.tooth.packed_laws import undamped

# What loads the closed power loop: a torque that one mesh shall carry, or the twist of the bracing that is held.


@dataclass(frozen=True, kw_only=True)
class LoopLoad:
    """Load of the loop; exactly one of torque and twist is given.

    torque : mean torque at the pinion of ``control_mesh``, negative on the back flank [N m]; the bracing twist that
        makes it is solved along
    twist : bracing twist that is held [rad]; the torque follows
    control_mesh : index of the mesh whose torque is meant

    Raises DynamicsInputError if both or neither are given.
    """

    torque: float | None = None
    twist: float | None = None
    control_mesh: int = 0

    def __post_init__(self) -> None:
        if (self.torque is None) == (self.twist is None):
            raise DynamicsInputError(
                "give either the torque or the twist of the loop, not both and not neither"
            )


Array = NDArray[np.float64]

TRACE = 1e-3
"""Share of its mean stiffness that a mesh keeps in Newton's method where its flanks stand apart."""


@dataclass(frozen=True, kw_only=True)
class PortModel:
    """Loop reduced to its ports: the gear bodies that mesh, each once, and, last, the drive freedom.

    An idler is one port with the torques of two meshes.

    dofs : (n,) freedom of every port; n = number of gear bodies + 1
    pinions, wheels : (n_meshes,) ports of each mesh
    stiffness : (n, n) [N m/rad]; twist : (n,) torque per bracing twist [N m/rad]
    drag_per_speed : (n,) torque of linear drag per reference speed [N m s/rad], negative
    drags : name -> (n,) reduced share of a drag load
    approach : (n_meshes, n) approach per port angle [m/rad]
    ratios : (n,) speed of every port relative to the drive freedom
    packed : law tables of every mesh; elastic : the same without damping, whose force jumps at first touch
    base_radii : (n_meshes, 2) [m]; offsets : (n_meshes,) [m]
    loads : (n_inputs, n_freedoms) rows of the system on which the meshes act: gear bodies, then friction of pinion and
        wheel beside the ports, mesh by mesh (`MeshWrench.friction_rows`), which is none where gears only rotate
    at_rest : (n, n_inputs) port torques that unit torques on these rows are at rest
    path_shares : (n_meshes, 2) torque on friction rows per path torque on the pinion less that torque
    """

    dofs: NDArray[np.int64]
    pinions: NDArray[np.int64]
    wheels: NDArray[np.int64]
    stiffness: Array
    twist: Array
    drag_per_speed: Array
    drags: Mapping[str, Array]
    approach: Array
    ratios: Array
    packed: tuple[PackedMeshes, ...]
    elastic: tuple[PackedMeshes, ...]
    laws: tuple[MeshLaw, ...]
    base_radii: Array
    offsets: Array
    loads: Array
    at_rest: Array
    path_shares: Array

    @property
    def n_meshes(self) -> int:
        """Number of meshes."""
        return len(self.laws)

    @property
    def n_bodies(self) -> int:
        """Number of gear bodies that mesh."""
        return self.dofs.size - 1

    def drag(self, speed: float, torques: Mapping[str, float] | None) -> Array:
        """Drag torques on the ports (n,) at a reference speed [rad/s]: linear drag and named torques."""
        load = self.drag_per_speed * speed
        for name, torque in (torques or {}).items():
            if name not in self.drags:
                raise DynamicsInputError(
                    f"drag torque {name!r} has no place in the drivetrain: known are {', '.join(self.drags)}"
                )
            load = load + self.drags[name] * torque
        return load


def line_ratios(system: LinearSystem, laws: Sequence[MeshLaw]) -> Array:
    """Speed of every freedom relative to the drive freedom (n,) [-]: the rigid motion in which all meshes roll.

    Raises DynamicsInputError if a line is joined to the drive by no mesh.
    """
    rigid = system.rigid
    rows = [rigid[system.drive_dof]]
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        rows.append(rigid[pinion] - law.base_radius_2 / law.base_radius_1 * rigid[wheel])
    shares, _, rank, _ = np.linalg.lstsq(np.array(rows), np.eye(1, len(rows))[0], rcond=1e-9)
    if rank < rigid.shape[1]:
        still = rigid @ scipy.linalg.null_space(np.array(rows), rcond=1e-9)[:, 0]
        raise DynamicsInputError(
            f"the line of {system.dofs[int(np.argmax(np.abs(still)))]} is joined to the drive by no mesh; every line "
            "must turn with it"
        )
    return np.asarray(rigid @ shares)


def port_model(system: LinearSystem, laws: Sequence[MeshLaw]) -> PortModel:
    """Reduce the stiffness of a system statically to its mesh ports and its drive freedom.

    Raises DynamicsInputError if the number of laws is not the number of meshes.
    """
    if len(laws) != len(system.mesh_ports):
        raise DynamicsInputError(
            f"{len(laws)} mesh laws for {len(system.mesh_ports)} meshes: give one per mesh, in order"
        )
    bodies = np.array(list(dict.fromkeys(system.mesh_ports.ravel().tolist())), dtype=np.int64)
    port = {int(dof): i for i, dof in enumerate(bodies)}
    pinions, wheels = (
        np.array([port[int(dof)] for dof in side], dtype=np.int64) for side in system.mesh_ports.T
    )
    kept = np.append(bodies, system.drive_dof)
    if system.drive_dof in bodies:
        raise DynamicsInputError(
            "the motor acts on a gear body that also meshes: place it on a shaft station"
        )
    inner = np.setdiff1d(np.arange(len(system.inertia)), kept)
    coupling = system.stiffness[np.ix_(kept, inner)]
    carry = np.linalg.solve(system.stiffness[np.ix_(inner, inner)].T, coupling.T).T
    ratios = line_ratios(system, laws)

    def reduce(load: Array) -> Array:
        return np.asarray(load[kept] - carry @ load[inner])

    approach = np.zeros((len(laws), kept.size))
    for m, law in enumerate(laws):
        approach[m, pinions[m]], approach[m, wheels[m]] = law.base_radius_1, -law.base_radius_2
    packed = tuple(pack_meshes([law]) for law in laws)
    wrench = system.mesh_wrench
    loads = np.eye(len(system.inertia))[bodies]
    if wrench is not None:
        loads = np.vstack([loads, wrench.friction_rows(laws)])
    return PortModel(
        dofs=kept,
        pinions=pinions,
        wheels=wheels,
        stiffness=system.stiffness[np.ix_(kept, kept)] - carry @ system.stiffness[np.ix_(inner, kept)],
        twist=reduce(system.twist_load),
        drag_per_speed=reduce(-system.damping @ ratios),
        drags={name: reduce(load) for name, load in system.drag_loads.items()},
        approach=approach,
        ratios=ratios[kept],
        packed=packed,
        elastic=tuple(undamped(tables) for tables in packed),
        laws=tuple(laws),
        base_radii=np.array([(law.base_radius_1, law.base_radius_2) for law in laws]),
        offsets=np.array([law.offset for law in laws]),
        loads=loads,
        at_rest=np.array([reduce(row) for row in loads]).T,
        path_shares=np.zeros((len(laws), 2)) if wrench is None else wrench.numbers(laws)[:, 1:3],
    )


@dataclass(frozen=True, kw_only=True)
class StaticState:
    """Quasi-static state of the loop over some angles of rotation.

    twist : bracing twist [rad]; angles : (n_angles,) rotation of the drive freedom [rad]
    ports : (n_angles, n) windup of the ports against the rigid rotation of the held one [rad]
    torque : (n_angles, n_meshes) torque transmitted at the pinion, positive on the front flank [N m]
    drive : (n_angles,) drive torque that balances friction and drag [N m]
    """

    twist: float
    angles: Array
    ports: Array
    torque: Array
    drive: Array
    approach: Array

    @property
    def mean_torque(self) -> Array:
        """Mean torque of every mesh at its pinion (n_meshes,) [N m]."""
        return np.asarray(self.torque.mean(axis=0))


def mesh_angles(model: PortModel, count: int = 32) -> Array:
    """Angles of the drive freedom over one period of the first mesh (count,) [rad]."""
    law = model.laws[0]
    return np.asarray(np.arange(count) / count * (2.0 * np.pi / law.teeth_1 / float(model.ratios[0])), float)


@dataclass(frozen=True, kw_only=True)
class SlowRotation:
    """Rotation so slow that no inertia acts.

    angles : (n_angles,) of the port that turns [rad]; None: 32 over one period of the first mesh
    speed : of the drive freedom, gives friction and linear drag their direction [rad/s]; 0 leaves both out
    drag_torques : by name of ``PortModel.drags`` [N m]
    port : port that turns by ``angles`` without windup: the drive freedom, last of all, or a pinion.
        Behind a soft motor shaft a mesh may step over the pitch point, where friction
        reverses, and no state exists for some angles of the drive; it does for the angles of a pinion
    """

    angles: Array | None = None
    speed: float = 0.0
    drag_torques: Mapping[str, float] | None = None
    port: int = -1


AT_REST = SlowRotation()
"""Over one period of the first mesh without friction and drag torques."""


def solve_static(
    model: PortModel, load: LoopLoad, rotation: SlowRotation = AT_REST, start: StaticState | None = None
) -> StaticState:
    """Quasi-static state for a held twist, or the twist for a given mean torque of one mesh.

    Parameters
    ----------
    model : loop reduced to its mesh ports
    load : torque of a mesh or bracing twist
    rotation : angles at which the state is wanted, and what brakes there
    start : state to start from, at as many angles; default: springs in place of the meshes

    Raises
    ------
    DynamicsInputError
        For a drag torque without a place in the drivetrain.
    DynamicsNotConverged
        If Newton's method does not converge, for instance because the twist leaves the flanks open.
    """
    torque, twist, control_mesh = load.torque, load.twist, load.control_mesh
    speed, port = rotation.speed, rotation.port
    where = mesh_angles(model) if rotation.angles is None else rotation.angles
    drag = model.drag(speed, rotation.drag_torques)
    if start is None:
        u, phi = _bilateral(model, torque, twist, control_mesh)
        u = np.tile(u, (where.size, 1))
        drive = np.zeros(where.size)
    else:
        u, phi, drive = start.ports.copy(), start.twist if twist is None else twist, start.drive.copy()
    n, ref = model.ratios.size, model.ratios.size - 1
    unit = np.zeros(n)
    unit[ref] = 1.0
    scale = abs(torque) if torque else float(np.max(np.abs(model.twist))) * max(abs(phi), 1e-6)
    previous, damp = np.inf, 1.0
    step: tuple[Array, Array, float] = (np.zeros_like(u), np.zeros(where.size), 0.0)
    for _ in range(80):
        tau, tangents, pinion_slopes, transmitted = _reactions(model, u, where, speed)
        residual = u @ model.stiffness.T - tau - model.twist * phi - drag - drive[:, None] * unit
        miss = 0.0 if torque is None else torque - float(transmitted[:, control_mesh].mean())
        error = max(float(np.max(np.abs(residual))), abs(miss))
        # a loop that a shift braces carries torque with hardly any twist
        limit = 1e-10 * max(scale, float(np.max(np.abs(transmitted)))) + _round_off(model, u, phi)
        if error < limit:
            return StaticState(
                twist=float(phi), angles=where, ports=u, torque=transmitted, drive=drive,
                approach=u @ model.approach.T + model.offsets,
            )  # fmt: skip
        if error > 2.0 * previous and damp > 1.0 / 64.0:
            damp *= 0.5
            u, drive, phi = u - damp * step[0], drive - damp * step[1], phi - damp * step[2]
            continue
        previous, damp = error, 1.0
        jacobian = np.zeros((where.size, n + 1, n + 1))
        jacobian[:, :n, :n] = model.stiffness - tangents
        jacobian[:, ref, n] = -1.0
        jacobian[:, n, port % n] = 1.0
        right = np.zeros((where.size, n + 1, 2))
        right[:, :n, 0] = -residual
        right[:, n, 0] = -u[:, port]
        right[:, :n, 1] = model.twist
        try:
            moves = np.asarray(np.linalg.solve(jacobian, right), float)
        except np.linalg.LinAlgError:
            break
        d_phi = 0.0
        if torque is not None:
            gain = _transmitted_change(pinion_slopes, moves[:, :n, :], control_mesh)
            if gain[1] == 0.0:
                break
            d_phi = (miss - gain[0]) / gain[1]
        move = moves[:, :, 0] + d_phi * moves[:, :, 1]
        step = (move[:, :n], move[:, n], d_phi)
        u, drive, phi = u + step[0], drive + step[1], phi + step[2]
    raise DynamicsNotConverged(
        f"static loop: {error:.2g} N m are left unbalanced at a torque of {scale:.3g} N m, limit {limit:.1g} N m: "
        "the twist leaves the flanks open or the torque is below the friction; raise the twist or the torque"
    )


def _round_off(model: PortModel, u: Array, twist: float) -> float:
    """Torque that the last digits of windups, twist and approaches make [N m]."""
    windup = np.abs(u).max(axis=0)
    reach = np.abs(model.approach) @ windup + np.abs(model.offsets)
    tooth = max(law.mean_stiffness * law.base_radius_1 * x for law, x in zip(model.laws, reach))
    size = max(
        float((np.abs(model.stiffness) @ windup).max()), float(np.abs(model.twist * twist).max()), tooth
    )
    return 16.0 * float(np.finfo(float).eps) * float(size)


def _transmitted_change(pinion_slopes: Array, moves: Array, mesh: int) -> Array:
    """Mean change of the torque transmitted by one mesh for each column of moves (n_angles, n, columns)."""
    row = pinion_slopes[:, mesh, :]
    return np.asarray(-np.einsum("aj,ajc->c", row, moves) / len(row))


def _reactions(model: PortModel, u: Array, angles: Array, speed: float) -> tuple[Array, Array, Array, Array]:
    """Port torques (n_angles, n), their derivatives over the windup (n_angles, n, n), those of each mesh at its own
    pinion (n_angles, n_meshes, n), transmitted torques (n_angles, n_meshes).

    The derivatives keep a trace of stiffness where the flanks stand apart, so that Newton's method closes them."""
    tau = np.zeros_like(u)
    tangents = np.zeros((*u.shape, u.shape[1]))
    pinion_slopes = np.zeros((u.shape[0], model.n_meshes, u.shape[1]))
    transmitted = np.empty((u.shape[0], model.n_meshes))
    reach = u @ model.approach.T + model.offsets
    for m, packed in enumerate(model.elastic):
        p, w = int(model.pinions[m]), int(model.wheels[m])
        ratio_1, ratio_2 = model.ratios[p], model.ratios[w]
        reaction = evaluate_mesh(
            packed, ratio_1 * angles + u[:, p], reach[:, m], ratio_1 * speed, ratio_2 * speed
        )
        tau[:, p] += reaction.torque_1
        tau[:, w] += reaction.torque_2
        radius_1, radius_2 = model.base_radii[m]
        apart = np.maximum(
            TRACE * model.laws[m].mean_stiffness - reaction.torque_2_per_approach / radius_2, 0.0
        )
        pinion_slopes[:, m] = (reaction.torque_1_per_approach - apart * radius_1)[:, None] * model.approach[m]
        pinion_slopes[:, m, p] += reaction.torque_1_per_angle
        tangents[:, p] += pinion_slopes[:, m]
        tangents[:, w] += (reaction.torque_2_per_approach + apart * radius_2)[:, None] * model.approach[m]
        tangents[:, w, p] += reaction.torque_2_per_angle
        transmitted[:, m] = radius_1 * (reaction.force_front - reaction.force_back)
    return tau, tangents, pinion_slopes, transmitted


def _bilateral(
    model: PortModel, torque: float | None, twist: float | None, control_mesh: int
) -> tuple[Array, float]:
    """Windup and twist with springs for meshes: first to learn which flanks carry, then from those flanks."""
    n, ref = model.ratios.size, model.ratios.size - 1
    stiffness = np.array([law.mean_stiffness for law in model.laws])
    flank = np.zeros(model.n_meshes)
    u, phi = np.zeros(n), 0.0
    for _ in range(2):
        # unknowns: windup, drive torque, twist
        matrix = np.zeros((n + 2, n + 2))
        matrix[:n, :n] = model.stiffness + (model.approach.T * stiffness) @ model.approach
        matrix[ref, n] = -1.0
        matrix[n, ref] = 1.0
        matrix[:n, n + 1] = -model.twist
        right = np.zeros(n + 2)
        right[:n] = -(model.approach.T * stiffness) @ (model.offsets - flank)
        if torque is None:
            matrix[n + 1, n + 1], right[n + 1] = 1.0, twist or 0.0
        else:
            lever = model.base_radii[control_mesh, 0] * stiffness[control_mesh]
            matrix[n + 1, :n] = lever * model.approach[control_mesh]
            right[n + 1] = torque - lever * (model.offsets - flank)[control_mesh]
        scale = np.maximum(np.abs(matrix).max(axis=1), 1e-300)
        solution = np.linalg.solve(matrix / scale[:, None], right / scale)
        u, phi = solution[:n], float(solution[n + 1])
        reach = model.approach @ u + model.offsets - flank
        flank = np.array(
            [
                float(law.gap.min()) if x >= 0.0 else -law.backlash - float(law.gap.min())
                for x, law in zip(reach, model.laws)
            ]
        )
    return u, phi


def loaded_share(model: PortModel, torque: float, twist: float, control_mesh: int = 0) -> float:
    """Share of a torque [N m] that a twist [rad] makes with springs for meshes; below 0 the flanks stand apart."""
    touching, loaded = (_bilateral(model, share * torque, None, control_mesh)[1] for share in (1e-6, 1.0))
    return (twist - touching) / (loaded - touching)
