"""One iteration round the loop at an operating point: warm gears, loads, losses, oil, temperatures, thermal
expansion."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from dynamics.bearing.protocol import BearingState
from dynamics.response.speed_sweep import CurvePoint
from rigdesign.base.finite import finite
from rigdesign.coupling.bearing_films import solve_bearings
from rigdesign.coupling.drag_torques import drag_torques
from rigdesign.coupling.expansion import HousingExpansion, expand_housing, hot_clearances, uniform_expansion
from rigdesign.coupling.loads import BracingState, MeshModel, mesh_models, respond
from rigdesign.coupling.losses import PlacedLoss, mesh_losses, rotating_losses
from rigdesign.coupling.oil import OilStream, oil_streams
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.coupling.temperatures import (
    TOLERANCE,
    HousingField,
    body_mean,
    heat_into_films,
    heat_into_oil,
    solve_housing,
)
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed, wall_flow

ROUGH = 1e-5
"""Heat left over in the fields of an iteration that cannot be the last: some millikelvin."""


@dataclass(frozen=True, kw_only=True)
class IterationResult:
    """Everything one iteration computed from one coupling state."""

    point: OperatingPoint
    coupling_state: CouplingState
    """What the iteration started from."""
    models: tuple[MeshModel, ...]
    bearings: Mapping[str, BearingState]
    drags: Mapping[str, float]
    response: CurvePoint | None
    losses: tuple[PlacedLoss, ...]
    streams: tuple[OilStream, ...]
    fields: Mapping[str, HousingField]
    expansion: Mapping[str, HousingExpansion]
    bearing_heat: Mapping[str, float]
    """Heat the solids gave to each film in this iteration [W], before relaxation."""
    wall_heat: Mapping[str, float]
    """Heat the solids gave to each oil stream [W], before relaxation."""


@dataclass(frozen=True, kw_only=True)
class IterationParts:
    """The expensive parts of an iteration, each as the function that computes it.

    `rigdesign.prediction` puts others in their place: what is known already, fields and thermal expansion projected
    on few shapes.
    """

    models: Callable[..., tuple[MeshModel, ...]] = mesh_models
    bearings: Callable[..., dict[str, BearingState]] = solve_bearings
    response: Callable[..., CurvePoint] = respond
    field: Callable[..., HousingField] = solve_housing
    expansion: Callable[..., HousingExpansion] = expand_housing
    bulk: Callable[[Rig, HousingField, str], float] = body_mean


SOLVED = IterationParts()
"""Every part solved in full."""


def run_iteration(
    rig: Rig,
    point: OperatingPoint,
    coupling_state: CouplingState,
    setting: BracingState | None,
    before: IterationResult | None = None,
    *,
    fine: bool = True,
    parts: IterationParts = SOLVED,
) -> IterationResult:
    """Compute one iteration; ``before`` gives the fields to start from.

    parts : what computes its expensive parts
    fine : expand the housings and solve the fields to the last digit; else the thermal expansion of ``before`` is
    carried on
        and the heat of the fields closes to 1e-4, which saves time while the temperatures still move a lot. An
        iteration that ends the loop must be fine.

    Raises
    ------
    NonFiniteResultError
        A loss that is NaN or infinite.
    """
    models = parts.models(rig, point, coupling_state)
    bearings = parts.bearings(rig, point, coupling_state)
    turning = rotating_losses(rig, point, coupling_state, models, bearings)
    drags = drag_torques(turning, rig, point.speed)
    response = None if setting is None else parts.response(rig, point, models, drags, setting)
    losses = (*turning, *mesh_losses(rig, point, models, response, coupling_state))
    for placed in losses:
        finite(f"stage {point.stage}: {placed.loss.kind} loss of {placed.name}", placed.loss.power)
    starts: Mapping[str, HousingField] = {} if before is None else before.fields
    tolerance = TOLERANCE if fine else ROUGH
    fields = {
        name: parts.field(
            rig, name, point, coupling_state, bearings, losses, starts.get(name), tolerance=tolerance
        )
        for name in rig.models
    }
    bearing_heat = dict.fromkeys(bearings, 0.0)
    wall_heat = dict.fromkeys(coupling_state.wall_heat, 0.0)
    for field in fields.values():
        bearing_heat |= heat_into_films(field)
        wall_heat |= heat_into_oil(field)
    return IterationResult(
        point=point,
        coupling_state=coupling_state,
        models=models,
        bearings=bearings,
        drags=drags,
        response=response,
        losses=losses,
        streams=tuple(oil_streams(rig, losses, coupling_state.bearing_heat, coupling_state.wall_heat)),
        fields=fields,
        expansion=_expansion(rig, fields, before, fine, parts),
        bearing_heat=bearing_heat,
        wall_heat=wall_heat,
    )


def _expansion(
    rig: Rig,
    fields: Mapping[str, HousingField],
    before: IterationResult | None,
    fine: bool,
    parts: IterationParts,
) -> dict[str, HousingExpansion]:
    if before is not None and not fine:
        return dict(before.expansion)
    return {
        name: parts.expansion(rig, field, None if before is None else before.expansion[name])
        for name, field in fields.items()
        if not rig.models[name].no_expansion
    }


def next_state(rig: Rig, done: IterationResult, parts: IterationParts = SOLVED) -> CouplingState:
    """What an iteration hands to the next; heats are relaxed by what the oil can take up (`relaxed_heat`)."""
    old = done.coupling_state
    gear_temperature: dict[str, float] = {}
    centre_distance: dict[str, float] = {}
    clearance: dict[str, float] = {}
    axial_expansion = dict.fromkeys(rig.pairs, 0.0)
    for name, box in rig.case.gearboxes.items():
        streams = {stream.name: stream for stream in done.streams}
        bulk = streams[f"{name}.gear_oil"].chamber
        gear_temperature |= {f"{name}.{gear}": bulk for gear in box.gears}
        if name in done.fields:
            gear_temperature |= {
                f"{name}.{gear}": parts.bulk(rig, done.fields[name], f"gear_{entry.shaft}")
                for gear, entry in box.gears.items()
                if f"gear_{entry.shaft}" in rig.models[name].mesh.bodies
            }
        if name in done.expansion:
            centre_distance |= done.expansion[name].centre_distance
            axial_expansion |= done.expansion[name].axial_expansion
        else:
            centre_distance |= uniform_expansion(rig, name, streams[f"{name}.bearing_oil"].chamber)
    clearance |= hot_clearances(rig, done.point.speed, done.expansion)
    torque = old.mesh_torque
    if done.response is not None:
        signed = done.response.flank * done.response.mean
        torque = dict(zip(rig.mesh_names, map(float, signed)))
    return CouplingState(
        gear_temperature=gear_temperature,
        centre_distance=centre_distance,
        bearing_clearance=clearance,
        bearing_heat={
            name: relaxed(old.bearing_heat[name], heat, 0.5 * _film_slope(rig, done, name))
            for name, heat in done.bearing_heat.items()
        },
        wall_heat={
            name: relaxed(old.wall_heat[name], heat, _stream_slope(rig, done, name))
            for name, heat in done.wall_heat.items()
        },
        oil_outlet={stream.name: stream.chamber for stream in done.streams},
        mesh_torque=torque,
        axial_expansion=axial_expansion,
    )


def relaxed(old: float, new: float, slope: float) -> float:
    """Heat after a step that stays stable however little oil flows.

    slope : film conductance over heat capacity flow, h A / (rho c Q): how strongly the heat of one iteration
        answers the oil temperature it caused. The step 1 / (1 + slope) damps at most that answer.
    """
    return old + (new - old) / (1.0 + slope)


def heat_residual(rig: Rig, done: IterationResult) -> float:
    """Largest temperature error [K] that the heats of the last iteration would still make in an oil stream or film."""
    old = done.coupling_state
    films = (
        0.5 * abs(heat - old.bearing_heat[name]) / _bearing_capacity(rig, name)
        for name, heat in done.bearing_heat.items()
    )
    walls = (
        abs(heat - old.wall_heat[name]) / _stream_capacity(rig, name) for name, heat in done.wall_heat.items()
    )
    return max((*films, *walls), default=0.0)


def _bearing_capacity(rig: Rig, name: str) -> float:
    """Heat capacity flow rho c Q of the oil of one bearing [W/K]."""
    return bearing_feed(rig, name.split(".")[0]).capacity_rate


def _stream_capacity(rig: Rig, name: str) -> float:
    """Heat capacity flow of an oil stream of a gearbox along its walls [W/K]."""
    box_name, kind = name.split(".")
    box = rig.case.gearboxes[box_name]
    if kind == "gear_oil":
        return replace(gear_feed(rig, box_name), flow=wall_flow(box)).capacity_rate
    feed = bearing_feed(rig, box_name)
    return replace(feed, flow=feed.flow * len(box.bearings)).capacity_rate


def _film_slope(rig: Rig, done: IterationResult, name: str) -> float:
    box, part = name.split(".")
    return _conductance(done, box, f"bearing_film:{part}") / _bearing_capacity(rig, name)


def _stream_slope(rig: Rig, done: IterationResult, name: str) -> float:
    box, kind = name.split(".")
    return _conductance(done, box, kind) / _stream_capacity(rig, name)


def _conductance(done: IterationResult, box: str, kind: str) -> float:
    """Sum of h A over the films of one kind [W/K]."""
    if box not in done.fields:
        return 0.0
    rows = done.fields[box].solution.balance.rows
    return sum(row.coefficient.value * row.area for row in rows if row.kind == kind and row.coefficient)
