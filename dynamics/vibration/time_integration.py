"""A drivetrain in motion: modal state, gear contacts and accounts that are carried from call to call.

``TimeMarch`` advances a ``DriveState`` in blocks and keeps the work done by
each slow input and the losses of meshes and joints, so that drive torque and losses are known from two sides.
"""

from collections.abc import Sequence
from math import gcd

import numpy as np
from numpy.typing import NDArray

from dynamics import kernels
from dynamics.errors import DynamicsNotConverged
from dynamics.kernels.contact_table import V_BODY
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import TableReaction, evaluate_table
from dynamics.vibration.march_inputs import Accounts as Accounts
from dynamics.vibration.march_inputs import Block as Block
from dynamics.vibration.march_inputs import (
    DragTables,
    DriveLoads,
    DriveState,
    FollowingLoads,
    MarchSettings,
    MarchTables,
    SpeedControl,
    TorqueControl,
    drag_loads,
    drag_places,
    fade,
    march_model,
    mean_shift,
    slow_loads,
)
from dynamics.vibration.modal_model import ModalModel
from dynamics.vibration.propagator import (
    StateReader,
    discretise,
    modal_state,
    parted_flanks,
    scaled_state,
    wrench_inputs,
)

Array = NDArray[np.float64]

CREEP_SHARE = 1e-3
"""Share of the highest speed of a drag table below which its torque goes smoothly through zero [-]."""
SEGMENT = 1000
"""Samples after which the contact tables are those of the speed that has come."""
BESIDE_EVERY = 2
"""Steps in which tooth forces beside the line of action are linear at most; accounts see them in every step."""
NO_LOADS = DriveLoads()


class MarchDiverged(DynamicsNotConverged):
    """A march left the finite numbers; the message names mesh, time, speed and the slowest mode."""


