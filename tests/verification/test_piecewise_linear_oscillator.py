"""Contact loss and jumps: the piecewise-linear oscillator with the shipped contact kernel.

x'' + 2 zeta x' + g(x) = F_m + F_a W^2 cos(W t), g = x -+ 1 outside |x| > 1 and 0 inside; zeta 0.05, F_m 0.1, F_a 0.05:
parameters of Kahraman and Singh, J. Sound Vib. 142 (1990). Half peak-to-peak amplitudes from DOP853 at 1e-9 over 400
cycles, swept up and down. The damper acts in the gap too, so it stands on the ground beside the contact.
"""

import numpy as np
import pytest

from dynamics.tooth.law import MeshLaw
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import two_bodies
from tests.published.mechanics import DOWN, FORCE, MEAN_FORCE, UP, ZETA

FREQUENCIES = tuple(sorted(UP))
STEPS = 200


def law() -> MeshLaw:
    """One pair of constant stiffness 1 for ever, play of 2 about x = 0."""
    none = np.zeros((1, 3))
    return MeshLaw(
        base_radius_1=1.0, base_radius_2=1.0, base_pitch=1e3, teeth_1=1, teeth_2=1, tooth_offset_2=0,
        path_start=-500.0, path_step=500.0, stiffness=np.ones((1, 3)), gap=none, slice_shift=np.zeros(1),
        deviation_1=none, deviation_2=none, scale_1=np.ones(1), scale_2=np.ones(1), backlash=2.0, offset=-1.0,
        phase=0.0, back_phase=0.0, damping=0.0, mean_stiffness=1.0, friction=0.0, rolling_radius_1=1.0,
        rolling_radius_2=1.0, friction_reversal_speed=1.0,
    )  # fmt: skip


def sweep(frequencies: tuple[float, ...], cycles: int = 120) -> np.ndarray:
    """(half peak-to-peak, least, mean displacement) at each frequency, each run from the end of the one before."""
    system = two_bodies(inertia=(1.0, 1e12), damping=(2.0 * ZETA, 0.0))
    state = DriveState(angles=np.array([1.0 + MEAN_FORCE, 0.0]), speeds=np.zeros(2))
    rows = []
    for frequency in frequencies:
        step = 2.0 * np.pi / frequency / STEPS
        time = step * np.arange(1, cycles * STEPS + 1)
        force = MEAN_FORCE + FORCE * frequency**2 * np.cos(frequency * time)
        given = np.zeros((len(time), 4))
        given[:, 0] = force
        march = TimeMarch(
            system,
            [law()],
            state,
            settings=MarchSettings(step=step, accounts=False),
            loads=DriveLoads(drive_torque=force[-1]),
        )
        displacement = march.advance(given).approach[0, -STEPS:] - law().offset
        state = march.state()
        rows.append((0.5 * np.ptp(displacement), displacement.min(), displacement.mean()))
        assert march.unconverged == 0
    return np.array(rows).T


def test_upward_sweep_jumps_between_080_and_085() -> None:
    amplitudes, least, _ = sweep(FREQUENCIES)
    np.testing.assert_allclose(amplitudes, [UP[f] for f in FREQUENCIES], rtol=5e-3)
    assert least[3] > 1.0 > least[4]


def test_downward_sweep_keeps_the_upper_branch_to_075() -> None:
    amplitudes, least, mean = sweep(FREQUENCIES[::-1])[:, ::-1]
    np.testing.assert_allclose(amplitudes, [DOWN[f] for f in FREQUENCIES], rtol=5e-3)
    assert least[2] < 1.0
    # the mean falls from 1.100 to 0.998 while contact is lost
    assert mean[2] == pytest.approx(0.998, abs=2e-3)
    assert mean[0] == pytest.approx(1.100, abs=1e-3)
