import math
from dataclasses import replace

import numpy as np
import pytest

from dynamics.errors import DynamicsNotConverged
from dynamics.rotor.graph import assemble
from dynamics.rotor.linear_system import LinearSystem, modal_form
from dynamics.rotor.parts import Motor
from dynamics.rotor.static_loop import LoopLoad, port_model
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.harmonic_balance import (
    BalanceProblem,
    HarmonicGrid,
    HarmonicNewton,
    resample,
    solve_periodic,
)
from dynamics.vibration.response_curve import ResponseCurve, waveform
from dynamics.vibration.speed_continuation import HarmonicWalk, highest_mode, mesh_cells, quasi_static_start
from dynamics.vibration.speed_sweep import DragTorques, SweepSettings, periodic_response
from tests.builders.rig import prototype, prototype_laws

RPM = math.pi / 30.0


def by_harmonics(
    laws: tuple[MeshLaw, ...],
    speeds: list[float],
    load: LoopLoad = LoopLoad(torque=180.0),  # noqa: B008 - immutable
    drag_torques: DragTorques = None,
    system: LinearSystem | None = None,
    **settings: object,
) -> ResponseCurve:
    chosen = SweepSettings(methods=("harmonic_balance",), **settings)
    speeds = [n * RPM for n in speeds]
    return periodic_response(system or assemble(prototype()), laws, speeds, load, drag_torques, chosen)


def problem_of(system: LinearSystem, laws: tuple[MeshLaw, ...]) -> BalanceProblem:
    form = modal_form(system.inertia, system.damping, system.stiffness, system.rigid)
    return BalanceProblem(model=port_model(system, laws), form=form, load=LoopLoad(torque=180.0))


def test_mean_torque_is_the_asked_one_and_the_loop_closes() -> None:
    for point in by_harmonics(prototype_laws(), [1500.0, 4500.0, 12000.0]).points:
        assert point.mean[0] == pytest.approx(180.0, rel=1e-4)
        assert point.flank.tolist() == [1.0, -1.0]
        assert point.minimum[0] < 180.0 < point.maximum[0]
        assert point.harmonics[0, 0] == pytest.approx(point.mean[0])
        assert point.dynamic_factor == pytest.approx(point.maximum / point.mean)
        assert np.all(point.dynamic_factor_half_peak_to_peak >= 1.0)


def test_motor_on_a_soft_shaft_takes_nothing_from_the_loop() -> None:
    """A motor that swings at 20 Hz on its shaft has no part in the mesh vibration at 20 kHz.

    Its angle cannot lead the loop from state to state: friction reverses at the pitch point faster than so soft
    a spring follows.
    """
    rig = prototype()
    stiff, soft = (
        by_harmonics(
            prototype_laws(friction=0.04),
            [12000.0],
            system=assemble(replace(rig, motor=replace(rig.motor, inertia=0.01, stiffness=stiffness))),
        ).points[0]
        for stiffness in (1e5, 160.0)
    )
    assert soft.drive_torque == pytest.approx(stiff.drive_torque, rel=5e-3)
    assert soft.maximum == pytest.approx(stiff.maximum, rel=5e-3)


@pytest.mark.parametrize("speed", [1500.0, 6000.0])
def test_drive_power_is_what_meshes_and_joints_lose(speed: float) -> None:
    """Momentum balance against integrated losses (V12): joints from the harmonics of their ports."""
    system, laws = assemble(prototype()), prototype_laws()
    problem = problem_of(system, laws)
    walk = HarmonicWalk(problem, "mesh", 50e3, 1e-7)
    drive_speed = speed * RPM / problem.model.ratios[0]
    solution = walk.solve(drive_speed, None, None)
    wave = waveform(problem.model, solution)
    base = drive_speed * 2.0 * np.pi / walk.cell_angle
    omega = base * np.arange(1, solution.grid.top + 1)
    stiff = np.linalg.inv(problem.form.receptance(omega, problem.model.dofs[:-1]))
    velocity = 1j * omega * solution.ports[:, 1:]
    torque = np.einsum("kij,jk->ik", stiff, solution.ports[:, 1:])
    joints = 2.0 * float(np.sum((torque * velocity.conj()).real))
    lost = wave.friction_power.sum() + wave.damping_power.sum() + joints
    assert joints > 0.0
    assert solution.drive * drive_speed == pytest.approx(lost, rel=1e-3)


