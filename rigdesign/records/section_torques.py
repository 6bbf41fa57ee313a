"""Dynamic torque in every section of the shafts, every joint and mesh: held stages, over speed, in the time run.

Held stages and curves over speed are periodic responses, the time run is read at every sample.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.loop import PointResult
from rigdesign.records.curves import resolved, response_solver
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import LoopState, dwell_speeds
from rigdesign.records.run_torques import run_torques
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.records.torques_over_speed import (
    LoopOverSpeed,
    Solve,
    is_around,
    mesh_swing,
    torques_over_speed,
)
from rigdesign.results.vibration import (
    HeldTorque,
    RunTorque,
    SectionTorqueRecord,
    TorquePlace,
)
from rigdesign.rig.model import Rig

MOST_SPEEDS = 150
"""Speeds of the curves at most, but for those around the dwell speeds and at peaks of the torques of meshes and
sections, which are always among them."""


def section_torque_record(solved: SolvedRig, states: Sequence[LoopState]) -> SectionTorqueRecord:
    """Torques of the held points, of the governing curve, and of the time run of a rig with loads."""
    rig, run = solved.rig, solved.run
    assert run is not None
    in_run = run_torques(rig, run.ramp)
    dwells = [rig.pinion_speed(speed) for speed in dwell_speeds(rig)]
    points, curves = torques_over_speed(
        LoopOverSpeed(rig, run.test.last, states),
        chosen(run.curves.response.points, MOST_SPEEDS, dwells),
        _more_speeds(rig, run),
    )
    return SectionTorqueRecord(
        held=tuple(_held(solved, in_run)),
        torque=next(iter(run.curves.named)),
        speeds=tuple(point.speed for point in points),
        curves=curves,
        run=in_run,
    )


def _more_speeds(rig: Rig, run: DynamicRun) -> Solve | None:
    """Finds stable responses of the governing curve at more speeds, where the curves are to show every resonance.

    Where only a march finds the motion, meshes lose contact and no resonance of a shaft is narrow.
    """
    if not resolved(rig):
        return None
    speeds = run.curves.response.speeds
    limits = (float(min(speeds)), float(max(speeds)))
    return response_solver(rig, run.test.last, run.curves.torque, limits, stable_only=True)


def chosen(points: Sequence[CurvePoint], most: int, dwells: Sequence[float] = ()) -> list[CurvePoint]:
    """At most so many points of a curve, evenly by their number, with all at which the torque of a mesh peaks; on top
    all around a dwell speed [rad/s] (`is_around`), where shafts peak between the meshes."""
    if len(points) <= most:
        return list(points)
    swing = np.array([point.dynamic_factor_half_peak_to_peak for point in points])
    inner = (swing[1:-1] >= swing[:-2]) & (swing[1:-1] >= swing[2:])
    peaks = set((np.flatnonzero(inner.any(axis=1)) + 1).tolist())
    rest = max(2, most - len(peaks))
    even = set(np.linspace(0, len(points) - 1, rest).round().astype(int).tolist())
    near = {i for i, point in enumerate(points) if any(is_around(point.speed, dwell) for dwell in dwells)}
    return [points[i] for i in sorted(peaks | even | near)]


def _held(solved: SolvedRig, run: Sequence[RunTorque]) -> Iterator[HeldTorque]:
    """Sections, joints and meshes of every held point with their peaks in the time run."""
    peaks = {(torque.place, torque.stage): torque.peak for torque in run}
    for point in solved.points:
        stage = point.point.stage
        for torque in solved.held_torques:
            if torque.stage == stage:
                yield replace(torque, run_peak=peaks.get((torque.place, stage)))
        yield from _held_meshes(solved, point)


def _held_meshes(solved: SolvedRig, point: PointResult) -> Iterator[HeldTorque]:
    rig, loads, response = solved.rig, solved.loads, point.last.response
    assert loads is not None and response is not None
    for mesh, name in enumerate(rig.mesh_names):
        label = rig.mesh_labels[name]
        stages = {load.stage: load.peak for load in loads.meshes[label].stage_loads}
        yield HeldTorque(
            place=TorquePlace(kind="mesh", part=label),
            stage=point.point.stage,
            speed=rig.pinion_speed(point.point.speed),
            swing=mesh_swing(response, mesh),
            run_peak=stages.get(point.point.stage),
            shear_stress=None,
        )
