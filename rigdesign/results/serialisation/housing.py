"""Losses, oil and temperatures as rows of the result."""

from collections.abc import Sequence
from dataclasses import asdict

from rigdesign.coupling.housing_context import BEARING_OIL
from rigdesign.coupling.located_loss import PlacedLoss
from rigdesign.coupling.oil import OilStream
from rigdesign.results.housing import FluidTemperature, GearHeatSplit, HousingTemperatures
from rigdesign.results.thermal import FluidRow, HeatRow, HeatSplitRow, LossRow, OilRow, ThermalResult
from rigdesign.results.units import L_MIN, ZERO
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
