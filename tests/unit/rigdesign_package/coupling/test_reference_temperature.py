"""Drawings hold at 20 degC, whatever the room: growth counts from there."""

import pytest

from rigdesign import load_case
from rigdesign.base.part_name import MeshName
from rigdesign.coupling.expansion import uniform_expansion
from rigdesign.coupling.iteration import initial_state
from rigdesign.coupling.mesh_models import warm_pair
from rigdesign.coupling.time_run import held_points
from rigdesign.rig.model import Rig
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

PROTOTYPE = CASES / "uhcf_prototype"


def rig_at(**values: str) -> Rig:
    case = load_case(PROTOTYPE)
    for key, value in values.items():
        case = case.with_value(f"ambient.{key}", value)
    return twisting_rig(case)


def test_a_box_in_a_warm_room_has_grown_before_it_runs() -> None:
    """15 K of structural steel on 99.5 mm: 18 um; measures that hold at 35 degC have not grown."""
    expanded = 99.5e-3 * 12e-6 * 15.0
    for values, expected in (
        ({}, 0.0),
        ({"temperature": "35 degC"}, expanded),
        ({"temperature": "35 degC", "reference_temperature": "35 degC"}, 0.0),
    ):
        rig = rig_at(**values)
        cold = initial_state(rig, held_points(rig)[0])
        change = cold.centre_distance["test.main"] - 99.5e-3
        assert change == pytest.approx(expected, rel=0.1, abs=1e-12)
    assert uniform_expansion(rig_at(), "reference", 293.15)["reference.main"] == 99.5e-3


def test_the_room_does_not_change_a_hot_gear() -> None:
    pairs = []
    for room in ("20 degC", "35 degC"):
        rig = rig_at(temperature=room)
        point = held_points(rig)[0]
        cold = initial_state(rig, point)
        hot = type(cold)(**{**vars(cold), "gear_temperature": dict.fromkeys(cold.gear_temperature, 420.0)})
        pairs.append(warm_pair(rig, MeshName("test", "main"), point.speed, hot).gears[0].tip_radius)
    assert pairs[0] == pairs[1]
