"""Steady oil circuits: balances, limits, setpoints that are held and that are not."""

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigdesign.base.errors import CaseError, NotConvergedError
from rigdesign.oil_circuit.circuit import Consumer, Coolant, Cooler, Heater, Pipe, Pump, Tank, TankCooler
from rigdesign.oil_circuit.steady import SetpointNotHeldError, steady_circuit
from rigdesign.properties.oil import FVA_3, oil_outlet
from tests.builders.oil_circuit import LITRE_A_MINUTE, ZERO, circuit, cooler, line

PUMP = Pump(flow=30 * LITRE_A_MINUTE, pressure=1e6, efficiency=0.8, heat_share=0.9)


def test_without_devices_the_tank_finds_its_temperature() -> None:
    found = steady_circuit(circuit(), {"gears": 500.0})
    assert found.tank_temperature == pytest.approx(293.15 + 50.0, abs=1e-9)
    assert found.heater is None
    assert found.supply_margin("gears") is None
    assert found.room_loss == pytest.approx(500.0)


def test_return_is_the_outlet_of_the_consumer() -> None:
    found = steady_circuit(circuit(), {"gears": 500.0}).consumers["gears"]
    assert found.return_ == pytest.approx(
        oil_outlet(circuit().oil, found.supply, 15 * LITRE_A_MINUTE, 500.0), abs=1e-7
    )


def test_heater_holds_its_setpoint_with_what_the_walls_lose() -> None:
    found = steady_circuit(circuit(heater=Heater(power_limit=3e3, setpoint=ZERO + 90.0)), {"gears": 100.0})
    assert found.heater is not None
    assert found.tank_temperature == ZERO + 90.0
    assert found.heater.power == pytest.approx(10.0 * 70.0 - 100.0)
    assert found.heater.needed == pytest.approx(found.heater.power)
    assert found.heater.margin == pytest.approx(2400.0)


def test_heater_at_its_limit_leaves_the_supply_cold() -> None:
    """A housing that takes 85.71 W/K makes 6.7 kW at 90 degC of it; 3 kW reach 51.3 degC."""
    cold = {"gears": lambda supply: -(6700.0 / 70.0 - 10.0) * (supply - 293.15)}
    given = circuit(line(setpoint=ZERO + 90.0), heater=Heater(power_limit=3e3, setpoint=ZERO + 90.0))
    found = steady_circuit(given, cold)
    assert found.heater is not None
    assert found.heater.needed == pytest.approx(6700.0, rel=1e-9)
    assert found.heater.power == 3000.0
    assert found.tank_temperature == pytest.approx(293.15 + 70.0 * 3.0 / 6.7, abs=1e-8)
    assert found.supply_margin("gears") == pytest.approx(1.0 - 70.0 * 3.7 / 6.7, abs=1e-7)
    assert "supply temperature = 51.34 degC: cannot be held at 90 degC within 1 K" in found.warnings[0]
    assert "heater: power needed = 6.7 kW: it gives at most 3 kW" in found.warnings[1]
    hard = replace(given, lines=(replace(given.lines[0], hard=True),))
    with pytest.raises(
        SetpointNotHeldError, match=r"lines.gears.setpoint = 90 degC: .* reaches 51.34 degC"
    ) as raised:
        steady_circuit(hard, cold)
    assert raised.value.exit_code == 2


def test_hard_setpoint_that_is_held_is_no_error() -> None:
    given = circuit(line(setpoint=ZERO + 60.0, hard=True, cooler=cooler()), pump=PUMP)
    assert steady_circuit(given, {"gears": 5e3}).lines["gears"].supply == pytest.approx(ZERO + 60.0)


def test_line_cooler_holds_the_supply_or_carries_what_it_can() -> None:
    given = circuit(line(setpoint=ZERO + 60.0, cooler=cooler(heat=5e3)), oil=FVA_3)
    easy = steady_circuit(given, {"gears": 3e3})
    load = easy.line_coolers["gears"]
    assert load.power == pytest.approx(3e3 - easy.room_loss, rel=1e-9)
    assert load.margin > 0.0
    assert easy.warnings == ()
    hard = steady_circuit(given, {"gears": 9e3})
    load = hard.line_coolers["gears"]
    assert load.power == pytest.approx(load.capability)
    assert hard.lines["gears"].supply > ZERO + 65.0
    assert load.needed > load.capability
    assert any("more cooling, or less heat" in text for text in hard.warnings)
    assert any("lines.gears.cooler: power needed" in text for text in hard.warnings)


