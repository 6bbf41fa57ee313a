"""Oil coolers against hand formulas, a second method, and what they refuse."""

import math

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.oil_circuit.circuit import Arrangement, Coolant, Cooler, RatedPoint
from rigdesign.properties.oil import FVA_3, MIL_PRF_23699
from tests.builders.oil_circuit import LITRE_A_MINUTE, WATER, ZERO, cooler

OIL_FLOW = 30 * LITRE_A_MINUTE
HOT = ZERO + 90.0
MASS_FLOW = FVA_3.density(HOT) * OIL_FLOW


def test_water_has_its_table_values() -> None:
    density, heat_capacity = 999.2, 4184.0  # 15 degC, 3 bar (IAPWS)
    assert WATER.capacity_rate == pytest.approx(density * heat_capacity * WATER.flow, rel=2e-3)
    assert WATER.boiling_temperature == pytest.approx(ZERO + 133.52, abs=0.02)


@pytest.mark.parametrize("arrangement", ["counterflow", "parallel", "crossflow approximate", "S&T"])
def test_carries_the_heat_it_is_rated_with(arrangement: Arrangement) -> None:
    rated = RatedPoint(oil=FVA_3, heat=20e3, flow=OIL_FLOW, inlet_temperature=HOT)
    found = Cooler.from_rated_point(rated, WATER, arrangement)
    assert found.carried(FVA_3, MASS_FLOW, HOT) == pytest.approx(20e3, rel=1e-9)


def test_rated_point_with_a_heat_capacity_that_changes() -> None:
    rated = RatedPoint(oil=MIL_PRF_23699, heat=20e3, flow=OIL_FLOW, inlet_temperature=HOT)
    found = Cooler.from_rated_point(rated, WATER)
    assert found.carried(MIL_PRF_23699, MIL_PRF_23699.density(HOT) * OIL_FLOW, HOT) == pytest.approx(
        20e3, rel=1e-9
    )


def test_heat_is_conductance_times_log_mean_difference() -> None:
    found = cooler()
    heat = found.carried(FVA_3, MASS_FLOW, HOT)
    oil_out = HOT - heat / (MASS_FLOW * 2000.0)
    hot, cold = HOT - found.coolant_outlet(heat), oil_out - WATER.inlet_temperature
    assert heat == pytest.approx(found.conductance * (hot - cold) / math.log(hot / cold), rel=1e-9)


def test_shell_and_tube_by_the_formula_of_bergman() -> None:
    found = Cooler(conductance=800.0, coolant=WATER, arrangement="S&T")
    least, most = sorted((MASS_FLOW * 2000.0, WATER.capacity_rate))
    ratio, units = least / most, 800.0 / least
    root = math.sqrt(1 + ratio**2)
    grown = math.exp(-units * root)
    effectiveness = 2 / (1 + ratio + root * (1 + grown) / (1 - grown))
    expected = effectiveness * least * (HOT - WATER.inlet_temperature)
    assert found.carried(FVA_3, MASS_FLOW, HOT) == pytest.approx(expected, rel=1e-9)


def test_more_oil_or_hotter_oil_gives_more_heat_and_cold_oil_none() -> None:
    found = cooler()
    by_flow = [
        found.carried(FVA_3, share * MASS_FLOW, HOT) for share in (0.0, 1e-6, 0.01, 0.1, 0.5, 1.0, 2.0)
    ]
    by_temperature = [found.carried(FVA_3, MASS_FLOW, ZERO + t) for t in (15.0, 16.0, 40.0, 90.0)]
    for values in (by_flow, by_temperature):
        assert values[0] == 0.0
        assert values == sorted(values)
    assert found.carried(FVA_3, MASS_FLOW, ZERO + 5.0) == 0.0


def test_never_below_the_coolant() -> None:
    huge = Cooler(conductance=1e6, coolant=Coolant(flow=1.0, inlet_temperature=ZERO + 15.0))
    assert huge.carried(FVA_3, MASS_FLOW, HOT) <= MASS_FLOW * 2000.0 * 75.0 * (1 + 1e-12)


def test_glycol_has_no_boiling_point_and_cools_less() -> None:
    glycol = Coolant(flow=WATER.flow, inlet_temperature=ZERO + 15.0, fluid="INCOMP::MEG[0.3]")
    assert glycol.boiling_temperature is None
    assert glycol.capacity_rate < WATER.capacity_rate
    assert Cooler(conductance=1e3, coolant=glycol).warnings("cooler", 1e9) == ()


def test_coolant_that_would_boil_is_reported() -> None:
    drip = Cooler(conductance=1e3, coolant=Coolant(flow=LITRE_A_MINUTE, inlet_temperature=ZERO + 15.0))
    (text,) = drip.warnings("warm.cooler", 10e3)
    assert text.startswith("warm.cooler: coolant outlet = 158")
    assert "above boiling, 133.5 degC at 3 bar" in text
    assert drip.warnings("warm.cooler", 1e3) == ()


def test_refuses_a_rated_heat_beyond_any_area() -> None:
    assert pytest.approx(64.72e3, rel=1e-4) == MASS_FLOW * 2000.0 * 75.0
    with pytest.raises(CaseError, match=r"cooler.rated.heat = 90 kW: must be below the 64\.72 kW"):
        cooler(heat=90e3)


def test_refuses_a_rated_point_colder_than_the_coolant() -> None:
    rated = RatedPoint(oil=FVA_3, heat=1e3, flow=OIL_FLOW, inlet_temperature=ZERO + 10.0)
    with pytest.raises(CaseError, match="inlet_temperature"):
        Cooler.from_rated_point(rated, WATER)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"fluid": "Beer"}, "coolant.fluid = Beer at 15 degC, 3 bar: CoolProp has no properties"),
        ({"inlet_temperature": ZERO + 150.0}, "must be a liquid, is gas"),
    ],
)
def test_refuses_a_coolant_that_is_no_liquid(given: dict[str, object], words: str) -> None:
    coolant = Coolant(**{"flow": 1e-4, "inlet_temperature": ZERO + 15.0, **given})  # type: ignore[arg-type]
    with pytest.raises(CaseError) as raised:
        Cooler(conductance=1e3, coolant=coolant).carried(FVA_3, MASS_FLOW, ZERO + 200.0)
    assert words in str(raised.value)
