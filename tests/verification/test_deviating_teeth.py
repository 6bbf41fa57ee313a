"""Deviations of single teeth and swinging torques in the loop, beside stiffnesses in series and rigid inertia.

Sources: torsion of bars, Dubbel C 4 (T = G I_p phi / l); springs in series; a rigid body under a swinging torque,
amplitude of the speed T / (J k omega). In the 1:1 loop all base radii are equal, so that everything is in series:
pinion line, wheel line and both meshes.
"""

import math
from functools import cache

import numpy as np
import pytest

from dynamics.rotor.static_loop import LoopLoad, SlowRotation, port_model, solve_static
from dynamics.tooth.mesh_laws import reach_beyond
from dynamics.vibration.command import Command, MotorDrive, Sampling
from dynamics.vibration.speed_sweep import SweepSettings, periodic_response
from dynamics.vibration.time_response import run_schedule
from rigdesign import load_case
from rigdesign.case import Case
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import MeshModel, laws_of, mesh_models
from rigdesign.coupling.preloaded_loop import brace_initial
from rigdesign.coupling.state import OperatingPoint
from rigdesign.rig.model import Rig
from tests.builders.twisting import twisting_rig

POINT = OperatingPoint(stage="test", speed=60.0, torque=200.0)
PINION, WHEEL = (f"gearboxes.test.gears.{gear}.flank" for gear in ("pinion", "wheel"))
SHEAR = 206e9 / 2.6


@cache
def loop() -> Case:
    return load_case("cases/loop_1to1").with_value("numerics.response_period", "revolution")


def changed(**values: object) -> Case:
    case = loop()
    for path, value in values.items():
        case = case.with_value(path, value)
    return case


def built(case: Case) -> tuple[Rig, tuple[MeshModel, ...]]:
    rig = twisting_rig(case)
    return rig, mesh_models(rig, POINT, initial_state(rig, POINT))


@cache
def windup() -> float:
    """How far the pinion of the test gearbox is wound up against the motor [rad]: its angle is that much ahead."""
    rig, models = built(loop())
    assert rig.system is not None
    model = port_model(rig.system, laws_of(models))
    state = solve_static(model, LoopLoad(torque=POINT.torque))
    return float(state.ports[:, model.pinions[0]].mean())


def turn(case: Case, steps: int = 28 * 24) -> tuple[np.ndarray, np.ndarray]:
    """Torque [N m] and approach [m] of the test mesh over a slow turn of the motor, twist held, no friction."""
    rig, models = built(case)
    assert rig.system is not None
    model = port_model(rig.system, laws_of(models))
    twist = brace_initial(rig, POINT, initial_state(rig, POINT)).twist
    angles = np.arange(steps) * 2.0 * math.pi / steps
    state = solve_static(
        model, LoopLoad(twist=twist), rotation=SlowRotation(angles=angles)
    )  # at no speed: without friction
    return np.asarray(state.torque[:, 0]), np.asarray(state.approach[:, 0])


def order(wave: np.ndarray, number: int) -> complex:
    """One-sided amplitude x = Re(X exp(i number phi))."""
    return complex(2.0 * np.fft.rfft(wave)[number] / wave.size)


def bar(length: float, diameter: float) -> float:
    """Compliance of a round bar in torsion [rad/(N m)]."""
    return length / (SHEAR * math.pi * diameter**4 / 32.0)


def loop_compliance(models: tuple[MeshModel, ...]) -> float:
    """Twist per torque round the 1:1 loop [rad/(N m)]: lines by hand from the drawing, meshes by their stiffness."""
    pinion_line = 2.0 * bar(0.140, 0.040) + 1.0 / 4e5
    wheel_line = bar(0.070, 0.040) + bar(0.500, 0.026) + bar(0.140, 0.040) + 1.0 / 9e4
    splines = 2.0 / 3e5 + 2.0 / 4e5
    meshes = sum(1.0 / (m.law.mean_stiffness * m.law.base_radius_1**2) for m in models)
    return pinion_line + wheel_line + splines + meshes


def test_run_out_swings_the_torque_by_the_stiffness_of_the_loop() -> None:
    case = changed(**{f"{PINION}.run_out": "40 um", f"{PINION}.run_out_phase": "50 deg"})
    torque, _ = turn(case)
    models = built(case)[1]
    expected = 20e-6 / models[0].law.base_radius_1 / loop_compliance(models)
    assert abs(order(torque, 1)) == pytest.approx(expected, rel=0.02)
    assert np.angle(order(torque, 1)) == pytest.approx(windup() - math.radians(50.0), abs=0.01)


