"""Oils of the virtual rig: viscosity through two points of its chart, density, heat capacity, conductivity linear."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

ZERO = 273.15


@dataclass(frozen=True, kw_only=True)
class OilData:
    """Data sheet of one oil: nu [m2/s] at 40 and 100 degC, the rest at 40 degC and per kelvin (relative)."""

    nu_40: float
    nu_100: float
    density: float
    heat_capacity: float
    conductivity: float
    density_slope: float = -7.0e-4
    heat_capacity_slope: float = 1.2e-3
    conductivity_slope: float = -6e-4
    lubricant_factor: float = 1.0
    air: float = 0.0
    """Share of the volume that is air, 0 to below 1."""

    def nu(self, temperature: float) -> float:
        """Kinematic viscosity [m2/s] at a temperature [K]: Walther's double logarithm with 0.8."""
        low, high = _twice(self.nu_40), _twice(self.nu_100)
        share = math.log(temperature / (ZERO + 40.0)) / math.log((ZERO + 100.0) / (ZERO + 40.0))
        return (10.0**10.0 ** (low + share * (high - low)) - 0.8) * 1e-6

    def rho(self, temperature: float) -> float:
        """Density of what is pumped, air included [kg/m3]."""
        return (1.0 - self.air) * self._liquid(temperature)

    def eta(self, temperature: float) -> float:
        """Dynamic viscosity [Pa s]; bubbles thicken a little (Einstein's 1 + phi for soft ones)."""
        return self.nu(temperature) * self._liquid(temperature) * (1.0 + self.air)

    def cp(self, temperature: float) -> float:
        """Heat capacity [J/(kg K)]."""
        return self.heat_capacity * (1.0 + self.heat_capacity_slope * (temperature - ZERO - 40.0))

    def k(self, temperature: float) -> float:
        """Conductivity [W/(m K)]; bubbles insulate (Maxwell)."""
        liquid = self.conductivity * (1.0 + self.conductivity_slope * (temperature - ZERO - 40.0))
        return liquid * (1.0 - self.air) / (1.0 + 0.5 * self.air)

    def changed(self, *, viscosity: float = 1.0, index: float = 1.0, density: float = 1.0, heat_capacity: float = 1.0,
                conductivity: float = 1.0, air: float = 0.0) -> "OilData":  # fmt: skip
        """The oil with factors on its data (``index``: on the fall from 40 to 100 degC) and with air in it."""
        nu_40 = self.nu_40 * viscosity
        nu_100 = nu_40 * (self.nu_100 / self.nu_40) ** index
        return replace(
            self, nu_40=nu_40, nu_100=nu_100, density=self.density * density, air=air,
            heat_capacity=self.heat_capacity * heat_capacity, conductivity=self.conductivity * conductivity,
        )  # fmt: skip

    def _liquid(self, temperature: float) -> float:
        return self.density * (1.0 + self.density_slope * (temperature - ZERO - 40.0))


OILS: Mapping[str, OilData] = {
    "MIL-PRF-23699": OilData(
        nu_40=27.6e-6, nu_100=5.1e-6, density=982.0, heat_capacity=1920.0, conductivity=0.149, lubricant_factor=0.8
    ),
    "FVA 3": OilData(
        nu_40=99.4e-6, nu_100=10.99e-6, density=885.0, heat_capacity=1990.0, conductivity=0.132,
        density_slope=-6.2e-4, heat_capacity_slope=1.5e-3,
    ),
    "FVA 3A": OilData(
        nu_40=95e-6, nu_100=10.7e-6, density=869.0, heat_capacity=1990.0, conductivity=0.132,
        density_slope=-6.5e-4, heat_capacity_slope=1.5e-3,
    ),
}  # fmt: skip
"""Typical data sheets; the case gives the name of its oil only."""


def oil_of(tree: Mapping[str, Any], name: str) -> OilData:
    """Oil of a case by name: built in, or the case's own ``oils`` table."""
    if name in OILS:
        return OILS[name]
    own = tree["oils"][name]
    return OilData(
        nu_40=own["viscosity_40"], nu_100=own["viscosity_100"], density=own.get("density_15", 880.0) * 0.98,
        heat_capacity=own.get("heat_capacity", 1950.0), conductivity=own.get("conductivity", 0.13),
        lubricant_factor=own.get("lubricant_factor", 1.0),
    )  # fmt: skip


def _twice(nu: float) -> float:
    return math.log10(math.log10(nu * 1e6 + 0.8))
