"""Parts of an oil circuit: tank, pump, heater, pipe, consumer."""

import math
from dataclasses import dataclass

from rigdesign.base.number_faults import refuse, require_above, require_at_least, require_share


@dataclass(frozen=True, kw_only=True)
class Tank:
    """Tank of a circuit, its oil well mixed.

    volume : most oil it holds [m3]
    fill : oil of the whole circuit at room temperature, that of the lines included [m3]
    suction_minimum : oil in the tank below which the pump draws air [m3]
    wall_conductance : to the room [W/K]
    body_heat_capacity : of what has the temperature of the oil, the steel of the tank [J/K]

    Raises CaseError where the fill is above the volume or not above the suction minimum.
    """

    volume: float
    fill: float
    suction_minimum: float = 0.0
    wall_conductance: float = 0.0
    body_heat_capacity: float = 0.0

    def __post_init__(self) -> None:
        require_above("tank.volume", self.volume, "m3", "give the volume of the tank")
        require_at_least("tank.suction_minimum", self.suction_minimum, "m3", "give 0 if it is not known")
        require_at_least("tank.wall_conductance", self.wall_conductance, "W/K", "give 0 for a lagged tank")
        require_at_least("tank.body_heat_capacity", self.body_heat_capacity, "J/K", "give 0 to leave it out")
        require_above(
            "tank.fill", self.fill, "m3", "fill in more oil than the pump needs", limit=self.suction_minimum
        )
        if self.fill > self.volume:
            refuse(
                "tank.fill",
                f"{1e3 * self.fill:.4g} l",
                f"must be at most the volume of the tank, {1e3 * self.volume:.4g} l",
                "fill in less, or take a larger tank",
            )


@dataclass(frozen=True, kw_only=True)
class Pump:
    """Pump of all lines of a circuit.

    flow : delivered [m3/s]; what the consumers do not take returns over the relief valve
    pressure : rise [Pa]
    efficiency : hydraulic over shaft power [-]
    heat_share : share of the shaft power that ends in the oil [-]; the rest goes to the room

    The hydraulic power is throttled in valves and pipes and heats the oil as the losses of the pump do; what the
    jets of the consumers carry away is heat of the consumers. The rest is counted ahead of the supply temperature:
    10 bar are 0.6 K.
    """

    flow: float
    pressure: float
    efficiency: float
    heat_share: float = 1.0

    def __post_init__(self) -> None:
        require_above("pump.flow", self.flow, "m3/s", "give the flow the pump delivers")
        require_at_least("pump.pressure", self.pressure, "Pa", "give the rise of pressure")
        require_share("pump.efficiency", self.efficiency, "gear pumps have 0.7 to 0.9", zero=False)
        require_share("pump.heat_share", self.heat_share, "give 1 for all heat into the oil")

    @property
    def shaft_power(self) -> float:
        """Flow times pressure over efficiency [W]."""
        return self.flow * self.pressure / self.efficiency

    @property
    def heat_into_oil(self) -> float:
        """With what the jets carry into the consumers [W]."""
        return self.heat_share * self.shaft_power

    @property
    def heat_into_room(self) -> float:
        """[W]"""
        return self.shaft_power - self.heat_into_oil


@dataclass(frozen=True, kw_only=True)
class Heater:
    """Electric heater in the tank.

    power_limit : most power [W]
    setpoint : temperature of the tank it holds [K]
    band : hysteresis of its thermostat [K]: on below setpoint - band/2, off above setpoint + band/2, and always at
        full power; 0 for a heater whose power is controlled continuously
    """

    power_limit: float
    setpoint: float
    band: float = 0.0

    def __post_init__(self) -> None:
        require_at_least("heater.power_limit", self.power_limit, "W", "give the power of its nameplate")
        require_above("heater.setpoint", self.setpoint, "K", "give an absolute temperature")
        require_at_least("heater.band", self.band, "K", "give 0 for continuous control")


@dataclass(frozen=True, kw_only=True)
class Pipe:
    """Pipe between tank and consumers.

    volume : [m3]; wall_conductance : to the room [W/K]

    Over time it is one mixed volume: right for fill times (seconds) that are short against those of the tank.
    """

    volume: float = 0.0
    wall_conductance: float = 0.0

    def __post_init__(self) -> None:
        require_at_least("pipe.volume", self.volume, "m3", "give the volume inside the pipe")
        require_at_least("pipe.wall_conductance", self.wall_conductance, "W/K", "give 0 for a lagged pipe")

    def outlet_conductance(self, capacity_rate: float) -> float:
        """Conductance that, on the temperature at its outlet, gives the loss of a pipe the oil cools along [W/K].

            C (T_in - T_out) = U_out (T_out - T_room) ,    U_out = C (exp(UA/C) - 1)

        capacity_rate : C = m c_p [W/K]; without flow the wall conductance itself
        """
        if capacity_rate <= 0.0:
            return self.wall_conductance
        units = min(self.wall_conductance / capacity_rate, 500.0)
        return capacity_rate * math.expm1(units)


@dataclass(frozen=True, kw_only=True)
class Consumer:
    """What is fed with oil: meshes or bearings of a gearbox.

    flow : at its supply temperature [m3/s]
    holdup : oil that stands in it and drains back when the pump stops [m3]
    jet_power : kinetic energy the oil leaves the nozzles with [W]; the pump gives it, it is heat of the consumer
    """

    name: str
    flow: float
    holdup: float = 0.0
    jet_power: float = 0.0

    def __post_init__(self) -> None:
        require_above(f"{self.name}.flow", self.flow, "m3/s", "feed the consumer, or leave it out")
        require_at_least(f"{self.name}.holdup", self.holdup, "m3", "give 0 if it drains at once")
        require_at_least(f"{self.name}.jet_power", self.jet_power, "W", "give 0 without jets")
