"""The film on inner walls of a box with a sump."""

from typing import Literal

from rigdesign.case.films import OilFluid, PublishedFilm
from rigdesign.case.surface_place import SurfacePlace
from thermal.films.bath import wetted_wall_film
from thermal.films.convection import scaled
from thermal.films.law import FilmLaw


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
