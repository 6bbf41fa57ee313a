"""Film laws of the case: each class states its keys, what it needs of its surface, and the law it stands for.

A new law of a still wall or of a shaft is a formula in `thermal.films`, its class here or in `shaft_films`, and its
name in `PlateFilm` or `ShaftFilm`. A coefficient that the case gives: `rigdesign.case.surface_conditions`.
"""

import re
from abc import abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal, Protocol, get_args

from pydantic import Field, WithJsonSchema, model_validator

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import Conductivity, Length, Name, Part, Size, Text, Usual, Velocity, fault
from thermal.conditions.boundary import BoundaryCondition
from thermal.films import bath, convection
from thermal.films.bath import wetted_wall_film
from thermal.films.convection import RibArray, scaled
from thermal.films.flank import FilmOil
from thermal.films.law import FilmLaw

# What a boundary condition may need of its surface: the case file's side, and the numbers of an operating point.


@dataclass(frozen=True, kw_only=True)
class SurfaceSite:
    """A surface as far as the case file describes it; what the rules of a condition are checked against."""

    surface: str
    housing_height: float
    """[m]"""
    on_shaft: bool
    """A surface of a shaft or gear."""
    has_teeth: bool
    """The rim of a gear."""
    in_bearing: bool = False
    """Bore or journal of a bearing."""
    seal: str = ""
    """Shaft of the seal the surface belongs to; empty for another surface."""
    seal_gap: float | None = None
    """Radial gap of that seal [m]."""


@dataclass(frozen=True, kw_only=True)
class ShaftPlace:
    """The shaft or gear a surface belongs to, at one operating point."""

    speed: float
    """[rad/s]"""
    diameter: float
    """Of the surface [m]."""
    seal_gap: float
    """Radial gap of the seals of the shaft [m]."""


@dataclass(frozen=True, kw_only=True)
class BathPlace:
    """The sump that a shaft or gear surface dips into, by its level at rest."""

    oil: FilmOil
    face_share: float
    """Part of the circle of the surface below the level [-]."""
    rim_share: float
    """Part of its circumference below the level [-]."""


@dataclass(frozen=True, kw_only=True)
class SurfacePlace:
    """Numbers of one surface at one operating point, from which a condition makes its film law."""

    height: float
    """Of the housing [m]."""
    wall_conductivity: float = 50.0
    """Of the housing [W/(m K)]; grey iron where no housing is stated."""
    shaft: ShaftPlace | None = None
    """None for a surface that does not turn."""
    bath: BathPlace | None = None
    """None where no sump is or nothing turns."""
    mist_density: float | None = None
    """Density of the oil mist in the chamber [kg/m3]; None where the case gives none."""
    wetted_share: float = 1.0
    """Share of a given oil film that is left: bubbles conduct less than oil, blocked jets leave flanks dry."""
    source: str = "input of the case"
    """Where the case has a given coefficient from."""

    @property
    def turning(self) -> ShaftPlace:
        """The shaft; the rules of the case keep films of shafts off other surfaces."""
        assert self.shaft is not None
        return self.shaft

    @property
    def sump(self) -> BathPlace:
        """The sump; the rules of the case keep baths out of boxes without one."""
        assert self.bath is not None
        return self.bath


# Names of surfaces with stars.


