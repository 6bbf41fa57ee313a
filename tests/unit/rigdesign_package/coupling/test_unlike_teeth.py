"""Keys of a case for single teeth, meshes, bracing and swinging torques: neutral by default, and what they reach."""

import math
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.gear.flank import FlankField
from dynamics.gear.microgeometry import Microgeometry, pitch_waves
from dynamics.rotor.parts import LoadOrder
from dynamics.tooth.mesh_laws import alike_teeth, mesh_law
from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case import Case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import MeshModel, laws_of, mesh_models
from rigdesign.coupling.preloaded_loop import averaged_gears, locked_share, periodic_laws, signed_torque
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig, build_rig
from rigdesign.run.warnings import _deviating_teeth

POINT = OperatingPoint(stage="test", speed=100.0, torque=200.0)
PINION = "gearboxes.test.gears.pinion"
WHEEL = "gearboxes.test.gears.wheel"
MESH = "gearboxes.test.meshes.main"


@cache
def shipped(name: str) -> Case:
    return load_case(f"cases/{name}")


def built(case: Case) -> tuple[Rig, tuple[MeshModel, ...]]:
    rig = build_rig(case, "quick")
    return rig, mesh_models(rig, POINT, initial_state(rig, POINT))


def test_defaults_leave_all_teeth_alike() -> None:
    rig, models = built(shipped("loop_1to1"))
    for model in models:
        assert model.law.deviation_1.shape[0] == model.law.deviation_2.shape[0] == 1
        assert not model.law.deviation_1.any()
        assert model.law.scale_1.tolist() == model.law.scale_2.tolist() == [1.0]
        assert model.law.tooth_offset_2 == 0
    assert locked_share(rig) == 1.0
    assert rig.system is not None and rig.system.periodic_loads == ()


def test_profile_slope_takes_from_the_root_what_it_adds_to_the_tip() -> None:
    _, models = built(shipped("loop_1to1"))
    pair = models[0].pair
    path = np.array([pair.path.start, 0.5 * (pair.path.start + pair.path.end), pair.path.end])
    gear = Microgeometry(profile_slope=8e-6)
    flanks = [FlankField(pair=pair, index=side, micro=gear) for side in (0, 1)]
    pinion, wheel = (flank.modification(flank.roll(path), 0.0) for flank in flanks)
    np.testing.assert_allclose(pinion, [4e-6, 0.0, -4e-6], atol=1e-18)
    np.testing.assert_allclose(wheel, pinion[::-1], atol=1e-18)


def test_scatter_of_the_profile_slope_belongs_to_single_teeth() -> None:
    case = shipped("loop_1to1").with_value(f"{WHEEL}.flank.profile_slope_scatter", ["0 um"] * 27 + ["6 um"])
    _, (model, _) = built(case)
    table = model.law.deviation_2
    assert not table[:27].any()
    assert table[27].min() == pytest.approx(-3e-6) and table[27].max() == pytest.approx(3e-6)
    assert table[27, 0] < 0.0 < table[27, -1]  # the path starts at the tip of the wheel
    assert not model.law.deviation_1.any()


def test_pitch_waves_add_to_single_pitch() -> None:
    np.testing.assert_allclose(
        pitch_waves(4, [(1, 2e-6, math.pi / 2.0)]), [0.0, 2e-6, 0.0, -2e-6], atol=1e-18
    )
    wave = [{"order": 2, "amplitude": "5 um"}]
    single = ["0 um"] * 28
    single[3], single[4] = "2 um", "-2 um"
    plain = shipped("loop_1to1").with_value(f"{PINION}.flank.single_pitch", single)
    with_wave = plain.with_value(f"{PINION}.flank.pitch_waves", wave)
    added = built(with_wave)[1][0].law.deviation_1 - built(plain)[1][0].law.deviation_1
    np.testing.assert_allclose(added[:, 0], -5e-6 * np.cos(4.0 * math.pi * np.arange(28) / 28.0), atol=1e-12)


