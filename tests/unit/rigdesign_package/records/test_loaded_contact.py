"""Loaded contact of the warm prototype from coarse influence numbers: record, row of the result, picture."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from dynamics.contact.loaded_mesh import LoadedMesh
from dynamics.flank.axes import AxisMisalignment
from dynamics.influence.gear_body import SectionDivision
from dynamics.influence.gear_model import GearModel
from rigdesign.records.gear_loads import COMPUTED, STATED, rated_loads
from rigdesign.records.loaded_contact import held_contact, loaded_contact
from rigdesign.report.figures.tooth_contact import tooth_contact_figure
from rigdesign.results.loaded_contact import LoadedContact
from rigdesign.results.rows.loaded_contact import loaded_contact_row
from rigdesign.rig import tooth_influence
from rigdesign.rig.influence_store import InfluenceStore
from rigdesign.rig.model import Rig
from tests.builders.warm_prototype import base

pytestmark = pytest.mark.whole_run

COARSE = SectionDivision(profile=4, thickness=2, fillet=8, depth=1, grading=0.4, neighbours=(2, 1, 4))


def coarse(model: GearModel) -> GearModel:
    return replace(model, division=COARSE, n_face=5)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """The prototype with influence numbers of coarse teeth."""
    rig, _ = base()
    whole = tooth_influence.gear_model
    tooth_influence.gear_model = lambda pair, index: coarse(whole(pair, index))
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


def test_forces_carry_the_torque(found: LoadedContact) -> None:
    cycle = found.cycle
    torque = cycle.mesh_force * cycle.points.pair.base_radii[1]
    assert cycle.torques[1] == pytest.approx(np.full(64, torque), rel=1e-10)


def test_row_and_picture_hold_what_was_found(found: LoadedContact) -> None:
    row: dict[str, Any] = loaded_contact_row(found)
    assert row["K_H_beta"] == pytest.approx(found.cycle.face_load_factor)
    assert row["root_stress"]["pinion"]["largest_MPa"] == pytest.approx(1e-6 * found.roots[0].highest)
    assert max(row["root_stress"]["wheel"]["highest_MPa"]) == pytest.approx(1e-6 * found.roots[1].highest)
    assert np.all(np.diff(row["root_stress"]["wheel"]["rolling_angle_deg"]) > 0.0)
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
