"""Speeds of a curve: every resonance that a mesh excites is met, however narrow, whatever the steps between."""

from collections.abc import Sequence
from dataclasses import replace

import pytest

from dynamics.vibration.response_curve import ResponseCurve
from rigdesign.base.fidelity import Fidelity
from rigdesign.postprocessing import curves
from rigdesign.postprocessing.curves import dwell_speeds, is_around
from tests.builders.solved_loop import solved


@pytest.mark.parametrize("fidelity", ["quick", "standard"])
def test_a_resonance_that_a_mesh_excites_is_met_around_a_dwell(
    fidelity: Fidelity, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of shafts that damp themselves alone they are narrower than a step of the dense grid: at standard a rig passed
    that dwelt beside one, which quick had met."""
    rig, run = replace(solved().rig, fidelity=fidelity), solved().run
    assert run is not None
    asked: list[float] = []

    def solver(*_: object) -> object:
        def solve(speeds: Sequence[float]) -> ResponseCurve:
            asked.extend(speeds)
            return ResponseCurve(points=(), failed=())

        return solve

    monkeypatch.setattr(curves, "response_solver", solver)
    ((torque, limits), *_) = curves.speed_ranges(rig).items()
    warm = run.test.last
    curves.curve_at(rig, warm, torque, limits)
    dwells = [rig.pinion_speed(speed) for speed in dwell_speeds(rig)]
    met = [
        (speed, width)
        for speed, width in curves.resonance_speeds(rig, warm, min(asked), max(asked))
        if any(is_around(speed, dwell) for dwell in dwells)
    ]
    assert any(width < 0.01 * speed for speed, width in met)
    assert {speed for speed, _ in met} <= set(asked)
