"""Temperatures and heat of the solved rig: housings, heat balance of the rig, fields."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from rigdesign.case.rig_heat import OIL_COOLER
from rigdesign.coupling.housing_fluids import (
    STREAM,
    heat_carried_off,
    heat_given_off,
    link_conductance,
    segments,
)
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.oil import heater_and_cooler
from rigdesign.coupling.oil_circuits import circuit_balances
from rigdesign.coupling.rig_heat import drive_heat
from rigdesign.coupling.temperatures import HousingField, heat_stored, heat_to_room, solve_housing
from rigdesign.records.heat_split import COMPARED, heat_splits
from rigdesign.records.rig_heat import into_oil, rig_heat
from rigdesign.results.housing import (
    BodyTemperature,
    CoolingBalance,
    FluidTemperature,
    HousingTemperatures,
    RadiationReadings,
)
from rigdesign.results.thermal import TemperatureField
from rigdesign.rig.model import Rig
from thermal.conduction.flux import heat_flux


def cooling_balance(rig: Rig, last: IterationResult) -> CoolingBalance:
    """What cooler and room take out against what shafts, pump and heaters put in, at one held stage."""
    damped = math.fsum(placed.not_heat for placed in last.losses)
    heats = {stream.name: np.array([stream.to_tank]) for stream in last.streams}
    balances = circuit_balances(rig, last)
    circuits = balances.values()
    heater, carried = (float(power[0]) for power in heater_and_cooler(rig.case, heats))
    drive = drive_heat(rig, last.point, last.losses)
    by_oil = [part for part in drive.machines if into_oil(rig, part)]
    steady = rig.case.ambient.warming_time is None
    streams, volumes = carried_and_given(rig, last.fields)
    return CoolingBalance(
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
        circulation=math.fsum(found.pump_heat for found in circuits),
        tanks=math.fsum(found.wall_loss for found in circuits),
        machines=math.fsum(part.to_coolant for part in by_oil),
        circuits=balances,
        streams=streams,
        volumes=volumes,
        heat=rig_heat(rig, last, drive, balances, heater),
    )


def compared_temperatures(rig: Rig, result: PointResult, field: HousingField) -> HousingTemperatures:
    """Temperatures and heat of one housing at one held stage, with what was solved to compare: the other reading of
    radiation, the ends of the ranges of the flank films.

    Raises
    ------
    NotConverged
        One of these solves stalls.
    """
    name, last = field.gearbox, result.last
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    other = solve_housing(
        rig, name, last, field,
        radiation_included=not housing.radiation_included, tolerance=COMPARED,
    )  # fmt: skip
    readings = {housing.radiation_included: field, not housing.radiation_included: other}
    return replace(
        housing_temperatures(rig, result, field),
        radiation=RadiationReadings(
            highest_apart=float(readings[False].temperature.max()),
            highest_included=float(readings[True].temperature.max()),
            other_room_heat=heat_to_room(other),
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
        highest=float(field.temperature.max()),
        hottest_body=max(bodies, key=lambda body: bodies[body].highest),
        bodies=bodies,
        heat=tuple(field.solution.balance.rows),
        closure=field.solution.balance.closure,
        room_heat=heat_to_room(field),
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        fluids=tuple(fluid_temperatures(rig, field, result.last.coupling_state.oil_outlet)),
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
            highest=float(nodes.max()),
            lowest=float(nodes.min()),
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
    housing = rig.case.gearboxes[field.gearbox].housing
    assert housing is not None
    rows = field.solution.balance.rows
    found = field.solution.volumes
    ends = {
        name.split(".")[1]: value
        for name, value in oil_outlets.items()
        if name.split(".")[0] == field.gearbox
    }
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
