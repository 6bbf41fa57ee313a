"""What an entry of ``boundary`` may be besides a film to a fluid: flanks, bearings, radiation, exchange, fixed ends."""

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import Field, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from rigdesign.base.errors import Fault
from rigdesign.base.units import show
from rigdesign.case.fields import (
    Clearance,
    HeatTransferCoefficient,
    Part,
    Size,
    Temperature,
    TemperatureDifference,
    Text,
    Usual,
    fault,
)
from rigdesign.case.films import (
    ROOM,
    WARM_WALL,
    BathFilm,
    FilmFactor,
    Fluid,
    Host,
    HousingHeightFilm,
    PlateFilm,
    ShaftFilm,
    StillAirFilm,
    SurfaceCondition,
    SurfaceFilm,
    SurfacePlace,
    SurfaceSite,
)
from thermal.conditions.boundary import (
    Adiabatic,
    BoundaryCondition,
    Exchange,
    PrescribedTemperature,
    Radiation,
)
from thermal.films import convection
from thermal.films.law import ExchangeLaw, FilmLaw

# A heat transfer coefficient that the case gives, and the film law it was read from where it was printed.


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


class FlankFilm(SurfaceCondition):
    """Rim of a gear that stands for its teeth: the oil the jets lay on the flanks, tooth as a fin."""

    law: Literal["flank_film"]
    """Selects the oil film on the flanks."""
    correlation: Literal["fling_off", "jet_renewal", "constant"] = "fling_off"
    """fling_off: laid by every jet and flung off; jet_renewal: stays until the next jet, an upper bound; constant:
    ``heat_transfer_coefficient`` on the flanks."""
    wetted_share: float = Field(default=1.0, gt=0.0, le=1.0)
    """Outer share of the tooth height that the oil reaches."""
    film_factor: FilmFactor = 1.0
    """Multiplies the film."""
    heat_transfer_coefficient: HeatTransferCoefficient | None = None
    """Mean over all flanks, for ``constant``."""

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """It needs teeth, and a coefficient for ``constant`` only."""
        if not site.has_teeth:
            yield Fault(
                "surfaces", f'"{site.surface}"', "has no teeth",
                'law = "flank_film" is for gear_*_rim; write another law',
            )  # fmt: skip
        given = self.heat_transfer_coefficient
        if self.correlation == "constant" and given is None:
            yield Fault(
                "heat_transfer_coefficient", "", 'correlation = "constant" needs it',
                'add it, e.g. heat_transfer_coefficient = "3000 W/(m2 K)"',
            )  # fmt: skip
        if self.correlation != "constant" and given is not None:
            yield Fault(
                "heat_transfer_coefficient", f"{given:g} W/(m2 K)",
                f'is not used: correlation = "{self.correlation}" computes it',
                'remove it, or write correlation = "constant"',
            )  # fmt: skip

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """Film on the teeth that the rim stands for."""
        return host.flank_film(surface)


class BearingFilm(SurfaceCondition):
    """Bore or journal to the lubricant film: conductance of the film, sink at film temperature."""

    law: Literal["bearing_film"]
    """Selects the film of the bearing."""
    film_factor: FilmFactor = 1.0
    """Multiplies the conductance between film and wall, not what the film carries or heats."""

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """It needs a bearing."""
        if not site.in_bearing:
            yield Fault(
                "surfaces", f'"{site.surface}"', "is neither bore nor journal of a bearing",
                'law = "bearing_film" is for bearing_bore_* and shaft_*_journal_*; write another law',
            )  # fmt: skip

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """Film of the bearing, where it has one."""
        return host.bearing_film(self.film_factor, surface)


class ThermalRadiation(SurfaceCondition):
    """Grey radiation to large surroundings; a film may cover the same surface."""

    may_join_a_film: ClassVar[bool] = True

    law: Literal["radiation"]
    """Selects radiation."""
    emissivity: Annotated[float, Usual(0.1, 1.0)] = Field(gt=0.0, le=1.0)
    """Emissivity of the grey surface."""
    emissivity_excess: float = Field(default=0.0, ge=-1.0, le=1.0)
    """What the surface has beyond ``emissivity``: it counts even where a film to room air stands for the rest."""
    surroundings_temperature: Temperature | None = None
    """Walls of the room; ambient when left out."""

    @model_validator(mode="after")
    def _grey(self) -> "ThermalRadiation":
        whole = self.emissivity + self.emissivity_excess
        if not 0.0 <= whole <= 1.0:
            raise fault(
                f"emissivity and emissivity_excess add up to {whole:g}, outside of 0 to 1",
                f"write an excess within {-self.emissivity:g} and {1.0 - self.emissivity:g}",
            )
        return self

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """Radiation to the surroundings; under a film that holds it only what the excess adds."""
        if radiation_in_film and self.emissivity_excess == 0.0:
            return None
        return Radiation(
            surface=surface,
            emissivity=self.emissivity_excess
            if radiation_in_film
            else self.emissivity + self.emissivity_excess,
            surroundings_temperature=self.surroundings_temperature or host.surroundings,
        )

    def against_enclosure(self, entry: str) -> tuple[str, str]:
        """It radiates to the room."""
        return (
            f"radiates to its surroundings by boundary.{entry} already",
            f"take it out of one of them, or give the enclosure an opening_temperature in place of {entry}",
        )


