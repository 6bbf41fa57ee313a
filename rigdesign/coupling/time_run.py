"""The time run over the whole schedule: once, after the coupling loop, with the warm rig of its last point."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from dynamics.vibration.command import Command as RunCommand
from dynamics.vibration.command import DragCurve, MotorDrive, Sampling
from dynamics.vibration.modal_model import DEFAULT_CUTOFF
from dynamics.vibration.schedule import Kind, Schedule, Stage, StageCommand, s_function
from dynamics.vibration.time_response import TimeResponse, run_schedule
from rigdesign.base.errors import NotConvergedError
from rigdesign.case.schedule import StageValues
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import drag_shafts, drag_torques
from rigdesign.coupling.loop_over_speed import loop_over_speed
from rigdesign.coupling.loop_system import twist_rows_of
from rigdesign.coupling.losses import rotating_losses
from rigdesign.coupling.preloaded_loop import BracingState, locked_share, shifted_laws
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.rig.drivetrain import mesh_frequency
from rigdesign.rig.model import Rig

KINDS: Mapping[str, Kind] = {
    "load": "torque", "unload": "torque", "run_up": "speed", "run_down": "speed", "dwell": "hold"
}  # fmt: skip
DRAG_SHARES = (0.02, 0.0625, 0.125, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0)
"""Shares of the highest speed at which drag torques are computed for the run."""
SPEED_TOLERANCE = 0.01
"""Share of the test speed that may be missing at the end of a run-up."""
DIVERGED = 2.0
"""Error of the speed, in highest speeds of the schedule, from which a run diverges."""
WINDOW = 0.01
"""Length of the envelope windows [s]."""
LEAST_TORQUE = 1.0
"""Bracing torque [N m] that is kept at standstill: the flanks just touch."""
ELASTIC_CUTOFF, MESH_ORDERS = 20e3, 1.25
"""Highest mode of the time run of elastic shafts at least [Hz], and per mesh frequency of the test speed."""
DRIVE_ONSET = 0.1
"""Time over which a constant drive torque is applied by the S-function [s]."""
MOST_KEPT = 4e6
"""Torques of one mesh up to which a time run keeps them for their spectra, 16 MB; a longer run has none."""
SPECTRUM_ORDERS = 3.2
"""Mesh orders at the highest speed up to which they are kept: three with their sidebands."""
RPM = np.pi / 30.0
COMMAND_INTERVAL = 1e-3
"""Interval of the command samples [s]."""


def schedule_of(rig: Rig) -> Schedule:
    """The stages of the case as a schedule.

    Raises
    ------
    ScheduleError
        Stages that contradict themselves.
    """
    return Schedule(stages=tuple(_stage(rig, stage) for stage in rig.case.schedule.resolved()))


def _stage(rig: Rig, stage: StageValues) -> Stage:
    ratio = rig.torque_ratio
    return Stage(
        name=stage.name,
        kind=KINDS[stage.kind],
        speed=(rig.pinion_speed(stage.speed_start), rig.pinion_speed(stage.speed_end)),
        torque=(ratio * stage.torque_start, ratio * stage.torque_end),
        duration=stage.duration,
        held=stage.held,
    )


def run_ramp(
    rig: Rig, warm: IterationResult, setting: BracingState, coupling_state: CouplingState
) -> TimeResponse:
    """March over the schedule with the warm gears and films of ``warm``.

    A run that misses the speed of a stage ends before that stage, with the reason and the torque balance.

    Raises
    ------
    NotConvergedError
        The first stage is missed: there is nothing before it.
    """
    schedule = schedule_of(rig)
    command = schedule.command(COMMAND_INTERVAL)
    numerics = rig.case.numerics
    controlled = setting.mode == "torque_controlled"
    laws = shifted_laws(rig, warm.models, setting)
    top = max(stage.speed_end for stage in rig.case.schedule.resolved())
    loop = loop_over_speed(rig, warm, (0.0, top), partial(torque_share_at, rig, warm))
    sampling = Sampling(
        sample_rate=numerics.sample_rate,
        substeps=numerics.internal_steps,
        window=WINDOW,
        torque_band=SPECTRUM_ORDERS * highest_mesh_frequency(rig, top) / (2.0 * np.pi),
        keep_accounts=False,
        cutoff=_cutoff(rig),
        sections=lambda speed: twist_rows_of(rig, speed / rig.pinion_speed(1.0)),
    )
    response = run_schedule(
        loop,
        laws,
        RunCommand(
            time=command.time,
            speed=_speed_command(rig, schedule, command),
            torque=np.maximum(command.torque * locked_share(rig), LEAST_TORQUE) if controlled else None,
            twist=None if controlled else np.full_like(command.time, setting.twist),
        ),
        drags=drag_curves(rig, warm, coupling_state),
        motor=MotorDrive(torque_limit=torque_limits(rig)[command.stage]),
        sampling=replace(sampling, keep_channels=sampling.torques_kept(command.time[-1]) <= MOST_KEPT),
    )
    missed = missed_stage(rig, schedule, response)
    if missed is None:
        return response
    number, reason = missed
    if number == 0:
        raise NotConvergedError(reason, {"stage": schedule.stages[0].name, "traces": _traces(response)})
    return response.until(float(schedule.starts[number]), reason)


def highest_mesh_frequency(rig: Rig, speed: float) -> float:
    """Angular mesh frequency of the fastest mesh at a stated speed [rad/s]."""
    return max(
        rig.pairs[name].gears[0].teeth * abs(rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, speed))
        for mesh, name in enumerate(rig.mesh_names)
    )


def _cutoff(rig: Rig) -> float:
    """Highest mode of the time run [Hz]; those above keep their static effect."""
    if rig.shaft_model == "torsional":
        return DEFAULT_CUTOFF
    return min(max(ELASTIC_CUTOFF, MESH_ORDERS * mesh_frequency(rig.case) / (2.0 * np.pi)), DEFAULT_CUTOFF)


def torque_share_at(rig: Rig, warm: IterationResult, speed: float) -> float:
    """Torque at which the schedule holds a speed [rad/s], else under which it first reaches it, per that of the warm
    point."""
    stages = rig.case.schedule.resolved()
    for stage in (*(stage for stage in stages if stage.held), *stages):
        low, high = sorted((stage.speed_start, stage.speed_end))
        if low <= speed <= high and warm.point.torque:
            return stage.torque_end / warm.point.torque
    return 1.0


def torque_limits(rig: Rig) -> NDArray[np.float64]:
    """Largest torque of the motor in every stage [N m]: its own limit, or the constant torque the stage asks for."""
    own = rig.case.power_circuit.motor.torque_limit
    return np.array(
        [
            own if stage.drive_torque is None else min(own, stage.drive_torque)
            for stage in rig.case.schedule.resolved()
        ]
    )


def _speed_command(rig: Rig, schedule: Schedule, command: StageCommand) -> NDArray[np.float64]:
    """Speed over time [rad/s]; a stage with a constant drive torque asks for its end speed at once.

    The controller then stands at its torque limit until the speed is there: the stage's duration is the most it
    may take.
    """
    speed = command.speed.copy()
    for index, stage in enumerate(rig.case.schedule.resolved()):
        if stage.drive_torque is not None:
            own = command.stage == index
            since = command.time[own] - command.time[own][0]
            start, end = schedule.stages[index].speed
            speed[own] = start + (end - start) * s_function(since / DRIVE_ONSET)
    return speed


def drag_curves(rig: Rig, warm: IterationResult, coupling_state: CouplingState) -> dict[str, DragCurve]:
    """Drag torque over speed of every place that brakes, with the films at their own balance at each speed.

    A jet that is faster than the teeth at low speed pushes them; that help is left out of the run.
    """
    top = max(stage.speed_end for stage in rig.case.schedule.resolved())
    speeds = [share * top for share in DRAG_SHARES]
    tables = [drags_at(rig, warm, coupling_state, speed) for speed in speeds]
    shafts = drag_shafts(rig.drivetrain)
    curves = {}
    for name in tables[-1]:
        place = np.array([0.0, *(rig.shaft_speed(shafts[name], speed) for speed in speeds)])
        torque = [max(table.get(name, 0.0), 0.0) for table in tables]
        curves[name] = DragCurve(speed=place, torque=np.array([torque[0], *torque]))
    return curves


def drags_at(
    rig: Rig, warm: IterationResult, coupling_state: CouplingState, speed: float
) -> dict[str, float]:
    """Drag torques at one speed [N m] under the load of the warm point."""
    point = replace(warm.point, speed=speed)
    bearings = solve_bearings(rig, point, coupling_state)
    return drag_torques(rotating_losses(rig, point, coupling_state, warm.models, bearings), rig, speed)


def missed_stage(rig: Rig, schedule: Schedule, response: TimeResponse) -> tuple[int, str] | None:
    """Number of the first stage that does not end at its speed, a dwell at the speed it holds, and what went wrong.

    The speed is the mean over whole mesh periods before the end of the stage: a vibration is no lack of speed. None
    where all stages do.
    """
    top = max(max(stage.speed) for stage in schedule.stages)
    limit = SPEED_TOLERANCE * top
    off = np.abs(response.speed - response.speed_command) > DIVERGED * top
    lost = float(response.time[np.argmax(off)]) if off.any() else np.inf
    for number, (stage, end, most) in enumerate(
        zip(schedule.stages, schedule.starts[1:], torque_limits(rig))
    ):
        if lost <= end:
            return number, _diverged(stage, response, lost)
        mean = response.mean_speed(float(end), mesh_synchronous_window(rig, stage.speed[1], stage.duration))
        excess = mean - stage.speed[1]
        if abs(excess) > limit:
            at = min(int(np.searchsorted(response.time, end)), len(response.time) - 1)
            return number, (
                f"stage {stage.name!r} {_missed(stage, excess)}: {mean / RPM:.0f} rpm against "
                f"{stage.speed[1] / RPM:.0f} rpm at {end:.2f} s, limit {limit / RPM:.0f} rpm. "
                f"{_balance(rig, response, at)}; {_remedy(float(response.drive_torque[at]), float(most))}"
            )
    return None


def _diverged(stage: Stage, response: TimeResponse, lost: float) -> str:
    """What is said of a run whose speed leaves that of all stages: more torque would not help."""
    low, high = (value / RPM for value in (response.speed.min(), response.speed.max()))
    commands = [value / RPM for value in (response.speed_command.min(), response.speed_command.max())]
    return (
        f"the time run diverges in stage {stage.name!r} from {lost:.2f} s on: speed {low:.0f} to {high:.0f} rpm where "
        f"{commands[0]:.0f} to {commands[1]:.0f} rpm are asked. The speed control shakes the motor against the rig, "
        "its torque is not too small; raise numerics.sample_rate or correct drivetrain.motor.inertia"
    )


def _traces(response: TimeResponse) -> dict[str, list[float]]:
    """Speed and motor torque over the schedule, at 2000 times at most."""
    every = slice(None, None, max(1, len(response.time) // 2000))
    return {
        "time_s": response.time[every].tolist(),
        "speed_rpm": (response.speed[every] / RPM).tolist(),
        "speed_command_rpm": (response.speed_command[every] / RPM).tolist(),
        "drive_torque_Nm": response.drive_torque[every].tolist(),
    }


def mesh_synchronous_window(rig: Rig, speed: float, duration: float) -> float:
    """Whole periods of the first mesh that last one window at least, within the stage [s].

    speed : of the pinion of the first mesh [rad/s]; duration : of the stage [s]
    """
    period = 2.0 * np.pi / (speed * rig.pairs[rig.mesh_names[0]].gears[0].teeth) if speed > 0.0 else WINDOW
    return min(float(np.ceil(WINDOW / period)) * period, duration)


def _missed(stage: Stage, excess: float) -> str:
    """What went wrong at the end of a stage that is ``excess`` too fast [rad/s]."""
    if stage.kind != "speed":
        return f"does not hold its speed, {abs(excess) / RPM:.0f} rpm {'too slow' if excess < 0.0 else 'too fast'}"
    if stage.actual_direction == "rising":
        return (
            "does not reach its speed" if excess < 0.0 else f"overshoots its speed by {excess / RPM:.0f} rpm"
        )
    if excess < 0.0:
        return f"falls through its speed by {-excess / RPM:.0f} rpm"
    return f"does not come down to its speed, {excess / RPM:.0f} rpm are left"


def _balance(rig: Rig, response: TimeResponse, at: int) -> str:
    drag = sum(float(torque[at]) for torque in response.drag_torque.values())
    return (
        f"Torque balance: motor {response.drive_torque[at]:.2f} N m (drivetrain.motor.torque_limit "
        f"{rig.case.power_circuit.motor.torque_limit:.2f} N m), drag of bearings, windage, oil and seals "
        f"{drag:.2f} N m, the rest tooth friction and acceleration"
    )


def _remedy(drive_torque: float, limit: float) -> str:
    if abs(drive_torque) >= 0.999 * limit:
        return "raise the limit or give the stage more time"
    return (
        "the motor is within its limit, so its speed control is still settling: give the stage more time, or "
        "stiffen the shaft between motor and gears"
    )


def stage_names(schedule: Schedule, time: NDArray[np.float64]) -> list[str]:
    """Stage at each time [s]."""
    index = schedule.at(time).stage
    return [schedule.stages[i].name for i in index]


def held_points(rig: Rig) -> list[OperatingPoint]:
    """Operating points of the stages marked held; the last dwell if none is."""
    return [
        OperatingPoint(stage=stage.name, speed=stage.speed_end, torque=stage.torque_end)
        for stage in rig.case.schedule.held()
    ]
