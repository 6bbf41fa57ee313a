"""Fluids of a housing besides its oil and room air: volumes of one temperature, streams, and what links them.

A film of ``boundary`` names one of them as its fluid. Their temperatures are unknowns of the temperature field.
"""

from pydantic import model_validator

from rigdesign.case.fields import Conductance, Flow, Name, Part, Power, Pressure, Temperature, Text, fault
from rigdesign.properties.fluid import ATMOSPHERE

LINKED = ("ambient", "gear_oil", "bearing_oil")
"""What a volume may be linked to besides other volumes: room air, the oils as they leave the chamber."""


class HousingVolume(Part):
    """Air, mist or oil at rest in the housing, of one temperature that follows from its films, links and power."""

    power: Power = 0.0
    """Heat set free in it."""


class HousingStream(Part):
    """A stream along surfaces of the housing that warms up on its way (plug flow): jacket, oil gallery, air duct.

    Over time it runs through all phases, warm-up and cooling down included.
    """

    flow: Flow
    """Volume flow at the inlet."""
    inlet_temperature: Temperature
    """As it enters."""
    medium: Text
    """Oil of the case, or a fluid by its name in CoolProp, such as ``Water`` or ``Air``."""
    pressure: Pressure = ATMOSPHERE
    """Absolute, for a fluid of CoolProp."""
    surfaces: tuple[Text, ...] = ()
    """Its surfaces in the order in which it passes them; that of ``boundary`` when left out."""


class HousingLink(Part):
    """Heat exchange between a volume and another volume, room air or an oil."""

    between: tuple[Name, Name]
    """Two volumes, or a volume and ``ambient``, ``gear_oil`` or ``bearing_oil`` (as they leave the chamber)."""
    conductance: Conductance | None = None
    """Heat per kelvin between the two."""
    flow: Flow | None = None
    """In place of it: volume flow that goes each way, as of a breather or an opening, at room temperature."""
    medium: Text | None = None
    """What flows: oil of the case, or a fluid by its name in CoolProp; needed with ``flow``."""

    @model_validator(mode="after")
    def _conducts(self) -> "HousingLink":
        if (self.conductance is None) == (self.flow is None):
            raise fault(
                "needs either a conductance or a flow",
                'write conductance = "5 W/K", or flow with its medium',
            )
        if (self.flow is None) != (self.medium is None):
            raise fault("flow and medium go together", 'write both, e.g. medium = "Air"')
        return self
