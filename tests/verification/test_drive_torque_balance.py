"""At a dwell the motor torque of the momentum balance equals the losses integrated one by one.

Drive torque times speed is the sum of all losses: an identity that no model parameter can repair. The torque comes
from the momentum gained and lost, the losses from the contacts, the joint rates and the drags.
"""

import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.steady_motion import PeriodicResponse, TimeSettings, periodic_by_time
from tests.builders.rig import prototype, prototype_laws

RPM = np.pi / 30.0


@pytest.fixture(scope="module")
def rig() -> tuple[LinearSystem, tuple[MeshLaw, ...]]:
    return assemble(prototype(linear_drag=7e-4)), tuple(prototype_laws())


def dwell(rig: tuple[LinearSystem, tuple[MeshLaw, ...]], rpm: float, **options: float) -> PeriodicResponse:
    system, laws = rig
    drags = dict.fromkeys(list(system.drag_loads)[:2], 0.1)
    return periodic_by_time(
        system,
        laws,
        speed=rpm * RPM,
        drag_torques=drags,
        load=LoopLoad(torque=180.0),
        settings=TimeSettings(tolerance=1e-4, internal_rate=640e3, **options),
    )


@pytest.mark.parametrize("rpm", [900.0, 2500.0, 5000.0, 12000.0])
def test_drive_power_is_the_sum_of_the_losses(
    rig: tuple[LinearSystem, tuple[MeshLaw, ...]], rpm: float
) -> None:
    response = dwell(rig, rpm)
    assert response.steady, response.warnings
    assert response.drive_power + response.bracing_power == pytest.approx(response.total_loss, rel=1e-3)
    parts = (
        *response.friction_loss,
        *response.mesh_damping_loss,
        response.joint_loss,
        *response.drag_loss.values(),
    )
    assert min(parts) > 0.0
    assert sum(response.drag_loss.values()) > 0.01 * response.total_loss
    assert float(response.friction_loss.sum()) > 0.05 * response.total_loss
    assert response.mean_torque[0] == pytest.approx(180.0, rel=2e-4)


def test_friction_loss_is_the_friction_of_the_teeth(rig: tuple[LinearSystem, tuple[MeshLaw, ...]]) -> None:
    # the same run without tooth friction needs so much less torque
    system, laws = rig
    with_friction = dwell(rig, 3000.0)
    without = dwell((system, tuple(law._replace(friction=0.0) for law in laws)), 3000.0)
    saved = with_friction.drive_power - without.drive_power
    assert saved == pytest.approx(float(with_friction.friction_loss.sum()), rel=0.05)
    assert not np.any(without.friction_loss)
