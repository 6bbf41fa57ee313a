"""Predictions at single operating points against the check of the same case."""

import math

import numpy as np
import pytest

from rigdesign.base.errors import UsageError
from rigdesign.case.loader import load_case
from rigdesign.prediction import Channel, OperatingCondition, PredictionModel, features_of
from rigdesign.prediction.places import place_weights
from rigdesign.prediction.predict import predict
from rigdesign.prediction.readings import readings
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES
from tests.builders.shared_runs import quick_run

pytestmark = pytest.mark.whole_run

CASE = load_case(CASES / "uhcf_prototype")
STAGE = next(stage for stage in CASE.schedule.resolved() if stage.held)
DWELL = OperatingCondition(name=STAGE.name, speed=STAGE.speed_end, torque=STAGE.torque_end)
POINT = (0.05, -0.16, 0.14)

CHANNELS = (
    Channel(name="wall", quantity="temperature", place="test.outer_warm"),
    Channel(name="pinion", quantity="temperature", place="test.gear_test_pinion"),
    Channel(name="gear_oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
    Channel(name="bearing_oil", quantity="oil_outlet_temperature", place="reference.bearing_oil"),
    Channel(name="drive", quantity="drive_torque"),
    Channel(name="power", quantity="motor_power"),
)


@pytest.fixture(scope="module")
def checked():
    return quick_run("uhcf_prototype")


@pytest.fixture(scope="module")
def rig():
    return build_rig(CASE, "quick")


@pytest.fixture(scope="module")
def predicted(rig):
    seal = Channel(name="seal", quantity="seal_gap", place=rig.models["test"].seals[0].name)
    point = Channel(name="point", quantity="temperature", place="test", at=POINT)
    channels = (*CHANNELS, seal, point)
    prediction = predict(CASE, [DWELL], channels, circuit=PredictionModel(teeth="influence_numbers"))
    assert prediction.features == features_of([DWELL], channels)
    assert prediction.error == 0.0 and np.all(np.isfinite(prediction.values))
    return dict(zip([feature.channel for feature in prediction.features], prediction.values))


def test_a_dwell_is_that_of_the_check_to_nine_digits(rig, checked, predicted):
    outlets = {row.consumer: row.outlet for row in checked.oil if row.stage == DWELL.name}
    assert predicted["gear_oil"] == pytest.approx(outlets["test.gear_oil"], rel=1e-9)
    assert predicted["bearing_oil"] == pytest.approx(outlets["reference.bearing_oil"], rel=1e-9)
    thermal = checked.thermal[0]
    wall = next(row for row in thermal.heat if row.surface == "outer_warm")
    assert predicted["wall"] == pytest.approx(wall.mean_temperature, rel=1e-9)
    pinion = thermal.bodies["gear_test_pinion"].mean
    assert predicted["pinion"] == pytest.approx(pinion, rel=1e-9)
    seal = next(
        row for row in checked.expansion[0].seal_gaps if row["seal"] == rig.models["test"].seals[0].name
    )
    assert predicted["seal"] == pytest.approx(1e-3 * seal["hot_mean_mm"], rel=1e-9)


def test_the_motor_gives_the_sum_of_the_losses(checked, predicted):
    lost = math.fsum(row.power for row in checked.losses if row.stage == DWELL.name)
    assert predicted["power"] == pytest.approx(lost, rel=2e-3)
    assert predicted["power"] > 0.0


def test_coordinates_read_the_field_where_the_sensor_sits(rig, predicted):
    """A quadratic field is read to rounding anywhere; the wall is warmer than the room and near its mean."""
    elements = rig.conduction["test"].elements
    points = elements.mesh.points
    name, (nodes, weights) = place_weights(rig, "test", POINT)
    assert name == "test" and weights.sum() == pytest.approx(1.0)
    straight = points @ np.array([3.0, -2.0, 5.0])
    assert weights @ straight[nodes] == pytest.approx(np.dot(POINT, [3.0, -2.0, 5.0]), abs=1e-6)
    assert CASE.ambient.temperature < predicted["point"] < predicted["wall"] + 40.0


def test_a_point_off_the_body_names_the_nearest_surface(rig):
    with pytest.raises(UsageError, match=r"mm off the body.*nearest surface: "):
        place_weights(rig, "test", (0.05, 0.0, 0.2))


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        (Channel(name="x", quantity="temperature", place="test.roof"), "no body or surface"),
        (Channel(name="x", quantity="temperature", place="reference.housing"), "no gearbox with a housing"),
        (Channel(name="x", quantity="oil_outlet_temperature", place="test.water"), "no oil stream"),
        (Channel(name="x", quantity="seal_gap", place="test.nowhere"), "not one seal"),
        (Channel(name="x", quantity="torque", place="wheel_side"), "read by orders"),
    ],
)
def test_a_place_the_rig_does_not_have_is_a_wrong_call(rig, channel, said):
    with pytest.raises(UsageError, match=said):
        readings(rig, [channel])


def test_settings_and_channels_need_names_of_their_own():
    with pytest.raises(UsageError, match="two settings are called"):
        predict(CASE, [DWELL, DWELL], CHANNELS)
