"""Where a time run starts: the drivetrain turning rigidly, wound up by the torque that the loop carries."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.linear_system import LinearSystem
from dynamics.mesh_law import MeshLaw
from dynamics.static_loop import line_ratios, port_model, solve_static
from dynamics.time_march import DriveState

Array = NDArray[np.float64]


def pinion_ratios(system: LinearSystem, laws: Sequence[MeshLaw]) -> Array:
    """Return the speed of every freedom per speed of the pinion of the first mesh, shape (n,) [-].

    Raises ValueError if a mesh closes a loop with another ratio or a line is reached by no mesh.
    """
    try:
        ratios = line_ratios(system, laws)
    except KeyError as missing:
        raise ValueError(f"line {missing} is joined to the drive by no mesh; every line must turn with it") from None
    for mesh, (law, (pinion, wheel)) in enumerate(zip(laws, system.mesh_ports)):
        slip = ratios[pinion] * law.base_radius_1 - ratios[wheel] * law.base_radius_2
        if abs(slip) > 1e-9 * abs(ratios[pinion] * law.base_radius_1):
            raise ValueError(
                f"mesh {mesh} cannot turn with the others: r_b1 omega_1 - r_b2 omega_2 = {slip:.3e} m/s per rad/s of the "
                "drive, limit 0; correct tooth numbers or base radii"
            )
    scaled: Array = ratios / ratios[system.mesh_ports[0, 0]]
    return scaled


def wound_state(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    *,
    speed: float,
    torque: float | None = None,
    twist: float | None = None,
    drag_torques: Mapping[str, float] | None = None,
) -> tuple[DriveState, float, float]:
    """Return start state, drive torque [N m] and loop stiffness [N m/rad] at a pinion speed [rad/s].

    Either the mean torque of the first mesh [N m] or the bracing twist [rad] is given. The loop stiffness is the
    change of that torque per twist.

    Raises
    ------
    ValueError
        If neither or both are given, or the lines cannot turn together.
    NotConverged
        If the static state is not found.
    """
    ratios = pinion_ratios(system, laws)
    elastic = [law._replace(damping=0.0) for law in laws]
    model = port_model(system, elastic)
    turning = speed * ratios[system.drive_dof]
    one = np.zeros(1)
    static = solve_static(
        model, torque=torque, twist=twist, angles=one, speed=turning, drag_torques=drag_torques
    )  # fmt: skip
    change = 1e-3 * abs(static.twist) if static.twist else 1e-6
    nearby = solve_static(
        model, twist=static.twist + change, angles=one, speed=turning, drag_torques=drag_torques, start=static
    )
    stiffness = float(nearby.torque[0, 0] - static.torque[0, 0]) / change
    kept = model.dofs
    inner = np.setdiff1d(np.arange(len(system.inertia)), kept)
    load = system.twist_load * static.twist - system.damping @ (speed * ratios)
    for name, value in (drag_torques or {}).items():
        load = load + system.drag_loads[name] * value
    angles = np.zeros(len(system.inertia))
    angles[kept] = static.ports[0]
    held = system.stiffness[np.ix_(inner, kept)] @ angles[kept]
    angles[inner] = np.linalg.solve(system.stiffness[np.ix_(inner, inner)], load[inner] - held)
    state = DriveState(angles=angles, speeds=speed * ratios, twist=static.twist)
    return state, float(static.drive[0]), stiffness
