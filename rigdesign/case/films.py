"""Film laws of the case: each class states its keys, what it needs of its surface, and the law it stands for.

A new law of a still wall or of a shaft is a formula in `thermal.films`, its class here, and its name in `PlateFilm`
or `ShaftFilm`. A coefficient that the case gives: `rigdesign.case.given_film`.
"""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import Part, Size, Text
from rigdesign.case.surface_place import SurfacePlace, SurfaceSite
from thermal.films import convection
from thermal.films.law import FilmLaw

Fluid = Literal[
    "ambient",
    "gear_oil_inlet",
    "gear_oil_mean",
    "gear_oil_outlet",
    "bearing_oil_inlet",
    "bearing_oil_mean",
    "bearing_oil_outlet",
]
"""What wets a surface: room air, or the oil of the chamber at inlet, outlet or their mean."""
Medium = Literal["air", "mist"]
"""What a surface of the chamber turns in: dry air at the film temperature, or the mist whose density
``losses.chamber_density`` gives for windage."""
FilmFactor = Annotated[float, Field(gt=0.0, le=10.0)]
"""Multiplies a film: what it really is, over what its law or the case says."""

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
    def wetted_by(self) -> Fluid | None:
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

    @property
    def wetted_by(self) -> Fluid:
        """Room air."""
        return "ambient"


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
    draught_factor: float = Field(default=1.0, gt=0.0, le=5.0)
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


PlateFilm = NiemannWinter | RecknagelPlate | IsoTr14179 | VerticalPlate | HorizontalPlate
"""Film between a still wall or plate and room air."""


class TurningFilm(PublishedFilm):
    """A film that takes diameter and speed from a shaft or gear."""

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """It needs a surface of a shaft or gear."""
        if not site.on_shaft:
            yield Fault(
                "surfaces", f'"{site.surface}"',
                f"is no surface of a shaft or gear: {self.law} takes its diameter from there",
                "take it out, or choose a film for still walls",
            )  # fmt: skip


class HorizontalCylinder(TurningFilm):
    """Shaft at rest in still room air (Churchill and Chu); diameter from the shaft."""

    law: Literal["horizontal_cylinder"]
    """Selects the film of a shaft at rest."""

    @property
    def wetted_by(self) -> Fluid:
        """Room air."""
        return "ambient"

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published."""
        return convection.horizontal_cylinder_churchill_chu(place.turning.diameter, place.turning.speed)


class RotatingCylinder(TurningFilm):
    """Rotating shaft in air or oil mist; diameter and speed from the shaft."""

    law: Literal["rotating_cylinder"]
    """Selects the film of a rotating shaft."""
    correlation: Literal["becker", "jungnickel", "kays_bjorklund", "etemad", "dropkin_carmi"] = "becker"
    """becker, etemad, dropkin_carmi: air at the film temperature; kays_bjorklund: with buoyancy, down to zero speed;
    jungnickel: constants of air near room temperature."""
    fluid: Fluid
    """Fluid whose temperature counts: room air, or one of the oils at inlet, mean or outlet."""
    medium: Medium = "air"
    """air: dry air; mist: density of ``losses.chamber_density`` (not for ``jungnickel``)."""

    @property
    def wetted_by(self) -> Fluid:
        """The fluid it names."""
        return self.fluid

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published, in the medium of the entry."""
        shaft = place.turning
        if self.correlation == "jungnickel":
            return convection.rotating_cylinder_jungnickel(shaft.speed, shaft.diameter)
        laws = {
            "becker": convection.rotating_cylinder_becker,
            "kays_bjorklund": convection.rotating_cylinder_kays_bjorklund,
            "etemad": convection.rotating_cylinder_etemad,
            "dropkin_carmi": convection.rotating_cylinder_dropkin_carmi,
        }
        density = place.mist_density if self.medium == "mist" else None
        return laws[self.correlation](shaft.speed, shaft.diameter, density)


class RotatingDisc(TurningFilm):
    """Rotating end or gear face in air or oil mist; radius and speed from the shaft."""

    law: Literal["rotating_disc"]
    """Selects the film of a rotating end or gear face."""
    correlation: Literal["kreith", "jungnickel"] = "kreith"
    """kreith: air at the film temperature; jungnickel: constants of air near room temperature."""
    fluid: Fluid
    """Fluid whose temperature counts: room air, or one of the oils at inlet, mean or outlet."""
    medium: Medium = "air"
    """air: dry air; mist: density of ``losses.chamber_density`` (not for ``jungnickel``)."""

    @property
    def wetted_by(self) -> Fluid:
        """The fluid it names."""
        return self.fluid

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published, in the medium of the entry."""
        speed, radius = place.turning.speed, 0.5 * place.turning.diameter
        if self.correlation == "jungnickel":
            return convection.rotating_disc_jungnickel(speed, radius)
        return convection.rotating_disc(speed, radius, place.mist_density if self.medium == "mist" else None)


ShaftFilm = HorizontalCylinder | RotatingCylinder | RotatingDisc
"""Film that takes its diameter from a shaft or gear."""