class SurfaceExchange(SurfaceCondition):
    """Heat from a surface to its partner, by their area means."""

    may_join_a_film: ClassVar[bool] = True

    partner: Text
    """Surface on the other side; ``*`` is filled with what it stood for in ``surfaces``."""

    @abstractmethod
    def exchange_law(self, place: SurfacePlace) -> ExchangeLaw:
        """Its law with the numbers of the first surface."""

    def partner_of(self, stood_for: tuple[str, ...]) -> str:
        """Name of the partner surface, each ``*`` filled with what it stood for in the surface."""
        name = self.partner
        for text in stood_for:
            name = name.replace("*", text, 1)
        return name

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """Exchange with its partner."""
        return Exchange(
            surface_a=surface,
            surface_b=self.partner_of(stood_for),
            kind="exchange",
            law=self.exchange_law(host.place(self, surface)),
        )


class GapExchange(SurfaceExchange):
    """Heat across a narrow rotating gap from each surface to its partner (area means)."""

    film_factor: FilmFactor = 1.0
    """Multiplies the film: with a range it stands for the scatter of the correlation."""
    law: Literal["narrow_gap"]
    """Selects exchange across a narrow rotating gap."""
    correlation: Literal["becker_kaye", "jungnickel"] = "becker_kaye"
    """becker_kaye: air at the mean temperature, with the onset of vortices; jungnickel: constants of air near room
    temperature."""
    gap: Clearance | None = None
    """The radial gap of the seals of the shaft when left out."""

    def exchange_law(self, place: SurfacePlace) -> ExchangeLaw:
        """Law of the gap, with its own width or that of the seals."""
        shaft, gap = place.turning, self.gap or place.turning.seal_gap
        jungnickel = self.correlation == "jungnickel"
        across = convection.narrow_gap_jungnickel if jungnickel else convection.narrow_gap_taylor
        return convection.scaled(across(shaft.speed, 0.5 * shaft.diameter, gap), self.film_factor)

    def faults_on(self, site: SurfaceSite) -> Iterator[Fault]:
        """It needs a surface that turns; its gap has to be known, and that of the seals where it is one."""
        if not site.on_shaft:
            yield Fault(
                "surfaces", f'"{site.surface}"',
                "is no surface of a shaft or gear: the gap takes its diameter from there",
                "write the shaft here and this surface as its partner, or choose another law",
            )  # fmt: skip
            return
        if site.seal_gap is None:
            if self.gap is None:
                yield Fault("gap", "", f"{site.surface} is no seal, its gap is not known", "add the gap")
        elif self.gap not in (None, site.seal_gap):
            yield Fault(
                "gap", show(self.gap or 0.0, "length"),
                f"is not the radial gap of the seals of {site.seal}, {show(site.seal_gap, 'length')}",
                "leave it out: the film takes the gap of the seals",
            )  # fmt: skip


class SeriesExchange(SurfaceExchange):
    """Heat from a rotating shaft through air to a wall: two films in series (P2, Formula 3)."""

    law: Literal["series_films"]
    """Selects two films in series."""
    coefficients: tuple[HeatTransferCoefficient, HeatTransferCoefficient]
    """Film on the surface, film on the partner."""
    film_factor: FilmFactor = 1.0
    """Multiplies the conductance of both in series."""

    def exchange_law(self, place: SurfacePlace) -> ExchangeLaw:
        """Both coefficients in series."""
        first, second = (convection.constant(value, "input of the case") for value in self.coefficients)
        return convection.scaled(convection.series(first, second), self.film_factor)


class FixedTemperature(SurfaceCondition):
    """A surface held at one temperature."""

    law: Literal["fixed_temperature"]
    """Selects a given temperature."""
    temperature: Temperature
    """Temperature at which the surface is held."""

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """The temperature."""
        return PrescribedTemperature(surface=surface, temperature=self.temperature)


class Insulated(SurfaceCondition):
    """A surface that passes no heat."""

    law: Literal["insulated"]
    """Selects no heat flux."""

    def on(
        self, surface: str, stood_for: tuple[str, ...], host: Host, *, radiation_in_film: bool = False
    ) -> BoundaryCondition | None:
        """No flux."""
        return Adiabatic(surface=surface)

    def against_enclosure(self, entry: str) -> tuple[str, str]:
        """It passes nothing."""
        return (
            f"passes no heat by boundary.{entry}",
            f"take it out of {entry}: the enclosure is a condition of its own; or write a film",
        )


Condition = Annotated[
    PlateFilm
    | ConstantFilm
    | BathFilm
    | FlankFilm
    | ShaftFilm
    | BearingFilm
    | ThermalRadiation
    | GapExchange
    | SeriesExchange
    | FixedTemperature
    | Insulated,
    Field(discriminator="law"),
]
"""One boundary condition; ``law`` says which."""
