"""The time run over the schedule as records: envelopes, loads of every stage, loss of contact by stage."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from dynamics.response.envelopes import EnvelopeWindows, split_lift_off
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.time_run import LEAST_TORQUE, schedule_of, stage_names
from rigdesign.records.curves import own_ratio
from rigdesign.results.result import RampHistory
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
RPM = 30.0 / np.pi


def bounds(windows: EnvelopeWindows, mesh: int) -> tuple[Array, Array, Array]:
    """Lowest, mean and highest torque of a mesh in every window [N m], positive on the flank that carries the run."""
    sign = -1.0 if windows.mean[mesh].sum() < 0.0 else 1.0
    edges = sign * windows.least[mesh], sign * windows.greatest[mesh]
    return np.minimum(*edges), sign * windows.mean[mesh], np.maximum(*edges)


def torque_peak(windows: EnvelopeWindows, mesh: int) -> float:
    """Highest dynamic torque of the run [N m], whichever flank carries."""
    return float(max(np.abs(windows.least[mesh]).max(), np.abs(windows.greatest[mesh]).max()))


def stage_loads(rig: Rig, ramp: TimeResponse, mesh: int) -> list[dict[str, Any]]:
    """Load of one mesh in every stage that turns under torque, by the envelopes of the time run.

    dynamic_factor : highest torque over the mean of its window, and the speed of the mesh's pinion where it
        occurs; least_share : lowest torque over the mean of its window, below zero where the other flank is hit
    """
    low, mean, high = bounds(ramp.windows, mesh)
    speed = own_ratio(rig, mesh) * ramp.windows.speed * RPM
    stages = np.array(_window_stages(rig, ramp))
    rows = []
    for stage in schedule_of(rig).stages:
        own = np.flatnonzero((stages == stage.name) & (mean > LEAST_TORQUE) & (speed > 0.0))
        if own.size == 0 or max(stage.speed) <= 0.0:
            continue
        worst, loosest = own[np.argmax(high[own] / mean[own])], own[np.argmin(low[own] / mean[own])]
        rows.append(
            {
                "stage": stage.name,
                "dynamic_factor": float(high[worst] / mean[worst]),
                "speed_rpm": float(speed[worst]),
                "mean_Nm": float(mean[worst]),
                "peak_Nm": float(high[own].max()),
                "least_Nm": float(low[own].min()),
                "least_share": float(low[loosest] / mean[loosest]),
                "least_share_at_rpm": float(speed[loosest]),
                "least_share_mean_Nm": float(mean[loosest]),
            }
        )
    return rows


def lift_off(rig: Rig, ramp: TimeResponse, mesh: int) -> list[dict[str, Any]]:
    """Intervals of the run in which a mesh kept losing contact, cut at the ends of the stages."""
    schedule = schedule_of(rig)
    own = [interval for interval in ramp.lift_off if interval.mesh == mesh]
    pieces = split_lift_off(ramp.windows, own, schedule.starts[1:-1])
    middles = np.array([0.5 * (piece.start + piece.end) for piece in pieces])
    return [
        {
            "stage": name,
            "start_s": piece.start,
            "end_s": piece.end,
            "share": piece.out_of_contact,
            "longest_gap_ms": 1e3 * piece.longest_gap,
        }
        for piece, name in zip(pieces, stage_names(schedule, middles) if pieces else [])
    ]


def ramp_history(rig: Rig, ramp: TimeResponse) -> RampHistory:
    """Envelopes of the time run in windows."""
    windows = ramp.windows
    command = schedule_of(rig).at(_middles(ramp))
    drive = np.interp(windows.time, ramp.time, ramp.drive_torque)
    torque = {}
    for mesh, name in enumerate(rig.mesh_names):
        low, mean, high = bounds(windows, mesh)
        torque[rig.mesh_labels[name]] = {
            "mean": mean.tolist(),
            "maximum": high.tolist(),
            "minimum": low.tolist(),
        }
    return RampHistory(
        time_s=windows.time.tolist(),
        speed_rpm=(windows.speed * RPM).tolist(),
        stage=_window_stages(rig, ramp),
        target_torque_Nm=command.torque.tolist(),
        drive_torque_Nm=drive.tolist(),
        torque=torque,
    )


def _middles(ramp: TimeResponse) -> Array:
    return np.asarray(ramp.windows.time - 0.5 * ramp.windows.duration)


def _window_stages(rig: Rig, ramp: TimeResponse) -> list[str]:
    """Stage of every window, by its middle."""
    return stage_names(schedule_of(rig), _middles(ramp))
