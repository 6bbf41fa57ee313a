"""What a boundary condition may need of its surface: the case file's side, and the numbers of an operating point."""

from dataclasses import dataclass

from thermal.films.flank import FilmOil


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
