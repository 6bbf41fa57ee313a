"""Convergence, heat, oil circuits and rolling bearings of the rig as rows of the result."""

import math
from collections.abc import Iterator
from typing import Any

from rigdesign.coupling.loop import PointResult
from rigdesign.oil_circuit.steady_result import DeviceLoad, SteadyCircuit
from rigdesign.results.housing import CoolingBalance
from rigdesign.results.result import CouplingHistory
from rigdesign.results.rig_heat import SINKS, HeatSource, RigHeat
from rigdesign.results.rolling_bearings import RollingBearingRecord
from rigdesign.results.units import L_MIN, RPM, UM, ZERO
from rigdesign.rig_heat.room import Room, RoomBalance

M3_H = 3600.0
"""m3/h of a flow [m3/s]."""
N_UM = 1e-6
"""Newtons per micrometre in a newton per metre."""
KNM_RAD = 1e-3
"""Kilonewton metres in a newton metre."""


def coupling_row(result: PointResult) -> CouplingHistory:
    """Residuals of every iteration of the loop at one held stage."""
    return CouplingHistory(
        stage=result.point.stage,
        iterations=len(result.residuals),
        residuals=[
            {
                "temperature_K": residual.temperature,
                "growth_um": UM * residual.length,
                "torque_relative": residual.torque,
            }
            for residual in result.residuals
        ],
    )


def rig_heat_row(heat: RigHeat, room: Room | None) -> dict[str, Any]:
    """Sources, room and powers of one held stage; room : the one that the case states."""
    return {
        "stage": heat.stage,
        "drive_power_W": heat.drive_power,
        "mains_power_W": heat.mains_power,
        "input_power_W": heat.input_power,
        "open_W": heat.imbalance,
        "sources": [_source_row(source) for source in heat.sources],
        "room": None if room is None or heat.room is None else _room_row(room, heat.room),
    }


def _source_row(source: HeatSource) -> dict[str, Any]:
    sinks = {f"{sink}_W": source.sinks.get(sink, 0.0) for sink in SINKS}
    return {"source": source.name, "kind": source.kind, "power_W": source.power, **sinks}


def _room_row(room: Room, found: RoomBalance) -> dict[str, Any]:
    needed = found.needed_air_flow
    return {
        "temperature_degC": found.temperature - ZERO,
        "limit_degC": None if room.temperature_limit is None else room.temperature_limit - ZERO,
        "heat_W": found.heat,
        "by_air_W": found.by_air,
        "by_walls_W": found.by_walls,
        "air_flow_m3_h": M3_H * room.air_flow,
        "needed_air_flow_m3_h": None if needed is None or math.isinf(needed) else M3_H * needed,
    }


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


def rolling_bearing_row(found: RollingBearingRecord) -> dict[str, Any]:
    """One rolling bearing at one stage; a life without end is None."""
    rolling, sliding, seals, drag = found.torques
    return {
        "bearing": found.name,
        "stage": found.stage,
        "designation": found.designation,
        "radial_load_N": found.radial_load,
        "axial_load_N": found.axial_load,
        "minimum_load_N": found.minimum_load,
        "speed_rpm": RPM * found.speed,
        "speed_utilisation": found.speed_utilisation,
        "rolling_torque_Nm": rolling,
        "sliding_torque_Nm": sliding,
        "seal_torque_Nm": seals,
        "drag_torque_Nm": drag,
        "friction_W": found.power,
        "temperature_degC": found.temperature - ZERO,
        "inner_ring_degC": found.inner_ring - ZERO,
        "outer_ring_degC": found.outer_ring - ZERO,
        "heat_to_shaft_W": found.heat_to_shaft,
        "heat_to_housing_W": found.heat_to_housing,
        "operating_clearance_um": UM * found.clearance,
        "basic_life_h": _finite(found.basic_life),
        "modified_life_h": _finite(found.modified_life),
        "static_safety": _finite(found.static_safety),
        "viscosity_ratio": found.viscosity_ratio,
        "radial_stiffness_N_um": N_UM * found.radial_stiffness,
        "axial_stiffness_N_um": N_UM * found.axial_stiffness,
        "tilting_stiffness_kNm_rad": KNM_RAD * found.tilting_stiffness,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
