"""Heat of a bearing that is joined to its seats: one node between shaft, housing and oil, eliminated.

The node of `HeatStar` with the conductances G_s, G_h and C = rho c Q to shaft seat, housing seat and oil stores no
heat, so it can be taken out (star to triangle, S = G_s + G_h + C): shaft and housing exchange G_s G_h / S, each gives
G C / S to the oil as it comes, and the friction P enters shaft, housing and oil in the proportion of G_s, G_h and C.
Every flow is then one of the temperature field, none goes round the coupling loop.
"""

from collections.abc import Iterator

from dynamics.bearing.protocol import BearingState, HeatStar
from rigdesign.coupling.bearing_seats import HOUSING, SHAFT, Seat, bearing_seats
from rigdesign.coupling.housing_context import OilFilm
from rigdesign.rig.model import Rig
from thermal.conditions.boundary import BoundaryCondition, Exchange, SurfaceSource
from thermal.films import convection
from thermal.films.law import FilmLaw

BEARING_SEATS, BEARING_LOSS = "bearing_seats", "bearing_loss"
"""Kinds of the rows of the heat balance: between the seats through the bearing, friction into the seats."""
SOURCE = "rings, rolling elements and oil of the bearing as one node between its seats"


def conductances(rig: Rig, name: str, star: HeatStar) -> list[tuple[Seat, float]]:
    """Every seat that takes heat of the bearing ``gearbox.bearing``, with the conductance to it [W/K]."""
    own = {SHAFT: star.shaft, HOUSING: star.housing}
    return [(seat, own[key]) for key, seat in bearing_seats(rig, name).items()]


def body_shares(rig: Rig, name: str, state: BearingState) -> list[tuple[Seat, float]]:
    """Share of the friction of a bearing that enters the bodies at every seat; none for a film, whose oil has it."""
    if state.star is None:
        return []
    total = state.star.total
    return [(seat, conductance / total) for seat, conductance in conductances(rig, name, state.star)]


def seat_conditions(
    rig: Rig, name: str, star: HeatStar, film_kind: str, follows: float
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


def seat_sources(rig: Rig, name: str, state: BearingState, power: float) -> Iterator[BoundaryCondition]:
    """Friction of a bearing into its seats; power : of the friction [W]."""
    for seat, share in body_shares(rig, name, state):
        yield SurfaceSource(surface=seat.surface, power=share * power, kind=BEARING_LOSS)


def on_surface(rig: Rig, name: str, seat: Seat, conductance: float) -> FilmLaw:
    """Law of a conductance [W/K] that is spread over the surface of a seat."""
    area = rig.conduction[name.split(".")[0]].elements.surfaces[seat.surface].area
    return convection.constant(conductance / area, SOURCE, "conductance / area")
