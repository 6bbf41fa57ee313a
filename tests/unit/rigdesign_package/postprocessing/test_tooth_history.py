"""Stress history of idlers and of gears with one mesh: timing by the teeth, flanks, mean stress, rating."""

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.rating.root_stress import mean_stress_factor
from dynamics.tooth.root_field import RootCourse, ToothTurn, pitches_apart
from rigdesign.case import load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import MeshModel, mesh_model
from rigdesign.coupling.state import OperatingPoint
from rigdesign.postprocessing import root, tooth_history
from rigdesign.postprocessing import tooth_history as reversed_bending
from rigdesign.postprocessing.tooth_history import GearInMesh, gear_meshes, tooth_histories
from rigdesign.report.figures.teeth import tooth_history_figure
from rigdesign.results.serialisation.teeth import tooth_history_row
from rigdesign.results.teeth import ToothHistory
from rigdesign.rig.model import Rig
from tests.builders.idler_case import idler_case
from tests.builders.twisting import twisting_rig

SPEED, TORQUE, STEPS = 1256.6, 4000.0, 64


@pytest.fixture(scope="module")
def rig() -> Rig:
    """The main rig: in both gearboxes a pinion between two wheels."""
    return twisting_rig(load_case("cases/uhcf_main"))


@pytest.fixture(scope="module")
def point(rig: Rig) -> Any:
    """Warm meshes under a constant tooth force each, as the loop has them: no dynamics are solved."""
    operating = OperatingPoint(stage="test", speed=SPEED, torque=TORQUE)
    state = initial_state(rig, operating)
    models = [mesh_model(rig, name, operating, state) for name in rig.mesh_names]
    signs = [np.sign(rig.mesh_forces[name]) for name in rig.mesh_names]
    return SimpleNamespace(
        point=operating,
        last=SimpleNamespace(models=models, response=response(models, signs)),
    )


def response(models: list[MeshModel], signs: list[float]) -> Any:
    """One mesh period at a constant approach of 40 um beyond the play."""
    law = models[0].law
    turned = np.linspace(0.0, law.base_pitch / law.base_radius_1, STEPS, endpoint=False)
    approach = [
        np.full(STEPS, 40e-6 if sign > 0.0 else -(40e-6 + one.law.backlash))
        for one, sign in zip(models, signs)
    ]
    zero = np.zeros((len(models), STEPS))
    wave = SimpleNamespace(
        angle=np.tile(turned, (len(models), 1)), approach=np.array(approach), omega_1=zero, omega_2=zero
    )
    return SimpleNamespace(wave=wave, flank=np.array(signs))


@pytest.fixture(scope="module")
def histories(rig: Rig, point: Any) -> dict[str, ToothHistory]:
    return {found.gear: found for found in tooth_histories(rig, point)}


def test_idlers_are_in_two_meshes_and_wheels_in_one(rig: Rig, histories: dict[str, ToothHistory]) -> None:
    assert set(histories) == {f"{box}.{gear}" for box in ("test", "reference") for gear in ("pinion", "wheel_a", "wheel_b")}  # fmt: skip # noqa: E501
    assert histories["test.pinion"].meshes == ("test.a", "test.b")
    assert histories["test.wheel_a"].meshes == ("test.a",)
    assert [place.index for place in gear_meshes(rig)["test.pinion"]] == [0, 0]


def test_trailing_flank_follows_the_leading_one_by_half_a_turn_and_the_tooth(rig: Rig, point: Any) -> None:
    """A tooth leaves its leading flank at one wheel; its trailing one comes to the other wheel later by its thickness.

    The phase of the second mesh is that of the cold gears: 0.8 mrad of thermal growth are within the tolerance.
    """
    first, second = (
        tooth_history._Passing(point.last.models[rig.mesh_names.index(name)], 0, front)
        for name, front in (("test.a", True), ("test.b", False))
    )
    apart = tooth_history._angle_between(rig, GearInMesh(0, 0), GearInMesh(1, 0))
    assert apart == np.pi
    pair = first.model.pair
    lag = pitches_apart(apart, second.start - first.start, first.pitch)
    assert lag - np.pi == pytest.approx(pair.working_thicknesses[0] / pair.working_radii[0], abs=1e-3)


