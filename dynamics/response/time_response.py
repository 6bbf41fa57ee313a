"""Time response of the drivetrain over a schedule of speed and bracing torque.

The run is marched at the internal rate (eight or more steps per sample). Torques pass a linear-phase
low-pass before they are kept at the sample rate; envelopes, lift-off and peaks come from the internal
steps. The motor follows the speed command through a controller with a torque limit, the bracing follows a
twist or a torque.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import pi

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.errors import DynamicsInputError
from dynamics.mesh.law import MeshLaw
from dynamics.response.envelopes import LiftOff, Slots, SlotStatistics
from dynamics.response.initial_state import pinion_ratios, wound_state
from dynamics.response.periodic_response import PeriodicResponse, periodic_by_time
from dynamics.response.propagator import DEFAULT_CUTOFF, modal_model
from dynamics.response.time_march import (
    DriveState,
    SpeedControl,
    TimeMarch,
    TorqueControl,
    drag_loads,
    slow_loads,
)

__all__ = [
    "Command",
    "DragCurve",
    "EnergyBook",
    "LiftOff",
    "PeriodicResponse",
    "Slots",
    "TimeResponse",
    "periodic_by_time",
    "run_schedule",
]

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Command:
    """What the rig is told to do, on a slow grid, linear between its points.

    time : (n,) increasing [s]; speed : (n,) of the pinion of the first mesh [rad/s]
    torque : (n,) mean dynamic torque of the first mesh, negative on the back flank [N m] (torque-controlled
        bracing), or None; twist : (n,) bracing twist that is held [rad], or None; one of the two is given
    offsets : (n, n_meshes) approach imposed on each mesh [m], or None for the offsets of the laws
    """

    time: Array
    speed: Array
    torque: Array | None = None
    twist: Array | None = None
    offsets: Array | None = None


@dataclass(frozen=True, kw_only=True)
class DragCurve:
    """Drag torque over the speed of its place: speed (n,) from 0, increasing [rad/s]; torque (n,) >= 0 [N m]."""

    speed: Array
    torque: Array


@dataclass(frozen=True, kw_only=True)
class EnergyBook:
    """Where the work went, integrated at the internal steps [J].

    input_work : of the motor and of all torques that swing with a shaft; bracing_work : of the twist
    friction, mesh_damping : (n_meshes,); joint_damping : joints and linear bearing damping; drag : by name
    change : of kinetic and elastic energy
    """

    input_work: float
    bracing_work: float
    friction: Array
    mesh_damping: Array
    joint_damping: float
    drag: dict[str, float]
    change: float

    @property
    def losses(self) -> float:
        """Sum of all losses [J]."""
        tooth = float(self.friction.sum() + self.mesh_damping.sum())
        return tooth + self.joint_damping + sum(self.drag.values())

    @property
    def residual(self) -> float:
        """Work put in less losses and change [J]; the error of the integration."""
        return self.input_work + self.bracing_work - self.losses - self.change


@dataclass(frozen=True, kw_only=True)
class TimeResponse:
    """Response over a schedule; n samples at ``1 / sample_time``, slots of ``slots.duration``.

    time : (n,) [s]; speed : (n,) of the drive freedom, as speed of the first pinion [rad/s]
    speed_command : (n,) [rad/s]; drive_torque : (n,) [N m]; twist : (n,) [rad]
    angle : (n,) of the first pinion [rad]; drag_torque : name -> (n,) [N m]
    torque : (n_meshes, n) dynamic torque r_b1 (front - back force) after the low-pass [N m]; no columns if
        the channels were not kept
    slots : least, mean and greatest dynamic torque of each mesh and time without contact, per slot
    lift_off : intervals in which a mesh lost contact for longer than the asked share of a mesh period
    energy : the balance of the run, None if no accounts were kept
    drive_limited_share : share of samples at the torque limit of the motor
    speed_missed : lag behind the speed command at the end of the schedule [rad/s]
    end : state at the end; unsettled_steps : contact iterations that ended early
    """

    time: Array
    speed: Array
    speed_command: Array
    drive_torque: Array
    twist: Array
    angle: Array
    drag_torque: dict[str, Array]
    torque: Array
    slots: Slots
    lift_off: tuple[LiftOff, ...]
    energy: EnergyBook | None
    drive_limited_share: float
    speed_missed: float
    end: DriveState
    unsettled_steps: int
    warnings: tuple[str, ...] = field(default=())

    def mean_speed(self, end: float, window: float) -> float:
        """Mean speed of the first pinion over the ``window`` [s] before ``end`` [s], by the angle it turned [rad/s].

        Vibrations with a whole number of periods in the window leave nothing, whatever the sample rate. A window
        beyond the run is cut.
        """
        last = float(np.clip(end, self.time[1], self.time[-1]))
        first = max(last - window, float(self.time[0]))
        turned = np.interp([first, last], self.time, self.angle)
        return float(turned[1] - turned[0]) / (last - first)


def default_speed_control(
    system: LinearSystem, laws: Sequence[MeshLaw], torque_limit: float, *, bandwidth: float = 2.0
) -> SpeedControl:
    """Return a controller of ``bandwidth`` [Hz] for the rigid inertia of the rig, damped 1.0.

    Source: second-order loop J s^2 + k_p s + k_i with both roots at -2 pi bandwidth.
    """
    ratios = pinion_ratios(system, laws)
    inertia = float(system.inertia @ ratios**2) / float(ratios[system.drive_dof]) ** 2
    rate = 2.0 * pi * bandwidth
    return SpeedControl(
        proportional=2.0 * inertia * rate,
        integral=inertia * rate**2,
        torque_limit=torque_limit,
        time_constant=0.1 / rate,
    )


def run_schedule(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    command: Command,
    *,
    torque_limit: float | Array,
    drags: Mapping[str, DragCurve] | None = None,
    speed_control: SpeedControl | None = None,
    sample_rate: float = 40e3,
    substeps: int = 8,
    slot: float = 0.01,
    lift_off_share: float = 0.05,
    keep_channels: bool = True,
    keep_accounts: bool = True,
    cutoff: float = DEFAULT_CUTOFF,
    start: DriveState | None = None,
) -> TimeResponse:
    """March over a schedule.

    Parameters
    ----------
    torque_limit : of the motor [N m], or one for every time of the command, each from its time on; changes count
        from the nearest slot end
    drags : drag torque over speed for names of ``system.drag_loads``
    speed_control : of the motor; default ``default_speed_control``
    sample_rate : of controller and kept channels [Hz]; substeps : internal steps per sample, 8 or more
    slot : length of the envelope slots [s]
    keep_accounts : integrate the energy of every joint and contact; without it the run is about twice as fast and
        ``energy`` is None
    lift_off_share : a gap without contact counts from this share of the mesh period on [-]
    start : state at the first time; default: turning rigidly at the first speed, wound up by the first torque

    Raises
    ------
    ValueError
        For impossible commands, sizes or names.
    """
    _check(command, len(laws), substeps, sample_rate)
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
    first_twist = None if command.twist is None else float(command.twist[0])
    first_torque = None if command.torque is None else float(command.torque[0])
    wound, drive, stiffness = wound_state(
        system,
        laws,
        speed=float(command.speed[0]),
        torque=first_torque,
        twist=first_twist,
        drag_torques=drag_now,
    )
    march = TimeMarch(
        system, laws, start or wound, step=1.0 / sample_rate / substeps, substeps=substeps, drags=names,
        drive_torque=drive, drag_torques=tuple(drag_now.values()), record_all=False, accounts=keep_accounts,
        model=modal_model(system, laws, slow_loads(system), drag_loads(system, names), cutoff=cutoff),
    )  # fmt: skip
    limits = np.broadcast_to(np.asarray(torque_limit, float), command.time.shape)
    control = speed_control or default_speed_control(system, laws, float(limits[0]))
    march.preset_speed_integral(drive)
    bracing = None if command.torque is None else TorqueControl(stiffness=stiffness)
    feed_forward = (
        (np.zeros(1), np.zeros(1)) if command.torque is None else _twists(system, laws, command.torque)
    )
    tables, ends = _drag_tables(curves)
    inertia = float(system.inertia @ ratios**2) / drive_ratio**2

    n_samples = max(1, round(float(command.time[-1] - command.time[0]) * sample_rate))
    per_slot = max(1, round(slot * sample_rate))
    pinions = [ratios[ports[0]] for ports in system.mesh_ports]
    statistics = SlotStatistics(laws, per_slot * substeps, march.step, lift_off_share, pinions)
    low_pass = LowPass(len(laws), substeps)
    energy_before = march.energy()
    columns: list[tuple[Array, ...]] = []
    torques: list[Array] = []
    radius = np.array([law.base_radius_1 for law in laws])[:, None]
    limit_at = np.empty(n_samples)
    turned = np.zeros(1)
    for first, count, limit in _chunks(command.time, limits, n_samples, sample_rate, per_slot):
        limit_at[first : first + count] = limit
        control = replace(control, torque_limit=limit)
        at = command.time[0] + np.arange(first, first + count + 1) / sample_rate
        target = np.interp(at, command.time, command.speed) * drive_ratio
        given = np.zeros((count, 4 + len(system.shaft_torques)))
        given[:, 0] = inertia * np.diff(target) * sample_rate
        if command.twist is not None:
            given[:, 1] = np.interp(at[1:], command.time, command.twist)
        given[:, 2] = target[1:]
        turned = (
            turned[-1] + np.concatenate(([0.0], np.cumsum(0.5 * (target[1:] + target[:-1])))) / sample_rate
        )
        for i, swinging in enumerate(system.shaft_torques):
            given[:, 4 + i] = swinging.at(ratios[swinging.dof] / drive_ratio * turned[1:])
        if command.torque is not None:
            asked = np.interp(at[1:], command.time, command.torque)
            given[:, 3] = asked
            given[:, 1] = np.interp(asked, *feed_forward)
        offsets = None
        if command.offsets is not None:
            offsets = np.column_stack([np.interp(at[1:], command.time, row) for row in command.offsets.T])
        block = march.advance(
            given, offsets=offsets, speed_control=control, torque_control=bracing, drag_tables=tables, drag_speeds=ends
        )  # fmt: skip
        dynamic = radius * block.force
        statistics.add(dynamic, block.slow_speed[:, 0] / drive_ratio)
        if keep_channels:
            torques.append(low_pass.decimate(dynamic))
        columns.append(
            (block.slow[:, :2], block.slow_speed[:, 0], block.drags, block.turned, target[1:] / drive_ratio)
        )
    if keep_channels:
        torques.append(low_pass.finish())
    slow, drive_speed, braking, angle, command_speed = (np.concatenate(parts) for parts in zip(*columns))
    accounts = march.accounts()
    speed = drive_speed / drive_ratio
    limited = np.abs(slow[:, 0]) >= limit_at * (1.0 - 1e-9)
    warnings = []
    if march.unsettled:
        warnings.append(f"{march.unsettled} contact iterations ended early, limit 0; use more internal steps")
    return TimeResponse(
        time=command.time[0] + np.arange(1, n_samples + 1) / sample_rate,
        speed=speed,
        speed_command=command_speed,
        drive_torque=slow[:, 0],
        twist=slow[:, 1],
        angle=angle,
        drag_torque=dict(zip(names, braking.T)),
        torque=np.hstack(torques) if keep_channels else np.empty((len(laws), 0)),
        slots=statistics.slots(float(command.time[0])),
        lift_off=statistics.lift_off(float(command.time[0])),
        energy=None
        if not keep_accounts
        else EnergyBook(
            input_work=float(accounts.slow_work[0] + accounts.slow_work[2:].sum()),
            bracing_work=float(accounts.slow_work[1]),
            friction=accounts.friction,
            mesh_damping=accounts.mesh_damping,
            joint_damping=accounts.joint_damping,
            drag=dict(zip(names, accounts.drag.tolist())),
            change=march.energy() - energy_before,
        ),
        drive_limited_share=float(np.mean(limited)),
        speed_missed=float(command_speed[-1] - speed[-1]),
        end=march.state(),
        unsettled_steps=march.unsettled,
        warnings=tuple(warnings),
    )


def _chunks(
    time: Array, limits: Array, n_samples: int, sample_rate: float, per_slot: int
) -> Iterator[tuple[int, int, float]]:
    """(first sample, count, torque limit) of blocks that begin at a slot, each with one torque limit."""
    changes = np.flatnonzero(np.diff(limits)) + 1
    slots = np.rint((time[changes] - time[0]) * sample_rate / per_slot).astype(int)
    borders = np.unique(np.concatenate([[0], slots * per_slot, [n_samples]]).clip(0, n_samples))
    chunk = per_slot * max(1, 8192 // per_slot)
    for start, end in pairwise(borders.tolist()):
        middle = time[0] + 0.5 * (start + end) / sample_rate
        limit = float(limits[np.searchsorted(time, middle, side="right") - 1])
        for first in range(start, end, chunk):
            yield first, min(chunk, end - first), limit


class LowPass:
    """Linear-phase low-pass before decimation by ``factor``: flat to 0.4, below -60 dB from 0.6 of the new
    rate on.

    Source: Kaiser window design, Oppenheim and Schafer, Discrete-Time Signal Processing, section 7.5.
    """

    def __init__(self, channels: int, factor: int) -> None:
        half = 18 * factor
        at = np.arange(-half, half + 1)
        self._factor = factor
        self._taps = np.sinc(at / factor) * np.kaiser(2 * half + 1, 5.65)
        self._taps /= self._taps.sum()
        self._half = half
        self._held = np.empty((channels, 0))
        self._started = False

    def decimate(self, values: Array) -> Array:
        """Return the samples that can be told after ``values`` (channels, steps); they lag by the filter length."""
        if not self._started:
            # as if the first value had always been there; samples sit at the last step of each group
            ahead = self._half - self._factor + 1
            self._held = np.repeat(values[:, :1], ahead, axis=1)
            self._started = True
        self._held = np.hstack((self._held, values))
        n_taps = len(self._taps)
        if self._held.shape[1] < n_taps:
            return np.empty((len(values), 0))
        count = max(0, (self._held.shape[1] - n_taps) // self._factor + 1)
        windows = np.lib.stride_tricks.sliding_window_view(self._held, n_taps, axis=1)[:, :: self._factor]
        result: Array = windows[:, :count] @ self._taps
        self._held = self._held[:, count * self._factor :].copy()
        return result

    def finish(self) -> Array:
        """Return the samples that were still held back, the last value going on."""
        return self.decimate(np.repeat(self._held[:, -1:], self._half, axis=1))


def _check(command: Command, n_meshes: int, substeps: int, sample_rate: float) -> None:
    n = len(command.time)
    if n < 2 or np.any(np.diff(command.time) <= 0.0):
        raise DynamicsInputError("command: time must have two points at least and increase")
    if (command.torque is None) == (command.twist is None):
        raise DynamicsInputError("command: give either torque or twist")
    for name in ("speed", "torque", "twist"):
        values = getattr(command, name)
        if values is not None and (len(values) != n or not np.all(np.isfinite(values))):
            raise DynamicsInputError(
                f"command: {name} has {len(values)} values, needs {n} finite ones, one for each time"
            )
    if command.offsets is not None and command.offsets.shape != (n, n_meshes):
        raise ValueError(f"command: offsets has shape {command.offsets.shape}, expected {(n, n_meshes)}")
    if substeps < 8:
        raise DynamicsInputError(
            f"substeps = {substeps}, limit 8: the sample rate of {sample_rate:g} Hz is no integration step"
        )


def _twists(system: LinearSystem, laws: Sequence[MeshLaw], torque: Array) -> tuple[Array, Array]:
    """Return torques of the first mesh over the range of a command and the static twists that make them."""
    least, greatest = float(torque.min()), float(torque.max())
    levels = np.linspace(least, greatest, 9) if greatest > least else np.array([least])
    return levels, np.array([wound_state(system, laws, speed=0.0, torque=float(t))[0].twist for t in levels])


def _drag_speed(system: LinearSystem, ratios: Array, name: str) -> float:
    """Speed of the place of a drag per speed of the first pinion."""
    if name not in system.drag_loads:
        raise DynamicsInputError(
            f"no drag load named {name}; known: {', '.join(system.drag_loads) or 'none'}"
        )
    return abs(float(system.drag_loads[name] @ ratios))


def _drag_tables(curves: Mapping[str, DragCurve]) -> tuple[Array, Array]:
    """Return all curves on uniform grids of 513 points, and the last speed of each."""
    ends = np.array([curve.speed[-1] for curve in curves.values()], float)
    rows = []
    for name, curve in curves.items():
        if curve.speed[0] != 0.0 or np.any(np.diff(curve.speed) <= 0.0) or np.any(curve.torque < 0.0):
            raise DynamicsInputError(
                f"drag {name}: speed must start at 0 and increase, torque must not be negative"
            )
        rows.append(np.interp(np.linspace(0.0, curve.speed[-1], 513), curve.speed, curve.torque))
    return np.array(rows, float).reshape(len(rows), 513), ends
