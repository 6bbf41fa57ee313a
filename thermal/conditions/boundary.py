"""What happens at the named surfaces and in the named bodies of a housing.

Every entry names its surface; a surface may carry several entries (film and radiation, say) but must carry
at least one, ``Adiabatic`` included: `conduction.solve_steady` refuses a mesh with a surface left open.
All temperatures in kelvin, all powers in watt, positive into the solid.
"""

from dataclasses import dataclass

from thermal.errors import ThermalInputError
from thermal.films.law import ExchangeLaw, FilmCoefficient, FilmLaw


class ConditionError(ThermalInputError):
    """A condition that cannot be computed; the message names place, value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class Film:
    """Convection from a surface to a fluid: q = h(T_mean, T_fluid) (T_fluid - T)."""

    surface: str
    kind: str
    """Row name in the heat balance: ``air``, ``oil``, ``bearing_film`` ..."""
    fluid_temperature: float
    law: FilmLaw

    def coefficient_at(self, wall_excess: float) -> FilmCoefficient:
        """Coefficient with the wall ``wall_excess`` [K] above the fluid."""
        return self.law(self.fluid_temperature + wall_excess, self.fluid_temperature)


@dataclass(frozen=True, kw_only=True)
class Radiation:
    """Grey radiation to large surroundings: q = eps sigma (T_s^4 - T^4)."""

    surface: str
    emissivity: float
    """0 to 1; negative where it takes back radiation that a film on the surface holds."""
    surroundings_temperature: float
    kind: str = "radiation"


@dataclass(frozen=True, kw_only=True)
class Exchange:
    """Heat between two surfaces by their area means: Q = h A_a (mean T_b - mean T_a) into surface a."""

    surface_a: str
    surface_b: str
    kind: str
    law: ExchangeLaw


@dataclass(frozen=True, kw_only=True)
class PrescribedTemperature:
    """A surface held at one temperature; its heat is the residual reaction."""

    surface: str
    temperature: float
    kind: str = "prescribed_temperature"


@dataclass(frozen=True, kw_only=True)
class SurfaceSource:
    """A power spread evenly over a surface (friction heat on flanks, seal lips)."""

    surface: str
    power: float
    kind: str


@dataclass(frozen=True, kw_only=True)
class BodySource:
    """A power spread evenly over a body."""

    body: str
    power: float
    kind: str


@dataclass(frozen=True, kw_only=True)
class Adiabatic:
    """A surface stated to pass no heat."""

    surface: str


BoundaryCondition = (
    Film | Radiation | Exchange | PrescribedTemperature | SurfaceSource | BodySource | Adiabatic
)