def test_an_idler_of_opposite_meshes_has_the_same_history_in_both_fillets(
    histories: dict[str, ToothHistory],
) -> None:
    """Compression 1.2 times the tension of the other flank, by the factors of quick fidelity."""
    turn = histories["test.pinion"].turn
    assert turn.leading.max() == pytest.approx(turn.trailing.max(), rel=5e-3)
    assert turn.leading.min() == pytest.approx(-1.2 * turn.trailing.max(), rel=5e-3)
    apart = abs(turn.angle[turn.leading.argmax()] - turn.angle[turn.trailing.argmax()])
    assert apart == pytest.approx(np.pi, abs=0.15)


def test_back_flanks_of_helical_gears_are_stressed_as_their_front_flanks(
    histories: dict[str, ToothHistory],
) -> None:
    """The slices of a back flank lag the other way; one wheel of the reference gearbox carries on each."""
    one, other = (histories[f"reference.{name}"].turn for name in ("wheel_a", "wheel_b"))
    peaks = [max(turn.leading.max(), turn.trailing.max()) for turn in (one, other)]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.02)


def test_stress_ratio_and_factor_hold_the_centrifugal_stress(histories: dict[str, ToothHistory]) -> None:
    idler, wheel = histories["test.pinion"], histories["test.wheel_a"]
    high, low, mean = idler.turn.leading.max(), idler.turn.leading.min(), idler.mean.total
    assert mean == pytest.approx(62.8e6, rel=0.01)
    assert idler.stress_ratio == pytest.approx((low + mean) / (high + mean), rel=5e-3)
    assert -1.2 < idler.stress_ratio < -0.5 and 0.7 < idler.mean_stress_factor < 0.85
    assert 0.0 < wheel.stress_ratio < 0.3 and wheel.mean_stress_factor > 1.0


def test_only_a_gear_bent_both_ways_is_rated_so(rig: Rig, histories: dict[str, ToothHistory]) -> None:
    idler, wheel = gear_meshes(rig)["test.pinion"][0], gear_meshes(rig)["test.wheel_a"][0]
    found = reversed_bending.of_history(rig, idler, histories["test.pinion"])
    assert found is not None
    assert found.strength_factor == pytest.approx(histories["test.pinion"].mean_stress_factor, rel=2e-3)
    assert reversed_bending.of_history(rig, wheel, histories["test.wheel_a"]) is None
    assert reversed_bending.by_standard(rig, wheel, 500e6, SPEED) is None
    assert reversed_bending.bent_both_ways(rig, "test.pinion")
    assert not reversed_bending.bent_both_ways(rig, "test.wheel_a")


