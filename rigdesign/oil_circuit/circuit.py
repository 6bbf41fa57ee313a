"""An oil circuit: one oil, one tank, and the lines that feed its consumers.

    tank (heater, tank cooler) -> pump -> line: cooler with bypass -> trim heater -> supply pipe -> consumers
      ^                                                                                             |
      +--------------------------------- tank cooler in the return  <- return pipe <----------------+

Each line has a supply temperature of its own, so one tank feeds a warm and a cold supply.
"""

import math
from dataclasses import dataclass

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import celsius, refuse, require_above, require_at_least
from rigdesign.oil_circuit.parts import Consumer, Cooler, Heater, Pipe, Pump, Tank, TankCooler
from rigdesign.properties.oil import Oil

NO_PIPE = Pipe()
"""No oil, no loss."""


@dataclass(frozen=True, kw_only=True)
class SupplyLine:
    """Consumers fed at one temperature.

    setpoint : supply temperature [K] that valve and trim heater hold where they stand, ahead of the supply pipe; None
        for oil as the pump gives it
    tolerance : of the supply temperature at the consumers, to either side [K]
    hard : whether a setpoint that cannot be held is an error; else it is a result
    cooler : with a three-way valve that mixes cooled and bypassed oil to the setpoint
    valve_band : proportional band of that valve [K]: shut at setpoint - band/2, no oil past the cooler at
        setpoint + band/2; 0 for a controlled valve that holds the setpoint
    trim_power_limit : most power of a heater of the line [W], controlled continuously
    """

    name: str
    consumers: tuple[Consumer, ...]
    setpoint: float | None = None
    tolerance: float = 1.0
    hard: bool = False
    cooler: Cooler | None = None
    valve_band: float = 0.0
    trim_power_limit: float = 0.0
    supply_pipe: Pipe = NO_PIPE
    return_pipe: Pipe = NO_PIPE

    def __post_init__(self) -> None:
        key = f"lines.{self.name}"
        if not self.consumers:
            refuse(
                f"{key}.consumers",
                "none",
                "must feed at least one",
                "name its consumers, or leave the line out",
            )
        for name, unit in (("tolerance", "K"), ("valve_band", "K"), ("trim_power_limit", "W")):
            require_at_least(f"{key}.{name}", getattr(self, name), unit, "give 0 for none")
        if self.setpoint is not None:
            require_above(f"{key}.setpoint", self.setpoint, "K", "give an absolute temperature")
        elif self.cooler or self.trim_power_limit or self.hard:
            refuse(
                f"{key}.setpoint",
                "",
                "is missing, and cooler, trim heater or a hard limit need it",
                "give the supply temperature, or put cooler and heater at the tank",
            )
        if self.valve_band and self.trim_power_limit:
            refuse(
                f"{key}.valve_band",
                f"{self.valve_band:.4g} K",
                "must be 0 with a trim heater, which would heat what the valve cools within its band",
                "leave out the band or the trim heater",
            )

    @property
    def flow(self) -> float:
        """Of all consumers [m3/s], at the supply temperature."""
        return math.fsum(consumer.flow for consumer in self.consumers)

    @property
    def jet_power(self) -> float:
        """Kinetic energy of the jets of all consumers [W]."""
        return math.fsum(consumer.jet_power for consumer in self.consumers)

    @property
    def volume(self) -> float:
        """Oil in pipes and consumers while the pump runs [m3]."""
        return math.fsum(
            (
                self.supply_pipe.volume,
                self.return_pipe.volume,
                *(consumer.holdup for consumer in self.consumers),
            )
        )


