"""Dynamic torque in every section of the shafts, every joint and mesh: held stages, over speed, in the time run.

From the periodic responses: the forces of the meshes drive the linear loop between them. Over speed the loop has the
matrices of the nearest of a few speeds (`loop_states`), around a dwell speed those at it; the forces are those of every
speed.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from dynamics.drivetrain.twist_rows import TorqueSection, TwistRows
from dynamics.response.section_torque import SectionTorques, section_torques
from dynamics.response.speed_sweep import CurvePoint
from rigdesign.coupling.braced_loop import shifted_laws
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.tooth_deviations import periodic_laws
from rigdesign.coupling.twist_rows import twist_rows_of
from rigdesign.records.dynamics import DynamicRun
from rigdesign.records.loop_states import LoopState, dwell_speeds, nearest
from rigdesign.records.run_torques import place_of, run_torques
from rigdesign.results.loads import DynamicLoads
from rigdesign.results.section_torques import (
    HeldTorque,
    SectionTorqueRecord,
    TorqueOverSpeed,
    TorquePlace,
    TorqueSwing,
)
from rigdesign.rig.model import Rig

Array = NDArray[np.float64]
AROUND = 0.2
"""Speeds that count as around a dwell speed, as a share of it: twice the usual margin."""
MOST_SPEEDS = 150
"""Speeds of the curves at most, but for those around the dwell speeds; peaks of the mesh torque are always among
them."""


def section_torque_record(
    rig: Rig, run: DynamicRun, loads: DynamicLoads, states: Sequence[LoopState]
) -> SectionTorqueRecord:
    """Torques of the held points of a run and of its governing curve."""
    held: list[HeldTorque] = []
    for point in run.points:
        held += _held(rig, point, loads)
    dwells = [rig.pinion_speed(speed) for speed in dwell_speeds(rig)]
    points = chosen(run.curves.response.points, MOST_SPEEDS, dwells)
    return SectionTorqueRecord(
        held=tuple(held),
        torque=next(iter(run.curves.named)),
        speeds=tuple(point.speed for point in points),
        curves=tuple(torques_over_speed(rig, run, points, states)),
        run=run_torques(rig, run.ramp, twist_rows_of(rig, states[0].system).sections),
    )


def chosen(points: Sequence[CurvePoint], most: int, dwells: Sequence[float] = ()) -> list[CurvePoint]:
    """At most so many points of a curve, evenly by their number, with all at which the torque of a mesh peaks; on top
    all within `AROUND` of a dwell speed [rad/s], where shafts peak between the meshes."""
    if len(points) <= most:
        return list(points)
    swing = np.array([point.dynamic_factor_half_peak_to_peak for point in points])
    inner = (swing[1:-1] >= swing[:-2]) & (swing[1:-1] >= swing[2:])
    peaks = set((np.flatnonzero(inner.any(axis=1)) + 1).tolist())
    rest = max(2, most - len(peaks))
    even = set(np.linspace(0, len(points) - 1, rest).round().astype(int).tolist())
    near = {i for i, point in enumerate(points) if any(is_around(point.speed, dwell) for dwell in dwells)}
    return [points[i] for i in sorted(peaks | even | near)]


def is_around(speed: float, dwell: float) -> bool:
    """Whether a speed counts as one of those around a dwell speed."""
    return abs(speed - dwell) <= AROUND * dwell


def _held(rig: Rig, point: PointResult, loads: DynamicLoads) -> Iterator[HeldTorque]:
    last = point.last
    assert last.system is not None and last.response is not None and point.setting is not None
    laws = periodic_laws(rig, shifted_laws(rig, last.models, point.setting))
    loop = section_torques(last.system, laws, twist_rows_of(rig, last.system, point.point.speed))
    torque = loop.over_period(last.response, last.drags)
    speed = rig.pinion_speed(point.point.speed)
    for place, section, swing in _swings(loop.rows, torque):
        stress = section.shear_per_torque * swing.peak if section.section is not None else None
        yield HeldTorque(
            place=place,
            stage=point.point.stage,
            speed=speed,
            swing=swing,
            run_peak=None,
            shear_stress=stress,
        )
    for mesh, name in enumerate(rig.mesh_names):
        label = rig.mesh_labels[name]
        stages = {load.stage: load.peak for load in loads.meshes[label].stage_loads}
        yield HeldTorque(
            place=TorquePlace(kind="mesh", part=label),
            stage=point.point.stage,
            speed=speed,
            swing=mesh_swing(last.response, mesh),
            run_peak=stages.get(point.point.stage),
            shear_stress=None,
        )


def mesh_swing(point: CurvePoint, mesh: int) -> TorqueSwing:
    """Torque of a mesh at its pinion."""
    high, low = float(point.maximum[mesh]), float(point.minimum[mesh])
    return TorqueSwing(
        mean=abs(float(point.mean[mesh])), half_peak_to_peak=0.5 * (high - low), peak=max(abs(high), abs(low))
    )


def _swings(rows: TwistRows, torque: Array) -> Iterator[tuple[TorquePlace, TorqueSection, TorqueSwing]]:
    """Of every section and joint, from the torque (r, count) of their springs: that with the highest peak."""
    peak = np.abs(torque).max(axis=1)
    members: dict[TorqueSection, list[int]] = {}
    for i, section in enumerate(rows.sections):
        members.setdefault(section, []).append(i)
    for section, own in members.items():
        worst = own[int(np.argmax(peak[own]))]
        place = place_of(section)
        swing = TorqueSwing(
            mean=abs(float(torque[worst].mean())),
            half_peak_to_peak=0.5 * float(np.ptp(torque[worst])),
            peak=float(peak[worst]),
        )
        yield place, section, swing


def torques_over_speed(
    rig: Rig, run: DynamicRun, points: Sequence[CurvePoint], states: Sequence[LoopState]
) -> Iterator[TorqueOverSpeed]:
    """Of every section, joint and mesh at points of the governing curve.

    states : of the loop, those at the dwell speeds around which a point lies among them
    """
    warm = run.test.last
    laws = periodic_laws(rig, laws_of(warm.models))
    rows = twist_rows_of(rig, states[0].system)
    loops: dict[int, SectionTorques] = {}
    found: dict[TorquePlace, list[TorqueSwing]] = {}
    per_stated = rig.pinion_speed(1.0)
    for point in points:
        stated = point.speed / per_stated
        around = next((dwell for dwell in dwell_speeds(rig) if is_around(stated, dwell)), stated)
        system = nearest(states, around).system
        if id(system) not in loops:
            loops[id(system)] = section_torques(system, laws, rows)
        torque = loops[id(system)].over_period(point, warm.drags)
        for place, _, swing in _swings(rows, torque):
            found.setdefault(place, []).append(swing)
        for mesh, name in enumerate(rig.mesh_names):
            place = TorquePlace(kind="mesh", part=rig.mesh_labels[name])
            found.setdefault(place, []).append(mesh_swing(point, mesh))
    for place, swings in found.items():
        yield TorqueOverSpeed(place=place, swings=tuple(swings))