def test_slow_rotation_is_the_quasi_static_state() -> None:
    """All parts light and undamped, so that no mode is near, and a flywheel holds the angle of the drive."""
    system, laws = assemble(prototype()), prototype_laws(damping=0.0)
    inertia = 1e-5 * system.inertia
    inertia[system.drive_dof, system.drive_dof] = 1e3
    system = replace(system, inertia=inertia, damping=np.zeros_like(system.damping))
    problem = problem_of(system, laws)
    _, angle = mesh_cells(problem.model, "mesh", 0)
    grid = HarmonicGrid(cells=1, harmonics=48, samples=512, cell_angle=angle)
    start = quasi_static_start(problem, grid, 5.0, None)
    solution = solve_periodic(problem, 5.0, start)
    assert solution.twist == pytest.approx(start.twist, rel=1e-5)
    apart = waveform(problem.model, solution).torque - waveform(problem.model, start).torque
    assert np.sqrt(np.mean(apart**2, axis=1)).max() < 1e-3 * 180.0


def test_harmonics_reach_the_highest_mode_or_the_method_is_refused() -> None:
    problem = problem_of(assemble(prototype()), prototype_laws())
    walk = HarmonicWalk(problem, "mesh", 50e3, 1e-5)
    assert 45e3 < walk.highest <= 50e3
    for speed in (60.0, 300.0, 1200.0):
        grid = walk.grid(speed)
        assert grid.harmonics * speed / grid.cell_angle >= 1.5 * walk.highest or grid.harmonics == 24
        assert grid.samples >= 4 * grid.harmonics
    with pytest.raises(DynamicsNotConverged, match=r"harmonics needed to reach 1\.5 times"):
        walk.grid(5.0)
    assert highest_mode(problem.model, problem.form, 0.0) == 0.0


def test_more_harmonics_do_not_change_the_answer() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    coarse = by_harmonics(laws, [3300.0], cutoff=1.0).points[0]
    fine = by_harmonics(laws, [3300.0], cutoff=100e3).points[0]
    assert fine.harmonics.shape[1] > coarse.harmonics.shape[1]
    assert fine.dynamic_factor == pytest.approx(coarse.dynamic_factor, rel=3e-3)
    assert system.rigid.shape[1] == 2


def test_revolution_of_equal_teeth_is_the_mesh_period_again() -> None:
    laws = prototype_laws()
    one = by_harmonics(laws, [3300.0], cutoff=1.0).points[0]
    turn = by_harmonics(laws, [3300.0], cutoff=1.0, period="revolution").points[0]
    assert turn.wave.time.size == 99 * one.wave.time.size
    assert turn.maximum == pytest.approx(one.maximum, rel=1e-5)
    assert turn.harmonics[:, :10] == pytest.approx(one.harmonics[:, :10], rel=1e-3, abs=1e-2)


def test_one_pitch_error_makes_sidebands_of_first_order() -> None:
    laws = prototype_laws()
    points = laws[0].gap.shape[1]
    deviation = np.zeros((99, points))
    deviation[7] = 3e-6
    turn = by_harmonics(
        (laws[0]._replace(deviation_1=deviation), laws[1]), [3300.0], cutoff=1.0, period="revolution"
    ).points[0]
    clean = by_harmonics(laws, [3300.0], cutoff=1.0, period="revolution").points[0]
    with_error, without = (np.abs(np.fft.rfft(p.wave.torque[0])) / p.wave.time.size for p in (turn, clean))
    orders = np.array([1, 50, 98, 100, 197, 199])
    assert np.all(with_error[[1, 50]] > 0.01)
    assert np.all(with_error[orders] > 100.0 * without[orders])


def test_hunting_cycle_length() -> None:
    model = port_model(assemble(prototype()), prototype_laws())
    assert mesh_cells(model, "revolution", 0)[0] == 99
    assert mesh_cells(model, "hunting_cycle", 0)[0] == math.lcm(99, 102)
    assert mesh_cells(model, "mesh", 0) == (1, pytest.approx(2.0 * math.pi / 102))


def test_start_on_another_grid_keeps_the_mesh_harmonics() -> None:
    problem = problem_of(assemble(prototype()), prototype_laws())
    small = HarmonicGrid(cells=1, harmonics=8, samples=64, cell_angle=2.0 * math.pi / 102)
    start = quasi_static_start(problem, small, 100.0, None)
    spread = resample(start, replace(small, cells=99, harmonics=10))
    assert spread.ports.shape[1] == 991
    assert np.array_equal(spread.ports[:, 0 : 9 * 99 : 99], start.ports)
    assert np.array_equal(resample(spread, small).ports, start.ports)


