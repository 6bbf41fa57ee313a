"""A cross joint under an angle turns its shafts ahead and back twice a turn."""

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES

COUPLING = "drivetrain.couplings.wheel_side"


def test_the_torque_is_that_of_the_kinematics_of_the_joint() -> None:
    """tan(turn_2) = tan(turn_1) cos(b): second order of the difference over a turn, against the torsional stiffness.
    The series ends with b^2, at 3 degrees to 0.2 %. It draws the first shaft ahead where the second
    stays behind."""
    angle = np.radians(3.0)
    values = {f"{COUPLING}.joint": "hooke", f"{COUPLING}.cold_angle_lateral": f"{1e3 * angle} mrad"}
    drivetrain = build_rig(load_case(CASES / "uhcf_prototype").with_values(values), "quick").drivetrain
    assert drivetrain is not None
    coupling = next(one for one in drivetrain.couplings if one.name == "wheel_side")
    (order,) = (part for part in coupling.excitation if part.order == 2.0)
    turn = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    ahead = np.arctan2(np.cos(angle) * np.sin(turn), np.cos(turn)) - turn
    ahead = (ahead + np.pi) % (2.0 * np.pi) - np.pi
    second = 2.0 * np.mean(ahead * np.exp(-2j * turn))
    found = order.amplitude * np.exp(-1j * order.phase) / coupling.stiffness
    assert found == pytest.approx(-second, abs=2e-3 * abs(second))
    assert abs(found) == pytest.approx(angle**2 / 4.0)


def test_axes_in_line_or_another_joint_make_none() -> None:
    case = load_case(CASES / "uhcf_prototype")
    for values in ({f"{COUPLING}.joint": "hooke"}, {f"{COUPLING}.cold_angle_lateral": "20 mrad"}):
        drivetrain = build_rig(case.with_values(values), "quick").drivetrain
        assert drivetrain is not None
        assert all(not coupling.excitation for coupling in drivetrain.couplings)
