"""Conductance of pressed joints: hand values, limits, range."""

import pytest

from thermal.films.joint_conductance import GapFilling, RoughContact, pressed_joint
from thermal.films.law import ExchangeLaw, FilmError


def foot(pressure: float = 5e6, **changes: float) -> ExchangeLaw:
    """Ground steel on cast iron, 2 um rms together."""
    given: dict[str, float] = {
        "pressure": pressure, "hardness": 2.5e9, "roughness": 2e-6, "slope": 0.15, "conductivity_a": 45.0,
        "gap_conductivity": 0.0, "gas_parameter": 0.0,
    } | changes  # fmt: skip
    faces = {name: given[name] for name in ("pressure", "hardness", "roughness", "slope")}
    filling = GapFilling(conductivity=given["gap_conductivity"], gas_parameter=given["gas_parameter"])
    return pressed_joint(RoughContact(**faces), (given["conductivity_a"], 50.0), filling)


def test_hand_value_dry() -> None:
    """k = 47.37, m/s = 75,000, (2e-3)^0.95 = 2.729e-3: 1.25 x 47.37 x 75,000 x 2.729e-3 = 12,119."""
    assert foot()(300.0, 300.0).value == pytest.approx(12119.0, rel=1e-3)


def test_hand_value_of_the_gaps() -> None:
    """Y = 1.53 x 2 um x (2e-3)^-0.097 = 5.591 um; oil 0.13: 23,250; air 0.026 with M = 0.37 um: 4,361."""
    dry = foot()(300.0, 300.0).value
    assert foot(gap_conductivity=0.13)(300.0, 300.0).value - dry == pytest.approx(23250.0, rel=1e-3)
    air = foot(gap_conductivity=0.026, gas_parameter=0.37e-6)(300.0, 300.0).value - dry
    assert air == pytest.approx(4361.0, rel=1e-3)


def test_twice_the_pressure_gives_almost_twice_the_conductance() -> None:
    ratio = foot(1e7)(300.0, 300.0).value / foot(5e6)(300.0, 300.0).value
    assert ratio == pytest.approx(2.0**0.95)


def test_a_pressure_outside_of_the_range_warns_and_the_record_names_all_inputs() -> None:
    record = foot(1e3)(300.0, 300.0)
    assert record.warnings == ("p/H = 4e-07 is outside 1e-05 to 0.02; give a measured conductance",)
    assert foot()(300.0, 300.0).warnings == ()
    assert len(record.inputs) == 8
    assert "Yovanovich" in record.source


@pytest.mark.parametrize("field", ["pressure", "hardness", "conductivity_a", "roughness", "slope"])
def test_impossible_inputs_are_refused(field: str) -> None:
    with pytest.raises(FilmError, match=f"{field} = 0.0 .*must be greater than 0"):
        foot(**{field: 0.0})
