"""Windage of discs, teeth and shafts."""

import math
from dataclasses import replace

import pytest

from dynamics.losses.loss import LossError
from dynamics.losses.windage import (
    LAMINAR_LIMIT,
    GearRotor,
    Mist,
    anderson_loewenthal,
    disc_coefficient,
    gear_windage,
    mist_density,
    shaft_windage,
    tooth_coefficient,
)
from tests.builders.p2_gears import spur_pair

AIR = Mist(density=1.2, viscosity=1.8e-5)
HOT_AIR = Mist(density=0.83, viscosity=2.4e-5)
TEST_SPEED = 12000 * math.pi / 30


def prototype_pinion() -> GearRotor:
    """P2, Figure 7: z 99, m 1, b 7, x1 = 0; made from the gear pair."""
    pair = spur_pair()
    return GearRotor.of_pair(pair, 0)


def diab_gear_1() -> GearRotor:
    """Gear 1 of Diab et al.: pitch radius 144 mm, m 8, z 36, b 30 mm, standard addendum."""
    pressure = math.radians(20.0)
    tip = math.acos(0.144 * math.cos(pressure) / 0.152)
    opening = math.pi / 36 + 2.0 * (math.tan(tip) - tip - math.tan(pressure) + pressure)
    return GearRotor(pitch_radius=0.144, tip_radius=0.152, face_width=0.03, teeth=36, tip_space_angle=opening)


def test_smooth_disc_rules_out_dawson() -> None:
    """1 m disc at 1000 rpm: about 180 W of skin friction in air alone; Dawson's formula read in W gives 4.8 W
    for a gear of that size (m 16, b 300 mm), less than the disc inside it.
    """
    omega = 1000 * math.pi / 30
    disc = 0.5 * 1.2 * omega**3 * 0.5**5 * disc_coefficient(AIR.reynolds(omega, 0.5))
    dawson = 1000.0**2.9 * (0.16 * 1000.0**3.9 + 1000.0**2.9 * 300.0**0.75 * 16.0**1.15) * 1e-20
    assert disc == pytest.approx(177.0, rel=0.02)
    assert dawson == pytest.approx(4.8, rel=0.05)
    assert dawson < 0.05 * disc


def test_default_law_meets_the_correlation_of_the_tested_gear() -> None:
    """Diab's gear 1 at 6000 rpm: impact theory with free disc against the dimensional correlation of the same paper.

    C = 60 Re^-0.25 (b/R)^0.8 z^-0.4 ((h1/R)^0.56 + (h2/R)^0.56), h = 75 mm the distances to the side walls.
    """
    gear, omega = diab_gear_1(), 6000 * math.pi / 30
    by_theory = gear_windage("gear", gear, omega, AIR)
    radius = gear.pitch_radius
    coefficient = 60.0 * AIR.reynolds(omega, radius) ** -0.25 * (gear.face_width / radius) ** 0.8
    coefficient *= gear.teeth**-0.4 * 2.0 * (0.075 / radius) ** 0.56
    assert by_theory.warnings == ()
    assert by_theory.power == pytest.approx(0.5 * coefficient * AIR.density * omega**3 * radius**5, rel=0.10)


def test_prototype_pinion_by_hand() -> None:
    """12,000 rpm in hot air: Re = 1.1e5 laminar, C_disc = 0.0116, disc 3.1 W; teeth 8.4 W."""
    loss = gear_windage("pinion", prototype_pinion(), TEST_SPEED, HOT_AIR)
    reynolds = 0.83 * TEST_SPEED * 50.5e-3**2 / 2.4e-5
    disc = 0.5 * 0.83 * TEST_SPEED**3 * 50.5e-3**5 * 3.87 / math.sqrt(reynolds)
    assert loss.details["disc_power"] == pytest.approx(disc)
    assert disc == pytest.approx(3.14, abs=0.02)
    assert loss.power == pytest.approx(11.5, abs=0.2)
    assert any("pitch radius" in text for text in loss.warnings)


def test_prototype_lies_between_disc_and_oily_mist() -> None:
    """The law at 1 to 20 times air brackets Anderson and Loewenthal's oily mist (about 60 W)."""
    pinion = prototype_pinion()
    thin = gear_windage("pinion", pinion, TEST_SPEED, HOT_AIR).power
    thick = gear_windage("pinion", pinion, TEST_SPEED, replace(HOT_AIR, density=20 * 0.83)).power
    mist = anderson_loewenthal(pinion.pitch_radius, pinion.face_width, TEST_SPEED, 2.5e-3)
    assert thin < mist < thick
    assert mist == pytest.approx(60.0, abs=2.0)
    smooth = gear_windage("pinion", pinion, TEST_SPEED, HOT_AIR).details["disc_power"]
    assert isinstance(smooth, float)
    assert 15.0 < mist / smooth < 20.0


