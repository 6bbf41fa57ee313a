"""Causes without a name: heat in the pipes, heat by law and place."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.diagnosis.residual.hypotheses import heats, unmodelled_causes
from tests.builders.diagnosis import story

STREAM = "test.gear_oil"
FLOWS = (1e-5, 2e-5, 4e-5)


@pytest.fixture(scope="module")
def residuals():
    return story("healthy").problem.residuals


def causes(residuals):
    flows = {run.name: FLOWS[number % 3] for number, run in enumerate(residuals.library.settings)}
    runs = tuple(replace(run, flow={STREAM: flows[run.name]}) for run in residuals.library.settings)
    found = unmodelled_causes(replace(residuals.library, settings=runs), residuals.channels)
    by_flow = np.array([1.0 / flows[one.setting] for one in residuals.features])
    return {name: (family, columns) for family, name, columns in found}, by_flow


def test_heat_in_the_supply_warms_by_less_the_more_oil_flows(residuals):
    found, by_flow = causes(residuals)
    family, column = found[f"heat in the supply of {STREAM} constant"]
    warmer = sum(
        residuals.library.inputs["inlet_temperature", STREAM, run.name] for run in residuals.library.settings
    )
    assert family == "local"
    assert column[:, 0] == pytest.approx(warmer * by_flow)


def test_heat_in_the_drain_is_felt_by_one_thermometer_alone(residuals):
    found, by_flow = causes(residuals)
    family, column = found[f"heat in the drain of {STREAM} constant"]
    reads = np.array([one.channel == "T_gear" for one in residuals.features])
    assert family == "local"
    assert column[:, 0] == pytest.approx(reads * by_flow)


def test_heat_follows_every_law_at_every_place_paid_and_unpaid(residuals):
    found = {heat.name: heat for heat in heats(residuals.library)}
    assert len(found) == 2 * 2 * 4
    constant, square = found["heat at film:bearing constant"], found["heat at film:bearing ~n2"]
    speeds = {run.name: run.speed for run in residuals.library.settings}
    mean = np.exp(np.mean(np.log(list(speeds.values()))))
    law = np.array([(speeds[one.setting] / mean) ** 2 for one in residuals.features])
    assert square.values == pytest.approx(constant.values * law)
    assert square.likeness == "heat at film ~n2"
