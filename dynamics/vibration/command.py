"""Commands of a time run: speed and bracing over time, motor, drag torques, sampling."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError
from dynamics.rotor.graph import TwistRows
from dynamics.rotor.linear_system import LinearSystem
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.initial_state import pinion_ratios
from dynamics.vibration.march_inputs import DragTables, SpeedControl
from dynamics.vibration.modal_model import DEFAULT_CUTOFF

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Command:
    """Speed and bracing of the rig, on a coarse time grid, linear between its points.

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
class MotorDrive:
    """Motor of the rig in a time run.

    torque_limit : of the motor [N m], or one for every time of the command, each from its time on; changes count
        from the nearest window end
    speed_control : controller; default ``default_speed_control``
    """

    torque_limit: float | Array
    speed_control: SpeedControl | None = None


LEAST_SUBSTEPS = 4
"""Internal steps per sample: at 40 kHz and 12,000 rpm eight per mesh of a 99 tooth pinion."""


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """Steps of a time run and what it keeps.

    sample_rate : of controller and kept channels [Hz]; substeps : internal steps per sample, 4 or more
    window : length of the envelope windows [s]
    lift_off_share : a gap without contact counts from this share of the mesh period on [-]
    keep_channels : keep the torques of the meshes
    torque_band : frequency up to which the kept torques are flat at least, as far as the internal steps allow; 0: as
        far as the sample rate allows [Hz]
    keep_accounts : integrate the energy of every joint and contact; without it the run is about twice as fast and
        its energy balance is None
    cutoff : modes above this frequency keep their static effect only [Hz]
    sections : springs whose torque is read, by the speed of the pinion of the first mesh at which the run comes to the
        matrices they are read with [rad/s]; none when left out

    Raises DynamicsInputError for fewer than 4 internal steps.
    """

    sample_rate: float = 40e3
    substeps: int = 8
    window: float = 0.01
    lift_off_share: float = 0.05
    keep_channels: bool = True
    torque_band: float = 0.0
    keep_accounts: bool = True
    cutoff: float = DEFAULT_CUTOFF
    sections: Callable[[float], TwistRows] | None = None

    def __post_init__(self) -> None:
        if self.substeps < LEAST_SUBSTEPS:
            raise DynamicsInputError(
                f"substeps = {self.substeps}, limit {LEAST_SUBSTEPS}: the sample rate of {self.sample_rate:g} Hz is no "
                "integration step"
            )

    @property
    def steps_kept(self) -> int:
        """Internal steps from one kept torque to the next: the most, within a sample, that keep the band."""
        divisors = [n for n in range(1, self.substeps + 1) if self.substeps % n == 0]
        rate = self.sample_rate * self.substeps
        return max((n for n in divisors if FLAT * rate / n >= self.torque_band), default=1)

    def torques_kept(self, duration: float) -> float:
        """Kept torques of one mesh in a run of some duration [s]: up to ``substeps`` of them a sample."""
        return duration * self.sample_rate * self.substeps / self.steps_kept


def default_speed_control(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    torque_limit: float,
    *,
    bandwidth: float = 2.0,
    sample_time: float = 25e-6,
) -> SpeedControl:
    """Return a controller of ``bandwidth`` [Hz] for the rigid inertia of the rig, damped 1.0.

    Torque and measured speed act at one place, so that without delay the loop is stable whatever lies behind; the delay
    of the sampled controller, one and a half ``sample_time`` [s], drives oscillations of the motor against the rig
    above 1 / sqrt(time constant x delay). The bandwidth is lowered until it cannot: a light rotor before heavy wheels.

    Source: second-order loop J s^2 + k_p s + k_i with both roots at -2 pi bandwidth.
    """
    ratios = pinion_ratios(system, laws)
    drive = system.drive_dof
    inertia = float(ratios @ system.inertia @ ratios) / float(ratios[drive]) ** 2
    delay = 1.5 * sample_time
    frequency, mobility = _drive_modes(system, laws)
    # what is left of the rig where all springs are soft: the rotor alone
    rotor = 1.0 / float(np.linalg.inv(system.inertia)[drive, drive])
    rate = min(2.0 * pi * bandwidth, rotor / (8.0 * inertia * delay))
    for _ in range(20):
        control = SpeedControl(
            proportional=2.0 * inertia * rate,
            integral=inertia * rate**2,
            torque_limit=torque_limit,
            time_constant=0.1 / rate,
        )
        fast = frequency > 1.0 / np.sqrt(control.time_constant * delay)
        gain = control.proportional / np.hypot(1.0, control.time_constant * frequency) * mobility
        if not fast.any() or float(gain[fast].max()) <= 1.0:
            break
        rate /= np.sqrt(2.0)
    return control


