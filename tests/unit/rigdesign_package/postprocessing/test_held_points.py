"""Several held points: which one speaks for the rig, and what cooler and heaters have to do at each."""

from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.base.part_name import OilStreamName
from rigdesign.case.circuit_parts import HeatParts
from rigdesign.coupling.loop import governing_point
from rigdesign.postprocessing.housing import stage_balance


def held(stage: str, speed: float, torque: float) -> Any:
    return SimpleNamespace(point=SimpleNamespace(stage=stage, speed=speed, torque=torque))


def test_the_highest_torque_governs_then_the_highest_speed_then_the_last() -> None:
    slow, fast = held("slow", 300.0, -180.0), held("fast", 1200.0, 180.0)
    again, light = held("again", 1200.0, 180.0), held("light", 1500.0, 90.0)
    assert governing_point([slow, fast, light]).point.stage == "fast"
    assert governing_point([fast, slow, light]).point.stage == "fast"
    assert governing_point([fast, again]).point.stage == "again"
    assert governing_point([light, slow]).point.stage == "slow"


def test_oil_that_must_be_heated_cools_nothing() -> None:
    """140 degC oil that comes back 1.4 kW colder does not carry what a 40 degC circuit brings."""
    warm, cool = (SimpleNamespace(oil="ester", inlet_temperature=inlet) for inlet in (413.15, 313.15))
    test = SimpleNamespace(feeds={"gear_oil": (warm, 1), "bearing_oil": (cool, 4)})
    reference = SimpleNamespace(feeds={"gear_oil": (cool, 1), "bearing_oil": (cool, 4)})
    ambient = SimpleNamespace(warming_time=None, temperature=293.15)
    rig: Any = SimpleNamespace(
        case=SimpleNamespace(
            gearboxes={"test": test, "reference": reference}, ambient=ambient, oil_circuits={}
        ),
        oil_circuits={},
        heat_parts=HeatParts(),
        driven_speed=float,
    )
    heats = {
        "test.gear_oil": (413.15, -1400.0),
        "test.bearing_oil": (313.15, 6200.0),
        "reference.gear_oil": (313.15, -200.0),
        "reference.bearing_oil": (313.15, 4700.0),
    }
    last: Any = SimpleNamespace(
        point=SimpleNamespace(stage="test", speed=1000.0),
        losses=[
            SimpleNamespace(gearbox="test", loss=SimpleNamespace(power=9300.0), pumped=0.0, not_heat=0.0)
        ],
        streams=[
            SimpleNamespace(name=OilStreamName.read(name), inlet=inlet, heat=heat, to_tank=heat, flow=1e-4)
            for name, (inlet, heat) in heats.items()
        ],
        fields={},
    )
    found = stage_balance(rig, last)
    balance, heat = found.cooling, found.heat
    assert balance.heater == pytest.approx(1400.0)
    assert balance.cooler == pytest.approx(6200.0 - 200.0 + 4700.0)
    assert balance.imbalance == pytest.approx(0.0)
    assert heat.drive_power == heat.mains_power == 9300.0
    assert heat.input_power == 9300.0 + 1400.0
    assert heat.imbalance == pytest.approx(0.0)
