"""The march against Exudyn's generalised-alpha method: both come to one limit as their steps become shorter.

Prototype with 62 torsional freedoms at 3000 rpm and 180 N m; both meshes have a stiffness that waves with the angle of
their pinion, 25 and 5 %, with all torques of one potential. Over 2.5 ms after the start, mesh forces at 40 kHz; rms of
the differences over the dynamic part of each mesh. Measured: halving 32 steps a sample changes ours by 8e-6 and 1.1e-5,
Exudyn by 2.0e-4 and 7.4e-4; the limits extrapolated by Richardson differ by 3.2e-6 and 1.0e-6.
"""

import itertools
from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import WoundLoop, wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.exudyn_march import Motion, WaveMesh, exudyn_march
from tests.performance.test_dynamics_speed import BACKLASH, DAMPING, DEPTHS, phase_laws, rig

Array = NDArray[np.float64]
pytestmark = pytest.mark.slow
SPEED, TORQUE = 3000.0 * np.pi / 30.0, 180.0
RATE, SAMPLES = 40e3, 100
SUBSTEPS = (16, 32, 64)


@cache
def wound() -> WoundLoop:
    return wound_state(rig(), phase_laws(), speed=SPEED, load=LoopLoad(torque=TORQUE))


@cache
def ours(substeps: int) -> Array:
    """Mesh forces (2, n) at the samples; all modes move."""
    start, drive, _ = wound()
    march = TimeMarch(
        rig(),
        phase_laws(),
        start,
        MarchSettings(step=1.0 / RATE / substeps, substeps=substeps, cutoff=1e12, accounts=False),
        DriveLoads(drive_torque=drive),
    )
    force = march.advance(np.tile([drive, start.twist, 0.0, 0.0], (SAMPLES, 1))).force
    assert march.unconverged == 0
    return force[:, substeps - 1 :: substeps]


@cache
def theirs(substeps: int) -> Array:
    """The same of Exudyn; the reference mesh runs on its back flanks."""
    system = rig()
    start, drive, _ = wound()
    load = system.twist_load * start.twist
    load[system.drive_dof] += drive
    rows = np.eye(len(load))
    meshes = [
        WaveMesh(
            approach=law.base_radius_1 * rows[pinion] - law.base_radius_2 * rows[wheel],
            angle=rows[pinion],
            stiffness=law.mean_stiffness,
            damping=DAMPING,
            depth=depth,
            teeth=law.teeth_1,
            play=play,
        )
        for (pinion, wheel), law, depth, play in zip(
            system.mesh_ports, phase_laws(), DEPTHS, (0.0, BACKLASH), strict=True
        )
    ]
    motion = Motion(
        mass=system.inertia,
        damping=system.damping,
        stiffness=system.stiffness,
        load=load,
        angles=start.angles,
        speeds=start.speeds,
    )
    return exudyn_march(motion, meshes, 1.0 / RATE / substeps, SAMPLES * substeps, substeps)[0]


def apart(one: Array, other: Array) -> Array:
    """Rms of the difference over the dynamic part, by mesh."""
    return np.asarray(np.sqrt(np.mean((one - other) ** 2, axis=1)) / np.std(ours(SUBSTEPS[-1]), axis=1))


def limit(forces: Callable[[int], Array]) -> Array:
    """Extrapolated from the last two steps, of second order."""
    coarse, fine = (forces(substeps) for substeps in SUBSTEPS[-2:])
    return fine + (fine - coarse) / 3.0


@pytest.mark.parametrize("forces", [ours, theirs])
def test_forces_converge_at_second_order(forces: Callable[[int], Array]) -> None:
    changes = [apart(forces(a), forces(b)) for a, b in itertools.pairwise(SUBSTEPS)]
    print(changes)
    assert changes[0] / changes[1] == pytest.approx([4.0, 4.0], rel=0.05)


def test_the_limits_of_both_codes_are_one() -> None:
    difference = apart(limit(ours), limit(theirs))
    print(difference)
    assert (difference < 1e-4).all()


def test_contact_is_never_lost_and_both_meshes_vibrate() -> None:
    """Else no order would be left to extrapolate with, or nothing to compare."""
    front, back = ours(SUBSTEPS[-1])
    assert front.min() > 0.0 > back.max()
    assert np.std(front) > 0.1 * front.mean() and np.std(back) > 0.1 * abs(back.mean())
