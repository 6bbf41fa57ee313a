"""Gauges of the strain-gauge rig in the loaded contact of their mesh, on coarse influence numbers."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.tooth.mesh_cycle import MeshCycle
from dynamics.tooth.root_field import root_course
from rigdesign.base.part_name import MeshName
from rigdesign.case import load_case
from rigdesign.case.shipped import case_folder
from rigdesign.coupling.mesh_models import mesh_microgeometry
from rigdesign.postprocessing.loaded_contact import ElasticGear, gauge_stresses
from rigdesign.rig.model import Rig, build_rig
from tests.published.p1_contact import coarse, cycle_at, elastic_contact, elastic_gears

Gears = tuple[ElasticGear, ElasticGear]


@pytest.fixture(scope="module")
def rig() -> Rig:
    return build_rig(load_case(case_folder("strain_gauge_rig")), "quick")


@pytest.fixture(scope="module")
def gears(rig: Rig) -> Gears:
    return elastic_gears(rig.pairs["test.main"], coarse)


@pytest.fixture(scope="module")
def cycle(rig: Rig, gears: Gears) -> MeshCycle:
    pair = rig.pairs["test.main"]
    return cycle_at(
        elastic_contact(pair, mesh_microgeometry(rig, MeshName("test", "main"), pair), gears), 189.0
    )


def test_every_gauge_of_the_mesh_and_of_no_other(rig: Rig, cycle: MeshCycle, gears: Gears) -> None:
    found = gauge_stresses(rig, MeshName("test", "main"), cycle, gears)
    assert [(gauge.name, gauge.gear, gauge.front) for gauge in found] == [
        (name, "pinion", True) for name in ("i", "ii", "iii", "iv", "v")
    ]
    assert gauge_stresses(rig, MeshName("reference", "main"), cycle, gears) == ()


def test_reads_what_the_fillet_has_at_its_place(rig: Rig, cycle: MeshCycle, gears: Gears) -> None:
    """Mid-face gauge: mean over 0.6 x 1 mm within 1 % of the stress at its middle, the 30 deg tangent."""
    found = {gauge.name: gauge for gauge in gauge_stresses(rig, MeshName("test", "main"), cycle, gears)}
    course = root_course(cycle, gears[0].numbers, gears[0].compliance, 0)
    fillet = gears[0].numbers.fillet
    middle = len(course.face) // 2
    at_tangent = np.array(
        [np.interp(np.radians(-30.0), -fillet.tangent[:20], over[:20, middle]) for over in course.stress]
    )
    assert course.face[middle] == pytest.approx(0.0, abs=1e-12)
    assert found["iii"].curve.peak == pytest.approx(at_tangent.max(), rel=0.01)
    # the next tooth ahead bends the root the other way before the tooth itself carries
    assert found["iii"].curve.lowest < 0.0


def test_the_other_fillet_is_pressed(rig: Rig, cycle: MeshCycle, gears: Gears) -> None:
    behind = replace(rig.strain_gauges["test.pinion.iii"], front=False)
    other = replace(rig)
    other.__dict__["strain_gauges"] = {"test.pinion.iii": behind}
    (found,) = gauge_stresses(other, MeshName("test", "main"), cycle, gears)
    (drawn,) = (
        one for one in gauge_stresses(rig, MeshName("test", "main"), cycle, gears) if one.name == "iii"
    )
    assert -found.curve.lowest == pytest.approx(drawn.curve.peak, rel=0.4)
    assert abs(found.curve.peak) < 0.2 * drawn.curve.peak


def test_on_back_flanks_a_gauge_there_reads_from_the_other_end(
    rig: Rig, cycle: MeshCycle, gears: Gears
) -> None:
    """The gear turned round by half a turn: its back fillet in front, the face counted the other way."""
    front = rig.strain_gauges["test.pinion.ii"]
    place = front.point.placement
    mirrored = replace(place, face_position=-place.face_position)
    other = replace(rig)
    other.__dict__["strain_gauges"] = {
        "test.pinion.ii": replace(front, front=False, point=replace(front.point, placement=mirrored))
    }
    (found,) = gauge_stresses(other, MeshName("test", "main"), cycle, gears, "back")
    (drawn,) = (
        one for one in gauge_stresses(rig, MeshName("test", "main"), cycle, gears) if one.name == "ii"
    )
    assert found.curve.stress == pytest.approx(drawn.curve.stress, rel=1e-9, abs=1.0)