def test_valve_with_a_band_droops_within_it() -> None:
    tight = line(setpoint=ZERO + 60.0, cooler=cooler(), valve_band=6.0)
    supplies = [
        steady_circuit(circuit(tight), {"gears": heat}).lines["gears"].supply - ZERO - 60.0
        for heat in (1e3, 4e3, 8e3, 12e3)
    ]
    assert supplies == sorted(supplies)
    assert -3.0 < supplies[0] < supplies[-1] < 3.0
    shut = steady_circuit(circuit(tight), {"gears": 100.0})
    assert shut.line_coolers["gears"].power == 0.0


def test_narrow_band_comes_to_the_valve_that_holds() -> None:
    exact = steady_circuit(circuit(line(setpoint=ZERO + 60.0, cooler=cooler())), {"gears": 8e3})
    narrow = line(setpoint=ZERO + 60.0, cooler=cooler(), valve_band=1e-4)
    found = steady_circuit(circuit(narrow), {"gears": 8e3})
    assert found.tank_temperature == pytest.approx(exact.tank_temperature, abs=2e-4)
    assert found.cooler_heat == pytest.approx(exact.cooler_heat, rel=1e-6)


def test_two_supply_temperatures_from_one_tank() -> None:
    """A cold line by its cooler, a warm one by its trim heater, tank by its heater."""
    lines = (
        line("warm", 5.0, setpoint=ZERO + 80.0, trim_power_limit=5e3),
        line("cold", 5.0, setpoint=ZERO + 40.0, cooler=cooler()),
    )
    given = circuit(*lines, heater=Heater(power_limit=8e3, setpoint=ZERO + 60.0))
    found = steady_circuit(given, {"warm": 200.0, "cold": 300.0})
    assert {name: each.supply - ZERO for name, each in found.lines.items()} == pytest.approx(
        {"warm": 80, "cold": 40}
    )
    heat = found.heater_power + 500.0
    assert heat == pytest.approx(found.cooler_heat + found.room_loss, rel=1e-12)
    both = [text for text in found.warnings if "heat from heaters to coolers" in text]
    assert len(both) == 1
    weak = replace(given, lines=(replace(lines[0], trim_power_limit=1e3), lines[1]))
    short = steady_circuit(weak, {"warm": 200.0, "cold": 300.0})
    assert short.trim_heaters["warm"].power == 1e3
    assert short.lines["warm"].supply < ZERO + 72.0


@pytest.mark.parametrize("flow", [None, 10 * LITRE_A_MINUTE], ids=["return", "own pump"])
def test_tank_cooler_holds_its_setpoint_or_carries_what_it_can(flow: float | None) -> None:
    placed = TankCooler(cooler=cooler(), setpoint=ZERO + 60.0, flow=flow)
    held = steady_circuit(circuit(tank_cooler=placed), {"gears": 4e3})
    assert held.tank_cooler is not None
    assert held.tank_temperature == ZERO + 60.0
    assert held.tank_cooler.power == pytest.approx(4e3 - 400.0)
    assert held.tank_cooler.margin > 0.0
    over = steady_circuit(circuit(tank_cooler=placed), {"gears": 30e3})
    assert over.tank_cooler is not None
    assert over.tank_temperature > ZERO + 62.0
    assert over.tank_cooler.margin < 0.0
    assert any("tank_cooler: power needed" in text for text in over.warnings)
    idle = steady_circuit(circuit(tank_cooler=placed), {"gears": 100.0})
    assert idle.tank_cooler is not None
    assert idle.tank_cooler.power == 0.0


def test_cooler_in_the_return_sees_hotter_oil_than_one_with_its_own_pump() -> None:
    temperatures = [
        steady_circuit(
            circuit(tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 60.0, flow=flow)), {"gears": 30e3}
        ).tank_temperature
        for flow in (None, 15 * LITRE_A_MINUTE)
    ]
    assert temperatures[0] < temperatures[1]


def test_heater_and_cooler_of_the_tank_between_their_setpoints_both_rest() -> None:
    given = circuit(
        heater=Heater(power_limit=3e3, setpoint=ZERO + 50.0),
        tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 70.0),
    )
    for heat, temperature in ((200.0, 50.0), (400.0, 60.0), (900.0, 70.0)):
        assert steady_circuit(given, {"gears": heat}).tank_temperature == pytest.approx(ZERO + temperature)


def test_pipes_cool_as_the_exponential_law() -> None:
    given = circuit(
        line(supply_pipe=Pipe(wall_conductance=40.0)),
        oil=FVA_3,
        heater=Heater(power_limit=9e3, setpoint=363.15),
    )
    found = steady_circuit(given, {"gears": 0.0}).lines["gears"]
    rate = found.mass_flow * FVA_3.heat_capacity(363.15)
    assert found.supply - 293.15 == pytest.approx(70.0 * math.exp(-40.0 / rate), rel=1e-9)
    assert found.room_loss == pytest.approx(rate * (363.15 - found.supply), rel=1e-9)


