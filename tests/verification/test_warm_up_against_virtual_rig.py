"""A point read too early, against the independent finite-volume rig: the rate of the effect is the one hidden."""

import math

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.prediction import Channel, OperatingCondition
from rigdesign.prediction.predict import Predictor
from tests.builders.paths import CASES
from tests.virtual_rig.heat_truth import HeatTruth, rig

pytestmark = pytest.mark.whole_run

POINT = {"speed": 2.0 * math.pi * 200.0, "torque": 180.0}
WALLS = {
    "right": (0.13, 0.16, 0.1),
    "left": (0.13, -0.16, 0.1),
    "front": (0.03, 0.16, 0.15),
    "rear": (0.27, 0.16, 0.15),
}
"""Thermocouples outside on the walls of chamber and cold sections [m]."""


@pytest.fixture(scope="module")
def predictor() -> Predictor:
    channels = [Channel(name=n, quantity="temperature", place="test", at=at) for n, at in WALLS.items()]
    made = Predictor(load_case(CASES / "uhcf_prototype"), (OperatingCondition(name="P", **POINT),), channels)
    made.prepare()
    return made


def hidden(rate: float) -> np.ndarray:
    """(walls,) how much colder the walls of the virtual rig are at a rate [1/h]."""
    tree, boxes = rig(CASES / "uhcf_prototype" / "case.toml")
    early, steady = (
        HeatTruth(tree, None, effects, boxes=boxes).solve(POINT, WALLS)["thermocouples"]
        for effects in ({"not_steady:test": rate}, None)
    )
    return np.array([early[name] - steady[name] for name in WALLS])


@pytest.mark.parametrize("rate, share", [(1.0, 0.05), (0.25, 0.05), (2.0, 0.30)])
def test_outer_walls_are_as_cold_as_on_the_virtual_rig(
    predictor: Predictor, rate: float, share: float
) -> None:
    """Within a twentieth after one and four hours; after half an hour the few cells of the other rig and its coarse
    implicit steps differ. One implicit step over the whole time misses two to three times as much."""
    effect = next(one for one in effects_of(predictor.case) if one.name == "not_steady")
    change = predictor.response(effect.changes(predictor.case, (rate / 3600.0,))) - predictor.base
    np.testing.assert_allclose(change, hidden(rate), rtol=share)
