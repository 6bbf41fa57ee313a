"""Speeds at which an order meets a mode, for what run-ups show."""

import math
from dataclasses import replace
from functools import cache

import pytest

from rigdesign.base.errors import UsageError
from rigdesign.coupling.state import OperatingPoint
from rigdesign.prediction.full import modelled_rig
from rigdesign.prediction.model import OWN_MODEL, TORSIONAL, Channel, OperatingCondition
from rigdesign.prediction.predict import Predictor
from rigdesign.prediction.static_tests import mode_frequency, resonance_speed, standing_modes
from rigdesign.rig.model import Rig
from tests.builders.order import shipped

MESH = Channel(name="n", quantity="resonance_speed", place="2", orders=(28.0,), torque=300.0)


@cache
def rig(bends: bool) -> Rig:
    return modelled_rig(shipped("loop_1to1"), "quick", OWN_MODEL if bends else TORSIONAL)


def test_speed_is_frequency_over_order_at_the_torque_of_the_sweep() -> None:
    found = {}
    for torque in (100.0, 300.0):
        modes = standing_modes(rig(False), OperatingPoint(stage="", speed=0.0, torque=torque))
        found[torque] = resonance_speed(rig(False), replace(MESH, torque=torque))
        assert found[torque] == pytest.approx(2.0 * math.pi * mode_frequency(MESH, modes) / 28.0, rel=1e-12)
    assert resonance_speed(rig(False), replace(MESH, orders=(56.0,))) == pytest.approx(
        0.5 * found[300.0], rel=1e-12
    )
    assert resonance_speed(rig(False), replace(MESH, torque=None)) > 0.0


@pytest.mark.slow
def test_shafts_that_bend_meet_nearly_the_same_torsional_mode() -> None:
    """Bearings give a little: the mode of the speed itself, within a tenth of a per cent, and 5 % of twisting alone."""
    speed = resonance_speed(rig(True), MESH)
    assert speed == pytest.approx(resonance_speed(rig(False), MESH), rel=0.05)
    modes = standing_modes(rig(True), OperatingPoint(stage="", speed=speed, torque=300.0))
    assert 28.0 * speed == pytest.approx(2.0 * math.pi * mode_frequency(MESH, modes), rel=1e-3)


def test_lateral_modes_in_films_have_no_resonance_speed() -> None:
    with pytest.raises(UsageError, match="'lateral test_wheel 1': lateral modes in oil films"):
        resonance_speed(rig(True), replace(MESH, place="lateral test_wheel 1"))


def test_predictor_holds_resonance_speeds_with_the_numbers_at_rest() -> None:
    point = OperatingCondition(name="P", speed=150.0, torque=300.0)
    predictor = Predictor(shipped("loop_1to1"), [point], [MESH], circuit=TORSIONAL)
    assert [one.setting for one in predictor.features] == [""]
    assert predictor.base[0] == pytest.approx(resonance_speed(rig(False), MESH), rel=1e-9)
    stiffer = predictor.response({"gearboxes.test.meshes.main.stiffness_factor": 1.2})
    assert stiffer[0] > predictor.base[0]


@pytest.mark.parametrize("orders", [(), (0.0,), (1.0, 2.0)])
def test_one_order_meets_a_mode(orders: tuple[float, ...]) -> None:
    with pytest.raises(UsageError, match="one order above 0 meets a mode"):
        resonance_speed(rig(False), replace(MESH, orders=orders))


def test_unknown_modes_are_refused() -> None:
    with pytest.raises(UsageError, match="counted from 1 to"):
        resonance_speed(rig(False), replace(MESH, place="99"))
