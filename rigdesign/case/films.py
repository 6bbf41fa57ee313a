"""Film laws of the case: each class states its keys, what it needs of its surface, and the law it stands for.

A new law of a still wall or of a shaft is a formula in `thermal.films`, its class here or in `shaft_films`, and its
name in `PlateFilm` or `ShaftFilm`. A coefficient that the case gives: `rigdesign.case.given_film`.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal, get_args

from pydantic import Field, WithJsonSchema

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import Name, Part, Size, Text, Usual, Velocity
from rigdesign.case.ribs import Ribs
from rigdesign.case.surface_place import SurfacePlace, SurfaceSite
from thermal.films import convection
from thermal.films.law import FilmLaw

OilFluid = Literal[
    "gear_oil_inlet",
    "gear_oil_mean",
    "gear_oil_outlet",
    "bearing_oil_inlet",
    "bearing_oil_mean",
    "bearing_oil_outlet",
]
"""Oil of the gears or bearings of a chamber at inlet, outlet or their mean."""
UsualFluid = Literal["ambient", OilFluid]
"""What wets a surface: room air, or the oil of the chamber at inlet, outlet or their mean."""
FLUIDS: tuple[str, ...] = get_args(UsualFluid)
Fluid = Annotated[
    Name, WithJsonSchema({"anyOf": [{"type": "string", "enum": list(FLUIDS)}, {"type": "string"}]})
]
"""One of `FLUIDS`, or the name of a volume or stream of the housing."""
FilmFactor = Annotated[float, Field(gt=0.0, le=10.0), Usual(0.15, 7.0)]
"""Multiplies a film: what it really is, over what its law or the case says."""

FAN_VELOCITY = 3.0
"""Velocity of the air of a fan along a housing [m/s] where the case says none."""
ROOM, WARM_WALL = 293.15, 343.15
"""Temperatures of air and wall [K] at which a law is evaluated for whether its coefficient contains radiation."""


class SurfaceCondition(Part):
    """What one entry of ``boundary`` says of its surfaces."""

    surfaces: tuple[Text, ...] = Field(min_length=1)
    """Surface names; ``*`` stands for any run of characters."""
    law: str
    """Which law holds on the surfaces; it decides which other keys the entry has."""

    may_join_a_film: ClassVar[bool] = False
    """It may stand on a surface that has a film already."""

    @property
    def wetted_by(self) -> str | None:
        """Fluid of the case that its film exchanges heat with; None for anything else."""
        return None

    def partner_of(self, stood_for: tuple[str, ...]) -> str | None:
        """Surface that an exchange leads to; ``stood_for``: what the stars stood for. None for anything else."""
        return None

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """What it needs of a surface and does not find there; paths are relative to the entry."""
        yield from ()


class SurfaceFilm(SurfaceCondition):
    """A film between a surface and a fluid of the case."""

    coefficient_given: ClassVar[bool] = False
    """Its coefficient is a number of the case, not computed by a law."""

    @abstractmethod
    def film_law(self, place: SurfacePlace) -> FilmLaw:
        """Its law with the numbers of a surface."""

    def radiation_included(self, place: SurfacePlace) -> bool:
        """Whether its coefficient is of the size of convection and radiation together."""
        return self.film_law(place)(WARM_WALL, ROOM).radiation_included

    def fluid_temperature_given(self, usual: float) -> float:
        """Temperature of the fluid [K]; ``usual`` is that of the case."""
        return usual


class PublishedFilm(SurfaceFilm):
    """A film that follows a published law."""

    film_factor: FilmFactor = 1.0
    """Multiplies the film: with a range it stands for the scatter of the correlation."""

    def film_law(self, place: SurfacePlace) -> FilmLaw:
        """Its law with the numbers of a surface."""
        return convection.scaled(self.correlation_at(place), self.film_factor)

    @abstractmethod
    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""


class StillAirFilm(PublishedFilm):
    """A film between a still wall or plate and room air."""

    ribs: Ribs | None = None
    """Ribs on the surface that are not drawn: the film counts on their area too, at their fin efficiency."""

    @property
    def wetted_by(self) -> str:
        """Room air."""
        return "ambient"

    def film_law(self, place: SurfacePlace) -> FilmLaw:
        """Its law with the numbers of a surface, on the ribs too where there are some."""
        if self.ribs is None:
            return super().film_law(place)
        law = self.ribs.on(self.correlation_at(place), place)
        return convection.scaled(law, self.film_factor)


class HousingHeightFilm(StillAirFilm):
    """A film that takes the height of the housing."""

    height: Size | None = None
    """The height of the housing when left out."""

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """A height of its own has to be that of the housing."""
        if self.height not in (None, site.housing_height):
            yield Fault(
                "height", show(self.height or 0.0, "length"),
                f"is not the height of the housing, {show(site.housing_height, 'length')}",
                "leave it out: the film takes the height of the housing",
            )  # fmt: skip


class NiemannWinter(HousingHeightFilm):
    """Housing to room air, alpha = f_k (10 + 0.07 dT) h^-0.15 (Niemann/Winter; P2, Formula 2)."""

    law: Literal["niemann_winter"]
    """Selects the film of Niemann/Winter for the housing in room air."""
    draught_factor: Annotated[float, Usual(0.3, 3.0)] = Field(default=1.0, gt=0.0, le=5.0)
    """f_k: 1 in still room air."""
    height: Size | None = None
    """h; the height of the housing when left out."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        return convection.niemann_winter(self.height or place.height, self.draught_factor)