def test_pump_heat_ends_in_the_oil_and_the_rest_in_the_room() -> None:
    found = steady_circuit(circuit(pump=PUMP), {"gears": 0.0})
    assert found.pump_heat == pytest.approx(0.9 * PUMP.shaft_power)
    assert found.room_loss == pytest.approx(PUMP.shaft_power)


def test_what_the_jets_carry_into_the_gearbox_is_not_heat_of_the_pump_as_well() -> None:
    """Shaft power of the pump = its heat in oil and room + jets, which are part of the heat of the gears."""
    jets, friction = 40.0, 500.0
    fed = replace(line(), consumers=(Consumer(name="gears", flow=15 * LITRE_A_MINUTE, jet_power=jets),))
    found = steady_circuit(circuit(fed, pump=PUMP), {"gears": friction + jets})
    assert found.pump_heat + found.pump_to_room + jets == pytest.approx(PUMP.shaft_power)
    assert found.room_loss == pytest.approx(PUMP.shaft_power + friction)


def test_two_consumers_of_a_line_mix_by_their_flows() -> None:
    shared = replace(
        line(),
        consumers=(
            Consumer(name="a", flow=10 * LITRE_A_MINUTE),
            Consumer(name="b", flow=5 * LITRE_A_MINUTE),
        ),
    )
    found = steady_circuit(circuit(shared, oil=FVA_3), {"a": 0.0, "b": 900.0})
    a, b = found.consumers["a"], found.consumers["b"]
    assert a.return_ == pytest.approx(a.supply)
    assert found.lines["gears"].drain == pytest.approx((2.0 * a.return_ + b.return_) / 3.0)


@settings(max_examples=40, deadline=None)
@given(
    heats=st.tuples(st.floats(-400.0, 3e4), st.floats(-400.0, 2e4), st.floats(0.0, 200.0)),
    limits=st.tuples(st.floats(0.0, 1e4), st.floats(0.0, 5e3), st.floats(1e3, 4e4)),
    band=st.sampled_from([0.0, 5.0]),
    returns=st.booleans(),
)
def test_the_balance_closes(
    heats: tuple[float, float, float], limits: tuple[float, float, float], band: float, returns: bool
) -> None:
    pipe = Pipe(volume=2e-3, wall_conductance=4.0)
    lines = (
        line("warm", setpoint=ZERO + 80.0, trim_power_limit=limits[1], supply_pipe=pipe, return_pipe=pipe),
        line("cold", setpoint=ZERO + 40.0, cooler=cooler(limits[2]), valve_band=band, return_pipe=pipe),
    )
    given_circuit = circuit(
        *lines,
        pump=PUMP,
        heater=Heater(power_limit=limits[0], setpoint=ZERO + 60.0),
        tank_cooler=TankCooler(cooler=cooler(), setpoint=ZERO + 85.0, flow=None if returns else 2e-4),
    )
    found = steady_circuit(
        given_circuit, {"warm": heats[0], "cold": lambda supply: heats[1] - heats[2] * (supply - 300.0)}
    )
    into = [found.heater_power, found.pump_heat, *(each.heat for each in found.consumers.values())]
    assert abs(found.imbalance) <= 1e-9 * max(map(abs, [*into, found.cooler_heat]))


def test_no_way_out_for_the_heat_is_said() -> None:
    tight = Tank(volume=0.1, fill=0.08)
    with pytest.raises(NotConvergedError, match=r"test: tank temperature: no balance .* 5 kW are left over"):
        steady_circuit(circuit(tank=tight), {"gears": 5e3})


@pytest.mark.parametrize(
    ("heats", "words"),
    [({}, "gears: has no value"), ({"gears": 1.0, "jets": 1.0}, "jets: is no consumer of the circuit")],
)
def test_heats_must_be_those_of_the_consumers(heats: dict[str, float], words: str) -> None:
    with pytest.raises(CaseError, match=words):
        steady_circuit(circuit(), heats)


def test_oil_that_expands_beyond_the_tank_is_reported() -> None:
    full = Tank(volume=0.1, fill=0.098, wall_conductance=10.0)
    found = steady_circuit(circuit(tank=full), {"gears": 800.0})
    assert any("above the 100 l of the tank once the lines drain" in text for text in found.warnings)


def test_coolant_that_boils_is_reported() -> None:
    drip = Cooler(conductance=500.0, coolant=Coolant(flow=LITRE_A_MINUTE, inlet_temperature=ZERO + 15.0))
    found = steady_circuit(circuit(line(setpoint=ZERO + 140.0, cooler=drip)), {"gears": 12e3})
    assert any(text.startswith("test.lines.gears.cooler: coolant outlet") for text in found.warnings)
