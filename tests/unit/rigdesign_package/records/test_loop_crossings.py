"""Crossings of the closed loop in results, report and the check of the resonance distance."""

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
    assert (first["mode"], first["frequency_Hz"]) == (0, 0.0)
    assert [row["mode"] for row in swinging] == list(range(1, len(swinging) + 1))
    assert all(row["largest_at"] and 0.0 < row["damping_ratio"] < 1.0 for row in swinging)


def test_mesh_and_shaft_orders_meet_the_modes_of_the_loop() -> None:
    dynamics = hunting().dynamics
    assert dynamics is not None
    assert {row["order_of"] for row in dynamics.loop_crossings} == {"test", "reference"}
    modes = {row["mode"]: row for row in dynamics.natural_frequencies}
    case = load_case(CASES / "loop_hunting")
    teeth = {name: box.gears["pinion"].teeth for name, box in case.gearboxes.items()}
    for row in dynamics.loop_crossings:
        cycles = teeth[row["order_of"]] if row["kind"] == "mesh" else 1
        met = row["speed_rpm"] / 60.0 * cycles * row["harmonic"]
        assert met == pytest.approx(modes[row["mode"]]["frequency_Hz"], rel=1e-9)


def test_the_distance_names_the_mode_of_the_loop_nearest_to_the_held_speed() -> None:
    """Mode 2 of the loop meets the mesh at 2420 rpm, 3 % below the held speed; it holds three shafts, and the coarse
    curve of a quick run does not resolve it."""
    result = hunting()
    assert result.dynamics is not None
    check = next(check for check in result.checks if check.id == "dynamics.resonance_distance.test")
    assert "closed loop that the mesh excites: mode 2 (" in check.reason and "3.1 % away" in check.reason
    assert check.verdict != "pass" and "loop's modes 2" in check.left_out[0]


def test_the_report_shows_the_crossings_of_the_loop() -> None:
    page = report_html(hunting())
    assert "Mesh orders that meet a mode of the closed loop" in page
    assert "Up to the highest speed of the curves no shaft order meets a mode of the closed loop." in page
