"""The virtual rig's loop and measuring chain, against closed forms and their own balances."""

import ast
import math
from pathlib import Path

import numpy as np
import pytest

from tests.virtual_rig import loop as loop_module
from tests.virtual_rig import loop_march as kernel
from tests.virtual_rig.case_reader import read_case
from tests.virtual_rig.chain import draw_chain, put_in, repeats, systematic, write_set
from tests.virtual_rig.generate_effects import LOOP, candidates
from tests.virtual_rig.generate_plans import plan_points, sensors
from tests.virtual_rig.generate_truth import RigTruth, draw_rig, nominal_constants, readings, true_points
from tests.virtual_rig.loop import LoopTruth, Point
from tests.virtual_rig.loop_model import read_circuit, speed_ratio
from tests.virtual_rig.teeth import pair_stiffness

HERE = Path(__file__).resolve().parents[1] / "virtual_rig"
CASES = HERE.parents[1] / "cases"
FRICTION = {"test.main": 0.05, "reference.main": 0.05}


@pytest.fixture(scope="module")
def equal():
    return read_case(CASES / "loop_1to1" / "case.toml")


@pytest.fixture(scope="module")
def hunting():
    return read_case(CASES / "loop_hunting" / "case.toml")


def test_nothing_of_the_checker_is_imported():
    for file in HERE.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            assert not {name.split(".")[0] for name in names} & {"rigdesign", "thermal", "dynamics"}, (
                file.name
            )


def test_pair_stiffness_of_the_printed_example():
    # ISO/TR 6336-30 example 1: c'_th 17.85584 N/(mm um)
    found = 1e-9 * pair_stiffness((17, 103), (0.145, 0.0), math.radians(15.8), math.radians(20.0))
    assert found == pytest.approx(17.85584, rel=2e-4)


def step_response(dt, time):
    """Displacement of a damped oscillator (1 kg, 800 Hz, 3 %) at ``time`` after a force of one newton sets in."""
    omega, zeta = 2.0 * math.pi * 800.0, 0.03
    root = complex(-zeta * omega, omega * math.sqrt(1.0 - zeta**2))
    state, rho = np.zeros(1, complex), np.zeros(2)
    weight = -1j / root.imag  # x = Re(weight z), z the state after an impulse of one
    numbers = np.zeros((1, kernel.N_NUMBERS))
    numbers[0, [kernel.RATE, kernel.PITCH, kernel.STEP, kernel.BACK_GAP]] = 1e-9, 1.0, 1e-3, 1.0
    steps = round(time / dt)
    kernel.march(
        steps, 0, dt, state, rho, np.array([np.exp(root * dt)]), np.array([[weight]]), np.array([[weight * root]]),
        np.array([[1.0 + 0j], [0j], [0j]]), np.zeros(1), np.zeros(3), np.zeros(1), np.zeros((1, 1)),
        np.zeros((1, 1)), np.array([-1.0, 0.0, 0.0]), numbers, np.zeros((1, 8)), np.zeros((1, 1, 8)),
        np.zeros((1, 2, 1)), np.ones((1, 2, 1)), np.zeros((1, 2, 1)), np.array([[1, 1]]), np.array([0]),
        np.zeros((3, 0)),
    )  # fmt: skip
    damped = root.imag
    exact = (
        1.0
        - math.exp(-zeta * omega * time)
        * (math.cos(damped * time) + zeta * omega / damped * math.sin(damped * time))
    ) / omega**2
    return float((weight * state[0]).real), exact


def test_one_oscillator_follows_its_closed_form():
    found, exact = step_response(1e-6, 4e-3)
    assert found == pytest.approx(exact, rel=5e-3)


def test_run_out_winds_the_loop(equal):
    # slow: the wave of 10 um goes into the loop at the base radius and meets its stiffness in series
    truth = LoopTruth(equal, effects=[{"effect": "run_out:test.pinion", "size": 10e-6, "phase": 0.5}])
    answer = truth.solve(Point(speed=400.0 * math.pi / 30.0, torque=200.0), (1.0,))
    circuit = read_circuit(equal, truth.meshes, 40.0, 200.0, {})
    meshes = [np.outer(row, row) * 2.5e8 * (1.0 + i) for i, row in enumerate(circuit.approach)]
    stiff = circuit.stiffness + sum(meshes)
    load = -2.5e8 * circuit.approach[0] * 10e-6
    at = np.linalg.lstsq(stiff, load, rcond=1e-15)[0]
    joint = circuit.couplings["wheel_side"]
    expected = joint.stiffness * (at[joint.a] - at[joint.b])
    found = answer.torques["wheel_side"][1.0]
    assert abs(found) == pytest.approx(abs(expected), rel=0.03)
    # Re(10 um exp(i 0.5) exp(-i phi)) ahead: the order turns against the phase
    assert (found / expected).real > 0.0 and np.angle(found / expected) == pytest.approx(-0.5, abs=0.05)


