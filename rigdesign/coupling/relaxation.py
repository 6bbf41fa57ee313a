"""What an iteration hands to the next, with its heats relaxed by what the oil can take up."""

import math
from dataclasses import replace

from rigdesign.coupling.bearing_seats import bearing_temperatures
from rigdesign.coupling.expansion import hot_clearances, uniform_expansion
from rigdesign.coupling.iteration import SOLVED, IterationParts, IterationResult, PointProblem
from rigdesign.coupling.misalignment import warm_misalignment
from rigdesign.coupling.oil_circuits import circuit_balances, supplies
from rigdesign.coupling.shaft_positions import axis_tilt, flank_approach, mesh_placements
from rigdesign.coupling.state import CouplingState
from rigdesign.coupling.temperatures import seat_temperatures
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed, wall_flow


def next_state(rig: Rig, done: IterationResult, parts: IterationParts = SOLVED) -> CouplingState:
    """What an iteration hands to the next; heats are relaxed by what the oil can take up (`relaxed`)."""
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
    seats = seat_temperatures(rig, done.fields)
    clearance |= hot_clearances(
        rig, done.point.speed, done.expansion, bearing_temperatures(done.bearings, seats)
    )
    placements = mesh_placements(rig, done.point, old, done.bearings)
    warm = warm_misalignment(rig, {name: shape.deformed for name, shape in done.expansion.items()})
    torque = old.mesh_torque
    if done.response is not None:
        signed = done.response.flank * done.response.mean
        torque = dict(zip(rig.mesh_names, map(float, signed)))
    return CouplingState(
        gear_temperature=gear_temperature,
        centre_distance={
            name: distance + (placements[name].apart if name in placements else 0.0)
            for name, distance in centre_distance.items()
        },
        bearing_clearance=clearance,
        bearing_heat={
            name: relaxed(old.bearing_heat[name], heat, 0.5 * _film_gain(rig, done, name))
            if rig.bearing(name).has_film
            else heat
            for name, heat in done.bearing_heat.items()
        },
        wall_heat={
            name: relaxed(old.wall_heat[name], heat, _stream_gain(rig, done, name))
            for name, heat in done.wall_heat.items()
        },
        oil_outlet={stream.name: stream.chamber for stream in done.streams},
        oil_supply=supplies(circuit_balances(rig, done)),
        mesh_torque=torque,
        axial_expansion=axial_expansion,
        seat_temperature=seats,
        flank_approach=flank_approach(placements),
        axis_tilt=axis_tilt(placements),
        coupling_offset=warm.offset,
        coupling_angle=warm.angle,
    )


def unrelaxed(after: CouplingState, done: IterationResult) -> CouplingState:
    """The next state of an iteration with its heats as the solids gave them."""
    return replace(after, bearing_heat=done.bearing_heat, wall_heat=done.wall_heat)


def relaxed(old: float, new: float, gain: float) -> float:
    """Heat after a step that stays stable however little oil flows.

    gain : film conductance over heat capacity flow, h A / (rho c Q): change of the heat per heat of the iteration
        before, by the oil temperature this caused; the step is 1 / (1 + gain)
    """
    return old + (new - old) / (1.0 + gain)


def heat_residual(problem: PointProblem, done: IterationResult) -> float:
    """Largest temperature error [K] that the heats of an iteration would still make in an oil stream or film.

    Zero where the heats are frozen.
    """
    rig, old = problem.rig, done.coupling_state
    if {"bearing_heat", "wall_heat"} & problem.freeze:
        return 0.0
    films = (
        0.5 * abs(heat - old.bearing_heat[name]) / _bearing_capacity(rig, name, old)
        for name, heat in done.bearing_heat.items()
    )
    walls = (
        abs(heat - old.wall_heat[name]) / _stream_capacity(rig, name, old)
        for name, heat in done.wall_heat.items()
    )
    return max((*films, *walls), default=0.0)


def _bearing_capacity(rig: Rig, name: str, state: CouplingState) -> float:
    """Heat capacity flow rho c Q of the oil of one bearing [W/K]; boundless where none is fed (`_without_flow`)."""
    box_name = name.split(".")[0]
    chamber = state.oil_outlet[f"{box_name}.gear_oil"]
    return _without_flow(bearing_feed(rig, box_name, chamber, state.oil_supply).capacity_rate)


def _stream_capacity(rig: Rig, name: str, state: CouplingState) -> float:
    """Heat capacity flow of an oil stream of a gearbox along its walls [W/K]; boundless where none is fed."""
    box_name, kind = name.split(".")
    box = rig.case.gearboxes[box_name]
    chamber = state.oil_outlet[f"{box_name}.gear_oil"]
    if kind == "gear_oil":
        return _without_flow(
            replace(gear_feed(rig, box_name, chamber, state.oil_supply), flow=wall_flow(box)).capacity_rate
        )
    feed = bearing_feed(rig, box_name, chamber, state.oil_supply)
    return _without_flow(replace(feed, flow=feed.flow * len(box.bearings)).capacity_rate)


def _without_flow(capacity_rate: float) -> float:
    """A capacity rate, boundless for zero: the field knows the temperature of such oil, no heat has to be relaxed."""
    return capacity_rate or math.inf


def _film_gain(rig: Rig, done: IterationResult, name: str) -> float:
    box, part = name.split(".")
    return _conductance(done, box, f"bearing_film:{part}") / _bearing_capacity(rig, name, done.coupling_state)


def _stream_gain(rig: Rig, done: IterationResult, name: str) -> float:
    box, kind = name.split(".")
    return _conductance(done, box, kind) / _stream_capacity(rig, name, done.coupling_state)


def _conductance(done: IterationResult, box: str, kind: str) -> float:
    """Sum of h A over the films of one kind [W/K]."""
    if box not in done.fields:
        return 0.0
    rows = done.fields[box].solution.balance.rows
    return sum(row.coefficient.value * row.area for row in rows if row.kind == kind and row.coefficient)
