"""An oil circuit: one oil, one tank, and the lines that feed its consumers.

    tank (heater, tank cooler) -> pump -> line: cooler with bypass -> trim heater -> supply pipe -> consumers
      ^                                                                                             |
      +--------------------------------- tank cooler in the return  <- return pipe <----------------+

Each line has a supply temperature of its own, so one tank feeds a warm and a cold supply.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Literal, Self

from rigdesign.base.errors import CaseError, Fault
from rigdesign.base.units import ZERO_CELSIUS, celsius, refuse, require_above, require_at_least, require_share
from rigdesign.properties.oil import Oil

# Parts of an oil circuit: tank, pump, heater, pipe, consumer.


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


# Heat in a mass or a flow of oil, and the temperature that belongs to it.
#
# With c_p linear in temperature (`Oil.heat_capacity`) the enthalpy above 40 degC is
#
#     h(T) = c_40 x + s x^2 / 2 ,    x = T - 313.15 K ,
#
# so that between two temperatures it is c_p at their mean times their difference, as `oil_outlet` has it.

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


# Oil coolers by effectiveness and number of transfer units.
#
#     Q = eps(NTU, C_r) C_min (T_oil - T_coolant) ,    NTU = UA / C_min ,    C_r = C_min / C_max
#
# eps by `ht.hx.effectiveness_from_NTU` (Bergman, Lavine, Incropera, DeWitt, 6th ed., tables 11.3 and 11.4; Shah and
# Sekulic 2002). UA is constant: a cooler with less oil than at its rated point (bypass half open) has less, so the
# share of the bypass is approximate; what it carries with the bypass shut is that of the rated point.

Arrangement = Literal["counterflow", "parallel", "crossflow approximate", "S&T"]
"""Flows against each other; S&T: one shell pass, two or more tube passes."""


@dataclass(frozen=True, kw_only=True)
class Coolant:
    """What takes the heat of a cooler.

    flow : at the inlet [m3/s]; inlet_temperature : [K]
    fluid : name in CoolProp, such as ``Water`` or ``INCOMP::MEG[0.3]``; pressure : absolute [Pa]

    Raises CaseError for a fluid CoolProp does not know, or that is no liquid at the inlet.
    """

    flow: float
    inlet_temperature: float
    fluid: str = "Water"
    pressure: float = 3e5

    def __post_init__(self) -> None:
        require_above("coolant.flow", self.flow, "m3/s", "open the coolant, or leave the cooler out")
        require_above(
            "coolant.inlet_temperature", self.inlet_temperature, "K", "give an absolute temperature"
        )
        require_above("coolant.pressure", self.pressure, "Pa", "give the absolute pressure")

    @cached_property
    def capacity_rate(self) -> float:
        """Heat that warms it by one kelvin, with properties at the inlet [W/K]."""
        density, heat_capacity = _liquid(self.fluid, self.inlet_temperature, self.pressure)
        return density * heat_capacity * self.flow

    @cached_property
    def boiling_temperature(self) -> float | None:
        """[K]; None for mixtures, of which CoolProp has no vapour pressure."""
        return None if self.fluid.startswith("INCOMP::") else _boiling(self.fluid, self.pressure)


@dataclass(frozen=True, kw_only=True)
class RatedPoint:
    """Point of a cooler's data sheet.

    heat : carried [W]; flow : of oil, at its inlet [m3/s]; inlet_temperature : of the oil [K]
    """

    oil: Oil
    heat: float
    flow: float
    inlet_temperature: float


@dataclass(frozen=True, kw_only=True)
class Cooler:
    """Heat exchanger from oil to a coolant.

    conductance : UA, overall coefficient times area [W/K]
    """

    conductance: float
    coolant: Coolant
    arrangement: Arrangement = "counterflow"

    def __post_init__(self) -> None:
        require_above("cooler.conductance", self.conductance, "W/K", "give UA, or a rated point")

    @classmethod
    def from_rated_point(
        cls, rated: RatedPoint, coolant: Coolant, arrangement: Arrangement = "counterflow"
    ) -> Self:
        """Cooler that carries ``rated.heat`` with the coolant it is rated with.

        Raises CaseError for a heat that no area carries between these flows and temperatures.
        """
        from ht import hx

        require_above("cooler.rated.heat", rated.heat, "W", "give the heat of the data sheet")
        require_above("cooler.rated.flow", rated.flow, "m3/s", "give the oil flow of the data sheet")
        difference = rated.inlet_temperature - coolant.inlet_temperature
        require_above("cooler.rated.inlet_temperature", difference, "K over the coolant", "check both inlets")
        oil, inlet = rated.oil, rated.inlet_temperature
        mass_flow = oil.density(inlet) * rated.flow
        outlet = temperature_at(oil, enthalpy(oil, inlet) - rated.heat / mass_flow)
        capacity_rate = mass_flow * oil.heat_capacity(0.5 * (inlet + outlet))
        least, most = sorted((capacity_rate, coolant.capacity_rate))
        effectiveness = rated.heat / (least * difference)
        best = _effectiveness(1e4, least / most, arrangement)
        if effectiveness >= best:
            refuse(
                "cooler.rated.heat",
                f"{1e-3 * rated.heat:.4g} kW",
                f"must be below the {1e-3 * best * least * difference:.4g} kW that the largest cooler of this kind "
                f"({arrangement}) carries between these flows and inlet temperatures",
                "check flows and inlet temperatures of the rated point",
            )
        transfer_units: Callable[..., float] = hx.NTU_from_effectiveness
        units = transfer_units(effectiveness, least / most, arrangement)
        return cls(conductance=units * least, coolant=coolant, arrangement=arrangement)

    def carried(self, oil: Oil, mass_flow: float, inlet_temperature: float) -> float:
        """Heat that an oil flow gives to the coolant [W]; 0 for oil colder than the coolant.

        mass_flow : [kg/s]; inlet_temperature : of the oil [K]
        """
        difference = inlet_temperature - self.coolant.inlet_temperature
        if mass_flow <= 0.0 or difference <= 0.0:
            return 0.0
        heat = 0.0
        for _ in range(50):
            outlet = temperature_at(oil, enthalpy(oil, inlet_temperature) - heat / mass_flow)
            capacity_rate = mass_flow * oil.heat_capacity(0.5 * (inlet_temperature + outlet))
            least, most = sorted((capacity_rate, self.coolant.capacity_rate))
            units = self.conductance / least
            better = _effectiveness(units, least / most, self.arrangement) * least * difference
            if abs(better - heat) <= 1e-13 * better:
                break
            heat = better
        return better

    def coolant_outlet(self, heat: float) -> float:
        """Temperature of the coolant behind the cooler [K] that carries ``heat`` [W]."""
        return self.coolant.inlet_temperature + heat / self.coolant.capacity_rate

    def warnings(self, name: str, heat: float) -> tuple[str, ...]:
        """Sentence where the coolant would boil under ``heat`` [W]."""
        outlet, boiling = self.coolant_outlet(heat), self.coolant.boiling_temperature
        if boiling is None or outlet < boiling:
            return ()
        return (
            f"{name}: coolant outlet = {celsius(outlet)}: above boiling, {celsius(boiling)} at "
            f"{1e-5 * self.coolant.pressure:.3g} bar; open the coolant or raise its pressure",
        )


@dataclass(frozen=True, kw_only=True)
class TankCooler:
    """Cooler that holds the temperature of the tank.

    setpoint : of the tank [K]
    band : hysteresis of its thermostat [K], as `Heater.band` (on above, off below); 0 for continuous control
    flow : oil of its own pump, from the tank and back [m3/s]; None for a cooler in the common return of all lines
    """

    cooler: Cooler
    setpoint: float
    band: float = 0.0
    flow: float | None = None

    def __post_init__(self) -> None:
        require_above("tank_cooler.setpoint", self.setpoint, "K", "give an absolute temperature")
        require_at_least("tank_cooler.band", self.band, "K", "give 0 for continuous control")
        if self.flow is not None:
            require_above("tank_cooler.flow", self.flow, "m3/s", "leave it out for a cooler in the return")


def _effectiveness(units: float, ratio: float, arrangement: Arrangement) -> float:
    from ht import hx

    law: Callable[..., float] = hx.effectiveness_from_NTU
    return law(units, ratio, subtype=arrangement)


@lru_cache(maxsize=64)
def _liquid(fluid: str, temperature: float, pressure: float) -> tuple[float, float]:
    """Density [kg/m3] and heat capacity [J/(kg K)] of a coolant."""
    from CoolProp.CoolProp import PhaseSI, PropsSI

    given = f"{fluid} at {celsius(temperature)}, {1e-5 * pressure:.3g} bar"
    try:
        found = tuple(float(PropsSI(key, "T", temperature, "P", pressure, fluid)) for key in ("D", "C"))
        phase = "liquid" if fluid.startswith("INCOMP::") else PhaseSI("T", temperature, "P", pressure, fluid)
    except ValueError as error:
        refuse("coolant.fluid", given, f"CoolProp has no properties ({error})", "name a liquid such as Water")
    if "liquid" not in phase:
        refuse("coolant.fluid", given, f"must be a liquid, is {phase}", "check temperature and pressure")
    return found[0], found[1]


@lru_cache(maxsize=64)
def _boiling(fluid: str, pressure: float) -> float:
    from CoolProp.CoolProp import PropsSI

    try:
        return float(PropsSI("T", "P", pressure, "Q", 0, fluid))
    except ValueError as error:
        raise CaseError(
            f"coolant.pressure = {pressure:.4g} Pa: {fluid} has no boiling point there ({error})"
        ) from error


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