def test_weak_tooth_comes_on_top_of_tooth_stiffness() -> None:
    shares = [1.0] * 28
    shares[5] = 0.9
    case = shipped("loop_1to1").with_value(f"{PINION}.flank.tooth_stiffness", shares)
    case = case.with_value(f"{PINION}.flank.weak_tooth", {"tooth": 5, "stiffness": 0.5})
    law = built(case)[1][0].law
    assert law.scale_1[5] == pytest.approx(0.45)
    assert np.delete(law.scale_1, 5).tolist() == [1.0] * 27
    missing = case.with_value(f"{PINION}.flank.weak_tooth.stiffness", 0.0)
    assert built(missing)[1][0].law.scale_1[5] == 0.0


def test_no_tooth_pushes_by_less_than_nothing() -> None:
    _, (model, _) = built(shipped("loop_1to1"))
    for shares in ((-0.1,) + (1.0,) * 27, (0.0,) * 28):
        with pytest.raises(ValueError, match="use 0 for a missing tooth"):
            mesh_law(
                model.pair, model.stiffness, micro=(Microgeometry(tooth_stiffness=shares), Microgeometry())
            )


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("tooth_stiffness", [1.0] * 27, "27 entries"),
        ("profile_slope_scatter", ["1 um"] * 3, "3 entries"),
        ("tooth_stiffness", [0.0] * 28, "not all of them 0"),
        ("weak_tooth", {"tooth": 28, "stiffness": 0.5}, "counted from 0"),
        ("pitch_waves", [{"order": 15, "amplitude": "1 um"}], "no wave above order 14"),
    ],
)
def test_a_gear_has_as_many_teeth_as_it_has(key: str, value: object, named: str) -> None:
    with pytest.raises(CaseError, match=named):
        shipped("loop_1to1").with_value(f"{PINION}.flank.{key}", value)


def test_factors_of_a_mesh_scale_stiffness_and_friction() -> None:
    plain = built(shipped("loop_1to1"))[1]
    stiff = built(shipped("loop_1to1").with_value(f"{MESH}.stiffness_factor", 0.9))[1]
    slick = built(shipped("loop_1to1").with_value(f"{MESH}.friction_factor", 0.5))[1]
    assert stiff[0].law.mean_stiffness == pytest.approx(0.9 * plain[0].law.mean_stiffness, rel=1e-12)
    assert stiff[1].law.mean_stiffness == plain[1].law.mean_stiffness
    assert slick[0].friction.value == pytest.approx(0.5 * plain[0].friction.value, rel=1e-12)
    assert slick[0].law.friction == pytest.approx(0.5 * plain[0].law.friction, rel=1e-12)
    assert slick[1].law.friction == plain[1].law.friction


def test_wheel_put_on_further_takes_its_eccentricity_along() -> None:
    eccentric = shipped("loop_hunting").with_value(f"{WHEEL}.flank.run_out", "30 um")
    moved = eccentric.with_value(f"{MESH}.tooth_offset", 4)
    before, after = (built(case)[1][0].law for case in (eccentric, moved))
    assert after.tooth_offset_2 == 4
    np.testing.assert_allclose(after.deviation_2, before.deviation_2, atol=1e-15)


def test_inertia_factor_and_inertia_reach_the_system() -> None:
    def of_pinion(case: Case) -> float:
        rig, _ = built(case)
        assert rig.drivetrain is not None
        return rig.drivetrain.gear("test.pinion").inertia

    plain = of_pinion(shipped("loop_1to1"))
    assert of_pinion(shipped("loop_1to1").with_value(f"{PINION}.inertia_factor", 1.2)) == pytest.approx(
        1.2 * plain
    )
    stated = shipped("loop_1to1").with_value(f"{PINION}.inertia", "0.003 kg m2")
    assert of_pinion(stated) == pytest.approx(0.003)
    assert of_pinion(stated.with_value(f"{PINION}.inertia_factor", 0.5)) == pytest.approx(0.0015)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (f"{PINION}.spline.torsional_stiffness", "2e5 N m/rad"),
        (f"{PINION}.spline.torsional_damping", "9 N m s/rad"),
        ("drivetrain.couplings.wheel_side.torsional_stiffness", "8e4 N m/rad"),
        ("drivetrain.couplings.wheel_side.torsional_damping", "4 N m s/rad"),
        ("drivetrain.motor.inertia", "0.009 kg m2"),
    ],
)
def test_joints_and_motor_can_be_patched(path: str, value: str) -> None:
    before, after = (
        built(case)[0].system for case in (shipped("loop_1to1"), shipped("loop_1to1").with_value(path, value))
    )
    assert before is not None and after is not None
    same = [
        np.array_equal(getattr(before, name), getattr(after, name))
        for name in ("inertia", "stiffness", "damping")
    ]
    assert same.count(False) == 1


