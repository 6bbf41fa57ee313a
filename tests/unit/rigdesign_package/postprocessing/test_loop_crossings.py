"""Crossings of the closed loop in results, report and the check of the resonance distance."""

import math
from functools import cache

import pytest

from rigdesign import load_case
from rigdesign.report.pages.report import report_html
from rigdesign.results.result import RunResult
from tests.builders.paths import CASES
from tests.builders.shared_runs import quick_run


@cache
def hunting() -> RunResult:
    return quick_run("loop_hunting")


def test_modes_say_where_they_are_largest() -> None:
    dynamics = hunting().dynamics
    assert dynamics is not None
    first, *swinging = dynamics.natural_frequencies
    assert (first.mode, first.frequency) == (0, 0.0)
    assert [row.mode for row in swinging] == list(range(1, len(swinging) + 1))
    assert all(row.largest_at and 0.0 < row.damping_ratio < 1.0 for row in swinging)


def test_mesh_and_shaft_orders_meet_the_modes_of_the_loop() -> None:
    dynamics = hunting().dynamics
    assert dynamics is not None
    case = load_case(CASES / "loop_hunting")
    cycles: dict[tuple[str, str], float] = {}
    for name, box in case.gearboxes.items():
        cycles["mesh", name] = box.gears["pinion"].teeth
        cycles |= {("shaft", f"{name}_{gear}"): 1.0 for gear in box.gears}  # at the shaft's own speed
    assert {(row.kind, row.order_of) for row in dynamics.loop_crossings} == set(cycles)
    modes = {row.mode: row for row in dynamics.natural_frequencies}
    for row in dynamics.loop_crossings:
        met = row.speed / (2.0 * math.pi) * cycles[row.kind, row.order_of] * row.harmonic
        assert met == pytest.approx(modes[row.mode].frequency, rel=1e-9)


def test_the_distance_names_the_mode_of_the_loop_nearest_to_the_held_speed() -> None:
    """Bending of the pinion shaft meets the mesh at 2430 rpm, 3 % below the held speed; the curve has a peak there, too
    small to be dangerous: the next that is stands 20 % away."""
    result = hunting()
    assert result.dynamics is not None
    check = next(check for check in result.checks if check.id == "dynamics.resonance_distance.test")
    assert check.value == pytest.approx(0.199, abs=0.004) and check.verdict == "pass"
    assert "closed loop that the mesh excites: mode 37 (test_pinion bending" in check.reason
    assert "2.7 % away" in check.reason


def test_the_report_shows_the_crossings_of_the_loop() -> None:
    page = report_html(hunting())
    assert "Mesh orders that meet a mode of the closed loop" in page