@dataclass(frozen=True, kw_only=True)
class Circuit:
    """Oil, tank and lines.

    oil : in its state in the circuit
    lines : at least one; names of lines and of consumers are unique
    room_temperature : round tank, pipes and pump [K]

    Raises CaseError for a tank that runs dry with the lines full, for consumers that take more than the pump gives,
    for jets faster than the pressure of the pump makes them, and where heater and cooler of the tank would work against
    each other.
    """

    name: str
    oil: Oil
    tank: Tank
    lines: tuple[SupplyLine, ...]
    pump: Pump | None = None
    heater: Heater | None = None
    tank_cooler: TankCooler | None = None
    room_temperature: float = 293.15

    def __post_init__(self) -> None:
        faults = [*self._names(), *self._flows(), *self._jets(), *self._level(), *self._thermostats()]
        if faults:
            raise CaseError(faults, f"oil circuit {self.name}")

    @property
    def flow(self) -> float:
        """Of all lines [m3/s]."""
        return math.fsum(line.flow for line in self.lines)

    @property
    def consumers(self) -> tuple[Consumer, ...]:
        """Of all lines."""
        return tuple(consumer for line in self.lines for consumer in line.consumers)

    @property
    def running_fill(self) -> float:
        """Oil left in the tank while pipes and consumers are full [m3], at room temperature."""
        return self.tank.fill - math.fsum(line.volume for line in self.lines)

    def line_pump_heat(self, line: SupplyLine) -> float:
        """Heat of the pump in the oil of a line [W], by its share of the flow and less what its jets carry away."""
        return self.pump.heat_into_oil * line.flow / self.pump.flow - line.jet_power if self.pump else 0.0

    @property
    def pump_heat(self) -> float:
        """Heat of the pump in the oil of the circuit [W]: not what the jets carry into the consumers."""
        return (
            self.pump.heat_into_oil - math.fsum(line.jet_power for line in self.lines) if self.pump else 0.0
        )

    @property
    def relief_heat(self) -> float:
        """Heat of the pump in the oil that goes back to the tank over the relief valve [W]."""
        return self.pump.heat_into_oil * (1.0 - self.flow / self.pump.flow) if self.pump else 0.0

    def _names(self) -> list[Fault]:
        faults = []
        for kind, names in (
            ("lines", [line.name for line in self.lines]),
            ("consumers", [consumer.name for consumer in self.consumers]),
        ):
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:
                faults.append(Fault(kind, ", ".join(twice), "must occur once", "rename one"))
        if not self.lines:
            faults.append(Fault("lines", "none", "must be at least one", "name what the circuit feeds"))
        return faults

    def _flows(self) -> list[Fault]:
        if self.pump is None or self.flow <= self.pump.flow * (1.0 + 1e-9):
            return []
        return [
            Fault(
                "pump.flow",
                f"{6e4 * self.pump.flow:.4g} l/min",
                f"must be at least the {6e4 * self.flow:.4g} l/min of all consumers",
                "take a larger pump, or feed less",
            )
        ]

    def _jets(self) -> list[Fault]:
        if self.pump is None:
            return []
        needed = max((each.jet_power / each.flow for each in self.consumers), default=0.0)
        if self.pump.pressure >= needed:
            return []
        return [
            Fault(
                "pump.pressure",
                f"{1e-5 * self.pump.pressure:.4g} bar",
                f"must be at least the {1e-5 * needed:.3g} bar that the velocity of the jets takes (rho v^2 / 2)",
                "give the pressure of the pump, or the velocity that the jets have with it",
            )
        ]

    def _level(self) -> list[Fault]:
        if self.running_fill > self.tank.suction_minimum:
            return []
        return [
            Fault(
                "tank.fill",
                f"{1e3 * self.tank.fill:.4g} l",
                f"pipes and consumers hold {1e3 * (self.tank.fill - self.running_fill):.4g} l, which leaves "
                f"{1e3 * self.running_fill:.4g} l in the tank; the pump needs more than "
                f"{1e3 * self.tank.suction_minimum:.4g} l (suction_minimum), else it runs dry",
                "fill in more, or take a larger tank",
            )
        ]

    def _thermostats(self) -> list[Fault]:
        heater, cooler = self.heater, self.tank_cooler
        if heater is None or cooler is None:
            return []
        warmest, coldest = heater.setpoint + 0.5 * heater.band, cooler.setpoint - 0.5 * cooler.band
        if warmest < coldest:
            return []
        return [
            Fault(
                "heater.setpoint",
                celsius(heater.setpoint),
                f"with its band must be below {celsius(coldest)}, where the cooler of the tank ends; both would work "
                "against each other",
                "lower the setpoint of the heater, or raise that of the cooler",
            )
        ]
