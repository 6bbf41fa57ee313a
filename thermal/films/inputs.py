"""What every film law does with its inputs: refuse the impossible, warn outside a correlation's range."""

import math

from thermal.errors import ThermalInputError


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
