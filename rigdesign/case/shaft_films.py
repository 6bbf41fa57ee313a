"""Film laws of the case that take diameter and speed from a shaft or gear."""

from collections.abc import Iterator
from typing import Literal

from rigdesign.base.errors import Fault
from rigdesign.case.films import Fluid, PublishedFilm
from rigdesign.case.surface_place import SurfacePlace, SurfaceSite
from thermal.films import bath, convection
from thermal.films.law import FilmLaw

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
