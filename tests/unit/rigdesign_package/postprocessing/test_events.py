"""Events of the prototype at quick fidelity: records, checks, report."""

from dataclasses import replace
from functools import cache
from math import pi
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.case import load_case
from rigdesign.checks.component_overload import checks as overloads
from rigdesign.checks.events import checks
from rigdesign.checks.seats import checks as seat_checks
from rigdesign.postprocessing.curves import Curves, curve_at
from rigdesign.postprocessing.events import overspeed_time, solve_events
from rigdesign.postprocessing.passing_peaks import passing_peaks
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.report.numbers import margin_text, value_text
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import results_document
from rigdesign.results.check import Checks
from rigdesign.results.loads import EventRecord
from rigdesign.results.quantity import Records
from tests.builders.made_run import made_ramp, made_run
from tests.builders.paths import CASES
from tests.builders.report import make_result
from tests.builders.twisting import twisting_rig
from tests.builders.warm_prototype import base

EVENTS = """
[events.broken]
kind = "tooth_loss"
mesh = "test.main"
teeth = 2
monitor = "drivetrain.couplings.pinion_side"
trip_torque = "195 N m"
trip_delay = "1 ms"
brake_torque = "20 N m"
duration = "8 ms"
trip_time_maximum = "4 ms"
coupling_torque_maximum = "200 N m"
bearing_force_maximum = "20 kN"
[events.stop]
kind = "emergency_stop"
stop_time = "3 s"
duration = "10 ms"
standstill_time_maximum = "2.5 s"
[events.fast]
kind = "overspeed"
speed = "13200 rpm"
dynamic_factor_maximum = 1.5
resonance_distance_minimum = 0.001
"""


RPM = pi / 30.0
LOADS: Any = SimpleNamespace()
"""Something there: no check here reads the loads of the meshes."""


@cache
def solved(folder: Path) -> SolvedRig:
    file = folder / "case.toml"
    file.write_text(f'extends = "{CASES / "uhcf_prototype" / "case.toml"}"\n{EVENTS}', encoding="utf-8")
    rig, test = base()
    own = twisting_rig(load_case(file)).with_models(rig.models)
    curve = curve_at(own, test.last, 180.0, (4000.0 * RPM, 12500.0 * RPM))
    curves = Curves(response=curve, others={}, torque=180.0)
    run = made_run(own, [test], made_ramp(own, None), curves)
    return SolvedRig(rig=own, points=[test], run=run, loads=LOADS, events=solve_events(own, run))


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> SolvedRig:
    return solved(tmp_path_factory.mktemp("events"))


def test_lost_teeth_shake_the_loop_and_trip_the_monitor(rig: SolvedRig) -> None:
    broken = rig.events[0]
    peaks = {(peak.place, peak.quantity): peak for peak in broken.peaks}
    mesh = peaks["test.main", "mesh torque"]
    assert mesh.before == pytest.approx(180.0, rel=0.02) and mesh.peak > 1.8 * mesh.before
    section = peaks["test_pinion 148 to 211 mm", "shaft torque"]
    assert abs(section.before) == pytest.approx(180.0, rel=0.03) and section.peak > 1.5 * 180.0
    assert section.shear_stress == pytest.approx(16.0 * section.peak / (pi * 0.04192**3))
    assert section.part == "test_pinion"
    seat = peaks["test.pinion", "seat torque"]
    assert abs(seat.before) == pytest.approx(180.0, rel=0.03) and seat.peak > section.peak
    assert len([1 for _, quantity in peaks if quantity == "bearing force"]) == 8
    assert broken.tripped is not None and 0.0 < broken.tripped < 4e-3
    assert broken.standstill is not None and 0.5 < broken.standstill < 5.0
    assert len(broken.time) == len(broken.curves[0].least) == 400


def test_stop_takes_the_time_it_is_to_take(rig: SolvedRig) -> None:
    stop = rig.events[1]
    assert stop.standstill == pytest.approx(3.0, rel=1e-6)
    assert stop.reversals[0].other_flank == 0.0


