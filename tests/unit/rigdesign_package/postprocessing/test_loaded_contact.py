"""Loaded contact of the warm prototype from coarse influence numbers: record, row of the result, picture."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from dynamics.gear.flank import AxisMisalignment
from dynamics.tooth.elastic_segment import GearModel
from dynamics.tooth.influence_numbers import SectionDivision
from dynamics.tooth.loaded_mesh import LoadedMesh
from rigdesign.postprocessing import root
from rigdesign.postprocessing.gear_loads import COMPUTED, STATED, rated_loads
from rigdesign.postprocessing.loaded_contact import held_contact, loaded_contact
from rigdesign.postprocessing.tooth_history import tooth_histories
from rigdesign.report.figures.teeth import tooth_contact_figure
from rigdesign.results.serialisation.teeth import loaded_contact_row
from rigdesign.results.teeth import FROM_FACTORS, FROM_INFLUENCE, LoadedContact
from rigdesign.rig import tooth_influence
from rigdesign.rig.model import Rig
from rigdesign.rig.tooth_influence import InfluenceStore
from tests.builders.warm_prototype import base

pytestmark = pytest.mark.whole_run

COARSE = SectionDivision(profile=4, thickness=2, fillet=8, depth=1, grading=0.4, neighbours=(2, 1, 4))


def coarse(model: GearModel) -> GearModel:
    return replace(model, division=COARSE, n_face=7)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """The prototype with influence numbers of coarse teeth."""
    rig, _ = base()
    whole = tooth_influence.gear_model
    tooth_influence.gear_model = lambda *arguments: coarse(whole(*arguments))
    try:
        folder = tmp_path_factory.mktemp("influence")
        yield replace(
            rig,
            mesh_stiffness="influence_numbers",
            tooth_influence=tooth_influence.ToothInfluence(InfluenceStore(folder)),
        )
    finally:
        tooth_influence.gear_model = whole


@pytest.fixture(scope="module")
def found(rig: Rig) -> LoadedContact:
    """Of the test gears at 180 N m."""
    contact = loaded_contact(rig, base()[1], 0)
    assert contact is not None
    return contact


def test_quick_has_no_loaded_contact() -> None:
    rig, result = base()
    assert loaded_contact(rig, result, 0) is None


def test_teeth_of_the_prototype_meet_early_and_share_as_in_calculix(found: LoadedContact) -> None:
    """CalculiX, plane, cold: largest share 0.884, contact ratio 2.08, pinion root 1240 MPa.

    The wheel is twice as wide as the pinion and sees 960 MPa with the standard mesh; this one is coarse.
    """
    assert found.torque == pytest.approx(180.0, rel=1e-3)
    assert found.unloaded_contact_ratio == pytest.approx(1.0, abs=1e-4)
    assert found.cycle.contact_ratio == pytest.approx(2.1, abs=0.1)
    assert found.cycle.early.any() and found.cycle.late.any()
    assert found.cycle.load_share.max() == pytest.approx(0.88, abs=0.03)
    assert found.roots[0].highest == pytest.approx(1.24e9, rel=0.08)
    assert found.roots[1].highest == pytest.approx(0.96e9, rel=0.1)


def test_stress_over_the_path_is_that_of_the_numbers(rig: Rig, found: LoadedContact) -> None:
    """Forces of the mesh law: the stress of the loaded contact on the same numbers, per force on the tooth.

    Analytic teeth carry 0.79 at most where those of the loaded contact carry 0.88, and their face is cut into slices:
    on the wheel, twice as wide as the pinion, the load then ends half a slice further out.
    """
    model = base()[1].last.models[0]
    response = base()[1].last.response
    assert response is not None
    roots, factors = root.mesh_roots(rig, model), root.mesh_roots(base()[0], model)
    assert (roots.source, factors.source) == (FROM_INFLUENCE, FROM_FACTORS)
    (forces,) = root.dynamic_forces(model, [response], 0)
    stresses = roots.highest(forces)
    share = float(forces.force.sum(axis=2).max()) / found.cycle.mesh_force
    expected = [course.highest * share / found.cycle.load_share.max() for course in found.roots]
    assert [root.peak(stress) for stress in stresses] == pytest.approx(expected, rel=0.07)
    narrow = roots.at_highest(forces).highest(forces)
    assert [root.peak(one) for one in narrow] == [root.peak(one) for one in stresses]
    place = root.StressedGear("pinion", "test", model.pair.base_radii[0], roots.source)
    shown = root.over_path(place, stresses[0], stresses[0])
    assert shown.source == FROM_INFLUENCE
    assert max(shown.dynamic) == pytest.approx(root.peak(stresses[0]), rel=5e-3)


def test_both_fillets_of_a_gear_with_one_mesh(rig: Rig) -> None:
    """The fillet behind the loaded flank is compressed by about 1.2 times the tension (ISO 6336-3, Annex B)."""
    histories = {one.gear: one for one in tooth_histories(rig, base()[1]) if one.gear.startswith("test.")}
    pinion = histories["test.pinion"]
    assert pinion.meshes == ("test",)
    # the pinion of the test gears is driven or drives: one flank is under tension, the other compressed
    tension = max(pinion.turn.leading.max(), pinion.turn.trailing.max())
    compression = min(pinion.turn.leading.min(), pinion.turn.trailing.min())
    assert compression / tension == pytest.approx(-1.2, abs=0.15)
    neighbours = min(pinion.turn.leading.min(), pinion.turn.trailing.min(), key=abs)
    assert -0.25 < neighbours / tension < -0.05
    assert pinion.stress_ratio == pytest.approx((neighbours + pinion.mean.total) / pinion.highest)
    assert pinion.source == FROM_INFLUENCE


def test_forces_carry_the_torque(found: LoadedContact) -> None:
    cycle = found.cycle
    torque = cycle.mesh_force * cycle.points.pair.base_radii[1]
    assert cycle.torques[1] == pytest.approx(np.full(64, torque), rel=1e-10)


def test_row_and_picture_hold_what_was_found(found: LoadedContact) -> None:
    row: dict[str, Any] = loaded_contact_row(found)
    assert row["K_H_beta"] == pytest.approx(found.cycle.face_load_factor)
    edges = row["edge_contact"]
    assert edges["where"] == "tip edge of pinion and wheel"
    assert max(edges["tip_pressure_pinion_MPa"], edges["tip_pressure_wheel_MPa"]) == row["edge_pressure_MPa"]
    assert 0.05 < edges["tip_share"] < 0.4
    assert row["root_stress"]["pinion"]["largest_MPa"] == pytest.approx(1e-6 * found.roots[0].highest)
    assert max(row["root_stress"]["wheel"]["highest_MPa"]) == pytest.approx(1e-6 * found.roots[1].highest)
    assert np.all(np.diff(row["root_stress"]["wheel"]["rolling_angle_deg"]) > 0.0)
    tangent = row["root_stress_30_deg_tangent"]["pinion"]
    assert len(tangent["face_mm"]) == 7 and np.all(np.diff(tangent["face_mm"]) > 0.0)
    # the critical section of the standard lies next to the most stressed point of the fillet
    assert 0.85 < max(tangent["highest_MPa"]) / row["root_stress"]["pinion"]["largest_MPa"] <= 1.0
    pressure = np.array(row["pattern"]["pressure_MPa"])
    assert pressure.shape == np.shape(row["pattern"]["rolling_angle_deg"])
    assert pressure.max() == pytest.approx(row["flank_pressure_MPa"])
    figure = tooth_contact_figure(row)
    for axes in figure.axes[1:3]:
        assert {"highest over the face", "mid-face"} <= {str(line.get_label()) for line in axes.get_lines()}


def test_ratings_take_the_load_factors_of_the_contact(rig: Rig, found: LoadedContact) -> None:
    load = next(rated_loads(rig, [base()[1]], 0))
    assert load.sharing_basis == COMPUTED
    assert load.contact.face_load == found.cycle.face_load_factor > 1.0
    ratio = rig.pairs["test.main"].face_width / 1e-3 / 2.0  # b/h: whole depth of about 2 mm
    exponent = np.log(load.root.K_Fbeta) / np.log(load.contact.face_load)
    assert exponent == pytest.approx(ratio**2 / (1.0 + ratio + ratio**2), rel=0.05)
    assert 1.0 <= load.contact.transverse <= 1.0 / found.cycle.load_share.max() + 1e-9


def test_quick_takes_the_face_load_factor_of_the_case() -> None:
    rig, result = base()
    load = next(rated_loads(rig, [result], 1))
    assert load.sharing_basis == STATED
    assert load.root.K_Fbeta == rig.case.gearboxes["reference"].meshes["main"].face_load_factor


def test_contact_of_a_point_is_solved_once(
    rig: Rig, found: LoadedContact, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*given: object) -> None:
        raise AssertionError("solved again")

    next(rated_loads(rig, [base()[1]], 0))
    monkeypatch.setattr(LoadedMesh, "cycle", refuse)
    next(rated_loads(rig, [base()[1]], 0))
    again = held_contact(rig, base()[1], 0)
    assert again is not None and again.cycle is found.cycle


def test_inclined_axes_shift_the_pattern_to_the_end_where_they_close(rig: Rig) -> None:
    """The warm housing against one that opens the front flanks to the rear by 8 um over the face."""
    result = base()[1]
    held = held_contact(rig, result, 0)
    assert held is not None
    slope = 8e-6 / held.flanks.pair.face_width
    axes = AxisMisalignment.of_gap(held.flanks.pair, slope, slope)
    parted = replace(held, flanks=replace(held.flanks, axes=axes))
    assert parted.cycle.pattern(0).centre[1] < held.cycle.pattern(0).centre[1] - 0.3e-3
    assert parted.cycle.face_load_factor > held.cycle.face_load_factor
