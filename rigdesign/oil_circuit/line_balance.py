"""Oil on its way through one line, from the tank and back, at a given temperature of the tank.

Steady, a pipe stores nothing. Over an implicit time step of weight w [s] it is one mixed volume,

    E(T_out) - E_before = w (m h_in - m h(T_out) - U (T_out - T_room)) ,

and its steady state is the same as that of the steady balance.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from scipy.optimize import brentq

from rigdesign.oil_circuit.circuit import Circuit, SupplyLine
from rigdesign.oil_circuit.heat_content import REFERENCE, HeatContent, enthalpy, temperature_at
from rigdesign.oil_circuit.parts import Pipe
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
