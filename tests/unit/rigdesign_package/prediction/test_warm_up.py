"""Points that were not steady: the linearised rig marched exactly, against the model marched in time steps."""

import numpy as np
import pytest

from rigdesign.base.errors import UsageError
from rigdesign.case.loader import load_case
from rigdesign.prediction import Channel, OperatingCondition
from rigdesign.prediction.model import changed_case
from rigdesign.prediction.predict import Predictor
from rigdesign.prediction.readings import rate_rows
from tests.builders.paths import CASES

pytestmark = pytest.mark.whole_run

WARMING = "ambient.warming_time"
SETTINGS = (
    OperatingCondition(name="fast", speed=1256.0, torque=180.0),
    OperatingCondition(name="slow", speed=500.0, torque=90.0),
)
CHANNELS = (
    Channel(name="wall", quantity="temperature", place="test.outer_warm"),
    Channel(name="pinion", quantity="temperature", place="test.gear_test_pinion"),
    Channel(name="point", quantity="temperature", place="test", at=(0.05, -0.16, 0.14)),
    Channel(name="gear_oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
    Channel(name="power", quantity="motor_power"),
    Channel(name="rate", quantity="warming_rate", place="test.outer_warm"),
    Channel(name="rate of point", quantity="warming_rate", place="test", at=(0.05, -0.16, 0.14)),
)
RATES = np.array([channel.quantity == "warming_rate" for channel in CHANNELS])
HOUR = 3600.0


@pytest.fixture(scope="module")
def predictor() -> Predictor:
    made = Predictor(load_case(CASES / "uhcf_prototype"), SETTINGS, CHANNELS)
    made.prepare()
    return made


def missing(predictor: Predictor, time: float) -> np.ndarray:
    """(points, channels) less than steady after a time."""
    change = predictor.response({WARMING: time}) - predictor.base
    return np.asarray(change.reshape(len(SETTINGS), len(CHANNELS)))


@pytest.mark.parametrize(
    "time", [HOUR, *(pytest.param(hours * HOUR, marks=pytest.mark.slow) for hours in (0.5, 4.0))]
)
def test_first_order_is_near_the_model_marched_in_time(predictor: Predictor, time: float) -> None:
    """Films, radiation and losses of a rig tens of kelvin colder make up the difference: 6 % of what is missing."""
    marched = (predictor.values({WARMING: time}) - predictor.base).reshape(len(SETTINGS), len(CHANNELS))
    first_order = missing(predictor, time)
    allowed = np.where(RATES, 0.1 * np.abs(marched), 0.06 * np.abs(marched) + 0.01)
    assert np.all(np.abs(first_order - marched) <= allowed)
    assert np.all(first_order[:, :4] < 0.0) and np.all(first_order[:, 4:] > 0.0)


def test_a_rate_is_the_change_of_its_temperature_with_time(predictor: Predictor) -> None:
    step = 1.0
    before, at, after = (missing(predictor, HOUR + lag) for lag in (-step, 0.0, step))
    for rate, temperature in ((5, 0), (6, 2)):
        slope = (after - before)[:, temperature] / (2.0 * step)
        np.testing.assert_allclose(at[:, rate], slope, rtol=1e-5)
    assert np.all(predictor.base.reshape(len(SETTINGS), -1)[:, RATES] == 0.0)


def test_a_rate_needs_the_temperature_that_changes() -> None:
    with pytest.raises(UsageError, match=r"'rate of point'.*is no channel"):
        rate_rows((CHANNELS[0], CHANNELS[6]))
    assert rate_rows(CHANNELS) == {5: 0, 6: 2}


def test_late_readings_approach_steady_by_one_time_constant(predictor: Predictor) -> None:
    """exp(-t/tau) of the slowest mode: equal times leave equal ratios, which one implicit step does not."""
    walls = [missing(predictor, hours * HOUR)[0, 0] for hours in (8.0, 12.0, 16.0)]
    assert walls[2] / walls[1] == pytest.approx(walls[1] / walls[0], rel=5e-3)
    assert walls[1] / walls[0] < 0.4
    assert np.abs(missing(predictor, 1e7)).max() < 1e-6


def test_points_may_have_run_for_different_times(predictor: Predictor) -> None:
    both = predictor.response([{WARMING: HOUR}, {}]) - predictor.base
    found = both.reshape(len(SETTINGS), len(CHANNELS))
    np.testing.assert_allclose(found[0], missing(predictor, HOUR)[0])
    np.testing.assert_allclose(found[1], 0.0, atol=1e-12)


@pytest.mark.slow
def test_a_case_that_is_not_steady_has_no_first_order(predictor: Predictor) -> None:
    case = changed_case(predictor.case, {WARMING: HOUR})
    early = Predictor(case, SETTINGS[:1], CHANNELS)
    marched = predictor.values({WARMING: HOUR})[: len(CHANNELS)]
    np.testing.assert_allclose(early.base[:4], marched[:4], atol=0.15)
    with pytest.raises(UsageError, match="warming_time"):
        early.prepare()
