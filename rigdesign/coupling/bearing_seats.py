"""Seats of bearings that conduct their heat into shaft and housing: where they are, how warm they are.

A rolling bearing is one node between the surface of its shaft, its bore in the housing and its oil (`HeatStar`). The
surfaces that the case covers with ``bearing_film`` take its heat; where another condition covers one, or the gearbox
has no housing, that seat takes none and the oil carries all.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from dynamics.rotor.bearing import BearingState, HeatStar
from rigdesign.base.part_name import BearingName
from rigdesign.case.films import matched
from rigdesign.case.surface_conditions import BearingFilm
from rigdesign.coupling.housing_context import OilFilm
from rigdesign.coupling.state import CouplingState
from rigdesign.rig.model import Rig
from thermal.conditions.boundary import BoundaryCondition, Exchange, SurfaceSource
from thermal.films import convection
from thermal.films.law import FilmLaw

SHAFT, HOUSING = "shaft", "housing"


@dataclass(frozen=True, kw_only=True)
class Seat:
    """A surface that takes heat of a bearing, and the factor on the conductance to it."""

    surface: str
    factor: float


def bearing_seats(rig: Rig, name: BearingName) -> dict[str, Seat]:
    """Seats by `SHAFT` and `HOUSING` of a bearing; only those that take its heat."""
    box = rig.case.gearboxes[name.gearbox]
    entry, housing = box.bearings[name.part], box.housing
    if housing is None or entry.has_film:
        return {}
    places = {
        SHAFT: f"shaft_{entry.shaft}_journal_{entry.side}",
        HOUSING: f"bearing_bore_{entry.shaft}_{entry.side}",
    }
    known = rig.surface_names(name.gearbox)
    return {
        seat: Seat(surface=surface, factor=housing.bearing_film_factor * condition.film_factor)
        for condition in housing.boundary.values()
        if isinstance(condition, BearingFilm)
        for seat, surface in places.items()
        if surface in known and matched(condition.surfaces, (surface,))
    }


def initial_seats(rig: Rig, temperature: float) -> dict[str, float]:
    """All seats at one temperature [K], by ``gearbox.bearing.seat``."""
    return {
        f"{name}.{seat}": temperature for name, _, _ in rig.bearings() for seat in bearing_seats(rig, name)
    }


def seats_of(name: str, state: CouplingState) -> tuple[float | None, float | None]:
    """Temperatures of the seats of a bearing on shaft and in housing [K]; None for one that takes no heat."""
    known = state.seat_temperature
    return known.get(f"{name}.{SHAFT}"), known.get(f"{name}.{HOUSING}")


@dataclass(frozen=True, kw_only=True)
class WarmBearing:
    """Temperatures of a bearing and of its seats on the shaft and in the housing [K]."""

    shaft: float
    bearing: float
    housing: float


def bearing_temperatures(
    bearings: Mapping[str, BearingState], seats: Mapping[str, float]
) -> dict[str, WarmBearing]:
    """Every bearing that conducts heat to its seats, by ``gearbox.bearing``.

    seats : temperatures [K] by ``gearbox.bearing.seat``
    """
    return bearings_between(
        {name: state.star for name, state in bearings.items() if state.star is not None}, seats
    )


def bearings_between(stars: Mapping[str, HeatStar], seats: Mapping[str, float]) -> dict[str, WarmBearing]:
    """Bearings by ``gearbox.bearing`` between their seats; a seat that takes no heat is as warm as its bearing."""
    return {
        name: warm_bearing(star, (seats.get(f"{name}.{SHAFT}"), seats.get(f"{name}.{HOUSING}")))
        for name, star in stars.items()
    }


def warm_bearing(star: HeatStar, seats: tuple[float | None, float | None]) -> WarmBearing:
    """A bearing between seats of these temperatures [K]; None for one that takes no heat."""
    shaft, housing = (star.oil_temperature if seat is None else seat for seat in seats)
    node = star.node(shaft, housing)
    return WarmBearing(
        shaft=node if seats[0] is None else shaft,
        bearing=node,
        housing=node if seats[1] is None else housing,
    )


# Heat of a bearing that is joined to its seats: one node between shaft, housing and oil, eliminated.
#
# The node of `HeatStar` with the conductances G_s, G_h and C = rho c Q to shaft seat, housing seat and oil stores no
# heat, so it can be taken out (star to triangle, S = G_s + G_h + C): shaft and housing exchange G_s G_h / S, each gives
# G C / S to the oil as it comes, and the friction P enters shaft, housing and oil in the proportion of G_s, G_h and C.
# Every flow is then one of the temperature field, none goes round the coupling loop.

BEARING_SEATS, BEARING_LOSS = "bearing_seats", "bearing_loss"
"""Kinds of the rows of the heat balance: between the seats through the bearing, friction into the seats."""
SOURCE = "rings, rolling elements and oil of the bearing as one node between its seats"


def conductances(rig: Rig, name: BearingName, star: HeatStar) -> list[tuple[Seat, float]]:
    """Every seat that takes heat of a bearing, with the conductance to it [W/K]."""
    own = {SHAFT: star.shaft, HOUSING: star.housing}
    return [(seat, own[key]) for key, seat in bearing_seats(rig, name).items()]


def body_shares(rig: Rig, name: BearingName, state: BearingState) -> list[tuple[Seat, float]]:
    """Share of the friction of a bearing that enters the bodies at every seat; none for a film, whose oil has it."""
    if state.star is None:
        return []
    total = state.star.total
    return [(seat, conductance / total) for seat, conductance in conductances(rig, name, state.star)]


def seat_conditions(
    rig: Rig, name: BearingName, star: HeatStar, film_kind: str, follows: float
) -> Iterator[BoundaryCondition]:
    """Exchange of the seats through the bearing, and films of both to its oil as it comes.

    film_kind : of the rows of the films; follows : `OilFilm.follows` of them
    """
    seats = conductances(rig, name, star)
    for seat, conductance in seats:
        yield OilFilm(
            surface=seat.surface,
            kind=film_kind,
            follows=follows,
            fluid_temperature=star.oil_temperature,
            law=on_surface(rig, name, seat, conductance * star.oil / star.total),
        )
    if len(seats) == 2:
        (first, shaft), (second, housing) = seats
        yield Exchange(
            surface_a=first.surface,
            surface_b=second.surface,
            kind=BEARING_SEATS,
            law=on_surface(rig, name, first, shaft * housing / star.total),
        )


def seat_sources(
    rig: Rig, name: BearingName, state: BearingState, power: float
) -> Iterator[BoundaryCondition]:
    """Friction of a bearing into its seats; power : of the friction [W]."""
    for seat, share in body_shares(rig, name, state):
        yield SurfaceSource(surface=seat.surface, power=share * power, kind=BEARING_LOSS)


def on_surface(rig: Rig, name: BearingName, seat: Seat, conductance: float) -> FilmLaw:
    """Law of a conductance [W/K] that is spread over the surface of a seat."""
    area = rig.conduction[name.gearbox].elements.surfaces[seat.surface].area
    return convection.constant(conductance / area, SOURCE, "conductance / area")
