"""Spectrum of the mesh torque in a time run: sidebands of a run-out against harmonic balance, and no line of aliasing.

The pinion of 20 teeth runs out by 1.5 um. The step of the march is chosen so that the 56th mesh order stands beside
the rate of the internal steps: seen at their ends, the law at full resolution shows it as a slow order.
"""

from functools import cache

import numpy as np
import pytest

from dynamics.rotor.static_loop import LoopLoad
from dynamics.tooth.law import MeshLaw
from dynamics.vibration.command import Command, MotorDrive, Sampling
from dynamics.vibration.initial_state import wound_state
from dynamics.vibration.march_inputs import DriveLoads, MarchSettings
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.time_integration import TimeMarch
from dynamics.vibration.time_response import TimeResponse, run_schedule
from rigdesign.postprocessing.spectra import order_spectrum
from tests.builders.mesh import BASE_RADIUS_1, chain, spur_law

TEETH, SPEED, TORQUE = 20, 890.0, 100.0
RATE, SUBSTEPS = 20e3, 8
TURN = SPEED / (2.0 * np.pi)


@cache
def law(run_out: float) -> MeshLaw:
    base = spur_law(n_slices=1)
    return base._replace(
        base_pitch=2.0 * np.pi * BASE_RADIUS_1 / TEETH, teeth_1=TEETH, teeth_2=TEETH, base_radius_2=BASE_RADIUS_1,
        path_start=base.path_start * 99 / TEETH, path_step=base.path_step * 99 / TEETH, damping=4e3,
        deviation_1=0.5 * run_out * np.cos(2.0 * np.pi * np.arange(TEETH) / TEETH)[:, None]
        * np.ones(base.stiffness.shape[1]),
    )  # fmt: skip


def system():
    return chain(2, joint=(1e6, 100.0), bearing=0.02)


@cache
def run(run_out: float) -> TimeResponse:
    """Half a second at the speed; three mesh orders are 8.5 kHz."""
    time = np.array([0.0, 0.5])
    return run_schedule(
        system(),
        [law(run_out)],
        Command(time=time, speed=np.full(2, SPEED), torque=np.full(2, TORQUE)),
        MotorDrive(torque_limit=1e4),
        sampling=Sampling(
            sample_rate=RATE, substeps=SUBSTEPS, torque_band=3.2 * TEETH * TURN, keep_accounts=False
        ),
    )


def lines(response: TimeResponse) -> tuple[np.ndarray, np.ndarray]:
    """Orders of the pinion and amplitudes in the last half of a run."""
    torque = np.asarray(response.torque[0, response.torque.shape[1] // 2 :], float)
    speed = float(response.speed[response.speed.size // 2 :].mean())
    return order_spectrum(torque, speed / (2.0 * np.pi) * response.torque_step)


def near(found: tuple[np.ndarray, np.ndarray], order: float, width: float = 0.1) -> float:
    orders, amplitude = found
    return float(amplitude[np.abs(orders - order) < width].max())


@cache
def balance() -> np.ndarray:
    """Amplitudes of the torque by order of the pinion, by harmonic balance over the revolution."""
    curve = periodic_response(
        system(), [law(1.5e-6)], [SPEED], LoopLoad(torque=TORQUE),
        settings=SweepSettings(period="revolution", methods=("harmonic_balance",)),
    )  # fmt: skip
    (point,) = curve.points
    torque = point.wave.torque[0]
    return np.asarray(2.0 * np.abs(np.fft.rfft(torque)) / torque.size)


def test_the_band_is_kept_by_a_divisor_of_the_internal_steps() -> None:
    sampling = Sampling(sample_rate=RATE, substeps=SUBSTEPS, torque_band=9e3)
    assert sampling.steps_kept == 4  # 0.4 of 40 kHz are 16 kHz, of 20 kHz less than 9 kHz
    assert Sampling(sample_rate=RATE, substeps=SUBSTEPS).steps_kept == SUBSTEPS
    assert Sampling(sample_rate=RATE, substeps=SUBSTEPS, torque_band=1e6).steps_kept == 1
    assert run(0.0).torque_band > 3.0 * TEETH * TURN


@pytest.mark.parametrize("order", [1, 19, 20, 21, 39, 40, 41, 60])
def test_orders_and_sidebands_of_a_run_out_are_those_of_harmonic_balance(order: int) -> None:
    assert near(lines(run(1.5e-6)), order) == pytest.approx(balance()[order], rel=0.03, abs=2e-3)


def test_sidebands_are_there_with_the_run_out_alone() -> None:
    alike, out = lines(run(0.0)), lines(run(1.5e-6))
    for order in (19, 21):
        assert near(out, order) > 30.0 * near(alike, order)


def test_the_high_orders_that_the_steps_do_not_hold_leave_no_line() -> None:
    """The 56th mesh order lies 0.85 % below the step rate: at order 10 in the law at full resolution."""
    steps = RATE * SUBSTEPS
    wound = wound_state(system(), [law(0.0)], SPEED, LoopLoad(torque=TORQUE), {})
    march = TimeMarch(
        system(), [law(0.0)], wound.state,
        MarchSettings(step=1.0 / steps, substeps=SUBSTEPS, accounts=False, record_all=False),
        DriveLoads(drive_torque=wound.drive_torque),
    )  # fmt: skip
    given = np.tile([wound.drive_torque, wound.state.twist, SPEED, 0.0], (int(0.5 * RATE), 1))
    block = march.advance(given)
    half = slice(block.force.shape[1] // 2, None)
    speed = float(block.slow_speed[len(block.slow_speed) // 2 :, 0].mean())
    full, acting = (
        order_spectrum(BASE_RADIUS_1 * force[0, half], speed / (2.0 * np.pi) / steps)
        for force in (block.force, block.acting_force)
    )
    turns = 2.0 * np.pi * steps / speed
    aliases = [abs(number * TEETH - turns) for number in (55, 56, 57)]
    mesh = near(acting, TEETH)
    assert max(near(full, order) for order in aliases) > 2e-4 * mesh
    for order in aliases:
        assert near(acting, order) < 1e-5 * mesh
        assert near(lines(run(0.0)), order) < 1e-5 * mesh
