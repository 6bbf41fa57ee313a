"""From a record over time to stress over the rolling angle: zero, delay, turns, mating teeth, faults."""

import math

import numpy as np
import pytest

from rigdesign.base.errors import CaseError, MeasurementError
from rigdesign.strain_gauge.gauge import ThermalOutput
from rigdesign.strain_gauge.low_pass import LowPass
from rigdesign.strain_gauge.measuring_point import StrainRecord
from rigdesign.strain_gauge.turn_average import (
    AngleGrid,
    at_constant_speed,
    from_speed,
    turn_average,
    turns_until_same_teeth,
)
from tests.builders.strain_evaluation import Evaluation, lost_in_low_pass, stress_over_angle
from tests.builders.strain_gauge import (
    SPEED,
    bridge,
    gauge,
    measuring_point,
    root_stress,
    wandering_angle,
    wandering_speed,
)
from tests.builders.strain_logger import Amplifier, RootStressHistory, logged
from tests.builders.strain_zero import UnloadedAngles, ZeroReadings

FAR_SIDE = UnloadedAngles(1.5, 5.5)
PLAIN = Amplifier(sample_rate=5000.0)


def test_clean_record_at_constant_speed_comes_back() -> None:
    point, angle = measuring_point(), at_constant_speed(SPEED)
    record = logged(point, RootStressHistory(stress=root_stress, angle=angle), PLAIN, 2.0)
    curve = stress_over_angle(record, point, angle, Evaluation(grid=AngleGrid(points=720)))
    assert curve.turns == 3
    # 5/384 h^4 of the fourth derivative of a Gaussian, 12 / width^4 at its top, is left by the cubic spline: 6 Pa
    left = 5 / 384 * (SPEED / 5000.0) ** 4 * 12 * 125e6 / 0.09**4
    assert np.abs(curve.mean - root_stress(curve.angle)).max() < left < 10.0


def test_run_to_zero_removes_offset_drift_and_thermal_output() -> None:
    sheet = ThermalOutput(coefficients=(-31.8e-6, 2.77e-6, -6.55e-8, 3.28e-10))
    point = measuring_point(bridge=bridge(gauge=gauge(thermal_output=sheet), completion_resistance=120.2))
    warming = RootStressHistory(
        stress=root_stress, angle=at_constant_speed(SPEED), temperature=lambda time: 300.0 + 0.5 * time
    )
    amplifier = Amplifier(sample_rate=5000.0, offset=2e-4, drift=-3e-6)
    record = logged(point, warming, amplifier, 6.0)
    grid = AngleGrid(points=720)
    worst = {}
    for name, zero in (("none", None), ("far side", FAR_SIDE)):
        curve = stress_over_angle(record, point, warming.angle, Evaluation(grid=grid, zero=zero))
        worst[name] = np.abs(curve.mean - root_stress(curve.angle)).max()
    assert worst["none"] > 50e6
    assert worst["far side"] < 0.03e6  # what drifts within a turn, and the bridge's nonlinearity


def test_zero_readings_before_and_after_remove_a_straight_drift() -> None:
    point, angle = measuring_point(), at_constant_speed(SPEED)
    amplifier = Amplifier(sample_rate=5000.0, offset=2e-4, drift=-3e-6)
    record = logged(point, RootStressHistory(stress=root_stress, angle=angle), amplifier, 3.0)
    zero = ZeroReadings((0.0, 3.0), (2e-4, 2e-4 - 9e-6))
    curve = stress_over_angle(record, point, angle, Evaluation(grid=AngleGrid(points=360), zero=zero))
    assert np.abs(curve.mean - root_stress(curve.angle)).max() < 10.0


@pytest.mark.parametrize("kind", ["butterworth", "bessel"])
def test_delay_is_taken_back_at_varying_speed_and_the_rest_is_as_stated(kind: str) -> None:
    """At 1500 rpm through 2 kHz: left late, the curve is wrong by tens of N/mm²; what remains is the stated loss."""
    speed, low_pass = 15.0 * SPEED, LowPass(kind, 4, 2000.0)

    def angle(time: np.ndarray) -> np.ndarray:
        return wandering_angle(time, speed)

    point = measuring_point()
    amplifier = Amplifier(sample_rate=50e3, low_pass=low_pass)
    record = logged(
        point, RootStressHistory(stress=root_stress, angle=angle), amplifier, 6.8
    )  # ~ slow periods
    grid = AngleGrid(points=720)
    late = stress_over_angle(record, point, angle, Evaluation(grid=grid))
    back = stress_over_angle(record, point, angle, Evaluation(grid=grid, low_pass=low_pass))
    true = root_stress(back.angle)
    stated = lost_in_low_pass(true, low_pass, speed)
    assert np.abs(late.mean - true).max() > 15e6
    assert np.abs(back.mean - true).max() == pytest.approx(np.abs(stated).max(), rel=0.05)
    assert np.abs(back.mean - true - stated).max() < 0.03 * np.abs(stated).max()


