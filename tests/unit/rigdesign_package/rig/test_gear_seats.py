"""Seats of gears that give in all directions, and gears that stand beside their seat: from the case to the shafts."""

import numpy as np
import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case import load_case
from rigdesign.case.loader import changed_together
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES

CASE = CASES / "uhcf_prototype" / "table_1_bearings.toml"
AT = "gearboxes.test.gears.pinion"
SEAT = {
    f"{AT}.spline.radial_stiffness": "4e8 N/m",
    f"{AT}.spline.axial_stiffness": "2e8 N/m",
    f"{AT}.spline.angular_stiffness": "3e5 N m/rad",
    f"{AT}.spline.lateral_damping_time": 1e-6,
}


def test_a_seat_of_the_case_is_a_joint_in_all_directions() -> None:
    rig = build_rig(changed_together(load_case(CASE), SEAT))
    joint = rig.elastic.model.joint("test.pinion", "spline")
    values = dict(zip(joint.directions, np.diag(joint.stiffness)))
    damping = dict(zip(joint.directions, np.diag(joint.damping)))
    assert values["u_x"] == pytest.approx(2e8)
    assert values["u_y"] == values["u_z"] == pytest.approx(4e8)
    assert values["theta_y"] == values["theta_z"] == pytest.approx(3e5)
    assert damping["u_y"] == pytest.approx(4e2)
    rigid = build_rig(load_case(CASE)).elastic.model
    assert rig.elastic.model.size == rigid.size + 5


def test_a_gear_beside_its_seat_twists_the_shaft_there_and_meshes_in_its_own_plane() -> None:
    case = load_case(CASE)
    position = case.gearboxes["test"].gears["pinion"].position
    assert position is not None
    moved = build_rig(changed_together(case, {f"{AT}.seat_offset": "4 mm"}))
    assert moved.drivetrain is not None
    body = moved.drivetrain.gear("test.pinion")
    assert (body.position, body.offset) == pytest.approx((position - 4e-3, 4e-3))
    place = moved.elastic.model.freedoms.place("test.pinion")
    assert place.x == pytest.approx(build_rig(case).elastic.model.freedoms.place("test.pinion").x, abs=1e-12)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({f"{AT}.spline.radial_stiffness": "4e8 N/m"}, "axial_stiffness and angular_stiffness of the seat missing"),
        ({f"{AT}.spline.lateral_damping_time": 1e-6}, "is given without stiffness"),
        ({f"{AT}.seat_offset": "15 mm", f"{AT}.position": "10 mm"}, "puts the middle of the seat at"),
    ],
)  # fmt: skip
def test_seats_that_do_not_fit_are_named(values: dict[str, object], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        changed_together(load_case(CASE), values)