def _drive_modes(system: LinearSystem, laws: Sequence[MeshLaw]) -> tuple[Array, Array]:
    """Of every mode with mean mesh stiffness: frequency [rad/s], peak of the speed of the drive per torque on
    it [rad/(N m s)]."""
    stiffness, damping = system.stiffness.copy(), system.damping.copy()
    for law, (pinion, wheel) in zip(laws, system.mesh_ports):
        row = np.zeros(len(stiffness))
        row[pinion], row[wheel] = law.base_radius_1, -law.base_radius_2
        stiffness += law.mean_stiffness * np.outer(row, row)
        damping += law.damping * np.outer(row, row)
    squared, shapes = scipy.linalg.eigh(0.5 * (stiffness + stiffness.T), system.inertia)
    frequency = np.sqrt(np.maximum(squared, 1.0))
    damped = np.einsum("im,ij,jm->m", shapes, damping, shapes)
    return frequency, shapes[system.drive_dof] ** 2 / np.maximum(damped, 2e-3 * frequency)


def check_command(command: Command, n_meshes: int) -> None:
    """Raise DynamicsInputError for a command that contradicts itself, ValueError for offsets of another shape."""
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


def drag_tables(curves: Mapping[str, DragCurve]) -> DragTables:
    """All curves on uniform grids of 513 points; DynamicsInputError for speeds or torques that cannot be."""
    ends = np.array([curve.speed[-1] for curve in curves.values()], float)
    rows = []
    for name, curve in curves.items():
        if curve.speed[0] != 0.0 or np.any(np.diff(curve.speed) <= 0.0) or np.any(curve.torque < 0.0):
            raise DynamicsInputError(
                f"drag {name}: speed must start at 0 and increase, torque must not be negative"
            )
        rows.append(np.interp(np.linspace(0.0, curve.speed[-1], 513), curve.speed, curve.torque))
    return DragTables(torque=np.array(rows, float).reshape(len(rows), 513), last_speed=ends)


# Low-pass that keeps torques of internal steps at a lower rate.

FLAT = 0.4
"""Share of the new rate up to which a low-pass keeps what it gets."""


class LowPass:
    """Linear-phase low-pass before decimation by ``factor``: flat to `FLAT`, below -60 dB from 0.6 of the new rate on.

    Source: Kaiser window design, Oppenheim and Schafer, Discrete-Time Signal Processing, section 7.5.
    """

    def __init__(self, channels: int, factor: int) -> None:
        half = 18 * factor
        lags = np.arange(-half, half + 1)
        self._factor = factor
        self._taps = np.sinc(lags / factor) * np.kaiser(2 * half + 1, 5.65)
        self._taps /= self._taps.sum()
        self._half = half
        self._pending = np.empty((channels, 0))
        self._started = False

    def decimate(self, values: Array) -> Array:
        """Return the samples that are known after ``values`` (channels, steps); they lag by the filter length."""
        if not self._started:
            # as if the first value had always been there; samples sit at the last step of each group
            ahead = self._half - self._factor + 1
            self._pending = np.repeat(values[:, :1], ahead, axis=1)
            self._started = True
        self._pending = np.hstack((self._pending, values))
        n_taps = len(self._taps)
        if self._pending.shape[1] < n_taps:
            return np.empty((len(values), 0))
        count = max(0, (self._pending.shape[1] - n_taps) // self._factor + 1)
        windows = np.lib.stride_tricks.sliding_window_view(self._pending, n_taps, axis=1)[:, :: self._factor]
        result: Array = windows[:, :count] @ self._taps
        self._pending = self._pending[:, count * self._factor :].copy()
        return result

    def finish(self) -> Array:
        """Return the samples that were still held back, the last value going on."""
        return self.decimate(np.repeat(self._pending[:, -1:], self._half, axis=1))
