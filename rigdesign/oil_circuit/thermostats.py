"""On-off thermostats of a tank: when they switch next, and what they force while they do not."""

import math
from dataclasses import dataclass, replace
from typing import Literal

from rigdesign.oil_circuit.circuit import Circuit
from rigdesign.oil_circuit.tank_balance import Setpoints

Device = Literal["heater", "tank_cooler"]
EDGE = 1e-6
"""Distance from a threshold that counts as standing there [K]."""


@dataclass(frozen=True, kw_only=True)
class Thermostat:
    """An on-off device of the tank.

    threshold : temperature of the tank at which it switches next [K]
    sign : 1 where that is passed upwards, -1 downwards
    """

    device: Device
    threshold: float
    sign: float

    def passed(self, temperature: float) -> float:
        """Distance by which a temperature is beyond the threshold [K]; negative before it."""
        return self.sign * (temperature - self.threshold)


def thermostats(circuit: Circuit, on: frozenset[Device]) -> list[Thermostat]:
    """Heater and tank cooler as far as they have a band; ``on``: those that work."""
    found = []
    heater, cooler = circuit.heater, circuit.tank_cooler
    if heater and heater.band:
        sign = 1.0 if "heater" in on else -1.0
        found.append(
            Thermostat(device="heater", threshold=heater.setpoint + 0.5 * sign * heater.band, sign=sign)
        )
    if cooler and cooler.band:
        sign = -1.0 if "tank_cooler" in on else 1.0
        threshold = cooler.setpoint + 0.5 * sign * cooler.band
        found.append(Thermostat(device="tank_cooler", threshold=threshold, sign=sign))
    return found


def switched(circuit: Circuit, on: frozenset[Device], temperature: float) -> frozenset[Device]:
    """Devices that work once the thermostats have met a temperature of the tank [K]."""
    return on ^ {each.device for each in thermostats(circuit, on) if each.passed(temperature) > EDGE}


def forced_setpoints(circuit: Circuit, on: frozenset[Device]) -> Setpoints:
    """Setpoints of continuous control; infinite ones for on-off devices, as their thermostats stand."""
    given = Setpoints.of(circuit)
    if circuit.heater and circuit.heater.band:
        given = replace(given, heater=math.inf if "heater" in on else -math.inf)
    if circuit.tank_cooler and circuit.tank_cooler.band:
        given = replace(given, cooler=-math.inf if "tank_cooler" in on else math.inf)
    return given
