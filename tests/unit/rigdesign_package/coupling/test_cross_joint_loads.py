"""A cross joint of a case: torque that it passes, load of its linear system, couple on the bearings of its shafts."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.coupling.bearing_loads import bearing_loads
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.loop_system import loop_system
from rigdesign.coupling.misalignment import coupling_forces, coupling_torques
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES

ANGLE = 2e-3


def rig_with(side: str, joint: str = "hooke") -> Rig:
    """The prototype with bearings of Table 1, axes at one coupling 2 mrad apart across."""
    at = f"drivetrain.couplings.{side}"
    values = {f"{at}.joint": joint, f"{at}.cold_angle_lateral": f"{1e3 * ANGLE} mrad"}
    return build_rig(
        load_case(CASES / "uhcf_prototype" / "table_1_bearings.toml").with_values(values), "standard"
    )


@pytest.fixture(scope="module", params=["pinion_side", "wheel_side"])
def side(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def rig(side: str) -> Rig:
    return rig_with(side)


def passed(rig: Rig, side: str) -> float:
    """By hand: the mesh torque of the gear on the first shaft, which the other gear of the line takes again."""
    point = held_points(rig)[0]
    torque = initial_state(rig, point).mesh_torque["test.main"]
    first, second = rig.pairs["test.main"].teeth
    return -torque if side == "pinion_side" else torque * second / first


def test_a_cross_joint_passes_the_torque_of_its_line(rig: Rig, side: str) -> None:
    """The pinion that drives is driven through its coupling, the wheel passes on what it gets; both couplings name the
    shaft of the test gearbox first."""
    assert rig.case.drivetrain is not None
    assert rig.case.drivetrain.couplings[side].shafts[0].startswith("test_")
    state = initial_state(rig, held_points(rig)[0])
    assert coupling_torques(rig, state.mesh_torque) == {side: pytest.approx(passed(rig, side), rel=1e-9)}


def test_its_load_of_the_system_grows_with_the_torque(rig: Rig, side: str) -> None:
    point = held_points(rig)[0]
    for share in (1.0, 0.5):
        state = initial_state(rig, point)
        state = replace(state, mesh_torque={k: share * v for k, v in state.mesh_torque.items()})
        loads = loop_system(rig, point, state, {}).periodic_loads
        found = [part for one in loads if one.name == f"cross joint {side}" for part in one.parts]
        assert [part.order for part in found] == [2.0, 2.0]
        assert [part.amplitude for part in found] == pytest.approx([share * passed(rig, side)] * 2)
    assert not [one for one in loads if one.name.startswith("cross joint") and not np.any(one.load)]


def test_the_bearings_of_both_shafts_carry_half_of_torque_times_angle(rig: Rig, side: str) -> None:
    """A couple -T/2 b w with w = -s (0, slope) on both, against the same coupling as a spring alone: force times
    distance of the two forces that stand for it, no force, and its lever rule on the bearings. The spring presses with
    5.7 N in both but for 2e-4 of it: the basis of the cross joint has shapes of its own."""
    state = initial_state(rig, held_points(rig)[0])
    assert rig.case.drivetrain is not None
    other = rig_with(side, "constant_velocity")
    plain, bent = bearing_loads(other, state), bearing_loads(rig, state)
    for shaft in rig.case.drivetrain.couplings[side].shafts:
        here, there = (list(coupling_forces(one, shaft, state)) for one in (rig, other))
        (near, one), (far, two) = (
            (place, force - old) for (place, force), (_, old) in zip(here, there, strict=True)
        )
        assert one + two == pytest.approx([0.0, 0.0], abs=1e-3)
        axis = rig.axes[shaft]
        about_y = -0.5 * passed(rig, side) * (-axis.sense * ANGLE)
        moment = axis.direction * (far - near) * two
        assert moment == pytest.approx([0.0, -about_y], abs=2e-3)
        first, last = (name for name, _, entry in rig.bearings() if entry.shaft == shaft)
        span = axis.direction * ((rig.bearing(last).position or 0.0) - (rig.bearing(first).position or 0.0))
        change = np.array(bent[last].force) - np.array(plain[last].force)
        assert change == pytest.approx(moment / span, rel=1e-3, abs=2e-3)


def test_another_joint_has_none(side: str) -> None:
    rig = rig_with(side, "constant_velocity")
    point = held_points(rig)[0]
    state = initial_state(rig, point)
    assert coupling_torques(rig, state.mesh_torque) == {}
    assert not [one for one in loop_system(rig, point, state, {}).periodic_loads if "cross joint" in one.name]
