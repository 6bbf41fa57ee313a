"""Senses of rotation over couplings: filled in where one gearbox states its own, refused where two contradict."""

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.case.rotation import pinion_sense, shaft_senses
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES


def test_meshes_turn_the_other_way_and_like_ends_turn_a_shaft_as_drawn() -> None:
    senses = shaft_senses(
        {"a": 1.0}, [("a", "b"), ("c", "d")], [(("a", "c"), ("end", "start")), (("d", "e"), ("end", "end"))]
    )
    assert senses == {"a": 1.0, "b": -1.0, "c": 1.0, "d": -1.0, "e": 1.0}


@pytest.mark.parametrize("rotation", ["clockwise", "anticlockwise"])
def test_a_gearbox_turns_as_its_couplings_turn_it(rotation: str) -> None:
    case = load_case(CASES / "uhcf_prototype").with_value("gearboxes.test.rotation", rotation)
    assert case.gearboxes["reference"].rotation == rotation
    rig = build_rig(case, "quick")
    for name, box in case.gearboxes.items():
        axis = rig.axes[box.gears["pinion"].shaft]
        assert pinion_sense(box, "main") == axis.sense * axis.direction, name


def test_a_rotation_that_contradicts_the_couplings_is_refused() -> None:
    case = load_case(CASES / "uhcf_prototype").with_value("gearboxes.test.rotation", "clockwise")
    with pytest.raises(
        CaseError, match=r"reference\.rotation.*coupled to gearbox test.*clockwise or leave it out"
    ):
        case.with_value("gearboxes.reference.rotation", "anticlockwise")
