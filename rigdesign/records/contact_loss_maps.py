"""Speeds and torques at which contact is lost: periodic response on a grid, stable states only.

The grid holds the torques and speeds of the schedule, and those speeds at which K_V peaks on a curve or in the time
run: resonances are narrower than even steps of the speed.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.response.response_curve import ResponseCurve
from rigdesign.coupling.braced_loop import signed_torque
from rigdesign.records.curves import own_ratio, resolved, response_solver
from rigdesign.records.dynamics import DynamicRun
from rigdesign.results.contact_in_motion import ContactLossMap
from rigdesign.results.loads import DynamicLoads
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
SHARES = (0.05, 0.1, 0.2, 0.4, 1.0)
"""Torques of the map over the test torque."""
SAME_TORQUE, SAME_SPEED = 0.25, 0.002
"""Ratio, less one, up to which a torque of the schedule or a speed stands for another."""
SPEEDS = 28
"""Speeds evenly over the range of the curves."""
MOST_PEAKS = 10
"""Peaks of K_V on the curves that are speeds of the map, the highest."""


def contact_loss_maps(rig: Rig, run: DynamicRun, loads: DynamicLoads) -> tuple[ContactLossMap, ...]:
    """Of every mesh, under the warm teeth of the governing held point; bearings as they run at each torque.

    None at quick fidelity and where the response repeats after a revolution or more: its points cost too much.
    """
    if not resolved(rig):
        return ()
    speeds, torques = _speeds(rig, run, loads), _torques(rig)
    curves = [response_under(rig, run, torque, speeds) for torque in torques]
    return tuple(_map(rig, mesh, torques, speeds, curves) for mesh in range(len(rig.mesh_names)))


def response_under(rig: Rig, run: DynamicRun, torque: float, speeds: Sequence[float]) -> ResponseCurve:
    """Stable states that repeat in every mesh, by harmonic balance; none at speeds where there are none.

    torque : stated [N m]; speeds : of the first pinion, rising [rad/s]
    """
    warm = run.test.last
    held = signed_torque(rig, warm.point)
    signed = math.copysign(torque * abs(held / warm.point.torque), held)
    return response_solver(rig, warm, signed, (min(speeds), max(speeds)), stable_only=True)(speeds)


def _map(
    rig: Rig, mesh: int, torques: Sequence[float], speeds: Sequence[float], curves: Sequence[ResponseCurve]
) -> ContactLossMap:
    """That of one mesh from the curves of all torques."""
    found = [{point.speed: point for point in curve.points} for curve in curves]
    rows = [[points.get(speed) for speed in speeds] for points in found]
    return ContactLossMap(
        mesh=rig.mesh_labels[rig.mesh_names[mesh]],
        speed=tuple(own_ratio(rig, mesh) * speed for speed in speeds),
        torque=tuple(torques),
        least_share=tuple(
            tuple(None if p is None else float(p.minimum[mesh] / p.mean[mesh]) for p in row) for row in rows
        ),
        lift_off=tuple(
            tuple(None if p is None else float(p.lift_off_share[mesh]) for p in row) for row in rows
        ),
        unstable=tuple(tuple(speed in curve.unstable for speed in speeds) for curve in curves),
    )


def _torques(rig: Rig) -> list[float]:
    """Stated torques of the schedule, and shares of the test torque where it states none near them; rising [N m]."""
    own = {abs(stage.torque_end) for stage in rig.case.schedule.resolved()} - {0.0}
    shares = {share * rig.case.schedule.test_torque for share in SHARES}
    free = {
        one for one in shares if all(abs(math.log(one / other)) > math.log1p(SAME_TORQUE) for other in own)
    }
    return sorted(own | free)


def _speeds(rig: Rig, run: DynamicRun, loads: DynamicLoads) -> list[float]:
    """Even speeds, those of the stages and those at which K_V peaks; rising [rad/s]."""
    curve = run.curves.response.speeds
    low, high = float(curve[0]), float(curve[-1])
    special = [rig.pinion_speed(stage.speed_end) for stage in rig.case.schedule.resolved()]
    for mesh, label in enumerate(rig.mesh_labels[name] for name in rig.mesh_names):
        for load in loads.meshes[label].stage_loads:
            special += [load.speed / own_ratio(rig, mesh), load.least_share_speed / own_ratio(rig, mesh)]
    peaks = sorted(_peaks(rig, run), reverse=True)[:MOST_PEAKS]
    wanted = [*special, *(speed for _, speed in peaks), *np.linspace(low, high, SPEEDS).tolist()]
    found: list[float] = []
    for speed in wanted:
        if low <= speed <= high and all(abs(speed / other - 1.0) > SAME_SPEED for other in found):
            found.append(float(speed))
    return sorted(found)


def _peaks(rig: Rig, run: DynamicRun) -> Iterator[tuple[float, float]]:
    """K_V and speed of the peaks of every mesh on every curve."""
    for _, curve in run.curves.named.values():
        for mesh in range(len(rig.mesh_names)):
            factor = curve.dynamic_factor(mesh)
            for i in np.flatnonzero((factor[1:-1] > factor[:-2]) & (factor[1:-1] >= factor[2:])) + 1:
                yield float(factor[i]), float(curve.speeds[i])
