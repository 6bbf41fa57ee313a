"""Heat of the whole rig: every source with its sinks, what the drive takes, and the room."""

from typing import Any

from rigdesign.report import views
from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

COLUMNS = {
    "power_W": "heat [W]",
    "room_W": "to the room [W]",
    "oil_W": "into the oil [W]",
    "water_W": "cooling water [W]",
    "stored_W": "stored [W]",
    "no_heat_W": "no heat [W]",
}
ALWAYS = ("power_W", "room_W", "oil_W")


def _heat(result: RunResult, draw: Draw) -> Values:
    from rigdesign.report.figures.rig_heat import rig_heat_figure

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
