"""Parts of an oil circuit: what they refuse, and the laws of pump, pipe and heat content."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigdesign.base.errors import CaseError
from rigdesign.oil_circuit.circuit import (
    Consumer,
    HeatContent,
    Heater,
    Pipe,
    Pump,
    Tank,
    TankCooler,
    enthalpy,
    temperature_at,
)
from rigdesign.properties.oil import FVA_3, OILS, oil_outlet
from tests.builders.oil_circuit import LITRE_A_MINUTE, TANK, ZERO, circuit, cooler, line

PIPE = Pipe(volume=0.035)


@pytest.mark.parametrize(
    ("build", "key", "words"),
    [
        (lambda: Tank(volume=0.1, fill=0.12), "tank.fill", "100 l"),
        (lambda: Tank(volume=0.1, fill=0.02, suction_minimum=0.03), "tank.fill", "above 0.03 m3"),
        (lambda: Tank(volume=math.nan, fill=0.02), "tank.volume", "above 0"),
        (lambda: Pump(flow=1e-3, pressure=1e6, efficiency=0.0), "pump.efficiency", "within 0 to 1"),
        (lambda: Pump(flow=1e-3, pressure=1e6, efficiency=1.2), "pump.efficiency", "within 0 to 1"),
        (lambda: Heater(power_limit=-1.0, setpoint=350.0), "heater.power_limit", "at least 0"),
        (lambda: Heater(power_limit=math.inf, setpoint=350.0), "heater.power_limit", "at least 0"),
        (lambda: Consumer(name="test.gear_oil", flow=0.0), "test.gear_oil.flow", "feed the consumer"),
        (lambda: Pipe(volume=-1e-3), "pipe.volume", "at least 0"),
        (lambda: line(cooler=cooler()), "lines.gears.setpoint", "missing"),
        (lambda: line(hard=True), "lines.gears.setpoint", "missing"),
        (
            lambda: line(setpoint=350.0, valve_band=3.0, trim_power_limit=1e3, cooler=cooler()),
            "lines.gears.valve_band",
            "must be 0 with a trim heater",
        ),
        (lambda: replace(line(), consumers=()), "lines.gears.consumers", "at least one"),
        (
            lambda: circuit(line(supply_pipe=PIPE, return_pipe=PIPE)),
            "tank.fill",
            "hold 70 l, which leaves 10 l in the tank; the pump needs more than 20 l",
        ),
        (lambda: circuit(line(), line()), "lines", "must occur once"),
        (
            lambda: circuit(pump=Pump(flow=10 * LITRE_A_MINUTE, pressure=1e6, efficiency=0.8)),
            "pump.flow",
            "15 l/min of all consumers",
        ),
        (
            lambda: circuit(
                heater=Heater(power_limit=1e3, setpoint=ZERO + 60.0, band=4.0),
                tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 63.0, band=2.0),
            ),
            "heater.setpoint",
            "work against each other",
        ),
    ],
)
def test_refuses_what_cannot_be(build: Callable[[], object], key: str, words: str) -> None:
    with pytest.raises(CaseError) as raised:
        build()
    assert key in [fault.path for fault in raised.value.faults]
    assert words in str(raised.value)


def test_holdup_of_consumers_counts_as_oil_out_of_the_tank() -> None:
    held = replace(line(), consumers=(Consumer(name="gears", flow=15 * LITRE_A_MINUTE, holdup=0.03),))
    assert circuit(held).running_fill == pytest.approx(0.05)
    with pytest.raises(CaseError, match="runs dry"):
        circuit(held, tank=replace(TANK, suction_minimum=0.05))


def test_pump_heat_splits_by_flow_and_its_rest_returns_over_the_relief_valve() -> None:
    pump = Pump(flow=40 * LITRE_A_MINUTE, pressure=1e6, efficiency=0.8, heat_share=0.9)
    assert pump.shaft_power == pytest.approx(1e6 * 40e-3 / 60 / 0.8)  # 833 W
    lines = line(litres=15.0), line("bearings", litres=5.0)
    found = circuit(*lines, pump=pump)
    parts = [*(found.line_pump_heat(each) for each in lines), found.relief_heat]
    assert parts == pytest.approx([0.9 * pump.shaft_power * share for share in (15 / 40, 5 / 40, 20 / 40)])


def test_a_pump_cannot_make_jets_faster_than_its_pressure_allows() -> None:
    """15 l/min with 200 W in the jets are 8 bar."""
    fed = replace(line(), consumers=(Consumer(name="gears", flow=15 * LITRE_A_MINUTE, jet_power=200.0),))
    pump = Pump(flow=40 * LITRE_A_MINUTE, pressure=7.9e5, efficiency=0.8)
    with pytest.raises(CaseError, match=r"pump\.pressure.*7\.9 bar.*at least the 8 bar"):
        circuit(fed, pump=pump)
    assert circuit(fed, pump=replace(pump, pressure=8.1e5)).pump_heat == pytest.approx(675.0 - 200.0)


def test_ten_bar_are_0_6_kelvin() -> None:
    rise = 1e6 / (FVA_3.density(ZERO + 60.0) * FVA_3.heat_capacity(ZERO + 60.0))
    assert rise == pytest.approx(0.57, abs=5e-3)


@pytest.mark.parametrize("units", [1e-6, 0.1, 1.0, 5.0])
def test_pipe_conductance_at_the_outlet_is_that_of_a_pipe_that_cools_along(units: float) -> None:
    rate = 500.0
    conductance = Pipe(wall_conductance=units * rate).outlet_conductance(rate)
    outlet = (rate * 80.0 + conductance * 20.0) / (rate + conductance)
    assert outlet == pytest.approx(20.0 + 60.0 * math.exp(-units), rel=1e-12)


def test_pipe_without_flow_has_its_wall() -> None:
    assert Pipe(volume=1e-3, wall_conductance=3.0).outlet_conductance(0.0) == 3.0


@given(
    st.sampled_from(list(OILS.values())), st.floats(253.0, 470.0), st.floats(0.0, 500.0), st.floats(0.0, 1e5)
)
def test_temperature_and_content_turn_into_each_other(
    oil: object, temperature: float, mass: float, body: float
) -> None:
    content = HeatContent(oil=oil, mass=mass + 0.1, body=body)  # type: ignore[arg-type]
    assert content.temperature(content.at(temperature)) == pytest.approx(temperature, abs=1e-9)


@pytest.mark.parametrize("oil", list(OILS.values()), ids=list(OILS))
def test_enthalpy_is_what_the_outlet_of_a_consumer_has_taken_up(oil: object) -> None:
    flow, inlet, heat = 10 * LITRE_A_MINUTE, ZERO + 40.0, 9e3
    mass_flow = oil.density(inlet) * flow  # type: ignore[attr-defined]
    outlet = temperature_at(oil, enthalpy(oil, inlet) + heat / mass_flow)  # type: ignore[arg-type]
    assert outlet == pytest.approx(oil_outlet(oil, inlet, flow, heat), abs=1e-8)  # type: ignore[arg-type]
