"""The thermal sections of the result: losses, oil, temperatures, clearances."""

import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from rigdesign.coupling.expansion import axes_of, bearing_expansion
from rigdesign.coupling.iteration import IterationResult
from rigdesign.coupling.loop import PointResult
from rigdesign.coupling.losses import PlacedLoss
from rigdesign.coupling.oil import OilStream, heater_and_cooler
from rigdesign.coupling.temperatures import HousingField, heat_stored, heat_to_room, solve_housing
from rigdesign.records.alignment import axis_rows, bore_rows, coupling_rows
from rigdesign.records.heat_split import COMPARED, heat_split_rows
from rigdesign.results.result import (
    CouplingHistory,
    ExpansionResult,
    HeatRow,
    LossRow,
    OilRow,
    TemperatureField,
    ThermalResult,
)
from rigdesign.rig.model import Rig
from thermal.conduction.flux import heat_flux
from thermal.conduction.heat_rows import HeatFlow as SolvedRow
from thermal.expansion.expansion import Expansion

ZERO = 273.15
MM, UM, L_MIN = 1e3, 1e6, 6e4


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
    """Oil streams of one stage."""
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
    ]


def cooler(rig: Rig, last: IterationResult) -> dict[str, float | str]:
    """What cooler and room take out against what shafts, pump and heaters put in [W], at one held stage."""
    damped = math.fsum(placed.not_heat for placed in last.losses)
    lost = math.fsum(placed.loss.power for placed in last.losses) - damped
    pumped = math.fsum(placed.pumped for placed in last.losses)
    heats = {stream.name: np.array([stream.heat]) for stream in last.streams}
    heater, carried = (float(power[0]) for power in heater_and_cooler(rig.case, heats))
    room = math.fsum(heat_to_room(field) for field in last.fields.values())
    stored = math.fsum(heat_stored(field) for field in last.fields.values())
    warming = {} if rig.case.ambient.warming_time is None else {"stored_W": stored}
    return {
        "stage": last.point.stage,
        "losses_W": lost,
        "pump_W": pumped,
        "heater_W": heater,
        "cooler_W": carried,
        "room_W": room,
        **warming,
        "not_heat_W": damped,
        "open_W": lost + pumped + heater - carried - room - stored,
        "flow_l_min": L_MIN * math.fsum(stream.flow for stream in last.streams),
    }


def thermal_result(rig: Rig, result: PointResult, field: HousingField) -> ThermalResult:
    """Temperatures and heat of one housing at one held stage, with the other reading of radiation beside it."""
    name, last = field.gearbox, result.last
    housing = rig.case.gearboxes[name].housing
    assert housing is not None
    other = solve_housing(
        rig, name, last, field,
        radiation_included=not housing.radiation_included, tolerance=COMPARED,
    )  # fmt: skip
    readings = {housing.radiation_included: field, not housing.radiation_included: other}
    return replace(
        solved_temperatures(rig, result, field),
        alternatives={
            f"highest_radiation_included_{str(key).lower()}_degC": float(readings[key].temperature.max())
            - ZERO
            for key in (False, True)
        }
        | {"heat_to_the_room_under_the_other_reading_W": heat_to_room(other)},
        heat_split=heat_split_rows(rig, result, field),
    )


def solved_temperatures(rig: Rig, result: PointResult, field: HousingField) -> ThermalResult:
    """Temperatures and heat of one housing at one held stage as the loop left them: nothing is solved again."""
    mesh = rig.models[field.gearbox].mesh
    bodies = body_temperatures(rig, field)
    return ThermalResult(
        gearbox=field.gearbox,
        stage=result.point.stage,
        max_temperature_degC=float(field.temperature.max()) - ZERO,
        max_temperature_body=max(bodies, key=lambda body: bodies[body]["max_degC"]),
        heat=[_heat_row(row) for row in field.solution.balance.rows],
        closure_relative=field.solution.balance.closure,
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        bodies=bodies,
        room_heat_W=heat_to_room(field),
        alternatives={},
    )


def body_temperatures(rig: Rig, field: HousingField) -> dict[str, dict[str, float]]:
    """Mean, highest and lowest temperature of every body [degC]."""
    mesh = rig.models[field.gearbox].mesh
    elements = rig.conduction[field.gearbox].elements
    temperatures = {}
    for body, cells in mesh.bodies.items():
        nodes = field.temperature[np.unique(mesh.cells[cells])]
        temperatures[body] = {
            "mean_degC": elements.body_mean(field.temperature, body) - ZERO,
            "max_degC": float(nodes.max()) - ZERO,
            "min_degC": float(nodes.min()) - ZERO,
        }
    return temperatures


def _heat_row(row: SolvedRow) -> HeatRow:
    coefficient = None
    if row.coefficient is not None:
        coefficient = asdict(row.coefficient) | {"warnings": list(row.coefficient.warnings)}
    return HeatRow(
        surface=row.surface,
        kind=row.kind,
        power_W=row.power,
        area_m2=row.area,
        mean_temperature_degC=row.mean_temperature - ZERO,
        coefficient=coefficient,
    )