class RecknagelPlate(StillAirFilm):
    """Horizontal plate to still room air."""

    law: Literal["recknagel_plate"]
    """Selects the film of Recknagel for a horizontal plate."""
    correlation: Literal["dimensional", "turbulent"] = "dimensional"
    """dimensional: 2.0 dT^(1/4); turbulent: Nu = 0.125 Ra^(1/3)."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        return convection.recknagel_plate(self.correlation)


class IsoTr14179(HousingHeightFilm):
    """Housing to room air by ISO/TR 14179-2, free convection."""

    law: Literal["iso_tr_14179_2"]
    """Selects the film of ISO/TR 14179-2 for free convection."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        return convection.iso_tr_14179_2_free(self.height or place.height)


class VerticalPlate(HousingHeightFilm):
    """Vertical wall to still room air (Churchill and Chu, as the VDI Heat Atlas has it); no radiation in it."""

    law: Literal["vertical_plate"]
    """Selects the film of Churchill and Chu for a vertical wall."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        return convection.vertical_plate_churchill(self.height or place.height)


class HorizontalPlate(StillAirFilm):
    """Horizontal plate to still room air; no radiation in it."""

    law: Literal["horizontal_plate"]
    """Selects the film of a horizontal plate."""
    correlation: Literal["mcadams", "vdi", "rohsenow"] = "mcadams"
    """Author of the correlation; all take ``length`` and ``facing``."""
    length: Size
    """Characteristic length: area over perimeter."""
    facing: Literal["up", "down"] = "up"
    """Side of the plate the air is on."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        laws = {
            "mcadams": convection.horizontal_plate_mcadams,
            "vdi": convection.horizontal_plate_vdi,
            "rohsenow": convection.horizontal_plate_rohsenow,
        }
        return laws[self.correlation](self.length, self.facing)


class ForcedAir(HousingHeightFilm):
    """Wall in the air stream of a fan, plate in a stream with free convection under it; no radiation in it."""

    law: Literal["forced_air"]
    """Selects the film of a wall in moving air."""
    length: Size
    """Length of the wall along the stream."""
    velocity: Velocity | None = None
    """Velocity of the air along the wall; 3 m/s when left out, which the report lists as an assumption."""

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        velocity = FAN_VELOCITY if self.velocity is None else self.velocity
        return convection.forced_air_plate(velocity, self.length, self.height or place.height)


PlateFilm = NiemannWinter | RecknagelPlate | IsoTr14179 | VerticalPlate | HorizontalPlate | ForcedAir
"""Film between a still wall or plate and room air."""
