"""First-order response of a power circuit: what is not solved again is the same as if it were."""

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.coupling.iteration import initial_state
from rigdesign.prediction import OWN_MODEL, TORSIONAL, Channel, OperatingCondition
from rigdesign.prediction.full import like, operating_point, rig_at
from rigdesign.prediction.memoisation import Memoisation
from rigdesign.prediction.model import changed_case
from rigdesign.prediction.predict import Predictor
from tests.builders.paths import CASES

CASE = load_case(CASES / "loop_1to1")
SETTINGS = (
    OperatingCondition(name="slow", speed=105.0, torque=350.0),
    OperatingCondition(name="fast", speed=377.0, torque=200.0, inlet_temperature={"test.gear_oil": 343.0}),
)
CHANNELS = (
    Channel(name="torque", quantity="torque", place="wheel_side", orders=(0.0, 1.0, 28.0, 29.0)),
    Channel(name="angle", quantity="angle", place="test_pinion", orders=(1.0, 28.0)),
    Channel(name="first", quantity="natural_frequency", place="1"),
    Channel(name="oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
    Channel(name="power", quantity="motor_power", place="motor"),
)
FLANK = "gearboxes.test.gears.pinion.flank"


@pytest.fixture(scope="module", params=[OWN_MODEL, TORSIONAL], ids=["elastic", "torsional"])
def predictor(request):
    made = Predictor(CASE, SETTINGS, CHANNELS, circuit=request.param)
    made.prepare()
    return made


def _off(predictor, answer, wanted):
    """Largest difference of two answers by channel and order, over the largest answer of these."""
    places = {}
    for number, feature in enumerate(predictor.features):
        places.setdefault((feature.channel, feature.order), []).append(number)
    return {
        place: np.abs(answer[rows] - wanted[rows]).max() / np.abs(wanted[rows]).max()
        for place, rows in places.items()
        if np.abs(wanted[rows]).max() > 1e-9 * np.abs(predictor.base[rows]).max()
    }


def _solved_again(predictor, changes):
    """The same first-order answer with a response and orders of its own at every point."""
    drags = [point.drag for point in predictor._first_order.points]
    for drag in drags:
        drag.causes = lambda *_: None
    try:
        return predictor.response(changes) - predictor.base
    finally:
        for drag in drags:
            del drag.causes


@pytest.mark.parametrize(
    "changes",
    [
        {"gearboxes.test.loss_factors.mesh": 1.5},
        {"gearboxes.test.loss_factors.bearing": 1.8},
        {"gearboxes.reference.oil_state.viscosity_factor": 0.75},
        {"gearboxes.test.loss_factors.bearing": 1.1},
        {"gearboxes.test.oil_state.heat_capacity_factor": 0.9},
    ],
)
def test_drags_and_friction_answer_as_a_loop_solved_again(predictor, changes):
    same_loop = all(
        point.changed(predictor._reduced.changed_problem(rig, setting)).same_loop
        for point, rig, setting in zip(
            predictor._first_order.points, predictor._changed_rigs(changes), predictor.settings
        )
    )
    # films that change by more than 3 % are other bearings to shafts that bend: their loop is solved again
    much = (
        {"gearboxes.test.loss_factors.bearing": 1.8},
        {"gearboxes.reference.oil_state.viscosity_factor": 0.75},
    )
    assert same_loop == (predictor.circuit is TORSIONAL or changes not in much)
    answer = predictor.response(changes) - predictor.base
    off = _off(predictor, answer, _solved_again(predictor, changes))
    assert max(off[place] for place in (("torque", 0.0), ("power", 0.0), ("oil", 0.0))) < 0.003
    assert max(off[place] for place in (("torque", 28.0), ("angle", 28.0))) < 0.02


def test_what_only_oscillates_moves_its_orders_alone(predictor):
    changes = {f"{FLANK}.run_out": 4e-6}
    oscillating = predictor.oscillating(changes) - predictor.base
    whole = predictor.response(changes) - predictor.base
    off = _off(predictor, oscillating, whole)
    assert max(off["torque", 1.0], off["torque", 29.0], off["angle", 1.0]) < 0.01
    assert oscillating[[f.channel in ("first", "oil", "power") for f in predictor.features]] == pytest.approx(
        0.0, abs=0.0
    )
    assert np.abs(oscillating).max() > 0.1


def test_an_oscillating_motor_is_answered_in_proportion(predictor):
    one, two = (
        predictor.oscillating(
            {"drivetrain.motor.ripple": [{"order": 1.0, "torque": f"{torque} N m", "phase": "0 rad"}]}
        )
        - predictor.base
        for torque in (1.0, 2.0)
    )
    np.testing.assert_allclose(two, 2.0 * one, rtol=1e-9, atol=1e-12)
    assert np.abs(one).max() > 0.01


def test_memoisation_finds_again_what_a_change_leaves_alone(predictor):
    memoisation, stated = Memoisation(), predictor._reduced.stated
    setting, point = SETTINGS[0], operating_point(SETTINGS[0])
    coupling_state = predictor._points[0].last.coupling_state
    own = memoisation.models(rig_at(stated, setting), point, coupling_state)

    def brace(rig):
        return memoisation.bracing(rig, point, initial_state(rig, point))

    def met(changes):
        rig = rig_at(like(stated, changed_case(CASE, changes)), setting)
        return memoisation.models(rig, point, coupling_state), brace(rig)

    bracing = brace(rig_at(stated, setting))

    models, braced = met({"gearboxes.test.gears.pinion.inertia_factor": 1.2})
    assert all(one is other for one, other in zip(models, own))
    # a heavier gear presses the bearings of shafts that bend
    assert braced.twist == pytest.approx(bracing.twist, rel=1e-5)
    assert predictor.circuit is OWN_MODEL or braced is bracing
    models, braced = met(
        {"gearboxes.test.meshes.main.damping": 1234.0, "gearboxes.test.loss_factors.mesh": 1.5}
    )
    law, before = models[0].law, own[0].law
    assert law.gap is before.gap and law.damping == 1234.0
    assert law.friction == pytest.approx(1.5 * before.friction) and braced is bracing
    models, braced = met({f"{FLANK}.run_out": 2e-5})
    assert models[0].law.deviation_1.shape[0] == 28 and braced is bracing
    models, braced = met({f"{FLANK}.profile_slope": 1e-5})
    assert np.abs(models[0].law.gap - before.gap).max() > 1e-6
    _, braced = met({"drivetrain.couplings.pinion_side.torsional_stiffness": 2e5})
    assert braced.twist > bracing.twist