class TimeMarch:
    """A drivetrain that is advanced in time; the only object of the dynamics that changes.

    Slow inputs, linear over a sample, are the motor torque (on ``system.drive_dof``), the bracing twist (on
    ``system.twist_load``) and a value for each entry of ``system.periodic_loads``. For each name in ``drags`` a torque
    brakes through ``system.drag_loads``: a function of the speed there at the end of every internal step.
    """

    def __init__(
        self,
        system: LinearSystem,
        laws: Sequence[MeshLaw],
        start: DriveState,
        settings: MarchSettings,
        loads: DriveLoads = NO_LOADS,
        model: ModalModel | None = None,
        tables: MarchTables | None = None,
    ) -> None:
        """Prepare the march.

        Parameters
        ----------
        laws : of the meshes, in the order of ``system.mesh_ports``
        start : angles, speeds and twist of the first instant
        settings : steps and what is kept
        loads : torques that act at the first instant; the names of drags say which may act
        model : ``march_model`` of the same system, laws and drags, to be shared between runs; made when left out
        tables : of the same laws and step, of a march that this one goes on with; made when left out

        Raises
        ------
        DynamicsInputError
            For disagreeing shapes or unknown drags.
        DefectiveModes
            As ``modal_model``.
        """
        drags = tuple(loads.drag_torques)
        accounts = settings.accounts
        self.laws, self.system = tuple(laws), system
        self.step = settings.step
        self.substeps = settings.substeps
        self.drags = drags
        self.model = model or march_model(system, laws, drags, settings.cutoff)
        self.propagator = discretise(
            self.model,
            self.step,
            substeps=self.substeps,
            with_losses=accounts,
            beside_every=1 if accounts else gcd(self.substeps, BESIDE_EVERY),
        )
        self.unconverged = 0
        self._settings = settings
        self._tables = tables or MarchTables(
            self.laws, self.step, derivative_torques=settings.derivative_torques
        )
        self._marched = 0
        self._reader: StateReader | None = None
        self._following: FollowingLoads | None = None
        self._apart, self._apart_since = np.zeros(len(self.laws)), 0
        self._names = system.dofs
        self._record_all = settings.record_all
        self._places = drag_places(system, drags)
        braked = drag_loads(system, drags)
        columns = np.column_stack((slow_loads(system), braked))
        n_meshes, n_slow, n_drags = len(self.laws), 2 + len(system.periodic_loads), braked.shape[1]
        self._n_slow = n_slow
        n_power = 2 * n_meshes + n_slow + n_drags + 2 if accounts else 0
        pinions, wheels = system.mesh_ports.T
        self.tables = self._tables.at(start.speeds[pinions])
        ports = np.zeros((n_meshes, kernels.N_PORTS))
        powers = np.full((3, n_power), np.nan)
        for mesh, law in enumerate(self.laws):
            angles = start.angles[pinions[mesh]], start.angles[wheels[mesh]]
            turning = start.speeds[pinions[mesh]], start.speeds[wheels[mesh]]
            for back in range(3):
                # the steps before are those of a steady rotation
                now = [angle - back * self.step * speed for angle, speed in zip(angles, turning)]
                x = law.base_radius_1 * now[0] - law.base_radius_2 * now[1]
                reaction = self._reaction(mesh, now[0], x + law.offset, *turning)
                ports[mesh, 2 * back : 2 * back + 2] = reaction.torque_1[0], reaction.torque_2[0]
                if back == 0:
                    ports[mesh, 6:8] = x, now[0]
                    ports[mesh, 10:] = turning
                    ports[mesh, 8:10] = self._outer_given(mesh, x + law.offset, reaction)
                if accounts and back == 0:
                    powers[0, 2 * mesh : 2 * mesh + 2] = (
                        reaction.friction_power[0],
                        reaction.damping_power[0],
                    )
        slow = np.zeros(n_slow)
        slow[:2] = loads.drive_torque, start.twist
        slow[2:] = 0.0 if loads.periodic is None else loads.periodic
        braking = np.zeros(n_drags)
        braking[self._places] = list(loads.drag_torques.values())
        speeds = columns.T @ start.speeds
        if accounts:
            powers[0, 2 * n_meshes : -2] = np.concatenate((slow, braking)) * speeds
            powers[0, -2] = start.speeds @ system.damping @ start.speeds
            skew = 0.5 * (system.stiffness - system.stiffness.T)
            powers[0, -1] = start.speeds @ skew @ start.angles
        self._carried = kernels.Carried(
            wrench=np.zeros(len(self.propagator.wrench.by_force)),
            apart=parted_flanks(self.model, system.mesh_wrench, start.angles),
            state=np.zeros(self.propagator.modes.rows.shape[1]),
            ports=ports,
            slow=slow,
            drags=braking,
            offset=np.array([law.offset for law in self.laws], float),
            controller=np.zeros(5),
            speeds=speeds,
            powers=powers,
            work=np.zeros(n_power),
        )
        with np.errstate(invalid="ignore"):  # an infinite torque shows in the march, which says where
            self._carried.state[:] = modal_state(
                self.model, self.propagator, start.angles, start.speeds, self._inputs()
            )
        torque = self.mean_torque_of_first_mesh()
        self._carried.controller[2:] = torque, speeds[0], torque

    def advance(
        self,
        given: Array,
        *,
        offsets: Array | None = None,
        speed_control: SpeedControl | None = None,
        torque_control: TorqueControl | None = None,
        drags: DragTables | None = None,
    ) -> Block:
        """March over ``len(given)`` samples.

        Parameters
        ----------
        given : (n_samples, 4 + n_periodic_loads) commands at the end of each sample: motor torque (feed-forward)
            [N m], twist [rad], speed of the drive freedom [rad/s], torque of the first mesh [N m], then the value of
            each entry of ``system.periodic_loads``, which counts only as long as none are followed (`follow`)
        offsets : (n_samples, n_meshes) approach imposed on each mesh [m], in place of the offsets of the laws
        speed_control, torque_control : of motor and bracing; without one its command is followed as it is
        drags : torque over speed of each drag; none brakes when left out

        Raises MarchDiverged if the motion leaves the finite numbers.
        """
        n_meshes, n_slow = len(self.laws), self._n_slow
        n_samples = len(given)
        sample_time = self.step * self.substeps
        control = np.zeros(6)
        if speed_control is not None:
            control[:4] = (
                speed_control.proportional, speed_control.integral * sample_time, speed_control.torque_limit,
                min(1.0, sample_time / speed_control.time_constant),
            )  # fmt: skip
        if torque_control is not None:
            share = min(1.0, sample_time / torque_control.time_constant)
            control[4:] = 0.25 * share / torque_control.stiffness, share
        n_drags = len(self._carried.drags)
        tables = np.zeros((n_drags, 2 if drags is None else drags.torque.shape[1]))
        ends = np.ones(n_drags)
        if drags is not None:
            tables[self._places] = drags.torque
            if drags.last_speed is not None:
                ends[self._places] = drags.last_speed
        left = np.outer(fade(n_samples, self._apart_since, sample_time), self._apart)
        past = fade(1, self._apart_since - 1, sample_time)[0] * self._apart
        asked = np.tile(self._carried.offset - past, (n_samples, 1)) if offsets is None else offsets
        held = np.ascontiguousarray(asked + left)
        drag_laws = kernels.DragLaws(
            torque=tables, per_step=(tables.shape[1] - 1) / ends, creep=CREEP_SHARE * ends
        )
        given = np.array(given, float, order="C")
        histories, all_samples, torques = [], [], []
        for first in range(0, n_samples, SEGMENT):
            part = slice(first, min(first + SEGMENT, n_samples))
            count = part.stop - part.start
            if self._following is not None:
                now = self.state()
                times = sample_time * np.arange(1.0, count + 1.0)
                given[part, 4:] = self._following.ahead(now.angles, now.speeds, times)
            commands = kernels.Commands(
                given=given[part], offsets=held[part], control=control, drags=drag_laws
            )
            histories.append(np.empty((n_meshes, 7 if self._record_all else 2, count * self.substeps)))
            all_samples.append(np.empty((count, 2 * n_slow + n_drags + 1)))
            seen = 0 if self._reader is None else count
            states = np.empty((seen, len(self._carried.state) + 2 * n_meshes + len(self._carried.wrench)))
            self.tables = self._tables.at(self._pinion_speeds())
            self.unconverged += kernels.integrate(
                self.tables,
                self.propagator.modes,
                self.propagator.wrench,
                commands,
                self._carried,
                kernels.Steps(self.step, self.substeps),
                kernels.Histories(histories[-1], all_samples[-1], states),
            )
            if self._reader is not None:
                torques.append(self._read(self._reader, states, all_samples[-1]))
        history = histories[0] if len(histories) == 1 else np.concatenate(histories, axis=2)
        samples = all_samples[0] if len(histories) == 1 else np.concatenate(all_samples)
        if not np.all(np.isfinite(self._carried.ports)):
            raise MarchDiverged(self._diverged(history[:, 0], samples[:, : 2 * n_slow]))
        self._marched += n_samples
        self._apart_since += n_samples
        none = np.empty((n_meshes, 0))
        force, acting, approach, angle, rate, omega, torque = (
            history[:, i] if i < history.shape[1] else none for i in range(7)
        )
        slow, speed, braking, angle_1 = np.split(samples, (n_slow, 2 * n_slow, 2 * n_slow + n_drags), axis=1)
        braking = braking[:, self._places]
        return Block(
            force, acting, approach, angle, rate, omega, torque, slow, speed, braking, angle_1[:, 0],
            np.hstack(torques) if torques else np.empty((0, n_samples)),
        )  # fmt: skip

    def _read(self, reader: StateReader, states: Array, samples: Array) -> Array:
        """Torques (r, n) [N m] at the ends of n samples, see ``kernels.Histories``."""
        n_states = len(self._carried.state)
        marched, ports, beside = np.split(states, (n_states, n_states + 2 * len(self.laws)), axis=1)
        slow, _, braking, _ = np.split(
            samples, np.cumsum((self._n_slow, self._n_slow, len(self._carried.drags))), axis=1
        )
        beside = wrench_inputs(self.model, beside)
        return reader.read(marched, np.hstack((ports, slow, braking, beside)), slow[:, 1])

    def _diverged(self, force: Array, samples: Array) -> str:
        """What is known of a march that left the finite numbers in its last block.

        force : (n_meshes, n_steps) [N]; samples : (n_samples, 2 n_slow) slow inputs and their speeds
        """
        broken = ~np.isfinite(force)
        step = int(np.argmax(broken.any(axis=0)))
        mesh = int(np.argmax(broken[:, step]))
        pinion, wheel = (self._names[port] for port in self.model.mesh_ports[mesh])
        good = np.flatnonzero(np.isfinite(samples).all(axis=1))
        speed = samples[good[-1], samples.shape[1] // 2] * 30.0 / np.pi if good.size else np.nan
        elastic = self.model.n_lines
        frequency = self.model.frequencies[elastic] / (2.0 * np.pi) if elastic < len(self._names) else np.inf
        where = self._names[int(np.argmax(np.abs(self.model.shapes[:, min(elastic, len(self._names) - 1)])))]
        return (
            f"the march left the finite numbers: mesh of {pinion} and {wheel}, "
            f"{(self._marched * self.substeps + step) * self.step:.6g} s after its start, last drive speed "
            f"{speed:.6g} rpm; slowest elastic mode {frequency:.4g} Hz, largest at {where}, step {self.step:.3g} s. "
            "Correct inertia, stiffness or torque that is orders of magnitude off there, or take more internal "
            "steps"
        )

    def mean_torque_of_first_mesh(self) -> float:
        """Torque of the first mesh at its pinion at this instant, friction left out [N m]."""
        force = self._reaction_now(0)
        return float(self.laws[0].base_radius_1 * (force.force_front[0] - force.force_back[0]))

    def _reaction(self, mesh: int, angle: float, reach: float, *speeds: float) -> TableReaction:
        """What a mesh answers at the angle of its pinion and an approach, imposed part included."""
        return evaluate_table(self.tables, angle, reach, *speeds, mesh=mesh)

    def _reaction_now(self, mesh: int) -> TableReaction:
        """What a mesh answers at rest at this instant."""
        approach, angle = self._carried.ports[mesh, 6:8]
        return self._reaction(mesh, angle, approach + self._carried.offset[mesh])

    def _outer_given(self, mesh: int, reach: float, reaction: TableReaction) -> float:
        """Part of an approach that bodies outside the table give [m]."""
        outside = self.tables.values[mesh, V_BODY] > 0.0
        return float(reach - reaction.tooth_approach[0]) if outside else 0.0

    def _pinion_speeds(self) -> Array:
        """Speeds of the pinions (n_meshes,) without their vibration [rad/s]."""
        model = self.model
        scaled = scaled_state(model, self.propagator, self._carried.state, self._inputs())
        rigid = model.n_lines
        return np.asarray(model.shapes[model.mesh_ports[:, 0], :rigid] @ scaled[:rigid])

    def accounts(self) -> Accounts:
        """Return work and losses since the start; zeros if the march keeps no accounts."""
        n = len(self.laws)
        if len(self._carried.work) == 0:
            return Accounts(np.zeros(n), np.zeros(n), np.zeros(self._n_slow), np.zeros(len(self.drags)), 0.0)
        work = self._carried.work
        slow, drag = np.split(work[2 * n : -2], (self._n_slow,))
        return Accounts(
            work[0 : 2 * n : 2].copy(),
            work[1 : 2 * n : 2].copy(),
            slow.copy(),
            -drag[self._places],
            float(work[-2]),
            float(work[-1]),
        )

    def energy(self) -> float:
        """Kinetic energy plus elastic energy of joints and tooth contacts at this instant [J]."""
        scaled = scaled_state(self.model, self.propagator, self._carried.state, self._inputs())
        n = len(self.model.inertia)
        stored = 0.5 * float(scaled[:n] @ scaled[:n] + self.model.springs @ scaled[n:] ** 2)
        return stored + sum(self._contact_energy(mesh) for mesh in range(len(self.laws)))

    def _contact_energy(self, mesh: int) -> float:
        """Energy in the teeth of a mesh [J]: of the flanks that carry, else of the others, which see an approach of
        their own."""
        approach, angle = self._carried.ports[mesh, 6:8]
        reach, sides = approach + self._carried.offset[mesh], self.model.wrench_numbers[:, 0]
        here = self._reaction(mesh, angle, reach)
        if len(sides) == 0 or (here.force_front if sides[mesh] > 0.0 else here.force_back)[0] > 0.0:
            return float(here.energy[0])
        moved = reach - sides[mesh] * self._carried.apart[0, mesh]
        return float(self._reaction(mesh, angle, moved).energy[0])

    def state(self) -> DriveState:
        """Return angles, speeds and twist at this instant; each line is placed by one of its mesh ports."""
        model = self.model
        scaled = scaled_state(model, self.propagator, self._carried.state, self._inputs())
        n, rigid = len(model.inertia), model.n_lines
        elastic = scaled[n:] / model.frequencies[rigid:]
        angles = model.shapes[:, rigid:] @ elastic
        placed: set[int] = set()
        for mesh in range(len(self.laws)):
            law = self.laws[mesh]
            approach, pinion = self._carried.ports[mesh, 6:8]
            wheel = (law.base_radius_1 * pinion - approach) / law.base_radius_2
            for port, angle in zip(model.mesh_ports[mesh], (pinion, wheel)):
                line = int(np.argmax(np.abs(model.shapes[port, :rigid])))
                if line not in placed:
                    turned = (angle - angles[port]) / model.shapes[port, line]
                    angles += turned * model.shapes[:, line]
                    placed.add(line)
        return DriveState(angles=angles, speeds=model.shapes @ scaled[:n], twist=float(self._carried.slow[1]))

    def continued(
        self, system: LinearSystem, model: ModalModel, mean_force: Array | None = None
    ) -> "TimeMarch":
        """The same motion with other matrices of the same freedoms from this instant on: another speed band.

        system : with the same ports and loads
        model : its ``march_model`` for the laws and drags of this march
        mean_force : (n_meshes,) mean of ``Block.force``, under which the mean position goes over to that of the new
            bearings (see ``band_change``); it stays where it is when left out [N]
        """
        drags = dict(zip(self.drags, self._carried.drags[self._places].tolist()))
        loads = DriveLoads(drive_torque=float(self._carried.slow[0]), drag_torques=drags)
        state = self.state()
        march = TimeMarch(system, self.laws, state, self._settings, loads, model, self._tables)
        march._marched, march.unconverged = self._marched, self.unconverged
        march._following = self._following
        march._apart, march._apart_since = self._apart.copy(), self._apart_since
        before, after = self._carried, march._carried
        after.ports[:], after.slow[:], after.offset[:] = before.ports, before.slow, before.offset
        after.wrench[:], after.apart[:] = before.wrench, before.apart
        after.controller[:], after.work[:], after.powers[:] = before.controller, before.work, before.powers
        angles = state.angles
        if mean_force is not None:
            shift = mean_shift(self.system, system, self._mean_load(mean_force))
            angles = angles + shift
            march._move_flanks(shift)
        after.state[:] = modal_state(model, march.propagator, angles, state.speeds, march._inputs())
        return march

    def _mean_load(self, mean_force: Array) -> Array:
        """Loads (n,) on the freedoms under mean forces of the meshes, with motor, twist and drags of this instant;
        loads that alternate have no mean."""
        carried = self._carried
        load = (
            slow_loads(self.system)[:, :2] @ carried.slow[:2]
            + drag_loads(self.system, self.drags) @ carried.drags
        )
        for law, (pinion, wheel), force in zip(self.laws, self.system.mesh_ports, mean_force):
            load[pinion] -= law.base_radius_1 * force
            load[wheel] += law.base_radius_2 * force
        return np.asarray(load)

    def _move_flanks(self, shift: Array) -> None:
        """Let the ports move by ``shift`` (n,) at once, and the approach that this gives come over a time."""
        past = fade(1, self._apart_since - 1, self.step * self.substeps)[0]
        ports = shift[self.system.mesh_ports]
        for mesh, law in enumerate(self.laws):
            moved = law.base_radius_1 * ports[mesh, 0] - law.base_radius_2 * ports[mesh, 1]
            self._carried.ports[mesh, 6] += moved
            self._carried.ports[mesh, 7] += ports[mesh, 0]
            self._carried.offset[mesh] -= moved
            self._apart[mesh] = past * self._apart[mesh] - moved
        self._apart_since = 0

    def watch(self, reader: StateReader | None) -> None:
        """Read torques at the end of every sample from now on, into ``Block.sections``.

        reader : of the model and propagator of this march
        """
        self._reader = reader

    def follow(self, loads: FollowingLoads | None) -> None:
        """Let the periodic loads stand at the angles of their shaft lines from now on, whatever ``given`` says of them.

        They are set anew at the start of every segment; None gives them back to ``given``.
        """
        self._following = loads

    def preset_integrals(self, torque: float, twist: float = 0.0) -> None:
        """Let the controllers start from a motor torque [N m] and a twist beside that given [rad]."""
        self._carried.controller[:2] = torque, twist

    def pinion_angle(self) -> float:
        """Angle of the pinion of the first mesh at this instant [rad]."""
        return float(self._carried.ports[0, 7])

    def kick(self, speeds: Array) -> None:
        """Add ``speeds`` (n,) [rad/s] to the motion at once."""
        nothing = np.zeros(self.propagator.hold.shape[1])
        self._carried.state[:] += modal_state(
            self.model, self.propagator, np.zeros_like(speeds), speeds, nothing
        )

    def set_slow(self, drive_torque: float, twist: float) -> None:
        """Change motor torque and twist at once, without a ramp over the next sample."""
        before = self._inputs()
        self._carried.slow[:2] = drive_torque, twist
        still = np.zeros(len(self.model.inertia))
        self._carried.state[:] += modal_state(
            self.model, self.propagator, still, still, self._inputs() - before
        )

    def _inputs(self) -> Array:
        """Inputs (n_inputs,) that act at this instant: mesh torques, slow inputs and drag torques."""
        carried = self._carried
        beside = wrench_inputs(self.model, carried.wrench)
        return np.concatenate((carried.ports[:, :2].ravel(), carried.slow, carried.drags, beside))


def compile_time_integration() -> None:
    """Compile the march and leave it on disk, by one sample of a pair of gears that hardly turns.

    For a copy of the process, so that the first run does not wait for it.
    """
    pitch, teeth = 0.01, np.ones(1)
    law = MeshLaw(
        base_radius_1=0.05, base_radius_2=0.05, base_pitch=pitch, teeth_1=30, teeth_2=30, tooth_offset_2=0,
        path_start=-pitch, path_step=0.25 * pitch, stiffness=np.full((1, 9), 1e8), gap=np.zeros((1, 9)),
        slice_shift=np.zeros(1), deviation_1=np.zeros((1, 9)), deviation_2=np.zeros((1, 9)), scale_1=teeth,
        scale_2=teeth, backlash=1e-3, offset=0.0, phase=0.0, back_phase=0.0, damping=1e3, mean_stiffness=1e8,
        friction=0.0, rolling_radius_1=0.02, rolling_radius_2=0.02, friction_reversal_speed=0.1,
    )  # fmt: skip
    system = LinearSystem(
        inertia=0.01 * np.eye(2), damping=np.zeros((2, 2)), stiffness=np.zeros((2, 2)), dofs=("pinion", "wheel"),
        mesh_ports=np.array([[0, 1]]), rigid=np.eye(2), drive_dof=0, twist_load=np.zeros(2), drag_loads={},
    )  # fmt: skip
    rest = DriveState(angles=np.zeros(2), speeds=np.ones(2), twist=0.0)
    TimeMarch(system, [law], rest, MarchSettings(step=1e-6)).advance(np.zeros((1, 2)))
