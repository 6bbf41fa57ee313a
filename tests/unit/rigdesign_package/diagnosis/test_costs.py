"""Costs of further sensors and points: stated ones as they are, others by their usual ratio to them."""

from typing import get_args

import pytest

from rigdesign.diagnosis.library.candidates import NOISE, USUAL_COST, Costs
from rigdesign.measurement.reading.measurement_set import ExtraPoint
from rigdesign.prediction.model import Quantity


def test_every_sensor_and_point_has_a_cost() -> None:
    assert set(USUAL_COST) == {*get_args(Quantity), *get_args(ExtraPoint)}
    assert set(NOISE) == set(get_args(Quantity))


def test_costs_are_relative_to_a_thermocouple_unless_one_is_stated() -> None:
    assert Costs().of("torque") == USUAL_COST["torque"]
    stated = Costs(stated={"temperature": 150.0, "torque": 9000.0})
    assert stated.of("torque") == 9000.0
    assert stated.of("seal_gap") == 150.0 * USUAL_COST["seal_gap"]


def test_without_a_thermocouple_the_stated_items_say_what_one_costs() -> None:
    stated = Costs(stated={"operating_point": 100.0, "torque": 3200.0})
    assert stated.of("temperature") == pytest.approx(200.0)