def test_on_the_way_down_the_stop_passes_the_torques_of_the_periodic_responses(rig: SolvedRig) -> None:
    """Every place but the motor joint, at a speed of the curve below that of the stop; the seat feels more than the
    shafts beside it."""
    stop, test = rig.events[1], rig.points[0]
    passing = {(peak.place, peak.quantity): peak for peak in stop.passing}
    marched = {(peak.place, peak.quantity) for peak in stop.peaks if peak.quantity != "bearing force"}
    assert set(passing) == marched
    curve = rig.run.curves.response  # type: ignore[union-attr]
    speeds = {round(point.speed / RPM) for point in curve.points}
    for peak in passing.values():
        assert round(peak.speed / RPM) in speeds and peak.speed < 12000.5 * RPM
    mesh = passing["test.main", "mesh torque"]
    assert mesh.peak == max(float(point.maximum[0]) for point in curve.points if point.speed < 12000.5 * RPM)
    at_test = next(point for point in curve.points if round(point.speed / RPM) == 12000)
    assert (
        mesh.peak
        >= float(at_test.maximum[0])
        == pytest.approx(float(test.last.response.maximum[0]), rel=1e-3)
    )  # type: ignore[union-attr]
    assert any("12000 to 4000 rpm" in note for note in stop.notes)
    passed = sum(speed <= 12000 for speed in speeds)
    assert any(f"between its {passed} speeds are not captured" in note for note in stop.notes)


def test_a_torque_without_a_curve_is_solved(rig: SolvedRig) -> None:
    """Half the torque of the test: mean torques are halved."""
    assert rig.run is not None
    point = replace(rig.points[0].point, torque=90.0, speed=1000.0 * RPM)
    peaks, _ = passing_peaks(rig.rig, rig.run, point)
    seat = next(peak for peak in peaks if (peak.place, peak.quantity) == ("test.pinion", "seat torque"))
    assert 90.0 < seat.peak < 180.0 and seat.speed <= 1000.5 * RPM


def test_overspeed_knows_its_factor_and_its_resonance(rig: SolvedRig) -> None:
    fast = rig.events[2]
    quantities = {peak.quantity for peak in fast.peaks}
    assert quantities == {"mesh torque", "coupling torque", "shaft torque", "seat torque", "bearing force"}
    for peak in fast.peaks:
        if peak.quantity == "seat torque":
            assert abs(peak.before) <= peak.peak < 1.2 * abs(peak.before)
    assert 1.0 < fast.dynamic_factor["test.main"] < 1.3
    assert fast.resonance_distance is not None and 0.0 < fast.resonance_distance < 0.1
    assert "order" in fast.resonance


def test_every_stated_limit_is_a_check(rig: SolvedRig) -> None:
    found = {check.id: check.verdict for check in checks(rig) if check.limit is not None}
    assert {check.verdict for check in checks(rig) if check.limit is None} == {"not applicable"}
    assert found == {
        "event.coupling_torque_maximum.broken": "fail",
        "event.bearing_force_maximum.broken": "pass",
        "event.trip_time_maximum.broken": "pass",
        "event.standstill_time_maximum.stop": "fail",
        "event.dynamic_factor_maximum.fast": "pass",
        "event.resonance_distance_minimum.fast": "pass",
    }


def test_the_torque_flange_is_held_in_the_events_and_in_the_stages(rig: SolvedRig) -> None:
    """Its own coupling counts, not the mesh; without an overload its limit stands."""
    (check,) = overloads(rig)
    assert check.value is not None
    coupling = max(
        peak.peak
        for event in rig.events
        for peak in (*event.peaks, *event.passing)
        if (peak.place, peak.quantity) == ("wheel_side", "coupling torque")
    )
    assert (check.id, check.verdict) == ("bought_part_event.torque_flange", "pass")
    assert check.value == pytest.approx(coupling) and check.limit == pytest.approx(400.0)
    assert check.reason.startswith("coupling wheel_side, event broken")
    stated = rig.rig.case.with_values({"limits.bought_parts.torque_flange.overload": "600 N m"})
    higher = replace(rig, rig=replace(rig.rig, case=stated))
    assert next(iter(overloads(higher))).limit == pytest.approx(600.0)
    quiet = replace(rig, events=())
    assert next(iter(overloads(quiet))).verdict == "not applicable"


