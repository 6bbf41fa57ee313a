"""Films between a still surface and room air: gearbox housings, plates, shafts at rest.

Every factory takes the fixed dimensions and returns a law (wall temperature, fluid temperature) [K] ->
coefficient, with air properties at the film temperature, the mean of the two. Laws are even in the
temperature difference: a wall colder than the air gets the coefficient of one as much warmer.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Literal, Protocol

from thermal.errors import ThermalInputError
from thermal.films.law import (
    Correlation,
    FilmCoefficient,
    FilmError,
    FilmLaw,
    not_negative,
    outside,
    positive,
)

# Properties of dry air at one atmosphere, from CoolProp (imported when first asked for).

ATMOSPHERE = 101325.0
"""[Pa]"""
LOWEST, HIGHEST = 200.0, 1000.0
"""Temperatures [K] between which properties are given."""


class AirRangeError(ThermalInputError):
    """An air temperature at which no correlation of this package holds."""


@dataclass(frozen=True, kw_only=True)
class Air:
    """Air at one temperature, SI."""

    temperature: float
    """[K]"""
    density: float
    """[kg/m3]"""
    specific_heat: float
    """[J/(kg K)]"""
    conductivity: float
    """[W/(m K)]"""
    viscosity: float
    """Dynamic viscosity [Pa s]."""

    @property
    def kinematic_viscosity(self) -> float:
        """[m2/s]"""
        return self.viscosity / self.density

    @property
    def prandtl(self) -> float:
        """Prandtl number [-]."""
        return self.viscosity * self.specific_heat / self.conductivity

    @property
    def expansion(self) -> float:
        """Isobaric expansion coefficient of an ideal gas, 1/T [1/K]."""
        return 1.0 / self.temperature


@lru_cache(maxsize=8192)
def air(temperature: float) -> Air:
    """Air at ``temperature`` [K] and one atmosphere (CoolProp, HEOS equation of state of Lemmon et al. 2000).

    Raises AirRangeError outside 200 to 1000 K.
    """
    if not LOWEST <= temperature <= HIGHEST:
        raise AirRangeError(
            f"air temperature = {temperature:g} K is outside {LOWEST:g} to {HIGHEST:g} K; check the wall and "
            "ambient temperatures of this film"
        )
    from CoolProp.CoolProp import PT_INPUTS

    state = _equation_of_state()
    state.update(PT_INPUTS, ATMOSPHERE, temperature)
    return Air(
        temperature=temperature,
        density=state.rhomass(),
        specific_heat=state.cpmass(),
        conductivity=state.conductivity(),
        viscosity=state.viscosity(),
    )


@lru_cache(maxsize=1)
def _equation_of_state() -> Any:
    from CoolProp.CoolProp import AbstractState

    return AbstractState("HEOS", "Air")


GRAVITY = 9.80665
"""[m/s2]"""
Facing = Literal["up", "down"]
_OTHER_LAW = "use a law made for it or a measured coefficient"

_VERTICAL_PLATE = Correlation(
    "vertical_plate_churchill", (0.0, 1e12), "Churchill and Chu, Int. J. Heat Mass Transfer 18 (1975) 1323"
)
_HORIZONTAL_CYLINDER = Correlation(
    "horizontal_cylinder_churchill_chu", (0.0, 1e12),
    "Churchill and Chu, Int. J. Heat Mass Transfer 18 (1975) 1049",
)  # fmt: skip
_MCADAMS = Correlation("horizontal_plate_mcadams", (1e4, 1e11), "McAdams, Heat Transmission, 3rd ed.")
_ROHSENOW = Correlation(
    "horizontal_plate_rohsenow", (1.0, 1e12), "Rohsenow, Hartnett, Cho, Handbook of Heat Transfer, 3rd ed."
)
_VDI = Correlation(
    "horizontal_plate_vdi", (1e3, 1e10), "VDI Heat Atlas, free convection on horizontal surfaces"
)
"""Correlations Nu(Ra, Pr) with their range of Ra."""


def niemann_winter(height: float, place_factor: float = 1.0) -> FilmLaw:
    """Gearbox housing in still room air: f_k (10 + 0.07 dT) (1/h)^0.15 (Niemann/Winter; P2 Formula 2).

    height : h, height of the housing [m]
    place_factor : f_k [-], 1 for a housing standing free in still air, less when enclosed, more in a draught

    The coefficient is of the size of free convection plus radiation together (thermal sheet a), so a surface
    with this film should not radiate as well; `thermal.conduction.setup.radiation_counted_twice` says
    so. The book's own limits are not public: the range is that in which the formula agrees with other sources.
    """
    positive("housing height", height, "m")
    positive("place factor f_k", place_factor, "")

    def law(wall: float, fluid: float) -> FilmCoefficient:
        difference = abs(wall - fluid)
        warnings = outside("wall - air", difference, 0.0, 150.0, _OTHER_LAW, "K")
        warnings += outside("housing height", height, 0.1, 3.0, _OTHER_LAW, "m")
        warnings += outside(
            "place factor f_k", place_factor, 0.5, 3.0, "give a coefficient measured in place"
        )
        if wall < fluid:
            warnings += (
                f"wall - air = {wall - fluid:.4g} K is below 0 K; the formula is made for heated "
                "housings, its value for a wall as much warmer is used",
            )
        return FilmCoefficient(
            value=place_factor * (10.0 + 0.07 * difference) * height**-0.15,
            formula="niemann_winter",
            inputs={"place_factor": place_factor, "height": height, "temperature_difference": difference},
            valid_range="still room air, 0 <= dT <= 150 K, 0.1 <= h <= 3 m (limits assumed)",
            source="Niemann/Winter, Maschinenelemente II; P2 Formula 2",
            warnings=warnings,
            radiation_included=True,
        )

    return law


def recknagel_plate(
    variant: Literal["turbulent", "dimensional"] = "turbulent", length: float | None = None
) -> FilmLaw:
    """Free plane surface in room air, size free; two candidates for P2's 6.3 W/m2K at 100 K (P2 Ref. 29).

    turbulent : Nu = 0.125 Ra^(1/3). The default: on a plate of metres Ra is far above 1e9, and only the
        exponent 1/3 makes the size drop out of a turbulent law.
    dimensional : 2.0 dT^(1/4), dT in K. Both give 6.32 W/m2K at 100 K over air of 20 degC; at 25 K it is 4 %
        above the other.
    length : characteristic length [m], used to check the range of the turbulent variant only

    Which of the two the book prints is not known (thermal sheet b).
    """
    if variant not in ("turbulent", "dimensional"):
        raise FilmError(f"variant = {variant!r} is unknown; use 'turbulent' or 'dimensional'")
    if length is not None:
        positive("plate length", length, "m")

    def turbulent(wall: float, fluid: float) -> FilmCoefficient:
        gas, cubed = _buoyancy(wall, fluid)
        rayleigh = cubed * length**3 if length is not None else None
        warnings: tuple[str, ...] = ()
        if rayleigh:
            warnings = outside("Rayleigh number", rayleigh, 1e7, 1e13, "use horizontal_plate_mcadams")
        return FilmCoefficient(
            value=0.125 * gas.conductivity * cubed ** (1.0 / 3.0),
            formula="recknagel_plate_turbulent",
            inputs={"temperature_difference": abs(wall - fluid), "film_temperature": gas.temperature}
            | (
                {"length": length, "rayleigh": rayleigh}
                if length is not None and rayleigh is not None
                else {}
            ),
            valid_range="turbulent free convection, Ra > 1e7 (limit assumed)",
            source="Nu = 0.125 Ra^(1/3), candidate for Recknagel (P2 Ref. 29)",
            warnings=warnings,
        )

    def dimensional(wall: float, fluid: float) -> FilmCoefficient:
        difference = abs(wall - fluid)
        return FilmCoefficient(
            value=2.0 * difference**0.25,
            formula="recknagel_plate_dimensional",
            inputs={"temperature_difference": difference},
            valid_range="room air, dT <= 150 K (limit assumed)",
            source="2.0 dT^(1/4), candidate for Recknagel (P2 Ref. 29)",
            warnings=outside("wall - air", difference, 0.0, 150.0, _OTHER_LAW, "K"),
        )

    return turbulent if variant == "turbulent" else dimensional


def vertical_plate_churchill(height: float) -> FilmLaw:
    """Vertical plate of ``height`` [m] in still air (Churchill and Chu 1975, the VDI Heat Atlas too; through ht)."""
    positive("plate height", height, "m")

    def law(wall: float, fluid: float) -> FilmCoefficient:
        from ht.conv_free_immersed import Nu_vertical_plate_Churchill

        gas, cubed = _buoyancy(wall, fluid)
        rayleigh = cubed * height**3
        nusselt = float(Nu_vertical_plate_Churchill(gas.prandtl, rayleigh / gas.prandtl))
        return _from_nusselt(nusselt, height, gas, rayleigh, _VERTICAL_PLATE)

    return law


def horizontal_plate_mcadams(length: float, facing: Facing = "up") -> FilmLaw:
    """Horizontal plate in still air (McAdams, through ht).

    length : characteristic length [m], area over perimeter
    facing : side of the plate the air is on; a warm plate facing up and a cold one facing down stir the air
    """
    from ht.conv_free_immersed import Nu_horizontal_plate_McAdams

    return _horizontal_plate(Nu_horizontal_plate_McAdams, length, facing, _MCADAMS, calm=(1e5, 1e10))


def horizontal_plate_rohsenow(length: float, facing: Facing = "up") -> FilmLaw:
    """Horizontal plate in still air, laminar and turbulent blended (Rohsenow/Hartnett/Cho, through ht).

    length : characteristic length [m], area over perimeter
    facing : side of the plate the air is on. Limits assumed.
    """
    from ht.conv_free_immersed import Nu_horizontal_plate_Rohsenow

    return _horizontal_plate(Nu_horizontal_plate_Rohsenow, length, facing, _ROHSENOW, calm=(1e3, 1e10))


def horizontal_plate_vdi(length: float, facing: Facing = "up") -> FilmLaw:
    """Horizontal plate in still air, form of the VDI Heat Atlas.

    Stirred side: Nu = 0.766 (Ra f2)^(1/5) up to Ra f2 = 7e4, 0.15 (Ra f2)^(1/3) above, with
    f2 = (1 + (0.322/Pr)^(11/20))^(-20/11). Calm side: Nu = 0.6 (Ra f1)^(1/5) with
    f1 = (1 + (0.492/Pr)^(9/16))^(-16/9). Both f are below 1 for any Prandtl number; ht 1.2.0 codes f2 with
    the exponent +20/11 and gets 1.8 times the coefficient in air, so its function is not used.

    length : characteristic length [m], area over perimeter
    facing : side of the plate the air is on
    """
    positive("plate length", length, "m")
    _check_facing(facing)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        gas, cubed = _buoyancy(wall, fluid)
        rayleigh = cubed * length**3
        if (wall >= fluid) == (facing == "up"):
            reduced = rayleigh * (1.0 + (0.322 / gas.prandtl) ** (11.0 / 20.0)) ** (-20.0 / 11.0)
            nusselt = 0.766 * reduced**0.2 if reduced <= 7e4 else 0.15 * reduced ** (1.0 / 3.0)
            limits = (1e3, 1e12)
        else:
            reduced = rayleigh * (1.0 + (0.492 / gas.prandtl) ** (9.0 / 16.0)) ** (-16.0 / 9.0)
            nusselt = 0.6 * reduced**0.2
            limits = (1e3, 1e10)
        return _from_nusselt(nusselt, length, gas, rayleigh, replace(_VDI, limits=limits))

    return law


def horizontal_cylinder_churchill_chu(diameter: float, speed: float = 0.0) -> FilmLaw:
    """Horizontal cylinder at rest in still air (Churchill and Chu 1975, through ht): a shaft that stands.

    diameter : [m]; speed : [rad/s], warned of if not zero
    """
    positive("cylinder diameter", diameter, "m")
    turning = outside("speed", speed, 0.0, 0.0, "use a law for rotating shafts", "rad/s")

    def law(wall: float, fluid: float) -> FilmCoefficient:
        from ht.conv_free_immersed import Nu_horizontal_cylinder_Churchill_Chu

        gas, cubed = _buoyancy(wall, fluid)
        rayleigh = cubed * diameter**3
        nusselt = float(Nu_horizontal_cylinder_Churchill_Chu(gas.prandtl, rayleigh / gas.prandtl))
        film = _from_nusselt(nusselt, diameter, gas, rayleigh, _HORIZONTAL_CYLINDER)
        return replace(film, warnings=film.warnings + turning)

    return law


def iso_tr_14179_2_free(height: float) -> FilmLaw:
    """Free convection of a gear housing after ISO/TR 14179-2: 18 h^-0.1 ((T_w - T_inf)/T_inf)^0.3.

    height : height of the housing [m]. Radiation is not included.
    """
    positive("housing height", height, "m")

    def law(wall: float, fluid: float) -> FilmCoefficient:
        positive("air temperature", fluid, "K")
        difference = abs(wall - fluid)
        return FilmCoefficient(
            value=18.0 * height**-0.1 * (difference / fluid) ** 0.3,
            formula="iso_tr_14179_2_free",
            inputs={"height": height, "temperature_difference": difference, "air_temperature": fluid},
            valid_range="still room air, dT <= 150 K (limit assumed)",
            source="ISO/TR 14179-2:2001, free convection of the housing",
            warnings=outside("wall - air", difference, 0.0, 150.0, _OTHER_LAW, "K"),
        )

    return law


def _buoyancy(wall: float, fluid: float) -> tuple[Air, float]:
    """Air at the film temperature and Ra / L^3 [1/m3]."""
    gas = air(0.5 * (wall + fluid))
    grashof = GRAVITY * gas.expansion * abs(wall - fluid) / gas.kinematic_viscosity**2
    return gas, not_negative("Rayleigh number per cubic metre", grashof * gas.prandtl, "1/m3")


def _from_nusselt(
    nusselt: float, length: float, gas: Air, rayleigh: float, correlation: Correlation
) -> FilmCoefficient:
    low, high = correlation.limits
    still = rayleigh == 0.0
    return FilmCoefficient(
        value=nusselt * gas.conductivity / length,
        formula=correlation.formula,
        inputs={"length": length, "rayleigh": rayleigh, "film_temperature": gas.temperature},
        valid_range=f"{low:g} < Ra < {high:g}",
        source=correlation.source,
        warnings=() if still else outside("Rayleigh number", rayleigh, low, high, _OTHER_LAW),
    )


class _PlateNusselt(Protocol):
    def __call__(self, Pr: float, Gr: float, buoyancy: bool = True) -> float: ...  # noqa: N803 - names of ht


def _horizontal_plate(
    number: _PlateNusselt,
    length: float,
    facing: Facing,
    stirred: Correlation,
    calm: tuple[float, float],
) -> FilmLaw:
    """A plate law Nu(Pr, Gr, buoyancy); ``calm``: limits of Ra on the side that buoyancy does not stir."""
    positive("plate length", length, "m")
    _check_facing(facing)

    def law(wall: float, fluid: float) -> FilmCoefficient:
        gas, cubed = _buoyancy(wall, fluid)
        rayleigh = cubed * length**3
        buoyant = (wall >= fluid) == (facing == "up")
        nusselt = float(number(gas.prandtl, rayleigh / gas.prandtl, buoyancy=buoyant)) if rayleigh else 0.0
        side = stirred if buoyant else replace(stirred, limits=calm)
        return _from_nusselt(nusselt, length, gas, rayleigh, side)

    return law


def _check_facing(facing: str) -> None:
    if facing not in ("up", "down"):
        raise FilmError(
            f"facing = {facing!r} is neither 'up' nor 'down'; say on which side of the plate the air is"
        )
