"""Aerated, thicker or other oil: properties by hand, and their way through losses, films and heat balance."""

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.properties.oil import FVA_3, OilError
from rigdesign.rig.oil_supply import bearing_oil, gear_oil
from tests.builders.warm_prototype import base, case_with, lost, open_share, settled

pytestmark = pytest.mark.whole_run

STATE = "gearboxes.test.oil_state"
AT = 350.0


def test_bubbles_take_mass_and_thicken() -> None:
    """10 % air: 0.9 of the density, Hayward's 1 + 1.5 a on the dynamic viscosity, Maxwell on the conductivity."""
    oil = FVA_3.in_state(air_content=0.1)
    assert oil.density(AT) == pytest.approx(0.9 * FVA_3.density(AT))
    assert oil.dynamic_viscosity(AT) == pytest.approx(1.15 * FVA_3.dynamic_viscosity(AT))
    assert oil.heat_capacity(AT) == FVA_3.heat_capacity(AT)
    # spheres that conduct nothing: (1 - a)/(1 + a/2) = 0.857; air conducts a fifth of oil
    assert 0.857 < oil.conductivity(AT) / FVA_3.conductivity(AT) < 0.9


def test_factors_multiply_at_every_temperature() -> None:
    oil = FVA_3.in_state(viscosity_factor=1.2, heat_capacity_factor=0.9)
    for at in (300.0, AT, 400.0):
        assert oil.kinematic_viscosity(at) == pytest.approx(1.2 * FVA_3.kinematic_viscosity(at))
        assert oil.heat_capacity(at) == pytest.approx(0.9 * FVA_3.heat_capacity(at))
    assert oil.density(AT) == FVA_3.density(AT)
    assert FVA_3.in_state() is FVA_3
    with pytest.raises(OilError, match="foam"):
        FVA_3.in_state(air_content=0.4)
    with pytest.raises(OilError, match="viscosity_factor"):
        FVA_3.in_state(viscosity_factor=0.0)


def test_the_state_is_that_of_one_gearbox() -> None:
    rig, _ = settled((f"{STATE}.viscosity_factor", 1.3))
    assert gear_oil(rig, "test").viscosity_factor == bearing_oil(rig, "test").viscosity_factor == 1.3
    assert gear_oil(rig, "reference").viscosity_factor == 1.0


def test_less_heat_capacity_warms_the_oil_more() -> None:
    """The rise of the oil goes as 1/c where the heat stays; films thin and lose less, walls pass some on."""
    (_, before), (rig, after) = settled(), settled((f"{STATE}.heat_capacity_factor", 0.8))
    rises = [
        s.outlet - s.inlet for last in (before, after) for s in last.streams if s.name == "test.bearing_oil"
    ]
    assert 1.1 < rises[1] / rises[0] < 1.25
    assert lost(after, "bearing") < lost(before, "bearing")
    assert open_share(rig, after) < 2e-3


def test_aeration_weakens_the_heat_capacity_flow_and_lowers_the_jet_loss() -> None:
    (_, before), (rig, after) = settled(), settled((f"{STATE}.air_content", 0.1))
    rises = [
        s.outlet - s.inlet for last in (before, after) for s in last.streams if s.name == "test.bearing_oil"
    ]
    assert 1.05 < rises[1] / rises[0] < 1.3
    assert lost(after, "oil_acceleration") == pytest.approx(0.9 * lost(before, "oil_acceleration"), rel=1e-3)
    films = [last.fields["test"].solution.balance.rows for last in (before, after)]
    found = [
        {r.surface: r.coefficient.inputs["conductivity"] for r in rows if r.coefficient and "bearing_film" in r.kind
         and "conductivity" in r.coefficient.inputs}
        for rows in films
    ]  # fmt: skip
    assert found[0] and all(found[1][surface] < 0.9 * value for surface, value in found[0].items())
    walls = [
        next(
            r.coefficient.value
            for r in rows
            if r.coefficient and r.kind == "gear_oil" and "chamber" in r.surface
        )
        for rows in films
    ]
    oils = [gear_oil(one, "test") for one in (base()[0], rig)]
    assert walls[1] / walls[0] == pytest.approx(oils[1].conductivity(400.0) / oils[0].conductivity(400.0))
    assert open_share(rig, after) < 2e-3


def test_thicker_oil_drags_more_in_the_bearings_and_less_at_the_teeth() -> None:
    """Petroff: drag ~ viscosity at one temperature; Schlenk: friction ~ viscosity^-0.05."""
    (_, before), (rig, after) = settled(), settled((f"{STATE}.viscosity_factor", 1.3))
    assert 1.05 < lost(after, "bearing") / lost(before, "bearing") < 1.3
    ratio = after.models[0].friction.value / before.models[0].friction.value
    assert ratio == pytest.approx(1.3**-0.05, rel=5e-3)
    assert after.models[1].friction.value == pytest.approx(before.models[1].friction.value, rel=1e-3)
    assert open_share(rig, after) < 2e-3


@pytest.mark.parametrize(
    "key, value", [("air_content", 0.31), ("viscosity_factor", 0.1), ("heat_capacity_factor", 2.5)]
)
def test_the_state_has_limits(key: str, value: float) -> None:
    with pytest.raises(CaseError, match=key):
        case_with(((f"{STATE}.{key}", value),))
