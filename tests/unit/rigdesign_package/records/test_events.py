"""Events of the prototype at quick fidelity: records, checks, report."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from rigdesign.case import load_case
from rigdesign.checks.events import checks
from rigdesign.records.events import solve_events
from rigdesign.records.solved_rig import SolvedRig
from rigdesign.report.pages.report import report_html
from rigdesign.report.results_json import results_document
from rigdesign.results.events import EventRecord
from rigdesign.results.rows.events import event_row
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from tests.builders.report import make_result
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


@cache
def solved(folder: Path) -> SolvedRig:
    file = folder / "case.toml"
    file.write_text(f'extends = "{CASES / "uhcf_prototype" / "case.toml"}"\n{EVENTS}', encoding="utf-8")
    rig, test = base()
    own = build_rig(load_case(file), "quick").with_models(rig.models)
    return SolvedRig(rig=own, points=[test], events=solve_events(own, test))


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> SolvedRig:
    return solved(tmp_path_factory.mktemp("events"))


def test_lost_teeth_shake_the_loop_and_trip_the_monitor(rig: SolvedRig) -> None:
    broken = rig.events[0]
    peaks = {(peak.place, peak.quantity): peak for peak in broken.peaks}
    mesh = peaks["test.main", "mesh torque"]
    assert mesh.before == pytest.approx(180.0, rel=0.02) and mesh.peak > 1.8 * mesh.before
    section = peaks["test_pinion section 3", "shaft torque"]
    assert abs(section.before) == pytest.approx(180.0, rel=0.03) and section.peak > 1.5 * 180.0
    assert len([1 for _, quantity in peaks if quantity == "bearing force"]) == 8
    assert broken.tripped is not None and 0.0 < broken.tripped < 4e-3
    assert broken.standstill is not None and 0.5 < broken.standstill < 5.0
    assert len(broken.time) == len(broken.curves[0].least) == 400


def test_stop_takes_the_time_it_is_to_take(rig: SolvedRig) -> None:
    stop = rig.events[1]
    assert stop.standstill == pytest.approx(3.0, rel=1e-6)
    assert stop.reversals[0].other_flank == 0.0


def test_overspeed_knows_its_factor_and_its_resonance(rig: SolvedRig) -> None:
    fast = rig.events[2]
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


def test_a_monitor_that_does_not_trip_fails_its_limit(rig: SolvedRig) -> None:
    silent = EventRecord(name="broken", kind="tooth_loss", speed=1.0, torque=1.0, what="", untripped=0.008)
    by_id = {check.id: check for check in checks(replace(rig, events=[silent]))}
    check = by_id["event.trip_time_maximum.broken"]
    assert (check.value, check.verdict) == (0.008, "fail")
    assert "no crossing" in check.reason


def test_report_and_results_show_events(rig: SolvedRig) -> None:
    result = replace(make_result(), events=[event_row(record) for record in rig.events])
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
