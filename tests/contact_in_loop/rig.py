"""K_V of the meshes of a solved rig with the contact solved in the loop: what the contact tables leave out.

At every held stage, and where a mesh has its highest K_V over speed, the loop marches with the contact of each mesh
solved from influence numbers in every step: tilt of the gears in motion, both flanks on their own normals, friction
across them (`tests.contact_in_loop.loop`). It is held against the periodic response on contact tables under the
same loads: all teeth alike and nothing that alternates once a turn, so that both repeat in every mesh. On half as many
positions over the face the helical gears of the strain gauge rig reach 1.189 in place of 1.079.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from dynamics.errors import DynamicsInputError, DynamicsNotConverged
from dynamics.rotor.craig_bampton import wrench_rows
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_laws import alike_teeth
from dynamics.vibration.response_curve import CurvePoint
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import laws_of
from rigdesign.coupling.preloaded_loop import signed_torque
from rigdesign.coupling.time_run import drags_at
from rigdesign.postprocessing.curves import state_at
from rigdesign.postprocessing.dynamics import DynamicRun
from rigdesign.postprocessing.loaded_contact import held_contact
from rigdesign.rig.model import Rig
from tests.contact_in_loop.loop import MeshInLoop
from tests.contact_in_loop.response import LoopedProblem, LoopedResponse, looped_response

Array = NDArray[np.float64]

SAME_SPEED = 0.01
"""Speeds that differ by less, over the higher, are one place [-]."""


@dataclass(frozen=True, kw_only=True)
class LoopedContact:
    """One mesh at a held stage or at the peak of its K_V over speed (stage: empty); all teeth alike, no loads once a
    turn.

    speed : of the pinion of the mesh [rad/s]; peak : whether it is the highest K_V of this mesh over speed
    dynamic_factor, least_share : highest and least over mean torque, contact in the loop and by the contact table [-]
    apart : share of the time without contact [-]; tilt : of the gears about their mean, peak to peak [rad]
    settled : whether K_V no longer changed when the march ended, else about by ``still_changing``
    unconverged : steps whose contacts were not solved to their tolerance
    """

    mesh: str
    stage: str
    peak: bool
    speed: float
    dynamic_factor: float
    dynamic_factor_by_table: float
    least_share: float
    least_share_by_table: float
    apart: float
    tilt: float
    still_changing: float
    settled: bool
    unconverged: int


@dataclass(frozen=True)
class _Place:
    """Where the loop marches; stage: empty where none holds the speed.

    speed : stated [rad/s]; peaks : numbers of the meshes that have their highest K_V there
    """

    held: PointResult = field(repr=False)
    stage: str
    speed: float
    peaks: tuple[int, ...] = ()


@dataclass(frozen=True)
class _Both:
    """The response at a place by both models."""

    by_table: CurvePoint
    in_loop: LoopedResponse


def contact_in_loop(rig: Rig, run: DynamicRun) -> tuple[LoopedContact, ...]:
    """Of every mesh at every place, of a rig with shafts that bend and teeth by influence numbers.

    Raises DynamicsNotConverged where there is no response, DynamicsInputError where a mesh carries no torque.
    """
    places = _places(rig, run)
    with BackgroundTasks([partial(_both, rig, place) for place in places]) as tasks:
        found = list(zip(places, tasks.results(), strict=True))
    return tuple(row for place, both in found for row in _rows(rig, place, both))


def _places(rig: Rig, run: DynamicRun) -> list[_Place]:
    """Held stages, then peaks of K_V over speed that none of them holds."""
    places = [_Place(point, point.point.stage, point.point.speed) for point in run.points]
    curve = run.curves.response
    for mesh in range(len(rig.mesh_names)):
        speed = float(curve.speeds[np.argmax(curve.dynamic_factor(mesh))]) / rig.pinion_speed(1.0)
        near = [i for i, place in enumerate(places) if _same(place, speed, run)]
        if near:
            places[near[0]] = replace(places[near[0]], peaks=(*places[near[0]].peaks, mesh))
        else:
            places.append(_Place(run.test, "", speed, (mesh,)))
    return places


def _same(place: _Place, speed: float, run: DynamicRun) -> bool:
    """Whether a place is at a speed [rad/s] under the torque of the curve."""
    return place.held is run.test and abs(speed - place.speed) <= SAME_SPEED * max(speed, place.speed)


def problem_in_loop(rig: Rig, held: PointResult, speed: float) -> tuple[CurvePoint, LoopedProblem]:
    """The response on contact tables at a stated speed [rad/s], gears as warm as at the held point, and what the march
    with the contact in the loop starts from: the same matrices, drag torques and bracing twist.

    Raises DynamicsNotConverged where there is no response, DynamicsInputError where a mesh carries no torque.
    """
    last = held.last
    system = replace(state_at(rig, held, speed).system, periodic_loads=())
    laws = [alike_teeth(law) for law in laws_of(last.models)]
    drags = drags_at(rig, last, last.coupling_state, speed)
    curve = periodic_response(
        system,
        laws,
        [rig.pinion_speed(speed)],
        LoopLoad(torque=signed_torque(rig, held.point)),
        drag_torques=drags,
        settings=SweepSettings(cutoff=rig.highest_mode),
    )
    if not curve.points:
        raise DynamicsNotConverged(f"no response on contact tables: {curve.failed[0][1]}")
    (by_table,) = curve.points
    rows = np.vstack([wrench_rows(rig.elastic.model, name) for name in rig.mesh_names])
    return by_table, LoopedProblem(
        system=system,
        rows=rig.elastic.seen.on_freedoms(rows),
        meshes=_meshes(rig, held, laws, by_table.flank),
        speed=by_table.speed,
        twist=by_table.twist,
        drive_torque=by_table.drive_torque,
        drag_torques=drags,
        cutoff=rig.highest_mode,
    )


def _both(rig: Rig, place: _Place) -> _Both:
    by_table, problem = problem_in_loop(rig, place.held, place.speed)
    return _Both(by_table, looped_response(problem))


def _meshes(rig: Rig, held: PointResult, laws: list[MeshLaw], flank: Array) -> list[MeshInLoop]:
    found = []
    for number, law in enumerate(laws):
        contact, halves = held_contact(rig, held, number), held.last.models[number].halves
        if contact is None:
            raise DynamicsInputError(
                f"mesh {rig.mesh_names[number]} carries no torque: there is no contact to solve"
            )
        force = float(flank[number]) * halves * contact.force
        found.append(MeshInLoop(contact=contact.mesh, law=law, force=force, halves=halves))
    return found


def _rows(rig: Rig, place: _Place, both: _Both) -> Iterator[LoopedContact]:
    for mesh, name in enumerate(rig.mesh_names):
        if not place.stage and mesh not in place.peaks:
            continue
        table, loop = both.by_table, both.in_loop
        yield LoopedContact(
            mesh=rig.mesh_labels[name],
            stage=place.stage,
            peak=mesh in place.peaks,
            speed=rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, place.speed),
            dynamic_factor=float(loop.dynamic_factor[mesh]),
            dynamic_factor_by_table=float(table.dynamic_factor[mesh]),
            least_share=float(loop.least_share[mesh]),
            least_share_by_table=float(table.minimum[mesh] / table.mean[mesh]),
            apart=float(loop.apart[mesh]),
            tilt=float(loop.tilt[mesh]),
            still_changing=float(loop.change[mesh]),
            settled=loop.settled,
            unconverged=loop.unconverged,
        )
