"""Volumes, streams and links of a housing as unknowns of its temperature field, and what they carry.

Volumes are stirred and have one temperature. A stream is a chain of plug flows, one for each surface it passes, and
leaves with the temperature of the last. A link leads to another volume, to room air, or to an oil as it leaves the
chamber; an oil that is an unknown itself is the volume of its own network.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from rigdesign.case.housing import Housing
from rigdesign.case.housing_fluids import HousingLink, HousingStream
from rigdesign.case.wetting import stream_surfaces
from rigdesign.properties.fluid import ATMOSPHERE, volumetric_heat
from rigdesign.rig.model import Rig
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm, VolumeLink
from thermal.conduction.steady import TemperatureSolution
from thermal.films.law import FilmLaw

STREAM, LINK, POWER = "stream", "link", "power"
"""Kinds of their rows in the heat balance: what flows in and out, links between volumes, given power."""


@dataclass(frozen=True, kw_only=True)
class WettedSurface:
    """A surface with a film to a volume or stream of the housing."""

    surface: str
    fluid: str
    law: FilmLaw


@dataclass(frozen=True, kw_only=True)
class LinkEnd:
    """What a volume may be linked to outside of the volumes."""

    temperature: float
    """[K]"""
    kind: str
    """Of the row in the heat balance."""


def fluid_networks(
    rig: Rig, name: str, films: Sequence[WettedSurface], ends: Mapping[str, LinkEnd]
) -> list[StreamNetwork]:
    """Volumes, streams and links of the housing of gearbox ``name``; none where it has none.

    films : of all its surfaces; ends : room air and oils with their temperatures. An oil that is missing there is a
    volume of another network
    """
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    networks = [_stream_network(rig, name, stream, films) for stream in housing.streams]
    if housing.volumes:
        networks.append(_volume_network(rig, housing, films, ends))
    return networks


def heat_rate(rig: Rig, medium: str, flow: float, temperature: float, pressure: float) -> tuple[float, float]:
    """Mass flow [kg/s] and specific heat [J/(kg K)] of a flow [m3/s] of an oil or fluid at a temperature [K]."""
    if medium in rig.oils:
        oil = rig.oils[medium]
        return oil.density(temperature) * flow, oil.heat_capacity(temperature)
    density, specific_heat = volumetric_heat(medium, temperature, pressure)
    return density * flow, specific_heat


def link_conductance(rig: Rig, link: HousingLink) -> float:
    """Heat per kelvin of a link [W/K]."""
    if link.conductance is not None:
        return link.conductance
    assert link.flow is not None and link.medium is not None
    room = rig.case.ambient.temperature
    mass_flow, specific_heat = heat_rate(rig, link.medium, link.flow, room, ATMOSPHERE)
    return mass_flow * specific_heat


def without_oils(network: StreamNetwork, oils: Sequence[str]) -> StreamNetwork:
    """The network with its links to ``oils`` led to the volumes of that name in other networks."""
    supplies = tuple(supply for supply in network.supplies if supply.name not in oils)
    return network if supplies == network.supplies else replace(network, supplies=supplies)


def heat_carried_off(solution: TemperatureSolution) -> float:
    """Heat that all streams of a housing take out of it [W]."""
    return -sum(row.power for row in solution.balance.rows if row.kind == STREAM)


def heat_given_off(housing: Housing) -> float:
    """Heat set free in the volumes of a housing [W]."""
    return sum(volume.power for volume in housing.volumes.values())


def segments(housing: Housing, names: Sequence[str], stream: str) -> Iterator[tuple[str, str]]:
    """(volume, surface) of every part of a stream in its order; the last has the name of the stream."""
    surfaces = stream_surfaces(housing, names, stream)
    for number, surface in enumerate(surfaces, 1):
        yield (stream if number == len(surfaces) else f"{stream} {number}"), surface


def _stream_network(rig: Rig, name: str, stream: str, films: Sequence[WettedSurface]) -> StreamNetwork:
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    entry: HousingStream = housing.streams[stream]
    inlet = f"{stream} inlet"
    parts = list(segments(housing, rig.surface_names(name), stream))
    laws = {film.surface: film.law for film in films if film.fluid == stream}
    mass_flow, specific_heat = heat_rate(
        rig, entry.medium, entry.flow, entry.inlet_temperature, entry.pressure
    )
    places = [inlet, *(volume for volume, _ in parts), None]
    return StreamNetwork(
        specific_heat=specific_heat,
        volumes=tuple(Volume(name=volume, plug_flow=True) for volume, _ in parts),
        films=tuple(
            VolumeFilm(surface=surface, volume=volume, kind=stream, law=laws[surface])
            for volume, surface in parts
        ),
        supplies=(Supply(name=inlet, temperature=entry.inlet_temperature),),
        streams=tuple(
            Stream(source=source, target=target, mass_flow=mass_flow, kind=STREAM)
            for source, target in pairwise(places)
            if source is not None
        ),
    )


def _volume_network(
    rig: Rig, housing: Housing, films: Sequence[WettedSurface], ends: Mapping[str, LinkEnd]
) -> StreamNetwork:
    links = list(_links(rig, housing, ends))
    reached = {place for link in links for place in (link.a, link.b)}
    return StreamNetwork(
        specific_heat=1.0,  # nothing flows
        volumes=tuple(Volume(name=volume, power=entry.power) for volume, entry in housing.volumes.items()),
        films=tuple(
            VolumeFilm(surface=film.surface, volume=film.fluid, kind=film.fluid, law=film.law)
            for film in films
            if film.fluid in housing.volumes
        ),
        supplies=tuple(
            Supply(name=place, temperature=end.temperature) for place, end in ends.items() if place in reached
        ),
        links=tuple(links),
    )


def _links(rig: Rig, housing: Housing, ends: Mapping[str, LinkEnd]) -> Iterator[VolumeLink]:
    for link in housing.links.values():
        kinds = [ends[place].kind for place in link.between if place in ends]
        others = [place for place in link.between if place not in housing.volumes and place not in ends]
        yield VolumeLink(
            a=link.between[0],
            b=link.between[1],
            conductance=link_conductance(rig, link),
            kind=(*kinds, *others, LINK)[0],
        )
