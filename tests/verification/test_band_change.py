"""Speed bands with the state carried, against a direct integration of matrices that change all the time.

A pinion on a film with skew stiffness, a wheel that a spring holds to a disc, one mesh: five freedoms. The film
stiffens by half over a run-up that the march passes in bands. Direct: the absolute motion under M q'' + C q' + K(speed)
q = mesh torques + loads, by DOP853 with the contact tables that the march has.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_table
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import (
    FADE,
    DriveLoads,
    DriveState,
    MarchSettings,
    march_model,
    static_position,
)
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, wavy_law
from tests.builders.rig import prototype_laws
from tests.unit.dynamics_package.rotor.test_seen_system import SPEED, films, seen

TORQUE = 180.0
BRAKE = TORQUE * BASE_RADIUS_2 / BASE_RADIUS_1
ALPHA = np.radians(20.0)
NORMAL = np.array([np.cos(ALPHA), np.sin(ALPHA)])
FIRST, LAST = 200.0, 400.0
"""Speeds of the pinion [rad/s]."""
RATE = 600.0
"""[rad/s2]"""
ACCELERATING = 5.1e-4 * RATE + (1.1e-3 + 4e-3) * RATE * (BASE_RADIUS_1 / BASE_RADIUS_2) ** 2
"""Torque on the pinion that speeds the rig up [N m]."""


def system(speed: float) -> LinearSystem:
    """Freedoms: pinion port (turn and motion along the flank normal), pinion y, z, wheel, disc."""
    stiff = 1.0 + 0.5 * (speed - FIRST) / (LAST - FIRST)
    # over turn, y, z, wheel, disc
    mass = np.diag([5.1e-4, 2.0, 2.0, 1.1e-3, 4e-3])
    spring, damper = np.zeros((5, 5)), np.zeros((5, 5))
    spring[1:3, 1:3] = stiff * np.array([[1.2e8, 0.4e8], [-0.6e8, 1.5e8]])
    damper[1:3, 1:3] = np.array([[3e4, 0.0], [0.0, 4e4]])
    spring[3:, 3:] = 4e4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    damper[3:, 3:] = 0.3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    # turn = port - normal . u / r
    back = np.eye(5)
    back[0, 1:3] = -NORMAL / BASE_RADIUS_1
    rigid = np.zeros((5, 2))
    rigid[0, 0] = 1.0
    rigid[3:, 1] = 1.0
    motor, brake = np.eye(5)[0] @ back, -np.eye(5)[4] @ back
    return LinearSystem(
        inertia=back.T @ mass @ back,
        damping=back.T @ damper @ back,
        stiffness=back.T @ spring @ back,
        dofs=("port", "y", "z", "wheel", "disc"),
        mesh_ports=np.array([[0, 3]]),
        rigid=rigid,
        drive_dof=0,
        twist_load=brake,
        drag_loads={"motor": motor},
    )


def drive(rig: LinearSystem) -> np.ndarray:
    """Load of the motor: on the port's freedom, which is the turn's with the pinion where it is."""
    load = np.zeros(5)
    load[rig.drive_dof] = 1.0
    return load


def law() -> MeshLaw:
    return wavy_law(damping=2e3, backlash=1.0)


def start(rig: LinearSystem) -> DriveState:
    """Wound up by the loads of the run-up."""
    force = TORQUE / BASE_RADIUS_1
    load = np.array([-TORQUE, 0.0, 0.0, BASE_RADIUS_2 * force, 0.0])
    load += (TORQUE + ACCELERATING) * drive(rig) + BRAKE * rig.twist_load
    angles = static_position(rig, load)
    approach = BASE_RADIUS_1 * angles[0] - BASE_RADIUS_2 * angles[3]
    angles[3:] += (approach - force / 1.1e8) / BASE_RADIUS_2
    ratio = BASE_RADIUS_1 / BASE_RADIUS_2
    return DriveState(angles=angles, speeds=FIRST * np.array([1.0, 0.0, 0.0, ratio, ratio]), twist=BRAKE)


STEP = 1.0 / 320e3


def marched(bands: int, samples: int, carry: bool) -> np.ndarray:
    """Mesh force at the end of every sample of eight steps."""
    limits = np.linspace(FIRST, LAST, bands + 1)
    systems = [system(0.5 * (low + high)) for low, high in pairwise(limits)]
    laws = [law()]
    march = TimeMarch(
        systems[0], laws, start(systems[0]), MarchSettings(step=STEP, substeps=8),
        DriveLoads(drive_torque=TORQUE + ACCELERATING),
    )  # fmt: skip
    forces, now = [], 0
    block_samples = 400
    for _ in range(samples // block_samples):
        given = np.tile([TORQUE + ACCELERATING, BRAKE, 0.0, 0.0], (block_samples, 1))
        block = march.advance(given)
        forces.append(block.force[0, 7::8])
        band = min(int(np.searchsorted(limits[1:], block.slow_speed[-1, 0])), bands - 1)
        if band != now:
            now = band
            mean = block.force.mean(axis=1) if carry else None
            march = march.continued(systems[band], march_model(systems[band], laws), mean)
    return np.concatenate(forces)


def direct(samples: int) -> np.ndarray:
    """The same with the film of each instant's speed."""
    first = system(FIRST)
    begin = start(first)
    reference = TimeMarch(
        first, [law()], begin, MarchSettings(step=STEP, substeps=8), DriveLoads(drive_torque=TORQUE)
    )
    base, slope = first.stiffness, (system(LAST).stiffness - first.stiffness) / (LAST - FIRST)
    inverse = np.linalg.inv(first.inertia)
    load = (TORQUE + ACCELERATING) * drive(first) + BRAKE * first.twist_load

    def motion(t: float, y: np.ndarray) -> np.ndarray:
        stiffness = base + slope * RATE * t
        force = load - stiffness @ y[:5] - first.damping @ y[5:]
        x = BASE_RADIUS_1 * y[0] - BASE_RADIUS_2 * y[3]
        answer = evaluate_table(reference.tables, y[0], x, y[5], y[8])
        force[0] += answer.torque_1[0]
        force[3] += answer.torque_2[0]
        return np.concatenate((y[5:], inverse @ force))

    times = np.arange(1, samples + 1) * 8 * STEP
    found = solve_ivp(
        motion, (0.0, times[-1]), np.concatenate((begin.angles, begin.speeds)), "DOP853", times, rtol=1e-8, atol=1e-12,
        max_step=4 * STEP,
    )  # fmt: skip
    x = BASE_RADIUS_1 * found.y[0] - BASE_RADIUS_2 * found.y[3]
    return evaluate_table(reference.tables, found.y[0], x, found.y[5], found.y[8]).force_front


