"""A rig that mixes plain and rolling bearings, and the FZG bearings beside hand values.

One run at quick fidelity: test gearbox fed with oil, its pinion on a small NU 206 and an NJ 406, its wheel on a plain
bearing with given losses and a locating 6306; slave gearbox on NU 406 and NJ 406 that live on splash; both dip.
"""

import json
import math
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from rigdesign import load_case
from rigdesign.report.results_json import results_document
from rigdesign.results.result import RunResult
from rigdesign.run.main import run_case
from tests.builders.fzg_case import BEARINGS
from tests.builders.rolling_rig import FED, SPLASH, rolling_case

OTHERS = {"test.pinion_front": "NU 206", "test.wheel_rear": "6306"}
"""Ends of the shafts of the test gearbox that differ from the other end."""

pytestmark = [pytest.mark.whole_run, pytest.mark.slow]  # a minute; the FZG rig runs its bearings in every run


@cache
def mixed() -> RunResult:
    with TemporaryDirectory() as folder:
        path = rolling_case(
            Path(folder), test_oil=FED, slave_oil=SPLASH, plain=("test.wheel_front",), others=OTHERS
        )
        return run_case(load_case(path), fidelity="quick")


def test_a_mixed_rig_closes_its_heat() -> None:
    (balance,) = mixed().cooler
    assert abs(balance.imbalance) < 2e-3 * balance.losses
    assert all(abs(found.closure_relative) < 1e-6 for found in mixed().thermal)
    rows = {row.bearing: row for row in mixed().rolling_bearings}
    assert sorted(rows) == [
        "slave.pinion_front", "slave.pinion_rear", "slave.wheel_front", "slave.wheel_rear",
        "test.pinion_front", "test.pinion_rear", "test.wheel_rear",
    ]  # fmt: skip
    assert all(
        row.heat_to_shaft == row.heat_to_housing == 0.0 for name, row in rows.items() if "slave" in name
    )
    losses = {row.place: row for row in mixed().losses if row.kind == "bearing" and row.stage == "test"}
    assert losses["test.wheel_front"].basis == "input" and losses["test.wheel_front"].into_body == 0.0
    assert 0.0 < losses["test.pinion_front"].into_body < losses["test.pinion_front"].power


def test_each_end_of_a_shaft_runs_on_its_own_bearing() -> None:
    """The friction of the 6306 enters its own seats; the plain bearing at the other end of its shaft has none."""
    rows = {row.bearing: row for row in mixed().rolling_bearings}
    front, rear, ball = (rows[f"test.{name}"] for name in ("pinion_front", "pinion_rear", "wheel_rear"))
    assert (front.designation, rear.designation, ball.designation) == (
        "NU 206 ECP",
        "NJ 406",
        "6306",
    )
    share = front.radial_load / rear.radial_load
    assert share == pytest.approx(1.0, abs=2e-3)  # gear in the middle; the weight of the shaft is not
    assert front.basic_life / rear.basic_life == pytest.approx((44.0 / 60.5 / share) ** (10 / 3), rel=1e-6)
    into_seats = ball.heat_to_shaft + ball.heat_to_housing
    losses = {row.place: row for row in mixed().losses if row.kind == "bearing" and row.stage == "test"}
    assert 0.0 < into_seats < losses["test.wheel_rear"].power
    assert all(row.tilting_stiffness > 0.0 for row in rows.values())


def test_rows_stand_in_the_document_and_add_up() -> None:
    document = json.loads(json.dumps(results_document(mixed())))
    for row in document["rolling_bearings"]:
        torque = math.fsum(row[f"{part}_torque_Nm"] for part in ("rolling", "sliding", "seal", "drag"))
        assert row["friction_W"] == pytest.approx(torque * row["speed_rpm"] * math.pi / 30.0, rel=1e-9)


def test_checks_of_both_kinds_stand_side_by_side() -> None:
    checks = {check.id: check for check in mixed().checks}
    life = checks["bearing.rating_life"]
    assert (life.limit, life.unit) == (300.0, "h") and life.source == "test_plan.time"
    least = min(row.modified_life or math.inf for row in mixed().rolling_bearings)
    assert life.value == pytest.approx(least)
    hottest = max(row.temperature - 273.15 for row in mixed().rolling_bearings)
    assert checks["bearing.temperature"].value == pytest.approx(hottest)
    assert checks["bearing.temperature"].limit == pytest.approx(120.0)
    assert checks["bearing.speed"].verdict == "pass" and checks["bearing.minimum_load"].verdict == "pass"
    assert checks["bearing.static_safety"].reason == "the case states no limit"


def test_fzg_bearings_beside_the_hand_values() -> None:
    """Hand values 38 and 25 W a bearing by ISO/TR 14179-2 at 372.6 N m; what the teeth lose and weight load more."""
    for row in mixed().rolling_bearings:
        if row.bearing.startswith("slave."):
            by_hand = float(BEARINGS[row.bearing.split(".")[1].split("_")[0]].split()[0])
            assert row.friction == pytest.approx(by_hand, rel=0.12)
            # Palmgren: f_1 F d_m with f_1 = 0.0004, d_m = 60 mm
            assert row.rolling_torque == pytest.approx(0.0004 * row.radial_load * 0.06, rel=1e-9)
