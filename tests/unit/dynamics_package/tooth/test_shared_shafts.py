"""Meshes that share a shaft or a gear: the march against a general integrator with the same mesh forces."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dynamics.kernels.contact_table import ContactTables
from dynamics.rotor.linear_system import LinearSystem, line_shapes
from dynamics.tooth.mesh_force import evaluate_table
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import BASE_RADIUS_1, BASE_RADIUS_2, ramped_law

pytestmark = pytest.mark.whole_run


def star(ports: list[tuple[int, int]], shaft: int) -> LinearSystem:
    """A shaft of ``shaft`` discs on springs that meshes with free discs, one line each."""
    n = 1 + max(max(pair) for pair in ports)
    stiffness = np.zeros((n, n))
    for a in range(shaft - 1):
        stiffness[np.ix_([a, a + 1], [a, a + 1])] += 4e4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    brake = np.zeros(n)
    brake[-1] = -1.0
    return LinearSystem(
        inertia=np.diag(np.linspace(5e-4, 9e-4, n)),
        damping=2e-6 * stiffness,
        stiffness=stiffness,
        dofs=tuple(f"disc {i}" for i in range(n)),
        mesh_ports=np.array(ports),
        rigid=line_shapes(np.array([max(0, i - shaft + 1) for i in range(n)])),
        drive_dof=0,
        twist_load=brake,
        drag_loads={},
    )


@pytest.mark.parametrize(
    ("ports", "shaft"),
    [([(0, 1), (0, 2)], 1), ([(0, 2), (1, 3), (1, 4)], 2)],
    ids=["idler", "three on a shaft"],
)
def test_march_with_shared_bodies(ports: list[tuple[int, int]], shaft: int) -> None:
    system = star(ports, shaft)
    n = len(system.inertia)
    laws = [ramped_law(damping=800.0, friction=0.03, phase=0.4e-3 * m) for m in range(len(ports))]
    torque, brake = 30.0, 10.0

    def motion(_: float, y: np.ndarray, tables: ContactTables) -> np.ndarray:
        angles, speeds = y[:n], y[n:]
        load = -system.stiffness @ angles - system.damping @ speeds + brake * system.twist_load
        load[0] += torque
        for mesh, (a, b) in enumerate(ports):
            x = BASE_RADIUS_1 * angles[a] - BASE_RADIUS_2 * angles[b]
            reaction = evaluate_table(tables, angles[a], x, speeds[a], speeds[b], mesh=mesh)
            load[a] += reaction.torque_1[0]
            load[b] += reaction.torque_2[0]
        return np.concatenate((speeds, load / np.diag(system.inertia)))

    angles = np.zeros(n)
    angles[shaft:] = -4e-6 / BASE_RADIUS_2  # all flanks pressed by 4 um
    speeds = np.where(np.arange(n) < shaft, 300.0, 300.0 * BASE_RADIUS_1 / BASE_RADIUS_2)
    start = DriveState(angles=angles, speeds=speeds, twist=brake)
    end = 0.6e-3
    errors = []
    for steps in (20, 40, 150):
        march = TimeMarch(
            system,
            laws,
            start,
            settings=MarchSettings(step=end / steps, cutoff=np.inf),
            loads=DriveLoads(drive_torque=torque),
        )
        march.advance(np.tile([torque, brake, 0.0, 0.0], (steps, 1)))
        assert march.unconverged == 0
        # longer steps resolve less of the path: each is held against the tables that it has
        exact = solve_ivp(
            motion, (0.0, end), np.concatenate((angles, speeds)), "DOP853", args=(march.tables,), rtol=1e-9, atol=1e-12
        )  # fmt: skip
        errors.append(
            np.abs(march.state().speeds - exact.y[n:, -1]).max() / np.ptp(exact.y[n:], axis=1).max()
        )
    assert errors[2] < 5e-4
    assert errors[1] < 0.3 * errors[0]  # second order: 0.25
    assert errors[2] < 0.02 * errors[0]  # second order: 0.018