def envelope(force: np.ndarray, window: int = 200) -> np.ndarray:
    """Greatest force in windows of 5 ms."""
    return force[: len(force) // window * window].reshape(-1, window).max(axis=1)


def test_run_up_in_bands_is_that_of_matrices_that_change_all_the_time() -> None:
    samples = 8000
    exact = envelope(direct(samples))
    swing = exact.max() - TORQUE / BASE_RADIUS_1
    errors = {}
    for carry in (False, True):
        found = envelope(marched(6, samples, carry))
        errors[carry] = np.abs(found - exact) / swing
        print(carry, errors[carry].max(), np.sqrt(np.mean(errors[carry] ** 2)))
    finer = np.abs(envelope(marched(24, samples, True)) - exact) / swing
    print(finer.max(), np.sqrt(np.mean(finer**2)))
    # most of it is the path filter of the march, which the direct integration does not have
    assert errors[True].max() < 5e-3
    assert np.sqrt(np.mean(errors[True] ** 2)) < 2e-3
    assert errors[True].max() - finer.max() < 1e-3


def test_change_of_band_is_no_blow() -> None:
    """Under steady loads without tooth contact that varies: what a change leaves of vibration."""
    soft, stiff = system(FIRST), system(LAST)
    laws = [wavy_law(depth=0.0, damping=2e3, backlash=1.0)]
    settle = round(2.0 * FADE / 8 / STEP)
    left = {}
    for carry in (False, True):
        march = TimeMarch(
            soft, laws, start(soft), MarchSettings(step=STEP, substeps=8),
            DriveLoads(drive_torque=TORQUE + ACCELERATING),
        )  # fmt: skip
        given = np.tile([TORQUE + ACCELERATING, BRAKE, 0.0, 0.0], (settle, 1))
        before = march.advance(given).force
        march = march.continued(stiff, march_model(stiff, laws), before.mean(axis=1) if carry else None)
        after = march.advance(given).force
        left[carry] = np.abs(after - before[0, -1]).max() / before[0, -1]
        end = march.advance(given).force
        assert end[0, -1] == pytest.approx(before[0, -1], rel=1e-4)
    print(left)
    assert left[True] < 2e-3
    assert left[False] > 20.0 * left[True]


def test_braced_loop_passes_to_stiffer_films_without_a_step() -> None:
    """Twist held: the loop is stiffer afterwards, and its torque comes to that over FADE, not at once."""
    rigs = [seen().system(films(scale=scale)) for scale in (1.0, 1.15)]
    laws = prototype_laws()
    wound = wound_state(rigs[0], laws, SPEED, LoopLoad(torque=180.0))
    peaks = {}
    for carry in (False, True):
        march = TimeMarch(rigs[0], laws, wound.state, MarchSettings(step=STEP, substeps=8, cutoff=20e3))
        given = np.zeros((4000, 4))
        given[:, 1] = wound.state.twist
        for _ in range(4):
            before = march.advance(given).force
        model = march_model(rigs[1], laws, cutoff=20e3)
        march = march.continued(rigs[1], model, before.mean(axis=1) if carry else None)
        at_once = march.advance(given).force[0, :640]
        for _ in range(4):
            later = march.advance(given).force
        peaks[carry] = np.abs(at_once).max() / np.abs(before[0]).max(), later[0].mean() / before[0].mean()
    assert peaks[True][0] == pytest.approx(1.0, abs=2e-3)
    assert peaks[False][0] > 1.01
    assert peaks[True][1] == pytest.approx(peaks[False][1], rel=1e-3)
    assert peaks[True][1] > 1.005
