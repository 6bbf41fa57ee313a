"""Residual unbalance by balance grade: its size and where it stands."""

import math
from dataclasses import replace

import pytest

from dynamics.rotor.parts import BearingPlace
from dynamics.rotor.rotor_model import BalanceGrade, ShaftBow, ShaftUnbalance, residual_unbalances, rotor_of
from dynamics.rotor.shaft import STEEL_DENSITY, Disc, DrivetrainError, Section
from tests.builders.elastic_rig import single_shaft

TUBE = (Section(length=0.4, outer_diameter=0.05),)
G_2_5 = BalanceGrade(grade=2.5e-3, speed=1000.0, angles=(0.2, 0.3))


def drivetrain(disc: float, bearings: tuple[float, ...]):  # type: ignore[no-untyped-def]
    return single_shaft(
        TUBE, bearings, 0.1, discs=(Disc(name="disc", position=disc, inertia=0.02, mass=10.0),)
    ).drivetrain


def test_the_grade_is_the_speed_of_the_centre_of_mass() -> None:
    """2.5 mm/s at 1000 rad/s is 2.5 um: 2.5 g mm for every kilogram."""
    train = drivetrain(0.1, (0.0, 0.4))
    shaft = STEEL_DENSITY * 0.25 * math.pi * 0.05**2 * 0.4
    rotor = rotor_of(train, "rotor")
    assert rotor.mass == pytest.approx(shaft + 10.0)
    assert rotor.centre == pytest.approx((shaft * 0.2 + 10.0 * 0.1) / rotor.mass)
    first, second = residual_unbalances(train, "rotor", G_2_5)
    assert first.moment + second.moment == pytest.approx(2.5e-6 * rotor.mass)
    share = (0.4 - rotor.centre) / 0.4
    assert first.moment == pytest.approx(2.5e-6 * rotor.mass * share)
    assert (first.position, second.position, first.angle, second.angle) == (0.0, 0.4, 0.2, 0.3)


def test_no_plane_has_less_than_three_tenths() -> None:
    train = drivetrain(0.38, (0.0, 0.4))
    whole = 2.5e-6 * rotor_of(train, "rotor").mass
    first, second = residual_unbalances(train, "rotor", G_2_5)
    assert (first.moment, second.moment) == pytest.approx((0.3 * whole, 0.7 * whole))
    overhung = drivetrain(0.4, (0.0, 0.05))
    first, second = residual_unbalances(overhung, "rotor", G_2_5)
    assert (first.moment, second.moment) == pytest.approx((1.3 * whole, 1.3 * whole))


def test_a_shaft_on_one_bearing_has_it_at_its_centre() -> None:
    train = drivetrain(0.1, (0.0, 0.4))
    train = replace(train, bearings=(BearingPlace(name="b0", shaft="rotor", position=0.0),))
    (only,) = residual_unbalances(train, "rotor", G_2_5)
    rotor = rotor_of(train, "rotor")
    assert (only.position, only.moment) == (rotor.centre, pytest.approx(2.5e-6 * rotor.mass))


def test_impossible_parts_name_value_limit_and_remedy() -> None:
    with pytest.raises(DrivetrainError, match="speed above 0; correct them"):
        BalanceGrade(grade=2.5e-3, speed=0.0)
    with pytest.raises(DrivetrainError, match="must be finite and at least 0"):
        ShaftUnbalance(shaft="rotor", position=0.1, moment=-1e-5)
    with pytest.raises(DrivetrainError, match="must ascend; give the positions of two bearings"):
        ShaftBow(shaft="rotor", supports=(0.1, 0.1), amplitude=1e-5)
    with pytest.raises(DrivetrainError, match=r"position = 0\.1 m is at a support"):
        ShaftBow(shaft="rotor", supports=(0.1, 0.3), amplitude=1e-5, position=0.1)
    rig = single_shaft(TUBE, (0.0, 0.4), 0.1)
    with pytest.raises(DrivetrainError, match=r"unbalance on shaft 'rotor': position = 0\.5 m"):
        replace(rig, rotating=(ShaftUnbalance(shaft="rotor", position=0.5, moment=1e-5),))
    with pytest.raises(DrivetrainError, match="ghost"):
        replace(rig, rotating=(ShaftUnbalance(shaft="ghost", position=0.1, moment=1e-5),))
