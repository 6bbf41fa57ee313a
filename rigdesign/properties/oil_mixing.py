"""Oil flows that meet: each knows how it was fed and what heat it has taken up since."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rigdesign.properties.oil import Oil, OilError


@dataclass(frozen=True, kw_only=True)
class Portion:
    """An oil flow on its way: how it was fed, and the heat it has taken up since."""

    oil: Oil
    inlet: float
    """[K]"""
    flow: float
    """[m3/s], at the inlet."""
    heat: float = 0.0
    """[W]"""

    def capacity(self, temperature: float) -> float:
        """Mean heat capacity flow between inlet and a temperature [W/K]."""
        mean = 0.5 * (self.inlet + temperature)
        return self.oil.density(self.inlet) * self.flow * self.oil.heat_capacity(mean)

    def heat_at(self, temperature: float) -> float:
        """Heat with which it has a temperature [W]."""
        return self.capacity(temperature) * (temperature - self.inlet)

    def warmed(self, temperature: float) -> "Portion":
        """The same at a temperature [K]."""
        return replace(self, heat=self.heat_at(temperature))


def mixed(portions: Sequence[Portion], heat: float = 0.0) -> float:
    """Temperature of oil flows that meet and take up ``heat`` [W] together [K]: the sum of heats is kept."""
    whole = heat + math.fsum(portion.heat for portion in portions)
    temperature = math.fsum(portion.inlet for portion in portions) / len(portions)
    for _ in range(100):
        capacities = [portion.capacity(temperature) for portion in portions]
        fed = math.fsum(c * portion.inlet for c, portion in zip(capacities, portions))
        better = (whole + fed) / math.fsum(capacities)
        if abs(better - temperature) < 1e-10:
            return better
        temperature = better
    raise OilError(f"oil streams that mix under {whole:.4g} W find no temperature; correct flows or heat")
