"""Oil circuits of a held stage as rows of the result."""

from collections.abc import Iterator
from typing import Any

from rigdesign.oil_circuit.steady_result import DeviceLoad, SteadyCircuit
from rigdesign.results.housing import CoolingBalance
from rigdesign.results.units import L_MIN, ZERO


def circuit_rows(balance: CoolingBalance) -> Iterator[dict[str, Any]]:
    """Every oil circuit of one held stage: tank, lines, heaters and coolers with what they need and can do."""
    for name, found in balance.circuits.items():
        pump = found.circuit.pump
        yield {
            "circuit": name,
            "stage": balance.stage,
            "tank_degC": found.tank_temperature - ZERO,
            "flow_l_min": L_MIN * found.circuit.flow,
            "heater_W": found.heater_power,
            "cooler_W": found.cooler_heat,
            "pump_W": pump.shaft_power if pump else 0.0,
            "machines_W": found.machine_heat,
            "room_W": found.room_loss,
            "open_W": found.imbalance,
            "lines": [_line_row(found, line) for line in found.lines],
            "devices": list(_device_rows(found)),
        }


def _line_row(found: SteadyCircuit, name: str) -> dict[str, Any]:
    line, given = found.lines[name], next(each for each in found.circuit.lines if each.name == name)
    return {
        "line": name,
        "setpoint_degC": None if given.setpoint is None else given.setpoint - ZERO,
        "tolerance_K": given.tolerance,
        "supply_degC": line.supply - ZERO,
        "drain_degC": line.drain - ZERO,
        "back_degC": line.back - ZERO,
        "flow_l_min": L_MIN * given.flow,
        "heat_W": sum(line.heats.values()),
    }


def _device_rows(found: SteadyCircuit) -> Iterator[dict[str, Any]]:
    loads: dict[str, DeviceLoad | None] = {"heater": found.heater, "tank cooler": found.tank_cooler}
    loads |= {f"trim heater of {line}": load for line, load in found.trim_heaters.items()}
    loads |= {f"cooler of {line}": load for line, load in found.line_coolers.items()}
    for name, load in loads.items():
        if load is not None:
            yield {
                "device": name,
                "power_W": load.power,
                "needed_W": load.needed,
                "capability_W": load.capability,
            }
