"""Heat in a mass or a flow of oil, and the temperature that belongs to it.

With c_p linear in temperature (`Oil.heat_capacity`) the enthalpy above 40 degC is

    h(T) = c_40 x + s x^2 / 2 ,    x = T - 313.15 K ,

so that between two temperatures it is c_p at their mean times their difference, as `oil_outlet` has it.
"""

import math
from dataclasses import dataclass

from rigdesign.base.quantity_kinds import ZERO_CELSIUS
from rigdesign.properties.oil import Oil

REFERENCE = ZERO_CELSIUS + 40.0
"""Temperature above which heat is counted [K]."""


def enthalpy(oil: Oil, temperature: float) -> float:
    """Specific enthalpy above 40 degC [J/kg] at a temperature [K]."""
    above = temperature - REFERENCE
    return above * (oil.heat_capacity_40 + 0.5 * oil.heat_capacity_slope * above)


def temperature_at(oil: Oil, specific_enthalpy: float) -> float:
    """Temperature [K] at a specific enthalpy above 40 degC [J/kg]."""
    return HeatContent(oil=oil, mass=1.0).temperature(specific_enthalpy)


@dataclass(frozen=True, kw_only=True)
class HeatContent:
    """Oil and a body of its temperature: the content mass h(T) + body (T - 40 degC).

    mass : [kg], or a mass flow [kg/s]; body : heat capacity [J/K], or a conductance [W/K]
    """

    oil: Oil
    mass: float
    body: float = 0.0

    def at(self, temperature: float) -> float:
        """Content above 40 degC [J or W] at a temperature [K]."""
        return self.mass * enthalpy(self.oil, temperature) + self.body * (temperature - REFERENCE)

    def temperature(self, content: float) -> float:
        """Temperature [K] at a content above 40 degC [J or W]; closed form of the quadratic."""
        linear = self.mass * self.oil.heat_capacity_40 + self.body
        slope = self.mass * self.oil.heat_capacity_slope
        root = math.sqrt(max(linear**2 + 2.0 * slope * content, 0.0))
        return REFERENCE + 2.0 * content / (linear + root)
