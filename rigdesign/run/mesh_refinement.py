"""A converged operating point on another mesh: one more iteration, with its loads and losses.

At reference the loop runs on the standard mesh and this iteration on the final one ends it. The same iteration on
coarser meshes tells how far the result depends on the mesh (`rigdesign.run.mesh_convergence`).
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Self

import numpy as np
from scipy.spatial import cKDTree

from rigdesign.base.fidelity import Fidelity
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.checks import mesh_checks
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.convergence import Residual
from rigdesign.coupling.iteration import HousingResult, IterationResult, solve_housings
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.oil import oil_streams
from rigdesign.coupling.relaxation import next_state
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.temperatures import HousingField
from rigdesign.records.heat_split import split_as_solved
from rigdesign.records.housing import housing_temperatures
from rigdesign.records.solved_rig import housing_fields, solved_rig
from rigdesign.results.check import Check
from rigdesign.results.housing import HousingTemperatures
from rigdesign.rig.model import Rig
from thermal.conduction.capacity import StoredHeat
from thermal.fe.mesh import FloatArray, MeshError, NamedMesh
from thermal.housing.stations import GearboxModel

COARSER: dict[Fidelity, tuple[Fidelity, ...]] = {
    "quick": (),
    "standard": ("quick",),
    "reference": ("quick", "standard"),
}
"""Meshes from which the errors of a fidelity follow, in addition to its own, from coarse to fine."""


def looping_rig(rig: Rig) -> Rig:
    """The rig on which the coupling iterates: at reference that of the standard mesh."""
    return replace(rig, fidelity="standard") if rig.fidelity == "reference" else rig


class BackgroundMeshing:
    """Meshes the rig at all other fidelities its errors need, on another core; `rigs` waits for them.

    rig : of which the errors are wanted; source : the one on which the loop runs
    """

    def __init__(self, rig: Rig, source: Rig) -> None:
        self._rig, self._source = rig, source
        fidelities = (*COARSER[rig.fidelity], rig.fidelity)
        self._others = tuple(f for f in fidelities if f != source.fidelity)
        works = [partial(_meshed, source, f, needed=f == rig.fidelity) for f in self._others]
        self._works: BackgroundTasks[dict[str, GearboxModel] | None] = BackgroundTasks(works)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._works.end()

    def rigs(self) -> tuple[Rig, ...]:
        """The rigs from coarse to fine, the last that of which the errors are wanted.

        Raises
        ------
        MeshError
            The last one cannot be meshed; a coarser one is left out then.
        """
        made = {self._source.fidelity: self._source}
        for fidelity, models in zip(self._others, self._works.results(), strict=True):
            if models is not None:
                made[fidelity] = replace(self._source, fidelity=fidelity).with_models(models)
        wanted = (*COARSER[self._rig.fidelity], self._rig.fidelity)
        return tuple(made[fidelity] for fidelity in wanted if fidelity in made)


def _meshed(rig: Rig, fidelity: Fidelity, *, needed: bool) -> dict[str, GearboxModel] | None:
    """Housings at one fidelity; None where one cannot be meshed that is not needed."""
    try:
        return rig.meshed(fidelity)
    except MeshError:
        if needed:
            raise
        return None


def on_mesh(rig: Rig, converged: PointResult, source: Rig, *, oil_follows: bool = False) -> PointResult:
    """One more iteration of a converged point on the mesh of ``rig``: fields, thermal expansion, oil, warm gears and
    bearings.

    The periodic response and the losses are those the point converged with. The residual that is added is the
    change of this iteration: the shift from mesh to mesh.

    source : the rig on which the point converged
    oil_follows : the oil ends at the temperatures of this iteration, not at those it started with

    Raises
    ------
    NotConverged
        A solve stalls on that mesh.
    """
    last = converged.last
    last = replace(last, stored=_stored_on(rig, last, source))
    housings = solve_housings(rig, last, _carried_over(last, source, rig))
    supplies = last.coupling_state.oil_supply
    streams = oil_streams(
        rig, last.losses, housings.bearing_heat, housings.wall_heat, housings.sumps, supplies
    )
    done = replace(last, **vars(housings), streams=tuple(streams))
    after = next_state(rig, done)
    change = replace(Residual.between(done.coupling_state, after), torque=0.0)
    if oil_follows:
        oil = {"oil_outlet": after.oil_outlet, "oil_supply": after.oil_supply}
        done = replace(done, coupling_state=replace(done.coupling_state, **oil))
    return replace(converged, last=_warmed(rig, done, after), residuals=(*converged.residuals, change))


def _carried_over(last: IterationResult, source: Rig, rig: Rig) -> HousingResult:
    """First guess on the meshes of ``rig`` from an iteration on those of ``source``."""
    meshes = {name: (source.models[name].mesh, rig.models[name].mesh) for name in last.fields}
    same = {name for name, (old, new) in meshes.items() if old is new}
    fields = {
        name: field if name in same and rig is source else _carried(field, *meshes[name])
        for name, field in last.fields.items()
    }
    expansion = {name: own for name, own in last.expansion.items() if name in same}
    return replace(last, fields=fields, expansion=expansion)


def _carried(field: HousingField, old: NamedMesh, new: NamedMesh) -> HousingField:
    """First guess of a field on another mesh: each node is as warm as the nearest one of its body was."""
    temperature = _at_nearest(field.temperature, old, new)
    return replace(field, solution=replace(field.solution, temperature=temperature, preconditioner=None))


def _at_nearest(values: FloatArray, old: NamedMesh, new: NamedMesh) -> FloatArray:
    """(n_nodes,) of the new mesh: that of the nearest node of the same body of the old one."""
    found = np.empty(len(new.points))
    for body, cells in new.bodies.items():
        nodes, known = np.unique(new.cells[cells]), np.unique(old.cells[old.bodies[body]])
        _, nearest = cKDTree(old.points[known]).query(new.points[nodes])
        found[nodes] = values[known[nearest]]
    return found


def _stored_on(rig: Rig, last: IterationResult, source: Rig) -> dict[str, StoredHeat]:
    """The time step of a point that still warms up, on the meshes of ``rig``: it counts from the same temperatures."""
    found = {}
    for name, stored in last.stored.items():
        old, new = source.models[name].mesh, rig.models[name].mesh
        start = stored.start
        moved = start if old is new or not isinstance(start, np.ndarray) else _at_nearest(start, old, new)
        found[name] = replace(stored, start=moved)
    return found


def _warmed(rig: Rig, done: IterationResult, after: CouplingState) -> IterationResult:
    """The iteration with gears and bearings at the lengths and temperatures it ended with."""
    coupling_state = replace(
        done.coupling_state,
        gear_temperature=after.gear_temperature,
        centre_distance=after.centre_distance,
        bearing_clearance=after.bearing_clearance,
        axial_expansion=after.axial_expansion,
        bearing_heat=done.bearing_heat,
        seat_temperature=after.seat_temperature,
    )
    return replace(
        done,
        coupling_state=coupling_state,
        models=mesh_models(rig, done.point, coupling_state),
        bearings=solve_bearings(rig, done.point, coupling_state),
    )


def checked(rig: Rig, points: Sequence[PointResult]) -> dict[str, Check]:
    """The checks that depend on temperatures, thermal expansion and oil, by id, as ``points`` on the mesh of ``rig``
    have them."""
    temperatures = [_temperatures(rig, *found) for found in housing_fields(points)]
    return {check.id: check for check in mesh_checks(solved_rig(rig, points, temperatures))}


def _temperatures(rig: Rig, point: PointResult, field: HousingField) -> HousingTemperatures:
    split = split_as_solved(rig, point, field)
    return replace(housing_temperatures(rig, point, field), heat_split=tuple(split.values()))
