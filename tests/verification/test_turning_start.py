"""Start of a time run with loads that alternate with a shaft: no blow at t = 0, the same run later on."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.assembly import assemble_rig
from dynamics.rotor.bearing_state import RunningState
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.parts import LoadOrder, rotating_load
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.rotor_model import FlangeRunOut, ShaftBow
from dynamics.tooth.law import MeshLaw
from dynamics.vibration import time_response
from dynamics.vibration.command import Command, MotorDrive, Sampling
from dynamics.vibration.march_inputs import SpeedControl
from dynamics.vibration.time_response import TurningStart, run_schedule, turning_start
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, chain, wavy_law
from tests.builders.rig import prototype_laws

Array = NDArray[np.float64]
MOTOR = MotorDrive(torque_limit=50.0)
SAMPLING = Sampling(sample_rate=80e3, substeps=4, cutoff=20e3, keep_accounts=False)


def unbent(system: LinearSystem, laws: object, speed: float) -> TurningStart:
    """Without the loads, which then act from the first sample on."""
    n = len(system.inertia)
    return TurningStart(values=np.zeros(len(system.periodic_loads)), load=np.zeros(n), speeds=np.zeros(n))


def torques(
    system: LinearSystem, laws: tuple[MeshLaw, ...], command: Command, motor: MotorDrive = MOTOR
) -> Iterator[Array]:
    """Of all meshes (n_meshes, n): without the loads, with them from the start, with them from the first sample."""
    with pytest.MonkeyPatch.context() as patch:
        for own, start in (
            (replace(system, periodic_loads=()), turning_start),
            (system, turning_start),
            (system, unbent),
        ):
            patch.setattr(time_response, "turning_start", start)
            yield run_schedule(own, laws, command, motor, sampling=SAMPLING).torque


@pytest.fixture(scope="module")
def bent() -> LinearSystem:
    """Prototype with a bow of 10 um and a run-out of 10 um."""
    parts = (
        ShaftBow(shaft="test_pinion", supports=(0.06758, 0.30778), amplitude=10e-6, angle=-0.4),
        FlangeRunOut(coupling="pinion side", offset=10e-6),
    )
    rig = replace(prototype_rig(0.03), rotating=parts)
    model = assemble_rig(rig)
    seen = SeenRig(
        reduced=reduce_rig(model, bearings(rig), 20e3),
        ports={"test": mesh_ports(model, "test"), "reference": mesh_ports(model, "reference", "back")},
    )
    return seen.system(RunningState(speed=0.0, bearings=bearings(rig)))


@pytest.mark.parametrize("torque", [1.0, 180.0])
def test_bow_and_run_out_of_a_rig_at_rest_give_no_blow(bent: LinearSystem, torque: float) -> None:
    """They displace it statically, so that the meshes feel nothing, flanks that just touch included. Left: 2 % at most
    of what loads from the first sample on give, before the loop rolls out of the angle at which it was wound up, where
    its strain energy is highest."""
    command = Command(time=np.array([0.0, 0.02]), speed=np.zeros(2), torque=np.full(2, torque))
    bare, found, before = torques(bent, prototype_laws(), command)
    assert np.all(np.ptp(before - bare, axis=1) > 0.5)
    assert np.all(np.ptp(found - bare, axis=1) < 0.02 * np.ptp(before - bare, axis=1))


def test_run_is_the_same_once_the_blow_has_died_away(bent: LinearSystem) -> None:
    """The bracing control brings the mean back, half in 25 ms: a thousandth of the blow is left after 0.4 s."""
    command = Command(time=np.array([0.0, 0.4]), speed=np.zeros(2), torque=np.full(2, 20.0))
    _, found, before = torques(bent, prototype_laws(), command)
    apart = np.abs(found - before)
    assert apart[:, :400].max() > 0.5
    assert apart[:, -800:].max() < 1e-3 * apart[:, :400].max()


def test_run_that_starts_at_a_speed_starts_in_the_forced_motion() -> None:
    """Mesh of constant stiffness, a load once a turn that moves no momentum: the torque is the wave of the linear
    solution from the first sample on."""
    speed = 300.0
    row = np.array([-1.0, 0.4, 0.6, 0.0, 0.0, 0.0])
    part = LoadOrder(order=1.0, amplitude=20.0, phase=0.6)
    system = replace(
        chain(3, joint=(1e6, 20.0), bearing=0.05),
        periodic_loads=rotating_load("bow", row + 0.5j * row, 2, part),
    )
    law = wavy_law(0.0, damping=2e3)
    command = Command(time=np.array([0.0, 0.1]), speed=np.full(2, speed), twist=np.full(2, 180.0))
    # torque of the start against the brake of 180 N m; a controller would answer to the wave
    still = SpeedControl(proportional=1e-6, integral=0.0, torque_limit=250.0, time_constant=0.1)
    bare, found, before = torques(
        system, (law,), command, MotorDrive(torque_limit=250.0, speed_control=still)
    )
    across = np.zeros(6)
    across[system.mesh_ports[0]] = BASE_RADIUS_1, -BASE_RADIUS_2
    tooth = 1.1e8 + 2e3j * speed
    dynamic = system.stiffness - speed**2 * system.inertia + 1j * speed * system.damping
    dynamic = dynamic + tooth * np.outer(across, across)
    approach = across @ np.linalg.solve(dynamic, 20.0 * np.exp(-0.6j) * (row + 0.5j * row))
    time = np.arange(1, bare.shape[1] + 1) / SAMPLING.sample_rate
    wave = BASE_RADIUS_1 * (tooth * approach * np.exp(1j * speed * time)).real
    transient = np.abs(found[0] - bare[0] - wave).max()
    assert transient < 0.02 * np.abs(before[0] - bare[0] - wave).max()
    assert transient < 0.02 * np.abs(wave).max()
