"""Steady balance of an oil circuit: temperatures of tank and supplies, heater and coolers against what they can do."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from rigdesign.base.errors import CaseError, Fault, NotConvergedError
from rigdesign.base.units import celsius
from rigdesign.oil_circuit.circuit import Circuit, SupplyLine
from rigdesign.oil_circuit.line_balance import (
    Heating,
    HeatTaken,
    LineBalance,
    Setpoints,
    TankBalance,
    TankEquation,
    consumer_return,
)

# What a steady balance of an oil circuit gives.


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


ITERATIONS = 200


class SetpointNotHeldError(CaseError):
    """A supply temperature demanded as hard that the circuit cannot hold."""


def steady_circuit(
    circuit: Circuit, heats: Mapping[str, HeatTaken], machine_heat: float = 0.0
) -> SteadyCircuit:
    """Balance of a circuit with its pump running.

    Parameters
    ----------
    heats : consumer -> heat into its oil [W], or that as a function of its supply temperature [K]; negative where a
        consumer cools the oil. It should not rise with the temperature, else there may be several balances.
    machine_heat : into the tank from what is cooled with its oil and is no consumer [W]

    Raises
    ------
    CaseError
        Consumers without a heat, or heats without a consumer.
    SetpointNotHeldError
        A line whose setpoint is hard and is not held.
    NotConvergedError
        No balance within the temperatures of `tank_balance.RANGE`.

    Flows count at the supply temperature, so that the mass flow is found by iteration; heater and cooler by their
    limits. An on-off heater or cooler gives the mean power that holds its setpoint. Where a limit binds, the supply
    temperature is what the balance gives, with a warning.
    """
    require_heats(circuit, heats)
    setpoints = Setpoints.of(circuit)
    supplies = {line.name: line.setpoint or circuit.room_temperature for line in circuit.lines}
    for _ in range(ITERATIONS):
        flows = {line.name: circuit.oil.density(supplies[line.name]) * line.flow for line in circuit.lines}
        equation = TankEquation(circuit=circuit, mass_flows=flows, heats=heats, machine_heat=machine_heat)
        balance = equation.solve(setpoints)
        better = {name: line.supply for name, line in balance.lines.items()}
        change = max(abs(better[name] - supplies[name]) for name in better)
        supplies = better
        if change < 1e-9:
            break
    else:
        raise NotConvergedError(
            f"oil circuit {circuit.name}: supply temperatures still move by {change:.3g} K after {ITERATIONS} "
            "iterations; check whether a heat rises with the supply temperature"
        )
    result = _result(equation, balance)
    _demand(result)
    return result


def require_heats(circuit: Circuit, heats: Mapping[str, object]) -> None:
    """Raise CaseError unless every consumer has a value, and nothing else."""
    names = {consumer.name for consumer in circuit.consumers}
    for name in sorted(names ^ set(heats)):
        problem = "has no value" if name in names else "is no consumer of the circuit"
        known = ", ".join(sorted(names))
        raise CaseError(
            [Fault(name, "", problem, f"give one for each of {known}")], f"oil circuit {circuit.name}"
        )


def _result(equation: TankEquation, balance: TankBalance) -> SteadyCircuit:
    circuit = equation.circuit
    line_coolers, trims, consumers = {}, {}, {}
    for line in circuit.lines:
        found = balance.lines[line.name]
        if line.cooler:
            line_coolers[line.name] = DeviceLoad(
                power=found.cooler_heat, needed=found.cooler_needed, capability=found.cooler_capability
            )
        if line.trim_power_limit:
            trims[line.name] = DeviceLoad(
                power=found.trim_power, needed=found.trim_needed, capability=line.trim_power_limit
            )
        for consumer in line.consumers:
            mass_flow = found.mass_flow * consumer.flow / line.flow
            heat = found.heats[consumer.name]
            consumers[consumer.name] = ConsumerOil(
                supply=found.supply,
                return_=consumer_return(circuit.oil, found.supply, mass_flow, heat),
                mass_flow=mass_flow,
                heat=heat,
            )
    pump_to_room = circuit.pump.heat_into_room if circuit.pump else 0.0
    draft = SteadyCircuit(
        circuit=circuit,
        tank_temperature=balance.temperature,
        lines=balance.lines,
        consumers=consumers,
        heater=_heater_load(equation, balance),
        tank_cooler=_cooler_load(equation, balance),
        line_coolers=line_coolers,
        trim_heaters=trims,
        pump_heat=circuit.pump_heat,
        room_loss=balance.room_loss + pump_to_room,
        machine_heat=equation.machine_heat,
        imbalance=_imbalance(equation, balance, circuit.pump_heat),
        warnings=(),
    )
    return replace(draft, warnings=steady_warnings(draft))


def _imbalance(equation: TankEquation, balance: TankBalance, pump_heat: float) -> float:
    """All heat into the oil of the circuit less all out of it [W]."""
    lines = balance.lines.values()
    into = [balance.heater_power, pump_heat, equation.machine_heat]
    into += [line.trim_power for line in lines]
    into += [heat for line in lines for heat in line.heats.values()]
    out = [balance.cooler_heat, balance.room_loss, *(line.cooler_heat for line in lines)]
    return math.fsum((*into, *(-heat for heat in out)))


def _heater_load(equation: TankEquation, balance: TankBalance) -> DeviceLoad | None:
    heater = equation.circuit.heater
    if heater is None:
        return None
    needed = max(-equation.at(heater.setpoint).power, 0.0)
    return DeviceLoad(power=balance.heater_power, needed=needed, capability=heater.power_limit)


def _cooler_load(equation: TankEquation, balance: TankBalance) -> DeviceLoad | None:
    placed = equation.circuit.tank_cooler
    if placed is None:
        return None
    there: Heating = equation.at(placed.setpoint)
    return DeviceLoad(
        power=balance.cooler_heat, needed=max(there.power, 0.0), capability=there.cooler_capability
    )


def _demand(result: SteadyCircuit) -> None:
    """Refuse what is hard and not held."""
    faults = []
    for line in result.circuit.lines:
        margin = result.supply_margin(line.name)
        if line.hard and line.setpoint is not None and margin is not None and margin < 0.0:
            faults.append(
                Fault(
                    f"lines.{line.name}.setpoint",
                    celsius(line.setpoint),
                    f"must be held within {line.tolerance:.3g} K, the supply reaches "
                    f"{celsius(result.lines[line.name].supply)}",
                    "; ".join(device_warnings(result)) or "give the circuit a heater or a cooler",
                )
            )
    if faults:
        raise SetpointNotHeldError(faults, f"oil circuit {result.circuit.name}")


# Warnings of a steady oil circuit: name, value, limit, remedy.


def steady_warnings(result: SteadyCircuit) -> tuple[str, ...]:
    """Sentences on setpoints not held, devices at their limit, coolant, oil and level."""
    circuit, found = result.circuit, []
    for line in circuit.lines:
        found += _supply_warning(result, line)
    found += device_warnings(result)
    coolers = [
        (f"lines.{line.name}.cooler", line.cooler, result.line_coolers.get(line.name))
        for line in circuit.lines
    ]
    if circuit.tank_cooler:
        coolers.append(("tank_cooler", circuit.tank_cooler.cooler, result.tank_cooler))
    for name, cooler, load in coolers:
        if cooler and load:
            found += cooler.warnings(f"{circuit.name}.{name}", load.power)
    hot = max((result.tank_temperature, *(oil.return_ for oil in result.consumers.values())))
    cold = min((result.tank_temperature, *(oil.supply for oil in result.consumers.values())))
    found += circuit.oil.warnings(hot)
    found += [text for text in circuit.oil.warnings(cold) if text not in found]
    found += _both_warning(result)
    found += _level_warning(circuit, result.tank_temperature)
    return tuple(found)


def _supply_warning(result: SteadyCircuit, line: SupplyLine) -> list[str]:
    margin = result.supply_margin(line.name)
    if line.setpoint is None or margin is None or margin >= 0.0:
        return []
    supply = result.lines[line.name].supply
    remedy = (
        "more heating power, or less heat lost" if supply < line.setpoint else "more cooling, or less heat"
    )
    return [
        f"{result.circuit.name}.lines.{line.name}: supply temperature = {celsius(supply)}: cannot be held at "
        f"{celsius(line.setpoint)} within {line.tolerance:.3g} K; {remedy}"
    ]


def device_warnings(result: SteadyCircuit) -> list[str]:
    """Sentences on every heater and cooler at its limit."""
    name = result.circuit.name
    loads = [(f"{name}.lines.{line}.cooler", "carries", load) for line, load in result.line_coolers.items()]
    loads += [
        (f"{name}.lines.{line}.trim_heater", "gives", load) for line, load in result.trim_heaters.items()
    ]
    if result.heater:
        loads.append((f"{name}.heater", "gives", result.heater))
    if result.tank_cooler:
        loads.append((f"{name}.tank_cooler", "carries", result.tank_cooler))
    return [
        f"{key}: power needed = {1e-3 * load.needed:.4g} kW: it {verb} at most {1e-3 * load.capability:.4g} kW at this "
        f"state; take a larger one or {'more or colder coolant' if verb == 'carries' else 'lag what loses heat'}"
        for key, verb, load in loads
        if load.margin < -1e-6 * max(load.needed, 1.0)
    ]


def _both_warning(result: SteadyCircuit) -> list[str]:
    """Heat that goes from the heaters straight to the coolers."""
    both = min(result.heater_power, result.cooler_heat)
    if both <= 1e-2 * result.heater_power:
        return []
    return [
        f"{result.circuit.name}: heat from heaters to coolers = {1e-3 * both:.4g} kW: 0 where only one of them works; "
        "lower heater.setpoint below the setpoints of the lines, or give warm and cold lines a tank each"
    ]


def _level_warning(circuit: Circuit, temperature: float) -> list[str]:
    """The fill of the whole circuit, expanded, back in the tank."""
    oil = circuit.oil
    volume = circuit.tank.fill * oil.density(circuit.room_temperature) / oil.density(temperature)
    if volume <= circuit.tank.volume:
        return []
    return [
        f"{circuit.name}.tank: oil of the circuit at {celsius(temperature)} = {1e3 * volume:.4g} l: above the "
        f"{1e3 * circuit.tank.volume:.4g} l of the tank once the lines drain; fill in less"
    ]
