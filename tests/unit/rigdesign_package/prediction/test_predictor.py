"""The reduced predictor against the full model, its derivatives against differences of its own values."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from rigdesign.base.errors import UsageError
from rigdesign.case.loader import changed_together, load_case
from rigdesign.prediction import OWN_MODEL, TORSIONAL, Channel, OperatingCondition
from rigdesign.prediction.predict import Predictor, predict
from tests.builders.fzg_case import HELD, fzg_case
from tests.builders.paths import CASES
from tests.builders.warm_chambers import warm_chambers_case

pytestmark = pytest.mark.whole_run

CASE = load_case(CASES / "uhcf_prototype")
SETTINGS = (
    OperatingCondition(name="fast", speed=1256.0, torque=180.0),
    OperatingCondition(name="slow", speed=500.0, torque=90.0, inlet_temperature={"test.gear_oil": 373.0}),
)
CHANNELS = (
    Channel(name="wall", quantity="temperature", place="test.outer_warm"),
    Channel(name="pinion", quantity="temperature", place="test.gear_test_pinion"),
    Channel(name="point", quantity="temperature", place="test", at=(0.05, -0.16, 0.14)),
    Channel(name="bore", quantity="temperature", place="test.bearing_bore_test_pinion_front"),
    Channel(name="gear_oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
    Channel(name="bearing_oil", quantity="oil_outlet_temperature", place="test.bearing_oil"),
    Channel(name="power", quantity="motor_power"),
    Channel(name="gap", quantity="seal_gap", place="test.test_pinion_front"),
)
KELVIN = [n for n, channel in enumerate(CHANNELS) if "temperature" in channel.quantity]
FILM = "gearboxes.test.housing.boundary.chamber_oil.heat_transfer_coefficient"
WETTED = ("chamber_wall", "chamber_top", "partition_warm_front", "partition_warm_rear")
TIGHT = {"numerics.temperature_tolerance": "0.005 K", "numerics.coupling_passes": 60}


LEAST_POWER = {TORSIONAL: 1e-4, OWN_MODEL: 3e-4}
"""Error of the power by the reduced expansion. Shafts that bend carry what couplings out of line push with as bearing
loads: a tenth of a micrometre of reduced expansion there is some newtons, and watts of single bearings that nearly
cancel."""


@pytest.fixture(scope="module")
def predictor():
    return Predictor(CASE, SETTINGS, CHANNELS)


@pytest.fixture(scope="module")
def twisting():
    return Predictor(CASE, SETTINGS, CHANNELS, circuit=TORSIONAL)


def _by_point(values):
    return np.asarray(values).reshape(len(SETTINGS), len(CHANNELS))


BEYOND = {
    FILM: 600.0,
    "gearboxes.test.loss_factors.bearing": 1.5,
    "gearboxes.test.loss_factors.mesh": 1.4,
    "gearboxes.test.bearings.pinion_front.shell_conductance": 1000.0,
}


@pytest.mark.parametrize(
    "circuit",
    [
        pytest.param(OWN_MODEL, id="elastic"),
        pytest.param(TORSIONAL, id="torsional", marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize(
    "changes",
    [
        BEYOND,
        *(pytest.param({path: value}, marks=pytest.mark.slow) for path, value in BEYOND.items()),
        pytest.param({}, marks=pytest.mark.slow),
        pytest.param({"ambient.warming_time": 3600.0}, marks=pytest.mark.slow),
    ],
)
def test_the_reduced_model_keeps_its_stated_error(request, circuit, changes):
    """Full solves with the coupling settled to 5 mK, under changes as large as a diagnosis seeks."""
    from rigdesign.prediction.model import changed_case

    predictor = request.getfixturevalue("twisting" if circuit is TORSIONAL else "predictor")
    tight = changed_together(changed_case(CASE, changes), TIGHT)
    full = predict(tight, SETTINGS, CHANNELS, circuit=circuit)
    off = np.abs(_by_point(predictor.values(changes)) - _by_point(full.values))
    assert predictor.error <= 0.1
    assert off[:, KELVIN].max() <= predictor.error + 0.01
    assert off[:, CHANNELS.index(CHANNELS[7])].max() < 2e-7
    power = [n for n, channel in enumerate(CHANNELS) if channel.quantity == "motor_power"]
    assert (off[:, power] / _by_point(full.values)[:, power]).max() < LEAST_POWER[circuit]


def test_no_change_is_the_base(predictor):
    np.testing.assert_allclose(predictor.values({}), predictor.base, atol=2e-3, rtol=0.0)
    predictor.links()
    np.testing.assert_allclose(predictor.values({}), predictor.base, atol=1e-4, rtol=0.0)


def test_first_order_answer_of_a_film_is_its_links_and_the_difference_of_values(predictor):
    stated = CASE.gearboxes["test"].housing.boundary["chamber_oil"].heat_transfer_coefficient
    step = 0.02
    links = predictor.links()
    by_links = sum(links[f"film:test.{surface}"] for surface in WETTED) * np.log1p(step)
    moved = predictor.values({FILM: stated * (1.0 + step)}) - predictor.base
    first = predictor.response({FILM: stated * (1.0 + step)}) - predictor.base
    size = np.abs(_by_point(moved)).max(axis=0)
    for answer in (by_links, first):
        assert (np.abs(_by_point(answer - moved)).max(axis=0) <= 0.03 * size + 1e-9).all()


def test_a_watt_of_oil_warms_the_stream_by_its_heat_capacity(predictor):
    """dT = P / (rho c Q) at the first; what the walls take back lessens it."""
    from rigdesign.rig.model import build_rig

    oil = build_rig(CASE, "quick").oils["MIL-PRF-23699"]
    feed = CASE.gearboxes["test"].oil
    inlet = feed.inlet_temperature
    alone = 1.0 / (oil.density(inlet) * oil.heat_capacity(inlet) * feed.flow)
    column = _by_point(predictor.sources()["oil:test.gear_oil"])
    assert 0.7 * alone < column[0, 4] < alone
    paid = _by_point(predictor.sources()["oil:test.gear_oil"] + predictor.motor_watt())
    assert paid[0, 6] - column[0, 6] == pytest.approx(1.0)


def test_inputs_follow_the_settings(predictor):
    """An inlet that a setting leaves out is the case's: the column is the difference of values there."""
    rise, stated = 0.5, CASE.gearboxes["test"].oil.inlet_temperature
    moved = _by_point(
        predictor.values({"gearboxes.test.oil.inlet_temperature": stated + rise}) - predictor.base
    )
    column = _by_point(predictor.inputs()["inlet_temperature", "test.gear_oil"])
    assert column[0, KELVIN] == pytest.approx(moved[0, KELVIN] / rise, abs=0.01)
    assert np.abs(moved[1]).max() < 1e-3 and column[1, 4] > 0.5


