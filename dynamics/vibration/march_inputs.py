"""What a march through time starts from and how it goes: state, loads, steps, controllers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from dynamics import kernels
from dynamics.errors import DynamicsInputError
from dynamics.kernels.contact_table import ContactTables
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import PeriodicLoad
from dynamics.tooth.contact_samples import RESOLVED
from dynamics.tooth.contact_table import MarchStep, contact_tables
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.modal_model import DEFAULT_CUTOFF, ModalModel, modal_model

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DriveState:
    """Angles [rad] and speeds [rad/s] of all freedoms, shape (n,), and the bracing twist [rad]."""

    angles: Array
    speeds: Array
    twist: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SpeedControl:
    """Speed controller of the motor: torque = proportional * error + integral * integrated error, limited.

    proportional : [N m s/rad]; integral : [N m/rad]; torque_limit : largest motor torque [N m]
    time_constant : of the average over the measured speed, which keeps the torsional vibration out [s]
    """

    proportional: float
    integral: float
    torque_limit: float
    time_constant: float = 0.01


@dataclass(frozen=True, kw_only=True)
class TorqueControl:
    """Torque-controlled bracing: the twist follows the averaged torque of the first mesh.

    stiffness : torque of the first mesh per twist of the bracing [N m/rad]
    time_constant : of the control loop and of the average it acts on [s]
    """

    stiffness: float
    time_constant: float = 0.02


@dataclass(frozen=True, kw_only=True)
class DriveLoads:
    """Torques that act at the start of a march.

    drive_torque : of the motor [N m]
    drag_torques : by name of ``system.drag_loads``, positive against positive rotation [N m]; a drag that may act
        later is named here, if only with 0
    periodic : (n_periodic_loads,) value of each entry of ``system.periodic_loads``; zeros when left out
    """

    drive_torque: float = 0.0
    drag_torques: Mapping[str, float] = field(default_factory=dict)
    periodic: Array | None = None


@dataclass(frozen=True, kw_only=True)
class DragTables:
    """Drag torques over speed, on uniform grids from 0.

    torque : (n_drags, n_table) [N m], in the order of the drags of the march
    last_speed : (n_drags,) at the end of each table [rad/s]; None for torques that do not depend on it
    """

    torque: Array
    last_speed: Array | None = None


@dataclass(frozen=True, kw_only=True)
class MarchSettings:
    """Steps of a march and what it keeps.

    step : internal step [s]; substeps : of them in a sample, over which the slow inputs are linear
    cutoff : modes above this frequency keep their static effect only [Hz]
    accounts : integrate work and losses at every internal step
    record_all : keep approach, rates and torques of every internal step, else the mesh forces alone
    derivative_torques : torques from the change of stiffness and gap along the path, without which the pinion
        sees the elastic force alone
    """

    step: float
    substeps: int = 1
    cutoff: float = DEFAULT_CUTOFF
    accounts: bool = True
    record_all: bool = True
    derivative_torques: bool = True


# Columns of load through which a march acts on the drivetrain: motor, bracing, periodic loads and drag torques.


def march_model(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    drags: Sequence[str] = (),
    cutoff: float = DEFAULT_CUTOFF,
    drag_damping: Mapping[str, float] | None = None,
) -> ModalModel:
    """Modal model of a drivetrain with the loads of a march: motor, twist, alternating torques and the drags named.

    cutoff : modes above this frequency keep their static effect only [Hz]
    drag_damping : steepest rise of the drags over the speed by name [N m s/rad]; modes that are
        damped far more by themselves give way to drags statically alone; all move with them when left out

    Raises DynamicsInputError and DefectiveModes as ``modal_model``, DynamicsInputError for unknown names of drags.
    """
    loads = drag_loads(system, drags)
    steepest = None
    if drag_damping is not None:
        steepest = np.zeros(loads.shape[1])
        steepest[drag_places(system, drags)] = [drag_damping[name] for name in drags]
    return modal_model(system, laws, slow_loads(system), loads, cutoff=cutoff, drag_damping=steepest)


def slow_loads(system: LinearSystem) -> Array:
    """Return the loads (n, 2 + n_periodic_loads) of motor, twist and what alternates with a shaft."""
    drive = np.zeros(len(system.inertia))
    drive[system.drive_dof] = 1.0
    return np.column_stack((drive, system.twist_load, *(load.load for load in system.periodic_loads)))


def drag_places(system: LinearSystem, drags: Sequence[str]) -> NDArray[np.int64]:
    """Return (n_drags,) the columns of named drags in ``drag_loads``: every line begins a new four of them.

    Raises DynamicsInputError for unknown names.
    """
    unknown = [name for name in drags if name not in system.drag_loads]
    if unknown:
        raise DynamicsInputError(
            f"no drag load named {', '.join(unknown)}; known: {', '.join(system.drag_loads) or 'none'}"
        )
    lines = [int(np.argmax(np.abs(system.drag_loads[name] @ system.rigid))) for name in drags]
    places = np.empty(len(drags), np.int64)
    first = 0
    for line in np.unique(lines):
        on_line = np.flatnonzero(np.array(lines) == line)
        places[on_line] = first + np.arange(len(on_line))
        first += -(-len(on_line) // kernels.FOUR) * kernels.FOUR
    return places


def drag_loads(system: LinearSystem, drags: Sequence[str]) -> Array:
    """Return the loads (n, n_places) of named drag torques in fours, see ``drag_places``; zeros where there is no drag.

    Raises DynamicsInputError for unknown names.
    """
    places = drag_places(system, drags)
    loads = np.zeros(
        (len(system.inertia), -(-int(max(places, default=-1) + 1) // kernels.FOUR) * kernels.FOUR)
    )
    for place, name in zip(places, drags):
        loads[:, place] = system.drag_loads[name]
    return loads


# What a march hands out: its steps and samples, and where the work went.


class Block(NamedTuple):
    """One advance: internal steps and sample values."""

    force: Array
    """(n_meshes, n_steps) front minus back normal force in the transverse line of action [N]: of the law at full
    resolution, for extremes and contact loss."""
    acting_force: Array
    """(n_meshes, n_steps) the same of the tables that act in the march (`dynamics.tooth.contact_samples`) [N]:
    for spectra, as the law at full resolution, seen at the ends of steps, shows harmonics beyond half the step rate as
    slow oscillations."""
    approach: Array
    """(n_meshes, n_steps) approach including offsets [m]; no columns unless everything is recorded."""
    angle_1: Array
    """(n_meshes, n_steps) pinion angle [rad]."""
    rate: Array
    """(n_meshes, n_steps) approach rate [m/s]."""
    omega_1: Array
    """(n_meshes, n_steps) pinion speed [rad/s]."""
    torque_1: Array
    """(n_meshes, n_steps) generalized torque on the pinion body, friction included [N m]."""
    slow: Array
    """(n_samples, n_slow) motor torque [N m], twist [rad] and alternating torques [N m] at the end of each sample."""
    slow_speed: Array
    """(n_samples, n_slow) speed that each slow input works on: its power is input times this."""
    drags: Array
    """(n_samples, n_drags) drag torques [N m] at the end of each sample."""
    angle: Array
    """(n_samples,) angle of the pinion of the first mesh at the end of each sample [rad]."""
    sections: Array
    """(r, n_samples) torque of the springs that are watched at the end of each sample [N m]; no rows without them."""


class Accounts(NamedTuple):
    """Work since the start of a march [J]; losses are positive."""

    friction: Array
    """(n_meshes,) sliding friction of the teeth."""
    mesh_damping: Array
    """(n_meshes,)"""
    slow_work: Array
    """(n_slow,) work done on the drivetrain by motor, bracing and alternating torques."""
    drag: Array
    """(n_drags,)"""
    joint_damping: float
    circulation: float = 0.0
    """Of skew stiffness, as that of lubricant films: what it takes from a whirl, negative where it drives one."""

    def since(self, before: "Accounts") -> "Accounts":
        """Work since an earlier account."""
        return Accounts(
            self.friction - before.friction,
            self.mesh_damping - before.mesh_damping,
            self.slow_work - before.slow_work,
            self.drag - before.drag,
            self.joint_damping - before.joint_damping,
            self.circulation - before.circulation,
        )


# Contact tables of a march at the speed at which it runs.
#
# What the steps do not resolve of the path is filtered out of the tables (``dynamics.tooth.contact_samples``): the
# faster, the more. They are made for speeds on a geometric scale, so that marches share them.

RUNG = 0.6
"""Ratio of the speeds of neighbouring tables, less one."""
CLOSING_RUNG = 0.05
"""Change of a speed after which dampers on the closing rate, which work as the speed, are tabulated anew [-]."""
CREEP = 0.1
"""Speed below which dampers on the closing rate of contacts find no path speed [rad/s]."""


class MarchTables:
    """Contact tables over the speed for the steps [s] of a march, which keeps those that serve again."""

    def __init__(self, laws: Sequence[MeshLaw], step: float, *, derivative_torques: bool = True) -> None:
        self._laws, self._step, self._derivative_torques = tuple(laws), step, derivative_torques
        self._closes = np.array([law.damping_acts_on == "contact_closing_rate" for law in laws])
        # slower than this all tables are alike, unless dampers know the speed
        unfiltered = np.array([law.base_pitch / (RESOLVED * law.base_radius_1 * step) for law in laws])
        self._slow = np.where(self._closes, CREEP, unfiltered)
        self._speeds: Array | None = None
        self._by_speed: dict[tuple[float, ...], ContactTables] = {}

    def at(self, speeds: Array) -> ContactTables:
        """Tables for speeds of the pinions (n_meshes,) [rad/s], the last ones as long as they are good."""
        known = self._speeds
        if known is not None:
            wide = np.where(self._closes, CLOSING_RUNG, RUNG) * np.abs(known)
            if np.all(np.abs(speeds - known) <= np.where(known == 0.0, self._slow, wide)):
                return self._by_speed[tuple(known.tolist())]
        rungs = np.round(np.log(np.maximum(np.abs(speeds), 1e-9)) / np.log1p(RUNG))
        known = np.where(self._closes, speeds, np.sign(speeds) * (1.0 + RUNG) ** rungs)
        known = np.where(np.abs(speeds) < self._slow, 0.0, known)
        self._speeds = known
        key = tuple(known.tolist())
        if key not in self._by_speed:
            if self._closes.any():  # of too many speeds to keep
                self._by_speed.clear()
            self._by_speed[key] = contact_tables(
                self._laws,
                march=MarchStep(step=self._step, speeds=key) if known.any() else None,
                derivative_torques=self._derivative_torques,
            )
        return self._by_speed[key]


# Change of a march to the matrices of another speed band.
#
# Within a band the bearings are springs from where nothing loads them, so that new springs would press on the old mean
# position by ``(K_2 - K_1) u``, a blow that no rig gives. The mean of the motion therefore goes over to the place where
# the new matrices hold the same loads; the vibration about it goes on as it is. What the place of the gears changes of
# the approach of their flanks comes over a time, as it does while the rig passes through the band.

FADE = 0.1
"""Time over which the approach of the flanks follows the mean position of a new band [s]."""


def static_position(system: LinearSystem, load: Array) -> Array:
    """Displacements (n,) under steady loads (n,), without rigid motion; what accelerates the lines is in balance with
    their inertia."""
    inertia, rigid = system.inertia, system.rigid
    still = inertia @ rigid
    modal = rigid.T @ still
    balanced = load - still @ np.linalg.solve(modal, rigid.T @ load)
    scale = np.abs(system.stiffness).max() / max(np.abs(still @ still.T).max(), 1e-300)
    return np.asarray(scipy.linalg.solve(system.stiffness + scale * still @ still.T, balanced))


def mean_shift(before: LinearSystem, after: LinearSystem, load: Array) -> Array:
    """Change (n,) of the mean position under steady loads (n,) from one band to the next, with equal freedoms."""
    return static_position(after, load) - static_position(before, load)


def fade(n_samples: int, first: int, sample_time: float) -> Array:
    """Part (n_samples,) of a shift that is still to come at the ends of samples from number ``first`` on, counted from
    the change; it begins and ends without a jump of its rate."""
    place = np.minimum((first + 1 + np.arange(n_samples)) * sample_time / FADE, 1.0)
    return np.asarray(1.0 - place * place * (3.0 - 2.0 * place))


# Loads that alternate with a shaft, at any instant of a march: unbalance, bow, run-out, ripple, couplings out of line.
#
# They stand at the angle of their shaft line and grow with its speed. Both are those of the line turning as one body,
# by its angular momentum: its vibration is left out.


class TurningLoads:
    """Loads of a system, n of them, evaluated together; all its ``periodic_loads`` when none are named.

    dofs : (n,) freedom whose angle and speed count for each
    """

    def __init__(self, system: LinearSystem, loads: Sequence[PeriodicLoad] | None = None) -> None:
        """Read the loads and the momentum of the lines of a system."""
        loads = system.periodic_loads if loads is None else loads
        parts = [(i, part) for i, load in enumerate(loads) for part in load.parts]
        self.dofs = np.array([load.dof for load in loads], np.int64)
        self._load_of_part = np.array([i for i, _ in parts], np.int64)
        self._order = np.array([part.order for _, part in parts])
        self._phase = np.array([part.phase for _, part in parts])
        self._power = np.array([part.speed_power for _, part in parts], float)
        amplitude = np.array([part.amplitude for _, part in parts])
        self._amplitude = np.zeros((len(parts), len(loads)))
        self._amplitude[np.arange(len(parts)), self._load_of_part] = amplitude
        momentum = system.inertia @ system.rigid
        lines = np.linalg.solve(system.rigid.T @ momentum, momentum.T)
        self._line_speeds = system.rigid[self.dofs] @ lines

    def speeds(self, speeds: Array) -> Array:
        """(n,) speed of the line of each load at its freedom, from those of all freedoms [rad/s]; angles likewise."""
        return np.asarray(self._line_speeds @ speeds)

    def values(self, angles: Array, speeds: Array) -> Array:
        """(..., n) value of each load at angles [rad] and speeds [rad/s] of its line (..., n)."""
        load = self._load_of_part
        waves = np.cos(self._order * angles[..., load] - self._phase) * speeds[..., load] ** self._power
        return np.asarray(waves @ self._amplitude)


class FollowingLoads:
    """Turning loads of a march stretch by stretch, at the angles and speeds that the lines of the rig really have.

    A line goes on at the acceleration that it had over the last stretch. What its angle missed by then is made up in
    equal parts over the next one, so that no load jumps.
    """

    def __init__(self, loads: TurningLoads, angles: Array) -> None:
        """Begin at the angles (n_freedoms,) of all freedoms [rad] at which the loads stand at 0."""
        self._loads = loads
        self._zero = loads.speeds(angles)
        self._angle = np.zeros_like(self._zero)
        self._speed = np.zeros_like(self._zero)
        self._elapsed = 0.0

    def ahead(self, angles: Array, speeds: Array, times: Array) -> Array:
        """(k, n) values of the loads at times (k,) after this instant [s], of which the last ends the stretch.

        angles, speeds : of all freedoms at this instant [rad], [rad/s]
        """
        angle, speed = self._loads.speeds(angles) - self._zero, self._loads.speeds(speeds)
        acceleration = (speed - self._speed) / self._elapsed if self._elapsed else np.zeros_like(speed)
        missed, since = angle - self._angle, times[:, None]
        way = angle + since * (speed + 0.5 * since * acceleration) - missed * (1.0 - since / times[-1])
        self._angle, self._speed, self._elapsed = way[-1], speed, float(times[-1])
        return self._loads.values(way, speed + since * acceleration)


def acting(loads: Sequence[PeriodicLoad]) -> list[PeriodicLoad]:
    """Those of loads that are not zero."""
    return [load for load in loads if np.any(load.load) and any(part.amplitude for part in load.parts)]