def test_shafts_and_seats_are_held_in_the_events(rig: SolvedRig) -> None:
    """The loss of teeth governs both, each at its own torque."""
    broken = {(peak.place, peak.quantity): peak for peak in rig.events[0].peaks}
    seats = {one.part: one.torque for one in rig.seat_torques if one.event == "broken"}
    assert seats == {
        gear: broken[gear, "seat torque"].peak
        for gear in ("test.pinion", "test.wheel", "reference.pinion", "reference.wheel")
    }
    case = rig.rig.case.with_values({"limits.strength.shaft_shear_maximum": "20 MPa"})
    limited = replace(rig, rig=replace(rig.rig, case=case))
    check = next(found for found in seat_checks(limited) if found.id == "strength.shaft_shear")
    stresses = [peak.shear_stress for peak in broken.values() if peak.shear_stress is not None]
    assert check.value == pytest.approx(1e-6 * max(stresses)) and check.verdict == "fail"
    assert "event broken" in check.reason


def test_a_monitor_that_does_not_trip_fails_its_limit(rig: SolvedRig) -> None:
    silent = EventRecord(name="broken", kind="tooth_loss", speed=1.0, torque=1.0, what="", untripped=0.008)
    by_id = {check.id: check for check in checks(replace(rig, events=[silent]))}
    check = by_id["event.trip_time_maximum.broken"]
    assert (check.value, check.verdict) == (0.008, "fail")
    assert check.reason.startswith("not within 0.008 s") and value_text(check) == "> 0.008 s"
    assert margin_text(check).startswith("< ")
    assert "&gt; 0.008 s" in report_html(replace(make_result(), checks=Checks([check])))


def test_report_and_results_show_events(rig: SolvedRig) -> None:
    result = replace(make_result(), events=Records(rig.events))
    rows = results_document(result)["events"]
    assert [row["name"] for row in rows] == ["broken", "stop", "fast"]
    assert rows[0]["peaks"][0]["factor"] > 1.8
    page = report_html(result)
    assert 'id="events"' in page
    for text in (
        "2 adjacent teeth of the pinion of test.main lost",
        "The monitor trips after",
        "Nearest resonance",
    ):
        assert text in page
    assert "Torque in couplings and meshes over the event broken" in page
    assert 'id="events"' not in report_html(make_result())


def test_the_report_shows_what_a_stop_passes(rig: SolvedRig) -> None:
    result = replace(make_result(), events=Records([rig.events[1]]))
    (row,) = results_document(result)["events"]
    passing = {(one["place"], one["quantity"]): one for one in row["passing"]}
    peak = next(peak for peak in rig.events[1].passing if peak.place == "pinion_side")
    assert passing["pinion_side", "coupling torque"]["peak_Nm"] == pytest.approx(peak.peak)
    assert passing["pinion_side", "coupling torque"]["speed_rpm"] == pytest.approx(peak.speed / RPM)
    page = report_html(result)
    assert "Highest torque during run-down" in page


def test_limits_of_a_stop_count_what_it_passes(rig: SolvedRig) -> None:
    case = rig.rig.case.with_values({"events.stop.shaft_torque_maximum": "900 N m"})
    by_id = {check.id: check for check in checks(replace(rig, rig=replace(rig.rig, case=case)))}
    check = by_id["event.shaft_torque_maximum.stop"]
    stop = rig.events[1]
    marched = max(peak.peak for peak in stop.peaks if peak.quantity == "shaft torque")
    passed = max(peak.peak for peak in stop.passing if peak.quantity == "shaft torque")
    assert check.value == pytest.approx(max(marched, passed)) and passed > marched
    assert "during run-down at" in check.reason


def test_overspeed_is_marched_for_two_turns_of_the_slowest_shaft(rig: SolvedRig) -> None:
    """20 ms hold two turns of all shafts at 13,200 rpm, but not those of a shaft at 3000 rpm: 40 ms."""
    assert rig.rig.drivetrain is not None
    ratio = min(abs(rig.rig.shaft_speed(shaft.name, 1.0)) for shaft in rig.rig.drivetrain.shafts)
    assert overspeed_time(rig.rig, 13200.0 * RPM) == 0.02
    assert overspeed_time(rig.rig, 3000.0 * RPM / ratio) == pytest.approx(0.04)
