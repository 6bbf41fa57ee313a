"""Bands of speed that a run passes faster than their bearings move the gears."""

from types import SimpleNamespace

import numpy as np
import pytest

from dynamics.vibration.march_inputs import FADE
from rigdesign.run import warnings as module
from rigdesign.run.warnings import fast_ramps, passed_bands

TIME = np.linspace(0.0, 3.0, 3001)
LIMITS = (100.0, 200.0, 400.0)


def test_a_band_is_passed_where_it_is_entered_at_one_end_and_left_at_the_other() -> None:
    """Up to 500 rad/s in a second, held, down to 300 and up again: the second descent turns back within its band."""
    speed = np.interp(TIME, [0.0, 1.0, 2.0, 2.4, 3.0], [0.0, 500.0, 500.0, 300.0, 500.0])
    found = list(passed_bands(TIME, speed, LIMITS))
    assert [(band.low, band.high) for band in found] == [(100.0, 200.0), (200.0, 400.0)]
    assert [band.duration for band in found] == pytest.approx([0.2, 0.4], abs=2e-3)
    assert [band.start for band in found] == pytest.approx([0.2, 0.4], abs=2e-3)


def test_without_bands_nothing_is_passed() -> None:
    assert not list(passed_bands(TIME, 500.0 * TIME, ()))


def solved(run_up: float, monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Up to 500 rad/s in a time, with a resonance at 150 and one above the bands."""
    monkeypatch.setattr(module, "band_limits", lambda rig, speeds: LIMITS)
    monkeypatch.setattr(module, "own_ratio", lambda rig, mesh: 1.0)
    stages = (
        SimpleNamespace(name="run_up", duration=run_up, speed_end=500.0),
        SimpleNamespace(name="test", duration=3.0 - run_up, speed_end=500.0),
    )
    loads = SimpleNamespace(resonances=[SimpleNamespace(speed=150.0), SimpleNamespace(speed=450.0)])
    schedule = SimpleNamespace(resolved=lambda: stages)
    ramp = SimpleNamespace(time=TIME, speed=np.interp(TIME, [0.0, run_up], [0.0, 500.0]))
    return SimpleNamespace(
        rig=SimpleNamespace(
            case=SimpleNamespace(schedule=schedule),
            mesh_names=("test.main",),
            mesh_labels={"test.main": "test"},
        ),
        run=SimpleNamespace(ramp=ramp),
        loads=SimpleNamespace(meshes={"test": loads}),
    )


def test_a_ramp_faster_than_the_fade_says_time_limit_and_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fifth of 0.3 s in the band of the resonance, 0.1 s wanted: 0.5 s."""
    (text,) = fast_ramps(solved(0.3, monkeypatch))  # type: ignore[arg-type]
    assert text.startswith(
        "stage run_up: time in the band of 955 to 1910 rpm with the resonance of test at 1432 rpm"
    )
    assert "= 0.06 s, limit 0.1 s" in text and "give the stage 0.5 s or more" in text


def test_a_slower_ramp_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not list(fast_ramps(solved(5.2 * FADE, monkeypatch)))  # type: ignore[arg-type]
