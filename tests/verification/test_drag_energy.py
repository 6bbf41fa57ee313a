"""A drag torque takes from a vibration what its law says, at any sample rate, at standstill and turning.

A line of two discs on a spring with a mode of 10.34 kHz, free of damping, braked at one disc; the mesh is open. The
closed forms: a drag linear in speed is a damper (matrix exponential); one that does not depend on speed leaves a mode
of a turning shaft alone; about standstill it is Coulomb friction, which takes 4 T per cycle and amplitude of angle.
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from dynamics.rotor.linear_system import LinearSystem, line_shapes
from dynamics.vibration.march_inputs import DragTables, DriveLoads, DriveState, MarchSettings, march_model
from dynamics.vibration.time_integration import TimeMarch
from tests.builders.mesh import spur_law

OPEN = spur_law(backlash=1e9, offset=-5e8)
INERTIA = np.array([4e-4, 6e-4, 1e-3])
REDUCED = INERTIA[0] * INERTIA[1] / (INERTIA[0] + INERTIA[1])
OMEGA = 2.0 * np.pi * 10.34e3
SPEED = 235.6
"""2250 rpm."""
TOP = 400.0
RATES = (11e3, 20e3, 20.68e3, 30e3, 40e3)
STEPS = 100_000


def system(damper: float = 0.0) -> LinearSystem:
    spring = REDUCED * OMEGA**2 * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    return LinearSystem(
        inertia=np.diag(INERTIA),
        damping=np.diag([damper, 0.0, 0.0]),
        stiffness=spring,
        dofs=("shaft/gear", "shaft/disc", "wheel"),
        mesh_ports=np.array([[0, 2]]),
        rigid=line_shapes(np.array([0, 0, 1])),
        drive_dof=1,
        twist_load=np.array([0.0, 0.0, -1.0]),
        drag_loads={"bearing": np.array([-1.0, 0.0, 0.0])},
    )


def start(speed: float, vibration: float) -> DriveState:
    """Turning at ``speed``, the braked disc swinging by ``vibration`` [rad/s] in the elastic mode."""
    swing = vibration * np.array([1.0, -INERTIA[0] / INERTIA[1], 0.0])
    return DriveState(angles=np.zeros(3), speeds=np.array([speed, speed, 0.0]) + swing)


def marched(
    begin: DriveState, torque: np.ndarray, rate: float, steps: int, substeps: int = 8
) -> tuple[TimeMarch, np.ndarray]:
    """The march at its end, and the vibration of the braked disc [rad/s] (amplitude) over time."""
    now = float(np.interp(begin.speeds[0], np.linspace(0.0, TOP, len(torque)), torque))
    march = TimeMarch(
        system(),
        [OPEN],
        begin,
        settings=MarchSettings(step=1.0 / rate / substeps, substeps=substeps),
        loads=DriveLoads(drag_torques={"bearing": now * np.sign(begin.speeds[0])}),
    )
    vibration = []
    for _ in range(20):
        march.advance(
            np.zeros((steps // substeps // 20, 4)),
            drags=DragTables(torque=torque[None], last_speed=np.array([TOP])),
        )
        state = march.state()
        twist, rate_of_twist = np.diff(state.angles[:2])[0], np.diff(state.speeds[:2])[0]
        relative = np.hypot(OMEGA * twist, rate_of_twist)
        vibration.append(relative * INERTIA[1] / (INERTIA[0] + INERTIA[1]))
    return march, np.array(vibration)


@pytest.mark.parametrize("rate", RATES)
def test_constant_drag_leaves_the_mode_of_a_turning_shaft_alone(rate: float) -> None:
    march, vibration = marched(start(SPEED, 5.0), np.full(513, 1e-3), rate, STEPS)
    assert vibration == pytest.approx(5.0, rel=1e-3)
    assert march.unconverged == 0


@pytest.mark.parametrize("rate", RATES)
def test_drag_linear_in_speed_is_a_damper(rate: float) -> None:
    damper = 5e-3
    steps = 8000
    march, vibration = marched(start(SPEED, 5.0), damper * np.linspace(0.0, TOP, 513), rate, steps)
    matrix = np.zeros((6, 6))
    matrix[:3, 3:] = np.eye(3)
    matrix[3:, :3] = -system().stiffness / INERTIA[:, None]
    matrix[3:, 3:] = -system(damper).damping / INERTIA[:, None]
    begin = start(SPEED, 5.0)
    end = scipy.linalg.expm(matrix * steps / rate / 8) @ np.concatenate((begin.angles, begin.speeds))
    decay = np.hypot(OMEGA * np.diff(end[:2])[0], np.diff(end[3:5])[0]) * 0.6
    # linear between the steps, a sinusoid is seen sinc^2(f h) as large as it is
    seen = np.sinc(10.34e3 / rate / 8) ** 2
    lost, asked = np.log(5.0 / vibration[-1]), np.log(5.0 / decay)
    assert lost == pytest.approx(seen * asked, rel=0.02)
    assert march.state().speeds[:2].mean() == pytest.approx(end[3:5].mean(), rel=2e-3)


@pytest.mark.parametrize("rate", RATES)
def test_friction_about_standstill_brings_the_mode_to_rest(rate: float) -> None:
    """Coulomb friction T on the braked disc: v falls by 2 T / (pi J_mode) per second."""
    torque, swing = 2e-3, 5.0
    modal = INERTIA[0] * (1.0 + INERTIA[0] / INERTIA[1])
    rest = np.pi * swing * modal / (2.0 * torque)
    steps = 20 * 8 * max(1, int(0.5 * rest * rate / 20))
    _, vibration = marched(start(0.0, swing), np.full(513, torque), rate, steps)
    assert np.all(np.diff(vibration) < 0.0)
    assert vibration[-1] == pytest.approx(swing * (1.0 - steps / rate / 8 / rest), rel=0.06)


@pytest.mark.parametrize("rate", RATES)
def test_nothing_moves_a_rig_at_rest(rate: float) -> None:
    march, vibration = marched(start(0.0, 1e-6), np.full(513, 1.0), rate, STEPS)
    assert np.all(vibration < 1e-6)
    assert np.abs(march.state().speeds).max() < 1e-6


def test_work_of_the_drag_is_what_the_rig_loses() -> None:
    march, _ = marched(start(SPEED, 5.0), np.linspace(1e-3, 0.2, 513), 20e3, 16000)
    begin = start(SPEED, 5.0)
    kinetic = 0.5 * INERTIA @ begin.speeds**2
    assert march.accounts().drag[0] == pytest.approx(kinetic - march.energy(), rel=1e-4)


def test_modes_far_above_the_damping_of_a_drag_give_way_to_it_statically() -> None:
    """A damped line with a brake: the march without drag in its fast mode is the march with it, shaft and teeth alike.

    The mode takes 2e-3 of its damping from the drag at most, so that 1e-3 of the vibration is left to differ at the
    end of its first time constant; the twist under the drag is all there.
    """
    damper = 5e-3
    line = replace(system(), damping=np.array([[0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.0, 0.0, 0.0]]) * 4.0)
    table = damper * np.linspace(0.0, TOP, 513)
    torque = damper * SPEED
    ends = {}
    for rise in (None, {"bearing": damper}):
        model = march_model(line, [OPEN], ("bearing",), drag_damping=rise)
        march = TimeMarch(
            line, [OPEN], start(SPEED, 5.0), MarchSettings(step=1.0 / 160e3, substeps=8),
            DriveLoads(drag_torques={"bearing": torque}), model,
        )  # fmt: skip
        march.advance(np.zeros((400, 4)), drags=DragTables(torque=table[None], last_speed=np.array([TOP])))
        assert march.unconverged == 0
        ends[rise is None] = march.state(), march.propagator.modes.drags
    (all_modes, every), (some, few) = ends[True], ends[False]
    assert np.count_nonzero(few.push) < np.count_nonzero(every.push)
    assert some.speeds == pytest.approx(all_modes.speeds, rel=1e-6, abs=1e-6)
    twist = np.diff(all_modes.angles[:2])[0]
    assert abs(twist) > 1e-10
    assert np.diff(some.angles[:2])[0] == pytest.approx(twist, rel=1e-3)
