"""Effects at one place, and the lag of a torque cell: what they change, and what a column says of it."""

from dataclasses import replace

import numpy as np
import pytest

from rigdesign.case import load_case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.library.build import run_places
from rigdesign.diagnosis.residual.sensors import LAG, LARGEST_LAG, Stated, sensor_errors
from rigdesign.prediction.model import Channel, changed_case
from tests.builders import diagnosis as builder
from tests.builders.paths import CASES

CASE = load_case(CASES / "uhcf_prototype")
EFFECTS = {effect.name: effect for effect in effects_of(CASE)}
LOCAL = ("one_bearing_loss", "one_bearing_oil", "one_bearing_joint", "leak_one_side", "draught")


def changed(name: str, size: float):
    return changed_case(CASE, EFFECTS[name].changes(CASE, (size,))).gearboxes["test"]


def test_every_bearing_wall_and_side_has_its_own() -> None:
    bearings = {f"test.{name}" for name in CASE.gearboxes["test"].bearings}
    places = {kind: {one.place for one in EFFECTS.values() if one.kind == kind} for kind in LOCAL}
    assert places["one_bearing_loss"] == places["one_bearing_oil"] == places["one_bearing_joint"] == bearings
    assert places["leak_one_side"] == {"test.front", "test.rear"}
    assert places["draught"] == {f"test.outer_{wall}" for wall in ("warm", "cold_front", "cold_rear")}


def test_a_rig_without_a_housing_has_no_places() -> None:
    kinds = {effect.kind for effect in effects_of(load_case(CASES / "loop_1to1"))}
    assert not kinds & set(LOCAL)


def test_local_effects_change_one_place_only() -> None:
    box = changed("one_bearing_loss:test.wheel_rear", 0.5)
    factors = {name: bearing.friction_factor for name, bearing in box.bearings.items()}
    assert factors == {"pinion_front": 1.0, "pinion_rear": 1.0, "wheel_front": 1.0, "wheel_rear": 1.5}
    shares = {n: b.feed_share for n, b in changed("one_bearing_oil:test.pinion_front", 0.4).bearings.items()}
    assert shares["pinion_front"] == pytest.approx(
        0.6 * CASE.gearboxes["test"].bearings["pinion_front"].feed_share
    )
    assert shares["wheel_rear"] == CASE.gearboxes["test"].bearings["wheel_rear"].feed_share
    joints = {
        n: b.shell_conductance
        for n, b in changed("one_bearing_joint:test.pinion_rear", 1e-3).bearings.items()
    }
    assert joints["pinion_rear"] == pytest.approx(1000.0) and joints["pinion_front"] is None
    walls = changed("draught:test.outer_warm", 1.0).housing.surface_film_factors
    assert dict(walls) == {"outer_warm": 2.0}


def test_a_leak_into_one_side_adds_to_what_leaks_evenly() -> None:
    paths = changed("leak_one_side:test.front", 0.06).oil_paths
    assert (paths.leak_warm_cold, paths.leak_front_share) == pytest.approx((0.06, 1.0))
    leaky = changed_case(CASE, {"gearboxes.test.oil_paths.leak_warm_cold": 0.06})
    paths = (
        changed_case(leaky, EFFECTS["leak_one_side:test.rear"].changes(leaky, (0.02,)))
        .gearboxes["test"]
        .oil_paths
    )
    assert paths.leak_warm_cold == pytest.approx(0.08)
    assert paths.leak_warm_cold * paths.leak_front_share == pytest.approx(0.03)


def test_a_healthy_rig_has_none_and_few_runs_are_spent() -> None:
    own = [effect for effect in EFFECTS.values() if effect.kind in LOCAL]
    assert all(effect.healthy == 0.0 < effect.matters for effect in own)
    assert sum(len(run_places(effect)) for effect in own) == 4 * (1 + 2 + 2) + 2 + 3


@pytest.mark.parametrize("time", [1e-5, 3e-4])
def test_the_column_of_a_lag_is_exact_on_what_is_read(time: float) -> None:
    runs = builder.settings(4)
    torque = Channel(name="M_wheel", quantity="torque", place="wheel_side", orders=builder.ORDERS)
    heat = Channel(name="T_gear", quantity="oil_outlet_temperature", place="test.gear_oil")
    library = builder.library(runs, (torque, heat))
    speed = {run.name: run.speed for run in runs}
    place = {feature: i for i, feature in enumerate(library.features)}
    read = library.base.copy()
    pairs = [
        (i, place[replace(one, part="imaginary")], one.order * speed[one.setting])
        for one, i in place.items()
        if one.channel == "M_wheel" and one.part == "real"
    ]
    for i, j, frequency in pairs:
        passed = complex(library.base[i], library.base[j]) / (1.0 + 1j * frequency * time)
        read[i], read[j] = passed.real, passed.imag
    channels = {"M_wheel": torque, "T_gear": heat}
    found = {one.name: one for one in sensor_errors(library, channels, {"M_wheel": Stated()}, read)}
    lag = found["torque_lag:M_wheel"]
    assert (lag.spread, lag.bound, lag.unit) == (LAG, pytest.approx(LARGEST_LAG), "s")
    assert not any(name.endswith("T_gear") for name in found)
    assert np.abs(read - library.base).max() > 0.0
    np.testing.assert_allclose(time * lag.values, read - library.base, rtol=1e-9, atol=1e-12)