def matched(patterns: Iterable[str], names: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Surface -> what each ``*`` stood for, for every name that a pattern fits."""
    known = tuple(names)
    found = {}
    for pattern in patterns:
        expression = re.compile("(.+)".join(re.escape(part) for part in pattern.split("*")))
        for name in known:
            match = expression.fullmatch(name)
            if match is not None:
                found[name] = match.groups()
    return found


# Ribs on a surface of a housing, which its mesh does not have.


class Ribs(Part):
    """Straight ribs of constant thickness, side by side."""

    height: Length
    """From the wall to the tip."""
    thickness: Length
    """Mean thickness of a rib."""
    pitch: Length
    """From middle to middle of two ribs."""
    conductivity: Conductivity | None = None
    """Thermal conductivity of the ribs; that of the housing when left out."""

    @model_validator(mode="after")
    def _room_between(self) -> "Ribs":
        if self.thickness >= self.pitch:
            raise fault(
                f"ribs of {show(self.thickness, 'length')} on a pitch of {show(self.pitch, 'length')} leave no gap",
                "write a pitch above the thickness",
            )
        return self

    def on(self, law: FilmLaw, place: SurfacePlace) -> FilmLaw:
        """The film of wall and ribs, referred to the wall without them."""
        array = RibArray(height=self.height, thickness=self.thickness, pitch=self.pitch)
        return convection.ribbed(law, array, self.conductivity or place.wall_conductivity)


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


class Host(Protocol):
    """Housing in a running rig, for the conditions on its surfaces."""

    @property
    def surroundings(self) -> float:
        """Temperature of the walls of the room [K]."""

    def place(self, condition: "SurfaceCondition", surface: str) -> SurfacePlace:
        """Numbers of a surface for a film law."""

    def film(self, condition: "SurfaceFilm", surface: str) -> BoundaryCondition:
        """Film to a fluid of the case."""

    def bearing_film(self, factor: float, surface: str) -> BoundaryCondition | None:
        """Film of the bearing at a surface, its conductance times a factor; None of one that is joined to its seats."""

    def flank_film(self, surface: str) -> BoundaryCondition:
        """Film on the teeth that a rim stands for."""


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

    @abstractmethod
    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """The condition of the temperature field; None where it adds none.

        stood_for : what the stars of its surfaces stood for
        radiation_in_film : a film to room air holds the radiation of the surface already
        """

    def against_enclosure(self, entry: str) -> tuple[str, str] | None:
        """Why its surface cannot radiate in an enclosure, and the remedy; None where it can."""
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

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """A film to its fluid."""
        return host.film(self, surface)


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


# The film on inner walls of a box with a sump.


class BathFilm(PublishedFilm):
    """Inner wall that splashed oil wets or that stands in the sump: 200 W/(m2 K) by ISO/TR 14179-2, 100 to 300 usual.

    One mean of wetted and drained walls at any speed; a wall that no oil reaches has far less (``film_factor``).
    """

    law: Literal["bath"]
    """Selects the film of inner walls wetted by a sump."""
    fluid: OilFluid = "gear_oil_mean"
    """Oil that wets the wall."""

    @property
    def wetted_by(self) -> str:
        """The oil it names."""
        return self.fluid

    @property
    def usual_film(self) -> bool:
        """Whether the case says nothing of the size of the film."""
        return "film_factor" not in self.model_fields_set

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The constant of the standard, less what does not wet the wall."""
        return scaled(wetted_wall_film(), place.wetted_share)


# Film laws of the case that take diameter and speed from a shaft or gear.

Medium = Literal["air", "mist", "bath"]
"""What a surface of the chamber turns in: dry air at the film temperature, the mist whose density
``losses.chamber_density`` gives for windage, or the sump up to its level and air above."""


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
    def wetted_by(self) -> str:
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
    """Fluid whose temperature counts: ``ambient``, ``gear_oil_`` or ``bearing_oil_`` with ``inlet``,
    ``mean`` or ``outlet``, or the name of a volume or stream of the housing."""
    medium: Medium = "air"
    """air: dry air; mist: density of ``losses.chamber_density`` (not for ``jungnickel``); bath: oil up to the level of
    the sump (Eisenberg, Tobias and Wilke) and air above."""

    @property
    def wetted_by(self) -> str:
        """The fluid it names."""
        return self.fluid

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published, in the medium of the entry."""
        shaft = place.turning
        if self.medium == "bath":
            sump = place.sump
            wet = bath.dipped_shaft_film(shaft.speed, shaft.diameter, sump.rim_share, sump.oil)
            dry = convection.rotating_cylinder_becker(shaft.speed, shaft.diameter)
            return bath.above_bath(wet, dry, sump.rim_share)
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
    """Fluid whose temperature counts: ``ambient``, ``gear_oil_`` or ``bearing_oil_`` with ``inlet``,
    ``mean`` or ``outlet``, or the name of a volume or stream of the housing."""
    medium: Medium = "air"
    """air: dry air; mist: density of ``losses.chamber_density`` (not for ``jungnickel``); bath: boundary layer of a
    disc in oil up to the level of the sump (Levich) and air above."""

    @property
    def wetted_by(self) -> str:
        """The fluid it names."""
        return self.fluid

    def correlation_at(self, place: SurfacePlace) -> FilmLaw:
        """The law as published, in the medium of the entry."""
        speed, radius = place.turning.speed, 0.5 * place.turning.diameter
        if self.medium == "bath":
            sump = place.sump
            wet = bath.dipped_face_film(speed, radius, sump.face_share, sump.oil)
            return bath.above_bath(wet, convection.rotating_disc(speed, radius), sump.face_share)
        if self.correlation == "jungnickel":
            return convection.rotating_disc_jungnickel(speed, radius)
        return convection.rotating_disc(speed, radius, place.mist_density if self.medium == "mist" else None)


ShaftFilm = HorizontalCylinder | RotatingCylinder | RotatingDisc
"""Film that takes its diameter from a shaft or gear."""
