"""The motor's torque over the schedule under other losses, without marching again.

The speed control holds the schedule, so that what the motor gives beyond a first run is what the losses have grown
by: drag of bearings, windage, oil and seals at the speed of each moment, tooth friction by its share of the load. The
lag of the control is left out: of a change of 1 N m of windage some 2 % in a run-up of 3 s, less in a longer one.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dynamics.response.command import DragCurve
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.drag_torques import drag_shafts
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.time_run import drag_curves, schedule_of, torque_limits
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


def peaks_only(ramp: TimeResponse) -> TimeResponse:
    """The run with one sample a window, that at which the motor gives most: small enough to be handed on.

    Highest torque and windows are those of the whole run.
    """
    length = max(1, round(ramp.windows.duration / float(ramp.time[1] - ramp.time[0])))
    starts = np.arange(0, len(ramp.time), length)
    size = np.abs(ramp.drive_torque)
    keep = np.array([start + int(np.argmax(size[start : start + length])) for start in starts])
    return replace(
        ramp,
        time=ramp.time[keep],
        speed=ramp.speed[keep],
        speed_command=ramp.speed_command[keep],
        drive_torque=ramp.drive_torque[keep],
        twist=ramp.twist[keep],
        drag_torque={},
        torque=ramp.torque[:, :0],
    )


def shifted_drive(rig: Rig, warm: IterationResult, ramp: TimeResponse, stated: Array) -> TimeResponse | None:
    """``ramp`` of the stated rig with the motor's torque under the losses of ``warm``.

    stated : `losses_on_motor` of the stated rig over ``ramp`` [N m], (n,)

    None where the motor gives no more or gave no more in ``ramp``: the torque at its limit is not what the losses
    ask for, and the run must be marched.
    """
    stage = schedule_of(rig).at(ramp.time).stage
    most = (1.0 - 1e-9) * torque_limits(rig)[stage]
    torque = ramp.drive_torque + losses_on_motor(rig, warm, ramp) - stated
    if np.any(np.abs(torque) >= most) or np.any(np.abs(ramp.drive_torque) >= most):
        return None
    return replace(ramp, drive_torque=torque)


def losses_on_motor(rig: Rig, warm: IterationResult, ramp: TimeResponse) -> Array:
    """Torque that all losses ask of the motor over the time of the run [N m], (n,)."""
    return drag_on_motor(rig, warm, ramp) + friction_on_motor(rig, warm, ramp)


def drag_on_motor(rig: Rig, warm: IterationResult, ramp: TimeResponse) -> Array:
    """Torque of all drags at the motor over the time of the run [N m], (n,)."""
    assert rig.drivetrain is not None
    curves: Mapping[str, DragCurve] = drag_curves(rig, warm, warm.coupling_state)
    shafts = drag_shafts(rig.drivetrain)
    total = np.zeros(len(ramp.time))
    for name, curve in curves.items():
        ratio = rig.shaft_speed(shafts[name], 1.0)
        speed = np.abs(ramp.speed) * ratio / rig.pinion_speed(1.0)
        total += ratio / rig.drive_speed(1.0) * np.interp(speed, curve.speed, curve.torque)
    return total


def friction_on_motor(rig: Rig, warm: IterationResult, ramp: TimeResponse) -> Array:
    """Torque of all tooth friction at the motor over the time of the run [N m], (n,): it follows the load."""
    held, speed = abs(rig.torque_ratio * warm.point.torque), rig.drive_speed(warm.point.speed)
    if not held or not speed:
        return np.zeros(len(ramp.time))
    power = sum(placed.loss.power for placed in warm.losses if placed.loss.kind == "mesh")
    load = np.abs(schedule_of(rig).at(ramp.time).torque)
    return np.asarray(power / speed * load / held)