@pytest.mark.parametrize(("gear", "sign"), [("pinion", 1.0), ("wheel", -1.0)])
def test_run_out_on_the_back_flank_turns_by_twice_the_working_angle(gear: str, sign: float) -> None:
    """The reference gearbox carries on its back flanks, on the other line of action: half a turn and 2 alpha_wt."""
    flank = f"gearboxes.reference.gears.{gear}.flank"
    torque, _ = turn(changed(**{f"{flank}.run_out": "40 um", f"{flank}.run_out_phase": "50 deg"}))
    rig, models = built(loop())
    assert rig.system is not None
    law = models[1].law
    model = port_model(rig.system, laws_of(models))
    ahead = float(solve_static(model, LoopLoad(torque=POINT.torque)).ports[:, model.pinions[1]].mean())
    expected = 20e-6 / law.base_radius_1 / loop_compliance(models)
    later = math.radians(50.0) + math.pi + sign * 2.0 * models[1].pair.working_pressure_angle
    found = order(torque, 1)
    assert abs(found) == pytest.approx(expected, rel=0.02)
    assert abs(np.angle(found * np.exp(1j * (later - ahead)))) < 0.01


def test_the_same_teeth_meet_until_the_wheel_is_put_on_further() -> None:
    """Two equal run-outs add up; half a turn further they cancel, a quarter further they are at right angles."""
    both = {f"{PINION}.run_out": "40 um", f"{WHEEL}.run_out": "40 um"}
    amplitude = {
        offset: abs(order(turn(changed(**both, **{"gearboxes.test.meshes.main.tooth_offset": offset}))[0], 1))
        for offset in (0, 7, 14)
    }
    assert amplitude[7] / amplitude[0] == pytest.approx(math.sqrt(0.5), rel=0.01)
    assert amplitude[14] < 0.01 * amplitude[0]


def test_pitch_wave_swings_the_torque_at_its_order() -> None:
    """The place of the teeth changes by steps: the wave is as high as that of a run-out but for the sinc of a step.

    With friction the normal force would swing more: in a soft loop it makes up for what friction takes.
    """
    wave = [{"order": 3, "amplitude": "1 um", "phase": "20 deg"}]
    case = changed(**{f"{PINION}.pitch_waves": wave})
    torque, _ = turn(case)
    models = built(case)[1]
    expected = 1e-6 / models[0].law.base_radius_1 / loop_compliance(models)
    assert abs(order(torque, 3)) == pytest.approx(expected * np.sinc(3 / 28), rel=0.015)
    assert abs(order(torque, 2)) < 0.01 * expected


def test_weak_tooth_gives_way_by_its_share_of_the_stiffness() -> None:
    """In single contact at the pitch point the force goes through the weak pair alone: q k x = F."""
    flat = {f"{flank}.lead_crowning": "0 um" for flank in (PINION, WHEEL)}
    torque, sound = turn(changed(**flat))
    _, weak = turn(changed(**flat, **{f"{PINION}.weak_tooth": {"tooth": 0, "stiffness": 0.7}}))
    assert sound[0] / weak[0] == pytest.approx(0.7, rel=0.03)
    far = slice(28 * 12 - 12, 28 * 12 + 12)
    assert np.abs(weak[far] - sound[far]).max() < 0.02 * sound[0]
    assert torque.min() > 0.0


def test_missing_tooth_is_carried_by_its_neighbours() -> None:
    """The flanks sink until the tips of the neighbours touch; the loop answers as to a run-out of that height."""
    sound_torque, sound = turn(changed())
    torque, sunk = turn(changed(**{f"{PINION}.weak_tooth": {"tooth": 0, "stiffness": 0.0}}))
    models = built(loop())[1]
    per_approach = 1.0 / models[0].law.base_radius_1 / loop_compliance(models)
    assert sunk.max() > 5.0 * sound.max()
    assert not reach_beyond(models[0].law, sunk)
    first = order(torque - sound_torque, 1)
    assert abs(first) == pytest.approx(per_approach * abs(order(sunk - sound, 1)), rel=0.02)


