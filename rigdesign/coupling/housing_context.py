"""One housing at one iteration: its fluids with their temperatures, and the shaft that a surface belongs to."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from dynamics.rotor.bearing import BearingState
from rigdesign.case.films import BathPlace, ShaftPlace, SurfaceCondition, SurfacePlace
from rigdesign.case.gearbox import Gearbox
from rigdesign.case.geometry import stream_surfaces
from rigdesign.case.housing import Housing, HousingLink, HousingStream
from rigdesign.coupling.flank_heat import AXES, rim_surfaces
from rigdesign.coupling.state import CouplingState, OperatingPoint
from rigdesign.properties.fluid import ATMOSPHERE, volumetric_heat
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import (
    bearing_feed,
    conducting_share,
    film_oil,
    gear_feed,
    wetted_width,
)
from thermal.conditions.boundary import Film
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm, VolumeLink
from thermal.conduction.steady import TemperatureSolution
from thermal.films.law import FilmLaw
from thermal.housing.geometry import HousingGeometry
from thermal.housing.shaft_geometry import ShaftGeometry

# Volumes, streams and links of a housing as unknowns of its temperature field, and what they carry.
#
# Volumes are stirred and have one temperature. A stream is a chain of plug flows, one for each surface it passes, and
# leaves with the temperature of the last. A link leads to another volume, to room air, or to an oil as it leaves the
# chamber; an oil that is an unknown itself is the volume of its own network.

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
    housing = rig.case.housings[name]
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
    housing = rig.case.housings[name]
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


GEAR_OIL, BEARING_OIL, BEARING_FILM, AIR = "gear_oil", "bearing_oil", "bearing_film", "air"
"""Kinds of films: what takes the heat up, as the heat balance names it."""


@dataclass(frozen=True, kw_only=True)
class OilFilm(Film):
    """A film to an oil.

    follows : kelvin by which the oil at the surface is warmer where it leaves one kelvin warmer: 0 as it is fed, 1 as
        it leaves
    """

    follows: float


@dataclass(frozen=True)
class HousingContext:
    """One housing at one iteration."""

    rig: Rig
    name: str
    point: OperatingPoint
    coupling_state: CouplingState
    bearings: Mapping[str, BearingState]

    @property
    def box(self) -> Gearbox:
        """The gearbox of the case."""
        return self.rig.case.gearboxes[self.name]

    @property
    def housing(self) -> Housing:
        """Its housing, which it has."""
        return self.rig.case.housings[self.name]

    def source(self, condition: SurfaceCondition) -> str:
        """Where the case has the coefficient of a given film from."""
        entry = next(name for name, own in self.housing.boundary.items() if own is condition)
        path = f"gearboxes.{self.name}.housing.boundary.{entry}.heat_transfer_coefficient"
        return self.rig.case.provenance(path)

    @property
    def geometry(self) -> HousingGeometry:
        """Geometry of the housing, cold."""
        return self.rig.geometries[self.name]

    def fluid(self, name: str) -> tuple[str, float]:
        """Kind and temperature [K] of room air or an oil."""
        if name == "ambient":
            return AIR, self.rig.case.ambient.temperature
        kind, _, which = name.rpartition("_")
        chamber = self.coupling_state.oil_outlet[f"{self.name}.{GEAR_OIL}"]
        feed = (gear_feed if kind == GEAR_OIL else bearing_feed)(
            self.rig, self.name, chamber, self.coupling_state.oil_supply
        )
        outlet = self.coupling_state.oil_outlet[f"{self.name}.{kind}"]
        return kind, {"inlet": feed.inlet, "outlet": outlet, "mean": feed.mean(outlet)}[which]

    def follows(self, name: str) -> float:
        """`OilFilm.follows` of an oil as the case names it; one that is not fed has the temperature of its sump."""
        kind, _, which = name.rpartition("_")
        return {"inlet": 0.0, "outlet": 1.0, "mean": 0.5}[which] if kind in self.box.feeds else 1.0

    def finds_own_temperature(self, fluid: str | None) -> bool:
        """Whether a fluid is a volume or stream of the housing."""
        return fluid in self.housing.volumes or fluid in self.housing.streams

    def link_ends(self, *, sump_given: bool) -> dict[str, LinkEnd]:
        """Room air and the oils as they leave the chamber; a sump that finds its own temperature is left out."""
        ends = {"ambient": LinkEnd(temperature=self.rig.case.ambient.temperature, kind=AIR)}
        for kind in (GEAR_OIL, BEARING_OIL):
            if kind == BEARING_OIL or self.box.gear_oil_temperature is not None or sump_given:
                outlet = self.coupling_state.oil_outlet[f"{self.name}.{kind}"]
                ends[kind] = LinkEnd(temperature=outlet, kind=kind)
        return ends

    def wetting(self, fluid: str, surface: str) -> float:
        """Share of a given oil film that is left: bubbles conduct less than oil, blocked jets leave flanks dry."""
        if self.finds_own_temperature(fluid):
            return 1.0
        kind, _ = self.fluid(fluid)
        if kind == AIR:
            return 1.0
        share = conducting_share(self.rig, self.name, kind)
        on_flanks = kind == GEAR_OIL and surface in rim_surfaces(self.box).values()
        return share * wetted_width(self.box) if on_flanks else share

    def place(self, condition: SurfaceCondition, surface: str) -> SurfacePlace:
        """Numbers of a surface for the law of its condition."""
        shaft = bath = None
        if self._shafts_of(surface):
            gap = self.shaft(surface).seal_gap
            shaft = ShaftPlace(speed=self.speed(surface), diameter=self.diameter(surface), seal_gap=gap)
            bath = self._bath(0.5 * shaft.diameter)
        fluid = condition.wetted_by
        return SurfacePlace(
            height=self.housing.height,
            wall_conductivity=self.rig.materials[self.housing.material].conductivity,
            shaft=shaft,
            bath=bath,
            mist_density=self.rig.case.losses.chamber_density,
            wetted_share=1.0 if fluid is None else self.wetting(fluid, surface),
            source=self.source(condition),
        )

    def _bath(self, radius: float) -> BathPlace | None:
        """The sump as a circle round the axis of a shaft dips into it; none in a box without."""
        sump = self.box.sump
        if sump is None:
            return None
        half = math.acos(max(-1.0, min(1.0, (AXES - sump.level) / radius)))
        face = (half - 0.5 * math.sin(2.0 * half)) / math.pi
        return BathPlace(oil=film_oil(self.rig, self.name), face_share=face, rim_share=half / math.pi)

    def shaft(self, surface: str) -> ShaftGeometry:
        """The shaft a surface belongs to, from its name."""
        return max(self._shafts_of(surface), key=lambda shaft: len(shaft.name))

    def _shafts_of(self, surface: str) -> list[ShaftGeometry]:
        return [shaft for shaft in self.geometry.shafts if f"_{shaft.name}_" in f"{surface}_"]

    def speed(self, surface: str) -> float:
        """Speed of the shaft of a surface [rad/s]."""
        return self.rig.shaft_speed(self.shaft(surface).name, self.point.speed)

    def diameter(self, surface: str) -> float:
        """Diameter of a shaft or gear surface [m]."""
        shaft = self.shaft(surface)
        if surface.startswith("gear_") and shaft.gear is not None:
            return shaft.gear.outer_diameter
        if "_cold_" in surface or ("_seal_" in surface and not surface.endswith("_end")):
            return shaft.seal_diameter
        if surface.endswith("_warm"):
            return shaft.seat_diameter
        if "_journal_" in surface:
            return shaft.bearing("front" if surface.endswith("_front") else "rear").journal_diameter
        return shaft.overhang_diameter
