"""How far the numbers the checks use are from those of an infinitely fine mesh.

The converged point is solved once more, same losses, films and oil, on other meshes: one of elements half as large
again for quick; quick for standard; quick and standard for reference. From three meshes the error follows by
Richardson extrapolation with the order observed, from two with the order of a field at re-entrant edges. The values
of the checks are taken on every mesh as they are, the worst place of all; a verdict that depends on the mesh says so
(`rigdesign.checks.rules.with_error`).
Sources: Roache, Annu. Rev. Fluid Mech. 29 (1997) 123; Celik et al., J. Fluids Eng. 130 (2008) 078001 for meshes
without a constant ratio; Strang, Fix, An Analysis of the Finite Element Method, ch. 8: at an edge of 270 degrees
the gradient converges with order 2/3, integrals of the field with twice that.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Self

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from dynamics.errors import DynamicsError, DynamicsNotConverged
from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.errors import RigdesignError
from rigdesign.base.fidelity import Fidelity
from rigdesign.base.parallel import BackgroundTasks
from rigdesign.checks import mesh_checks
from rigdesign.checks.dynamics import loaded_stages
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.expansion import HousingExpansion
from rigdesign.coupling.fixed_point import Residual, next_state
from rigdesign.coupling.iteration import HousingResult, IterationResult, solve_housings
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.loop import PointResult, governing_point
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.oil import oil_streams
from rigdesign.coupling.preloaded_loop import BracingState, LoadedCircuit, respond
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.temperatures import HousingField, body_mean
from rigdesign.postprocessing.housing import housing_temperatures, split_as_solved
from rigdesign.postprocessing.solved_rig import LawSpread, SolvedRig, housing_fields, solved_rig
from rigdesign.results.check import Check
from rigdesign.results.housing import HousingTemperatures
from rigdesign.results.result import DiscretisationRow, MeshShift
from rigdesign.results.units import MM, UM, ZERO
from rigdesign.rig.model import Rig, RigParts
from rigdesign.rig.resolution import Coarsening
from thermal.conduction.capacity import StoredHeat
from thermal.errors import ThermalError
from thermal.fe.mesh import FloatArray, MeshError, NamedMesh
from thermal.fe.recovery import energy_error
from thermal.housing.stations import GearboxModel

EDGE_ORDER = 4.0 / 3.0
"""Order of integrals of the field where its gradient is that of a re-entrant edge of 270 degrees."""
ORDERS = (0.5, 4.0)
"""Orders that are believed; four is what second-order elements reach on smooth fields."""
LEAST_RATIO = 1.1
"""Of the element sizes of two meshes: with a housing from a file only the drawn parts differ, and the count of all
nodes says less than that of their elements."""
LAW_TEMPERATURE = 373.15
"""Temperature [K] at which a conductivity law weighs the energy."""


@dataclass(frozen=True)
class MeshErrors:
    """What the meshes say of a solved rig."""

    rows: tuple[DiscretisationRow, ...]
    """One for each quantity of the governing point, the energy norm of each housing first, then the checks."""
    shifts: tuple[MeshShift, ...]
    """At reference, from the standard to the final mesh."""


@dataclass(frozen=True)
class Numbers:
    """Values and units of one mesh by (quantity, gearbox); an empty gearbox stands for checks."""

    nodes: Mapping[str, int]
    """By gearbox; those of all housings under the empty name."""
    values: Mapping[tuple[str, str], tuple[float, str]]


def discretisation(
    rigs: Sequence[Rig], source: Rig, converged: Sequence[PointResult], points: Sequence[PointResult]
) -> MeshErrors:
    """Errors of all numbers of the governing held point and of the checks.

    rigs : from coarse to fine meshes; the errors are those of the last
    source : the rig on which the loop ran; converged : held points as the loop left them
    points : the same on the mesh of the last rig
    """
    *coarser, rig = rigs
    last = governing_point(points)
    governing = next(i for i, point in enumerate(points) if point is last)
    meshes: list[Numbers] = []
    lost = ""
    for other in coarser:
        if _nodes(other) == _nodes(rig):
            continue
        try:
            meshes.append(numbers(other, [on_mesh(other, point, source) for point in converged], governing))
        except (ThermalError, DynamicsError, RigdesignError) as error:
            lost = f"; no result on the mesh of {other.fidelity} fidelity: {error}"
    # after a last iteration on a finer mesh the points come from one more iteration, as those of the coarser meshes do
    ours = points if rig is not source or not meshes else [on_mesh(rig, point, rig) for point in converged]
    rows = [_energy_row(rig, field, last.point.stage, lost) for field in last.last.fields.values()]
    meshes.append(numbers(rig, ours, governing))
    if len(meshes) == 1:
        return MeshErrors(tuple(rows), ())
    rows += _rows(last.point.stage, meshes)
    return MeshErrors(tuple(rows), () if rig is source else _shifts(meshes[-2], meshes[-1]))


def _nodes(rig: Rig) -> dict[str, int]:
    """Nodes of every housing; those of a mesh from a file are the same at any fidelity."""
    return {name: len(model.mesh.points) for name, model in rig.models.items()}


def numbers(rig: Rig, points: Sequence[PointResult], governing: int) -> Numbers:
    """Numbers of the governing point and of the checks, as held ``points`` on the mesh of ``rig`` have them."""
    last = points[governing].last
    nodes = _nodes(rig)
    values = {
        (quantity, name): (value, unit)
        for name, field in last.fields.items()
        for (quantity, unit), value in _measured(rig, field, last.expansion.get(name)).items()
    }
    values |= {(check.id, ""): (_value(check), check.unit) for check in checked(rig, points).values()}
    return Numbers({**nodes, "": sum(nodes.values())}, values)


def _value(check: Check) -> float:
    assert check.value is not None
    return check.value


def _measured(
    rig: Rig, field: HousingField, expansion: HousingExpansion | None
) -> dict[tuple[str, str], float]:
    """Every number of a housing that a check or the heat table shows, by quantity and unit."""
    name, mesh = field.gearbox, rig.models[field.gearbox].mesh
    housing = field.temperature[mesh.cells[mesh.bodies.get("housing", slice(None))]]
    values: dict[tuple[str, str], float] = {
        ("max_temperature", "degC"): float(field.temperature.max()) - ZERO,
        ("housing.max_temperature", "degC"): float(housing.max()) - ZERO,
    }
    for gear, entry in rig.case.gearboxes[name].gears.items():
        if f"gear_{entry.shaft}" not in mesh.bodies:
            continue
        values[f"{gear}.bulk_temperature", "degC"] = body_mean(rig, field, f"gear_{entry.shaft}") - ZERO
    for kind, power in field.solution.balance.by_kind().items():
        values[f"heat.{kind}", "W"] = power
    if expansion is None:
        return values
    shape = expansion.deformed
    for seal in shape.seals.values():
        values[f"{seal.name}.seal_gap", "mm"] = MM * seal.minimum
        values[f"{seal.name}.axial_shift", "mm"] = MM * seal.axial_shift
    for shaft in shape.shafts.values():
        values[f"{shaft.name}.growth", "mm"] = MM * (shaft.start + shaft.end)
        values[f"{shaft.name}.axial_play_change", "mm"] = MM * shaft.axial_play_change
    for bearing in shape.bearings.values():
        values[f"{bearing.name}.clearance_change", "um"] = UM * bearing.clearance_change
    for full, distance in expansion.centre_distance.items():
        values[f"{full.split('.')[1]}.centre_distance", "mm"] = MM * distance
    return values


def _energy_row(rig: Rig, field: HousingField, stage: str, lost: str) -> DiscretisationRow:
    setup = rig.conduction[field.gearbox]
    k = {
        body: float(law(np.array([LAW_TEMPERATURE]))[0]) if callable(law) else float(law)
        for body, law in setup.conductivity.items()
    }
    found = energy_error(setup.elements, field.temperature, setup.elements.per_cell(k))
    return DiscretisationRow(
        quantity="temperature_gradient", gearbox=field.gearbox, stage=stage, value=found.energy,
        error=found.total, unit="(W K)^0.5", order=None,
        method=f"energy norm against the recovered gradient (Zienkiewicz, Zhu 1992){lost}",
    )  # fmt: skip


def _rows(stage: str, meshes: Sequence[Numbers]) -> list[DiscretisationRow]:
    """One row for each number all meshes have; meshes from coarse to fine, the last is that of the result."""
    rows = []
    for key, (value, unit) in meshes[-1].values.items():
        quantity, gearbox = key
        nodes = [mesh.nodes[gearbox] for mesh in meshes]
        if nodes[-1] == nodes[-2] or not all(key in mesh.values for mesh in meshes):
            continue
        error, order, how = richardson(nodes, [mesh.values[key][0] for mesh in meshes])
        rows.append(
            DiscretisationRow(
                quantity=quantity,
                gearbox=gearbox,
                stage=stage if gearbox else "",
                value=value,
                error=error,
                unit=unit,
                order=order,
                method=f"meshes of {' and '.join(map(str, nodes))} nodes, {how}",
            )
        )
    return rows


def _shifts(standard: Numbers, reference: Numbers) -> tuple[MeshShift, ...]:
    """Change of every check from one mesh to the next."""
    return tuple(
        MeshShift(
            id=quantity,
            standard=standard.values[quantity, gearbox][0],
            reference=value,
            shift=value - standard.values[quantity, gearbox][0],
            unit=unit,
        )
        for (quantity, gearbox), (value, unit) in reference.values.items()
        if not gearbox and (quantity, gearbox) in standard.values
    )


def richardson(nodes: Sequence[int], values: Sequence[float]) -> tuple[float, float | None, str]:
    """Error estimate of the last of two or three values, the order behind it, and how it was found.

    nodes : of the meshes, rising; the element size goes with their cube root
    """
    change = values[-1] - values[-2]
    ratio = max((nodes[-1] / nodes[-2]) ** (1.0 / 3.0), LEAST_RATIO)
    if len(values) == 2:
        return _extrapolated(change, ratio, EDGE_ORDER), EDGE_ORDER, "order 4/3 of re-entrant edges assumed"
    before = values[-2] - values[-3]
    largest = max(abs(change), abs(before))
    if change * before <= 0.0:
        return largest, None, "not monotone: the largest change between meshes"
    order = _observed(before / change, (nodes[-2] / nodes[-3]) ** (1.0 / 3.0), ratio)
    if order is None:
        return largest, None, "no order between 0.5 and 4: the largest change between meshes"
    return _extrapolated(change, ratio, order), order, f"Richardson with the observed order {order:.2f}"


def _extrapolated(change: float, ratio: float, order: float) -> float:
    return float(abs(change) / (ratio**order - 1.0))


def _observed(quotient: float, first: float, second: float) -> float | None:
    """Order p with (r_1^p - 1) r_2^p / (r_2^p - 1) equal to the quotient of both changes; None outside of ORDERS."""

    def open_by(order: float) -> float:
        return float((first**order - 1.0) * second**order / (second**order - 1.0) - quotient)

    low, high = ORDERS
    if open_by(low) * open_by(high) > 0.0 or not math.isfinite(quotient):
        return None
    return float(brentq(open_by, low, high, xtol=1e-6))


# A converged operating point on another mesh: one more iteration, with its loads and losses.
#
# At reference the loop runs on the standard mesh and this iteration on the final one ends it. The same iteration on
# coarser meshes tells how far the result depends on the mesh.

MeshOf = tuple[Fidelity, float]
"""A mesh: that of a fidelity, or so many times coarser."""
COARSER: dict[Fidelity, tuple[MeshOf, ...]] = {
    "quick": (("quick", 1.5),),
    "standard": (("quick", 1.0),),
    "reference": (("quick", 1.0), ("standard", 1.0)),
}
"""Meshes from which the errors of a fidelity follow, in addition to its own, from coarse to fine."""


def looping_rig(rig: Rig) -> Rig:
    """The rig on which the coupling iterates: at reference that of the standard mesh."""
    return replace(rig, fidelity="standard", parts=RigParts()) if rig.fidelity == "reference" else rig


class BackgroundMeshing:
    """Makes all other meshes that the errors of the rig need, on another core; `rigs` waits for them.

    rig : of which the errors are wanted; source : the one on which the loop runs
    """

    def __init__(self, rig: Rig, source: Rig) -> None:
        self._source = source
        self._wanted: tuple[MeshOf, ...] = (*COARSER[rig.fidelity], (rig.fidelity, 1.0))
        self._others = tuple(mesh for mesh in self._wanted if mesh != (source.fidelity, 1.0))
        works = [partial(_meshed, source, mesh, needed=mesh == self._wanted[-1]) for mesh in self._others]
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
        made = {(self._source.fidelity, 1.0): self._source}
        for mesh, models in zip(self._others, self._works.results(), strict=True):
            if models is not None:
                made[mesh] = replace(self._source, fidelity=mesh[0]).with_models(models)
        return tuple(made[mesh] for mesh in self._wanted if mesh in made)


def _meshed(rig: Rig, mesh: MeshOf, *, needed: bool) -> dict[str, GearboxModel] | None:
    """Housings on one mesh; None where one cannot be meshed that is not needed."""
    try:
        return rig.meshed(*mesh)
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


# How far the checks depend on which published law gives a loss.
#
# Churning of small gears lies a factor of five apart between laws, windage more than that. The converged point is
# solved again with the losses of the law that differs most from the one taken, its loads and films kept; what that
# moves in the value of a check is an error of it (`rigdesign.checks.rules.with_error`), as that of a mesh is.

NOTABLE = 0.3
"""Share of a loss by which another law has to differ to count: below it laws agree as well as measurements do."""
LEAST_SHARE = 0.01
"""Share of all losses of a rig below which nothing is solved again."""
PASSES, SETTLED = 4, 0.05
"""Iterations that the oil is given to follow, and its last change [K]."""


def law_spreads(rig: Rig, points: Sequence[PointResult]) -> Iterator[LawSpread]:
    """For each kind of loss whose laws differ notably, what the other law changes in every check of heat.

    points : held, as they converged on the meshes of ``rig``
    """
    kinds = {placed.loss.kind for point in points for placed in point.last.losses if placed.rival}
    base = None
    for kind in sorted(kinds):
        changed = [_exchanged(point, kind) for point in points]
        if all(point is None for point in changed):
            continue
        base = base or _values(rig, points)
        solved = [
            point if other is None else _settled(rig, other)
            for point, other in zip(points, changed, strict=True)
        ]
        moved = {id_: abs(value - base[id_]) for id_, value in _values(rig, solved).items() if id_ in base}
        yield LawSpread(cause=_words(points, kind), changes=moved)


def _exchanged(point: PointResult, kind: str) -> PointResult | None:
    """A point with the losses of the rival law, not solved again; None where they matter little."""
    losses = point.last.losses
    rivals = {id(p): p.rival[1] for p in losses if p.loss.kind == kind and p.rival}
    own = math.fsum(p.loss.power for p in losses if id(p) in rivals)
    change = abs(math.fsum(rivals.values()) - own)
    if change < max(NOTABLE * own, LEAST_SHARE * math.fsum(p.loss.power for p in losses)):
        return None
    exchanged = tuple(_with_power(p, rivals[id(p)]) if id(p) in rivals else p for p in losses)
    return replace(point, last=replace(point.last, losses=exchanged))


def _with_power(placed: PlacedLoss, power: float) -> PlacedLoss:
    share = placed.into_body / placed.loss.power if placed.loss.power else 0.0
    return replace(placed, loss=replace(placed.loss, power=power), into_body=share * power)


def _settled(rig: Rig, point: PointResult) -> PointResult:
    """The point with its fields and oil at the temperatures that its losses lead to."""
    for _ in range(PASSES):
        before = point.last.coupling_state.oil_outlet
        point = on_mesh(rig, point, rig, oil_follows=True)
        after = point.last.coupling_state.oil_outlet
        if max((abs(after[name] - value) for name, value in before.items()), default=0.0) < SETTLED:
            break
    return point


def _values(rig: Rig, points: Sequence[PointResult]) -> Mapping[str, float]:
    found = checked(rig, points)
    return {id_: check.value for id_, check in found.items() if check.value is not None}


def _words(points: Sequence[PointResult], kind: str) -> str:
    """What both laws give in every gearbox, at the fastest stage."""
    point = max(points, key=lambda point: point.point.speed)
    texts = []
    for box in dict.fromkeys(p.gearbox for p in point.last.losses if p.loss.kind == kind and p.rival):
        placed = [p for p in point.last.losses if p.loss.kind == kind and p.gearbox == box and p.rival]
        own = math.fsum(p.loss.power for p in placed)
        other = math.fsum(p.rival[1] for p in placed if p.rival)
        details, rival = placed[0].loss.details, placed[0].rival
        law = details.get("law", details["source"])
        assert rival is not None
        texts.append(f"{box} {own:.3g} W by {law}, {other:.3g} W by {rival[0]}")
    return f"{kind} at stage {point.point.stage} ({'; '.join(texts)})"


# How far the dynamic loads behind the checks are from those of infinitely many slices, shaft elements and modes.
#
# The periodic response behind a check is solved again, once with half the slices of every mesh, once with shaft
# elements twice as long, and of shafts that bend once with modes up to half the frequency; each change gives an error
# of its own, and they are added. Slices and elements are of second order (midpoint rule over the face, lumped inertia),
# modes fall at least as fast, for static shapes stand for those left out: a third of the change is left where the rules
# of
# `rig.resolution` decide; slices or elements that the case states may be too few for any order: there the whole change
# counts. Peaks and least torques of the time run take the error of the periodic response at the speed and torque at
# which they occur: the run itself is not marched again. What the contact tables of bending shafts leave out is added
# (`TABLES_LEAVE_OUT`). Source: Roache, Annu. Rev. Fluid Mech. 29 (1997) 123.

HALVED = (Coarsening(slices=2), Coarsening(elements=2))
FEWER_MODES = Coarsening(modes=2)
ORDER = 2.0
TABLES_LEAVE_OUT = (0.02, 0.2)
"""Error of a dynamic factor or least share by the contact tables, in all and per dynamic part, against contacts solved
from influence numbers in every step of a time integration (`tests/contact_in_loop`): held stages and peaks of K_V of
the shipped rigs are within it where no contact is lost, the main rig with 0.11 of 0.50; tables are mostly higher."""
RPM = math.pi / 30.0
Value = Callable[[CurvePoint, int], float]
Place = tuple[str, float, float, str]
Rigs = tuple[Rig, ...]
"""As the result has it, with half the slices, with elements twice as long, and with fewer modes where shafts bend."""


@dataclass(frozen=True)
class _Loaded:
    """An operating point of the warm rig at which a periodic response is wanted."""

    point: OperatingPoint
    coupling_state: CouplingState = field(repr=False)
    drags: Mapping[str, float]
    setting: BracingState
    in_run: bool = False
    """Passed by the time run, whose motion is that of a time integration where it is not plain."""

    @property
    def place(self) -> Place:
        """What tells it from other points of the rig: stage, speed [rad/s], torque [N m] and kind of bracing."""
        return self.point.stage, self.point.speed, self.point.torque, self.setting.mode

    def responses(self, rigs: Rigs) -> tuple[CurvePoint, ...]:
        """Of each rig; nothing where one of them finds none."""
        systems: dict[tuple[int, int], LinearSystem] = {}
        try:
            return tuple(respond(rig, self._circuit(rig, systems), traced=not self.in_run) for rig in rigs)
        except DynamicsNotConverged:
            return ()

    def _circuit(self, rig: Rig, systems: dict[tuple[int, int], LinearSystem]) -> LoadedCircuit:
        """Rigs with the same shaft elements and modes share their matrices."""
        elements = rig.coarsening.elements, rig.coarsening.modes
        if elements not in systems:
            bearings = solve_bearings(rig, self.point, self.coupling_state)
            systems[elements] = loop_system(rig, self.point, self.coupling_state, bearings)
        models = mesh_models(rig, self.point, self.coupling_state)
        return LoadedCircuit(self.point, models, self.drags, self.setting, systems[elements])


@dataclass(frozen=True)
class _Wanted:
    """The error of one check: its key, its mesh, where the response behind it is, and what it takes from it."""

    key: str
    mesh: int
    loaded: _Loaded
    value: Value


def load_errors(solved: SolvedRig) -> tuple[DiscretisationRow, ...]:
    """Discretisation errors of the checks on dynamic loads by id; none without loads or where no response is found.

    Checks that look at the same place share its responses; the places are solved on all cores.
    """
    if solved.run is None:
        return ()
    coarser = HALVED if solved.rig.shaft_model == "torsional" else (*HALVED, FEWER_MODES)
    rigs = (solved.rig, *(solved.rig.coarsened(one) for one in coarser))
    wanted = [*_held(solved), *_in_the_run(solved)]
    places = {one.loaded.place: one.loaded for one in wanted}
    with BackgroundTasks([partial(loaded.responses, rigs) for loaded in places.values()]) as tasks:
        found = dict(zip(places, tasks.results(), strict=True))
    return tuple(_row(solved, one, found[one.loaded.place]) for one in wanted if found[one.loaded.place])


def missing_load_errors(solved: SolvedRig) -> tuple[str, ...]:
    """Ids of the checks on dynamic loads whose error is not known: a coarser rig found no periodic response."""
    if solved.run is None:
        return ()
    known = {row.quantity for row in solved.discretisation}
    wanted = [
        f"dynamics.{key}.{solved.label(mesh)}"
        for mesh in range(len(solved.rig.mesh_names))
        for key in (
            "dynamic_factor",
            *(("ramp_peak", "contact_margin") if loaded_stages(solved, mesh) else ()),
        )
    ]
    return tuple(name for name in wanted if name not in known)


def _held(solved: SolvedRig) -> Iterator[_Wanted]:
    """K_V of every mesh at the held stage where it is highest."""
    for mesh in range(len(solved.rig.mesh_names)):
        worst = max(
            (point for point in solved.points if point.last.response is not None),
            key=lambda point: _factor(point.last.response, mesh) if point.last.response else 0.0,
        )
        assert worst.setting is not None
        loaded = _Loaded(worst.point, worst.last.coupling_state, worst.last.drags, worst.setting)
        yield _Wanted("dynamic_factor", mesh, loaded, _factor)


def _in_the_run(solved: SolvedRig) -> Iterator[_Wanted]:
    """Highest peak and least share of every mesh in the time run, in the stages that the checks look at."""
    for mesh in range(len(solved.rig.mesh_names)):
        loads = loaded_stages(solved, mesh)
        if loads:
            peak = max(loads, key=lambda load: load.peak)
            least = min(loads, key=lambda load: load.least_share)
            at_peak = _at(solved, mesh, peak.stage, peak.speed, peak.mean)
            at_least = _at(solved, mesh, least.stage, least.least_share_speed, least.least_share_mean)
            yield _Wanted("ramp_peak", mesh, at_peak, _factor)
            yield _Wanted("contact_margin", mesh, at_least, _least)


def _at(solved: SolvedRig, mesh: int, stage: str, speed: float, torque: float) -> _Loaded:
    """The warm rig of the test at another speed [rad/s] and mean torque [N m] of the pinion of a mesh."""
    test, rig = solved.test, solved.rig
    assert test.last.response is not None
    share = torque / float(test.last.response.mean[mesh])
    point = OperatingPoint(
        stage=stage,
        speed=speed / rig.shaft_speed(rig.mesh_gear(mesh, 0).shaft, 1.0),
        torque=share * test.point.torque,
    )
    state = test.last.coupling_state.with_torque_share(share)
    return _Loaded(point, state, {}, BracingState(mode="torque_controlled"), in_run=True)


def _row(solved: SolvedRig, wanted: _Wanted, responses: tuple[CurvePoint, ...]) -> DiscretisationRow:
    """Error of a check from the responses of the rigs."""
    numerics = solved.case.numerics
    ruled = (
        numerics.slices_spur is None and numerics.slices_helical is None,
        numerics.shaft_element_length is None,
    )
    bends = solved.rig.shaft_model != "torsional"
    by_influence = solved.rig.mesh_stiffness == "influence_numbers"
    fine, *halved = (wanted.value(response, wanted.mesh) for response in responses)
    shares = [1.0 / (2.0**ORDER - 1.0) if rule else 1.0 for rule in (*ruled, *(True,) * bends)]
    parts = [share * abs(fine - other) for share, other in zip(shares, halved, strict=True)]
    solid, per_dynamic = TABLES_LEAVE_OUT
    tables = solid + per_dynamic * abs(fine - 1.0) if bends and by_influence else 0.0
    return DiscretisationRow(
        quantity=f"dynamics.{wanted.key}.{solved.label(wanted.mesh)}", gearbox="", stage="", value=fine,
        error=sum(parts) + tables, unit="-", order=ORDER if all(ruled) else None,
        method=f"periodic response at {responses[0].speed / RPM:.0f} rpm of the first pinion, half the slices "
        f"{halved[0]:.4f}, elements twice as long {halved[1]:.4f}"
        + (f", modes up to half the frequency {halved[2]:.4f}" if bends else "")
        + ("" if all(ruled) else "; full change where the case states slices or element length")
        + (f"; {tables:.4f} that the contact tables leave out" if tables else ""),
    )  # fmt: skip


def _factor(response: CurvePoint, mesh: int) -> float:
    return float(response.dynamic_factor[mesh])


def _least(response: CurvePoint, mesh: int) -> float:
    return float(response.minimum[mesh] / response.mean[mesh])
