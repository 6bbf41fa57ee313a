"""The bracing controller brings the mean torque of the first mesh to the one asked for, whatever its sign per twist."""

from dataclasses import replace

import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings, TorqueControl
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.rig import prototype, prototype_laws

SPEED, TORQUE = 300.0, 100.0


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_torque_comes_back_from_a_twist_that_is_too_large(sense: float) -> None:
    system = assemble(prototype())
    system = replace(system, twist_load=sense * system.twist_load)
    wound = wound_state(system, prototype_laws(), SPEED, LoopLoad(torque=TORQUE))
    assert sense * wound.loop_stiffness > 0.0
    settings = MarchSettings(step=1.0 / 320e3, substeps=8, accounts=False, record_all=False)
    march = TimeMarch(
        system, prototype_laws(), wound.state, settings, DriveLoads(drive_torque=wound.drive_torque)
    )
    given = np.tile([wound.drive_torque, 1.3 * wound.state.twist, SPEED, TORQUE], (4000, 1))
    control = TorqueControl(stiffness=wound.loop_stiffness)
    means = [
        float(
            march.advance(given, torque_control=control).force[0].mean() * prototype_laws()[0].base_radius_1
        )
        for _ in range(5)
    ]
    assert means[0] > 1.03 * TORQUE
    assert means[-1] == pytest.approx(TORQUE, rel=2e-3)
