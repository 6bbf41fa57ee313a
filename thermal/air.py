"""Properties of dry air at one atmosphere.

The equation of state is CoolProp's; as loading its fluids takes seconds, films ask Chebyshev series in ln T that
were fitted to it (`thermal.air_series`) and reproduce it to 2e-7.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebval

from thermal.air_series import SERIES

ATMOSPHERE = 101325.0
"""[Pa]"""
LOWEST, HIGHEST = 200.0, 1000.0
"""Temperatures [K] between which properties are given."""


class AirRangeError(ValueError):
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
    """Air at ``temperature`` [K] and one atmosphere, within 2e-7 of `air_by_equation_of_state`.

    Raises AirRangeError outside 200 to 1000 K.
    """
    _require_range(temperature)
    place = (2.0 * np.log(temperature) - np.log(LOWEST * HIGHEST)) / np.log(HIGHEST / LOWEST)
    density, specific_heat, conductivity, viscosity = np.exp(chebval(place, SERIES)).tolist()
    return Air(
        temperature=temperature,
        density=density,
        specific_heat=specific_heat,
        conductivity=conductivity,
        viscosity=viscosity,
    )


def air_by_equation_of_state(temperature: float) -> Air:
    """The same from CoolProp, HEOS equation of state of Lemmon et al. 2000 (imported when first asked for).

    Raises AirRangeError outside 200 to 1000 K.
    """
    _require_range(temperature)
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


def _require_range(temperature: float) -> None:
    if not LOWEST <= temperature <= HIGHEST:
        raise AirRangeError(
            f"air temperature = {temperature:g} K is outside {LOWEST:g} to {HIGHEST:g} K; check the wall and "
            "ambient temperatures of this film"
        )


@lru_cache(maxsize=1)
def _equation_of_state() -> Any:
    from CoolProp.CoolProp import AbstractState

    return AbstractState("HEOS", "Air")
