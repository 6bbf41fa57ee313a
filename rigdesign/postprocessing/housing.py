"""Temperatures and heat of the solved rig: housings, heat balance of the rig, fields."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rigdesign.base.part_name import OilStreamName
from rigdesign.base.units import celsius
from rigdesign.case.geometry import conditions_of
from rigdesign.case.rig_heat import OIL_COOLER
from rigdesign.case.surface_conditions import FlankFilm
from rigdesign.coupling.flank_heat import GearFlanks, flank_films, gear_flanks, rim_surfaces
from rigdesign.coupling.housing_context import (
    BEARING_OIL,
    GEAR_OIL,
    STREAM,
    heat_carried_off,
    heat_given_off,
    link_conductance,
    segments,
)
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.oil import heater_and_cooler
from rigdesign.coupling.oil_circuits import DriveHeat, circuit_balances, drive_heat, into_tank
from rigdesign.coupling.temperatures import HousingField, body_mean, heat_stored, heat_to_room, solve_housing
from rigdesign.oil_circuit.steady import DeviceLoad, SteadyCircuit
from rigdesign.results.housing import (
    BodyTemperature,
    CircuitBalance,
    CircuitDevice,
    CircuitLine,
    CoolingBalance,
    FluidTemperature,
    GearHeatSplit,
    HeatSource,
    HousingTemperatures,
    RadiationReadings,
    RigHeat,
    RoomTemperature,
    Sink,
    StageBalance,
)
from rigdesign.results.thermal import LossRow, OilRow, TemperatureField
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import ChamberOil
from rigdesign.rig_heat.component import ComponentHeat, room_balance
from thermal.conditions.boundary import Film, SurfaceSource
from thermal.conduction.setup import Condition, heat_flux
from thermal.conduction.steady import solve_steady
from thermal.films.flank import fin_efficiency, tooth_excess


def stage_balance(rig: Rig, last: IterationResult) -> StageBalance:
    """Heat of the whole rig at one held stage, with its oil circuits."""
    damped = math.fsum(placed.not_heat for placed in last.losses)
    heats = {str(stream.name): np.array([stream.to_tank]) for stream in last.streams}
    balances = circuit_balances(rig, last)
    circuits = balances.values()
    heater, carried = (float(power[0]) for power in heater_and_cooler(rig.case, heats))
    drive = drive_heat(rig, last.point, last.losses)
    by_oil = [part for part in drive.machines if into_oil(rig, part)]
    steady = rig.case.ambient.warming_time is None
    streams, volumes = carried_and_given(rig, last.fields)
    cooling = CoolingBalance(
        stage=last.point.stage,
        losses=math.fsum(placed.loss.power for placed in last.losses) - damped,
        pump=math.fsum(placed.pumped for placed in last.losses),
        heater=heater + math.fsum(found.heater_power for found in circuits),
        cooler=math.fsum(
            (
                carried,
                *(found.cooler_heat for found in circuits),
                *(part.to_coolant for part in by_oil if part.split.coolant == OIL_COOLER),
            )
        ),
        room=math.fsum(heat_to_room(field) for field in last.fields.values()),
        stored=None if steady else math.fsum(heat_stored(field) for field in last.fields.values()),
        not_heat=damped,
        flow=math.fsum(stream.flow for stream in last.streams),
        circulation=math.fsum(found.pump_heat for found in circuits) if circuits else None,
        tanks=math.fsum(found.wall_loss for found in circuits) if circuits else None,
        machines=math.fsum(part.to_coolant for part in by_oil) or None,
        streams=streams,
        volumes=volumes,
    )
    return StageBalance(cooling=cooling, heat=rig_heat(rig, last, drive, balances, heater), circuits=balances)


def compared_temperatures(rig: Rig, result: PointResult, field: HousingField) -> HousingTemperatures:
    """Temperatures and heat of one housing at one held stage, with what was solved to compare: the other reading of
    radiation, the ends of the ranges of the flank films.

    Raises
    ------
    NotConverged
        One of these solves stalls.
    """
    name, last = field.gearbox, result.last
    housing = rig.case.housings[name]
    other = solve_housing(
        rig, name, last, field,
        radiation_included=not housing.radiation_included, tolerance=COMPARED,
    )  # fmt: skip
    readings = {housing.radiation_included: field, not housing.radiation_included: other}
    return replace(
        housing_temperatures(rig, result, field),
        alternatives=RadiationReadings(
            highest_radiation_included_false=float(readings[False].temperature.max()),
            highest_radiation_included_true=float(readings[True].temperature.max()),
            heat_to_the_room_under_the_other_reading=heat_to_room(other),
        ),
        heat_split=heat_splits(rig, result, field),
    )


def housing_temperatures(rig: Rig, result: PointResult, field: HousingField) -> HousingTemperatures:
    """Temperatures and heat of one housing at one held stage as the loop left them: nothing is solved again."""
    mesh = rig.models[field.gearbox].mesh
    bodies = body_temperatures(rig, field)
    return HousingTemperatures(
        gearbox=field.gearbox,
        stage=result.point.stage,
        max_temperature=float(field.temperature.max()),
        max_temperature_body=max(bodies, key=lambda body: bodies[body].max),
        bodies=bodies,
        heat=tuple(field.solution.balance.rows),
        closure_relative=field.solution.balance.closure,
        room_heat=heat_to_room(field),
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        fluids=tuple(fluid_temperatures(rig, field, result.last.coupling_state.oil_outlet)),
    )


def losses_of(stage: str, losses: Sequence[PlacedLoss]) -> Iterator[LossRow]:
    """Losses of one stage by place."""
    for placed in losses:
        yield LossRow(
            place=placed.name,
            kind=placed.loss.kind,
            stage=stage,
            power=placed.loss.power,
            into_oil=placed.into_oil,
            into_body=placed.into_body,
            not_heat=placed.not_heat,
            pump=placed.pumped,
            basis="input" if placed.given else "computed",
            details=placed.loss.details,
        )


def oil_of(point: PointResult) -> Iterator[OilRow]:
    """Oil streams of one held stage; none for bearings that are not fed, whose heat is in the oil of the gears."""
    for stream in point.last.streams:
        if stream.flow or stream.heat or not stream.name.endswith(BEARING_OIL):
            yield OilRow(
                consumer=stream.name,
                stage=point.point.stage,
                inlet=stream.inlet,
                outlet=stream.outlet,
                flow=stream.flow,
                heat=stream.heat,
            )


def body_temperatures(rig: Rig, field: HousingField) -> dict[str, BodyTemperature]:
    """Mean, highest and lowest temperature of every body."""
    mesh = rig.models[field.gearbox].mesh
    elements = rig.conduction[field.gearbox].elements
    temperatures = {}
    for body, cells in mesh.bodies.items():
        nodes = field.temperature[np.unique(mesh.cells[cells])]
        temperatures[body] = BodyTemperature(
            mean=elements.body_mean(field.temperature, body),
            max=float(nodes.max()),
            min=float(nodes.min()),
        )
    return temperatures


def fields_of(rig: Rig, result: PointResult) -> list[TemperatureField]:
    """Fields of one held stage for pictures and files."""
    return [
        TemperatureField(
            name,
            result.point.stage,
            rig.models[name].mesh,
            field.temperature,
            result.last.expansion[name].deformed.displacement
            if name in result.last.expansion
            else np.zeros_like(rig.models[name].mesh.points),
            heat_flux(rig.conduction[name], field.temperature),
        )
        for name, field in result.last.fields.items()
    ]


# Volumes and streams of the housings as solved, and what they carry off.


def fluid_temperatures(
    rig: Rig, field: HousingField, oil_outlets: Mapping[str, float]
) -> Iterator[FluidTemperature]:
    """Volumes, then streams of one housing at one held stage; oil_outlets : by ``gearbox.stream`` [K]."""
    housing = rig.case.housings[field.gearbox]
    rows = field.solution.balance.rows
    found = field.solution.volumes
    ends = {kind: oil_outlets[OilStreamName(field.gearbox, kind)] for kind in (GEAR_OIL, BEARING_OIL)}
    places = {**ends, "ambient": rig.case.ambient.temperature, **found}
    for name, volume in housing.volumes.items():
        links = {}
        for link, entry in housing.links.items():
            if name in entry.between:
                other = entry.between[1 - entry.between.index(name)]
                links[link] = link_conductance(rig, entry) * (places[other] - places[name])
        films = (row.power for row in rows if row.surface == name and row.kind == name)
        yield FluidTemperature(
            name=name, kind="volume", inlet=None, temperature=found[name], heat=math.fsum(films), links=links,
            power=volume.power,
        )  # fmt: skip
    for name, stream in housing.streams.items():
        parts = {part for part, _ in segments(housing, rig.surface_names(field.gearbox), name)}
        yield FluidTemperature(
            name=name,
            kind="stream",
            inlet=stream.inlet_temperature,
            temperature=found[name],
            heat=-math.fsum(row.power for row in rows if row.kind == STREAM and row.surface in parts),
            links={},
        )


def carried_and_given(rig: Rig, fields: Mapping[str, HousingField]) -> tuple[float | None, float | None]:
    """Heat that streams carry off and heat set free in volumes, of all housings [W]; None where there are none."""
    housings = {name: rig.case.gearboxes[name].housing for name in fields}
    with_streams = [name for name, housing in housings.items() if housing is not None and housing.streams]
    with_volumes = [housing for housing in housings.values() if housing is not None and housing.volumes]
    carried = math.fsum(heat_carried_off(fields[name].solution) for name in with_streams)
    given = math.fsum(heat_given_off(housing) for housing in with_volumes)
    return carried if with_streams else None, given if with_volumes else None


# The heat split: share of the friction heat of each gear that goes into the oil, with its range.

RANGED = ("wetted_share", "film_factor")
"""Inputs of a flank film whose ranges make the range of the split, both at their low and both at their high end."""

COMPARED = 1e-7
"""Heat left over, relative to the heat turned over, of fields that are solved only to compare: microkelvins."""


def heat_splits(rig: Rig, result: PointResult, field: HousingField) -> tuple[GearHeatSplit, ...]:
    """Heat split of every gear of a housing at a held stage, with its range.

    The range keeps losses, oil and warm gears of the converged state and solves the housing anew.
    """
    friction = friction_heat(rig, result, field.gearbox)
    films = _films(rig, field.gearbox)
    splits = split_as_solved(rig, result, field)
    found: list[dict[str, GearHeatSplit]] = []
    for end in (0, 1):
        ends = _ends(rig, field.gearbox, films, end)
        if ends is None:
            return tuple(splits.values())
        other = _solved_again(rig, result, field, friction, ends)
        found.append({gear: _split(rig, result, other, gear, ends[gear]) for gear in splits})
    low, high = found
    return tuple(
        replace(split, weak_film=low[gear], strong_film=high[gear]) for gear, split in splits.items()
    )


def split_as_solved(rig: Rig, result: PointResult, field: HousingField) -> dict[str, GearHeatSplit]:
    """Split of every meshed gear that friction heats, without its range: nothing is solved again."""
    films, box = _films(rig, field.gearbox), rig.case.gearboxes[field.gearbox]
    bodies = rig.models[field.gearbox].mesh.bodies
    return {
        gear: _split(rig, result, field, gear, films.get(gear))
        for gear, heat in friction_heat(rig, result, field.gearbox).items()
        if heat and f"gear_{box.gears[gear].shaft}" in bodies
    }


def friction_heat(rig: Rig, result: PointResult, name: str) -> dict[str, float]:
    """Friction heat of all its meshes that enters the flanks of each gear of a gearbox [W]."""
    box = rig.case.gearboxes[name]
    heat = dict.fromkeys(box.gears, 0.0)
    for placed in result.last.losses:
        if placed.gearbox == name and placed.split is not None:
            mesh = box.meshes[placed.part]
            heat[mesh.pinion] += placed.split.pinion * placed.loss.power
            heat[mesh.wheel] += (1.0 - placed.split.pinion) * placed.loss.power
    return heat


def _films(rig: Rig, name: str) -> dict[str, FlankFilm]:
    box = rig.case.gearboxes[name]
    return flank_films(box, rim_surfaces(box))


def _ends(rig: Rig, name: str, films: Mapping[str, FlankFilm], end: int) -> dict[str, FlankFilm] | None:
    """The films at one end of the ranges of the case; None where it states no range."""
    box = rig.case.gearboxes[name]
    if box.housing is None or box.heat_split.rule != "flank_film":
        return None
    ranges = {mark.path: mark.range for mark in rig.case.origin.marks if mark.range is not None}
    rims = rim_surfaces(box)
    entries = {surface: entry for entry, surface, _ in conditions_of(box.housing, rims.values())}
    changed = {}
    for gear, film in films.items():
        at = f"gearboxes.{name}.housing.boundary.{entries[rims[gear]]}"
        given = {key: float(ranges[f"{at}.{key}"][end]) for key in RANGED if f"{at}.{key}" in ranges}
        changed[gear] = film.model_copy(update=given)
    return changed if changed != dict(films) else None


def _flanks(rig: Rig, result: PointResult, name: str, gear: str, film: FlankFilm) -> GearFlanks:
    state = result.last.coupling_state
    chamber = ChamberOil.of(name, state.oil_outlet, state.oil_supply)
    return gear_flanks(rig, name, gear, result.point, film, chamber)


def _solved_again(
    rig: Rig,
    result: PointResult,
    field: HousingField,
    friction: Mapping[str, float],
    films: Mapping[str, FlankFilm],
) -> HousingField:
    """The field with other films on the teeth and what these let through to the rims."""
    name = field.gearbox
    gears = {surface: gear for gear, surface in rim_surfaces(rig.case.gearboxes[name]).items()}
    bulk = result.last.coupling_state.gear_temperature
    conditions: list[Condition] = []
    for condition in field.conditions:
        gear = gears.get(getattr(condition, "surface", ""))
        if gear is not None and isinstance(condition, Film):
            condition = _flanks(rig, result, name, gear, films[gear]).film(condition.surface, condition.kind)
        elif gear is not None and isinstance(condition, SurfaceSource):
            kept = _flanks(rig, result, name, gear, films[gear]).kept(bulk[f"{name}.{gear}"])
            condition = replace(condition, power=kept * friction[gear])
        conditions.append(condition)
    setup = rig.conduction[name]
    solution = solve_steady(setup, conditions, near=field.solution, tolerance=COMPARED)
    return HousingField(gearbox=name, conditions=tuple(conditions), solution=solution)


def _split(
    rig: Rig, result: PointResult, field: HousingField, gear: str, condition: FlankFilm | None
) -> GearHeatSplit:
    name = field.gearbox
    box = rig.case.gearboxes[name]
    rim = rim_surfaces(box)[gear]
    heat = friction_heat(rig, result, name)[gear]
    rows = [row for row in field.solution.balance.rows if row.surface == rim]
    reached = math.fsum(row.power for row in rows if row.kind == "mesh_loss")
    coefficient = efficiency = tooth = None
    if condition is not None:
        flanks = _flanks(rig, result, name, gear, condition)
        wall = rows[0].mean_temperature
        coefficient = flanks.law(wall, flanks.oil_temperature).value
        efficiency = fin_efficiency(flanks.ring, coefficient)
        excess = tooth_excess(flanks.ring, coefficient, heat, wall - flanks.oil_temperature)
        tooth = flanks.oil_temperature + excess
    return GearHeatSplit(
        gear=f"{name}.{gear}",
        rule=box.heat_split.rule,
        friction=heat,
        at_once=heat - reached,
        film=-math.fsum(row.power for row in rows if row.kind == GEAR_OIL),
        bulk=body_mean(rig, field, f"gear_{box.gears[gear].shaft}"),
        tooth=tooth,
        flank_film=coefficient,
        fin_efficiency=efficiency,
    )


# Heat of the whole rig at a held stage: every source with its sinks, and the balance of the room.

FAR_FROM_AMBIENT = 5.0
"""Between the room and ``ambient.temperature``, from which it is named [K]."""


def rig_heat(
    rig: Rig,
    last: IterationResult,
    drive: DriveHeat,
    circuits: Mapping[str, SteadyCircuit],
    stated_heater: float,
) -> RigHeat:
    """Heat of the rig at one held stage.

    drive : what drives it; circuits : oil circuits in balance
    stated_heater : power that heats the oils whose inlet temperatures the case states [W]
    """
    sources = (
        *_gearboxes(rig, last),
        *_oil_supplies(circuits, stated_heater),
        *(
            HeatSource(name=part.name, kind="coupling", power=part.power, sinks={"room": part.power})
            for part in drive.couplings
        ),
        *(_machine(rig, part) for part in drive.machines),
    )
    pumps = [placed.pumped for placed in last.losses]
    pumps += [found.pump_heat + found.pump_to_room for found in circuits.values()]
    heaters = [stated_heater, *(found.heater_power for found in circuits.values())]
    room = _room(rig, sources)
    return RigHeat(
        stage=last.point.stage,
        sources=sources,
        drive_power=drive.power,
        mains_power=drive.mains,
        input_power=math.fsum((drive.mains, *pumps, *heaters)),
        room=room,
        warnings=_warnings(rig, drive, room),
    )


def _gearboxes(rig: Rig, last: IterationResult) -> Iterator[HeatSource]:
    """Losses with the energy of the jets; what the walls do not give away leaves with the oil."""
    steady = rig.case.ambient.warming_time is None
    for name in rig.case.gearboxes:
        own = [placed for placed in last.losses if placed.gearbox == name]
        field = last.fields.get(name)
        oil = (into_tank(rig, stream) for stream in last.streams if stream.name.gearbox == name)
        sinks: dict[Sink, float] = {
            "room": 0.0 if field is None else heat_to_room(field),
            "oil": math.fsum(oil),
            "no_heat": math.fsum(placed.not_heat for placed in own),
        }
        if field is not None and not steady:
            sinks["stored"] = heat_stored(field)
        power = math.fsum((*(placed.loss.power for placed in own), *(placed.pumped for placed in own)))
        yield HeatSource(name=name, kind="gearbox", power=power, sinks=sinks)


def _oil_supplies(circuits: Mapping[str, SteadyCircuit], stated_heater: float) -> Iterator[HeatSource]:
    """Pumps and heaters of the oil circuits; their tanks and pipes give heat of the oil to the room."""
    for name, found in circuits.items():
        power = found.heater_power + found.pump_heat + found.pump_to_room
        sinks: dict[Sink, float] = {"room": found.room_loss, "oil": power - found.room_loss}
        yield HeatSource(name=name, kind="oil supply", power=power, sinks=sinks)
    if stated_heater:
        yield HeatSource(name="heaters", kind="oil supply", power=stated_heater, sinks={"oil": stated_heater})


def _machine(rig: Rig, part: ComponentHeat) -> HeatSource:
    sinks: dict[Sink, float] = {"room": part.to_room}
    if part.to_coolant:
        sinks["oil" if into_oil(rig, part) else "water"] = part.to_coolant
    return HeatSource(name=part.name, kind="machine", power=part.power, sinks=sinks)


def into_oil(rig: Rig, part: ComponentHeat) -> bool:
    """Whether the coolant of a machine is an oil of the rig; else it is water of its own."""
    return part.split.coolant in (*rig.case.oil_circuits, OIL_COOLER)


def _room(rig: Rig, sources: Sequence[HeatSource]) -> RoomTemperature | None:
    room = rig.heat_parts.room
    if room is None:
        return None
    heats = {f"{source.kind} {source.name}": source.sinks.get("room", 0.0) for source in sources}
    balance = room_balance(room, {name: heat for name, heat in heats.items() if heat})
    needed = balance.needed_air_flow
    return RoomTemperature(
        temperature=balance.temperature,
        limit=room.temperature_limit,
        heat=balance.heat,
        by_air=balance.by_air,
        by_walls=balance.by_walls,
        air_flow=room.air_flow,
        needed_air_flow=None if needed is None or math.isinf(needed) else needed,
    )


def _warnings(rig: Rig, drive: DriveHeat, room: RoomTemperature | None) -> tuple[str, ...]:
    found = [f"{part.name}: {text}" for part in drive.components for text in part.warnings]
    ambient = rig.case.ambient.temperature
    if room is not None and abs(room.temperature - ambient) > FAR_FROM_AMBIENT:
        found.append(
            f"room: temperature = {celsius(room.temperature)}: the housings are computed in a room of "
            f"{celsius(ambient)} (ambient.temperature); write that of the room and compute again"
        )
    return tuple(found)


def circuit_balances_at(balance: StageBalance) -> Iterator[CircuitBalance]:
    """Every oil circuit of one held stage: tank, lines, heaters and coolers with what they need and can do."""
    for name, found in balance.circuits.items():
        pump = found.circuit.pump
        yield CircuitBalance(
            circuit=name,
            stage=balance.cooling.stage,
            tank=found.tank_temperature,
            flow=found.circuit.flow,
            heater=found.heater_power,
            cooler=found.cooler_heat,
            pump=pump.shaft_power if pump else 0.0,
            machines=found.machine_heat,
            room=found.room_loss,
            imbalance=found.imbalance,
            lines=tuple(_line(found, line) for line in found.lines),
            devices=tuple(_devices(found)),
        )


def _line(found: SteadyCircuit, name: str) -> CircuitLine:
    line, given = found.lines[name], next(each for each in found.circuit.lines if each.name == name)
    return CircuitLine(
        line=name,
        setpoint=given.setpoint,
        tolerance=given.tolerance,
        supply=line.supply,
        drain=line.drain,
        back=line.back,
        flow=given.flow,
        heat=sum(line.heats.values()),
    )


def _devices(found: SteadyCircuit) -> Iterator[CircuitDevice]:
    loads: dict[str, DeviceLoad | None] = {"heater": found.heater, "tank cooler": found.tank_cooler}
    loads |= {f"trim heater of {line}": load for line, load in found.trim_heaters.items()}
    loads |= {f"cooler of {line}": load for line, load in found.line_coolers.items()}
    for name, load in loads.items():
        if load is not None:
            yield CircuitDevice(device=name, power=load.power, needed=load.needed, capability=load.capability)
