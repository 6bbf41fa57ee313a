"""What a film law is: a coefficient with its provenance, from the temperatures on both sides."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from thermal.errors import ThermalInputError

STEFAN_BOLTZMANN = 5.670374419e-8
"""Stefan-Boltzmann constant [W/(m2 K4)], CODATA 2018."""


@dataclass(frozen=True, kw_only=True)
class FilmCoefficient:
    """A heat transfer coefficient with its provenance; what the report prints with every film."""

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
    radiation_included: bool = False
    """The coefficient is of the size of convection and radiation together."""


@dataclass(frozen=True)
class Correlation:
    """A published correlation of a dimensionless number.

    formula : its name; limits : of the number it depends on; source : document and equation
    """

    formula: str
    limits: tuple[float, float]
    source: str


FilmLaw = Callable[[float, float], FilmCoefficient]
"""Coefficient from (area-mean wall temperature [K], fluid temperature [K])."""

ExchangeLaw = Callable[[float, float], FilmCoefficient]
"""Coefficient from the area-mean temperatures of the two surfaces [K]; refers to the area of the first."""


# What every film law does with its inputs: refuse the impossible, warn outside a correlation's range.


class FilmError(ThermalInputError):
    """An input no film law can take; the message names quantity, value, limit and remedy."""


def positive(quantity: str, value: float, unit: str) -> float:
    """``value``, if it is a finite number above zero; FilmError otherwise."""
    if not (math.isfinite(value) and value > 0.0):
        raise FilmError(f"{quantity} = {value} {unit} must be greater than 0; give a positive number")
    return value


def not_negative(quantity: str, value: float, unit: str) -> float:
    """``value``, if it is a finite number, zero included; FilmError otherwise."""
    if not (math.isfinite(value) and value >= 0.0):
        raise FilmError(f"{quantity} = {value} {unit} must not be negative; give 0 or more")
    return value


def outside(
    quantity: str, value: float, low: float, high: float, remedy: str, unit: str = ""
) -> tuple[str, ...]:
    """A warning if ``value`` lies outside the closed range, nothing otherwise."""
    if low <= value <= high:
        return ()
    tail = f" {unit}" if unit else ""
    return (f"{quantity} = {value:.4g}{tail} is outside {low:g} to {high:g}{tail}; {remedy}",)
