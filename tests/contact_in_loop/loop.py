"""March of an elastic drivetrain with the tooth contact in the loop, in six degrees of freedom.

In every step the contact of each mesh is solved from the influence numbers of its gears at the positions and tilts that
the gears have (`tests.contact_in_loop.integration`): both flanks, loss of contact, tip corners, the load over the face.
Its forces act in the directions in which its motion is seen (`dynamics.rotor.craig_bampton`): each flank along its
own normal, moments over the face, friction across the normals. It is the reference of the faster march on tables
(`dynamics.vibration.time_integration`), which has one approach per mesh on the flank that carries.

What the shafts' mean load tilts is in the flanks' gap already, as the coupling loop has it; the moment of the mean load
over the face is taken out here, so that the tilt is that of the motion.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw, back_deviations
from dynamics.tooth.loaded_mesh import LoadedMesh
from dynamics.vibration.initial_state import WoundLoop
from tests.contact_in_loop.integration import (
    N_RECORD,
    N_ROWS,
    R_ANGLE,
    R_APPROACH,
    R_ENERGY,
    R_FORCE,
    R_MOMENT,
    R_OTHER_FORCE,
    R_SPEED,
    R_TILT,
    LoopedMesh,
    LoopedState,
    PhaseTable,
    looped_march,
)
from tests.contact_in_loop.modes import ModesOverStep
from tests.contact_in_loop.phase_tables import PHASES, phase_table

Array = NDArray[np.float64]

REACH = 2.5
"""Approach up to which points are tabulated, in those under the mean load."""
LEAST_REACH = 20e-6
"""[m]"""
TILTS = (1, 6)
"""Rows of a mesh that see its tilt."""


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshInLoop:
    """A mesh whose contact is solved in the loop.

    contact : the flanks that carry, all teeth alike; of one half of a double-helical mesh
    law : radii, phase, backlash, damping, friction and deviations of single teeth are taken from it
    force : mean transverse mesh force of all halves, positive on the front flanks [N]
    halves : equal contacts that share it, taken at the middle of the mesh
    """

    contact: LoadedMesh
    law: MeshLaw
    force: float
    halves: int = 1

    def __post_init__(self) -> None:
        if not abs(self.force) > 0.0:
            raise DynamicsInputError(
                "mesh in the loop: force = 0 N leaves open which flanks carry; give the mean force"
            )

    def table(self, phases: int = PHASES) -> tuple[PhaseTable, float]:
        """Points of a half over the phase, and the mean moment of the mesh force over the face [N m]."""
        own = abs(self.force) / self.halves
        cycle = self.contact.cycle(own)
        reach = max(REACH * float(cycle.approach.max()), LEAST_REACH)
        load = cycle.points.weight * cycle.force
        moment = float((load * self.contact.grid.position).sum(axis=(1, 2)).mean())
        return phase_table(self.contact, own, reach, phases), self.halves * moment

    def numbers(self, mean_moment: float) -> LoopedMesh:
        """What the kernel asks."""
        law, side = self.law, float(np.sign(self.force))
        first, second = self._deviations(side)
        return LoopedMesh(
            base_radius_1=law.base_radius_1, base_radius_2=law.base_radius_2, offset=law.offset, backlash=law.backlash,
            phase=law.phase, back_phase=law.back_phase, damp_time=law.damping / law.mean_stiffness,
            friction=law.friction, reversal_speed=max(law.friction_reversal_speed, 1e-9), mean_force=abs(self.force),
            halves=float(self.halves), mean_moment=mean_moment, side=side, deviations_1=first, deviations_2=second,
        )  # fmt: skip

    def _deviations(self, side: float) -> tuple[Array, Array]:
        """Mean over the path of what each tooth adds to the gap, by the number of the pair that it comes in with."""
        law = self.law
        shift = law.tooth_offset_2
        if side > 0.0:
            first, second = law.deviation_1, np.roll(law.deviation_2, -shift, axis=0)
        else:
            # on the back the pairs come in from the other side, each pinion tooth with the next wheel tooth
            back_1, back_2 = back_deviations(law)
            first = np.roll(back_1[::-1], 1, axis=0)
            second = np.roll(np.roll(back_2, -shift - 1, axis=0)[::-1], 1, axis=0)
        return np.ascontiguousarray(first.mean(axis=1)), np.ascontiguousarray(second.mean(axis=1))


@dataclass(frozen=True, kw_only=True)
class LoopRecord:
    """Motion of the meshes at the ends of the steps, each (n_meshes, n_steps), as their flanks that carry see it.

    force, other_force : transverse forces of the flanks that carry and of the others, along the line of action [N]
    moment : over the face, without that of the mean load [N m]
    approach : [m]; tilt : by the motion about the mean [rad]
    angle, speed : of the pinions [rad], [rad/s]; energy : stored in the teeth [J]
    """

    force: Array
    other_force: Array
    moment: Array
    approach: Array
    tilt: Array
    angle: Array
    speed: Array
    energy: Array

    @property
    def net_force(self) -> Array:
        """Transverse force of the meshes, flanks that carry less the others (n_meshes, n_steps) [N]."""
        return self.force - self.other_force


class ContactLoop:
    """A drivetrain in motion with its contacts in the loop; carries its state from call to call.

    step : [s]; unconverged : steps whose contacts did not settle
    work : (3,) done by the meshes on the drivetrain, by friction in them and taken by their dampers since the start [J]
    """

    def __init__(
        self,
        system: LinearSystem,
        rows: Array,
        meshes: Sequence[MeshInLoop],
        start: WoundLoop,
        *,
        step: float,
        cutoff: float = 50e3,
        drag_torques: Mapping[str, float] | None = None,
        phases: int = PHASES,
    ) -> None:
        """Prepare the march.

        Parameters
        ----------
        system : drivetrain without its meshes
        rows : (7 n_meshes, n) motion that the meshes see, on the freedoms of the system; rows as `ROWS`
        meshes : in the order of the rows
        start : wound up by its load, in uniform rotation
        step : [s]; cutoff : modes above this frequency [Hz] keep their static effect
        drag_torques : that stay, by name of ``system.drag_loads`` [N m]
        phases : places per base pitch at which the contacts are tabulated

        Raises DynamicsInputError for rows that do not fit or a step that is not positive.
        """
        if rows.shape != (N_ROWS * len(meshes), len(system.inertia)) or not step > 0.0:
            raise DynamicsInputError(
                f"contact loop: rows {rows.shape} must be ({N_ROWS * len(meshes)}, {len(system.inertia)}) and step = "
                f"{step} s above 0"
            )
        self.step, self.unconverged = step, 0
        tabulated = [mesh.table(phases) for mesh in meshes]
        self._tables = tuple(table for table, _ in tabulated)
        self._meshes = tuple(mesh.numbers(moment) for mesh, (_, moment) in zip(meshes, tabulated))
        self._system, self._rows = system, rows
        self._load = system.twist_load * start.state.twist
        for name, torque in (drag_torques or {}).items():
            self._load = self._load + system.drag_loads[name] * torque
        self.drive_torque = start.drive_torque
        self._linear = ModesOverStep(system.form, rows, step, cutoff)
        forces, motion = np.zeros(len(rows)), rows @ start.state.angles
        for number, mesh in enumerate(meshes):
            forces[N_ROWS * number + (0 if mesh.force > 0.0 else 5)] = -abs(mesh.force)
            motion[[N_ROWS * number + tilt for tilt in TILTS]] = 0.0  # the gaps know of the mean tilt
        self._state = LoopedState(
            modes=self._linear.at(system, start.state.angles, start.state.speeds),
            motion=motion,
            forces=np.tile(forces, (3, 1)),
            work=np.zeros(3),
            power=np.full(3, np.nan),
        )

    @property
    def work(self) -> Array:
        """See the class."""
        return self._state.work.copy()

    def kick(self, speeds: Array) -> None:
        """Change all speeds at once by (n,) [rad/s]."""
        self._state.modes[:] += self._linear.kicked(self._system, speeds)

    def advance(self, steps: int, drive_torque: float | None = None) -> LoopRecord:
        """March a number of steps under a motor torque [N m]; that of the start when left out.

        Raises DynamicsNotConverged if the motion leaves the finite numbers.
        """
        load = self._load.copy()
        load[self._system.drive_dof] += self.drive_torque if drive_torque is None else drive_torque
        record = np.empty((len(self._meshes), N_RECORD, steps))
        self.unconverged += looped_march(
            self._meshes, self._tables, self._linear.held(load), self._state, self.step, record
        )
        if not np.all(np.isfinite(record)):
            raise DynamicsNotConverged(
                f"contact in the loop: the motion left the finite numbers within {steps} steps of {self.step:.3g} s; "
                "take a shorter step"
            )
        return LoopRecord(
            force=record[:, R_FORCE], other_force=record[:, R_OTHER_FORCE], moment=record[:, R_MOMENT],
            approach=record[:, R_APPROACH], tilt=record[:, R_TILT], angle=record[:, R_ANGLE], speed=record[:, R_SPEED],
            energy=record[:, R_ENERGY],
        )  # fmt: skip