def test_angle_from_a_recorded_speed() -> None:
    time = np.arange(0.0, 5.0, 1e-3)
    found = from_speed(time, wandering_speed(time), 0.3)(time)
    assert np.abs(found - wandering_angle(time)).max() < 1e-9
    assert np.isnan(from_speed(time, wandering_speed(time))(np.array([-1.0, 9.0]))).all()


def test_turns_of_mating_teeth() -> None:
    assert turns_until_same_teeth(28, 28) == 1
    assert turns_until_same_teeth(16, 24) == 3
    assert turns_until_same_teeth(17, 24) == 24
    with pytest.raises(CaseError, match="teeth = 0: must be at least 1"):
        turns_until_same_teeth(0, 24)


def test_average_by_mating_tooth() -> None:
    """16/24: every third turn the same wheel tooth; its deviation shows in its own mean and in the scatter."""
    angle = np.arange(0.0, 30 * 2 * math.pi + 0.01, 0.01)
    mate = np.floor(angle / (2 * math.pi)).astype(int) % 3
    shape = np.sin(0.5 * np.mod(angle, 2 * math.pi)) ** 4
    curve = turn_average(
        angle, (100.0 + 5.0 * mate) * shape, AngleGrid(points=200, same_teeth_after=turns_until_same_teeth(16, 24))
    )  # fmt: skip
    assert curve.turns == 30
    assert curve.by_mating_tooth[:, 100] == pytest.approx([100.0, 105.0, 110.0], rel=1e-6)
    assert curve.mean[100] == pytest.approx(105.0, rel=1e-6)
    assert curve.scatter[100] == pytest.approx(5.0 * math.sqrt(2 / 3 * 30 / 29), rel=1e-5)


def test_turns_with_missing_samples_are_left_out() -> None:
    angle = np.arange(0.0, 10.05 * 2 * math.pi, 0.01)
    values = np.cos(angle)
    values[(angle > 14.0) & (angle < 14.2)] = math.nan  # in the third turn
    curve = turn_average(angle, values, AngleGrid(points=100))
    assert (curve.turns, curve.left_out) == (9, 1)
    assert curve.mean == pytest.approx(np.cos(curve.angle), abs=1e-6)


def test_one_turn_has_no_scatter() -> None:
    angle = np.arange(-0.05, 2 * math.pi + 0.05, 0.01)
    curve = turn_average(angle, np.cos(angle), AngleGrid(points=100))
    assert curve.turns == 1 and np.isnan(curve.scatter).all()


@pytest.mark.parametrize(
    ("angle", "points", "said"),
    [
        (np.arange(0.0, 6.0, 0.01), 100, "0.953 turns: no whole turn in it; record longer"),
        (np.arange(0.0, 20.0, 0.1), 100, "points = 100: more than the 63 samples of the fastest turn"),
        (np.concatenate([np.arange(0.0, 9.0, 0.1), [3.0]]), 10, "runs backwards or stands still"),
        (np.full(100, math.nan), 10, "no turn is known"),
    ],
)
def test_angle_that_gives_no_curve(angle: np.ndarray, points: int, said: str) -> None:
    with pytest.raises(MeasurementError) as error:
        turn_average(angle, np.zeros_like(angle), AngleGrid(points=points))
    assert said in str(error.value)


def test_samples_missing_in_every_turn() -> None:
    angle = np.arange(0.0, 20.0, 0.01)
    values = np.where(np.mod(angle, 2 * math.pi) < 0.1, math.nan, 1.0)
    with pytest.raises(MeasurementError, match="samples are missing in every one"):
        turn_average(angle, values, AngleGrid(points=10))


@pytest.mark.parametrize("speed", [np.full(10, 0.0), np.full(10, -3.0), np.full(10, math.nan), np.ones(1)])
def test_speed_that_gives_no_angle(speed: np.ndarray) -> None:
    with pytest.raises(MeasurementError, match="speed"):
        from_speed(np.arange(float(len(speed))), speed)


def test_zero_that_cannot_be() -> None:
    with pytest.raises(MeasurementError, match="must be as many"):
        ZeroReadings((0.0, 1.0), (0.0,))
    with pytest.raises(MeasurementError, match="less than a turn"):
        UnloadedAngles(1.0, 9.0)
    record = StrainRecord(np.arange(10.0), np.zeros(10))
    with pytest.raises(MeasurementError, match="no sample there"):
        UnloadedAngles(3.0, 3.1).readings(record.time, np.linspace(0.0, 1.0, 10), record.ratio)


def test_grid_and_duration_that_cannot_be() -> None:
    with pytest.raises(CaseError, match="points = 0: must be at least 1"):
        AngleGrid(points=0)
    with pytest.raises(CaseError, match="same_teeth_after = 0"):
        AngleGrid(points=9, same_teeth_after=0)
    with pytest.raises(CaseError, match="duration = 0 s: must be above 0 s"):
        PLAIN.record(np.zeros_like, 0.0)
