"""One iteration at an operating point: loads and losses, then temperatures, thermal expansion and oil."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from dynamics.rotor.bearing import BearingState
from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.response_curve import CurvePoint
from rigdesign.base.json_text import finite
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.bearing_seats import initial_seats
from rigdesign.coupling.expansion import HousingExpansion, expand_housing, uniform_expansion
from rigdesign.coupling.located_loss import PointLosses, drag_torques
from rigdesign.coupling.loop_system import axis_tilt, flank_approach, loop_system, mesh_placements
from rigdesign.coupling.losses import mesh_losses, rotating_losses
from rigdesign.coupling.mesh_models import MeshModel, mesh_models
from rigdesign.coupling.misalignment import warm_misalignment
from rigdesign.coupling.oil import OilStream, oil_streams
from rigdesign.coupling.preloaded_loop import (
    BracingState,
    LoadedCircuit,
    brace_initial,
    first_torques,
    respond,
)
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.temperatures import (
    TOLERANCE,
    HousingField,
    body_mean,
    heat_into_films,
    heat_into_oil,
    solve_housing,
    sump_temperatures,
)
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import meant_supplies
from thermal.conduction.capacity import StoredHeat

COARSE = 1e-5
"""Heat left over in the fields of an iteration that cannot be the last: some millikelvin."""


@dataclass(frozen=True, kw_only=True)
class IterationParts:
    """The expensive parts of an iteration, each as the function that computes it.

    `rigdesign.prediction` puts others in their place: what is known already, fields and thermal expansion projected
    on a reduced basis.
    """

    models: Callable[..., tuple[MeshModel, ...]] = mesh_models
    bearings: Callable[..., dict[str, BearingState]] = solve_bearings
    system: Callable[..., LinearSystem] = loop_system
    response: Callable[..., CurvePoint] = respond
    field: Callable[..., HousingField] = solve_housing
    expansion: Callable[..., HousingExpansion] = expand_housing
    bulk: Callable[[Rig, HousingField, str], float] = body_mean


SOLVED = IterationParts()
"""Every part solved in full."""


@dataclass(frozen=True, kw_only=True)
class PointProblem:
    """The coupled problem at one operating point: all that stays the same from iteration to iteration."""

    rig: Rig
    point: OperatingPoint
    initial: CouplingState
    """Before the rig turns (`initial_state`)."""
    bracing: BracingState | None
    """None without a drivetrain."""
    parts: IterationParts = SOLVED
    freeze: frozenset[str] = frozenset()
    """Arrows of the loop that are cut, by field of `CouplingState`: they keep their initial values."""
    stored: Mapping[str, StoredHeat] = field(default_factory=dict)
    """Gearbox -> heat that its bodies take up, of a time step (`rigdesign.coupling.loop`); empty when steady."""

    @classmethod
    def braced(
        cls,
        rig: Rig,
        point: OperatingPoint,
        parts: IterationParts = SOLVED,
        freeze: frozenset[str] = frozenset(),
    ) -> "PointProblem":
        """The problem of a rig that is braced in its initial state."""
        initial = initial_state(rig, point, parts.bearings)
        bracing = None
        power = rig.case.drivetrain
        if power is not None and power.bracing.mode == "torque_controlled":
            bracing = BracingState(mode="torque_controlled")
        elif power is not None:
            system = parts.system(rig, point, initial, parts.bearings(rig, point, initial))
            bracing = brace_initial(rig, point, initial, parts.models(rig, point, initial), system)
        return cls(rig=rig, point=point, initial=initial, bracing=bracing, parts=parts, freeze=freeze)


@dataclass(frozen=True, kw_only=True)
class LoadResult(PointLosses):
    """Loads and losses from one coupling state: the first half of an iteration."""

    bracing: BracingState | None
    models: tuple[MeshModel, ...]
    drags: Mapping[str, float]
    system: LinearSystem | None
    """Of the drivetrain without its meshes; None without a drivetrain."""
    response: CurvePoint | None

    @property
    def loop(self) -> LoadedCircuit:
        """The braced loop; of a rig with a drivetrain only."""
        assert self.bracing is not None and self.system is not None
        return LoadedCircuit(self.point, self.models, self.drags, self.bracing, self.system)


@dataclass(frozen=True, kw_only=True)
class HousingResult:
    """Temperatures and thermal expansion of the housings under these losses: the second half of an iteration."""

    fields: Mapping[str, HousingField]
    expansion: Mapping[str, HousingExpansion]
    bearing_heat: Mapping[str, float]
    """Heat the solids gave to each film in this iteration [W], before relaxation."""
    wall_heat: Mapping[str, float]
    """Heat the solids gave to each oil stream [W], before relaxation."""
    sumps: Mapping[str, float]
    """Gearbox -> temperature of its sump [K], of gearboxes with a sump."""


@dataclass(frozen=True, kw_only=True)
class IterationResult(LoadResult, HousingResult):
    """Everything one iteration computed from one coupling state."""

    streams: tuple[OilStream, ...]


def run_iteration(
    problem: PointProblem,
    coupling_state: CouplingState,
    before: IterationResult | None = None,
    *,
    final: bool = True,
) -> IterationResult:
    """Compute one iteration.

    before : an earlier iteration, or that of a neighbouring point: first guess of fields and thermal expansion
    final : as in `solve_housings`; an iteration that ends the loop must be final

    Raises
    ------
    NonFiniteResultError
        A loss that is NaN or infinite.
    """
    loads = solve_loads(problem, coupling_state)
    housings = solve_housings(problem.rig, loads, before, final=final, parts=problem.parts)
    streams = oil_streams(
        problem.rig,
        loads.losses,
        coupling_state.bearing_heat,
        coupling_state.wall_heat,
        housings.sumps,
        coupling_state.oil_supply,
    )
    return IterationResult(**vars(loads), **vars(housings), streams=tuple(streams))


def solve_loads(problem: PointProblem, coupling_state: CouplingState) -> LoadResult:
    """Warm gears, bearing films, periodic response and losses at a coupling state.

    Raises
    ------
    NonFiniteResultError
        A loss that is NaN or infinite.
    """
    rig, point, parts = problem.rig, problem.point, problem.parts
    models = parts.models(rig, point, coupling_state)
    bearings = parts.bearings(rig, point, coupling_state)
    rotating = rotating_losses(rig, point, coupling_state, models, bearings)
    drags = drag_torques(rotating, rig, point.speed)
    system, response = None, None
    if problem.bracing is not None:
        system = parts.system(rig, point, coupling_state, bearings)
        response = parts.response(rig, LoadedCircuit(point, models, drags, problem.bracing, system))
    losses = (*rotating, *mesh_losses(rig, point, models, response, coupling_state))
    for placed in losses:
        finite(f"stage {point.stage}: {placed.loss.kind} loss of {placed.name}", placed.loss.power)
    return LoadResult(
        point=point,
        coupling_state=coupling_state,
        bracing=problem.bracing,
        models=models,
        bearings=bearings,
        drags=drags,
        system=system,
        response=response,
        losses=losses,
        stored=problem.stored,
    )


def solve_housings(
    rig: Rig,
    losses: PointLosses,
    before: HousingResult | None = None,
    *,
    final: bool = True,
    parts: IterationParts = SOLVED,
) -> HousingResult:
    """Temperatures and thermal expansion of all housings under the losses of a point, and the heat of the solids.

    before : an earlier result on the same meshes: first guess of fields and, where it has them, thermal expansion
    final : expand the housings and solve the fields to the last digit; else the thermal expansion of ``before`` is
        carried on and the heat of the fields closes to `COARSE`, which saves time while the temperatures still move
        a lot
    """
    starts: Mapping[str, HousingField] = {} if before is None else before.fields
    tolerance = TOLERANCE if final else COARSE
    fields = {
        name: parts.field(rig, name, losses, starts.get(name), tolerance=tolerance) for name in rig.models
    }
    bearing_heat = dict.fromkeys(losses.bearings, 0.0)
    wall_heat = dict.fromkeys(losses.coupling_state.wall_heat, 0.0)
    for solved in fields.values():
        bearing_heat |= heat_into_films(solved)
        wall_heat |= heat_into_oil(solved)
    known: Mapping[str, HousingExpansion] = {} if before is None else before.expansion
    if before is None or final:
        expansion = {
            name: parts.expansion(rig, field, known.get(name))
            for name, field in fields.items()
            if not rig.models[name].no_expansion
        }
    else:
        expansion = dict(known)
    return HousingResult(
        fields=fields,
        expansion=expansion,
        bearing_heat=bearing_heat,
        wall_heat=wall_heat,
        sumps=sump_temperatures(rig, fields),
    )


# Where the coupling loop starts: all of the rig at room temperature, its oil as it is fed.

FIRST_SUMP_RISE = 40.0
"""First guess of a sump that finds its own temperature, above room temperature [K]; the loop leaves it behind."""


def initial_state(
    rig: Rig, point: OperatingPoint, bearings: Callable[..., dict[str, BearingState]] = solve_bearings
) -> CouplingState:
    """All of the rig at room temperature, no heat from bodies, oil as fed; mesh torques without losses.

    Elastic shafts already stand in their turning bearings; bearings : solves these, as `solve_bearings`
    """
    case = rig.case
    names = (f"{box}.{gear}" for box, entry in case.gearboxes.items() for gear in entry.gears)
    streams = {}
    for name, box in case.gearboxes.items():
        gears = box.gear_oil_temperature or case.ambient.temperature + FIRST_SUMP_RISE
        fed = box.fed_bearings
        streams[f"{name}.gear_oil"] = gears
        streams[f"{name}.bearing_oil"] = gears if fed is None else fed.inlet_temperature
    state = CouplingState(
        gear_temperature=dict.fromkeys(names, case.ambient.temperature),
        centre_distance={
            mesh: distance
            for box in case.gearboxes
            for mesh, distance in uniform_expansion(rig, box, case.ambient.temperature).items()
        },
        bearing_clearance={name: entry.drawn_clearance for name, _, entry in rig.bearings()},
        bearing_heat={name: 0.0 for name, _, _ in rig.bearings()},
        wall_heat=dict.fromkeys(streams, 0.0),
        oil_outlet=streams,
        oil_supply=meant_supplies(rig),
        mesh_torque=first_torques(rig, point),
        axial_expansion=dict.fromkeys(rig.pairs, 0.0),
        seat_temperature=initial_seats(rig, case.ambient.temperature),
    )
    if rig.shaft_model == "torsional":
        return state
    as_set = warm_misalignment(rig, {})
    state = replace(state, coupling_offset=as_set.offset, coupling_angle=as_set.angle)
    placements = mesh_placements(rig, point, state, bearings(rig, point, state))
    return replace(
        state,
        centre_distance={
            name: distance + placements[name].apart for name, distance in state.centre_distance.items()
        },
        flank_approach=flank_approach(placements),
        axis_tilt=axis_tilt(placements),
    )
