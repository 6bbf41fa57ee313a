"""Seconds per simulated second of the march at a stated error, shafts that twist and shafts that bend.

The error is the rms of the mesh force against a march with 64 steps a sample, over its dynamic part, the larger of both
meshes. What the contact tables have of the law themselves is printed beside: rms against the sums over the slices at
the mean load, over the mean force. Times are processor times of one thread, the best of some runs.
Run with ``pytest -m performance -s tests/performance/test_march_speed.py``.
"""

from time import process_time

import numpy as np
import pytest

from dynamics.rotor.linear_system import LinearSystem
from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.contact_table import contact_tables
from dynamics.tooth.law import MeshLaw
from dynamics.tooth.mesh_force import evaluate_mesh, evaluate_table
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings, march_model
from dynamics.vibration.time_integration import TimeMarch
from tests.performance.test_dynamics_speed import SAMPLE_RATE, TORQUE, phase_laws, rig, shipped_laws
from tests.unit.dynamics_package.rotor.test_seen_system import films, seen

pytestmark = pytest.mark.performance

RPM = np.pi / 30.0


def march_at(
    system: LinearSystem, laws: list[MeshLaw], rpm: float, substeps: int, samples: int
) -> tuple[np.ndarray, float]:
    """Mesh forces (2, samples) and processor seconds per simulated second."""
    wound = wound_state(system, laws, speed=rpm * RPM, load=LoopLoad(torque=TORQUE))
    model, best = march_model(system, laws), np.inf
    for _ in range(3):
        march = TimeMarch(
            system, laws, wound.state,
            MarchSettings(step=1.0 / SAMPLE_RATE / substeps, substeps=substeps, accounts=False, record_all=False),
            DriveLoads(drive_torque=wound.drive_torque), model,
        )  # fmt: skip
        given = np.tile([wound.drive_torque, wound.state.twist, 0.0, 0.0], (samples, 1))
        march.advance(given[:20])
        before = process_time()
        block = march.advance(given)
        best = min(best, process_time() - before)
        assert march.unconverged == 0
    return block.force[:, substeps - 1 :: substeps], best * SAMPLE_RATE / samples


def table_error(laws: list[MeshLaw]) -> float:
    worst = 0.0
    for law in laws:
        theta = np.linspace(0.0, 20.0 * np.pi / law.teeth_1, 4001)
        x = TORQUE / law.base_radius_1 / law.mean_stiffness
        exact = evaluate_mesh(law, theta, x, 0.0, 0.0).force_front
        found = evaluate_table(contact_tables([law]), theta, x).force_front
        worst = max(worst, float(np.sqrt(np.mean((found - exact) ** 2)) / exact.mean()))
    return worst


@pytest.mark.parametrize("name", ["62 torsional freedoms, shipped law", "shafts that bend, lumped meshes"])
def test_seconds_per_simulated_second(name: str) -> None:
    bends = name.startswith("shafts")
    laws = phase_laws() if bends else shipped_laws()
    system = seen(50e3).system(films()) if bends else rig()
    modes = len(march_model(system, laws).eigenvalues)
    freedoms = seen(50e3).reduced.model.mass.shape[0] if bends else len(system.inertia)
    print(
        f"\n{name}: {freedoms} freedoms, {modes} modes, tables off the law by {table_error(laws):.1e} of the mean"
    )
    for rpm in (3000.0, 12000.0):
        exact, _ = march_at(system, laws, rpm, 64, 400)
        for substeps in (4, 8, 16):
            force, _ = march_at(system, laws, rpm, substeps, 400)
            _, seconds = march_at(system, laws, rpm, substeps, 8000)
            late = slice(100, None)
            off = [np.sqrt(np.mean((a[late] - b[late]) ** 2)) / np.std(b[late]) for a, b in zip(force, exact)]
            print(
                f"  {rpm:6.0f} rpm, {substeps:2d} steps a sample: {seconds:.3f} s per simulated second "
                f"({1e9 * seconds / SAMPLE_RATE / substeps:.0f} ns a step), error {max(off):.1e}"
            )