def expansion_result(rig: Rig, result: PointResult, name: str) -> ExpansionResult:
    """Clearances of one housing, cold and hot."""
    shape = result.last.expansion[name].deformed
    return ExpansionResult(
        gearbox=name,
        stage=result.point.stage,
        seal_gaps=_seal_gaps(rig, name, shape),
        shafts=_shafts(rig, name, shape),
        gears=_gears(rig, result, name, shape),
        bearings=_bearings(rig, result, name, shape),
        bores=bore_rows(rig, result, name, shape),
        axes=axis_rows(rig, name, shape),
        couplings=coupling_rows(rig, result, name),
    )


def _seal_gaps(rig: Rig, name: str, shape: Expansion) -> list[dict[str, Any]]:
    shafts = {station.name: station.shaft for station in rig.models[name].seals}
    return [
        {
            "seal": seal.name,
            "shaft": shafts[seal.name],
            "cold_mm": MM * seal.cold_gap,
            "hot_min_mm": MM * seal.minimum,
            "hot_mean_mm": MM * seal.mean,
            "angle_of_min_deg": math.degrees(seal.angle_of_minimum),
            "by_hand_mm": MM * seal.gap_by_hand,
            "axial_shift_mm": MM * seal.axial_shift,
            "angle_deg": [math.degrees(float(angle)) for angle in seal.angles],
            "hot_mm": [MM * float(gap) for gap in seal.gap],
        }
        for seal in shape.seals.values()
    ]


def _shafts(rig: Rig, name: str, shape: Expansion) -> list[dict[str, Any]]:
    box = rig.case.gearboxes[name]
    rows = []
    for shaft in shape.shafts.values():
        play = next(
            (b.axial_play for b in box.bearings.values() if b.shaft == shaft.name and b.locating), 0.0
        )
        rows.append(
            {
                "shaft": shaft.name,
                "growth_mm": MM * (shaft.start + shaft.end),
                "growth_front_mm": MM * shaft.start,
                "growth_rear_mm": MM * shaft.end,
                "free_expansion_mm": MM * (shaft.start_by_hand + shaft.end_by_hand),
                "axial_play_cold_mm": MM * play,
                "axial_play_hot_mm": MM * (play - shaft.axial_play_change),
            }
        )
    return rows


def _gears(rig: Rig, result: PointResult, name: str, shape: Expansion) -> list[dict[str, Any]]:
    box = rig.case.gearboxes[name]
    rows = []
    for model in result.last.models:
        if model.name.split(".")[0] != name:
            continue
        entry = box.meshes[model.name.split(".")[1]]
        cold, warm = rig.pairs[model.name], model.pair
        shafts = box.gears[entry.pinion].shaft, box.gears[entry.wheel].shaft
        axes = axes_of(rig, name, shape, shafts)
        pinion, wheel = rig.mesh_gears(model.name)
        rows.append(
            {
                "gear_pair": model.name,
                "centre_distance_cold_mm": MM * cold.centre_distance,
                "centre_distance_hot_mm": MM * warm.centre_distance,
                "backlash_cold_mm": MM * cold.transverse_backlash,
                "backlash_hot_mm": MM * warm.transverse_backlash,
                "tip_clearance_cold_mm": MM * min(cold.tip_clearances),
                "tip_clearance_hot_mm": MM * min(warm.tip_clearances),
                "inclination_mrad": MM * axes.inclination,
                "skew_mrad": MM * axes.skew,
                "bulk_pinion_degC": result.last.coupling_state.gear_temperature[pinion] - ZERO,
                "bulk_wheel_degC": result.last.coupling_state.gear_temperature[wheel] - ZERO,
            }
        )
    return rows


def _bearings(rig: Rig, result: PointResult, name: str, shape: Expansion) -> list[dict[str, Any]]:
    rows = []
    for part, entry in rig.case.gearboxes[name].bearings.items():
        full = f"{name}.{part}"
        state = result.last.bearings[full]
        expansion = bearing_expansion(rig, name, shape, entry)
        rows.append(
            {
                "bearing": full,
                "diametral_clearance_cold_um": UM * entry.diametral_clearance,
                "diametral_clearance_hot_um": UM * result.last.coupling_state.bearing_clearance[full],
                "bore_ovality_um": UM * expansion.bore_ovality,
                "minimum_film_um": UM * state.minimum_film,
                "film_temperature_degC": state.film_temperature - ZERO,
                "specific_load_MPa": 1e-6 * state.specific_load,
                "transition_speed_rpm": state.transition_speed * 30.0 / math.pi,
            }
        )
    return rows


def coupling_history(result: PointResult) -> CouplingHistory:
    """Residuals of every iteration."""
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


def fields_of(rig: Rig, result: PointResult) -> list[TemperatureField]:
    """Fields of one held stage for pictures and files."""
    return [
        TemperatureField(
            name,
            result.point.stage,
            rig.models[name].mesh,
            field.temperature,
            result.last.expansion[name].deformed.displacement
            if name in result.last.expansion
            else np.zeros_like(rig.models[name].mesh.points),
            heat_flux(rig.conduction[name], field.temperature),
        )
        for name, field in result.last.fields.items()
    ]
