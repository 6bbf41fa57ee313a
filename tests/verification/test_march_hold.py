"""Mesh torques in a march: undamped vibrations stay as they are, displacements converge at fourth order.

Closed form: two free discs on a mesh spring swing with omega^2 = k (r_1^2 / J_1 + r_2^2 / J_2) about the deflection
under load; an elastic chain keeps its energy.
"""

import numpy as np
import pytest

from dynamics.tooth.law import MeshLaw
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, chain, two_bodies, wavy_law

TORQUE = 180.0
SPRING = 1.1e8
INERTIA = (5.1e-4, 1.1e-3)
OMEGA = float(np.sqrt(SPRING * (BASE_RADIUS_1**2 / INERTIA[0] + BASE_RADIUS_2**2 / INERTIA[1])))
DEFLECTION = TORQUE / BASE_RADIUS_1 / SPRING
BRAKE = TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1
STEPS = 100_000


def swinging(
    law: MeshLaw, step: float, steps: int, speed: float = 0.0
) -> tuple[np.ndarray, np.ndarray, TimeMarch]:
    """Approach less its mean, and its rate, of two discs let go at 1.5 times their deflection."""
    start = DriveState(
        angles=np.array([0.0, -1.5 * DEFLECTION / BASE_RADIUS_2]),
        speeds=speed * np.array([1.0, BASE_RADIUS_1 / BASE_RADIUS_2]),
        twist=BRAKE,
    )
    march = TimeMarch(
        two_bodies(INERTIA), [law], start, MarchSettings(step=step), DriveLoads(drive_torque=TORQUE)
    )
    block = march.advance(np.tile([TORQUE, BRAKE, 0.0, 0.0], (steps, 1)))
    assert march.unconverged == 0
    return block.approach[0] - DEFLECTION, block.rate[0], march


@pytest.mark.parametrize("share", [0.1, 0.4, 1.2])
def test_vibration_on_a_mesh_spring_neither_grows_nor_decays(share: float) -> None:
    """Steps of a sixty-third, a sixteenth and a fifth of a period; amplitudes over the first and the last periods."""
    x, _, _ = swinging(wavy_law(depth=0.0), share / OMEGA, STEPS)
    some = 500
    early, late = np.sqrt(np.mean(x[:some] ** 2)), np.sqrt(np.mean(x[-some:] ** 2))
    # an interval of 500 steps cuts its last period: 1 / (2 pi periods) at most
    assert late == pytest.approx(early, rel=2.0 / (some * share))
    spans = x[: STEPS - STEPS % 1000].reshape(-1, 1000)
    peaks = np.abs(spans).max(axis=1)
    # no trend: a straight line through the peaks of all spans rises by less than 1e-4 in 1e5 steps
    trend = np.polyfit(np.linspace(0.0, 1.0, len(peaks)), peaks / peaks.mean(), 1)[0]
    assert abs(trend) < (1e-4 if share < 1.0 else 1e-3)


@pytest.mark.parametrize("share", [0.05, 0.1, 0.2])
def test_frequency_on_a_mesh_spring_is_off_at_fourth_order(share: float) -> None:
    """Numerov: (omega h)^4 / 480 of the frequency; the straight line would have (omega h)^2 / 24."""
    periods = 400
    steps = round(periods * 2.0 * np.pi / share)
    x, _, _ = swinging(wavy_law(depth=0.0), share / OMEGA, steps)
    crossing = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    at = crossing + x[crossing] / (x[crossing] - x[crossing + 1])
    frequency = 2.0 * np.pi * (len(at) - 1) / (at[-1] - at[0]) / share
    bound = share**4 / 480.0
    assert abs(frequency - 1.0) < 2.0 * bound + 3e-7
    assert bound < 0.02 * share**2 / 24.0


def test_elastic_chains_in_mesh_keep_their_energy() -> None:
    """Twelve discs, undamped joints, a mesh spring: modes up to 5 kHz and 27 kHz, 1e5 steps of 3 us."""
    system = chain(joint=(1e6, 0.0))
    rng = np.random.default_rng(5)
    # wound up by the loads, so that the flanks stay in contact
    angles = rng.normal(size=12) * 2e-7
    angles[:6] -= TORQUE * np.concatenate(([0.0], np.cumsum([1e-6, 5e-6, 5e-6, 5e-6, 5e-6]))) - TORQUE * 21e-6
    angles[6:] += BRAKE * np.array([-20e-6, -20e-6, -15e-6, -10e-6, -5e-6, 0.0])
    angles[6:] -= 1.1 * DEFLECTION / BASE_RADIUS_2
    start = DriveState(angles=angles, speeds=rng.normal(size=12) * 0.02, twist=BRAKE)
    law = wavy_law(depth=0.0, backlash=1.0)
    march = TimeMarch(
        system, [law], start, MarchSettings(step=3.1e-6, cutoff=np.inf), DriveLoads(drive_torque=TORQUE)
    )
    kept = []
    for _ in range(20):
        march.advance(np.tile([TORQUE, BRAKE, 0.0, 0.0], (STEPS // 20, 1)))
        state = march.state()
        # the loads have a potential as well
        kept.append(march.energy() - TORQUE * state.angles[0] + BRAKE * state.angles[7])
    swing = 0.5 * SPRING * (0.1 * DEFLECTION) ** 2
    trend = np.polyfit(np.linspace(0.0, 1.0, 20), kept, 1)[0]
    assert abs(trend) < 1e-4 * swing
    # speeds are of second order in (omega h): the energy seen swings with them
    assert np.ptp(kept) < 1e-2 * swing


def test_motion_converges_at_fourth_order_where_the_contact_is_smooth() -> None:
    """No damper: mean of the approach error over the last fifth of 2 ms against a march with steps of 0.1 us."""
    law = wavy_law(points=4001)
    ends = {}
    for steps in (250, 500, 1000, 16000):
        x, _, _ = swinging(law, 2e-3 / steps, steps, speed=60.0)
        ends[steps] = x[steps // 250 - 1 :: steps // 250][-50:]
    errors = np.array([np.sqrt(np.mean((ends[n] - ends[16000]) ** 2)) for n in (250, 500, 1000)])
    orders = np.log2(errors[:-1] / errors[1:])
    print(errors / DEFLECTION, orders)
    # speeds are of second order, and so is the start of the motion
    assert np.all(orders > 3.0)
    assert errors[0] < 1e-3 * DEFLECTION
