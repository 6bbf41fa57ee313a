"""Losses by stage and place, oil and its circuits, heat of the whole rig."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

if TYPE_CHECKING:
    from markupsafe import Markup

POWERS = ("heater_W", "cooler_W", "pump_W", "machines_W", "room_W")
COLUMNS = {
    "power_W": "heat [W]",
    "room_W": "to the room [W]",
    "oil_W": "into the oil [W]",
    "water_W": "cooling water [W]",
    "stored_W": "stored [W]",
    "no_heat_W": "no heat [W]",
}
ALWAYS = ("power_W", "room_W", "oil_W")


def _losses(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    by_stage = None
    if result.losses:
        by_stage = draw(figures.losses_by_stage_figure(result.losses), "Power loss by stage and kind")
    return {
        "losses_by_stage": by_stage,
        "rig_flow": _rig_flow(result, oil_stage, draw),
        "flow_stage": oil_stage,
        "oil_rows": [row for row in result.oil if row.stage == oil_stage],
    }


def _details(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures import heat as figures

    stage = views.main_stage(result)
    oil_stage = _oil_stage(result, stage)
    shown: Values = {"losses_by_place": None, "oil": None, "main_stage": stage}
    if result.losses:
        shown["losses_by_place"] = draw(
            figures.losses_by_place_figure(result.losses, stage), f"Power loss by place at stage {stage}"
        )
    if result.oil:
        shown["oil"] = draw(
            figures.oil_figure(result.oil, oil_stage), f"Oil inlet and outlet at stage {oil_stage}"
        )
    return shown


def _oil_stage(result: RunResult, stage: str) -> str:
    """The stage with the most heat, or the first that has oil rows."""
    stages = [row.stage for row in result.oil]
    return stage if stage in stages else next(iter(stages), "")


def _rig_flow(result: RunResult, stage: str, draw: Draw) -> "Markup | None":
    """Heat of the rig at its main held stage."""
    from rigdesign.report.figures.flow import rig_flow_figure

    balance = next((row for row in result.cooler if row["stage"] == stage), None)
    if balance is None:
        return None
    losses = [row for row in result.losses if row.stage == stage]
    figure = rig_flow_figure(losses, [row for row in result.oil if row.stage == stage], balance)
    if figure is None:
        return None
    return draw(figure, f"Heat of the rig from losses to cooler and room at stage {stage}")


LOSSES = ReportSection(id="losses", title="Losses and oil", template="losses.html.j2", values=_losses)
LOSS_DETAILS = ReportSection(
    id="loss_details", title="Losses and oil in detail", template="loss_details.html.j2", values=_details,
    applies=lambda result: bool(result.losses or result.oil), place="appendix",
)  # fmt: skip


def _tables(result: RunResult, draw: Draw) -> Values:
    rows = result.oil_circuits
    return {
        "tanks": [_tank(row) for row in rows],
        "lines": [_line(row, line) for row in rows for line in row["lines"]],
        "devices": [device for row in rows for device in _devices(row)],
    }


def _tank(row: Mapping[str, Any]) -> dict[str, Any]:
    powers = {key.replace("_W", "_kW"): 1e-3 * row[key] for key in POWERS}
    return {
        "circuit": _words(row["circuit"]),
        "stage": row["stage"],
        "tank_degC": row["tank_degC"],
        "flow_l_min": row["flow_l_min"],
    } | powers


def _line(row: Mapping[str, Any], line: Mapping[str, Any]) -> dict[str, Any]:
    held = None
    if line["setpoint_degC"] is not None:
        held = abs(line["supply_degC"] - line["setpoint_degC"]) <= line["tolerance_K"]
    return {
        "circuit": _words(row["circuit"]),
        "line": _words(line["line"]),
        "stage": row["stage"],
        "flow_l_min": line["flow_l_min"],
        "setpoint_degC": line["setpoint_degC"],
        "supply_degC": line["supply_degC"],
        "held": held,
        "drain_degC": line["drain_degC"],
        "back_in_the_tank_degC": line["back_degC"],
        "heat_of_the_consumers_kW": 1e-3 * line["heat_W"],
    }


def _devices(row: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    for device in row["devices"]:
        limit = device["capability_W"]
        yield {
            "circuit": _words(row["circuit"]),
            "device": _words(device["device"]),
            "stage": row["stage"],
            "power_kW": 1e-3 * device["power_W"],
            "needed_for_its_setpoint_kW": 1e-3 * device["needed_W"],
            "most_kW": 1e-3 * limit,
            "used": f"{100.0 * device['needed_W'] / limit:.0f} %" if limit else None,
        }


def _words(name: str) -> str:
    return name.replace("_", " ")


OIL_CIRCUITS = ReportSection(
    id="oil_circuits", title="Oil circuits", template="oil_circuits.html.j2", values=_tables,
    applies=lambda result: bool(result.oil_circuits),
)  # fmt: skip


def _heat(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.heat import rig_heat_figure

    rows = result.rig_heat
    main = next((row for row in rows if row["stage"] == views.main_stage(result)), rows[-1])
    sources = main["sources"]
    used = [key for key in COLUMNS if key in ALWAYS or any(source[key] for source in sources)]
    return {
        "main": main,
        "figure": draw(rig_heat_figure(main), f"Heat of the whole rig by source and sink at stage {main['stage']}"),
        "columns_shown": {key: COLUMNS[key] for key in used},
        "sums": {key: sum(source[key] for source in sources) for key in used},
        "powers": [_powers(row) for row in rows],
        "rooms": [_room(row) for row in rows if row["room"] is not None],
    }  # fmt: skip


def _powers(row: dict[str, Any]) -> dict[str, Any]:
    total = {key: sum(source[key] for source in row["sources"]) for key in ("room_W", "oil_W", "water_W")}
    kilowatts = {key.replace("_W", "_kW"): 1e-3 * value for key, value in total.items()}
    return {
        "stage": row["stage"],
        "at_the_rig_kW": 1e-3 * row["drive_power_W"],
        "from_the_mains_kW": 1e-3 * row["mains_power_W"],
        "with_pumps_and_heaters_kW": 1e-3 * row["input_power_W"],
        "to_the_room_kW": kilowatts["room_kW"],
        "into_the_oil_kW": kilowatts["oil_kW"],
        "cooling_water_kW": kilowatts["water_kW"],
        "imbalance_W": row["open_W"],
    }


def _room(row: dict[str, Any]) -> dict[str, Any]:
    room = row["room"]
    return {
        "stage": row["stage"],
        "heat_kW": 1e-3 * room["heat_W"],
        "by_air_kW": 1e-3 * room["by_air_W"],
        "by_walls_kW": 1e-3 * room["by_walls_W"],
        "temperature_degC": room["temperature_degC"],
        "limit_degC": room["limit_degC"],
        "air_flow_m3_h": room["air_flow_m3_h"],
        "air_flow_that_holds_the_limit_m3_h": room["needed_air_flow_m3_h"],
    }


RIG_HEAT = ReportSection(
    id="rig_heat", title="Heat of the rig", template="rig_heat.html.j2", values=_heat,
    applies=lambda result: bool(result.rig_heat),
)  # fmt: skip
