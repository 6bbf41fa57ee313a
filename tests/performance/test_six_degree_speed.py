"""Seconds per simulated second of shafts that bend: 550 freedoms, two lumped meshes, ours and Exudyn in one table.

The prototype in six degrees of freedom with films, shaft elements of 17.6 mm; meshes whose stiffness waves with the
angle of the pinion. Ours in modes up to a frequency with static shapes of the ports above, Exudyn's generalised-alpha
method on the full matrices. Errors are the rms of the mesh force over its dynamic part, the larger of both meshes,
against 64 steps a sample: of the same modes (step), of the rig with all its modes (step and modes), for Exudyn against
its own 64 steps. Its mesh forces are a user function in Python. Times are processor times of one thread.
Run with ``pytest -m performance -s tests/performance/test_six_degree_speed.py``.
"""

from functools import cache
from time import process_time

import numpy as np
import pytest
from numpy.typing import NDArray

from dynamics.rotor.assembly import ElasticModel, assemble_rig
from dynamics.rotor.bearing_state import BearingCoefficients, RunningState
from dynamics.rotor.craig_bampton import SeenRig, mesh_ports
from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.reduction import reduce_rig
from dynamics.rotor.static_loop import LoopLoad
from dynamics.vibration.initial_state import WoundLoop, wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings, march_model
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.elastic_rig import bearings, prototype_rig
from tests.builders.exudyn_march import ExudynSolver, Motion, WaveMesh, exudyn_march
from tests.builders.full_matrices import full_matrices
from tests.performance.test_dynamics_speed import BACKLASH, DAMPING, DEPTHS, SAMPLE_RATE, TORQUE, phase_laws
from tests.unit.dynamics_package.rotor.test_seen_system import FILM

pytestmark = pytest.mark.performance
Array = NDArray[np.float64]
RPM = np.pi / 30.0
ELEMENT = 0.0176
SPEEDS = (3000.0, 12000.0)
CUTOFFS = (12.5e3, 25e3, 50e3)
SAMPLES, TIMED = 400, 8000
LOOSE = ExudynSolver(sparse=True, tolerance=1e-6)


@cache
def model() -> ElasticModel:
    return assemble_rig(prototype_rig(ELEMENT))


@cache
def seen(cutoff: float | None) -> SeenRig:
    rig = model().rig
    return SeenRig(
        reduced=reduce_rig(model(), bearings(rig), cutoff),
        ports={mesh.name: mesh_ports(model(), mesh.name) for mesh in rig.drivetrain.meshes},
    )


def state(rpm: float) -> RunningState:
    films: dict[str, BearingCoefficients] = dict.fromkeys(model().ports, FILM)
    return RunningState(speed=rpm * RPM, bearings=films)


@cache
def system(rpm: float, cutoff: float | None) -> LinearSystem:
    return seen(cutoff).system(state(rpm))


@cache
def wound(rpm: float, cutoff: float | None) -> WoundLoop:
    return wound_state(system(rpm, cutoff), phase_laws(), speed=rpm * RPM, load=LoopLoad(torque=TORQUE))


def march(rpm: float, cutoff: float | None, substeps: int, samples: int) -> tuple[Array, float, int]:
    """Mesh forces (2, samples) from the second sample on, seconds per simulated second, modes."""
    start, drive, _ = wound(rpm, cutoff)
    modes = march_model(system(rpm, cutoff), phase_laws(), cutoff=cutoff or 1e12)
    one = TimeMarch(
        system(rpm, cutoff),
        phase_laws(),
        start,
        MarchSettings(step=1.0 / SAMPLE_RATE / substeps, substeps=substeps, accounts=False, record_all=False),
        DriveLoads(drive_torque=drive),
        modes,
    )
    given = np.tile([drive, start.twist, 0.0, 0.0], (samples, 1))
    one.advance(given[:1])
    before = process_time()
    block = one.advance(given)
    spent = process_time() - before
    assert one.unconverged == 0
    return block.force[:, substeps - 1 :: substeps], spent * SAMPLE_RATE / samples, len(modes.eigenvalues)


def off(force: Array, exact: Array) -> float:
    n = min(force.shape[1], exact.shape[1])
    late = slice(n // 4, n)
    apart = [np.sqrt(np.mean((a[late] - b[late]) ** 2)) / np.std(b[late]) for a, b in zip(force, exact)]
    return float(max(apart))


@pytest.mark.parametrize("rpm", SPEEDS)
def test_ours(rpm: float) -> None:
    whole = march(rpm, None, 64, SAMPLES)[0]
    print(f"\n{model().size} freedoms, {rpm:.0f} rpm")
    for cutoff in CUTOFFS:
        exact = march(rpm, cutoff, 64, SAMPLES)[0]
        for substeps in (4, 8, 16):
            force = march(rpm, cutoff, substeps, SAMPLES)[0]
            seconds, modes = min(march(rpm, cutoff, substeps, TIMED)[1:] for _ in range(3))
            print(
                f"  {modes} modes to {1e-3 * cutoff:.1f} kHz, {substeps:2d} steps a sample: {seconds:.3f} s per "
                f"simulated second ({1e9 * seconds / SAMPLE_RATE / substeps:.0f} ns a step), error of the step "
                f"{off(force, exact):.1e}, with the modes {off(force, whole):.1e}"
            )


@pytest.mark.parametrize("rpm", SPEEDS)
def test_exudyn_on_the_full_matrices(rpm: float) -> None:
    """A short stretch, from the same wound state in all freedoms."""
    pytest.importorskip("exudyn")
    samples = 20
    at, reduced, (start, drive, _) = full_matrices(model(), state(rpm)), seen(None).reduced, wound(rpm, None)
    inner = np.linalg.inv(system(rpm, None).coordinates.freedoms)
    load = drive * model().row("motor", "turn")
    load += start.twist * model().joint("pinion side", "coupling").load("turn")
    meshes = []
    for mesh, law, depth, play in zip(model().rig.drivetrain.meshes, phase_laws(), DEPTHS, (0.0, BACKLASH)):
        pinion, wheel = mesh_ports(model(), mesh.name)
        approach = law.base_radius_1 * pinion - law.base_radius_2 * wheel
        meshes.append(
            WaveMesh(
                approach=approach,
                angle=pinion,
                stiffness=law.mean_stiffness,
                damping=DAMPING,
                depth=depth,
                teeth=law.teeth_1,
                play=play,
            )
        )
    motion = Motion(
        mass=at.mass.toarray(),
        damping=at.damping.toarray(),
        stiffness=at.stiffness.toarray(),
        load=load,
        angles=reduced.basis @ inner @ start.angles,
        speeds=reduced.basis @ inner @ start.speeds,
    )
    found = {
        n: exudyn_march(motion, meshes, 1.0 / SAMPLE_RATE / n, samples * n, n, LOOSE) for n in (8, 16, 64)
    }
    ours = march(rpm, None, 64, samples - 1)[0]
    print(f"\nExudyn, {model().size} freedoms, {rpm:.0f} rpm")
    for n in (8, 16):
        force, spent = found[n]
        print(
            f"  {n:2d} steps a sample: {spent * SAMPLE_RATE / samples:.0f} s per simulated second "
            f"({1e6 * spent / samples / n:.0f} us a step), error {off(force, found[64][0]):.1e}"
        )
    print(f"  64 steps against ours of all modes, 64 steps: {off(found[64][0][:, 1:], ours):.1e}")
