"""Warnings of a steady oil circuit: name, value, limit, remedy."""

from rigdesign.base.number_faults import celsius
from rigdesign.oil_circuit.circuit import Circuit, SupplyLine
from rigdesign.oil_circuit.steady_result import SteadyCircuit


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