def test_a_worker_gets_the_same_predictor(predictor):
    sent = pickle.loads(pickle.dumps(predictor))
    np.testing.assert_array_equal(sent.base, predictor.base)
    changes = {FILM: 400.0}
    np.testing.assert_allclose(sent.values(changes), predictor.values(changes), rtol=0.0, atol=0.02)


def test_a_loop_without_housing_has_no_links():
    case = load_case(CASES / "loop_hunting")
    channels = (
        Channel(name="oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
        Channel(name="drive", quantity="drive_torque"),
    )
    settings = (
        OperatingCondition(name="a", speed=200.0, torque=150.0),
        OperatingCondition(name="b", speed=300.0, torque=200.0),
    )
    predictor = Predictor(case, settings, channels)
    assert predictor.links() == {} and predictor.error == 0.0
    full = predict(changed_together(case, TIGHT), settings, channels)
    assert predictor.base == pytest.approx(full.values, abs=5e-3)
    assert set(predictor.sources()) >= {"oil:test.gear_oil", "film:test.pinion_front"}


def test_streams_of_a_housing_are_refused(tmp_path: Path) -> None:
    case = load_case(warm_chambers_case(tmp_path))
    setting = OperatingCondition(name="a", speed=200.0, torque=300.0)
    with pytest.raises(
        UsageError, match=r"gearboxes\.test\.housing\.volumes = cold_air: .*leave the table out"
    ):
        Predictor(case, [setting], [Channel(name="power", quantity="motor_power")])


def test_a_sump_that_finds_its_own_temperature_is_refused(tmp_path: Path) -> None:
    case = load_case(fzg_case(tmp_path, sumps={"test": "", "slave": HELD}))
    setting = OperatingCondition(name="a", speed=200.0, torque=300.0)
    with pytest.raises(UsageError, match=r"gearboxes\.test\.oil\.sump_temperature is left out"):
        Predictor(case, [setting], [Channel(name="power", quantity="motor_power")])
