"""Loads once a turn in a time run stand at the angle and grow with the speed that the shaft has, not the command."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import LoadOrder, PeriodicLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.command import Command, MotorDrive, Sampling
from dynamics.vibration.march_inputs import FollowingLoads, TurningLoads
from dynamics.vibration.time_response import TimeResponse, run_schedule
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, chain, wavy_law

Array = NDArray[np.float64]
ROW = np.array([-1.0, 0.4, 0.6, 0.0, 0.0, 0.0])
"""Twists the first line and moves no momentum."""
ORDER, AMPLITUDE, PHASE = 8.0, 1e-6, 0.6
END, MOTOR = 800.0, 12.0
"""Speed [rad/s] that the command asks for after 0.1 s, and the torque [N m] that takes it there in 0.5 s."""
LAW = wavy_law(0.0, damping=2e3)


def system() -> LinearSystem:
    part = LoadOrder(order=ORDER, amplitude=AMPLITUDE, phase=PHASE, speed_power=2)
    load = PeriodicLoad(name="unbalance", load=ROW, dof=2, parts=(part,))
    return replace(chain(3, joint=(3e4, 1.0), bearing=0.0), periodic_loads=(load,))


def response(system: LinearSystem, law: MeshLaw, speed: float) -> complex:
    """Torque of the mesh per cos(order angle) at a steady speed [N m]."""
    across = np.zeros(6)
    across[system.mesh_ports[0]] = BASE_RADIUS_1, -BASE_RADIUS_2
    omega = ORDER * speed
    tooth = 1.1e8 + 2e3j * omega
    dynamic = system.stiffness - omega**2 * system.inertia + 1j * omega * system.damping
    motion = np.linalg.solve(dynamic + tooth * np.outer(across, across), ROW * np.exp(-1j * PHASE))
    return complex(BASE_RADIUS_1 * tooth * AMPLITUDE * speed**2 * (across @ motion))


@pytest.fixture(scope="module")
def run() -> TimeResponse:
    command = Command(time=np.array([0.0, 0.1, 0.7]), speed=np.array([0.0, END, END]), twist=np.full(3, 3.0))
    sampling = Sampling(sample_rate=40e3, substeps=4, cutoff=20e3, keep_accounts=False)
    return run_schedule(system(), (LAW,), command, MotorDrive(torque_limit=MOTOR), sampling=sampling)


def waves(run: TimeResponse, speed: float, turns: float = 1.0) -> complex:
    """Component of the mesh torque at the order, over turns of the shaft about an instant at which it has a speed."""
    middle = int(np.argmax(run.speed > speed))
    own = np.abs(run.angle - run.angle[middle]) <= np.pi * turns
    angle, torque = run.angle[own], run.torque[0, own]
    columns = np.column_stack(
        [np.cos(ORDER * angle), np.sin(ORDER * angle), np.ones_like(angle), angle - angle.mean()]
    )
    cosine, sine, *_ = np.linalg.lstsq(columns, torque, rcond=None)[0]
    return complex(cosine, -sine)


def test_resonance_of_an_unbalance_stands_at_the_speed_of_the_rig(run: TimeResponse) -> None:
    """The command is at its end speed five times as soon as the rig; each order passes its mode where the rig is."""
    own = system()
    assert np.interp(0.2, run.time, run.speed) < 0.5 * np.interp(0.2, run.time, run.speed_command)
    speeds = np.arange(450.0, 760.0, 10.0)
    steady = np.array([abs(response(own, LAW, speed)) for speed in speeds])
    found = np.array([abs(waves(run, speed)) for speed in speeds])
    assert 500.0 < speeds[np.argmax(steady)] < 700.0
    # passed at 1560 rad/s2, the peak is a little lower and later than at rest in speed
    assert speeds[np.argmax(found)] == pytest.approx(speeds[np.argmax(steady)], rel=0.03)
    assert found.max() == pytest.approx(steady.max(), rel=0.08)


@pytest.mark.parametrize("speed", [210.0, 310.0, 410.0, 510.0, 710.0])
def test_phase_of_an_unbalance_follows_the_angle_of_its_shaft(run: TimeResponse, speed: float) -> None:
    """Its wave is that of the steady state at this speed, in size and in phase at the angle that the shaft has."""
    expected = response(system(), LAW, speed)
    assert abs(waves(run, speed) / expected - 1.0) < 0.04


def test_loads_of_an_even_acceleration_are_exact_from_the_second_stretch_on_and_never_jump() -> None:
    """The first knows the speed only; what its angle misses is made up over the second."""
    own = system()
    loads = TurningLoads(own)
    one = own.rigid[:, 0]
    times, rise = 1e-3 * np.arange(1, 51), 400.0
    following = FollowingLoads(loads, np.full(6, 0.3))
    last = None
    for stretch in range(4):
        start = stretch * times[-1]
        values = following.ahead(0.3 + one * 0.5 * rise * start**2, one * rise * start, times)
        angle, speed = 0.5 * rise * (start + times) ** 2, rise * (start + times)
        exact = own.periodic_loads[0].at(angle, speed)[:, None]
        size = AMPLITUDE * speed[-1] ** 2
        if stretch > 1:
            assert np.abs(values - exact).max() < 1e-9 * size
            assert last is not None
            assert abs(values[0] - last) <= 2.0 * np.abs(np.diff(exact[:, 0])).max()
        last = values[-1]
