"""What a steady balance of an oil circuit gives."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rigdesign.oil_circuit.circuit import Circuit
from rigdesign.oil_circuit.line_balance import LineBalance


@dataclass(frozen=True, kw_only=True)
class ConsumerOil:
    """Oil of one consumer."""

    supply: float
    """[K]"""
    return_: float
    """[K]"""
    mass_flow: float
    """[kg/s]"""
    heat: float
    """Taken up [W]."""


@dataclass(frozen=True, kw_only=True)
class DeviceLoad:
    """Heater or cooler: what it gives, what its setpoint needs, and what it can do there [W]."""

    power: float
    needed: float
    capability: float

    @property
    def margin(self) -> float:
        """Capability less need [W]; negative where the setpoint is not held."""
        return self.capability - self.needed


@dataclass(frozen=True, kw_only=True)
class SteadyCircuit:
    """A circuit in balance."""

    circuit: Circuit
    tank_temperature: float
    """[K]"""
    lines: Mapping[str, LineBalance]
    consumers: Mapping[str, ConsumerOil]
    heater: DeviceLoad | None
    """Need and capability at its setpoint."""
    tank_cooler: DeviceLoad | None
    """Need and capability at its setpoint."""
    line_coolers: Mapping[str, DeviceLoad]
    """Line -> need and capability at the temperature of the tank as it is."""
    trim_heaters: Mapping[str, DeviceLoad]
    pump_heat: float
    """Into the oil of the circuit, without what the jets carry into the consumers [W]."""
    room_loss: float
    """Of tank and pipes, and of the pump what the oil does not take [W]."""
    imbalance: float
    """What the balance of the whole circuit leaves open [W]."""
    warnings: tuple[str, ...]
    machine_heat: float = 0.0
    """Into the tank from what is cooled with its oil and is no consumer [W]."""

    @property
    def pump_to_room(self) -> float:
        """Heat of the pump that its oil does not take [W]."""
        pump = self.circuit.pump
        return pump.heat_into_room if pump else 0.0

    @property
    def wall_loss(self) -> float:
        """Of tank and pipes to the room [W]."""
        return self.room_loss - self.pump_to_room

    @property
    def heater_power(self) -> float:
        """Of tank and lines [W]."""
        tank = self.heater.power if self.heater else 0.0
        return tank + math.fsum(load.power for load in self.trim_heaters.values())

    @property
    def cooler_heat(self) -> float:
        """Of tank and lines [W]."""
        tank = self.tank_cooler.power if self.tank_cooler else 0.0
        return tank + math.fsum(load.power for load in self.line_coolers.values())

    def supply_margin(self, line: str) -> float | None:
        """Tolerance less distance from the setpoint [K]; negative where it is not held, None without a setpoint."""
        given = next(each for each in self.circuit.lines if each.name == line)
        if given.setpoint is None:
            return None
        return given.tolerance - abs(self.lines[line].supply - given.setpoint)
