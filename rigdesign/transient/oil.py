"""Conditions of a housing with its oil as unknowns, fed or cut off.

The steady conditions know the outlet temperatures of the coupled run. Over time the oil leaves with what it has
taken up: each oil is a stream with one outlet temperature, each bearing film a stream of its own that ends in the
oil of the bearings. A film feels as much of inlet and outlet as that of the steady conditions (`OilFilm.follows`). At a
held stage the two descriptions have the same steady state.

Without oil the streams stop. Chambers then are volumes of air: while the rig turns, what is left of the oil still
wets the walls; at standstill their films are those of still air. No oil carries friction heat away any more: that
of the teeth stays in the gears, that of the bearings in the oil of their films.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from dynamics.rotor.bearing import HeatStar
from rigdesign.base.part_name import BearingName
from rigdesign.case.gearbox import injected_flow
from rigdesign.case.lubrication import DipOil
from rigdesign.coupling.bearing_seats import (
    BEARING_LOSS,
    BEARING_SEATS,
    bearing_seats,
    conductances,
    on_surface,
)
from rigdesign.coupling.housing_context import BEARING_FILM, BEARING_OIL, GEAR_OIL, OilFilm, without_oils
from rigdesign.coupling.located_loss import PlacedLoss, PointLosses, heat_into_gear_oil
from rigdesign.coupling.temperatures import boundary_conditions
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import bearing_feed, gear_feed, gear_oil, wall_flow
from thermal.conditions.boundary import Film
from thermal.conditions.streams import Stream, StreamNetwork, Supply, Volume, VolumeFilm, VolumeLink
from thermal.conduction.capacity import StoredHeat
from thermal.conduction.setup import Condition
from thermal.films.law import FilmCoefficient, FilmLaw

THERMOSTAT = 1e6
"""Conductance that ties a held sump to its temperature [W/K]: 10 kW move it by 10 mK."""
HEATER_AND_COOLER = "heater and cooler"
"""Kind of that tie."""
FEED = "feed"
LEAK = "gear oil leaked"


def oil_conditions(rig: Rig, name: str, state: PointLosses, *, oil: bool) -> tuple[Condition, ...]:
    """Conditions of the housing of gearbox ``name`` at one speed and torque.

    oil : whether the rig is fed
    """
    losses = state.losses if oil else tuple(_dry(p) for p in state.losses if not p.kind.ends_with_oil)
    floor = rig.case.transient.still_film
    turning = state.point.speed > 0.0
    bodies: list[Condition] = []
    wetted: list[OilFilm] = []
    for condition in _steady(rig, name, state, losses):
        if not isinstance(condition, Film):
            bodies.append(_led_to_oils(condition))
            continue
        film = _floored(condition, floor)
        if not isinstance(film, OilFilm):
            bodies.append(film)
            continue
        if not (oil or turning or film.kind.startswith(BEARING_FILM)) and film is condition:
            film = replace(film, law=still(floor))
        wetted.append(film)
    nodes = bearing_nodes(rig, name, state, losses)
    seated = {f"{BEARING_FILM}:{part}" for part in nodes}
    films = [film for film in wetted if film.kind not in seated]
    rest = [c for c in bodies if getattr(c, "kind", "") not in (BEARING_SEATS, BEARING_LOSS)]
    gears = _gear_network(rig, name, state, losses, films, oil)
    if rig.case.gearboxes[name].fed_bearings is None:
        return *rest, with_nodes(gears, nodes, GEAR_OIL if oil else None)
    return *rest, gears, _bearing_network(rig, name, state, losses, films, oil)


def _led_to_oils(condition: Condition) -> Condition:
    """Links of the volumes of a housing end in its oils, which are unknowns here."""
    if isinstance(condition, StreamNetwork):
        return without_oils(condition, (GEAR_OIL, BEARING_OIL))
    return condition


def _gear_heat(rig: Rig, name: str, losses: Sequence[PlacedLoss]) -> float:
    """Losses into the gear oil [W]: with those of bearings that are not fed, but for the friction of nodes."""
    if rig.case.gearboxes[name].fed_bearings is not None:
        return heat_into_gear_oil(losses, name, bearings_fed=True)
    seated = seated_bearings(rig, name)
    return math.fsum(
        placed.into_oil
        for placed in losses
        if placed.gearbox == name and not (placed.kind.at_bearings and placed.part in seated)
    )


def _gear_kinds(rig: Rig, name: str) -> tuple[str, ...]:
    """Kinds of the films to the gear oil; bearings that are not fed leave theirs in it."""
    return (GEAR_OIL,) if rig.case.gearboxes[name].fed_bearings is not None else (GEAR_OIL, BEARING_OIL)


def supplied(state: PointLosses, supplies: Mapping[str, float]) -> PointLosses:
    """The same state with oil streams fed at other temperatures [K]: outlets and films move with them, losses stay."""
    if not supplies:
        return state
    old = state.coupling_state
    moved = {stream: value - old.oil_supply[stream] for stream, value in supplies.items()}
    outlets = {stream: value + moved.get(stream, 0.0) for stream, value in old.oil_outlet.items()}
    films = {
        bearing: replace(
            film,
            film_temperature=film.film_temperature + moved.get(f"{bearing.split('.')[0]}.{BEARING_OIL}", 0.0),
        )
        for bearing, film in state.bearings.items()
    }
    supply = {**old.oil_supply, **supplies}
    shifted = replace(old, oil_outlet=outlets, oil_supply=supply)
    return replace(state, coupling_state=shifted, bearings=films)


def _steady(rig: Rig, name: str, state: PointLosses, losses: Sequence[PlacedLoss]) -> list[Condition]:
    housing = rig.case.housings[name]
    heated = replace(state, losses=tuple(losses))
    conditions = boundary_conditions(
        rig, name, heated, radiation_included=housing.radiation_included, sump_given=True
    )
    return [condition for condition in conditions if not isinstance(condition, StoredHeat)]


def _dry(placed: PlacedLoss) -> PlacedLoss:
    """A loss no oil carries away: friction of the teeth stays in the gears."""
    if placed.split is None:
        return placed
    return replace(placed, into_body=placed.loss.power, split=replace(placed.split, kept=(1.0, 1.0)))


def _floored(film: Film, floor: float) -> Film:
    """Films of shafts and gears vanish with the speed, free convection stays."""
    turns = film.surface.startswith(("shaft_", "gear_")) and not film.kind.startswith(BEARING_FILM)
    return replace(film, law=at_least(film.law, floor)) if turns else film


def _gear_network(
    rig: Rig,
    name: str,
    state: PointLosses,
    losses: Sequence[PlacedLoss],
    wetted: Sequence[OilFilm],
    oil: bool,
) -> StreamNetwork:
    box = rig.case.gearboxes[name]
    outlet = state.coupling_state.oil_outlet[f"{name}.{GEAR_OIL}"]
    if box.sump is not None:
        return _sump_network(rig, name, box.sump, state, losses, wetted)
    fed = replace(gear_feed(rig, name, outlet, state.coupling_state.oil_supply), flow=wall_flow(box))
    feed = f"{GEAR_OIL} {FEED}"
    films, supplies = _films(GEAR_OIL, feed, fed.inlet, wetted, oil, _gear_kinds(rig, name))
    power = _gear_heat(rig, name, losses)
    # oil that goes from the meshes straight to the outlet takes its part of their heat along
    flow = fed.mass_flow
    if oil and box.oil_paths.short_circuit:
        power *= wall_flow(box) / (injected_flow(box) * len(box.meshes))
    return StreamNetwork(
        specific_heat=fed.oil.heat_capacity(fed.mean(outlet)),
        volumes=(Volume(name=GEAR_OIL, power=power),),
        films=films,
        supplies=(Supply(name=feed, temperature=fed.inlet), *supplies),
        streams=(
            Stream(source=feed, target=GEAR_OIL, mass_flow=flow),
            Stream(source=GEAR_OIL, target=None, mass_flow=flow),
        )
        if oil
        else (),
    )


def _sump_network(
    rig: Rig,
    name: str,
    sump: DipOil,
    state: PointLosses,
    losses: Sequence[PlacedLoss],
    wetted: Sequence[OilFilm],
) -> StreamNetwork:
    """The sump as one volume that stores heat; held, it is tied to the temperature of its heater and cooler."""
    chamber = state.coupling_state.oil_outlet[f"{name}.{GEAR_OIL}"]
    feed = f"{GEAR_OIL} {FEED}"
    lubricant = gear_oil(rig, name)
    heat = _gear_heat(rig, name, losses)
    specific_heat = lubricant.heat_capacity(chamber)
    films, _ = _films(GEAR_OIL, feed, chamber, wetted, False, _gear_kinds(rig, name))
    return StreamNetwork(
        specific_heat=specific_heat,
        volumes=(
            Volume(
                name=GEAR_OIL,
                power=heat,
                heat_capacity=lubricant.density(chamber) * sump.volume * specific_heat,
            ),
        ),
        films=films,
        supplies=()
        if sump.sump_temperature is None
        else (Supply(name=feed, temperature=sump.sump_temperature),),
        links=()
        if sump.sump_temperature is None
        else (VolumeLink(a=GEAR_OIL, b=feed, conductance=THERMOSTAT, kind=HEATER_AND_COOLER),),
    )


def _bearing_network(
    rig: Rig,
    name: str,
    state: PointLosses,
    losses: Sequence[PlacedLoss],
    wetted: Sequence[OilFilm],
    oil: bool,
) -> StreamNetwork:
    box = rig.case.gearboxes[name]
    chamber = state.coupling_state.oil_outlet[f"{name}.{GEAR_OIL}"]
    supplies = state.coupling_state.oil_supply
    fed, feed = bearing_feed(rig, name, chamber, supplies), f"{BEARING_OIL} {FEED}"
    in_gearbox = [placed for placed in losses if placed.gearbox == name]
    friction = dict.fromkeys(box.bearings, 0.0)
    for placed in in_gearbox:
        if placed.kind.at_bearings:
            friction[placed.part] += placed.loss.power
    others = math.fsum(placed.into_bearing_oil for placed in in_gearbox if not placed.kind.at_bearings)
    parts = [
        _films(BEARING_OIL, feed, fed.inlet, wetted, oil),
        *(_films(f"{BEARING_FILM}:{part}", feed, fed.inlet, wetted, oil) for part in box.bearings),
    ]
    nodes = bearing_nodes(rig, name, state, losses)
    outlet = state.coupling_state.oil_outlet[f"{name}.{BEARING_OIL}"]
    specific_heat = fed.oil.heat_capacity(fed.mean(outlet))
    each = fed.mass_flow
    # a film is balanced with the heat capacity of the oil as fed, the stream with that of its mean temperature
    as_fed = fed.oil.density(fed.inlet) * fed.oil.heat_capacity(fed.inlet) / specific_heat
    flows = {part: min(each, as_fed * state.bearings[f"{name}.{part}"].cooling_flow) for part in box.bearings}
    leak = _leak(rig, name, state, specific_heat) if oil else None
    return StreamNetwork(
        specific_heat=specific_heat,
        volumes=(
            Volume(name=BEARING_OIL, power=others),
            *(Volume(name=f"{BEARING_FILM}:{part}", power=friction[part]) for part in box.bearings),
        ),
        films=(
            *(film for films, _ in parts for film in films),
            *(film for node in nodes.values() for film in node.films),
        ),
        supplies=(
            Supply(name=feed, temperature=fed.inlet),
            *(() if leak is None else (Supply(name=LEAK, temperature=leak[0]),)),
            *(supply for _, supplies in parts for supply in supplies),
        ),
        streams=_bearing_streams(feed, flows, each, 0.0 if leak is None else leak[1]) if oil else (),
    )


def _leak(rig: Rig, name: str, state: PointLosses, specific_heat: float) -> tuple[float, float] | None:
    """Gear oil that leaks to the bearings: temperature [K] at the held stage, and flow [kg/s] of bearing oil alike."""
    box = rig.case.gearboxes[name]
    share = box.oil_paths.leak_warm_cold
    if not share or box.jets is None:
        return None
    lubricant = gear_oil(rig, name)
    warm, mixed = (state.coupling_state.oil_outlet[f"{name}.{kind}"] for kind in (GEAR_OIL, BEARING_OIL))
    flow = share * gear_feed(rig, name, warm, state.coupling_state.oil_supply).mass_flow
    return warm, flow * lubricant.heat_capacity(0.5 * (warm + mixed)) / specific_heat


def _bearing_streams(feed: str, flows: dict[str, float], each: float, leak: float) -> tuple[Stream, ...]:
    """Every bearing is fed ``each`` [kg/s]; part of it passes the film, all of it ends in the oil of the bearings.

    leak : of gear oil into it [kg/s]
    """
    streams: list[Stream] = []
    for part, flow in flows.items():
        if flow > 0.0:
            film = f"{BEARING_FILM}:{part}"
            streams.append(Stream(source=feed, target=film, mass_flow=flow))
            streams.append(Stream(source=film, target=BEARING_OIL, mass_flow=flow))
    past = math.fsum(each - flow for flow in flows.values())
    if past > 1e-9 * each:
        streams.append(Stream(source=feed, target=BEARING_OIL, mass_flow=past, kind="past the films"))
    if leak:
        streams.append(Stream(source=LEAK, target=BEARING_OIL, mass_flow=leak, kind="leak"))
    total = math.fsum(s.mass_flow for s in streams if s.target == BEARING_OIL)
    return (*streams, Stream(source=BEARING_OIL, target=None, mass_flow=total))


def _films(
    kind: str,
    feed: str,
    inlet: float,
    wetted: Sequence[OilFilm],
    oil: bool,
    kinds: tuple[str, ...] = (),
) -> tuple[tuple[VolumeFilm, ...], tuple[Supply, ...]]:
    """Films of one kind on their volume, or of several ``kinds``: each feels as much of the inlet as the steady one."""
    films, supplies = [], []
    for film in wetted:
        if film.kind not in (kinds or (kind,)):
            continue
        if not oil:
            films.append(VolumeFilm(surface=film.surface, volume=kind, kind=film.kind, law=film.law))
        elif film.follows == 0.0:
            place = f"{film.surface} fluid"
            supplies.append(Supply(name=place, temperature=film.fluid_temperature))
            films.append(_fed(film, kind, place, film.fluid_temperature, 1.0))
        else:
            films.append(_fed(film, kind, feed, inlet, 1.0 - film.follows))
    return tuple(films), tuple(supplies)


def _fed(film: Film, volume: str, supply: str, temperature: float, share: float) -> VolumeFilm:
    return VolumeFilm(
        surface=film.surface,
        volume=volume,
        kind=film.kind,
        law=_felt(film.law, temperature, share),
        supply=supply,
        supply_share=share,
    )


def _felt(law: FilmLaw, supply: float, share: float) -> FilmLaw:
    """The law asked with the temperature the film feels instead of that of its volume."""

    def mixed(wall: float, fluid: float) -> FilmCoefficient:
        return law(wall, share * supply + (1.0 - share) * fluid)

    return mixed


# Films of surfaces in air that hardly moves: a lower bound under laws that vanish at standstill.

SOURCE = "transient.still_film"


def still(value: float) -> FilmLaw:
    """The same coefficient [W/(m2 K)] whatever the temperatures."""
    coefficient = FilmCoefficient(
        value=value,
        formula="still_film",
        inputs={"value": value},
        valid_range="as given; free convection in a chamber is usually 3 to 10 W/(m2 K)",
        source=SOURCE,
    )
    return lambda wall, fluid: coefficient


def at_least(law: FilmLaw, floor: float) -> FilmLaw:
    """A law, or the coefficient of still air [W/(m2 K)] where that is more; its range then does not matter."""
    least = still(floor)

    def bounded(wall: float, fluid: float) -> FilmCoefficient:
        coefficient = law(wall, fluid)
        return coefficient if coefficient.value >= floor else least(wall, fluid)

    return bounded


# Bearings that conduct heat to their seats, over time: each a volume between shaft, housing and its oil.
#
# At a held stage the node has the temperature of the steady star; without oil it is left with its seats alone.

BEARING_TO_OIL = "bearing to oil"
"""Kind of the links between bearings that are not fed and the oil of the chamber."""


@dataclass(frozen=True, kw_only=True)
class BearingNode:
    """One bearing with the films to its seats; oil : conductance to the oil that passes it [W/K]."""

    part: str
    volume: Volume
    films: tuple[VolumeFilm, ...]
    oil: float


def seated_bearings(rig: Rig, name: str) -> list[str]:
    """Bearings of the gearbox ``name`` that conduct heat to a seat, by their own names."""
    return [part for part in rig.case.gearboxes[name].bearings if bearing_seats(rig, BearingName(name, part))]


def bearing_nodes(
    rig: Rig, name: str, state: PointLosses, losses: Sequence[PlacedLoss]
) -> dict[str, BearingNode]:
    """Nodes of the gearbox ``name`` by bearing."""
    nodes = {}
    for part in seated_bearings(rig, name):
        full = BearingName(name, part)
        star = state.bearings[full].star
        assert star is not None
        kind = f"{BEARING_FILM}:{part}"
        friction = math.fsum(p.loss.power for p in losses if p.name == full and p.kind.at_bearings)
        nodes[part] = BearingNode(
            part=part,
            volume=Volume(name=kind, power=friction),
            films=tuple(
                VolumeFilm(
                    surface=seat.surface, volume=kind, kind=kind, law=on_surface(rig, full, seat, conductance)
                )
                for seat, conductance in conductances(rig, full, star)
            ),
            oil=star.oil,
        )
    return nodes


def with_nodes(network: StreamNetwork, nodes: Mapping[str, BearingNode], oil: str | None) -> StreamNetwork:
    """A network with bearings that live on its volume ``oil``; None where no oil reaches them."""
    links = (
        VolumeLink(a=node.volume.name, b=oil, conductance=node.oil, kind=BEARING_TO_OIL)
        for node in nodes.values()
        if oil is not None
    )
    return replace(
        network,
        volumes=(*network.volumes, *(node.volume for node in nodes.values())),
        films=(*network.films, *(film for node in nodes.values() for film in node.films)),
        links=(*network.links, *links),
    )


def between(first: HeatStar, second: HeatStar, share: float, *, oil: bool) -> HeatStar:
    """A bearing ``share`` of the way between two operating points; without its oil where none runs."""
    mixed = {
        key: (1.0 - share) * getattr(first, key) + share * getattr(second, key)
        for key in ("shaft", "housing", "oil", "oil_temperature", "heat")
    }
    return HeatStar(**mixed | ({} if oil else {"oil": 0.0}))
