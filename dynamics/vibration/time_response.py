"""Time response of the drivetrain over a schedule of speed and bracing torque.

The run is marched at the internal rate (eight or more steps per sample). Torques pass a linear-phase
low-pass before they are kept, at the sample rate or a higher one; envelopes, lift-off and peaks come from the
internal steps. The motor follows the speed command through a controller with a torque limit, the bracing follows a
twist or a torque.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.linear_system import DrivetrainOverSpeed, LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.command import (
    FLAT,
    Command,
    DragCurve,
    LowPass,
    MotorDrive,
    Sampling,
    check_command,
    default_speed_control,
    drag_tables,
)
from dynamics.vibration.initial_state import pinion_ratios, wound_state
from dynamics.vibration.march_inputs import (
    DriveLoads,
    DriveState,
    FollowingLoads,
    MarchSettings,
    TorqueControl,
    TurningLoads,
    march_model,
)
from dynamics.vibration.propagator import SectionEnvelopes, SectionStatistics, StateReader
from dynamics.vibration.time_integration import CREEP_SHARE, TimeMarch

Array = NDArray[np.float64]


# Envelopes and loss of contact of a long run, window by window, from its internal steps.


@dataclass(frozen=True, kw_only=True)
class EnvelopeWindows:
    """Envelope of the dynamic torque: arrays (n_meshes, n_windows) [N m], time (n_windows,) at window ends [s].

    out_of_contact : share of each window without any contact [-]; longest_gap : longest time without contact
        [s]
    speed : (n_windows,) of the first pinion at the window end [rad/s]
    """

    duration: float
    time: Array
    speed: Array
    least: Array
    mean: Array
    greatest: Array
    out_of_contact: Array
    longest_gap: Array


@dataclass(frozen=True, kw_only=True)
class LiftOff:
    """Interval in which a mesh kept losing contact: mesh index, start and end [s], share and longest gap [s]."""

    mesh: int
    start: float
    end: float
    out_of_contact: float
    longest_gap: float


def split_lift_off(
    windows: EnvelopeWindows, intervals: Sequence[LiftOff], times: ArrayLike
) -> tuple[LiftOff, ...]:
    """Intervals cut at ``times`` [s], share and longest gap taken afresh for every piece.

    A window belongs to the piece in which its middle lies; a cut within a window moves to the nearer window end.
    """
    cuts = np.sort(np.asarray(times, float))
    middle = windows.time - 0.5 * windows.duration
    piece = np.searchsorted(cuts, middle, side="right")
    pieces = []
    for whole in intervals:
        inside = (middle > whole.start) & (middle < whole.end)
        for part in np.unique(piece[inside]):
            members = np.flatnonzero(inside & (piece == part))
            pieces.append(
                LiftOff(
                    mesh=whole.mesh,
                    start=float(windows.time[members[0]] - windows.duration),
                    end=float(windows.time[members[-1]]),
                    out_of_contact=float(windows.out_of_contact[whole.mesh, members].mean()),
                    longest_gap=float(windows.longest_gap[whole.mesh, members].max()),
                )
            )
    return tuple(pieces)


class WindowStatistics:
    """Collect windows of ``per_window`` internal steps of ``step`` seconds from consecutive blocks.

    pinion_ratios : (n_meshes,) speed of the pinion of each mesh per speed of the first pinion; 1 when left out
    """

    def __init__(
        self,
        laws: Sequence[MeshLaw],
        per_window: int,
        step: float,
        lift_off_share: float,
        pinion_ratios: ArrayLike = 1.0,
    ) -> None:
        teeth = np.array([law.teeth_1 for law in laws])
        self._meshes_per_turn = teeth * np.abs(np.broadcast_to(np.asarray(pinion_ratios, float), teeth.shape))
        self._per_window = per_window
        self._step = step
        self._share = lift_off_share
        self._rows: list[Array] = []
        self._speed: list[Array] = []
        self._open = np.zeros(len(laws))

    def add(self, torque: Array, speed: Array) -> None:
        """Add a block: torque (n_meshes, steps) from a window boundary on, speed (n_samples,) at its samples."""
        starts = np.arange(0, torque.shape[1], self._per_window)
        lengths = np.diff(np.append(starts, torque.shape[1]))
        free = torque == 0.0
        longest = np.stack([self._gaps(mesh, row, starts) for mesh, row in enumerate(free)])
        self._rows.append(
            np.stack(
                (
                    np.minimum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(torque, starts, axis=1) / lengths,
                    np.maximum.reduceat(torque, starts, axis=1),
                    np.add.reduceat(free.astype(float), starts, axis=1) / lengths,
                    longest,
                )
            )
        )
        samples_per_step = len(speed) / torque.shape[1]
        ends = np.minimum(np.rint((starts + lengths) * samples_per_step).astype(int), len(speed)) - 1
        self._speed.append(speed[ends])

    def windows(self, start: float) -> EnvelopeWindows:
        """Return all windows of a run that began at ``start`` [s]."""
        rows = np.concatenate(self._rows, axis=2)
        duration = self._per_window * self._step
        return EnvelopeWindows(
            duration=duration,
            time=start + duration * np.arange(1, rows.shape[2] + 1),
            speed=np.concatenate(self._speed),
            least=rows[0],
            mean=rows[1],
            greatest=rows[2],
            out_of_contact=rows[3],
            longest_gap=rows[4],
        )

    def lift_off(self, start: float) -> tuple[LiftOff, ...]:
        """Return intervals of windows whose longest gap exceeds the asked share of the mesh period."""
        windows = self.windows(start)
        intervals = []
        for mesh, meshes_per_turn in enumerate(self._meshes_per_turn):
            with np.errstate(divide="ignore"):
                mesh_period = 2.0 * pi / (np.abs(windows.speed) * meshes_per_turn)
            lost = np.concatenate(([False], windows.longest_gap[mesh] > self._share * mesh_period, [False]))
            edges = np.flatnonzero(np.diff(lost.astype(int)))
            for a, b in zip(edges[::2], edges[1::2]):
                intervals.append(
                    LiftOff(
                        mesh=mesh,
                        start=start + float(a) * windows.duration,
                        end=start + float(b) * windows.duration,
                        out_of_contact=float(windows.out_of_contact[mesh, a:b].mean()),
                        longest_gap=float(windows.longest_gap[mesh, a:b].max()),
                    )
                )
        return tuple(sorted(intervals, key=lambda interval: (interval.start, interval.mesh)))

    def _gaps(self, mesh: int, free: NDArray[np.bool_], starts: NDArray[np.int64]) -> Array:
        """Longest time without contact that ends in, or runs through, each window; carried over from block to block."""
        longest = np.zeros(len(starts))
        edges = np.flatnonzero(np.diff(np.concatenate(([False], free, [False])).astype(int)))
        carried = self._open[mesh]
        self._open[mesh] = 0.0
        for a, b in zip(edges[::2], edges[1::2]):
            length = (b - a) * self._step + (carried if a == 0 else 0.0)
            if b == len(free):
                self._open[mesh] = length
            first, last = (int(np.searchsorted(starts, edge, side="right")) - 1 for edge in (a, b - 1))
            longest[first : last + 1] = np.maximum(longest[first : last + 1], length)
        return longest


# Loads that alternate with a shaft at the start of a march, and the motion with which they are in balance there.
#
# A bow or run-out that acts at once on a rig at rest is a blow that no rig gets. The march therefore starts bent as
# they bend it, and at a speed in the motion that they force: by the dynamic stiffness with mean tooth stiffness.

Complex = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class TurningStart:
    """At the angle 0 of all shafts.

    values : (n_periodic_loads,) of ``system.periodic_loads``
    load : (n,) load on each freedom that holds the displacement in static balance: the loads themselves at rest, with
        inertia and damping of the forced motion at a speed; what accelerates all lines together is left to them
    speeds : (n,) of the forced motion [rad/s]
    """

    values: Array
    load: Array
    speeds: Array


def turning_start(system: LinearSystem, laws: Sequence[MeshLaw], speed: float) -> TurningStart:
    """Start at a speed of the first pinion [rad/s]; raises DynamicsInputError as `pinion_ratios`."""
    ratios = pinion_ratios(system, laws)
    n = len(ratios)
    values, load, speeds = [], np.zeros(n), np.zeros(n)
    for periodic in system.periodic_loads:
        line_speed = float(ratios[periodic.dof]) * speed
        values.append(float(periodic.at(np.zeros(1), line_speed)[0]))
        for part in periodic.parts:
            force = (
                part.at_speed(line_speed)
                * np.exp(-1j * part.phase)
                * _balanced(system, ratios, periodic.load)
            )
            omega = part.order * line_speed
            motion = _forced(system, laws, ratios, force, omega) if omega else np.zeros(n)
            static = force + omega**2 * system.inertia @ motion - 1j * omega * system.damping @ motion
            load += static.real
            speeds += (1j * omega * motion).real
    return TurningStart(values=np.array(values), load=load, speeds=speeds)


def _balanced(system: LinearSystem, ratios: Array, load: Array) -> Array:
    """A load (n,) less what accelerates all lines together."""
    still = system.inertia @ ratios
    return np.asarray(load - still * (ratios @ load) / (ratios @ still))


def _forced(
    system: LinearSystem, laws: Sequence[MeshLaw], ratios: Array, force: Complex, omega: float
) -> Complex:
    """Motion (n,) under Re(force exp(i omega t)) with the meshes closed, without rotation of the whole rig."""
    stiffness = system.stiffness.copy()
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        row = np.zeros(len(ratios))
        row[pinion], row[wheel] = law.base_radius_1, -law.base_radius_2
        stiffness += law.mean_stiffness * np.outer(row, row)
    still = system.inertia @ ratios
    scale = np.abs(stiffness).max() / np.abs(np.outer(still, still)).max()
    fixed = stiffness + scale * np.outer(still, still)
    return np.asarray(np.linalg.solve(fixed - omega**2 * system.inertia + 1j * omega * system.damping, force))


DEFAULT_SAMPLING = Sampling()


@dataclass(frozen=True, kw_only=True)
class LoopEnergy:
    """Where the work went, integrated at the internal steps [J].

    input_work : of the motor and of all torques that alternate with a shaft; bracing_work : of the twist
    friction, mesh_damping : (n_meshes,); joint_damping : joints and linear bearing damping; drag : by name
    change : of kinetic and elastic energy
    circulation : what the skew stiffness of lubricant films takes from whirling shafts, negative where it drives them
    """

    input_work: float
    bracing_work: float
    friction: Array
    mesh_damping: Array
    joint_damping: float
    drag: dict[str, float]
    change: float
    circulation: float = 0.0

    @property
    def losses(self) -> float:
        """Sum of all losses [J]."""
        tooth = float(self.friction.sum() + self.mesh_damping.sum())
        return tooth + self.joint_damping + sum(self.drag.values())

    @property
    def residual(self) -> float:
        """Work put in less losses and change [J]; the error of the integration."""
        return self.input_work + self.bracing_work - self.losses - self.circulation - self.change


PER_SAMPLE = ("time", "speed", "speed_command", "drive_torque", "twist", "angle")


@dataclass(frozen=True, kw_only=True)
class TimeResponse:
    """Response over a schedule; n samples at ``1 / sample_time``, windows of ``windows.duration``.

    time : (n,) [s]; speed : (n,) of the drive freedom, as speed of the first pinion [rad/s]
    speed_command : (n,) [rad/s]; drive_torque : (n,) [N m]; twist : (n,) [rad]
    angle : (n,) of the first pinion [rad]; drag_torque : name -> (n,) [N m]
    torque : (n_meshes, m) dynamic torque r_b1 (front - back force) of the filtered tables, after the low-pass, in
        single precision [N m]; no columns if the channels were not kept
    torque_step : interval of these [s]; the first one lies that much after the start of the run
    windows : least, mean and greatest dynamic torque of each mesh and time without contact, per window
    lift_off : intervals in which a mesh lost contact for longer than the asked share of a mesh period
    energy : the balance of the run, None if no accounts were kept
    drive_limited_share : share of samples at the torque limit of the motor
    speed_missed : lag behind the speed command at the end of the schedule [rad/s]
    end : state at the end; unconverged_steps : contact iterations that ended early
    sections : torque of the springs asked for in the same windows, None if none were
    cut : why it ends before its command, empty if it does not; see ``until``
    """

    time: Array
    speed: Array
    speed_command: Array
    drive_torque: Array
    twist: Array
    angle: Array
    drag_torque: dict[str, Array]
    torque: NDArray[np.float32]
    torque_step: float
    windows: EnvelopeWindows
    lift_off: tuple[LiftOff, ...]
    energy: LoopEnergy | None
    drive_limited_share: float
    speed_missed: float
    end: DriveState
    unconverged_steps: int
    warnings: tuple[str, ...] = field(default=())
    sections: SectionEnvelopes | None = None
    cut: str = ""

    def until(self, time: float, reason: str) -> "TimeResponse":
        """The run up to ``time`` [s], without its energy: what comes after ``reason`` is not to be used."""
        samples = slice(int(np.searchsorted(self.time, time * (1.0 + 1e-12), side="right")))
        windows = slice(int(np.searchsorted(self.windows.time, time + 1e-9, side="right")))
        begin = float(self.time[0]) - (float(self.time[1]) - float(self.time[0]))
        sections = self.sections and replace(
            self.sections,
            **{name: getattr(self.sections, name)[:, windows] for name in ("least", "mean", "greatest")},
        )
        kept = {
            name: getattr(self.windows, name)[..., windows]
            for name in ("time", "speed", "least", "mean", "greatest", "out_of_contact", "longest_gap")
        }
        return replace(
            self,
            **{name: getattr(self, name)[samples] for name in PER_SAMPLE},
            drag_torque={name: torque[samples] for name, torque in self.drag_torque.items()},
            torque=self.torque[:, : int((time - begin) / self.torque_step)],
            windows=replace(self.windows, **kept),
            lift_off=tuple(
                replace(interval, end=min(interval.end, time))
                for interval in self.lift_off
                if interval.start < time
            ),
            energy=None,
            sections=sections,
            warnings=(*self.warnings, f"what comes after {time:.2f} s was not evaluated: {reason}"),
            cut=reason,
        )

    @property
    def torque_band(self) -> float:
        """Frequency up to which the kept torques are flat [Hz]."""
        return FLAT / self.torque_step

    def mean_speed(self, end: float, window: float) -> float:
        """Mean speed of the first pinion over the ``window`` [s] before ``end`` [s], by the angle it turned [rad/s].

        Vibrations with a whole number of periods in the window leave nothing, whatever the sample rate. A window
        beyond the run is cut.
        """
        last = float(np.clip(end, self.time[1], self.time[-1]))
        first = max(last - window, float(self.time[0]))
        angle = np.interp([first, last], self.time, self.angle)
        return float(angle[1] - angle[0]) / (last - first)


def run_schedule(
    drivetrain: DrivetrainOverSpeed,
    laws: Sequence[MeshLaw],
    command: Command,
    motor: MotorDrive,
    drags: Mapping[str, DragCurve] | None = None,
    sampling: Sampling = DEFAULT_SAMPLING,
) -> TimeResponse:
    """March over a schedule, from a rigid rotation at its first speed, wound up by its first torque and bent by the
    loads that alternate with a shaft (``turning_start``); these stand at the angle and grow with the speed that their
    shaft line has, not with those of the command.

    Parameters
    ----------
    drivetrain : without its meshes, the same matrices at all speeds (a ``LinearSystem``) or by ``SpeedBands``, whose
        matrices change at the end of a block of samples; the state goes on as it is
    laws : of the meshes, in the order of ``mesh_ports``
    command : speed and bracing over time
    motor : torque limit and controller
    drags : drag torque over speed for names of ``system.drag_loads``
    sampling : steps and what is kept

    Raises
    ------
    DynamicsInputError
        For impossible commands or names.
    DynamicsNotConverged
        If the initial state is not found or the march leaves the finite numbers.
    """
    check_command(command, len(laws))
    system = drivetrain.at(abs(float(command.speed[0])))
    sample_rate, substeps = sampling.sample_rate, sampling.substeps
    curves = dict(drags or {})
    names = tuple(curves)
    ratios = pinion_ratios(system, laws)
    drive_ratio = float(ratios[system.drive_dof])
    drag_now = {
        name: float(
            np.interp(_drag_speed(system, ratios, name) * command.speed[0], curve.speed, curve.torque)
        )
        * float(np.sign(command.speed[0]))
        for name, curve in curves.items()
    }
    load = LoopLoad(
        torque=None if command.torque is None else float(command.torque[0]),
        twist=None if command.twist is None else float(command.twist[0]),
    )
    rises = {name: _steepest(curve) for name, curve in curves.items()}
    turning = turning_start(system, laws, float(command.speed[0]))
    wound = wound_state(system, laws, float(command.speed[0]), load, drag_now, turning.load)
    march = TimeMarch(
        system,
        laws,
        replace(wound.state, speeds=wound.state.speeds + turning.speeds),
        MarchSettings(
            step=1.0 / sample_rate / substeps,
            substeps=substeps,
            cutoff=sampling.cutoff,
            accounts=sampling.keep_accounts,
            record_all=False,
        ),
        DriveLoads(drive_torque=wound.drive_torque, drag_torques=drag_now, periodic=turning.values),
        march_model(system, laws, names, sampling.cutoff, rises),
    )
    models = {id(system): march.model}
    readers: dict[int, StateReader] = {}

    def watched(started: TimeMarch, speed: float) -> TimeMarch:
        """The march with the sections asked for read in it, from a speed of the first pinion on."""
        if sampling.sections is not None:
            key = id(started.system)
            if key not in readers:
                readers[key] = StateReader(sampling.sections(speed), started.model, started.propagator)
            started.watch(readers[key])
        return started

    watched(march, abs(float(command.speed[0])))
    n_periodic = len(system.periodic_loads)
    if n_periodic:
        march.follow(FollowingLoads(TurningLoads(system), wound.state.angles))
    limits = np.broadcast_to(np.asarray(motor.torque_limit, float), command.time.shape)
    control = motor.speed_control or default_speed_control(
        system, laws, float(limits[0]), sample_time=1.0 / sample_rate
    )
    bracing = None if command.torque is None else TorqueControl(stiffness=wound.loop_stiffness)
    feed_forward = (
        (np.zeros(1), np.zeros(1)) if command.torque is None else _twists(system, laws, command.torque)
    )
    ahead = 0.0 if load.torque is None else wound.state.twist - float(np.interp(load.torque, *feed_forward))
    march.preset_integrals(wound.drive_torque, ahead)
    tables = drag_tables(curves)
    inertia = float(ratios @ system.inertia @ ratios) / drive_ratio**2

    n_samples = max(1, round(float(command.time[-1] - command.time[0]) * sample_rate))
    per_window = max(1, round(sampling.window * sample_rate))
    pinions = [ratios[ports[0]] for ports in system.mesh_ports]
    statistics = WindowStatistics(laws, per_window * substeps, march.step, sampling.lift_off_share, pinions)
    sections = SectionStatistics(per_window)
    low_pass = LowPass(len(laws), sampling.steps_kept)
    energy_before = march.energy()
    columns: list[tuple[Array, ...]] = []
    torques: list[NDArray[np.float32]] = []
    radius = np.array([law.base_radius_1 for law in laws])[:, None]
    limit_at = np.empty(n_samples)
    for first, count, limit in _chunks(command.time, limits, n_samples, sample_rate, per_window):
        limit_at[first : first + count] = limit
        control = replace(control, torque_limit=limit)
        times = command.time[0] + np.arange(first, first + count + 1) / sample_rate
        target = np.interp(times, command.time, command.speed) * drive_ratio
        given = np.zeros((count, 4 + n_periodic))
        given[:, 0] = inertia * np.diff(target) * sample_rate
        if command.twist is not None:
            given[:, 1] = np.interp(times[1:], command.time, command.twist)
        given[:, 2] = target[1:]
        if command.torque is not None:
            asked = np.interp(times[1:], command.time, command.torque)
            given[:, 3] = asked
            given[:, 1] = np.interp(asked, *feed_forward)
        offsets = None
        if command.offsets is not None:
            offsets = np.column_stack([np.interp(times[1:], command.time, row) for row in command.offsets.T])
        block = march.advance(
            given, offsets=offsets, speed_control=control, torque_control=bracing, drags=tables
        )
        end_speed = abs(float(block.slow_speed[-1, 0])) / drive_ratio
        band = drivetrain.at(end_speed)
        if band is not march.system:
            if id(band) not in models:
                models[id(band)] = march_model(band, laws, names, sampling.cutoff, rises)
            march = watched(march.continued(band, models[id(band)], block.force.mean(axis=1)), end_speed)
        dynamic = radius * block.force
        statistics.add(dynamic, block.slow_speed[:, 0] / drive_ratio)
        if readers:
            sections.add(block.sections)
        if sampling.keep_channels:
            torques.append(low_pass.decimate(radius * block.acting_force).astype(np.float32))
        columns.append(
            (block.slow[:, :2], block.slow_speed[:, 0], block.drags, block.angle, target[1:] / drive_ratio)
        )
    if sampling.keep_channels:
        torques.append(low_pass.finish().astype(np.float32))
    slow, drive_speed, braking, angle, command_speed = (np.concatenate(parts) for parts in zip(*columns))
    accounts = march.accounts()
    speed = drive_speed / drive_ratio
    limited = np.abs(slow[:, 0]) >= limit_at * (1.0 - 1e-9)
    windows = statistics.windows(float(command.time[0]))
    warnings = []
    if march.unconverged:
        warnings.append(
            f"{march.unconverged} contact iterations ended early, limit 0; use more internal steps"
        )
    return TimeResponse(
        time=command.time[0] + np.arange(1, n_samples + 1) / sample_rate,
        speed=speed,
        speed_command=command_speed,
        drive_torque=slow[:, 0],
        twist=slow[:, 1],
        angle=angle,
        drag_torque=dict(zip(names, braking.T)),
        torque=np.hstack(torques) if sampling.keep_channels else np.empty((len(laws), 0), np.float32),
        torque_step=march.step * sampling.steps_kept,
        windows=windows,
        lift_off=statistics.lift_off(float(command.time[0])),
        energy=None
        if not sampling.keep_accounts
        else LoopEnergy(
            input_work=float(accounts.slow_work[0] + accounts.slow_work[2:].sum()),
            bracing_work=float(accounts.slow_work[1]),
            friction=accounts.friction,
            mesh_damping=accounts.mesh_damping,
            joint_damping=accounts.joint_damping,
            drag=dict(zip(names, accounts.drag.tolist())),
            change=march.energy() - energy_before,
            circulation=accounts.circulation,
        ),
        drive_limited_share=float(np.mean(limited)),
        speed_missed=float(command_speed[-1] - speed[-1]),
        end=march.state(),
        unconverged_steps=march.unconverged,
        warnings=tuple(warnings),
        sections=sections.envelopes(next(iter(readers.values())).sections) if readers else None,
    )


def _chunks(
    time: Array, limits: Array, n_samples: int, sample_rate: float, per_window: int
) -> Iterator[tuple[int, int, float]]:
    """(first sample, count, torque limit) of blocks that begin at a window, each with one torque limit."""
    changes = np.flatnonzero(np.diff(limits)) + 1
    windows = np.rint((time[changes] - time[0]) * sample_rate / per_window).astype(int)
    borders = np.unique(np.concatenate([[0], windows * per_window, [n_samples]]).clip(0, n_samples))
    chunk = per_window * max(1, 8192 // per_window)
    for start, end in pairwise(borders.tolist()):
        middle = time[0] + 0.5 * (start + end) / sample_rate
        limit = float(limits[np.searchsorted(time, middle, side="right") - 1])
        for first in range(start, end, chunk):
            yield first, min(chunk, end - first), limit


def _twists(system: LinearSystem, laws: Sequence[MeshLaw], torque: Array) -> tuple[Array, Array]:
    """Return torques of the first mesh over the range of a command and the static twists that make them."""
    least, greatest = float(torque.min()), float(torque.max())
    levels = np.linspace(least, greatest, 9) if greatest > least else np.array([least])
    return levels, np.array(
        [wound_state(system, laws, 0.0, LoopLoad(torque=float(t))).state.twist for t in levels]
    )


def _steepest(curve: DragCurve) -> float:
    """Steepest rise of a drag torque over the speed, that through standstill included [N m s/rad]."""
    rises = np.abs(np.diff(curve.torque) / np.diff(curve.speed))
    return float(max(rises.max(initial=0.0), 1.5 * curve.torque[0] / (CREEP_SHARE * curve.speed[-1])))


def _drag_speed(system: LinearSystem, ratios: Array, name: str) -> float:
    """Speed of the place of a drag per speed of the first pinion."""
    if name not in system.drag_loads:
        raise DynamicsInputError(
            f"no drag load named {name}; known: {', '.join(system.drag_loads) or 'none'}"
        )
    return abs(float(system.drag_loads[name] @ ratios))
