"""Factors between nominal stress, stress and strength of a tooth root, against hand numbers."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rating.iso_rating import permissible_factors, transverse_load_factor
from dynamics.rating.root_stress import MeanRootStress
from dynamics.standards import iso6336_3_2006 as iso
from dynamics.tooth.root_field import ToothTurn
from rigdesign.base.part_name import MeshName
from rigdesign.case import load_case
from rigdesign.checks import strength
from rigdesign.postprocessing.curves import iso_factor
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.postprocessing.tooth_history import GearInMesh, mean_stress, sensitivity
from rigdesign.results.teeth import FROM_FACTORS, StressSource, ToothHistory
from rigdesign.rig.model import Rig
from tests.builders.loads import StatedLoads, mesh_loads
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig


@pytest.fixture(scope="module")
def prototype() -> Rig:
    return twisting_rig(load_case(CASES / "uhcf_prototype"))


@pytest.mark.parametrize(
    ("cycles", "factor"), [(1e5, 1.0), (3e6, 1.0), (5e8, 0.9027), (1e10, 0.8503), (1e12, 0.8503)]
)
def test_life_factor_falls_from_the_knee_to_1e10_cycles(cycles: float, factor: float) -> None:
    """ISO 6336-3:2006, clause 12: 1.0 at 3e6 and 0.85 at 1e10 cycles, straight on log scales."""
    assert iso.Y_NT(cycles) == pytest.approx(factor, abs=1e-4)


@pytest.mark.parametrize(
    ("module", "factor"), [(1.0, 1.0), (5.0, 1.0), (10.0, 0.95), (25.0, 0.8), (40.0, 0.8)]
)
def test_size_factor_of_case_hardened_gears(module: float, factor: float) -> None:
    assert iso.Y_X(module) == pytest.approx(factor)


def test_only_a_blunt_notch_lowers_the_strength() -> None:
    sharp = iso.RootSection(E=0.0, G=0.0, H=0.0, theta=0.5, s_Fn=2.0, rho_F=0.4, y_F=1.0)
    blunt = iso.RootSection(E=0.0, G=0.0, H=0.0, theta=0.5, s_Fn=2.0, rho_F=0.7, y_F=1.0)
    assert (iso.Y_deltarelT(sharp), iso.Y_deltarelT(blunt)) == (1.0, 0.95)


def test_pitch_errors_load_single_teeth_of_a_lightly_loaded_wide_gear(prototype: Rig) -> None:
    """c_gamma_alpha f_pb,eff b / F_tH by hand for both gearboxes; 7 mm under 510 N/mm share evenly."""
    torque, speed = 180.0, 1256.6
    wide, narrow = (prototype.pairs[name] for name in ("reference.main", "test.main"))
    rated = iso_factor(prototype, MeshName("reference", "main"), torque, speed)
    load = torque / wide.gears[0].reference_radius / wide.face_width * 1e-3
    ratio = wide.total_contact_ratio
    sharing = 0.9 + 0.4 * np.sqrt(2.0 * (ratio - 1.0) / ratio) * (
        rated.stiffness.c_gamma_alpha * rated.f_pb_eff / load
    )
    assert 1.25 < sharing < 1.5
    assert transverse_load_factor(wide, rated) == pytest.approx(sharing)
    assert 1.0 < transverse_load_factor(wide, rated, dynamic=1.2, face_load=1.1) < sharing
    other = iso_factor(prototype, MeshName("test", "main"), torque, speed)
    assert transverse_load_factor(narrow, other) == 1.0


def rated(rig: Rig, meshes: int, source: StressSource = FROM_FACTORS) -> SolvedRig:
    """The rig held at 180 N m with a K_V of 1.1 in every mesh, and made-up histories."""
    response = SimpleNamespace(dynamic_factor=np.full(meshes, 1.1), mean=np.full(meshes, 180.0))
    point: Any = SimpleNamespace(
        point=SimpleNamespace(stage="test", speed=1256.6, torque=180.0),
        last=SimpleNamespace(response=response),
    )
    made = mesh_loads()
    made = replace(made, root_stress=tuple(replace(path, source=source) for path in made.root_stress))
    loads = StatedLoads(meshes=dict.fromkeys(rig.mesh_labels.values(), made))
    run: Any = SimpleNamespace()
    return SolvedRig(rig=rig, points=[point], run=run, loads=loads)


def test_safety_of_a_rig_gear_takes_sharing_and_cycles(prototype: Rig) -> None:
    found = {check.id: check for check in strength.checks(rated(prototype, 2))}
    check = found["strength.root_safety_iso.reference.pinion"]
    life = permissible_factors(prototype.pairs["reference.main"], 0, 720.0 * 3600.0 * 200.0)["Y_NT"]
    nominal = float(check.reason.split("nominal ")[1].split(" MPa")[0])
    shared = float(check.reason.split("K_Falpha ")[1].split(",")[0])
    assert shared > 1.2 and life == pytest.approx((3e6 / 5.184e8) ** 0.02)
    assert check.value == pytest.approx(920.0 * life / (nominal * 1.1 * 1.1 * shared), rel=5e-3)


@pytest.fixture(scope="module")
def main_rig() -> Rig:
    return twisting_rig(load_case(CASES / "uhcf_main"))


def test_every_mesh_of_a_gearbox_is_rated_and_an_idler_bends_both_ways(main_rig: Rig) -> None:
    """The pinion of the main rig between its two wheels: two labels, bent both ways by ISO 6336-3, Annex B.

    Safety (strength Y_M) / (sigma_F + mean) with R = (mean - 1.2 sigma_F) / (mean + sigma_F).
    """
    rig = main_rig
    labels = [rig.mesh_labels[name] for name in rig.mesh_names]
    assert {"test.a", "test.b"} <= set(labels)
    found = {check.id: check for check in strength.checks(rated(rig, len(labels)))}
    for label in labels:
        assert any(f".{label}." in identity for identity in found)
    solved, mesh = rated(rig, len(labels)), labels.index("test.a")
    idler, words = strength.root_safety(solved, mesh, 0) or (0.0, "")
    stress = float(words.split("sigma_F ")[1].split(" MPa")[0])
    mean = mean_stress(rig, GearInMesh(mesh, 0), solved.test.point.speed)
    assert mean.total == pytest.approx(63e6, rel=0.02)
    ratio = (1e-6 * mean.total - 1.2 * stress) / (1e-6 * mean.total + stress)
    factor = iso.Y_M(ratio, sensitivity(rig, GearInMesh(mesh, 0)))
    share, _ = strength._strength_share(solved, mesh, 0)
    assert idler == pytest.approx(920.0 * share * factor / (stress + 1e-6 * mean.total), rel=5e-3)
    assert f"Y_M {factor:.2f}" in words and "idler" in words
    _, of_wheel = strength.root_safety(solved, mesh, 1) or (0.0, "")
    assert "Y_M" not in of_wheel and "held all the time" not in of_wheel


def test_stress_over_the_path_of_an_idler_takes_r_of_its_history(main_rig: Rig) -> None:
    labels = [main_rig.mesh_labels[name] for name in main_rig.mesh_names]
    solved, mesh = rated(main_rig, len(labels)), labels.index("test.a")
    angle = np.linspace(0.0, 2.0 * np.pi, 5)
    wave = 1e6 * np.array([0.0, 500.0, 0.0, -400.0, 0.0])
    history = ToothHistory(
        gear="test.pinion",
        stage="test",
        meshes=("test.a", "test.b"),
        turn=ToothTurn(angle=angle, leading=wave, trailing=0.9 * wave),
        mean=MeanRootStress(disc=50e6, teeth=10e6),
        sensitivity=0.5,
        source="finite-element influence numbers",
    )
    assert solved.loads is not None
    loads = replace(solved.loads, teeth={"test.pinion": history})
    safety, words = strength.root_safety(replace(solved, loads=loads), mesh, 0, strength.PATH) or (0.0, "")
    assert history.stress_ratio == pytest.approx(-340.0 / 560.0)
    share, _ = strength._strength_share(solved, mesh, 0)
    stress = 1e-6 * max(loads.meshes["test.a"].root_stress[0].dynamic)
    factor = 1.0 / (1.0 + 340.0 / 560.0 / 3.0)
    assert safety == pytest.approx(920.0 * share * factor / (stress + 60.0))
    assert "R -0.61" in words


def test_the_computed_field_governs_and_the_standard_stands_beside_it(prototype: Rig) -> None:
    """With stress from influence numbers ISO 6336-3 warns at most, and both say so with both figures."""
    by_factors, by_field = (
        {check.id: check for check in strength.checks(held)}
        for held in (rated(prototype, 2), rated(prototype, 2, source="finite-element influence numbers"))
    )
    iso_id, path_id = (f"specimen.root_stress_{method}.test.pinion" for method in ("iso", "path"))
    assert by_factors[iso_id].verdict == by_factors[path_id].verdict == by_field[path_id].verdict == "fail"
    assert by_field[iso_id].status == "advisory"
    assert by_field[iso_id].value == by_factors[iso_id].value
    for identity in (iso_id, path_id):
        assert "governs" not in by_factors[identity].reason
        for check in (by_field[iso_id], by_field[path_id]):
            assert f"{check.value:.0f} MPa" in by_field[identity].reason
    assert "hand check" in by_field[iso_id].reason
    assert "it governs: computed from finite-element influence numbers" in by_field[path_id].reason


def with_application(rig: Rig, factor: float) -> Rig:
    """The same with K_A in every mesh."""
    case = rig.case
    for name in rig.mesh_names:
        box, _, mesh = name.partition(".")
        case = case.with_value(f"gearboxes.{box}.meshes.{mesh}.application_factor", str(factor))
    return twisting_rig(case)


def test_stress_over_the_path_takes_the_application_factor(prototype: Rig) -> None:
    """K_A = 1.25 on both methods alike, in value, decision and safety."""
    source: StressSource = "finite-element influence numbers"
    plain, raised = (
        {check.id: check for check in strength.checks(rated(rig, 2, source))}
        for rig in (prototype, with_application(prototype, 1.25))
    )
    peak = 1e-6 * max(mesh_loads().root_stress[0].dynamic)
    path = "specimen.root_stress_path.test.pinion"
    assert plain[path].value == pytest.approx(peak) and "K_A" not in plain[path].reason
    assert raised[path].value == pytest.approx(1.25 * peak)
    assert "times K_A 1.25" in raised[path].reason and f"{1.25 * peak:.0f} MPa, beside" in raised[path].reason
    safety = "strength.root_safety_path.reference.pinion"
    assert raised[safety].value == pytest.approx(plain[safety].value / 1.25)  # type: ignore[operator]
