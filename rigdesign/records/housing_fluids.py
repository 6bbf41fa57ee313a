"""Volumes and streams of the housings as solved, and what they carry off."""

import math
from collections.abc import Iterator, Mapping

from rigdesign.coupling.housing_fluids import (
    STREAM,
    heat_carried_off,
    heat_given_off,
    link_conductance,
    segments,
)
from rigdesign.coupling.temperatures import HousingField
from rigdesign.results.housing import FluidTemperature
from rigdesign.rig.model import Rig


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