def test_drag_adds_to_the_drive_torque() -> None:
    free = by_harmonics(prototype_laws(), [6000.0]).points[0]
    braked = by_harmonics(
        prototype_laws(), [6000.0], drag_torques=lambda speed: {"test_pinion left": 1e-3 * speed}
    )
    expected = 1e-3 * 6000.0 * RPM * 102 / 99
    assert braked.points[0].drive_torque - free.drive_torque == pytest.approx(expected, rel=0.02)
    with pytest.raises(ValueError, match="drag torque 'nowhere' has no place"):
        by_harmonics(prototype_laws(), [6000.0], drag_torques={"nowhere": 1.0})


def test_linear_bearing_drag_is_balanced_by_the_motor() -> None:
    """P2, Table 1: 8 bearings of 0.0007 Nms/rad take about 7 Nm at 12,000 rpm."""
    free = by_harmonics(prototype_laws(), [12000.0]).points[0]
    system = assemble(prototype(linear_drag=7e-4))
    braked = by_harmonics(prototype_laws(), [12000.0], system=system).points[0]
    speed = 12000.0 * RPM * np.array([1.0, 99 / 102])
    power = 4 * 7e-4 * float(np.sum(speed**2))
    assert (braked.drive_torque - free.drive_torque) * speed[1] == pytest.approx(power, rel=0.01)
    assert power / speed[0] == pytest.approx(7.0, abs=0.3)


def test_held_twist_gives_the_torque_that_needed_it() -> None:
    asked = by_harmonics(prototype_laws(), [5000.0]).points[0]
    held = by_harmonics(prototype_laws(), [5000.0], LoopLoad(twist=asked.twist)).points[0]
    assert held.mean == pytest.approx(asked.mean, rel=1e-4)


def test_bad_input_is_refused() -> None:
    laws = prototype_laws()
    with pytest.raises(ValueError, match="must be above 0"):
        by_harmonics(laws, [0.0])
    with pytest.raises(ValueError, match="either the torque or the twist"):
        by_harmonics(laws, [1000.0], LoopLoad(torque=180.0, twist=0.001))
    with pytest.raises(ValueError, match="time integration controls mesh 0"):
        periodic_response(assemble(prototype()), laws, [100.0], LoopLoad(torque=180.0, control_mesh=1))
    rig = prototype()
    on_gear = replace(assemble(rig), drive_dof=int(assemble(rig).mesh_ports[0, 0]))
    with pytest.raises(ValueError, match="place it on a shaft station"):
        port_model(on_gear, laws)
    assert isinstance(rig.motor, Motor)


def test_a_singular_newton_matrix_is_no_solution(monkeypatch: pytest.MonkeyPatch) -> None:
    def singular(*_: object) -> None:
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(HarmonicNewton, "step", singular)
    curve = periodic_response(
        assemble(prototype()),
        prototype_laws(),
        [500.0],
        LoopLoad(torque=180.0),
        settings=SweepSettings(methods=("harmonic_balance",)),
    )
    assert curve.points == ()
    assert "harmonic balance at" in curve.failed[0][1]


def test_a_start_next_to_the_solution_leads_to_it_at_the_twist_that_is_held() -> None:
    """From the state of a twist that is two per cent less, with another damping."""
    first = by_harmonics(prototype_laws(), [3000.0]).points[0]
    load, laws = LoopLoad(twist=first.twist), prototype_laws(damping=0.03)
    (less,) = by_harmonics(prototype_laws(), [3000.0], LoopLoad(twist=0.98 * first.twist)).points
    (alone,) = by_harmonics(laws, [3000.0], load, tolerance=1e-8).points
    (near,) = by_harmonics(laws, [3000.0], load, tolerance=1e-8, start=less.solution).points
    assert near.twist == first.twist
    assert near.mean == pytest.approx(alone.mean, rel=1e-8)
    assert near.harmonics[:, 1:5] == pytest.approx(alone.harmonics[:, 1:5], rel=1e-6)
    assert abs(less.mean[0] / alone.mean[0] - 1.0) > 5e-3


def test_steps_with_the_tangents_of_the_step_before_end_in_the_same_state(monkeypatch) -> None:
    (chords,) = by_harmonics(prototype_laws(), [4500.0], tolerance=1e-9).points
    monkeypatch.setattr(HarmonicNewton, "step_again", HarmonicNewton.step)
    (newton,) = by_harmonics(prototype_laws(), [4500.0], tolerance=1e-9).points
    assert chords.harmonics == pytest.approx(newton.harmonics, rel=1e-7, abs=1e-9)