def test_a_gear_wider_than_the_tests_is_said() -> None:
    """Diab: b/R 0.08 to 0.78; the reference gear of the prototype, both halves, has 1.6."""
    wide = replace(diab_gear_1(), face_width=0.2)
    (text,) = gear_windage("gear", wide, 600.0, AIR).warnings
    assert "face width / pitch radius = 1.39" in text
    assert "0.78" in text


def test_disc_coefficient_is_continuous_and_turns_turbulent() -> None:
    below, above = disc_coefficient(LAMINAR_LIMIT * (1 - 1e-9)), disc_coefficient(LAMINAR_LIMIT * (1 + 1e-9))
    assert below == pytest.approx(above, rel=1e-6)
    assert disc_coefficient(1e8) == pytest.approx(0.146 * 1e8**-0.2, rel=1e-2)
    assert disc_coefficient(0.0) == 0.0


def test_tooth_part_grows_with_width_and_opening() -> None:
    gear = diab_gear_1()
    assert tooth_coefficient(replace(gear, face_width=0.06)) == pytest.approx(2.0 * tooth_coefficient(gear))
    assert tooth_coefficient(replace(gear, tip_space_angle=0.5 * gear.tip_space_angle)) == pytest.approx(
        0.25 * tooth_coefficient(gear), rel=0.02
    )
    assert tooth_coefficient(replace(gear, shielding=0.5)) == pytest.approx(0.5 * tooth_coefficient(gear))


def test_covered_faces_drag_nothing() -> None:
    gear = diab_gear_1()
    covered = gear_windage("gear", replace(gear, free_faces=0), 600.0, AIR)
    assert covered.details["disc_power"] == 0.0
    assert covered.power == covered.details["tooth_power"]


def test_teeth_scale_with_the_cube_of_speed_and_with_density() -> None:
    gear = diab_gear_1()
    slow, fast = (gear_windage("gear", gear, omega, AIR).details["tooth_power"] for omega in (300.0, -600.0))
    assert fast == pytest.approx(8.0 * slow)
    dense = gear_windage("gear", gear, 300.0, replace(AIR, density=6.0)).details["tooth_power"]
    assert dense == pytest.approx(5.0 * slow)


def test_standing_gear_loses_nothing() -> None:
    assert gear_windage("gear", diab_gear_1(), 0.0, AIR).power == 0.0
    assert shaft_windage("shaft", 0.02, 0.2, 0.0, AIR).power == 0.0


@pytest.mark.parametrize("reynolds", [1e3, 1e4, 1e5])
def test_cylinder_satisfies_the_implicit_law(reynolds: float) -> None:
    omega = reynolds * AIR.viscosity / (AIR.density * 0.02**2)
    coefficient = shaft_windage("shaft", 0.02, 0.2, omega, AIR).details["drag_coefficient"]
    assert isinstance(coefficient, float)
    assert 1.0 / math.sqrt(coefficient) == pytest.approx(
        -0.6 + 4.07 * math.log10(reynolds * math.sqrt(coefficient))
    )


def test_slow_cylinder_drags_like_stokes() -> None:
    """Laminar: torque 4 pi eta omega R^2 L in unbounded fluid."""
    omega = 20.0 * AIR.viscosity / (AIR.density * 0.02**2)
    power = shaft_windage("shaft", 0.02, 0.2, omega, AIR).power
    assert power == pytest.approx(4.0 * math.pi * AIR.viscosity * omega**2 * 0.02**2 * 0.2)


def test_density_outside_air_to_oily_mist_warns() -> None:
    loss = gear_windage("gear", diab_gear_1(), 300.0, replace(AIR, density=60.0))
    assert any("chamber density" in text for text in loss.warnings)
    assert mist_density(1.2, 880.0, 1 / 35.25) == pytest.approx(26.1, abs=0.1)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"face_width": 0.0}, "face_width"),
        ({"free_faces": 3}, "free_faces"),
        ({"shielding": 1.5}, "shielding"),
    ],
)
def test_impossible_gear(changes: dict[str, float], word: str) -> None:
    with pytest.raises(LossError, match=word):
        replace(diab_gear_1(), **changes)
    with pytest.raises(LossError, match="mist"):
        Mist(density=0.0, viscosity=1.8e-5)
    with pytest.raises(LossError, match="fraction"):
        mist_density(1.2, 880.0, 2.0)
