"""Oil circuits and heat of the rig in the report: every source, every limit, the room."""

from dataclasses import replace
from typing import Any

from rigdesign.report.figures.heat import rig_heat_figure
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import results_document
from rigdesign.results.housing import HeatSource, RigHeat
from rigdesign.results.serialisation.housing import rig_heat_row
from rigdesign.rig_heat.component import Room, room_balance
from tests.builders.report import make_result

ZERO = 273.15
ROOM = Room(air_flow=0.5, supply_temperature=ZERO + 20.0, temperature_limit=ZERO + 30.0)
HEAT = RigHeat(
    stage="dwell",
    sources=(
        HeatSource(name="test", kind="gearbox", power=9e3, sinks={"room": 2e3, "oil": 7e3}),
        HeatSource(name="warm", kind="oil supply", power=1e3, sinks={"room": 1.5e3, "oil": -0.5e3}),
        HeatSource(name="motor", kind="machine", power=3e3, sinks={"room": 0.5e3, "water": 2.5e3}),
    ),
    drive_power=9e3,
    mains_power=12e3,
    input_power=13e3,
    room=room_balance(ROOM, {"all": 4e3}),
)
CIRCUIT = {
    "circuit": "warm", "stage": "dwell", "tank_degC": 131.5, "flow_l_min": 5.0, "heater_W": 900.0, "cooler_W": 0.0,
    "pump_W": 100.0, "machines_W": 0.0, "room_W": 1500.0, "open_W": 0.0,
    "lines": [
        {"line": "mesh", "setpoint_degC": 140.0, "tolerance_K": 1.0, "supply_degC": 131.9, "drain_degC": 128.0,
         "back_degC": 127.5, "flow_l_min": 5.0, "heat_W": -500.0},
        {"line": "free", "setpoint_degC": None, "tolerance_K": 1.0, "supply_degC": 131.9, "drain_degC": 128.0,
         "back_degC": 127.5, "flow_l_min": 5.0, "heat_W": -500.0},
    ],
    "devices": [{"device": "heater", "power_W": 900.0, "needed_W": 1200.0, "capability_W": 900.0}],
}  # fmt: skip


def row() -> dict[str, object]:
    return rig_heat_row(HEAT, ROOM)


def test_a_source_without_a_sink_is_open() -> None:
    assert HEAT.sources[0].open == 0.0
    assert HEAT.imbalance == 0.0
    assert replace(HEAT, input_power=14e3).imbalance == 1e3
    assert HEAT.into("room") == 4e3


def test_the_sections_stand_where_there_is_something_to_say() -> None:
    assert 'id="rig_heat"' not in report_html(make_result())
    assert 'id="oil_circuits"' not in report_html(make_result())


def test_heat_of_the_rig_shows_every_source_and_the_room() -> None:
    page = report_html(replace(make_result(), rig_heat=[row()]))
    section = page.split('<h2 id="rig_heat">')[1].split("<h2 id=")[0]
    for text in (
        "motor",
        "cooling water [W]",
        "oil supply",
        "air flow that holds the limit [m³/h]",
        "from the mains",
    ):
        assert text in section
    assert "stored [W]" not in section
    room = row()["room"]
    assert isinstance(room, dict)
    assert abs(room["needed_air_flow_m3_h"] - 4e3 / (1.204 * 1006 * 10) * 3600) < 10


def test_oil_circuits_show_limits_and_what_is_not_held() -> None:
    page = report_html(replace(make_result(), oil_circuits=[CIRCUIT]))
    section = page.split('<h2 id="oil_circuits">')[1].split("<h2 id=")[0]
    for text in ("133 %", "<td>no</td>", "131.9", "back in the tank [°C]"):
        assert text in section


def test_both_stand_in_results_json() -> None:
    document = results_document(replace(make_result(), rig_heat=[row()], oil_circuits=[CIRCUIT]))
    assert document["rig_heat"][0]["sources"][2]["water_W"] == 2500.0
    assert document["oil_circuits"][0]["devices"][0]["capability_W"] == 900.0
    assert "rig_heat" not in results_document(make_result())


def test_what_a_source_takes_from_the_oil_stands_to_the_left() -> None:
    axes: Any = rig_heat_figure(row()).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        "gearbox test",
        "oil supply warm",
        "machine motor",
    ]
    assert min(patch.get_x() + patch.get_width() for patch in axes.patches) == -0.5
