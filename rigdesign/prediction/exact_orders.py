"""The motion over the whole hunting cycle, all contacts opening and closing: what the fast way is held to."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.static_loop import port_model
from dynamics.errors import DynamicsNotConverged
from dynamics.mesh.force import evaluate_mesh
from dynamics.mesh.law import MeshLaw
from dynamics.orders.deviation_response import OrderLoads
from dynamics.response.harmonic_walk import mesh_cells
from dynamics.response.periodic_response import TimeSettings, periodic_by_time
from dynamics.response.speed_sweep import SweepSettings, periodic_response
from rigdesign.coupling.braced_loop import LoadedCircuit, signed_torque
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_CELLS = 1000
"""Mesh periods in a cycle up to which the harmonic balance is used; beyond it the loop is marched."""
LONGEST_MARCH = 20.0
"""Simulated time after which a march that does not converge ends [s]."""


@dataclass(frozen=True, kw_only=True)
class ExactMotion:
    """Torques of the meshes over one cycle.

    speed : of the first pinion [rad/s]; turns : of it in the cycle; phi : (n,) its mean angle [rad]
    dofs : (n_bodies,) freedoms of the gears, of ``size`` in all; torque : (n_bodies, n) on them [N m]
    twist [rad], drive [N m]
    """

    speed: float
    turns: float
    phi: Array
    dofs: Integers
    size: int
    torque: Array
    twist: float
    drive: float

    def loads(self, order: float) -> OrderLoads:
        """Loads at an order of the first pinion; zero if the cycle does not hold it."""
        whole = abs(order * self.turns - round(order * self.turns)) < 1e-6
        wave = np.exp(-1j * order * self.phi) / self.phi.size if whole else np.zeros(self.phi.size, complex)
        torque = np.zeros(self.size, complex)
        torque[self.dofs] = self.torque @ wave * (2.0 if order else 1.0)
        return OrderLoads(order=order, omega=order * self.speed, torque=torque)


def exact_motion(
    rig: Rig,
    loop: LoadedCircuit,
    laws: Sequence[MeshLaw],
    *,
    march: bool | None = None,
) -> ExactMotion:
    """Solve over the hunting cycle: harmonic balance up to MOST_CELLS mesh periods, else the march in time.

    laws : of the meshes of ``loop`` as they are braced; march : take the one or the other
    Raises DynamicsNotConverged if neither converges.
    """
    point, setting = loop.point, loop.bracing
    controlled = setting.mode == "torque_controlled"
    torque, twist = (signed_torque(rig, point), None) if controlled else (None, setting.twist)
    speed = rig.pinion_speed(point.speed)
    if march is None:
        march = mesh_cells(port_model(loop.system, laws), "hunting_cycle", 0)[0] > MOST_CELLS
    if not march:
        curve = periodic_response(
            loop.system,
            laws,
            [speed],
            LoopLoad(torque=torque, twist=twist),
            drag_torques=loop.drags,
            settings=SweepSettings(
                period="hunting_cycle", cutoff=rig.highest_mode, methods=("harmonic_balance",)
            ),
        )
        if curve.points:
            found = curve.points[0]
            wave = found.wave
            motion = _MeshMotion(wave.time, wave.angle, wave.approach, wave.omega_1, wave.omega_2)
            return _over_cycle(loop.system, laws, speed, motion, (found.twist, found.drive_torque))
    marched = periodic_by_time(
        loop.system,
        laws,
        speed=speed,
        drag_torques=loop.drags,
        load=LoopLoad(torque=torque, twist=twist),
        settings=TimeSettings(period="hunting_cycle", longest_time=LONGEST_MARCH, cutoff=rig.highest_mode),
    )
    if not marched.steady:
        raise DynamicsNotConverged(
            f"march over the hunting cycle at {point.stage!r}: {'; '.join(marched.warnings)}"
        )
    radius_1, radius_2 = np.array([(law.base_radius_1, law.base_radius_2) for law in laws]).T[..., None]
    omega_2 = (radius_1 * marched.omega_1 - marched.approach_rate) / radius_2
    motion = _MeshMotion(marched.time, marched.angle_1, marched.approach, marched.omega_1, omega_2)
    return _over_cycle(loop.system, laws, speed, motion, (marched.twist, marched.drive_torque))


class _MeshMotion(NamedTuple):
    """Motion of all meshes over one cycle that begins anywhere; time (n,) [s], all others (n_meshes, n)."""

    time: Array
    angle: Array
    """Of the pinion [rad]."""
    approach: Array
    """[m]"""
    omega_1: Array
    """[rad/s]"""
    omega_2: Array


def _over_cycle(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    motion: _MeshMotion,
    held: tuple[float, float],
) -> ExactMotion:
    """Torques on the gear bodies along a motion.

    held : bracing twist [rad] and motor torque [N m]
    """
    torque: dict[int, Array] = {}
    for m, (law, ports) in enumerate(zip(laws, system.mesh_ports.tolist())):
        reaction = evaluate_mesh(law, *(values[m] for values in motion[1:]))
        for dof, wave in zip(ports, (reaction.torque_1, reaction.torque_2)):
            torque[dof] = torque[dof] + wave if dof in torque else wave
    time = motion.time
    start = float(np.mean(motion.angle[0] - speed * time))
    step = float(time[1] - time[0])
    return ExactMotion(
        speed=speed, turns=speed * step * time.size / (2.0 * pi), phi=start + speed * time,
        dofs=np.array(list(torque), np.int64), size=len(system.inertia), torque=np.array(list(torque.values())),
        twist=held[0], drive=held[1],
    )  # fmt: skip
