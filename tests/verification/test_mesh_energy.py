"""An angle-dependent mesh stiffness neither makes nor destroys energy.

Oh, Grosh and Barber, ASME J. Mech. Des. 2005: switching k(t) as a function of the angle works on the gears unless the
torques hold the derivative terms. Two free gears of the size of P2's test gear at 180 Nm, no losses, 100 meshes; the
drift is relative to the strain energy at the mean load.
"""

from typing import get_args

import numpy as np
import pytest

from dynamics.tooth.law import DampedRate, MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import (
    BASE_RADIUS_1,
    BASE_RADIUS_2,
    TEETH,
    ramped_law,
    spur_law,
    two_bodies,
    wavy_law,
)

TORQUE = 180.0


def drift(
    law: MeshLaw, rpm: float, substeps: int, *, meshes: int = 100, derivative_torques: bool = True
) -> float:
    """Energy that appears within so many meshes, work of the loads taken off, per mean strain energy."""
    force = TORQUE / BASE_RADIUS_1
    deflection = force / law.mean_stiffness
    brake = TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1
    speed = rpm * np.pi / 30.0
    start = DriveState(
        angles=np.array([0.0, -deflection / BASE_RADIUS_2]),
        speeds=speed * np.array([1.0, BASE_RADIUS_1 / BASE_RADIUS_2]),
        twist=brake,
    )
    step = 1.0 / 40e3 / substeps
    march = TimeMarch(
        two_bodies(),
        [law],
        start,
        settings=MarchSettings(step=step, derivative_torques=derivative_torques),
        loads=DriveLoads(drive_torque=TORQUE),
    )
    before = march.energy()
    march.advance(np.tile([TORQUE, brake, 0.0, 0.0], (round(meshes / (rpm / 60.0 * TEETH[0]) / step), 1)))
    turned = march.state().angles - start.angles
    work = TORQUE * turned[0] - brake * turned[1]
    assert march.unconverged == 0
    return float(march.energy() - before - work) / (0.5 * force * deflection)


def test_no_energy_appears_at_1500_rpm() -> None:
    assert abs(drift(ramped_law(), 1500.0, 16)) < 1e-3


def test_little_energy_appears_at_12000_rpm() -> None:
    assert abs(drift(ramped_law(), 12000.0, 16)) < 3e-2


def shared(law: MeshLaw) -> MeshLaw:
    """The same mesh stiffness, 30 % of the approach in a body that all pairs share."""
    body = 0.3 / law.mean_stiffness
    return law._replace(stiffness=law.stiffness / 0.7, body_compliance=body)


@pytest.mark.parametrize("law", [shared(ramped_law()), shared(spur_law())])
def test_no_energy_appears_where_pairs_share_a_body(law: MeshLaw) -> None:
    assert abs(drift(law, 1500.0, 64, meshes=50)) < 2e-4
    assert abs(drift(law, 12000.0, 64)) < 3e-3


def test_drift_falls_at_second_order_where_pairs_share_a_body() -> None:
    law = shared(wavy_law(points=3201))
    worst = [max(abs(drift(law, 1500.0, n, meshes=m)) for m in (37, 41, 45, 50)) for n in (2, 4, 8)]
    assert worst[0] / worst[1] > 3.5
    assert worst[1] / worst[2] > 3.5


def test_without_derivative_torques_energy_appears() -> None:
    assert abs(drift(ramped_law(), 1500.0, 16, derivative_torques=False)) > 0.3


def test_drift_falls_at_second_order_in_smooth_contact() -> None:
    # largest drift over some end points, so that no zero crossing flatters one step length
    law = wavy_law(points=3201)
    worst = [max(abs(drift(law, 1500.0, n, meshes=m)) for m in (37, 41, 45, 50)) for n in (4, 8, 16)]
    assert worst[0] / worst[1] > 3.5
    assert worst[1] / worst[2] > 3.5


def test_motion_converges_at_second_order_in_smooth_contact() -> None:
    law = wavy_law(damping=1e3)
    start = DriveState(
        angles=np.array([0.0, -3.5e-5 / BASE_RADIUS_2]),
        speeds=600.0 * np.array([1.0, BASE_RADIUS_1 / BASE_RADIUS_2]),
        twist=TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1,
    )
    ends = []
    for steps in (250, 500, 1000, 16000):
        march = TimeMarch(
            two_bodies(),
            [law],
            start,
            settings=MarchSettings(step=2e-3 / steps),
            loads=DriveLoads(drive_torque=TORQUE),
        )
        block = march.advance(np.tile([TORQUE, start.twist, 0.0, 0.0], (steps, 1)))
        ends.append(block.approach[0, -1])
    errors = np.abs(np.array(ends[:3]) - ends[3])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(orders > 1.8)
    assert errors[2] < 1e-4 * 3.5e-5


