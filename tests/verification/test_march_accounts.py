"""Energy of a march with every term integrated by itself: teeth, joints, films with skew stiffness, loads.

Work put in = losses of teeth and joints + what skew stiffness takes + change of the stored energy, at the default step.
"""

import numpy as np
import pytest

from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings, static_position
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, spur_law, wavy_law
from tests.verification.test_band_change import BRAKE, TORQUE, drive, system

LAWS = {
    "one contact": wavy_law(damping=2e3, friction=0.03, backlash=1.0),
    "no losses": wavy_law(depth=0.0, backlash=1.0),
    "spur teeth": spur_law(damping=2e3, friction=0.03),
}
SPEED = 600.0


def books(name: str, substeps: int, duration: float = 0.05, whirl: float = 0.0) -> tuple[float, float, float]:
    """Imbalance, what the losses took together, what skew stiffness took [J]."""
    law, rig = LAWS[name], system(300.0)
    force = TORQUE / BASE_RADIUS_1
    load = TORQUE * drive(rig) + BRAKE * rig.twist_load
    load += np.array([-TORQUE, 0.0, 0.0, BASE_RADIUS_2 * force, 0.0])
    angles = static_position(rig, load)
    # half as much again as the flanks are pressed: the rig swings
    angles[3:] += (
        BASE_RADIUS_1 * angles[0] - BASE_RADIUS_2 * angles[3] - 1.5 * force / 1.1e8
    ) / BASE_RADIUS_2
    angles[1] += whirl
    ratio = BASE_RADIUS_1 / BASE_RADIUS_2
    start = DriveState(angles=angles, speeds=SPEED * np.array([1.0, 0.0, 0.0, ratio, ratio]), twist=BRAKE)
    march = TimeMarch(
        rig, [law], start, MarchSettings(step=1.0 / 40e3 / substeps, substeps=substeps, accounts=True),
        DriveLoads(drive_torque=TORQUE),
    )  # fmt: skip
    given = np.tile([TORQUE, BRAKE, 0.0, 0.0], (round(0.5 * duration * 40e3), 1))
    march.advance(given[:1])
    before, stored = march.accounts(), march.energy()
    march.advance(given)
    work = march.accounts().since(before)
    assert march.unconverged == 0
    losses = float(work.friction.sum() + work.mesh_damping.sum()) + work.joint_damping
    put_in = float(work.slow_work.sum())
    return put_in - losses - work.circulation - (march.energy() - stored), losses, work.circulation


@pytest.mark.parametrize("name", ["one contact", "spur teeth"])
def test_the_books_close_at_the_default_step(name: str) -> None:
    imbalance, losses, circulation = books(name, 8)
    print(name, imbalance, losses, circulation)
    assert abs(imbalance) < 1e-3 * losses


def test_the_imbalance_falls_with_the_step() -> None:
    found = [books("one contact", substeps) for substeps in (1, 2, 4, 16)]
    coarse, middle, fine, finest = (abs(imbalance) / losses for imbalance, losses, *_ in found)
    print(coarse, middle, fine, finest)
    assert middle < coarse / 4.0  # at least second order, down to what the tables leave
    assert max(fine, finest) < 1e-5


def test_what_a_film_takes_from_a_whirl_is_booked() -> None:
    """A shaft let go 20 um beside its place: its film damps it, and its skew stiffness takes a part of its own."""
    imbalance, losses, circulation = books("no losses", 8, 0.01, whirl=2e-5)
    print(imbalance, losses, circulation)
    assert abs(circulation) > 0.02 * losses
    assert abs(imbalance) < 1e-3 * losses
