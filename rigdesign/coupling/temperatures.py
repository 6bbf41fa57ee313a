"""Steady temperature fields of the housings at one operating point, and the heat they give to the oil."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dynamics.rotor.bearing import BearingState
from rigdesign.base.part_name import BearingName
from rigdesign.case.films import SurfaceCondition, SurfaceFilm, SurfacePlace
from rigdesign.case.geometry import bearing_on, conditions_of
from rigdesign.case.surface_conditions import ConstantFilm, TakenFrom
from rigdesign.coupling.bearing_seats import bearing_seats, seat_conditions, seat_sources
from rigdesign.coupling.flank_heat import flank_films, gear_flanks, rim_surfaces
from rigdesign.coupling.housing_context import (
    AIR,
    BEARING_FILM,
    BEARING_OIL,
    GEAR_OIL,
    HousingContext,
    OilFilm,
    WettedSurface,
    fluid_networks,
)
from rigdesign.coupling.located_loss import STORED, PlacedLoss, PointLosses, heat_into_gear_oil
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.joints import behind_shell, foot_joint
from rigdesign.rig.model import Rig
from rigdesign.rig.oil_supply import (
    ChamberOil,
    bearing_feed,
    bearing_oil,
    gear_feed,
    gear_oil,
)
from thermal.conditions.boundary import (
    BodySource,
    BoundaryCondition,
    Film,
    SurfaceSource,
)
from thermal.conditions.enclosure import Enclosure
from thermal.conditions.streams import StreamNetwork, Volume, VolumeFilm
from thermal.conduction.setup import Condition
from thermal.conduction.steady import TemperatureSolution, solve_steady
from thermal.films import convection
from thermal.housing.shaft_geometry import SIDES

TOLERANCE = 1e-9
"""Heat left over at the nodes, relative to the heat turned over, at which a field is solved."""


@dataclass(frozen=True)
class HousingField:
    """Temperatures of one housing with the conditions they answer to."""

    gearbox: str
    conditions: tuple[Condition, ...]
    solution: TemperatureSolution

    @property
    def temperature(self) -> NDArray[np.float64]:
        """(n_nodes,) [K]"""
        return self.solution.temperature


def solve_housing(
    rig: Rig,
    name: str,
    losses: PointLosses,
    start: HousingField | None = None,
    *,
    radiation_included: bool | None = None,
    tolerance: float = TOLERANCE,
) -> HousingField:
    """Temperature field of the housing of gearbox ``name``.

    start : field of an earlier iteration, a good first guess
    radiation_included : reading of the film to room air; that of the case when left out
    tolerance : of the heat left over, relative to the heat turned over

    Raises
    ------
    ConditionError
        Conditions that cannot be computed.
    NotConverged
        Newton's method stalls.
    """
    housing = rig.case.housings[name]
    included = housing.radiation_included if radiation_included is None else radiation_included
    conditions = boundary_conditions(rig, name, losses, radiation_included=included)
    setup = rig.conduction[name]
    solution = solve_steady(
        setup, conditions, near=None if start is None else start.solution, tolerance=tolerance
    )
    return HousingField(gearbox=name, conditions=tuple(conditions), solution=solution)


def heat_into_oil(field: HousingField) -> dict[str, float]:
    """Heat solids and linked volumes give to each oil stream of the gearbox [W], bearing films left out."""
    return {
        f"{field.gearbox}.{kind}": -math.fsum(
            row.power
            for row in field.solution.balance.rows
            if row.kind == kind and row.surface != GEAR_OIL  # the sump itself, where it is an unknown
        )
        for kind in (GEAR_OIL, BEARING_OIL)
    }


def sump_temperatures(rig: Rig, fields: Mapping[str, HousingField]) -> dict[str, float]:
    """Gearbox -> temperature of its sump [K]: the held one, or that of the temperature field it belongs to."""
    return {
        name: box.gear_oil_temperature or fields[name].solution.volumes[GEAR_OIL]
        for name, box in rig.case.gearboxes.items()
        if box.jets is None
    }


def heat_into_films(field: HousingField) -> dict[str, float]:
    """Heat that journal and bore give to each bearing film [W], by ``gearbox.bearing``."""
    heat: dict[str, float] = {}
    for row in field.solution.balance.rows:
        kind, _, part = row.kind.partition(":")
        if kind == BEARING_FILM and row.area > 0.0:  # of an unfed bearing the sump has a row as well
            name = f"{field.gearbox}.{part}"
            heat[name] = heat.get(name, 0.0) - row.power
    return heat


def heat_to_room(field: HousingField) -> float:
    """Heat to room air, to walls of the room and through openings of chambers that radiate [W]."""
    kinds = AIR, "radiation", CHAMBER_RADIATION
    return -math.fsum(row.power for row in field.solution.balance.rows if row.kind in kinds)


def heat_stored(field: HousingField) -> float:
    """Heat that bodies which are not steady yet take up [W]."""
    return -math.fsum(row.power for row in field.solution.balance.rows if row.kind == STORED)


def body_mean(rig: Rig, field: HousingField, body: str) -> float:
    """Volume mean temperature of a body [K]."""
    return rig.conduction[field.gearbox].elements.body_mean(field.temperature, body)


def seat_temperatures(rig: Rig, fields: Mapping[str, HousingField]) -> dict[str, float]:
    """Mean temperature of every seat that takes heat of a bearing [K], by ``gearbox.bearing.seat``."""
    return {
        key: value
        for name, field in fields.items()
        for key, value in seat_means(rig, name, field.temperature).items()
    }


def seat_means(rig: Rig, name: str, temperature: NDArray[np.float64]) -> dict[str, float]:
    """Of one housing; temperature : (n_nodes,) [K]."""
    surfaces = rig.conduction[name].elements.surfaces
    return {
        f"{name}.{part}.{seat}": surfaces[found.surface].mean(temperature)
        for part in rig.case.gearboxes[name].bearings
        for seat, found in bearing_seats(rig, BearingName(name, part)).items()
    }


# Boundary conditions of a housing: the case's laws with this iteration's fluids, films, speeds and losses.


def boundary_conditions(
    rig: Rig,
    name: str,
    losses: PointLosses,
    *,
    radiation_included: bool,
    sump_given: bool = False,
) -> list[Condition]:
    """Every condition of the housing of gearbox ``name``: films, fluids, radiation, exchanges, joints and sources.

    radiation_included : leave out explicit radiation where the film to room air contains it already
    sump_given : a sump has the temperature of the coupling state also where it finds its own
    """
    context = HousingContext(rig, name, losses.point, losses.coupling_state, losses.bearings)
    housing = context.housing
    rows = conditions_of(housing, rig.surface_names(name))
    covered = {surface for entry, surface, _ in rows if _radiation_in_film(context, entry, surface)}
    conditions: list[Condition] = [*foot_joint(rig, name), *enclosure_conditions(rig, name)]
    wetted: list[WettedSurface] = []
    host = _Host(context)
    for entry, surface, stood_for in rows:
        condition = housing.boundary[entry]
        if isinstance(condition, SurfaceFilm) and context.finds_own_temperature(condition.wetted_by):
            wetted.append(_wetted(context, condition, surface))
            continue
        found = condition.on(
            surface, stood_for, host, radiation_in_film=radiation_included and surface in covered
        )
        if found is None:
            continue
        if isinstance(found, Film):
            found = replace(found, law=behind_shell(rig, name, surface, found.law))
        conditions.append(found)
    conditions += _joined_bearings(context)
    if context.box.gear_oil_temperature is None and not sump_given:
        conditions = _with_free_sump(context, conditions, losses.losses)
    conditions += fluid_networks(rig, name, wetted, context.link_ends(sump_given=sump_given))
    stored = [losses.stored[name]] if name in losses.stored else []
    return [*conditions, *_sources(context, losses.losses), *stored]


def _with_free_sump(
    context: HousingContext, conditions: Sequence[Condition], losses: Sequence[PlacedLoss]
) -> list[Condition]:
    """The conditions with the sump as an unknown: films to its oil feel a volume that the losses in it heat."""
    chamber = context.coupling_state.oil_outlet[f"{context.name}.{GEAR_OIL}"]
    fed = context.box.fed_bearings is not None
    own = (GEAR_OIL,) if fed else (GEAR_OIL, BEARING_OIL, BEARING_FILM)
    films: list[OilFilm] = []
    rest: list[Condition] = []
    for condition in conditions:
        if isinstance(condition, OilFilm) and condition.kind.startswith(own) and condition.follows == 1.0:
            films.append(condition)
        else:
            rest.append(condition)
    heat = heat_into_gear_oil(losses, context.name, bearings_fed=fed)
    sump = StreamNetwork(
        specific_heat=gear_oil(context.rig, context.name).heat_capacity(chamber),
        volumes=(Volume(name=GEAR_OIL, power=heat),),
        films=tuple(
            VolumeFilm(surface=film.surface, volume=GEAR_OIL, kind=film.kind, law=film.law) for film in films
        ),
    )
    return [*rest, sump]


def _radiation_in_film(context: HousingContext, entry: str, surface: str) -> bool:
    """Whether the film to room air of a surface is of the size of convection and radiation together."""
    condition = context.housing.boundary[entry]
    return (
        isinstance(condition, SurfaceFilm)
        and condition.wetted_by == "ambient"
        and condition.radiation_included(context.place(condition, surface))
    )


def printed_films(rig: Rig, name: str) -> Iterator[tuple[str, TakenFrom]]:
    """(surface, what its coefficient was read from) of every film of a housing that assumes a difference."""
    housing = rig.case.housings[name]
    for entry, surface, _ in conditions_of(housing, rig.surface_names(name)):
        condition = housing.boundary[entry]
        if isinstance(condition, ConstantFilm) and condition.taken_from is not None:
            yield surface, condition.taken_from


@dataclass(frozen=True)
class _Host:
    """What the conditions of a case ask of their housing."""

    context: HousingContext

    @property
    def surroundings(self) -> float:
        ambient = self.context.rig.case.ambient
        return ambient.surroundings_temperature or ambient.temperature

    def place(self, condition: SurfaceCondition, surface: str) -> SurfacePlace:
        return self.context.place(condition, surface)

    def film(self, condition: SurfaceFilm, surface: str) -> Film:
        return _film(self.context, condition, surface)

    def bearing_film(self, factor: float, surface: str) -> Film | None:
        return _bearing_film(self.context, factor, surface)

    def flank_film(self, surface: str) -> Film:
        context, rims = self.context, rim_surfaces(self.context.box)
        gear = next(gear for gear, rim in rims.items() if rim == surface)
        condition = flank_films(context.box, rims)[gear]
        state = context.coupling_state
        chamber = ChamberOil.of(context.name, state.oil_outlet, state.oil_supply)
        flanks = gear_flanks(context.rig, context.name, gear, context.point, condition, chamber)
        film = flanks.film(surface, GEAR_OIL)
        return OilFilm(**vars(film), follows=1.0 if context.box.jets is None else 0.0)


def _film(context: HousingContext, condition: SurfaceFilm, surface: str) -> Film:
    """Film to a fluid of the case; those to room air times the factor of them all and of their wall."""
    assert condition.wetted_by is not None
    kind, usual = context.fluid(condition.wetted_by)
    law = condition.film_law(context.place(condition, surface))
    if kind == AIR:
        housing = context.housing
        of_wall = housing.surface_film_factors.get(surface, 1.0)
        law = convection.scaled(law, housing.ambient_film_factor * of_wall)
    usual += side_excess(context.rig, context.name, context.coupling_state, surface, condition.wetted_by)
    temperature = condition.fluid_temperature_given(usual)
    if kind == AIR:
        return Film(surface=surface, kind=kind, fluid_temperature=temperature, law=law)
    follows = context.follows(condition.wetted_by) if temperature == usual else 0.0
    return OilFilm(surface=surface, kind=kind, fluid_temperature=temperature, law=law, follows=follows)


def _wetted(context: HousingContext, condition: SurfaceFilm, surface: str) -> WettedSurface:
    """Film to a volume or stream of the housing."""
    assert condition.wetted_by is not None
    law = condition.film_law(context.place(condition, surface))
    return WettedSurface(
        surface=surface,
        fluid=condition.wetted_by,
        law=behind_shell(context.rig, context.name, surface, law),
    )


def _bearing_film(context: HousingContext, factor: float, surface: str) -> Film | None:
    """Conductance of the film from its mean temperature; the sink is that temperature, no source in addition.

    None of a bearing that is joined to its seats.
    """
    part, state = _bearing_of(context, surface)
    if state.star is not None:
        return None
    oil = bearing_oil(context.rig, context.name)
    return OilFilm(
        surface=surface,
        kind=f"{BEARING_FILM}:{part}",
        follows=0.5,
        fluid_temperature=state.film_temperature,
        law=convection.scaled(
            convection.bearing_film(oil.conductivity(state.film_temperature), 1.0 / state.mean_inverse_gap),
            context.housing.bearing_film_factor * factor,
        ),
    )


def _bearing_of(context: HousingContext, surface: str) -> tuple[str, BearingState]:
    """Name and state of the bearing whose journal or bore a surface is."""
    shaft = context.shaft(surface).name
    side = "front" if surface.endswith("front") else "rear"
    entry = bearing_on(context.box, shaft, side)
    part = next(name for name, bearing in context.box.bearings.items() if bearing is entry)
    return part, context.bearings[f"{context.name}.{part}"]


def _joined_bearings(context: HousingContext) -> Iterator[BoundaryCondition]:
    """Conduction through the bearings that are joined to their seats, into shaft, housing and oil."""
    follows = 1.0 if context.box.fed_bearings is None else 0.0
    for part in context.box.bearings:
        full = BearingName(context.name, part)
        star = context.bearings[full].star
        if star is not None:
            yield from seat_conditions(context.rig, full, star, f"{BEARING_FILM}:{part}", follows)


def _sources(context: HousingContext, losses: Sequence[PlacedLoss]) -> list[BoundaryCondition]:
    """Losses that enter solids: meshes into the rims, windage into the gears, seals into shaft and bore."""
    sources: list[BoundaryCondition] = [*_mesh_sources(context, losses)]
    for placed in losses:
        if placed.gearbox != context.name or placed.into_body == 0.0:
            continue
        match placed.kind.heats:
            case "gear":
                body = f"gear_{context.box.gears[placed.part].shaft}"
                sources.append(BodySource(body=body, power=placed.into_body, kind=placed.loss.kind))
            case "seal":
                sources += _seal_sources(context, placed)
            case "seats":
                state, bearing = context.bearings[placed.name], BearingName(placed.gearbox, placed.part)
                sources += seat_sources(context.rig, bearing, state, placed.loss.power)
    return sources


def _mesh_sources(context: HousingContext, losses: Sequence[PlacedLoss]) -> list[BoundaryCondition]:
    """Into the rim of every gear its share of the heat of all meshes it is in."""
    into_rim: dict[str, float] = {}
    for placed in losses:
        if placed.gearbox == context.name and placed.split is not None and placed.into_body:
            mesh = context.box.meshes[placed.part]
            for gear, share in zip((mesh.pinion, mesh.wheel), placed.split.into_rims):
                into_rim[gear] = into_rim.get(gear, 0.0) + share * placed.loss.power
    rims = rim_surfaces(context.box)
    return [
        SurfaceSource(surface=rims[gear], power=power, kind="mesh_loss") for gear, power in into_rim.items()
    ]


def _seal_sources(context: HousingContext, placed: PlacedLoss) -> list[BoundaryCondition]:
    """Shaft and bore of every seal: evenly on the two in the partitions, evenly on those where the shaft leaves."""
    name = context.box.seals[placed.part].shaft
    shaft = next(shaft for shaft in context.geometry.shafts if shaft.name == name)
    ends = [f"{side}_end" for side in SIDES if shaft.overhang(side) > 0.0]
    split = context.box.heat_split
    total = split.seal_into_shaft + split.seal_into_housing
    bodies = ((f"shaft_{name}_seal", split.seal_into_shaft), (f"seal_bore_{name}", split.seal_into_housing))
    return [
        SurfaceSource(
            surface=f"{stem}_{place}",
            power=part / len(places) * placed.into_body * share / total,
            kind="seal_loss",
        )
        for places, part in ((list(SIDES), 1.0 - placed.end_share), (ends, placed.end_share))
        for place in places
        for stem, share in bodies
        if part > 0.0
    ]


# Gear oil that leaks into the cold chamber of one side more than into the other: what the oil there is warmer by.
#
# The oil of the bearings leaves as one stream; its mean temperature is that of `rigdesign.coupling.oil`. On each side
# the oil of its own bearings, all warmed alike, mixes with the part of the leak that arrives there.

EVEN = 0.5
"""Share of a leak that reaches the front where it divides evenly."""


def side_excess(rig: Rig, name: str, state: CouplingState, surface: str, fluid: str) -> float:
    """How much warmer the oil at a surface is than the mixed oil of the bearings [K]; zero for other fluids.

    name : gearbox; fluid : as the case names it, ``bearing_oil_outlet`` or ``bearing_oil_mean``
    """
    box = rig.case.gearboxes[name]
    share, in_front = box.oil_paths.leak_warm_cold, box.oil_paths.leak_front_share
    side = next((side for side in SIDES if side in surface.split("_")), None)
    follows = {"bearing_oil_outlet": 1.0, "bearing_oil_mean": 0.5}.get(fluid, 0.0)
    if not (share and follows) or side is None or in_front == EVEN or box.fed_bearings is None:
        return 0.0
    warm, mixed = (state.oil_outlet[f"{name}.{kind}"] for kind in ("gear_oil", "bearing_oil"))
    leak = share * gear_feed(rig, name, warm, state.oil_supply).capacity_rate
    each = bearing_feed(rig, name, warm, state.oil_supply).capacity_rate
    cold = mixed + leak / (each * len(box.bearings)) * (mixed - warm)
    part = leak * (in_front if side == "front" else 1.0 - in_front)
    own = each * sum(bearing.side == side for bearing in box.bearings.values())
    return follows * ((own * cold + part * warm) / (own + part) - mixed) if own + part else 0.0


# Chambers of a housing whose surfaces radiate at each other, as conditions of its temperature field.

CHAMBER_RADIATION = "chamber_radiation"
"""Kind of their rows in the heat balance."""


def enclosure_conditions(rig: Rig, name: str) -> Iterator[Enclosure]:
    """Enclosures of the housing of gearbox ``name``; CaseError for view factors that do not close."""
    housing = rig.case.housings[name]
    for entry, enclosure in housing.enclosures.items():
        emissivities = enclosure.emissivities(rig.surface_names(name))
        surfaces = tuple(emissivities)
        opening = enclosure.opening_temperature
        at = f"gearboxes.{name}.housing.enclosures.{entry}.view_factors"
        views = rig.chamber_views
        rows = enclosure.rows(views.areas(name, surfaces))
        if rows is None:
            rows = views.between(name, surfaces, opening=opening is not None, at=at)
        else:
            views.require_closed(name, surfaces, rows, opening=opening is not None, at=at)
        yield Enclosure(
            name=entry,
            surfaces=surfaces,
            emissivities=tuple(emissivities.values()),
            view_factors=rows,
            opening_temperature=opening,
            kind=CHAMBER_RADIATION,
        )
