"""Oil circuits at the held stages: tank, supplies, flows, and how much of heaters and coolers is used."""

from collections.abc import Iterator, Mapping
from typing import Any

from rigdesign.report.sections.section import Draw, ReportSection, Values
from rigdesign.results.result import RunResult

POWERS = ("heater_W", "cooler_W", "pump_W", "machines_W", "room_W")


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
