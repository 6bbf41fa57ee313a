"""The modal propagator against the matrix exponential, its rigid modes, its truncation and its refusals."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from numba import njit

from dynamics.kernels.integrator_state import STEP
from dynamics.kernels.mesh_solve import left_open
from dynamics.rotor.linear_system import LinearSystem
from dynamics.vibration.march_inputs import DriveLoads, DriveState, MarchSettings, drag_loads, slow_loads
from dynamics.vibration.modal_model import modal_model
from dynamics.vibration.propagator import discretise
from dynamics.vibration.time_integration import MarchDiverged, TimeMarch
from tests.builders.mesh import chain, spur_law, two_bodies

left_open_of = njit(lambda meshes: left_open(meshes[0]))
OPEN = spur_law(backlash=1.0, offset=-0.5)
"""A mesh whose flanks never touch: the linear part alone."""


def first_order_hold(
    system: LinearSystem, state: np.ndarray, torque: np.ndarray, step: float, steps: int
) -> np.ndarray:
    """(angles, speeds) after ``steps`` with a motor torque that is linear between ``torque[i]``: Van Loan."""
    n = len(system.inertia)
    matrix = np.zeros((2 * n + 2, 2 * n + 2))
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n] = -system.stiffness / np.diag(system.inertia)[:, None]
    matrix[n : 2 * n, n : 2 * n] = -system.damping / np.diag(system.inertia)[:, None]
    matrix[n + system.drive_dof, 2 * n] = 1.0 / system.inertia[system.drive_dof, system.drive_dof]
    matrix[2 * n, 2 * n + 1] = 1.0
    propagate = scipy.linalg.expm(matrix * step)
    for i in range(steps):
        y = propagate @ np.concatenate((state, [torque[i], (torque[i + 1] - torque[i]) / step]))
        state = y[: 2 * n]
    return state


@pytest.mark.parametrize("joint", [(1e6, 0.0), (1e6, 1e3), (1e6, 0.3)])
@pytest.mark.parametrize("bearing", [0.0, 7e-4])
@pytest.mark.parametrize("step", [3e-6, 2e-4])
def test_march_is_the_matrix_exponential(joint: tuple[float, float], bearing: float, step: float) -> None:
    # a spline of 1e3 N m s/rad has a real pole at 2e6 1/s and its slow one at 1e3 1/s
    system = chain(joint=joint, bearing=bearing)
    rng = np.random.default_rng(3)
    torque = rng.normal(size=41) * 10.0
    angles, speeds = rng.normal(size=12) * 1e-4, rng.normal(size=12)
    start = DriveState(angles=angles, speeds=speeds)
    march = TimeMarch(
        system,
        [OPEN],
        start,
        settings=MarchSettings(step=step, cutoff=np.inf),
        loads=DriveLoads(drive_torque=torque[0]),
    )
    given = np.zeros((40, 4))
    given[:, 0] = torque[1:]
    march.advance(given)
    exact = first_order_hold(system, np.concatenate((angles, speeds)), torque, step, 40)
    end = march.state()
    np.testing.assert_allclose(end.speeds, exact[12:], atol=1e-9 * np.abs(exact[12:]).max())
    np.testing.assert_allclose(end.angles, exact[:12], atol=1e-9 * np.abs(exact[:12]).max())


def test_one_long_step_is_many_short_ones() -> None:
    system = chain(bearing=7e-4)
    start = DriveState(angles=np.zeros(12), speeds=np.full(12, 50.0))
    ends = []
    for steps in (1, 1000):
        march = TimeMarch(
            system,
            [OPEN],
            start,
            settings=MarchSettings(step=1e-2 / steps, cutoff=np.inf),
            loads=DriveLoads(drive_torque=5.0),
        )
        given = np.zeros((steps, 4))
        given[:, 0] = 5.0
        march.advance(given)
        ends.append(march.state())
    np.testing.assert_allclose(ends[0].speeds, ends[1].speeds, rtol=1e-10)
    np.testing.assert_allclose(ends[0].angles, ends[1].angles, rtol=1e-10)


def test_substeps_carry_linear_inputs_exactly() -> None:
    system = chain(bearing=7e-4)
    start = DriveState(angles=np.zeros(12), speeds=np.zeros(12))
    ramp = np.linspace(0.0, 8.0, 11)[1:]
    ends = []
    for substeps in (1, 16):
        march = TimeMarch(
            system,
            [OPEN],
            start,
            settings=MarchSettings(step=1e-4 / substeps, substeps=substeps, cutoff=np.inf),
        )
        given = np.zeros((10, 4))
        given[:, 0] = ramp
        march.advance(given)
        ends.append(march.state().speeds)
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-10)


def test_lossless_system_keeps_its_energy() -> None:
    system = chain(joint=(1e6, 0.0))
    rng = np.random.default_rng(5)
    start = DriveState(angles=rng.normal(size=12) * 1e-4, speeds=100.0 + rng.normal(size=12))
    march = TimeMarch(system, [OPEN], start, settings=MarchSettings(step=3.1e-6, cutoff=np.inf))
    by_hand = (
        0.5 * start.speeds @ system.inertia @ start.speeds
        + 0.5 * start.angles @ system.stiffness @ start.angles
    )
    assert march.energy() == pytest.approx(by_hand, rel=1e-12)
    march.advance(np.zeros((20000, 4)))
    assert march.energy() == pytest.approx(by_hand, rel=1e-11)


def test_undamped_rigid_rotation_does_not_drift() -> None:
    system = chain(joint=(1e6, 0.0))
    speeds = np.repeat([1234.5, 1234.5 * 99 / 102], 6)
    march = TimeMarch(
        system, [OPEN], DriveState(angles=np.zeros(12), speeds=speeds), settings=MarchSettings(step=1e-5)
    )
    march.advance(np.zeros((50000, 4)))
    np.testing.assert_allclose(march.state().speeds, speeds, rtol=1e-12)
    np.testing.assert_allclose(march.state().angles, 0.5 * speeds, rtol=1e-11)


def test_truncation_keeps_the_static_effect_of_fast_modes() -> None:
    # a torque at the mesh port: the windup it ends at must hold the flexibility of the dropped modes
    system = replace(chain(joint=(2e5, 20.0), bearing=0.05), drive_dof=5)
    given = np.zeros((2000, 4))
    given[:, 0] = 1.0
    windups = []
    for cutoff in (np.inf, 3e3):
        start = DriveState(angles=np.zeros(12), speeds=np.zeros(12))
        far = OPEN._replace(backlash=1e6, offset=-5e5)
        march = TimeMarch(
            system,
            [far],
            start,
            settings=MarchSettings(step=1e-2, cutoff=cutoff),
            loads=DriveLoads(drive_torque=1.0),
        )
        march.advance(given)
        angles = march.state().angles
        windups.append(angles[5] - angles[0])
    assert march.model.dropped > 0
    # four springs of 2e5 and the spline, less what the inertia of the drag's acceleration takes away
    assert windups[1] == pytest.approx(windups[0], rel=1e-6)
    kept = march.model.scaled_through[:, 2:3]
    assert np.abs(kept).max() > 0.0


def test_state_goes_in_and_out_unchanged() -> None:
    system = chain(joint=(1e6, 2.0))
    rng = np.random.default_rng(11)
    start = DriveState(angles=rng.normal(size=12), speeds=rng.normal(size=12), twist=0.25)
    end = TimeMarch(system, [OPEN], start, settings=MarchSettings(step=1e-6, cutoff=np.inf)).state()
    np.testing.assert_allclose(end.angles, start.angles, atol=1e-12)
    np.testing.assert_allclose(end.speeds, start.speeds, atol=1e-12)
    assert end.twist == 0.25


def test_two_marches_are_equal_to_the_last_bit() -> None:
    forces = []
    for _ in range(2):
        start = DriveState(angles=np.array([1e-3, 0.0]), speeds=np.array([100.0, 97.0]))
        march = TimeMarch(
            two_bodies(), [spur_law(damping=500.0, friction=0.05)], start, settings=MarchSettings(step=3e-6)
        )
        forces.append(march.advance(np.zeros((500, 4))).force)
    assert np.array_equal(*forces)
    assert forces[0].max() > 0.0


def test_a_run_that_diverges_says_so() -> None:
    start = DriveState(angles=np.array([1e200, 0.0]), speeds=np.array([1e200, 0.0]))
    march = TimeMarch(two_bodies(), [spur_law()], start, settings=MarchSettings(step=1.0))
    with pytest.raises(MarchDiverged) as raised:
        march.advance(np.full((200, 4), 1e300))
    for words in (
        "left the finite numbers: mesh of",
        "s after its start",
        "rpm",
        "slowest elastic mode",
        "step 1 s",
    ):
        assert words in str(raised.value)


def test_refusals_name_the_fault() -> None:
    system, loads = chain(), slow_loads(chain())
    crossed = system.stiffness.copy()
    crossed[0, 6] = crossed[6, 0] = 1.0
    with pytest.raises(ValueError, match="free to rotate"):
        modal_model(replace(system, stiffness=crossed), [OPEN], loads)
    held = system.stiffness.copy()
    held[0, 0] += 1e5
    with pytest.raises(ValueError, match="free to rotate"):
        modal_model(replace(system, stiffness=held), [OPEN], loads)
    with pytest.raises(ValueError, match="torn"):
        modal_model(replace(system, stiffness=np.zeros((12, 12))), [OPEN], loads)
    with pytest.raises(ValueError, match="mesh laws"):
        modal_model(system, [OPEN, OPEN], loads)
    with pytest.raises(ValueError, match="inertia of line 0/0"):
        modal_model(replace(system, inertia=np.diag(np.where(np.arange(12) == 0, 0.0, 1.0))), [OPEN], loads)
    with pytest.raises(ValueError, match="step"):
        discretise(modal_model(system, [OPEN], loads), 0.0)
    with pytest.raises(ValueError, match="no drag load named windage"):
        drag_loads(system, ("windage",))


def test_critical_damping_is_still_accurate() -> None:
    # the only elastic mode of a line damped critically: a double real pole whose two vectors nearly coincide
    k, j = 1e4, 1e-2
    joint = np.array([[1.0, -1.0], [-1.0, 1.0]])
    damping = np.kron(np.eye(2), np.sqrt(2.0 * k * j) * joint)
    system = replace(
        chain(2), inertia=np.diag(np.full(4, j)), stiffness=np.kron(np.eye(2), k * joint), damping=damping
    )
    torque = np.linspace(0.0, 30.0, 21)
    march = TimeMarch(
        system,
        [OPEN],
        DriveState(angles=np.zeros(4), speeds=np.zeros(4)),
        settings=MarchSettings(step=1e-4, cutoff=np.inf),
    )
    given = np.zeros((20, 4))
    given[:, 0] = torque[1:]
    march.advance(given)
    exact = first_order_hold(system, np.zeros(8), torque, 1e-4, 20)
    np.testing.assert_allclose(march.state().speeds, exact[4:], atol=1e-6 * np.abs(exact[4:]).max())


@pytest.mark.parametrize(
    ("changes", "known"),
    [({}, True), ({"high": 30.001e-6}, False), ({"low": 30.002e-6}, False), ({"force": 0.1}, False)],
)
def test_a_step_of_a_mesh_is_off_its_tangent_by_what_bends(changes: dict[str, float], known: bool) -> None:
    """3 nm of the gears, of which the teeth take two thirds less what they were off: known within the rows looked up,
    and as long as the damper leaves a force."""
    meshes = np.zeros(1, STEP)
    for name, value in {
        "reach": 3e-9, "rate": -2e-4, "off": -0.5e-9, "share": 2.0 / 3.0, "teeth": 30e-6, "low": 29e-6, "high": 31e-6,
        "force": 100.0, "force_x": 1e9, "force_v": 1e4, "net": 100.0, "net_x": 1e9, "net_v": 1e4, "bent": 1e12,
        "bent_v": 5e4, **changes,
    }.items():  # fmt: skip
        meshes[name] = value
    moved = 1.5e-9
    left = left_open_of(meshes)
    (mesh,) = meshes
    assert left == (pytest.approx(1e12 * moved**2 + 5e4 * moved * 2e-4) if known else np.inf)
    assert mesh["teeth"] == pytest.approx(30e-6 + moved, rel=1e-12)
    assert mesh["given"] == pytest.approx(3e-9 - 30e-6 - moved, rel=1e-12)
    assert mesh["net"] == pytest.approx(100.0 + 1e9 * moved - 1e4 * 2e-4)


def test_a_kernel_without_a_wrapper_says_so_where_python_calls_it() -> None:
    with pytest.raises(TypeError, match="left_open has no wrapper for Python"):
        left_open(np.zeros(1, STEP)[0])
