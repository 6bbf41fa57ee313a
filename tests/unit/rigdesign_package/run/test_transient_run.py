"""The thermal course of the prototype with given losses, at quick: one run, read from all sides."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.cli import exit_status as ending
from rigdesign.cli import main as cli
from rigdesign.properties.oil import MIL_PRF_23699
from rigdesign.report.results_json import results_document
from rigdesign.report.writing import write_results
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import TransientCurve, TransientResult
from rigdesign.run.main import run_case
from tests.builders.paths import CASES

pytestmark = pytest.mark.whole_run

BASE = (CASES / "uhcf_prototype" / "given_losses.toml").as_posix()
COURSE = f"""
extends = "{BASE}"
name = "course"
title = "course"
[transient]
warm_up = "1 h"
dwell = "60 h"
oil_run_on = "10 min"
soak_back = "1 h"
events = ["oil_loss"]
tolerance = "1 K"
probes.lid = {{ gearbox = "test", place = "outer_warm", quantity = "max" }}
"""
COARSE = {"gearboxes.test.housing.mesh.walls": "53 mm", "gearboxes.test.housing.mesh.field": "250 mm"}
"""About twice the usual sizes, for the thermal history and the steady state it is held against."""
WITHOUT_HOUSING = COURSE.replace("probes.lid", "# ") + '[gearboxes.test]\nremove = ["housing"]\n'


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    file = tmp_path_factory.mktemp("case") / "case.toml"
    file.write_text(COURSE)
    return run_case(load_case(file).with_values(COARSE), "quick", transient=True)


@pytest.fixture(scope="module")
def course(result: RunResult) -> TransientResult:
    assert result.transient is not None
    return result.transient


@pytest.fixture(scope="module")
def planned(course: TransientResult) -> TransientCurve:
    return next(curve for curve in course.curves if curve.branch == "schedule")


def last(curve: TransientCurve, phase: str) -> int:
    return max(i for i, name in enumerate(curve.phase) if name == phase)


def test_energy_is_conserved(course: TransientResult) -> None:
    assert course.energy_closure < 1e-8
    assert course.missed_temperature_K <= 0.5


def test_the_dwell_ends_in_the_coupled_steady_state(result: RunResult, planned: TransientCurve) -> None:
    """Two ways to one state: fixed oil temperatures found by the coupling, oil as an unknown of the heat model."""
    at = last(planned, "test")
    (steady,) = result.thermal
    for body, entry in steady.bodies.items():
        assert planned.temperatures_degC[body][at] == pytest.approx(entry.mean - 273.15, abs=0.3)
    outlets = {row.consumer: row.outlet - 273.15 for row in result.oil}
    for oil in ("gear_oil", "bearing_oil"):
        found = planned.temperatures_degC[f"{oil}_outlet"][at]
        assert found == pytest.approx(outlets[f"test.{oil}"], abs=0.3)
    (expansion,) = result.expansion
    backlash = planned.clearances_mm["backlash"]["test.main"][at]
    assert backlash == pytest.approx(expansion.gears[0]["backlash_hot_mm"], abs=5e-4)
    for seal in expansion.seal_gaps:
        assert planned.clearances_mm["seal_gap"][seal["seal"]][at] == pytest.approx(
            seal["hot_min_mm"], abs=1e-3
        )
    for bearing in expansion.bearings:
        warm = 1e3 * planned.clearances_mm["bearing_clearance"][bearing["bearing"]][at]
        assert warm == pytest.approx(bearing["diametral_clearance_hot_um"], abs=0.5)


def test_the_power_of_heaters_and_cooler_ends_at_the_steady_one(
    result: RunResult, course: TransientResult
) -> None:
    """At the end of the dwell what the coupled run has; no oil runs before the start and during the soak-back."""
    power = next(curve for curve in course.oil_power if curve.branch == "schedule")
    at = max(i for i, name in enumerate(power.phase) if name == "test")
    (steady,) = result.cooler
    streams = {row.consumer: row.heat for row in result.oil}
    for name, heat in streams.items():
        assert power.streams_W[name][at] == pytest.approx(heat, rel=0.02, abs=30.0)
    assert power.heater_W[at] == pytest.approx(steady.heater, rel=0.02)
    assert power.cooler_W[at] == pytest.approx(steady.cooler, rel=0.02)
    assert power.heater_W[0] == power.cooler_W[0] == 0.0
    soaking = [i for i, name in enumerate(power.phase) if name == "soak_back"]
    assert {power.heater_W[i] for i in soaking} == {power.cooler_W[i] for i in soaking} == {0.0}


def test_the_warm_up_asks_more_of_the_heater_than_the_steady_rig(
    result: RunResult, course: TransientResult, planned: TransientCurve
) -> None:
    """Cold walls and journals take rho c Q (T_in - T_out) of both oils: by hand from the outlets at the first step."""
    worst = next(row for row in course.worst if row.quantity == "heater_power" and row.planned)
    assert (worst.branch, worst.phase, worst.unit) == ("schedule", "warm_up", "kW")
    assert worst.steady is not None and worst.value > 2.0 * worst.steady
    at = planned.time_s.index(worst.time_s)
    assert at < 5
    by_hand = {}
    for stream, inlet, flow in (("gear_oil", 140.0, 5.0), ("bearing_oil", 40.0, 4 * 2.0)):
        outlet = planned.temperatures_degC[f"{stream}_outlet"][at]
        mean = MIL_PRF_23699.heat_capacity(273.15 + 0.5 * (inlet + outlet))
        carried = MIL_PRF_23699.density(273.15 + inlet) * flow / 6e4 * mean
        by_hand[stream] = 1e-3 * carried * (inlet - outlet)
    assert by_hand["gear_oil"] == pytest.approx(6.7, abs=0.1)
    assert worst.value == pytest.approx(sum(by_hand.values()), rel=0.03)
    assert worst.place == "test.gear_oil"
    checks = {check.id: check for check in result.checks}
    found = checks["transient.heater_power"]
    assert (found.value, found.limit, found.verdict) == (worst.value, 3.0, "fail")
    assert "warm_up" in found.reason
    assert checks["oil.heater"].verdict != "fail"
    assert checks["transient.cooler_power"].verdict != "fail"


def test_the_cold_rig_has_its_cold_clearances(result: RunResult, planned: TransientCurve) -> None:
    """The first entry: everything at ambient temperature and at rest."""
    (expansion,) = result.expansion
    assert planned.temperatures_degC["housing"][0] == pytest.approx(20.0, abs=1e-9)
    assert planned.clearances_mm["backlash"]["test.main"][0] == pytest.approx(
        expansion.gears[0]["backlash_cold_mm"], abs=1e-6
    )
    for seal in expansion.seal_gaps:
        assert planned.clearances_mm["seal_gap"][seal["seal"]][0] == pytest.approx(seal["cold_mm"], abs=1e-6)


def test_the_gears_lead_the_box(course: TransientResult) -> None:
    """Backlash is least soon after full torque, not in the steady state; it settles long before the field."""
    worst = next(row for row in course.worst if row.quantity == "backlash" and row.planned)
    assert worst.steady is not None and worst.value < worst.steady - 1e-3
    assert (worst.branch, worst.phase) == ("schedule", "test")
    assert 3600.0 < worst.time_s < 2.5 * 3600.0
    settled = {row.quantity: row.settled_after_s for row in course.settling}
    assert settled["field"] is not None and settled["backlash"] is not None
    assert settled["field"] > 5.0 * 3600.0
    assert settled["backlash"] < 0.1 * settled["field"]


def test_losing_the_oil_heats_the_films(course: TransientResult) -> None:
    loss = next(curve for curve in course.curves if curve.branch == "oil_loss")
    films = [name for name in loss.temperatures_degC if name.startswith("film_outlet_")]
    for name in films:
        values = loss.temperatures_degC[name]
        assert max(values) > values[0] + 10.0
    assert loss.time_s[0] == pytest.approx(3600.0 + 60.0 * 3600.0 + 10.5)
    assert loss.speed_rpm[0] == pytest.approx(12000.0) and loss.speed_rpm[-1] == 0.0


def test_without_oil_and_losses_the_rig_cools_and_evens_out(planned: TransientCurve) -> None:
    """Soak-back: the hottest place falls, the spread between gears and housing closes, the oil is still air."""
    start, end = last(planned, "oil_run_on"), last(planned, "soak_back")
    temperatures = planned.temperatures_degC
    spread = np.array(temperatures["gear_test_pinion"]) - np.array(temperatures["housing"])
    assert abs(spread[end]) < 0.5 * abs(spread[start])
    assert temperatures["gear_test_pinion"][end] < temperatures["gear_test_pinion"][start]
    assert 20.0 < temperatures["housing"][end] < temperatures["housing"][start]


def test_checks_and_notes_know_of_it(result: RunResult) -> None:
    ids = {check.id: check for check in result.checks}
    assert {"transient.seal_gap", "transient.backlash", "transient.soak.test"} <= set(ids)
    assert any(text.startswith("over time: losses") for text in result.not_modelled)
    assert not any(text.startswith("temperature over time:") for text in result.not_modelled)
    decided = [entry for entry in result.assumptions if "transient.seal_gap" in entry.decides]
    assert decided
    assert "transient" in result.timings_s


def test_json_report_and_curves_hold_it(result: RunResult, tmp_path: Path) -> None:
    document: dict[str, Any] = json.loads(json.dumps(results_document(result)))["transient"]
    assert {"quantity", "value", "unit", "time_s"} <= set(document["worst"][0])
    write_results(result, tmp_path)
    text = (tmp_path / "curves" / "transient_test_schedule.csv").read_text()
    rows = list(csv.DictReader(text.splitlines()))
    assert len(rows) == len(document["curves"][0]["time_s"])
    assert float(rows[0]["housing [degC]"]) == pytest.approx(20.0)
    assert {"lid [degC]", "seal_gap test_pinion_front [mm]"} <= set(rows[0])
    page = (tmp_path / "report.html").read_text()
    assert "Over the schedule and its events" in page and "warm-up before test" in page
    assert page.count("Temperatures and clearances of gearbox test over the thermal history") == 2


def test_a_rig_without_a_housing_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "case.toml"
    file.write_text(WITHOUT_HOUSING)
    arguments = ["check", str(file), "--fidelity", "quick", "--transient", "--json"]
    status = ending.exit_status(lambda: cli.app(arguments, result_action="return_value"))
    document = json.loads(capsys.readouterr().out)
    assert status in (0, 1)
    assert document["transient"] is None
    assert any(
        row["id"] == "transient" and "no gearbox has a housing" in row["text"] for row in document["warnings"]
    )


def test_alignment_starts_straight_and_ends_in_the_steady_state(
    result: RunResult, course: TransientResult, planned: TransientCurve
) -> None:
    at = last(planned, "test")
    (expansion,) = result.expansion
    for row in expansion.bores:
        tilt, share = (
            planned.alignment[key][row["bearing"]] for key in ("bearing_tilt_mrad", "bore_out_of_round")
        )
        assert (tilt[0], share[0]) == (pytest.approx(0.0, abs=1e-6), pytest.approx(0.0, abs=1e-6))
        assert tilt[at] == pytest.approx(row["tilt_mrad"], abs=2e-3)
        assert share[at] == pytest.approx(row["out_of_round_share"], abs=2e-3)
    worst = next(moment for moment in course.worst if moment.quantity == "bearing_tilt")
    assert worst.steady is not None and worst.value >= worst.steady - 2e-3
