"""Oil on its way through one line, from the tank and back, at a given temperature of the tank.

Steady, a pipe stores nothing. Over an implicit time step of weight w [s] it is one mixed volume,

    E(T_out) - E_before = w (m h_in - m h(T_out) - U (T_out - T_room)) ,

and its steady state is the same as that of the steady balance.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from scipy.optimize import brentq

from rigdesign.base.errors import NotConvergedError
from rigdesign.base.units import celsius
from rigdesign.oil_circuit.circuit import (
    REFERENCE,
    Circuit,
    HeatContent,
    Pipe,
    SupplyLine,
    enthalpy,
    temperature_at,
)
from rigdesign.properties.oil import Oil

HeatTaken = float | Callable[[float], float]
"""Heat a consumer gives to its oil [W], or that as a function of the supply temperature [K]."""


@dataclass(frozen=True, kw_only=True)
class PipeContents:
    """Heat contents of the pipes of a line before an implicit step [J], and the weight of the step [s]."""

    supply: float
    return_: float
    weight: float


@dataclass(frozen=True, kw_only=True)
class LineBalance:
    """Temperatures [K] and powers [W] of a line."""

    mass_flow: float
    """[kg/s]"""
    pumped: float
    """Behind the pump."""
    controlled: float
    """Behind valve and trim heater, where the setpoint is held."""
    supply: float
    """At the consumers."""
    drain: float
    """Mixed oil of all consumers."""
    back: float
    """Where it enters the tank."""
    heats: Mapping[str, float]
    """Consumer -> heat into its oil."""
    cooler_heat: float
    cooler_needed: float
    """To hold the setpoint, whatever the cooler carries."""
    cooler_capability: float
    """With the bypass shut, at this temperature."""
    trim_power: float
    trim_needed: float
    """To hold the setpoint, whatever the limit."""
    room_loss: float
    supply_stored: float
    """Into the oil of the supply pipe."""
    return_stored: float
    """Into the oil of the return pipe."""


def pipe_content(oil: Oil, pipe: Pipe, room_temperature: float) -> HeatContent:
    """Heat content of the oil in a pipe [J]; its mass is that at room temperature."""
    return HeatContent(oil=oil, mass=oil.density(room_temperature) * pipe.volume)


def consumer_return(oil: Oil, supply: float, mass_flow: float, heat: float) -> float:
    """Temperature [K] at which a consumer gives back oil that took up ``heat`` [W]; mass_flow : [kg/s]."""
    return temperature_at(oil, enthalpy(oil, supply) + heat / mass_flow)


def line_balance(
    circuit: Circuit,
    line: SupplyLine,
    tank_temperature: float,
    mass_flow: float,
    heats: Mapping[str, HeatTaken],
    before: PipeContents | None = None,
) -> LineBalance:
    """Balance of one line.

    tank_temperature : [K]; mass_flow : of the line [kg/s], 0 for a pump at rest
    heats : consumer -> heat into its oil
    before : pipes before an implicit step; None for the steady balance
    """
    oil = circuit.oil
    running = mass_flow > 0.0
    pump_heat = circuit.line_pump_heat(line) if running else 0.0
    pumped = tank_temperature
    if running:
        pumped = temperature_at(oil, enthalpy(oil, tank_temperature) + pump_heat / mass_flow)
    cooled, cooler_heat, cooler_needed, capability = _valve(line, oil, mass_flow, pumped)
    trim_needed = 0.0
    if line.trim_power_limit and line.setpoint is not None and running:
        trim_needed = max(mass_flow * (enthalpy(oil, line.setpoint) - enthalpy(oil, cooled)), 0.0)
    trim = min(trim_needed, line.trim_power_limit)
    controlled = temperature_at(oil, enthalpy(oil, cooled) + trim / mass_flow) if trim else cooled
    weight = before.weight if before else math.inf
    supply, loss, stored = _pipe(
        circuit, line.supply_pipe, (controlled, mass_flow), before.supply if before else 0.0, weight
    )
    taken: dict[str, float] = {}
    drain = supply
    if running:
        taken = {c.name: _value(heats[c.name], supply) for c in line.consumers}
        drain = consumer_return(oil, supply, mass_flow, math.fsum(taken.values()))
    back, return_loss, return_stored = _pipe(
        circuit, line.return_pipe, (drain, mass_flow), before.return_ if before else 0.0, weight
    )
    return LineBalance(
        mass_flow=mass_flow,
        pumped=pumped,
        controlled=controlled,
        supply=supply,
        drain=drain,
        back=back,
        heats=taken,
        cooler_heat=cooler_heat,
        cooler_needed=cooler_needed,
        cooler_capability=capability,
        trim_power=trim,
        trim_needed=trim_needed,
        room_loss=loss + return_loss,
        supply_stored=stored,
        return_stored=return_stored,
    )


def _value(heat: HeatTaken, supply: float) -> float:
    return heat(supply) if callable(heat) else heat


def _valve(line: SupplyLine, oil: Oil, mass_flow: float, inlet: float) -> tuple[float, float, float, float]:
    """Temperature behind cooler and bypass [K]; heat carried, needed and possible [W]."""
    cooler, setpoint = line.cooler, line.setpoint
    if cooler is None or setpoint is None or mass_flow <= 0.0:
        return inlet, 0.0, 0.0, 0.0
    entering = enthalpy(oil, inlet)
    needed = max(mass_flow * (entering - enthalpy(oil, setpoint)), 0.0)
    capability = cooler.carried(oil, mass_flow, inlet)
    if not line.valve_band:
        heat = min(needed, capability)
        return temperature_at(oil, entering - heat / mass_flow) if heat else inlet, heat, needed, capability
    band, shut = line.valve_band, setpoint - 0.5 * line.valve_band
    if inlet <= shut or not capability:
        return inlet, 0.0, needed, capability

    def mixed(temperature: float) -> float:
        share = min(max((temperature - shut) / band, 0.0), 1.0)
        return temperature_at(oil, entering - cooler.carried(oil, share * mass_flow, inlet) / mass_flow)

    outlet = float(brentq(lambda t: t - mixed(t), shut, inlet, xtol=1e-12, rtol=1e-15))
    return outlet, mass_flow * (entering - enthalpy(oil, outlet)), needed, capability


def _pipe(
    circuit: Circuit, pipe: Pipe, inflow: tuple[float, float], content: float, weight: float
) -> tuple[float, float, float]:
    """Outlet temperature [K] of a pipe, its loss to the room and what it stores [W].

    inflow : temperature [K] and mass flow [kg/s]; content : before the step [J]; weight : of the step [s]
    """
    (inlet, mass_flow), oil, room = inflow, circuit.oil, circuit.room_temperature
    if not pipe.volume and not (mass_flow and pipe.wall_conductance):
        return inlet, 0.0, 0.0
    conductance = pipe.outlet_conductance(mass_flow * oil.heat_capacity(inlet))
    stored = pipe_content(oil, pipe, room)
    share = 0.0 if math.isinf(weight) else 1.0 / weight
    if not (share * stored.mass or mass_flow or conductance):
        return inlet, 0.0, 0.0
    whole = HeatContent(oil=oil, mass=mass_flow + share * stored.mass, body=conductance)
    given = mass_flow * enthalpy(oil, inlet) + conductance * (room - REFERENCE) + share * content
    outlet = whole.temperature(given)
    loss = conductance * (outlet - room)
    # what flows in and stays: as exact for short steps as for long ones, where E(T_out) - E_before cancels
    kept = mass_flow * (enthalpy(oil, inlet) - enthalpy(oil, outlet)) - loss
    return outlet, loss, kept if share else 0.0


# The temperature of the tank at which the heat into its oil is zero, within the limits of heater and cooler.
#
#     sum m (h_back - h_tank) + P_relief + P_machines + P_heater - Q_cooler - U (T - T_room) - (E(T) - E_before) / w = 0
#
# The last term belongs to an implicit time step of weight w. Heater and cooler are steps over the temperature of the
# tank: full power below the setpoint of the heater, anything up to its limit at the setpoint, nothing above; the cooler
# the other way round. The sum falls with temperature, so that its zero is unique.

RANGE = (200.0, 900.0)
"""Temperatures of a tank among which a balance is sought [K]."""


@dataclass(frozen=True, kw_only=True)
class Contents:
    """Heat contents of a circuit above 40 degC [J]."""

    tank: float
    supply: Mapping[str, float]
    """Line -> oil in its supply pipe."""
    return_: Mapping[str, float]
    """Line -> oil in its return pipe."""

    @property
    def total(self) -> float:
        """[J]"""
        return math.fsum((self.tank, *self.supply.values(), *self.return_.values()))


@dataclass(frozen=True, kw_only=True)
class Setpoints:
    """Of the tank [K]; infinite ones force a device: heater +inf on, -inf off; cooler -inf on, +inf off."""

    heater: float
    cooler: float

    @classmethod
    def of(cls, circuit: Circuit) -> "Setpoints":
        """Those of continuous control."""
        return cls(
            heater=circuit.heater.setpoint if circuit.heater else -math.inf,
            cooler=circuit.tank_cooler.setpoint if circuit.tank_cooler else math.inf,
        )


@dataclass(frozen=True, kw_only=True)
class TankBalance:
    """Temperature of the tank [K], its lines, and the powers at it [W]."""

    temperature: float
    lines: Mapping[str, LineBalance]
    heater_power: float
    cooler_heat: float
    room_loss: float
    """Of tank and pipes."""
    stored: float
    """Into the tank."""


@dataclass(frozen=True, kw_only=True)
class Heating:
    """What the tank gets at one temperature without heater and cooler [W], and what its cooler would carry [W]."""

    lines: Mapping[str, LineBalance]
    given: float
    power: float
    """Given, less what a step to this temperature stores."""
    cooler_capability: float
    room_loss: float


@dataclass(frozen=True, kw_only=True)
class TankEquation:
    """Heat balance of the tank of a circuit as a function of its temperature.

    mass_flows : line -> [kg/s]; heats : consumer -> heat into its oil
    before, weight : contents before an implicit step and its weight [s]; None and infinite for the steady balance
    machine_heat : into the tank from what is cooled with its oil and is no consumer [W]
    """

    circuit: Circuit
    mass_flows: Mapping[str, float]
    heats: Mapping[str, HeatTaken]
    before: Contents | None = None
    weight: float = math.inf
    machine_heat: float = 0.0

    def at(self, temperature: float) -> Heating:
        """Heat into the tank at a temperature [K]."""
        circuit, oil = self.circuit, self.circuit.oil
        lines = {
            line.name: line_balance(
                circuit, line, temperature, self.mass_flows[line.name], self.heats, self._pipes(line.name)
            )
            for line in circuit.lines
        }
        own = enthalpy(oil, temperature)
        returned = math.fsum(line.mass_flow * (enthalpy(oil, line.back) - own) for line in lines.values())
        relief = circuit.relief_heat if any(self.mass_flows.values()) else 0.0
        loss = circuit.tank.wall_conductance * (temperature - circuit.room_temperature)
        stored = 0.0
        if self.before is not None:
            stored = (tank_content(circuit).at(temperature) - self.before.tank) / self.weight
        return Heating(
            lines=lines,
            given=returned + relief + self.machine_heat - loss,
            power=returned + relief + self.machine_heat - loss - stored,
            cooler_capability=self._cooler_capability(temperature, lines),
            room_loss=loss + math.fsum(line.room_loss for line in lines.values()),
        )

    def solve(self, setpoints: Setpoints) -> TankBalance:
        """Temperature at which the balance closes. Raises NotConvergedError where it does not within `RANGE`."""
        low, high = RANGE
        for mark in sorted({t for t in (setpoints.heater, setpoints.cooler) if low < t < high}):
            heating = self.at(mark)
            before = self._net(heating, setpoints.heater >= mark, setpoints.cooler < mark)
            after = self._net(heating, setpoints.heater > mark, setpoints.cooler <= mark)
            if before < 0.0:
                return self._between(low, mark, setpoints)
            if after <= 0.0:
                return self._held(mark, heating, setpoints)
            low = mark
        return self._between(low, high, setpoints)

    def _pipes(self, line: str) -> PipeContents | None:
        if self.before is None:
            return None
        return PipeContents(
            supply=self.before.supply[line], return_=self.before.return_[line], weight=self.weight
        )

    def _cooler_capability(self, temperature: float, lines: Mapping[str, LineBalance]) -> float:
        placed, oil = self.circuit.tank_cooler, self.circuit.oil
        if placed is None:
            return 0.0
        if placed.flow is not None:
            return placed.cooler.carried(oil, oil.density(temperature) * placed.flow, temperature)
        mass_flow = math.fsum(line.mass_flow for line in lines.values())
        if not mass_flow:
            return 0.0
        mean = math.fsum(line.mass_flow * enthalpy(oil, line.back) for line in lines.values()) / mass_flow
        return placed.cooler.carried(oil, mass_flow, temperature_at(oil, mean))

    def _net(self, heating: Heating, heater: bool, cooler: bool) -> float:
        limit = self.circuit.heater.power_limit if heater and self.circuit.heater else 0.0
        return heating.power + limit - (heating.cooler_capability if cooler else 0.0)

    def _held(self, mark: float, heating: Heating, setpoints: Setpoints) -> TankBalance:
        """The tank at a setpoint, its device at part load."""
        if mark == setpoints.heater:
            cooler = heating.cooler_capability if setpoints.cooler < mark else 0.0
            return self._balance(mark, heating, cooler - heating.power, cooler)
        heater = self._net(heating, setpoints.heater > mark, False) - heating.power
        return self._balance(mark, heating, heater, heating.power + heater)

    def _between(self, low: float, high: float, setpoints: Setpoints) -> TankBalance:
        """The tank between two setpoints, every device fully on or off."""
        heater, cooler = setpoints.heater >= high, setpoints.cooler <= low

        def net(temperature: float) -> float:
            return self._net(self.at(temperature), heater, cooler)

        try:
            found = float(brentq(net, low, high, xtol=1e-12, rtol=1e-15))
        except ValueError as error:
            given = 1e-3 * net(high)
            raise NotConvergedError(
                f"oil circuit {self.circuit.name}: tank temperature: no balance between {celsius(low)} and "
                f"{celsius(high)}, where {given:.4g} kW are left over; give the heat a way out (cooler, wall "
                "conductance) or correct the heat of the consumers"
            ) from error
        heating = self.at(found)
        limit = self._net(heating, heater, False) - heating.power
        return self._balance(found, heating, limit, heating.cooler_capability if cooler else 0.0)

    def _balance(self, temperature: float, heating: Heating, heater: float, cooler: float) -> TankBalance:
        return TankBalance(
            temperature=temperature,
            lines=heating.lines,
            heater_power=heater,
            cooler_heat=cooler,
            room_loss=heating.room_loss,
            # what is given and stays: as exact for short steps as for long ones, where E(T) - E_before cancels
            stored=0.0 if self.before is None else heating.given + heater - cooler,
        )


def tank_content(circuit: Circuit) -> HeatContent:
    """Heat content of the oil in the tank while the lines are full, and of the tank itself [J]."""
    return HeatContent(
        oil=circuit.oil,
        mass=circuit.oil.density(circuit.room_temperature) * circuit.running_fill,
        body=circuit.tank.body_heat_capacity,
    )
