"""Damping of a mesh by ratio, against the damping audit of the loop; material damping of shafts."""

import math
from pathlib import Path

import pytest

from dynamics.rotor.torsional_modes import damping_audit
from rigdesign.case import Case, load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import laws_of, mesh_models
from rigdesign.coupling.time_run import held_points
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.rig.model import Rig
from tests.builders.minimal_case import minimal_case
from tests.builders.twisting import twisting_rig


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Case:
    return load_case(minimal_case(tmp_path_factory.mktemp("minimal")))


def _ratios(rig: Rig) -> dict[str, float]:
    point = held_points(rig)[-1]
    laws = laws_of(mesh_models(rig, point, initial_state(rig, point)))
    assert rig.drivetrain is not None
    return {record.name: record.damping_ratio for record in damping_audit(rig.drivetrain, laws)}


def test_the_loop_has_the_ratio_that_the_case_states(case: Case) -> None:
    """The audit takes the gear bodies of the assembled drivetrain, the law those of the case."""
    stated = case.with_value("gearboxes.slave.meshes.main.damping_ratio", 0.03)
    ratios = _ratios(twisting_rig(stated))
    assert ratios["test.main"] == pytest.approx(0.06, rel=1e-9)
    assert ratios["slave.main"] == pytest.approx(0.03, rel=1e-9)


def test_ratio_and_constant_mean_the_same_loop(case: Case, tmp_path: Path) -> None:
    rig = twisting_rig(case)
    point = held_points(rig)[-1]
    first = mesh_models(rig, point, initial_state(rig, point))[0].law
    path = minimal_case(tmp_path)
    text = path.read_text().replace(
        'centre_distance = "91.5 mm" }',
        f'centre_distance = "91.5 mm", damping = "{first.damping!r} N s/m" }}',
    )
    path.write_text(text)
    stated = twisting_rig(load_case(path))
    assert _ratios(stated)["test.main"] == pytest.approx(0.06, rel=1e-9)
    assert stated.case.gearboxes["test"].meshes["main"].damping_ratio is None


def test_a_heavier_gear_keeps_its_ratio(case: Case) -> None:
    """c = 2 zeta sqrt(k m): the constant grows with the mass, the ratio stays."""
    heavier = case.with_value("gearboxes.test.gears.*.inertia_factor", 4.0)
    laws = []
    for one in (case, heavier):
        rig = twisting_rig(one)
        point = held_points(rig)[-1]
        laws.append(mesh_models(rig, point, initial_state(rig, point))[0].law)
        assert _ratios(rig)["test.main"] == pytest.approx(0.06, rel=1e-9)
    assert laws[1].damping == pytest.approx(2.0 * laws[0].damping, rel=1e-9)


def test_remembered_meshes_take_another_ratio(case: Case) -> None:
    known = Memoisation()
    for ratio in (0.06, 0.02):
        rig = twisting_rig(case.with_value("gearboxes.test.meshes.main.damping_ratio", ratio))
        point = held_points(rig)[-1]
        initial = initial_state(rig, point)
        remembered, fresh = known.models(rig, point, initial)[0], mesh_models(rig, point, initial)[0]
        assert remembered.law.damping == pytest.approx(fresh.law.damping, rel=1e-12)


def test_material_damping_is_the_loss_factor_at_the_mesh_frequency(case: Case) -> None:
    """Every element of the shaft: omega c = eta k at 16 teeth and 2250 rpm; the other shafts keep that of steel."""
    path = "drivetrain.shafts.test_wheel.material_damping"
    rig = twisting_rig(case.with_value(path, 0.004))
    omega = 16 * 2250 * math.tau / 60
    found = {
        joint.name: omega * joint.damping / joint.stiffness for joint in rig.joints if joint.kind == "shaft"
    }
    assert found.pop("test_wheel") == pytest.approx(0.004, rel=1e-9)
    assert list(found.values()) == pytest.approx([0.001] * len(found), rel=1e-9)
