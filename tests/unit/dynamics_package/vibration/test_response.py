"""Time response over a schedule: controllers, envelopes, low-pass, energy book, refusals."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.graph import assemble
from dynamics.vibration.command import (
    Command,
    DragCurve,
    LowPass,
    MotorDrive,
    Sampling,
    default_speed_control,
)
from dynamics.vibration.march_inputs import SpeedControl
from dynamics.vibration.time_response import TimeResponse, WindowStatistics, run_schedule, split_lift_off
from tests.builders.mesh import spur_law
from tests.builders.rig import prototype, prototype_laws

RPM = np.pi / 30.0
DRAG = DragCurve(speed=np.array([0.0, 2000.0]), torque=np.array([0.05, 0.4]))


@cache
def run(torque_limit: float = 60.0, friction: float = 0.04) -> TimeResponse:
    """A short ramp: 20 Nm at standstill, to 1500 rpm, 90 Nm there."""
    system = assemble(prototype(linear_drag=7e-4))
    laws = [law._replace(friction=friction) for law in prototype_laws()]
    command = Command(
        time=np.array([0.0, 0.05, 0.25, 0.3, 0.4]),
        speed=np.array([0.0, 0.0, 1500.0, 1500.0, 1500.0]) * RPM,
        torque=np.array([20.0, 20.0, 20.0, 90.0, 90.0]),
    )
    name = next(iter(system.drag_loads))
    return run_schedule(
        system, laws, command, drags={name: DRAG}, motor=MotorDrive(torque_limit=torque_limit)
    )


def test_speed_and_torque_follow_the_command() -> None:
    response = run()
    assert len(response.time) == 16000
    assert response.time[-1] == pytest.approx(0.4)
    settled = response.windows.time > 0.36
    # a controller of 2 Hz still carries the end of so short a ramp
    assert response.speed[-1] == pytest.approx(1500.0 * RPM, rel=0.03)
    np.testing.assert_allclose(response.windows.mean[0, settled], 90.0, rtol=0.05)
    np.testing.assert_allclose(response.windows.mean[0, response.windows.time < 0.04], 20.0, rtol=0.01)
    assert response.lift_off == () or response.lift_off[0].longest_gap > 0.0


def test_energy_book_closes() -> None:
    book = run().energy
    assert abs(book.residual) < 1e-3 * book.losses
    assert book.input_work > book.change > 0.0
    assert min(*book.friction, *book.mesh_damping, book.joint_damping, *book.drag.values()) > 0.0


def test_friction_costs_work() -> None:
    assert run().energy.input_work > run(friction=0.0).energy.input_work
    assert not np.any(run(friction=0.0).energy.friction)


def test_envelope_holds_the_samples() -> None:
    response = run()
    per_window = round(response.windows.duration * 40e3)
    for mesh in range(2):
        rows = response.torque[mesh].reshape(-1, per_window)[5:-1]
        reach = response.windows.greatest[mesh, 5:-1] - response.windows.least[mesh, 5:-1]
        # the low-pass may overshoot a peak by its ripple, no more
        assert np.all(rows.max(axis=1) <= response.windows.greatest[mesh, 5:-1] + 0.1 * reach + 1e-6)
        np.testing.assert_allclose(rows.mean(axis=1), response.windows.mean[mesh, 5:-1], atol=0.02 * 90.0)


def test_motor_at_its_limit_misses_the_speed() -> None:
    weak = run(torque_limit=2.0)
    assert weak.drive_torque.max() <= 2.0
    assert weak.drive_limited_share > 0.3
    assert weak.speed_missed > 300.0 * RPM
    assert run().drive_limited_share < 0.1


def test_run_is_reproducible_to_the_last_bit() -> None:
    system = assemble(prototype())
    laws = prototype_laws()
    command = Command(time=np.array([0.0, 0.02]), speed=np.array([10.0, 12.0]), twist=np.array([6e-3, 6e-3]))
    first, second = (
        run_schedule(system, laws, command, motor=MotorDrive(torque_limit=50.0)) for _ in range(2)
    )
    assert np.array_equal(first.torque, second.torque)
    assert first.energy.losses == second.energy.losses
    assert np.array_equal(first.end.speeds, second.end.speeds)


def test_chunks_do_not_show() -> None:
    # 0.3 s is longer than one chunk of 8192 samples: speed and torque run through its border
    response = run()
    border = 8000
    step = np.abs(np.diff(response.torque[0, border - 50 : border + 50]))
    assert step.max() < 1.5 * np.abs(np.diff(response.torque[0, border - 2000 : border + 2000])).max()
    assert np.abs(np.diff(response.speed))[border - 1] < 1.0


def test_imposed_offset_moves_the_torque_in_a_held_loop() -> None:
    system, laws = assemble(prototype()), prototype_laws()
    time = np.array([0.0, 0.02, 0.06, 0.1])
    offsets = np.zeros((4, 2))
    offsets[2:, 0] = 10e-6
    twist = np.full(4, 6e-3)
    command = Command(time=time, speed=np.full(4, 20.0), twist=twist, offsets=offsets)
    means = run_schedule(system, laws, command, motor=MotorDrive(torque_limit=50.0)).windows.mean[0]
    assert means[-1] - means[1] > 1.0


def test_lowpass_keeps_the_band_and_stops_the_rest() -> None:
    time = np.arange(16000) / 320e3
    for frequency, gain in ((1e3, 1.0), (15e3, 1.0), (24.5e3, 0.0), (60e3, 0.0), (79e3, 0.0)):
        low_pass = LowPass(1, 8)
        wave = np.sin(2.0 * np.pi * frequency * time)[None]
        samples = np.hstack([low_pass.decimate(part) for part in np.split(wave, [3000, 3001, 9000], axis=1)])
        samples = np.hstack((samples, low_pass.finish()))
        assert samples.shape == (1, 2000)
        middle = samples[0, 200:-200]
        expected = gain * np.sin(2.0 * np.pi * frequency * time[7::8])[200:-200]
        np.testing.assert_allclose(middle, expected, atol=2e-3)


def test_each_time_has_its_own_torque_limit() -> None:
    """A motor asked for more than it may gives 5 N m, from 0.03 s on 12 N m."""
    time = np.linspace(0.0, 0.06, 61)
    command = Command(time=time, speed=np.full(61, 200.0) + 4000.0 * time, torque=np.full(61, 60.0))
    response = run_schedule(
        assemble(prototype()),
        prototype_laws(),
        command,
        motor=MotorDrive(torque_limit=np.where(time < 0.03, 5.0, 12.0)),
        sampling=Sampling(keep_channels=False, keep_accounts=False),
    )
    early, late = response.time < 0.0299, response.time > 0.0301
    assert np.abs(response.drive_torque[early]).max() == pytest.approx(5.0)
    assert np.abs(response.drive_torque[late]).max() == pytest.approx(12.0)
    assert response.drive_limited_share > 0.9


def test_windows_carry_gaps_over_their_borders() -> None:
    law = spur_law()
    torque = np.full((1, 400), 50.0)
    torque[0, 90:210] = 0.0
    torque[0, 300] = -20.0
    speed = np.full(40, 100.0)
    windows = WindowStatistics([law], 100, 1e-5, 0.05)
    windows.add(torque[:, :200], speed[:20])
    windows.add(torque[:, 200:], speed[20:])
    result = windows.windows(2.0)
    np.testing.assert_allclose(result.time, 2.0 + 1e-3 * np.arange(1, 5))
    np.testing.assert_allclose(result.out_of_contact[0], [0.1, 1.0, 0.1, 0.0])
    np.testing.assert_allclose(result.longest_gap[0], [1.1e-3, 1.1e-3, 1.2e-3, 0.0])
    np.testing.assert_allclose(result.least[0], [0.0, 0.0, 0.0, -20.0])
    (lost,) = windows.lift_off(2.0)
    assert (lost.mesh, lost.start, lost.end) == (0, pytest.approx(2.0), pytest.approx(2.003))
    assert lost.longest_gap == pytest.approx(1.2e-3)


def test_a_loss_of_contact_is_shared_out_over_the_stages_it_runs_through() -> None:
    """80 % of the first window free, 20 % of the second, then closed and lost again: cut between the two windows."""
    windows = WindowStatistics([spur_law()], 100, 1e-5, 0.05)
    torque = np.full((1, 400), 50.0)
    torque[0, 20:120] = 0.0
    torque[0, 310:390] = 0.0
    windows.add(torque, np.full(40, 100.0))
    whole = windows.lift_off(2.0)
    assert [one.start for one in whole] == pytest.approx([2.0, 2.003])
    assert [one.end for one in whole] == pytest.approx([2.002, 2.004])
    first, second, third = split_lift_off(windows.windows(2.0), whole, [0.0, 2.001, 5.0])
    assert (first.start, first.end, second.start, second.end) == pytest.approx((2.0, 2.001, 2.001, 2.002))
    assert (first.out_of_contact, second.out_of_contact) == pytest.approx((0.8, 0.2))
    assert (third.start, third.out_of_contact) == pytest.approx((2.003, 0.8))


def test_a_gap_is_measured_by_the_mesh_period_of_its_own_pair() -> None:
    """A pinion that turns at a third of the speed has a mesh period three times as long."""
    law = spur_law()
    period = 2.0 * np.pi / (100.0 * law.teeth_1)
    gap = round(0.1 * period / 1e-6)
    torque = np.full((2, 4000), 50.0)
    torque[:, 1000 : 1000 + gap] = 0.0
    windows = WindowStatistics([law, law], 4000, 1e-6, 0.05, (1.0, 1.0 / 3.0))
    windows.add(torque, np.full(40, 100.0))
    assert [lost.mesh for lost in windows.lift_off(0.0)] == [0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"time": np.array([0.0, 0.0])}, "increase"),
        ({"twist": None}, "either torque or twist"),
        ({"speed": np.array([1.0])}, "speed has 1"),
        ({"offsets": np.zeros((2, 1))}, "offsets has shape"),
    ],
)
def test_impossible_commands_are_refused(change: dict[str, object], words: str) -> None:
    command = Command(time=np.array([0.0, 0.1]), speed=np.zeros(2), twist=np.full(2, 1e-2))
    with pytest.raises(ValueError, match=words):
        run_schedule(
            assemble(prototype()),
            prototype_laws(),
            replace(command, **change),
            motor=MotorDrive(torque_limit=10.0),
        )


def test_sample_rate_is_no_integration_step() -> None:
    command = Command(time=np.array([0.0, 0.1]), speed=np.zeros(2), twist=np.full(2, 1e-2))
    with pytest.raises(ValueError, match="no integration step"):
        run_schedule(
            assemble(prototype()),
            prototype_laws(),
            command,
            motor=MotorDrive(torque_limit=10.0),
            sampling=Sampling(substeps=2),
        )


def test_a_run_keeps_more_torques_than_samples_where_their_band_asks_for_it() -> None:
    """A band up to 60 kHz needs 160 kHz of 40 kHz samples with eight steps each: four a sample."""
    dense, coarse = (Sampling(sample_rate=40e3, substeps=8, torque_band=band) for band in (60e3, 0.0))
    assert dense.steps_kept == 2 and dense.torques_kept(10.0) == pytest.approx(4.0 * 40e3 * 10.0)
    assert coarse.torques_kept(10.0) == pytest.approx(40e3 * 10.0)


def test_speed_control_of_a_light_rotor_before_heavy_wheels_is_stable() -> None:
    """The delay of a controller of 2 Hz for the whole inertia shakes a rotor of a four-thousandth of it."""
    system = assemble(prototype(linear_drag=7e-4))
    heavy = np.full(len(system.inertia), 3000.0)
    heavy[system.drive_dof] = 1.0
    system = replace(
        system,
        inertia=system.inertia * np.sqrt(np.outer(heavy, heavy)),
        damping=0.02 * system.damping,
    )
    command = Command(
        time=np.array([0.0, 0.05, 0.2]), speed=np.array([20.0, 21.0, 21.0]) * RPM, torque=np.full(3, 20.0)
    )
    control = default_speed_control(system, prototype_laws(), 5e3, sample_time=1e-4)
    inertia, rate = control.integral * (control.time_constant / 0.1) ** 2, 4.0 * np.pi
    usual = SpeedControl(
        proportional=2.0 * inertia * rate,
        integral=inertia * rate**2,
        torque_limit=5e3,
        time_constant=0.1 / rate,
    )

    def error(given: SpeedControl | None) -> float:
        response = run_schedule(
            system, prototype_laws(), command, motor=MotorDrive(torque_limit=5e3, speed_control=given),
            sampling=Sampling(sample_rate=10e3, substeps=16, keep_channels=False),
        )  # fmt: skip
        return float(np.abs(response.speed - response.speed_command).max())

    assert error(usual) > 1000.0 * RPM
    assert error(None) < 10.0 * RPM
    ordinary = default_speed_control(assemble(prototype()), prototype_laws(), 20.0)
    assert ordinary.time_constant == pytest.approx(0.1 / rate)