def test_mesh_damping_can_be_patched() -> None:
    law = built(shipped("loop_1to1").with_value(f"{MESH}.damping", "1800 N s/m"))[1][0].law
    assert law.damping == 1800.0


def test_bracing_drifts_with_the_inlet_of_its_gearbox() -> None:
    drifting = shipped("loop_1to1").with_value("drivetrain.bracing.temperature_drift", 5e-4)
    rig, _ = built(drifting)
    assert signed_torque(rig, POINT) == pytest.approx(200.0 * (1.0 + 5e-4 * 40.0))
    colder, _ = built(drifting.with_value("gearboxes.test.oil.inlet_temperature", "20 degC"))
    assert signed_torque(colder, POINT) == pytest.approx(200.0)
    elsewhere, _ = built(drifting.with_value("gearboxes.reference.oil.inlet_temperature", "80 degC"))
    assert signed_torque(elsewhere, POINT) == signed_torque(rig, POINT)


def test_alike_teeth_keep_their_mean() -> None:
    case = shipped("loop_1to1").with_value(f"{PINION}.flank.weak_tooth", {"tooth": 3, "stiffness": 0.3})
    case = case.with_value(f"{WHEEL}.flank.run_out", "20 um")
    law = built(case)[1][0].law
    pinion = alike_teeth(law, True, False)
    assert pinion.scale_1.tolist() == [1.0] and pinion.deviation_2 is law.deviation_2
    np.testing.assert_allclose(pinion.stiffness, law.stiffness * (1.0 - 0.7 / 28.0))
    both = alike_teeth(law)
    assert not both.deviation_2.any()
    np.testing.assert_allclose(both.gap, law.gap, atol=1e-15)  # a whole turn of an eccentricity has no mean


@pytest.mark.parametrize(
    ("name", "period", "averaged"),
    [
        ("loop_1to1", "mesh", ["test.pinion", "test.wheel"]),
        ("loop_1to1", "revolution", []),
        ("loop_hunting", "revolution", ["test.wheel"]),
        ("loop_hunting", "hunting_cycle", []),
    ],
)
def test_teeth_that_do_not_come_back_in_the_period_are_averaged(
    name: str, period: str, averaged: list[str]
) -> None:
    case = shipped(name).with_value("numerics.response_period", period)
    for gear in (PINION, WHEEL):
        case = case.with_value(f"{gear}.flank.run_out", "20 um")
    rig, models = built(case)
    assert averaged_gears(rig, laws_of(models)) == averaged
    law = periodic_laws(rig, laws_of(models))[0]
    assert bool(law.deviation_1.any()) == ("test.pinion" not in averaged)
    assert bool(law.deviation_2.any()) == ("test.wheel" not in averaged)


def test_a_swinging_torque_needs_an_order() -> None:
    with pytest.raises(ValueError, match="must be above 0"):
        LoadOrder(order=0.0, amplitude=1.0)


def warned(case: Case) -> list[str]:
    """Warnings of a response that leaves out what single teeth and alternating torques do."""
    rig, models = built(case)
    point = SimpleNamespace(last=SimpleNamespace(models=models, system=None))
    solved: Any = SimpleNamespace(rig=rig, points=[point])
    return list(_deviating_teeth(solved))


def test_what_the_response_averages_is_warned_of() -> None:
    case = shipped("loop_hunting").with_value(f"{WHEEL}.flank.run_out", "20 um")
    case = case.with_value("drivetrain.motor.ripple", [{"order": 6, "torque": "0.5 N m"}])
    teeth, torque = warned(case)
    assert teeth.startswith("test.wheel: its teeth differ") and "response_period = mesh" in teeth
    assert torque.startswith("motor order 6: its torque alternates")
    assert warned(case.with_value("numerics.response_period", "hunting_cycle")) == []
