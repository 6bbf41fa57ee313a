"""Loaded contact of the warm prototype from coarse influence numbers: record, row of the result, picture."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from dynamics.influence.gear_body import SectionDivision
from dynamics.influence.gear_model import GearModel
from rigdesign.records.loaded_contact import loaded_contact
from rigdesign.report.figures.tooth_contact import tooth_contact_figure
from rigdesign.results.loaded_contact import LoadedContact
from rigdesign.results.rows.loaded_contact import loaded_contact_row
from rigdesign.rig import tooth_influence
from rigdesign.rig.influence_store import InfluenceStore
from tests.builders.warm_prototype import base

pytestmark = pytest.mark.whole_run

COARSE = SectionDivision(profile=4, thickness=2, fillet=8, depth=1, grading=0.4, neighbours=(2, 1, 4))


def coarse(model: GearModel) -> GearModel:
    return replace(model, division=COARSE, n_face=5)


@cache
def contact(folder: str) -> LoadedContact:
    """Of the test gears at 180 N m."""
    rig, result = base()
    rig = replace(
        rig,
        mesh_stiffness="influence_numbers",
        tooth_influence=tooth_influence.ToothInfluence(InfluenceStore(folder)),
    )
    whole = tooth_influence.gear_model
    tooth_influence.gear_model = lambda pair, index: coarse(whole(pair, index))
    try:
        found = loaded_contact(rig, result, 0)
    finally:
        tooth_influence.gear_model = whole
    assert found is not None
    return found


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> LoadedContact:
    return contact(tmp_path_factory.mktemp("influence"))


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
