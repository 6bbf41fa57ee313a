"""What further sensors and operating points cost: as the measurement set states, else by their usual ratio."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from statistics import geometric_mean

USUAL_COST: dict[str, float] = {
    "temperature": 1.0,
    "warming_rate": 1.0,
    "oil_outlet_temperature": 1.0,
    "motor_power": 4.0,
    "drive_torque": 4.0,
    "torque": 8.0,
    "angle": 4.0,
    "natural_frequency": 3.0,
    "backlash": 1.0,
    "seal_gap": 6.0,
    "acceleration": 3.0,
    "shaft_displacement": 6.0,
    "resonance_speed": 4.0,
    "root_strain": 8.0,
    "operating_point": 1.0,
    "oil_flow": 1.0,
    "inlet_temperature": 1.5,
    "reassembly": 5.0,
}
"""Of a sensor by its quantity, of a further point by what is changed for it; relative to one thermocouple."""


@dataclass(frozen=True, kw_only=True)
class Costs:
    """Costs of sensors and points.

    stated : by item, in any one unit; all others keep their usual ratio to these
    """

    stated: Mapping[str, float] = field(default_factory=dict)

    def of(self, item: str) -> float:
        """Of one sensor or point, in the unit of the stated costs, else relative to one thermocouple."""
        return self.stated.get(item, self._thermocouple * USUAL_COST[item])

    @property
    def _thermocouple(self) -> float:
        """As stated, else the geometric mean of what the stated items say of it."""
        if "temperature" in self.stated:
            return self.stated["temperature"]
        ratios = [value / USUAL_COST[item] for item, value in self.stated.items()]
        return geometric_mean(ratios) if ratios else 1.0
