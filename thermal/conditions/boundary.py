"""What happens at the named surfaces and in the named bodies of a housing.

Every entry names its surface; a surface may carry several entries (film and radiation, say) but must carry
at least one, ``Adiabatic`` included: `conduction.solve_steady` refuses a mesh with a surface left open.
All temperatures in kelvin, all powers in watt, positive into the solid.
"""

from collections.abc import Callable
from dataclasses import dataclass

STEFAN_BOLTZMANN = 5.670374419e-8
"""Stefan-Boltzmann constant [W/(m2 K4)], CODATA 2018."""


class ConditionError(ValueError):
    """A condition that cannot be computed; the message names place, value, limit and remedy."""


@dataclass(frozen=True, kw_only=True)
class FilmCoefficient:
    """A heat transfer coefficient with its provenance; what the report prints beside every film."""

    value: float
    """[W/(m2 K)] at the temperatures given in ``inputs``."""
    formula: str
    """Name of the correlation, e.g. ``niemann_winter``."""
    inputs: dict[str, float]
    """Every number that entered, SI, by field name."""
    valid_range: str
    """Range of the correlation in words, e.g. ``800 < Re < 4e5``."""
    source: str
    """Document and equation."""
    warnings: tuple[str, ...] = ()
    """One sentence per input outside the range: name, value, limit, remedy."""


FilmLaw = Callable[[float, float], FilmCoefficient]
"""Coefficient from (area-mean wall temperature [K], fluid temperature [K])."""

ExchangeLaw = Callable[[float, float], FilmCoefficient]
"""Coefficient from the area-mean temperatures of the two surfaces [K]; refers to the area of the first."""


@dataclass(frozen=True, kw_only=True)
class Film:
    """Convection from a surface to a fluid: q = h(T_mean, T_fluid) (T_fluid - T)."""

    surface: str
    kind: str
    """Row name in the heat balance: ``air``, ``oil``, ``bearing_film`` ..."""
    fluid_temperature: float
    law: FilmLaw


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