def test_every_mesh_of_an_idler_is_rated_at_the_fillet_that_it_loads(
    rig: Rig, histories: dict[str, ToothHistory], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Mesh b with half the load of mesh a: R = -1.2 / 2 in the fillet of a and -1.2 * 2 in that of b, plus the mean."""
    forces = dict(rig.mesh_forces)
    forces["test.b"] = -0.5 * forces["test.a"]
    monkeypatch.setitem(rig.__dict__, "mesh_forces", forces)
    places = gear_meshes(rig)["test.pinion"]
    stresses = (600e6, 300e6)
    turn = ToothTurn(
        angle=np.array([0.0, 2.0, 5.0]),
        leading=1e6 * np.array([0.0, 600.0, -360.0]),
        trailing=1e6 * np.array([0.0, -720.0, 300.0]),
    )
    history = replace(histories["test.pinion"], turn=turn)
    mean, M = history.mean.total, history.sensitivity
    ratios = (mean - 360e6) / (mean + 600e6), (mean - 720e6) / (mean + 300e6)
    assert ratios[1] < -1.2
    safeties, factors = [], []
    for place, stress, ratio in zip(places, stresses, ratios, strict=True):
        standard = reversed_bending.by_standard(rig, place, stress, SPEED)
        computed = reversed_bending.of_history(rig, place, history)
        assert standard is not None and computed is not None
        assert standard.stress_ratio == pytest.approx(ratio)
        assert computed.stress_ratio == pytest.approx(ratio)
        assert computed.strength_factor == pytest.approx(standard.strength_factor)
        safeties.append(standard.strength_factor / (mean + stress))
        factors.append(standard.strength_factor)
    assert factors == pytest.approx([mean_stress_factor(ratio, M) for ratio in ratios])
    assert factors[1] < factors[0]
    assert safeties[0] < safeties[1]


def test_row_and_figure_show_both_fillets_with_the_mean_stress(histories: dict[str, ToothHistory]) -> None:
    row = tooth_history_row(histories["test.pinion"], rated=True)
    assert max(row.leading_MPa) == pytest.approx(
        1e-6 * (histories["test.pinion"].turn.leading.max() + histories["test.pinion"].mean.total)
    )
    assert row.highest_MPa == pytest.approx(max(*row.leading_MPa, *row.trailing_MPa))
    assert pytest.approx(row.lowest_MPa / row.highest_MPa) == row.R
    assert (row.rotation_deg[0], row.rotation_deg[-1]) == (0.0, 360.0)
    figure = tooth_history_figure([row])
    labels = {str(line.get_label()) for line in figure.axes[0].get_lines()}
    assert {"fillet of the leading flank", "fillet of the trailing flank", "mean stress"} <= labels


@pytest.mark.parametrize(("interference", "more"), [("0 um", False), ("150 um", True)])
def test_a_press_fit_adds_to_the_mean_stress(interference: str, more: bool) -> None:
    case = load_case("cases/uhcf_main").with_value(
        "gearboxes.test.gears.pinion.shaft_interference", interference
    )
    found = tooth_history.mean_stress(twisting_rig(case), GearInMesh(0, 0), SPEED)
    assert (found.press_fit > 1e6) is more


def test_a_press_fit_needs_a_seat() -> None:
    case = load_case("cases/uhcf_prototype")
    with pytest.raises(Exception, match="press fit needs a seat"):
        case.with_value("gearboxes.test.gears.pinion.shaft_interference", "10 um").with_value(
            "gearboxes.test.gears.pinion.bore_diameter", "0 mm"
        )


@pytest.fixture(scope="module")
def without_housing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    folder = tmp_path_factory.mktemp("idlers")
    idler_case(folder, housing=False)
    yield twisting_rig(load_case(folder))


def test_partners_without_places_are_taken_as_opposite(without_housing: Rig) -> None:
    places = gear_meshes(without_housing)["test.pinion"]
    assert len(places) == 2
    assert tooth_history._angle_between(without_housing, *places) == np.pi


def test_history_takes_the_application_factor_of_its_mesh(
    rig: Rig, point: Any, histories: dict[str, ToothHistory]
) -> None:
    """On one mesh of an idler: the stress of the other flank does not change."""
    case = rig.case.with_value("gearboxes.test.meshes.a.application_factor", "1.25")
    raised = tooth_history.tooth_history(
        twisting_rig(case), point, "test.pinion", gear_meshes(rig)["test.pinion"]
    )
    assert raised is not None
    plain, found = histories["test.pinion"].turn, raised.turn
    assert found.leading.max() == pytest.approx(1.25 * plain.leading.max())
    assert found.trailing.max() == pytest.approx(plain.trailing.max())
    assert found.trailing.min() == pytest.approx(1.25 * plain.trailing.min())


@pytest.mark.parametrize("front", [True, False])
def test_a_gear_that_is_wheel_and_pinion_keeps_its_face(
    rig: Rig, point: Any, monkeypatch: pytest.MonkeyPatch, front: bool
) -> None:
    """Helical teeth: only the loaded flank turns the face, as the contact counts it on back flanks."""
    stress = np.zeros((2, 1, 3))
    stress[1, 0, 2] = 500e6
    made = RootCourse(path=np.array([0.0, 1e-3]), face=np.array([-1e-3, 0.0, 3e-3]), stress=stress)
    field: Any = SimpleNamespace(course=lambda forces: made)
    monkeypatch.setattr(root, "field_of", lambda *of: field)
    stiff: Any = SimpleNamespace(mesh_stiffness="influence_numbers")
    forces: Any = SimpleNamespace()
    model = point.last.models[rig.mesh_names.index("reference.a")]
    assert model.pair.helix_angle != 0.0
    for index in (0, 1):
        under, behind = tooth_history._both_fillets(
            stiff, tooth_history._Passing(model, index, front), forces
        )
        for course in (under, behind):
            assert course.face[course.highest_at[2]] == (3e-3 if front else -3e-3)


def test_a_stated_rim_raises_the_centrifugal_stress(rig: Rig) -> None:
    case = rig.case.with_value("gearboxes.test.gears.wheel_a.rim_thickness", "10 mm")
    place = gear_meshes(rig)["test.wheel_a"][0]
    solid, rim = (tooth_history.mean_stress(one, place, SPEED) for one in (rig, twisting_rig(case)))
    assert rim.disc > 1.2 * solid.disc and rim.teeth > solid.teeth