def test_wave_of_order_three_stays_order_three(equal):
    truth = LoopTruth(
        equal, effects=[{"effect": "cumulative_pitch:test.wheel", "size": 8e-6, "phase": 0.0, "order": 3}]
    )
    answer = truth.solve(Point(speed=105.0, torque=250.0), (1.0, 2.0, 3.0, 4.0)).torques["wheel_side"]
    assert abs(answer[3.0]) > 0.3
    assert max(abs(answer[k]) for k in (1.0, 2.0, 4.0)) < 0.02 * abs(answer[3.0])


@pytest.mark.parametrize(
    ("case", "effect", "order", "behind"),
    [
        ("loop_1to1", "run_out:test.pinion", 1.0, 0),
        ("loop_1to1", "run_out:reference.wheel", 1.0, -1),
        ("loop_1to1", "cumulative_pitch:test.pinion", 2.0, 0),
        ("loop_hunting", "run_out:test.wheel", 0.64, 0),
    ],
)
def test_deviations_swing_the_loop_against_its_inertia(case, effect, order, behind):
    """Gears that run together have the torque -F e'(phi) on them, e what the flanks stand out: T e / (r_b J omega^2).

    Between two torques what only winds the loop is the same.
    """
    tree = read_case(CASES / case / "case.toml")
    change = {"effect": effect, "size": 8e-6, "phase": 0.7, "order": order}
    truth = LoopTruth(tree, effects=[change])
    speed = 60.0
    gear = effect.partition(":")[2]
    mesh = next(m for m in truth.meshes if gear in m.gears)
    circuit = read_circuit(tree, truth.meshes, speed, 200.0, {})
    running = np.zeros(circuit.size)
    for line in np.unique(circuit.lines[circuit.lines >= 0]):
        running[circuit.lines == line] = speed_ratio(tree, truth.meshes, circuit, line)
    inertia = running @ circuit.mass @ running
    wave = 8e-6 * np.exp(0.7j) * (-np.exp(2j * behind * mesh.working_angle) if behind else 1.0)
    answers, torques = [], []
    for torque in (100.0, 300.0):
        point = Point(speed=speed, torque=torque)
        answers.append(truth.solve(point, (order,)))
        wound = truth._state(circuit, point, None)["place"][circuit.gears[gear]]
        force = answers[-1].mesh_forces[mesh.name].mean()
        turned = np.conj(wave) * np.exp(1j * (2.0 if order == 2.0 else 1.0) * wound)
        torques.append(-force * 1j * order * turned)  # per turn of the reference gear
    expected = -(torques[1] - torques[0]) / (inertia * (order * speed) ** 2)
    for shaft in answers[0].angles:
        ratio = running[circuit.ends[shaft, "start"]]
        found = (answers[1].angles[shaft][order] - answers[0].angles[shaft][order]) / ratio
        assert found == pytest.approx(expected, rel=0.03)


def test_force_is_the_slope_of_the_energy(equal):
    step = {"effect": "single_pitch:test.pinion", "size": 5e-6, "tooth": 3}
    truth = LoopTruth(equal, effects=[step])
    circuit = read_circuit(equal, truth.meshes, 100.0, 200.0, {})
    tables = truth._tables(circuit, 100.0, 1e-5, Point(speed=100.0, torque=200.0), (0.0, 0.0))
    for mesh in (0, 1):
        pitch = truth.meshes[mesh].base_pitch
        for place in pitch * np.linspace(0.0, 5.0, 41):
            for x in (3e-6, 12e-6, 40e-6):
                ends = [kernel.pair_energy(x + h, place, mesh, *tables) for h in (-1e-9, 1e-9)]
                force = kernel.pair_force(x, 0.0, place, mesh, *tables)[0]
                assert (ends[1] - ends[0]) / 2e-9 == pytest.approx(force, rel=1e-3, abs=0.5)


def test_drive_pays_friction_and_drags(equal):
    drags = {"test.pinion": 0.4, "reference.wheel": 0.7}
    truth = LoopTruth(equal)
    point = Point(speed=300.0, torque=300.0, friction=FRICTION, drags=drags)
    answer = truth.solve(point, (1.0,))
    friction = sum(0.05 * power for power in truth.sliding_power(300.0, 300.0).values())
    dragged = 300.0 * sum(drags.values())
    assert answer.motor_power == pytest.approx(friction + dragged, rel=0.02)
    assert answer.motor_power > 0.98 * (friction + dragged)


