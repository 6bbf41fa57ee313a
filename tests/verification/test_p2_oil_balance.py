"""What stands in the printed heats of the main rig of P2 (390 kW, 733 l/min, 80, 28 and 4.2 kW): arithmetic.

P2 prints: 390 kW total power dissipation of the rig, absorbed by 733 l/min in three circuits (warm: tooth mesh of the
test gearbox, 140 degC; cold 1: reference and transmission gears; cold 2: all journal bearings, 40 degC); 80 kW by the
tooth mesh and about 28 kW by the bearings of the test gearbox; 4.2 kW from the test gearbox to the room "in addition
to" the 390 kW. P2 names no oil, no flow of a single circuit and no pump.
"""

import pytest

from rigdesign.oil_circuit.circuit import Circuit, Consumer, Coolant, Cooler, Pump, SupplyLine, Tank
from rigdesign.oil_circuit.steady import SteadyCircuit, steady_circuit
from rigdesign.properties.oil import MIL_PRF_23699, OILS
from rigdesign.rig_heat.component import Room, room_balance
from tests.published.main_rig_oil import oil_balance_rows

ZERO = 273.15
TOTAL, FLOW = 390e3, 733e-3 / 60.0
MESH, BEARINGS = 80e3, 28e3
WARM, COLD = ZERO + 140.0, ZERO + 40.0
TO_AIR = {"field, convection": 1179.0, "field, radiation": 706.0, "warm housing": 800.0, "cold housing": 962.0,
          "housing, radiation": 617.0}  # fmt: skip
RISE = 20.0
"""P2 takes 160 degC for the warm oil that comes back [K]."""


def capacity(inlet: float, rise: float) -> float:
    """rho c of the oil, density as fed, heat capacity at the mean [J/(m3 K)]."""
    oil = MIL_PRF_23699
    return oil.density(inlet) * oil.heat_capacity(inlet + 0.5 * rise)


def warm_flow() -> float:
    """Flow [m3/s] whose rise by 20 K carries the 80 kW of the mesh."""
    return MESH / (capacity(WARM, RISE) * RISE)


def test_the_whole_flow_takes_390_kw_at_16_to_20_kelvin_whatever_the_oil() -> None:
    """Least for the ester fed at 140 degC, most for FVA 3A there; fed at 40 degC 17 to 18 K."""
    rises = {
        (name, fed): TOTAL / (oil.density(fed) * oil.heat_capacity(fed) * FLOW)
        for name, oil in OILS.items()
        for fed in (COLD, WARM)
    }
    assert min(rises.values()) == pytest.approx(16.34, abs=5e-3)
    assert max(rises.values()) == pytest.approx(19.63, abs=5e-3)
    assert all(17.0 < rise < 18.5 for (_, fed), rise in rises.items() if fed == COLD)


def test_the_aviation_oil_warms_by_17_kelvin_cold_and_16_warm() -> None:
    """981.75 kg/m3, 1900 J/(kg K), 0.012217 m3/s: 22.79 kW/K; at 140 degC 908.75, 2150: 23.87 kW/K."""
    oil = MIL_PRF_23699
    rates = [oil.density(fed) * oil.heat_capacity(fed) * FLOW for fed in (COLD, WARM)]
    assert rates == pytest.approx([22.79e3, 23.87e3], rel=1e-3)
    assert [TOTAL / rate for rate in rates] == pytest.approx([17.1, 16.3], abs=0.05)


def test_80_kw_at_20_kelvin_are_a_sixth_of_the_flow() -> None:
    """The 20 K belong to the warm oil: 121 l/min carry the mesh, 612 l/min are left for 310 kW at 16 K."""
    assert warm_flow() * 6e4 == pytest.approx(121.4, abs=0.1)
    cold_flow, cold_heat = FLOW - warm_flow(), TOTAL - MESH
    assert cold_flow * 6e4 == pytest.approx(611.6, abs=0.1)
    assert cold_heat / (cold_flow * capacity(COLD, 16.0)) == pytest.approx(16.1, abs=0.1)


