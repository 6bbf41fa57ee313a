"""The prototype with given losses and a circuit for its warm oil: housing and heater at its limit over time."""

from pathlib import Path

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.results.result import RunResult
from rigdesign.results.thermal import OilPowerCurve
from rigdesign.run.main import run_case
from tests.builders.paths import CASES

pytestmark = [pytest.mark.whole_run, pytest.mark.slow]  # 48 s of one core

CASE = f"""
extends = "{(CASES / "uhcf_prototype" / "given_losses.toml").as_posix()}"
name = "warm_up"
title = "warm-up"
[gearboxes.test.oil]
remove = ["inlet_temperature"]
[oil_circuits.warm]
oil = "MIL-PRF-23699"
tank = {{ volume = "60 l", fill = "45 l", wall_conductance = "4 W/K", heat_capacity = "10 kJ/K" }}
heater = {{ power_limit = "3 kW", setpoint = "90 degC" }}
lines.mesh = {{ consumers = ["test.gear_oil"], setpoint = "90 degC" }}
[transient]
warm_up = "30 min"
dwell = "4 h"
oil_run_on = "10 min"
soak_back = "10 min"
events = []
tolerance = "3 K"
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    file: Path = tmp_path_factory.mktemp("case") / "case.toml"
    file.write_text(CASE)
    return run_case(load_case(file), "quick", transient=True)


@pytest.fixture(scope="module")
def schedule(result: RunResult) -> OilPowerCurve:
    assert result.transient is not None
    return result.transient.oil_power[0]


def test_the_oil_warms_as_fast_as_its_heater_can(schedule: OilPowerCurve) -> None:
    times, tank = np.array(schedule.time_s), np.array(schedule.tanks_degC["warm"])
    assert tank[0] == pytest.approx(20.0)
    warm = int(np.argmax(tank > 89.9))
    assert np.all(np.diff(tank[: warm + 1]) > 0.0)
    assert 1920.0 < times[warm] < 2.0 * 3600.0
    assert tank[warm:].max() < 90.1
    supply = np.array(schedule.supplies_degC["test.gear_oil"])
    assert supply == pytest.approx(tank, abs=1e-6)  # no pump, no pipe


def test_the_oil_cannot_be_warmer_than_the_heater_makes_it(schedule: OilPowerCurve) -> None:
    """45 l and 10 kJ/K of steel alone would take up 3 kW for 32 minutes on their way to 90 degC; the box takes more."""
    times, tank = np.array(schedule.time_s), np.array(schedule.tanks_degC["warm"])
    oil = 45e-3 * 960.0 * 1950.0 + 10e3
    assert np.all(tank - 20.0 <= 3000.0 * times / oil + 0.5)


def test_heat_is_kept_and_the_warm_up_is_held_against_its_plan(result: RunResult) -> None:
    assert result.transient is not None
    assert result.transient.energy_closure < 1e-8
    check = next(c for c in result.checks if c.id == "transient.oil_supply.warm.lines.mesh")
    assert check.verdict == "fail"
    assert check.value is not None and 0.5 < check.value < 2.0