def test_held_twist_and_bracing_drift(equal):
    point = Point(speed=200.0, torque=300.0, oil=353.15)
    plain = LoopTruth(equal).solve(point, (1.0,)).torques["wheel_side"][0.0].real
    drifted = LoopTruth(equal, effects=[{"effect": "bracing_drift", "size": -1e-3}]).solve(point, (1.0,))
    assert plain == pytest.approx(300.0, rel=0.02)
    # 60 K above the reference temperature; of the twist, which shrinks by 6 %, the backlash takes the same as before
    assert drifted.torques["wheel_side"][0.0].real / plain - 1.0 == pytest.approx(-0.06, abs=0.004)


def test_error_falls_with_the_step(hunting, monkeypatch):
    truth = LoopTruth(hunting)
    found = []
    for step in (4e-6, 1.2e-5, 2.4e-5):
        monkeypatch.setattr(loop_module, "LONG_STEP", step)
        found.append(
            truth.solve(Point(speed=377.0, torque=250.0, friction=FRICTION), (16.0,)).torques["wheel_side"][
                16.0
            ]
        )
    fine, middle, coarse = found
    assert abs(coarse - fine) < 0.03 * abs(fine)
    assert abs(coarse - fine) > 1.8 * abs(middle - fine)


def test_hunting_teeth_make_fractional_orders(hunting):
    truth = LoopTruth(hunting, effects=[{"effect": "run_out:test.wheel", "size": 10e-6, "phase": 0.0}])
    answer = truth.solve(Point(speed=377.0, torque=200.0), (0.64, 1.0, 2.0)).torques["pinion_side"]
    assert abs(answer[0.64]) > 0.3
    assert abs(answer[1.0]) < 1e-6


def test_every_effect_of_the_loop_changes_something(equal):
    own = sensors("loop_1to1", "rich")
    point = true_points("loop_1to1", plan_points("loop_1to1", 15))[5:6]
    base = RigTruth("loop_1to1", nominal_constants("loop_1to1")).values(point, own)
    for catalogue in (True, False):
        kinds = {}
        for name in candidates("loop_1to1", own, catalogue=catalogue):
            kinds.setdefault(name.partition(":")[0], name)
        for kind, name in kinds.items():
            if kind not in LOOP or kind in ("x_cell_lag", "x_encoder_wobble", "x_rattle"):
                continue
            effect = {"effect": name, "size": 0.5 * LOOP[kind].upper, "phase": 0.3, "order": 2, "tooth": 5}
            changed = RigTruth("loop_1to1", nominal_constants("loop_1to1"), [effect]).values(point, own)
            noise = np.array(
                [next(s.noise for s in own if s.name == row.channel) for row in readings(own, point)]
            )
            assert np.abs((changed - base) / noise).max() > 1.0, name


def test_chain_keeps_its_errors_and_writes_no_label(tmp_path):
    own = sensors("loop_1to1", "sparse")
    points = true_points("loop_1to1", plan_points("loop_1to1", 15)[:2])
    rows = readings(own, points)
    truth = RigTruth("loop_1to1", draw_rig("loop_1to1", np.random.default_rng(1), own)).values(points, own)
    chain = draw_chain(own, np.random.default_rng(2))
    effect = {"effect": "torque_zero:M_1", "size": 2.5}
    before = systematic(chain, own, rows, points, truth)
    put_in(chain, [effect])
    change = systematic(chain, own, rows, points, truth) - before
    means = np.array([row.channel == "M_1" and row.part == "value" for row in rows])
    assert change == pytest.approx(np.where(means, 2.5, 0.0))
    texts = []
    for folder in ("a", "b"):
        rng = np.random.default_rng(3)
        told = repeats(chain, own, rows, points, truth, {p.name: 3 for p in points}, rng)
        write_set(tmp_path / folder, "loop_1to1", chain, own, points, told, rng, title="measured")
        texts.append("".join(f.read_text(encoding="utf-8") for f in sorted((tmp_path / folder).iterdir())))
    assert texts[0] == texts[1]
    assert "torque_zero" not in texts[0]
    spread = np.std(
        [[told[p.name, k][row] for k in (1, 2, 3)] for p in points for row in rows if row.point == p.name],
        axis=1,
    )
    assert 0.0 < np.median(spread) < 0.2
