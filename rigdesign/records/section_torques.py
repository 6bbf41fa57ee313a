"""Dynamic torque in every section of the shafts, every joint and mesh: held stages, over speed, in the time run.

Held stages and curves over speed are periodic responses, the time run is read at every sample.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from dynamics.response.response_curve import CurvePoint
from rigdesign.coupling.loop import PointResult
from rigdesign.records.run_torques import run_torques
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.records.torques_over_speed import (
    mesh_swing,
)
from rigdesign.results.vibration import (
    HeldTorque,
    RunTorque,
    SectionTorqueRecord,
    TorqueOverSpeed,
    TorquePlace,
)


def section_torque_record(
    solved: SolvedRig, points: Sequence[CurvePoint], curves: tuple[TorqueOverSpeed, ...]
) -> SectionTorqueRecord:
    """Torques of the held points, of the governing curve, and of the time run of a rig with loads.

    points, curves : of `torques_over_speed`
    """
    assert solved.run is not None
    in_run = run_torques(solved.rig, solved.run.ramp)
    return SectionTorqueRecord(
        held=tuple(_held(solved, in_run)),
        torque=next(iter(solved.run.curves.named)),
        speeds=tuple(point.speed for point in points),
        curves=curves,
        run=in_run,
    )


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