def test_profile_slope_lifts_the_mesh_order_and_its_scatter_the_shaft_orders() -> None:
    plain = turn(changed())[0]
    sloped = turn(changed(**{f"{PINION}.profile_slope": "12 um"}))[0]
    slopes = [f"{12.0 * math.cos(2.0 * math.pi * 2 * i / 28):.6f} um" for i in range(28)]
    scattered = turn(changed(**{f"{PINION}.profile_slope_scatter": slopes}))[0]
    assert abs(order(sloped, 28) - order(plain, 28)) > 0.2 * abs(order(plain, 28))
    assert abs(order(sloped, 2)) < 1e-3 * abs(order(plain, 28))
    sidebands = abs(order(scattered, 26)) + abs(order(scattered, 30))
    assert sidebands > 20.0 * (abs(order(plain, 26)) + abs(order(plain, 30)))


@cache
def swung(method: str, path: str, number: int, torque: float) -> complex:
    """Order of the torque in the test mesh at 200 rad/s, angle counted from the pinion."""
    case = loop().with_value(path, [{"order": number, "torque": f"{torque} N m", "phase": "30 deg"}])
    rig, models = built(case)
    assert rig.system is not None
    twist = brace_initial(rig, POINT, initial_state(rig, POINT)).twist
    found = periodic_response(
        rig.system,
        laws_of(models),
        [200.0],
        LoopLoad(twist=twist),
        settings=SweepSettings(period="revolution", methods=(method,)),
    )
    wave = found.points[0].wave
    start = float(np.mean(wave.angle[0] - 200.0 * wave.time))
    phi = start + 200.0 * wave.time
    return complex(2.0 * np.mean(wave.torque[0] * np.exp(-1j * number * phi)))


EXCITATION = "drivetrain.couplings.wheel_side.excitation"


def test_coupling_out_of_line_swings_the_loop_by_its_own_stiffness() -> None:
    """Torque T in a coupling of stiffness k is a twist T/k in the loop, raised by its first mode at 258 Hz."""
    found = swung("time_integration", EXCITATION, 2, 5.0)
    models = built(loop())[1]
    quasi_static = 5.0 / 9e4 / loop_compliance(models)
    raised = 1.0 / (1.0 - (2.0 * 200.0 / (2.0 * math.pi * 258.0)) ** 2)
    assert quasi_static < abs(found) < 1.5 * raised * quasi_static


def test_run_in_time_swings_as_the_periodic_response() -> None:
    case = loop().with_value(EXCITATION, [{"order": 2, "torque": "5 N m", "phase": "30 deg"}])
    rig, models = built(case)
    assert rig.system is not None
    twist = brace_initial(rig, POINT, initial_state(rig, POINT)).twist
    time = np.array([0.0, 0.8])
    run = run_schedule(
        rig.system,
        laws_of(models),
        Command(time=time, speed=np.full(2, 200.0), twist=np.full(2, twist)),
        motor=MotorDrive(torque_limit=20.0),
        sampling=Sampling(sample_rate=20e3, keep_accounts=False),
    )
    late = run.time > run.time[-1] - 10.0 * 2.0 * math.pi / 200.0
    wave = run.torque[0, late] - run.torque[0, late].mean()
    found = 2.0 * np.mean(wave * np.exp(-2j * 200.0 * run.time[late]))
    assert abs(found) == pytest.approx(abs(swung("time_integration", EXCITATION, 2, 5.0)), rel=0.03)


@pytest.mark.slow
def test_harmonic_balance_and_march_agree_on_swinging_torques() -> None:
    for path, number, torque in ((EXCITATION, 2, 5.0), ("drivetrain.motor.ripple", 6, 2.0)):
        by_harmonics, by_time = (
            swung(m, path, number, torque) for m in ("harmonic_balance", "time_integration")
        )
        assert abs(by_time - by_harmonics) < 0.02 * abs(by_harmonics)


def test_motor_ripple_swings_the_speed_of_the_whole_rig() -> None:
    """Far below the first mode the rig is rigid: amplitude of the speed T / (J k omega)."""
    case = loop().with_value("drivetrain.motor.ripple", [{"order": 1, "torque": "2 N m"}])
    rig, models = built(case)
    assert rig.system is not None
    twist = brace_initial(rig, POINT, initial_state(rig, POINT)).twist
    found = periodic_response(
        rig.system,
        laws_of(models),
        [100.0],
        LoopLoad(twist=twist),
        settings=SweepSettings(period="revolution", methods=("time_integration",)),
    ).points[0]
    speed = abs(order(np.asarray(found.wave.omega_1[0]), 1))
    assert speed == pytest.approx(2.0 / (float(rig.system.inertia.sum()) * 100.0), rel=0.03)
