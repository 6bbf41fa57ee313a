"""Steady state from which an event starts, with all loads that alternate with a shaft.

A periodic state holds those of them that have whole waves in its period. The others, as an unbalance of the wheel where
the period is a turn of the pinion, come up afterwards while the rig turns on at constant speed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dynamics.drivetrain.linear_system import LinearSystem
from dynamics.drivetrain.loop_load import LoopLoad
from dynamics.drivetrain.periodic_load import left_out, within_period
from dynamics.errors import DynamicsInputError
from dynamics.mesh.law import MeshLaw
from dynamics.response.held_speed import HeldSpeed
from dynamics.response.initial_state import pinion_ratios
from dynamics.response.march_inputs import DragTables, DriveLoads, DriveState, MarchSettings
from dynamics.response.march_loads import march_model
from dynamics.response.periodic_response import (
    DEFAULT_TIME,
    Period,
    TimeSettings,
    period_length,
    periodic_by_time,
)
from dynamics.response.time_march import TimeMarch
from dynamics.response.turning_loads import TurningLoads, acting

SAMPLE_RATE, SUBSTEPS = 80e3, 4
"""Samples of the channels per second, and internal steps in one."""
RISE, RISE_TURNS = 0.1, 2.0
"""Time [s] and turns of the first pinion in which loads come up, the longer of the two."""
BLOCKS = 4
"""Length of the settling, in those of the rise; the mean speed is held from one to the next."""


@dataclass(frozen=True, kw_only=True)
class SteadyStart:
    """Steady state before an event: state, motor torque [N m], drag torques by name [N m].

    speed : of the first pinion [rad/s]; angle : of the first pinion [rad], by which loads that alternate stand
    period : in which the state was sought
    settled : names and orders of loads that no whole number of waves fits into that period: they came up during the
        ``settling`` [s] after it, and stand at the event as they happen to
    doubts : why it is not steady; empty where it is
    """

    speed: float
    state: DriveState
    drive_torque: float
    drags: Mapping[str, float]
    angle: float
    period: Period = "mesh"
    settled: tuple[str, ...] = ()
    settling: float = 0.0
    doubts: tuple[str, ...] = ()


def steady_start(
    system: LinearSystem,
    laws: Sequence[MeshLaw],
    speed: float,
    torque: float,
    drags: Mapping[str, float],
    settings: TimeSettings = DEFAULT_TIME,
) -> SteadyStart:
    """Steady state at a speed of the first pinion [rad/s] and a torque of the first mesh [N m], by time integration.

    The period of the settings is taken for a turn of the first pinion where it is that of a mesh and loads alternate
    with a shaft.

    Raises DynamicsInputError and DynamicsNotConverged as `TimeIntegration.periodic`.
    """
    period = _period(system, laws, settings.period)
    found = periodic_by_time(
        system, laws, speed, LoopLoad(torque=torque), drags, replace(settings, period=period)
    )
    start = SteadyStart(
        speed=speed,
        state=found.end,
        drive_torque=found.drive_torque,
        drags=dict(drags),
        angle=float(found.end.angles[system.mesh_ports[0, 0]]),
        period=period,
        doubts=() if found.steady else tuple(found.warnings),
    )
    missing = _left_out(system, laws, period)
    return _settled(system, laws, start, missing, settings.cutoff) if missing else start


def march_settings(cutoff: float) -> MarchSettings:
    """Steps of an event."""
    return MarchSettings(
        step=1.0 / SAMPLE_RATE / SUBSTEPS, substeps=SUBSTEPS, cutoff=cutoff, accounts=False, record_all=False
    )


def constant_drags(drags: Mapping[str, float]) -> DragTables:
    """Drag torques [N m] that do not follow the speed."""
    return DragTables(torque=np.array([[value, value] for value in drags.values()]).reshape(len(drags), 2))


def _period(system: LinearSystem, laws: Sequence[MeshLaw], asked: Period) -> Period:
    if asked != "mesh" or not acting(system.periodic_loads):
        return asked
    try:
        _turns(system, laws, "revolution")
    except DynamicsInputError:
        return asked
    return "revolution"


def _turns(system: LinearSystem, laws: Sequence[MeshLaw], period: Period) -> float:
    ratios = pinion_ratios(system, laws)
    return period_length(laws, [ratios[pinion] for pinion in system.mesh_ports[:, 0]], period)


def _left_out(system: LinearSystem, laws: Sequence[MeshLaw], period: Period) -> tuple[str, ...]:
    loads = acting(system.periodic_loads)
    if not loads:
        return ()
    return tuple(left_out(loads, pinion_ratios(system, laws), _turns(system, laws, period)))


def _settled(
    system: LinearSystem, laws: Sequence[MeshLaw], start: SteadyStart, missing: tuple[str, ...], cutoff: float
) -> SteadyStart:
    """March on with constant motor torque and twist while the missing loads come up; the mean speed is held."""
    steady = HeldSpeed(system, laws, start.speed)
    ratios = steady.ratios
    held, rising = _parted(system, laws, start.period)
    turn = 2.0 * np.pi / start.speed
    rise = turn * np.ceil(max(RISE / turn, RISE_TURNS))
    count = round(rise * SAMPLE_RATE)
    angles, speeds = start.angle * ratios[held.dofs], start.speed * ratios[held.dofs]
    drive = start.drive_torque
    march = TimeMarch(
        system,
        laws,
        start.state,
        march_settings(cutoff),
        DriveLoads(drive_torque=drive, drag_torques=start.drags, periodic=held.values(angles, speeds)),
        march_model(system, laws, tuple(start.drags), cutoff),
    )
    for block in range(BLOCKS):
        time = (block * count + 1 + np.arange(count)) / SAMPLE_RATE
        at = angles + time[:, None] * speeds
        share = np.minimum(time / rise, 1.0)[:, None]
        given = np.zeros((count, 4 + len(system.periodic_loads)))
        given[:, 0], given[:, 1] = drive, start.state.twist
        given[:, 4:] = held.values(at, speeds) + share**2 * (3.0 - 2.0 * share) * rising.values(at, speeds)
        turned = march.advance(given, drags=constant_drags(start.drags)).slow_speed[:, 0]
        mean = float(turned.mean() / ratios[system.drive_dof])
        change = steady.correction(mean, rise)
        march.kick(change.kick)
        drive += change.drive_torque
    duration = BLOCKS * count / SAMPLE_RATE
    return replace(
        start,
        state=march.state(),
        drive_torque=drive,
        angle=start.angle + start.speed * duration,
        settled=missing,
        settling=duration,
    )


def _parted(
    system: LinearSystem, laws: Sequence[MeshLaw], period: Period
) -> tuple[TurningLoads, TurningLoads]:
    """The loads of a system with the orders that a period holds alone, and with the others alone."""
    loads = system.periodic_loads
    held = within_period(loads, pinion_ratios(system, laws), _turns(system, laws, period))
    rest = [
        replace(load, parts=tuple(part for part in load.parts if part not in own.parts))
        for load, own in zip(loads, held)
    ]
    return TurningLoads(system, held), TurningLoads(system, rest)
