"""Points put in where the response over speed bends."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics.response.speed_sweep import ResponseCurve, refined_response

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