def test_the_test_gearbox_is_28_percent_of_the_sum() -> None:
    """80 + 28 = 108 kW; 282 kW are left for reference and transmission gearbox, meshes and bearings."""
    assert pytest.approx(0.277, abs=5e-4) == (MESH + BEARINGS) / TOTAL
    assert TOTAL - MESH - BEARINGS == 282e3


def test_4_2_kw_are_4264_w_cut_and_stand_outside_the_390() -> None:
    """The 345 W into the bearing oil are no part of it; it is 1.1 % of what the oil carries."""
    to_air = sum(TO_AIR.values())
    assert to_air == 4264.0
    assert round(to_air / 1e3, 1) == 4.3
    assert to_air / TOTAL == pytest.approx(0.011, abs=1e-4)
    assert sum((*TO_AIR.values(), 345.23)) == pytest.approx(4609.23)


def cooled(name: str, flow: float, setpoint: float, pump: Pump | None = None) -> Circuit:
    """A circuit whose cooler holds the printed supply temperature."""
    cooler = Cooler(conductance=20e3, coolant=Coolant(flow=15e-3, inlet_temperature=ZERO + 20.0))
    line = SupplyLine(
        name=name, consumers=(Consumer(name=name, flow=flow),), setpoint=setpoint, hard=True, cooler=cooler
    )
    return Circuit(name=name, oil=MIL_PRF_23699, tank=Tank(volume=2.0, fill=1.5), lines=(line,), pump=pump)


def circuits(pump_pressure: float = 0.0) -> list[SteadyCircuit]:
    """Warm circuit with the mesh, cold circuit (1 and 2) with the rest."""
    flows = {"warm": (warm_flow(), WARM, MESH), "cold": (FLOW - warm_flow(), COLD, TOTAL - MESH)}
    return [
        steady_circuit(
            cooled(name, flow, supply, Pump(flow=flow, pressure=pump_pressure, efficiency=0.8)), {name: heat}
        )
        for name, (flow, supply, heat) in flows.items()
    ]


def test_circuits_with_the_printed_temperatures_carry_the_printed_sum() -> None:
    warm, cold = circuits()
    assert warm.consumers["warm"].return_ - ZERO == pytest.approx(160.0, abs=1e-6)
    assert warm.cooler_heat + cold.cooler_heat == pytest.approx(TOTAL, rel=1e-9)
    assert [found.warnings for found in (warm, cold) if found.supply_margin(found.circuit.name) != 1.0] == []


def test_pumps_add_15_kw_that_p2_does_not_name() -> None:
    """733 l/min at 10 bar and 0.8: 15.3 kW of shaft power end in the oil, more than the 4.2 kW to the room."""
    found = circuits(pump_pressure=1e6)
    pumps = sum(each.pump_heat for each in found)
    assert pumps == pytest.approx(FLOW * 1e6 / 0.8)
    assert pumps == pytest.approx(15.27e3, rel=1e-3)
    assert sum(each.cooler_heat for each in found) == pytest.approx(TOTAL + pumps, rel=1e-9)


def test_the_room_needs_1300_m3_an_hour_for_the_test_gearbox_alone() -> None:
    """4264 W at a rise of 10 K in air of 20 degC: 4264 / (1.204 * 1006 * 10) = 0.352 m3/s."""
    room = Room(air_flow=1.0, supply_temperature=ZERO + 20.0, temperature_limit=ZERO + 30.0)
    needed = room_balance(room, TO_AIR).needed_air_flow
    assert needed is not None
    assert needed * 3600.0 == pytest.approx(1267.0, rel=5e-3)


def test_the_rows_of_validate_have_these_numbers() -> None:
    rows = {row.id: row for row in oil_balance_rows()}
    expected = {
        "P2-oil-warm-flow": 121.4,
        "P2-oil-test-gearbox": 0.277,
        "P2-oil-room": 0.0108,
        "P2-oil-pumps": 15.27e3,
    }
    assert {name: row.computed for name, row in rows.items()} == pytest.approx(expected, rel=3e-3)
    assert {row.basis for row in rows.values()} == {"arithmetic"}
    assert "612 l/min" in rows["P2-oil-warm-flow"].assumptions
    assert "16.1 K" in rows["P2-oil-warm-flow"].assumptions
