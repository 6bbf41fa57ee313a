"""The time run over the schedule as records: envelopes, loads of every stage, loss of contact by stage."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dynamics.response.envelopes import EnvelopeWindows, split_lift_off
from dynamics.response.time_response import TimeResponse
from rigdesign.coupling.time_run import LEAST_TORQUE, schedule_of, stage_names
from rigdesign.records.curves import own_ratio
from rigdesign.results.dynamics import RampHistory
from rigdesign.results.loads import ContactLoss, StageLoad
from rigdesign.results.units import RPM
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


def bounds(windows: EnvelopeWindows, mesh: int) -> tuple[Array, Array, Array]:
    """Lowest, mean and highest torque of a mesh in every window [N m], positive on the flank that carries the run."""
    sign = -1.0 if windows.mean[mesh].sum() < 0.0 else 1.0
    edges = sign * windows.least[mesh], sign * windows.greatest[mesh]
    return np.minimum(*edges), sign * windows.mean[mesh], np.maximum(*edges)


def torque_peak(windows: EnvelopeWindows, mesh: int) -> float:
    """Highest dynamic torque of the run [N m], whichever flank carries."""
    return float(max(np.abs(windows.least[mesh]).max(), np.abs(windows.greatest[mesh]).max()))


def stage_loads(rig: Rig, ramp: TimeResponse, mesh: int) -> Iterator[StageLoad]:
    """Load of one mesh in every stage that turns under torque, by the envelopes of the time run."""
    low, mean, high = bounds(ramp.windows, mesh)
    speed = own_ratio(rig, mesh) * ramp.windows.speed
    stages = np.array(_window_stages(rig, ramp))
    for stage in schedule_of(rig).stages:
        own = np.flatnonzero((stages == stage.name) & (mean > LEAST_TORQUE) & (speed > 0.0))
        if own.size == 0 or max(stage.speed) <= 0.0:
            continue
        worst, loosest = own[np.argmax(high[own] / mean[own])], own[np.argmin(low[own] / mean[own])]
        yield StageLoad(
            stage=stage.name,
            dynamic_factor=float(high[worst] / mean[worst]),
            speed=float(speed[worst]),
            mean=float(mean[worst]),
            peak=float(high[own].max()),
            least=float(low[own].min()),
            least_share=float(low[loosest] / mean[loosest]),
            least_share_speed=float(speed[loosest]),
            least_share_mean=float(mean[loosest]),
        )


def contact_losses(rig: Rig, ramp: TimeResponse, mesh: int) -> Iterator[ContactLoss]:
    """Intervals of the run in which a mesh kept losing contact, cut at the ends of the stages."""
    schedule = schedule_of(rig)
    own = [interval for interval in ramp.lift_off if interval.mesh == mesh]
    pieces = split_lift_off(ramp.windows, own, schedule.starts[1:-1])
    middles = np.array([0.5 * (piece.start + piece.end) for piece in pieces])
    for piece, name in zip(pieces, stage_names(schedule, middles) if pieces else []):
        yield ContactLoss(
            stage=name,
            start=piece.start,
            end=piece.end,
            share=piece.out_of_contact,
            longest_gap=piece.longest_gap,
        )


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
