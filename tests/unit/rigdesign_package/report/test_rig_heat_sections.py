"""Oil circuits and heat of the rig in the report: every source, every limit, the room."""

from dataclasses import replace
from typing import Any

from rigdesign.report.figures.heat import rig_heat_figure
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import results_document
from rigdesign.results.housing import (
    CircuitBalance,
    CircuitDevice,
    CircuitLine,
    HeatSource,
    RigHeat,
    RoomTemperature,
)
from rigdesign.results.quantity import Records
from tests.builders.report import make_result

ZERO = 273.15
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
    room=RoomTemperature(
        temperature=ZERO + 26.6,
        limit=ZERO + 30.0,
        heat=4e3,
        by_air=4e3,
        by_walls=0.0,
        air_flow=0.5,
        needed_air_flow=0.33,
    ),
)


def line(name: str, setpoint: float | None) -> CircuitLine:
    return CircuitLine(
        line=name, setpoint=setpoint, tolerance=1.0, supply=ZERO + 131.9, drain=ZERO + 128.0, back=ZERO + 127.5,
        flow=5.0 / 6e4, heat=-500.0,
    )  # fmt: skip


CIRCUIT = CircuitBalance(
    circuit="warm", stage="dwell", tank=ZERO + 131.5, flow=5.0 / 6e4, heater=900.0, cooler=0.0, pump=100.0,
    machines=0.0, room=1500.0, imbalance=0.0, lines=(line("mesh", ZERO + 140.0), line("free", None)),
    devices=(CircuitDevice(device="heater", power=900.0, needed=1200.0, capability=900.0),),
)  # fmt: skip


def test_a_source_without_a_sink_is_open() -> None:
    assert HEAT.sources[0].open == 0.0
    assert HEAT.imbalance == 0.0
    assert replace(HEAT, input_power=14e3).imbalance == 1e3
    assert HEAT.into("room") == 4e3


def test_the_sections_stand_where_there_is_something_to_say() -> None:
    assert 'id="rig_heat"' not in report_html(make_result())
    assert 'id="oil_circuits"' not in report_html(make_result())


def test_heat_of_the_rig_shows_every_source_and_the_room() -> None:
    page = report_html(replace(make_result(), rig_heat=Records([HEAT])))
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
    assert "<td>1188</td>" in section or '<td class="n">1188</td>' in section


def test_oil_circuits_show_limits_and_what_is_not_held() -> None:
    page = report_html(replace(make_result(), oil_circuits=Records([CIRCUIT])))
    section = page.split('<h2 id="oil_circuits">')[1].split("<h2 id=")[0]
    for text in ("133 %", "<td>no</td>", "131.9", "back in the tank [°C]"):
        assert text in section


def test_both_stand_in_results_json() -> None:
    document = results_document(
        replace(make_result(), rig_heat=Records([HEAT]), oil_circuits=Records([CIRCUIT]))
    )
    assert document["rig_heat"][0]["sources"][2]["sinks_W"]["water"] == 2500.0
    assert document["oil_circuits"][0]["devices"][0]["capability_W"] == 900.0
    assert document["oil_circuits"][0]["lines"][0]["setpoint_degC"] == 140.0
    assert results_document(make_result())["rig_heat"] == []


def test_what_a_source_takes_from_the_oil_stands_to_the_left() -> None:
    axes: Any = rig_heat_figure(HEAT).axes[0]
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        "gearbox test",
        "oil supply warm",
        "machine motor",
    ]
    assert min(patch.get_x() + patch.get_width() for patch in axes.patches) == -0.5
