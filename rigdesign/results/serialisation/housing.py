"""Losses, oil, temperatures and heat as rows of the result."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from rigdesign.coupling.housing_context import BEARING_OIL
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.oil import OilStream
from rigdesign.oil_circuit.steady import DeviceLoad, SteadyCircuit
from rigdesign.results.housing import (
    SINKS,
    CoolingBalance,
    FluidTemperature,
    GearHeatSplit,
    HeatSource,
    HousingTemperatures,
    RigHeat,
)
from rigdesign.results.lateral import RollingBearingRecord
from rigdesign.results.result import CouplingHistory
from rigdesign.results.thermal import FluidRow, HeatRow, HeatSplitRow, LossRow, OilRow, ThermalResult
from rigdesign.results.units import L_MIN, RPM, UM, ZERO
from rigdesign.rig_heat.component import Room, RoomBalance
from thermal.conduction.balance import HeatFlow


def loss_rows(stage: str, losses: Sequence[PlacedLoss]) -> list[LossRow]:
    """Losses of one stage by place."""
    return [
        LossRow(
            place=placed.name,
            kind=placed.loss.kind,
            stage=stage,
            power_W=placed.loss.power,
            into_oil_W=placed.into_oil,
            into_body_W=placed.into_body,
            not_heat_W=placed.not_heat,
            pump_W=placed.pumped,
            basis="input" if placed.given else "computed",
            details=dict(placed.loss.details),
        )
        for placed in losses
    ]


def oil_rows(stage: str, streams: Sequence[OilStream]) -> list[OilRow]:
    """Oil streams of one stage; none for bearings that are not fed, whose heat is in the oil of the gears."""
    return [
        OilRow(
            consumer=stream.name,
            stage=stage,
            inlet_degC=stream.inlet - ZERO,
            outlet_degC=stream.outlet - ZERO,
            flow_l_min=stream.flow * L_MIN,
            heat_W=stream.heat,
        )
        for stream in streams
        if stream.flow or stream.heat or not stream.name.endswith(BEARING_OIL)
    ]


def cooling_row(balance: CoolingBalance) -> dict[str, float | str]:
    """Heat balance of the rig at one held stage."""
    warming = {} if balance.stored is None else {"stored_W": balance.stored}
    circuits = {"circulation_W": balance.circulation, "tanks_W": balance.tanks} if balance.circuits else {}
    fluids = {
        key: value
        for key, value in (("streams_W", balance.streams), ("volumes_W", balance.volumes))
        if value is not None
    }
    machines = {"machines_W": balance.machines} if balance.machines else {}
    return {
        "stage": balance.stage,
        "losses_W": balance.losses,
        "pump_W": balance.pump,
        "heater_W": balance.heater,
        "cooler_W": balance.cooler,
        "room_W": balance.room,
        **warming,
        **circuits,
        **fluids,
        **machines,
        "not_heat_W": balance.not_heat,
        "open_W": balance.imbalance,
        "flow_l_min": L_MIN * balance.flow,
    }


def thermal_row(found: HousingTemperatures) -> ThermalResult:
    """Temperatures and heat of one housing at one held stage."""
    return ThermalResult(
        gearbox=found.gearbox,
        stage=found.stage,
        max_temperature_degC=found.highest - ZERO,
        max_temperature_body=found.hottest_body,
        heat=[_heat_row(flow) for flow in found.heat],
        closure_relative=found.closure,
        nodes=found.nodes,
        elements=found.elements,
        bodies={
            name: {
                "mean_degC": body.mean - ZERO,
                "max_degC": body.highest - ZERO,
                "min_degC": body.lowest - ZERO,
            }
            for name, body in found.bodies.items()
        },
        room_heat_W=found.room_heat,
        alternatives=_alternatives(found),
        heat_split=[heat_split_row(split) for split in found.heat_split],
        fluids=[_fluid_row(fluid) for fluid in found.fluids],
    )


def _alternatives(found: HousingTemperatures) -> dict[str, float]:
    if found.radiation is None:
        return {}
    return {
        "highest_radiation_included_false_degC": found.radiation.highest_apart - ZERO,
        "highest_radiation_included_true_degC": found.radiation.highest_included - ZERO,
        "heat_to_the_room_under_the_other_reading_W": found.radiation.other_room_heat,
    }


def _fluid_row(fluid: FluidTemperature) -> FluidRow:
    return FluidRow(
        name=fluid.name,
        kind=fluid.kind,
        inlet_degC=_degrees(fluid.inlet),
        temperature_degC=fluid.temperature - ZERO,
        heat_W=fluid.heat,
        power_W=fluid.power,
        links_W=dict(fluid.links),
    )


def _heat_row(flow: HeatFlow) -> HeatRow:
    coefficient = None
    if flow.coefficient is not None:
        coefficient = asdict(flow.coefficient) | {"warnings": list(flow.coefficient.warnings)}
    return HeatRow(
        surface=flow.surface,
        kind=flow.kind,
        power_W=flow.power,
        area_m2=flow.area,
        mean_temperature_degC=flow.mean_temperature - ZERO,
        coefficient=coefficient,
    )


def heat_split_row(split: GearHeatSplit) -> HeatSplitRow:
    """Where the friction heat of one gear goes, with its range."""
    return HeatSplitRow(
        gear=split.gear,
        rule=split.rule,
        friction_W=split.friction,
        at_once_W=split.at_once,
        film_W=split.film,
        share_into_oil=split.share_into_oil,
        share_into_bodies=1.0 - split.share_into_oil,
        bulk_degC=split.bulk_temperature - ZERO,
        tooth_degC=_degrees(split.tooth_temperature),
        flank_film_W_m2K=split.coefficient,
        fin_efficiency=split.fin_efficiency,
        weak_film=_at_end(split.weak_film),
        strong_film=_at_end(split.strong_film),
    )


def _at_end(split: GearHeatSplit | None) -> dict[str, float | None] | None:
    """What a row shows at one end of the ranges of the film."""
    if split is None:
        return None
    return {
        "share_into_oil": split.share_into_oil,
        "bulk_degC": split.bulk_temperature - ZERO,
        "tooth_degC": _degrees(split.tooth_temperature),
        "flank_film_W_m2K": split.coefficient,
    }


def _degrees(temperature: float | None) -> float | None:
    return None if temperature is None else temperature - ZERO


# Convergence, heat, oil circuits and rolling bearings of the rig as rows of the result.

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
