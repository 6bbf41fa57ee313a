"""A heat transfer coefficient that the case gives, and the film law it was read from where it was printed."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rigdesign.base.errors import Fault
from rigdesign.case.fields import (
    HeatTransferCoefficient,
    Part,
    Size,
    Temperature,
    TemperatureDifference,
    Usual,
)
from rigdesign.case.films import (
    ROOM,
    WARM_WALL,
    FilmFactor,
    Fluid,
    HousingHeightFilm,
    PlateFilm,
    StillAirFilm,
    SurfaceFilm,
)
from rigdesign.case.surface_place import SurfacePlace, SurfaceSite
from thermal.films import convection
from thermal.films.law import FilmLaw


def _law_name(film: type[StillAirFilm]) -> str:
    (name,) = get_args(film.model_fields["law"].annotation)
    return str(name)


PRINTED_LAWS: dict[str, type[StillAirFilm]] = {
    _law_name(film): film
    for film in get_args(PlateFilm)
    if not any(
        field.is_required() for key, field in film.model_fields.items() if key not in ("surfaces", "law")
    )
}
"""Laws a printed coefficient may have been read from: those that need no more than a height."""


class _PrintedLaw:
    """One of `PRINTED_LAWS`, as a choice of the case file."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.literal_schema(list(PRINTED_LAWS))


class TakenFrom(Part):
    """Where a printed coefficient to room air was read: at an assumed temperature difference, from a film law."""

    temperature_difference: TemperatureDifference
    """Wall above air that was assumed; the run warns when it comes out otherwise."""
    law: Annotated[str, _PrintedLaw()] | None = None
    """Film law it was read from: gives the coefficient at other differences, and whether it contains radiation."""
    height: Size | None = None
    """h: height of the housing, where the law needs one."""

    @property
    def needs_height(self) -> bool:
        """The law depends on the height of the housing."""
        return self.law is not None and issubclass(PRINTED_LAWS[self.law], HousingHeightFilm)

    def film_law(self) -> FilmLaw | None:
        """The law the coefficient was read from; None if the case does not say."""
        if self.law is None:
            return None
        film = PRINTED_LAWS[self.law].model_validate({"surfaces": ("as printed",), "law": self.law})
        return film.film_law(SurfacePlace(height=self.height or 0.0))

    @property
    def radiation_included(self) -> bool:
        """The law it was read from is for convection and radiation together."""
        law = self.film_law()
        return law is not None and law(WARM_WALL, ROOM).radiation_included


class ConstantFilm(SurfaceFilm):
    """A given heat transfer coefficient to a fluid."""

    coefficient_given: ClassVar[bool] = True

    law: Literal["constant_film"]
    """Selects a given heat transfer coefficient."""
    heat_transfer_coefficient: Annotated[HeatTransferCoefficient, Usual(0.09, 8.0, "usual film of its fluid")]
    """Heat flux per kelvin between surface and fluid."""
    fluid: Fluid
    """Fluid that wets the surface: ``ambient``, ``gear_oil_`` or ``bearing_oil_`` with ``inlet``,
    ``mean`` or ``outlet``, or the name of a volume or stream of the housing."""
    taken_from: TakenFrom | None = None
    """For a printed coefficient to room air: what it was read from."""
    fluid_temperature: Temperature | None = None
    """Overrides the temperature of the fluid."""
    film_factor: FilmFactor = 1.0
    """Multiplies the coefficient."""

    @property
    def wetted_by(self) -> str:
        """The fluid it names."""
        return self.fluid

    def fluid_temperature_given(self, usual: float) -> float:
        """Its own, or the ``usual`` one [K]."""
        return self.fluid_temperature or usual

    def film_law(self, place: SurfacePlace) -> FilmLaw:
        """The coefficient, less what does not wet the surface."""
        taken = self.taken_from
        law = convection.constant(
            self.heat_transfer_coefficient,
            place.source,
            "constant" if taken is None or taken.law is None else taken.law,
            None if self.fluid == "ambient" else convection.OIL_RANGE,
            radiation_included=taken is not None and taken.radiation_included,
        )
        return convection.scaled(law, self.film_factor * place.wetted_share)

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """A printed coefficient is one to room air, with a height where its law needs one."""
        taken = self.taken_from
        if taken is None:
            return
        if self.fluid != "ambient":
            yield Fault(
                "taken_from", "", f"stands for films to room air, the fluid is {self.fluid}",
                'remove it or write fluid = "ambient"',
            )  # fmt: skip
        if taken.needs_height and taken.height is None:
            yield Fault(
                "taken_from.height", "", f"{taken.law} needs the height of the housing",
                'add it, e.g. height = "400 mm"',
            )  # fmt: skip
