"""Properties of dry air at one atmosphere, from CoolProp (imported when first asked for)."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from thermal.errors import ThermalInputError

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
