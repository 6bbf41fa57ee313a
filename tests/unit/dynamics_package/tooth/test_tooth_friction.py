"""Friction laws: floors, caps, limits of the mixed law, refusals."""

import math
from dataclasses import replace

import pytest

from dynamics.tooth.friction import (
    Doleschel,
    FrictionError,
    GivenFriction,
    Michaelis,
    Schlenk,
    ToothContact,
    friction_coefficient,
    hertzian_pressure,
    relative_film_thickness,
)

CONTACT = ToothContact(
    line_load=300e3,
    pitch_line_speed=10.0,
    working_pressure_angle=math.radians(22.0),
    reduced_radius=8e-3,
    pinion_diameter=72e-3,
    roughness=0.4e-6,
    viscosity=0.012,
)
OIL = Doleschel(
    solid=0.13,
    solid_pressure_exponent=0.1,
    solid_speed_exponent=-0.05,
    fluid=0.03,
    fluid_pressure_exponent=0.2,
    fluid_speed_exponent=-0.1,
    fluid_viscosity_exponent=0.05,
    pressure_viscosity=1.8e-8,
)


def test_schlenk_by_hand() -> None:
    """0.048 (300 / (7.492 8))^0.2 12^-0.05 0.4^0.25 = 0.0465."""
    result = friction_coefficient(CONTACT, Schlenk())
    sum_speed = 2.0 * 10.0 * math.sin(math.radians(22.0))
    by_hand = 0.048 * (300.0 / (sum_speed * 8.0)) ** 0.2 * 12.0**-0.05 * 0.4**0.25
    assert result.value == pytest.approx(by_hand)
    assert result.value == pytest.approx(0.0465, abs=5e-5)
    assert result.warnings == ()


def test_michaelis_by_hand() -> None:
    sum_speed = 2.0 * 10.0 * math.sin(math.radians(22.0))
    roughness = 3.8 * (0.4 / 72.0) ** 0.25
    by_hand = 0.045 * (300.0 / (sum_speed * 8.0)) ** 0.2 * 12.0**-0.05 * roughness
    assert friction_coefficient(CONTACT, Michaelis()).value == pytest.approx(by_hand)


@pytest.mark.parametrize("law", [Schlenk(), Michaelis()])
def test_lubricant_factor_scales(law: Schlenk | Michaelis) -> None:
    ester = replace(law, lubricant_factor=0.8)
    assert friction_coefficient(CONTACT, ester).value == pytest.approx(
        0.8 * friction_coefficient(CONTACT, law).value
    )


@pytest.mark.parametrize(
    ("changes", "limit", "word"),
    [
        ({"line_load": 20e3}, {"line_load": 150e3}, "150 N/mm"),
        ({"line_load": 0.0}, {"line_load": 150e3}, "150 N/mm"),
        ({"pitch_line_speed": 62.0}, {"pitch_line_speed": 50.0}, "50 m/s"),
        ({"pitch_line_speed": 0.0}, {"pitch_line_speed": 1.0}, "1 m/s"),
    ],
)
def test_outside_the_tests_the_value_at_the_limit_is_used_and_said(changes, limit, word) -> None:
    outside = friction_coefficient(replace(CONTACT, **changes), Schlenk())
    assert outside.value == friction_coefficient(replace(CONTACT, **limit), Schlenk()).value
    assert len(outside.warnings) == 1
    assert word in outside.warnings[0]
    assert friction_coefficient(replace(CONTACT, **limit), Schlenk()).warnings == ()


def test_doleschel_is_solid_without_film_and_fluid_with_a_thick_one() -> None:
    rough = friction_coefficient(replace(CONTACT, roughness=1e-3), OIL)
    smooth = friction_coefficient(replace(CONTACT, roughness=1e-9), OIL)
    assert rough.inputs["fluid_share"] < 1e-3
    assert smooth.inputs["fluid_share"] == 1.0
    pressure = hertzian_pressure(CONTACT, OIL.reduced_modulus) * 1e-9
    assert rough.value == pytest.approx(0.13 * pressure**0.1 * (CONTACT.sum_speed / 0.2) ** -0.05, rel=1e-3)
    fluid = 0.03 * pressure**0.2 * (CONTACT.sum_speed / 8.3) ** -0.1 * (12.0 / 20.0) ** 0.05
    assert smooth.value == pytest.approx(fluid)


def test_doleschel_between_grows_with_roughness() -> None:
    values = [
        friction_coefficient(replace(CONTACT, roughness=r), OIL).value for r in (1e-7, 4e-7, 1e-6, 3e-6)
    ]
    assert values == sorted(values)
    assert values[0] < values[-1]


def test_hertzian_pressure_of_steel() -> None:
    """0.418 sqrt(F' E / rho) for equal steel: 300 N/mm on 8 mm gives 1162 MPa (E 206 GPa)."""
    by_hand = 0.418 * math.sqrt(300.0 * 206e3 / 8.0) * 1e6
    assert hertzian_pressure(CONTACT, 226.4e9) == pytest.approx(by_hand, rel=2e-3)


def test_film_grows_with_speed_to_the_power_of_0_7() -> None:
    slow = relative_film_thickness(CONTACT, 1.8e-8, 226.4e9)
    fast = relative_film_thickness(replace(CONTACT, pitch_line_speed=20.0), 1.8e-8, 226.4e9)
    assert fast / slow == pytest.approx(2.0**0.7)
    assert 0.5 < slow < 3.0


def test_given_friction() -> None:
    assert friction_coefficient(CONTACT, GivenFriction(value=0.05)).value == 0.05
    with pytest.raises(FrictionError, match="0 to 1"):
        friction_coefficient(CONTACT, GivenFriction(value=1.2))


@pytest.mark.parametrize("name", ["viscosity", "roughness", "reduced_radius", "line_load"])
def test_impossible_contact(name: str) -> None:
    with pytest.raises(FrictionError, match=name):
        replace(CONTACT, **{name: -1.0})
