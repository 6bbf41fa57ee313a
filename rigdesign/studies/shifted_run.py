"""The envelopes of the time run under warmer or colder gears, without marching again.

In every window of the run the highest and the lowest torque move by what the periodic response at its speed and
torque moves by: the run passes its speeds slowly against the decay of its vibrations, so that both differ from it by
the same. Windows below the least torque at which the response is known keep what they have. Torques of shafts and
joints alternate in proportion to the mesh whose envelope grows most.

On the prototype, oil at 140 degC moved to 60 and to 180 degC: peaks of the loaded stages within 1.5 % of their
mean torque and the least torques within 2.5 %; the governing ones within 0.05 and 0.7 %
(`tests/verification/test_shifted_run.py`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dynamics.vibration.command import DragCurve
from dynamics.vibration.propagator import SectionEnvelopes
from dynamics.vibration.response_curve import ResponseCurve
from dynamics.vibration.time_response import EnvelopeWindows, TimeResponse
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import drag_shafts
from rigdesign.coupling.time_run import drag_curves, schedule_of, torque_limits
from rigdesign.postprocessing.curves import Curves
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]


LIGHT = 0.9
"""Share of the least torque of a curve below which a window keeps its envelope."""
FARTHEST = 0.15
"""Shift of an envelope, as a share of the mean torque, beyond which the run is marched again."""


def shifted_run(rig: Rig, stated: DynamicRun, curves: Curves) -> TimeResponse | None:
    """The time run of ``stated`` with its envelopes moved to the response ``curves`` of the modified rig.

    None where that tells nothing: an envelope moves by more than `FARTHEST` of its mean, teeth lose contact or come
    near it in a loaded stage, a curve has gaps, or the torques of the curves differ. Beyond the speeds of a curve its
    end counts.
    """
    if set(stated.curves.named) != set(curves.named):
        return None
    before, after = _ordered(stated.curves), _ordered(curves)
    if any(curve.failed for curve in (*before, *after)):
        return None
    windows = stated.ramp.windows
    least, greatest = windows.least.copy(), windows.greatest.copy()
    for mesh in range(len(rig.mesh_names)):
        edges = _shifted(windows, mesh, before, after)
        if edges is None:
            return None
        least[mesh], greatest[mesh] = edges
    moved = replace(windows, least=least, greatest=greatest)
    sections = None if stated.ramp.sections is None else _widened(stated.ramp.sections, windows, moved)
    return replace(stated.ramp, windows=moved, sections=sections)


def _widened(sections: SectionEnvelopes, before: EnvelopeWindows, after: EnvelopeWindows) -> SectionEnvelopes:
    """Torques of the sections, alternating about their means as that mesh whose envelope grows most."""
    width, wider = (windows.greatest - windows.least for windows in (before, after))
    ratio = np.max(np.where(width > 0.0, wider / np.where(width > 0.0, width, 1.0), 1.0), axis=0)
    return replace(
        sections,
        least=sections.mean + ratio * (sections.least - sections.mean),
        greatest=sections.mean + ratio * (sections.greatest - sections.mean),
    )


def _shifted(
    windows: EnvelopeWindows, mesh: int, before: Sequence[ResponseCurve], after: Sequence[ResponseCurve]
) -> tuple[Array, Array] | None:
    """Lowest and highest torque of a mesh in every window [N m], (n,) each, moved from one response to another."""
    mean = windows.mean[mesh]
    load = np.abs(mean)
    low, high = (
        _factor(windows.speed, load, mesh, after, edge) - _factor(windows.speed, load, mesh, before, edge)
        for edge in ("minimum", "maximum")
    )
    loaded = load >= LIGHT * _torque(before[0], mesh)
    moves = np.where(loaded, (low, high), 0.0)
    parted = loaded & (windows.out_of_contact[mesh] > 0.0)
    if np.max(np.abs(moves), initial=0.0) > FARTHEST or np.any(parted):
        return None
    down, up = load * moves[0], load * moves[1]
    turned = mean.sum() < 0.0
    edges = (
        windows.least[mesh] - up if turned else windows.least[mesh] + down,
        windows.greatest[mesh] - down if turned else windows.greatest[mesh] + up,
    )
    reserve = edges[1] if turned else edges[0]
    if np.any(loaded & ((reserve >= 0.0) if turned else (reserve <= 0.0))):
        return None
    return edges


def _ordered(curves: Curves) -> list[ResponseCurve]:
    """The curves of the shipped mesh laws, least torque first."""
    return [curve for _, curve in sorted(curves.named.values(), key=lambda item: abs(item[0]))]


def _torque(curve: ResponseCurve, mesh: int) -> float:
    """Mean torque of a mesh over a curve [N m]."""
    return float(np.mean([abs(point.mean[mesh]) for point in curve.points]))


def _factor(speed: Array, load: Array, mesh: int, curves: Sequence[ResponseCurve], edge: str) -> Array:
    """Highest or lowest torque over the mean [-] at speeds and torques (n,): linear between curves and their points."""
    torques = np.array([_torque(curve, mesh) for curve in curves])
    factors = np.array(
        [
            np.interp(
                speed, *_over_speed([(p.speed, getattr(p, edge)[mesh] / p.mean[mesh]) for p in curve.points])
            )
            for curve in curves
        ]
    )
    if len(torques) == 1:
        return np.asarray(factors[0])
    upper = np.clip(np.searchsorted(torques, load), 1, len(torques) - 1)
    lower = upper - 1
    share = np.clip((load - torques[lower]) / (torques[upper] - torques[lower]), 0.0, 1.0)
    number = np.arange(len(load))
    return np.asarray((1.0 - share) * factors[lower, number] + share * factors[upper, number])


def _over_speed(points: Sequence[tuple[float, float]]) -> tuple[Array, Array]:
    """Speeds, rising, and values (n,) each."""
    table = np.array(sorted(points))
    return table[:, 0], table[:, 1]


# The motor's torque over the schedule under other losses, without marching again.
#
# The speed control holds the schedule, so that what the motor gives beyond a first run is what the losses have grown
# by: drag of bearings, windage, oil and seals at the speed of each moment, tooth friction by its share of the load. The
# lag of the control is left out: of a change of 1 N m of windage some 2 % in a run-up of 3 s, less in a longer one.


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
