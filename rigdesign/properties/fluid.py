"""Density and heat capacity of fluids that are no lubricants, from CoolProp."""

from functools import lru_cache

from rigdesign.base.units import celsius

ATMOSPHERE = 101325.0
"""[Pa]"""


class FluidError(ValueError):
    """A fluid without properties at a temperature and pressure."""


@lru_cache(maxsize=64)
def volumetric_heat(fluid: str, temperature: float, pressure: float = ATMOSPHERE) -> tuple[float, float]:
    """Density [kg/m3] and specific heat [J/(kg K)] of a gas or liquid by its name in CoolProp.

    temperature : [K]; pressure : absolute [Pa]
    Raises FluidError for a fluid CoolProp does not know, or that has no properties there.
    """
    from CoolProp.CoolProp import PropsSI

    try:
        density, heat = (float(PropsSI(key, "T", temperature, "P", pressure, fluid)) for key in ("D", "C"))
    except ValueError as error:
        raise FluidError(
            f"is neither an oil nor has CoolProp properties of it at {celsius(temperature)} and "
            f"{1e-5 * pressure:.3g} bar ({error})"
        ) from error
    return density, heat
