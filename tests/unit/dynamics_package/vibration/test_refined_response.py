"""Points put in where the response over speed bends."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.vibration.response_curve import ResponseCurve, point_in_time
from dynamics.vibration.speed_sweep import refined_response
from dynamics.vibration.steady_motion import PERIODIC

NARROW = 3.0
"""Half width of the resonance below [rad/s], half of the first grid's step."""


def factor(speed: float) -> float:
    return float(1.05 + 0.6 / (1.0 + ((speed - 239.2) / NARROW) ** 2))


class Solver:
    """Stands for the periodic response: one mesh calm, one with a narrow peak; counts what it is asked."""

    def __init__(self, hole: tuple[float, float] = (0.0, 0.0)) -> None:
        self.asked: list[float] = []
        self.hole = hole

    def __call__(self, speeds: Sequence[float]) -> ResponseCurve:
        assert list(speeds) == sorted(speeds)
        self.asked += speeds
        points: list[Any] = []
        failed = []
        for speed in speeds:
            if self.hole[0] < speed < self.hole[1]:
                failed.append((speed, "no solution"))
                continue
            values = np.array([1.1, factor(speed)])
            points.append(SimpleNamespace(speed=speed, dynamic_factor_half_peak_to_peak=values))
        return ResponseCurve(points=tuple(points), failed=tuple(failed))


def test_a_narrow_peak_is_not_cut_off() -> None:
    grid = np.arange(50.0, 1250.1, 6.0)
    coarse, fine = Solver(), Solver()
    seen = max(p.dynamic_factor_half_peak_to_peak[1] for p in coarse(list(grid)).points)
    curve = refined_response(fine, grid)
    found = max(p.dynamic_factor_half_peak_to_peak[1] for p in curve.points)
    assert 1.65 - seen > 0.1
    assert found == pytest.approx(1.65, abs=0.02)
    assert list(curve.speeds) == sorted(set(curve.speeds))
    assert len(fine.asked) == len(set(fine.asked)) < grid.size + 30


def test_a_straight_curve_asks_for_nothing_more() -> None:
    solver = Solver()
    refined_response(solver, [600.0, 700.0, 800.0, 900.0])
    assert len(solver.asked) == 4


def test_speeds_without_solution_are_asked_once_and_kept() -> None:
    solver = Solver(hole=(235.0, 240.0))
    curve = refined_response(solver, np.arange(50.0, 400.0, 6.0))
    assert len(solver.asked) == len(set(solver.asked))
    assert all(235.0 < speed < 240.0 for speed, _ in curve.failed) and curve.failed


def test_a_period_marched_in_time_keeps_the_rate_of_approach() -> None:
    """The wheel turns as far behind the pinion as the approach changes: r_1 omega_1 - r_2 omega_2 is its rate."""
    radius_1, radius_2 = 0.04, 0.05
    time = np.arange(1, 65) / 64e3
    phase = 2.0 * np.pi * 1e3 * time
    result: Any = SimpleNamespace(
        time=time, angle_1=100.0 * time[None], omega_1=np.full((1, 64), 100.0),
        approach=1e-6 * np.sin(phase)[None], approach_rate=2e-3 * np.pi * np.cos(phase)[None],
        torque=np.full((1, 64), 50.0), force=np.ones((1, 64)), friction_loss=np.zeros(1),
        mesh_damping_loss=np.zeros(1), speed=100.0, residual=0.0, periods=1, twist=0.0, drive_torque=0.0,
        motion=PERIODIC,
    )  # fmt: skip
    model: Any = SimpleNamespace(base_radii=np.array([[radius_1, radius_2]]))
    wave = point_in_time(model, result, 1).wave
    assert radius_1 * wave.omega_1 - radius_2 * wave.omega_2 == pytest.approx(result.approach_rate, abs=1e-12)
