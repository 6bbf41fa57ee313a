"""The rig under its start torque around the speed at which the torque is first raised: K_V and contact.

At a tenth of the test torque or less the tooth deviations are not closed; slow resonances that are harmless under
load cause contact loss.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dynamics.vibration.response_curve import ResponseCurve
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.postprocessing.curves import own_ratio, resolved, response_solver
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.results.loads import DynamicLoads
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
TOUCHING = 0.05
"""Share of the test torque that closes the flanks, where the case states none."""
USUAL_SHARE = 0.5
"""Of the test torque on the way up (P2, Figure 9), where the case states none."""
BELOW, ABOVE = 0.7, 1.6
"""Speeds looked at, over that at which the torque is first raised."""
SPEEDS = 49


def start_torque(rig: Rig) -> float:
    """Stated torque before the bearings float [N m]."""
    case = rig.case
    torque = case.schedule.test_torque
    return min(case.limits.bearing.start_torque_limit or TOUCHING * torque, USUAL_SHARE * torque)


def first_speed(rig: Rig) -> float:
    """Speed of the first pinion at which the torque may first be raised: the transition speed of the bearings, else the
    first speed of the schedule [rad/s]."""
    floating = rig.case.limits.ramp.transition_speed
    ends = [stage.speed_end for stage in rig.case.schedule.resolved() if stage.speed_end > 0.0]
    return rig.pinion_speed(min(floating or ends[0], rig.case.schedule.test_speed))


@dataclass(frozen=True)
class StagePeak:
    """Highest K_V of a mesh in a stage of the time run, and at which speed of the first pinion [rad/s].

    lost : whether contact is lost in the stage
    """

    stage: str
    factor: float
    speed: float
    lost: bool


@dataclass(frozen=True, eq=False)
class StartResponse:
    """Periodic response under the start torque; speeds of the first pinion, rising [rad/s].

    speed : (n,); factor : (n,) highest K_V of a mesh, NaN where no stable state repeats in every mesh; lost : (n,) True
    where contact is lost
    """

    speed: Array
    factor: Array
    lost: Flags

    def spans(self) -> list[tuple[float, float]]:
        """Lowest and highest computed speed of every interval in which contact is lost, rising."""
        edges = np.flatnonzero(np.diff(np.concatenate(([0], self.lost.astype(int), [0]))))
        return [
            (float(self.speed[first]), float(self.speed[end - 1]))
            for first, end in zip(edges[::2], edges[1::2])
        ]

    def holds_at(self, speed: float) -> bool:
        """Whether the flanks stay in contact at a computed speed, between two of them at both; True outside them."""
        below = int(np.searchsorted(self.speed, speed, side="right")) - 1
        above = int(np.searchsorted(self.speed, speed))
        inside = below >= 0 and above < self.speed.size
        return not inside or not bool(self.lost[below] or self.lost[above])

    def held(self, windows: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        """What is left of rising windows of speeds (low, high) without those at which contact is lost."""
        left = list(windows)
        for low, high in self._parting():
            pieces = [piece for a, b in left for piece in ((a, min(b, low)), (max(a, high), b))]
            left = [(a, b) for a, b in pieces if a < b]
        return left

    def _parting(self) -> Iterator[tuple[float, float]]:
        """Computed speeds next to every interval of `spans` on both sides, between which `holds_at` says no."""
        for first, last in self.spans():
            below, above = self.speed[self.speed < first], self.speed[self.speed > last]
            yield (
                float(below[-1]) if below.size else float(np.nextafter(first, 0.0)),
                float(above[0]) if above.size else float(np.nextafter(last, np.inf)),
            )

    def next_held(self, speed: float) -> float | None:
        """Least computed speed from one on at which the flanks stay in contact there and at the next; None if none."""
        free = (self.speed[:-1] >= speed) & ~self.lost[:-1] & ~self.lost[1:]
        return float(self.speed[:-1][free][0]) if free.any() else None


def response_under(rig: Rig, run: DynamicRun, torque: float, speeds: Sequence[float]) -> ResponseCurve:
    """Stable states that repeat in every mesh, by harmonic balance; none at speeds where there are none.

    torque : stated [N m]; speeds : of the first pinion, rising [rad/s]
    """
    warm = run.test.last
    held = signed_torque(rig, warm.point)
    signed = math.copysign(torque * abs(held / warm.point.torque), held)
    return response_solver(rig, warm, signed, (min(speeds), max(speeds)), stable_only=True)(speeds)


def start_response(rig: Rig, run: DynamicRun) -> StartResponse | None:
    """Around the speed at which the torque is first raised; None where narrow resonances are not resolved."""
    if not resolved(rig) or rig.fidelity == "quick":
        return None
    speeds = np.linspace(BELOW, ABOVE, SPEEDS) * first_speed(rig)
    curve = response_under(rig, run, start_torque(rig), speeds.tolist())
    factor = np.full(speeds.size, np.nan)
    lost: Flags = np.isin(speeds, curve.unstable)
    for point in curve.points:
        at = int(np.argmin(np.abs(speeds - point.speed)))
        factor[at] = float(point.dynamic_factor.max())
        lost[at] = bool((point.lift_off_share > 0.0).any())
    known = lost | np.isfinite(factor)
    return StartResponse(speeds[known], factor[known], lost[known]) if known.any() else None


def worst_start(rig: Rig, loads: DynamicLoads, sense: Literal[1, -1]) -> StagePeak | None:
    """Highest K_V of a mesh in the stages of the time run that speed up (1) or slow down (-1) under the start torque;
    None where the schedule has none."""
    light = start_torque(rig)
    own = {
        stage.name
        for stage in rig.case.schedule.resolved()
        if max(abs(stage.torque_start), abs(stage.torque_end)) <= light
        and sense * (stage.speed_end - stage.speed_start) > 0.0
    }
    found = [
        StagePeak(load.stage, load.dynamic_factor, load.speed / own_ratio(rig, mesh), load.least_share <= 0.0)
        for mesh, name in enumerate(rig.mesh_names)
        for load in loads.meshes[rig.mesh_labels[name]].stage_loads
        if load.stage in own
    ]
    return max(found, key=lambda one: one.factor, default=None)
