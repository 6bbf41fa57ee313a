"""Narrow peaks of the torque of a section between the speeds of a curve, found by solving at more of them."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rigdesign.postprocessing import run_torques as module
from rigdesign.postprocessing.run_torques import torques_over_speed
from rigdesign.results.vibration import TorquePlace, TorqueSwing

SHAFT, BROAD = TorquePlace(kind="shaft", part="a", start=0.0, end=0.1), TorquePlace(kind="coupling", part="b")
AT, HALF_WIDTH, TALL = 1103.3, 11.0, 300.0
"""Peak of the shaft: speed, half width of half its torque, and torque [N m]; that of the coupling is broad."""


class Loop:
    """Torques that are known: a resonance as of one mode in the shaft, a broad rise in the coupling."""

    shear_per_torque: Mapping[str, float] = {"a 0 to 100 mm": 8e4}

    def swings(self, point: Any) -> dict[TorquePlace, TorqueSwing]:
        narrow = TALL / (1.0 + ((point.speed - AT) / HALF_WIDTH) ** 2)
        broad = 40.0 / (1.0 + ((point.speed - 700.0) / 400.0) ** 2)
        return {
            place: TorqueSwing(mean=180.0, half_peak_to_peak=half, peak=180.0 + half)
            for place, half in ((SHAFT, narrow), (BROAD, broad))
        }


def points(speeds: Sequence[float]) -> Any:
    return [SimpleNamespace(speed=float(speed), mean=[180.0]) for speed in speeds]


def test_a_narrow_peak_is_found_between_the_speeds_of_the_curve() -> None:
    """Steps of 57 rpm miss it; speeds expected from three points meet it. A broad one costs a handful of speeds."""
    coarse = points(range(500, 1500, 57))
    asked: list[float] = []

    def solve(speeds: Sequence[float]) -> Any:
        assert list(speeds) == sorted(speeds)
        asked.extend(speeds)
        return SimpleNamespace(points=points(speeds))

    loop: Any = Loop()
    found, curves = torques_over_speed(loop, coarse, solve)
    shaft = next(curve for curve in curves if curve.place == SHAFT)
    before = max(loop.swings(point)[SHAFT].half_peak_to_peak for point in coarse)
    highest = max(swing.half_peak_to_peak for swing in shaft.swings)
    assert before < 0.2 * TALL and highest == pytest.approx(TALL, rel=1e-3)
    speeds = [point.speed for point in found]
    assert speeds == sorted(speeds) and {point.speed for point in coarse} < set(speeds)
    assert len(shaft.swings) == len(found) < len(coarse) + 4
    print(asked, highest)
    assert len(asked) <= 9
    assert shaft.shear_per_torque == 8e4


def test_without_a_solver_the_curve_is_what_it_is() -> None:
    loop: Any = Loop()
    coarse = points(range(500, 1500, 57))
    found, curves = torques_over_speed(loop, coarse, None)
    assert [point.speed for point in found] == [point.speed for point in coarse]
    assert {curve.place for curve in curves} == {SHAFT, BROAD}


def test_no_points_give_no_curves() -> None:
    loop: Any = Loop()
    assert torques_over_speed(loop, [], None) == ((), ())


def test_of_two_dwells_around_a_speed_the_nearer_gives_the_loop(monkeypatch: pytest.MonkeyPatch) -> None:
    """930 rad/s lies within a fifth of dwells at 800 and 1000 rad/s: its loop is that of 1000."""
    asked: list[str] = []

    def swings_of(system: str, *_: object) -> Any:
        asked.append(system)
        return SimpleNamespace(rows=None, over_period=lambda point, drags: np.zeros((0, 1)))

    monkeypatch.setattr(module, "section_torques", swings_of)
    monkeypatch.setattr(module, "twist_rows_of", lambda *_: None)
    monkeypatch.setattr(module, "section_swings", lambda *_: ())
    monkeypatch.setattr(module, "dwell_speeds", lambda rig: (800.0, 1000.0))
    monkeypatch.setattr(module.LoopOverSpeed, "_laws", lambda self: ())
    rig: Any = SimpleNamespace(pinion_speed=lambda speed: speed, mesh_names=())
    states: Any = [SimpleNamespace(speed=speed, system=f"at {speed:.0f}") for speed in (800.0, 1000.0)]
    loop = module.LoopOverSpeed(rig, SimpleNamespace(drags={}), states)  # type: ignore[arg-type]
    for speed in (930.0, 830.0):
        loop.swings(points([speed])[0])
    assert asked == ["at 1000", "at 800"]
