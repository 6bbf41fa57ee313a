"""Lateral vibration of the prototype at analytic teeth: whirl with the square of the speed, what a key moves."""

from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rotor.damped_modes import rig_modes
from dynamics.rotor.rotor_model import HousingSupport, isotropic_support
from rigdesign.base.json_text import to_plain, to_text
from rigdesign.case.loader import load_case
from rigdesign.coupling.bearing_loads import solve_bearings
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import running_state
from rigdesign.coupling.mesh_models import mesh_models
from rigdesign.coupling.time_run import held_points
from rigdesign.postprocessing.vibration import lateral_vibration, seal_whirls, seat_stiffnesses
from rigdesign.results.document import as_shown, record_of
from rigdesign.results.lateral import LateralVibration
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig


def rig_of(**keys: Any) -> Rig:
    values = {"drivetrain.mesh_stiffness": "iso_6336_scaled"} | {
        f"drivetrain.{key.replace('__', '.')}": value for key, value in keys.items()
    }
    return build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "standard")


def held(rig: Rig) -> Any:
    """The held point in its initial state."""
    (point, *_) = held_points(rig)
    state = initial_state(rig, point)
    last = SimpleNamespace(
        coupling_state=state,
        bearings=solve_bearings(rig, point, state),
        models=mesh_models(rig, point, state),
        expansion={},
    )
    return SimpleNamespace(point=point, last=last)


@cache
def vibration(**keys: Any) -> LateralVibration:
    rig = rig_of(**keys)
    found = lateral_vibration(rig, [held(rig)])
    assert found is not None
    return found


def amplitudes(found: LateralVibration) -> np.ndarray:
    return np.array([bearing.amplitude for bearing in found.of("held")[0].bearings])


def test_orbits_grow_with_the_grade_and_far_below_a_critical_speed_with_the_square_of_the_speed() -> None:
    """The rig is linear in its unbalance; at a tenth and a fifth of the speed films change by less than half."""
    assert amplitudes(vibration(balance_grade=5.0)) == pytest.approx(2.0 * amplitudes(vibration()), rel=1e-9)
    curve = vibration().curve
    assert curve.speed[2] / curve.speed[0] == pytest.approx(2.0)
    growth = curve.bearings[0].orbit[2] / curve.bearings[0].orbit[0]
    assert 2.0 < growth < 6.0


def test_a_rig_that_loses_its_torque_whirls_at_half_speed() -> None:
    """Rigid rotor of 2.7 kg a bearing on films under its weight: the threshold is about 12,000 rpm (sheet m)."""
    with_torque, without = vibration().of("held")[0], vibration().of("lost")[0]
    slow = [mode for mode in with_torque.modes if mode.frequency < with_torque.highest_turn]
    assert min(mode.logarithmic_decrement for mode in slow) > 1.0
    least = min(without.modes, key=lambda mode: mode.logarithmic_decrement)
    assert least.logarithmic_decrement < 0.1
    assert least.frequency / without.highest_turn == pytest.approx(0.5, abs=0.03)


def test_a_bow_runs_out_in_the_mesh_and_loads_all_bearings() -> None:
    """A gear 10 um off its axis loads the loop like a run-out: hundreds of newtons, where the unbalance of G 2.5 makes
    half of one. The line without a bow turns as before."""
    bent, straight = vibration(shafts__test_wheel__bow__amplitude="20 um"), vibration()
    assert (amplitudes(bent) > 1.5 * amplitudes(straight)).all()
    for with_bow, without in zip(bent.of("held")[0].meshes, straight.of("held")[0].meshes, strict=True):
        assert with_bow.forces["test_pinion"] == pytest.approx(without.forces["test_pinion"], rel=1e-9)
        assert with_bow.forces["test_wheel"] > 100.0 > 1.0 > without.forces["test_wheel"]
        assert 0.02 < with_bow.share(["test_wheel"]) < 0.1


def test_seals_follow_their_shafts_and_a_twisting_rig_has_no_whirl() -> None:
    rig = rig_of()
    found = seal_whirls(rig, held(rig))
    assert found and all(seal.amplitude > 0.0 for seal in found)
    quick = twisting_rig(rig.case)
    assert lateral_vibration(quick, [held(quick)]) is None
    assert seal_whirls(quick, held(quick)) == ()


def test_there_is_every_stage_twice_and_the_curve() -> None:
    found = vibration()
    assert [stage.torque for stage in found.stages] == ["held", "lost"]
    assert len(found.curve.speed) == len(found.curve.bearings[0].orbit)
    meshes = found.stages[0].meshes
    assert {mesh.mesh for mesh in meshes} == set(rig_of().mesh_names)
    assert all(0.0 < mesh.share([line]) < 0.01 for mesh in meshes for line in mesh.forces)


def test_it_comes_back_from_its_document() -> None:
    """Numbers are turned into their units and back."""
    document = as_shown(vibration())
    assert document["stages"][0]["modes"][0]["frequency_Hz"] == vibration().stages[0].modes[0].frequency
    again = as_shown(record_of(LateralVibration, document))
    assert to_text(to_plain(again)) == to_text(to_plain(document))


def test_the_stiffness_of_elastic_seats_stands_in_the_result() -> None:
    """Two seats of 2e9 N/m that a wall of 1e9 N/m joins: alone each gives 2e9 + 2e9 x 1e9/(2e9 + 1e9)."""
    coupled = 1e9 * np.kron(np.array([[3.0, -1.0], [-1.0, 3.0]]), np.eye(3))
    supports = (
        HousingSupport(name="box", bearings=("test.front", "test.rear"), stiffness=coupled, mass=np.eye(6)),
        isotropic_support("reference.front", 5e8, 1.0),
    )
    rig: Any = SimpleNamespace(elastic=SimpleNamespace(rig=SimpleNamespace(supports=supports)))
    found = LateralVibration(stages=(), seats=tuple(seat_stiffnesses(rig)))
    front, _, stated = as_shown(found)["seats"]
    assert front["bearing"] == "test.front"
    for key in ("lateral_N_um", "vertical_N_um", "axial_N_um"):
        assert front[key] == pytest.approx(1e3 * (2.0 + 2.0 / 3.0))
    assert stated == {
        "bearing": "reference.front", "lateral_N_um": pytest.approx(500.0),
        "vertical_N_um": pytest.approx(500.0), "axial_N_um": None,
    }  # fmt: skip
    assert vibration().seats == ()


def test_modes_up_to_8_khz_are_enough_for_what_happens_at_the_speed_of_the_shafts() -> None:
    """The reduced rig of lateral vibration against that of the loop, modes up to 25 kHz."""
    rig = rig_of()
    point = held(rig)
    state = running_state(rig, point.point, point.last.coupling_state, point.last.bearings)
    few, all_modes = (rig_modes(one, state, 1000.0) for one in (rig.elastic.slow, rig.elastic.reduced))
    assert rig.elastic.slow.size < 0.7 * rig.elastic.reduced.size
    for quantity in ("frequency", "logarithmic_decrement"):
        assert [getattr(mode, quantity) for mode in few] == pytest.approx(
            [getattr(mode, quantity) for mode in all_modes], rel=1e-4
        )