@pytest.mark.parametrize("rpm", [1500.0, 6000.0])
def test_accounts_tell_the_same_drift(rpm: float) -> None:
    # work of the loads by the accounts against torque times angle
    law = wavy_law()
    force = TORQUE / BASE_RADIUS_1
    brake = TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1
    speed = rpm * np.pi / 30.0
    start = DriveState(
        angles=np.array([0.0, -force / law.mean_stiffness / BASE_RADIUS_2]),
        speeds=speed * np.array([1.0, BASE_RADIUS_1 / BASE_RADIUS_2]),
        twist=brake,
    )
    march = TimeMarch(
        two_bodies(),
        [law],
        start,
        settings=MarchSettings(step=1.0 / 640e3),
        loads=DriveLoads(drive_torque=TORQUE),
    )
    march.advance(np.tile([TORQUE, brake, 0.0, 0.0], (6400, 1)))
    turned = march.state().angles - start.angles
    work = march.accounts().slow_work
    assert work[0] == pytest.approx(TORQUE * turned[0], rel=1e-8)
    assert work[1] == pytest.approx(-brake * turned[1], rel=1e-8)


@pytest.mark.parametrize("body", [False, True])
@pytest.mark.parametrize("acts_on", get_args(DampedRate))
def test_march_books_all_that_the_damper_takes(acts_on: DampedRate, body: bool) -> None:
    # a free oscillation under steady load dies out: what is gone of the energy is in the account of the damper
    law = spur_law(n_slices=1, damping=1e3, damping_acts_on=acts_on)
    law = shared(law) if body else law
    force = TORQUE / BASE_RADIUS_1
    brake = TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1
    speed = 12000.0 * np.pi / 30.0
    start = DriveState(
        angles=np.array([0.0, -1.3 * force / law.mean_stiffness / BASE_RADIUS_2]),
        speeds=speed * np.array([1.0, BASE_RADIUS_1 / BASE_RADIUS_2]),
        twist=brake,
    )
    errors = []
    for step in (1.0 / 640e3, 1.0 / 2560e3):
        march = TimeMarch(
            two_bodies(),
            [law],
            start,
            settings=MarchSettings(step=step),
            loads=DriveLoads(drive_torque=TORQUE),
        )
        before = march.energy()
        march.advance(np.tile([TORQUE, brake, 0.0, 0.0], (round(5e-3 / step), 1)))
        work = march.accounts().slow_work.sum()
        lost = float(march.accounts().mesh_damping[0])
        errors.append(abs(march.energy() - before - work + lost))
        assert lost > (0.005 if body else 0.01)
    assert errors[1] < 0.25 * errors[0]
    assert errors[1] < 0.01 * lost


def test_damper_on_the_relative_rotation_brakes_both_gears_alike() -> None:
    # as one damper between the bodies: the damping matrix is symmetric, c k / k_mean on the line of action
    law = spur_law(n_slices=1, damping=1e3)
    theta = np.linspace(0.0, 2.0 * np.pi / TEETH[0], 50)
    rotation, closing = (
        evaluate_mesh(
            law._replace(damping_acts_on=acts_on), theta, 4e-5, 800.0, 800.0 * BASE_RADIUS_1 / BASE_RADIUS_2
        )
        for acts_on in get_args(DampedRate)
    )
    by_stiffness = -BASE_RADIUS_2 * law.damping / law.mean_stiffness
    np.testing.assert_allclose(
        rotation.torque_1_per_rate / BASE_RADIUS_1, -rotation.torque_2_per_rate / BASE_RADIUS_2, rtol=1e-12
    )
    inside = (
        np.abs(rotation.torque_2_per_approach * by_stiffness + BASE_RADIUS_2 * rotation.torque_2_per_rate)
        < 1e-9
    )
    assert inside.mean() > 0.8  # all contacts deeper than the depth over which damping grows
    apart = closing.torque_1_per_rate / BASE_RADIUS_1 + closing.torque_2_per_rate / BASE_RADIUS_2
    assert np.abs(apart).max() > 0.01 * law.damping
