"""Numbers of the torsional prediction, frozen before shafts that bend became what a case predicts with."""

import numpy as np
import pytest

from rigdesign.case.loader import load_case
from rigdesign.prediction import TORSIONAL, Channel, OperatingCondition
from rigdesign.prediction.predict import Predictor, predict
from tests.builders.paths import CASES
from tests.builders.undamped_shafts import undamped_shafts

SHIPPED = load_case(CASES / "loop_1to1")
CASE = SHIPPED.with_values(undamped_shafts(SHIPPED))
"""Shafts without damping of their own, as they were then."""
RUN_OUT = "gearboxes.test.gears.pinion.flank.run_out"
SETTINGS = (
    OperatingCondition(name="slow", speed=105.0, torque=350.0),
    OperatingCondition(name="fast", speed=377.0, torque=200.0, inlet_temperature={"test.gear_oil": 343.0}),
)
CHANNELS = (
    Channel(name="torque", quantity="torque", place="wheel_side", orders=(0.0, 1.0, 28.0, 29.0)),
    Channel(name="pinion", quantity="torque", place="pinion_side", orders=(0.0, 1.0, 28.0, 29.0)),
    Channel(name="angle", quantity="angle", place="test_pinion", orders=(1.0, 28.0)),
    Channel(name="first", quantity="natural_frequency", place="1"),
    Channel(name="third", quantity="natural_frequency", place="3"),
    Channel(name="oil", quantity="oil_outlet_temperature", place="test.gear_oil"),
    Channel(name="power", quantity="motor_power", place="motor"),
)
REMAINDER = {"rtol": 1e-8, "atol": 1e-10}
"""What an iterated response leaves: chords next to the solution end 7e-10 from the Newton steps that froze them."""
FULL = (
    349.61427944544977,
    0.48862290543740716,
    -0.0017741181432078903,
    2.140917741721871,
    -0.48829357289905434,
    0.0011754422792144752,
    0.00519562805960786,
    -353.2110990763948,
    -0.4890237613980872,
    -0.021167635514410213,
    26.265347900255783,
    -3.9324789707025087,
    0.015844981661198364,
    0.057572221892018056,
    3.6952800986315334e-06,
    8.993775399206705e-05,
    0.0004058710459771405,
    -5.346965046695847e-05,
    337.95365529452147,
    700.6057564278319,
    199.89762201334227,
    0.49136364411323713,
    -0.0012578288540785248,
    -0.8723664457872138,
    3.0181779637989017,
    0.0006005965930316032,
    -0.0016220878999894154,
    -202.97557317391912,
    -0.47327683405206106,
    -0.01204662879213992,
    -1.0882049380905532,
    -1.4080900122078368,
    0.0038396073792262455,
    0.0013179578321429071,
    -1.4305407482818973e-05,
    3.876473385436876e-06,
    -1.750915166584684e-05,
    3.3454774168635096e-07,
    350.59541943725617,
    2356.614404033951,
    477.3774898892821,
    903.9928532120248,
)
"""Of the case with a run-out of 10 um, by the full model; its orders with the whole tangent over the angle."""
STIFFER = (
    349.6115662526778,
    0.0,
    0.0,
    2.1094183183588817,
    -0.4727260033871864,
    0.0,
    0.0,
    -353.20745035092676,
    0.0,
    0.0,
    26.09270004985516,
    -3.8153420568258483,
    0.0,
    0.0,
    0.0,
    0.0,
    0.0004032963601202046,
    -5.1650465557424014e-05,
    337.95161035404476,
    700.4522065381193,
    199.89692375951452,
    0.0,
    0.0,
    -0.9885842638454867,
    2.791128337852922,
    0.0,
    0.0,
    -202.97495574689222,
    0.0,
    0.0,
    -1.0639553656049117,
    -1.3618004505468504,
    0.0,
    0.0,
    0.0,
    0.0,
    -1.7461639149101572e-05,
    4.059353125191603e-07,
    350.59544070961476,
    2356.527400492659,
    477.43973854166626,
    913.9504008621291,
)
"""First-order response to a coupling of 1e5 N m/rad on the wheel side."""


def test_the_full_model_gives_the_frozen_numbers():
    found = predict(CASE.with_value(RUN_OUT, "10 um"), SETTINGS, CHANNELS, circuit=TORSIONAL)
    np.testing.assert_allclose(found.values, FULL, **REMAINDER)


def test_the_first_order_model_gives_the_frozen_numbers():
    predictor = Predictor(CASE, SETTINGS, CHANNELS, circuit=TORSIONAL)
    found = predictor.response({"drivetrain.couplings.wheel_side.torsional_stiffness": 1e5})
    np.testing.assert_allclose(found, STIFFER, rtol=1e-7, atol=1e-9)


def test_shafts_that_bend_are_what_the_case_predicts_with():
    """Bending takes the first torsional mode down by 3 % and leaves mean torques within a thousandth."""
    bending = predict(CASE, SETTINGS, CHANNELS)
    values = dict(zip(bending.features, bending.values, strict=True))
    frozen = dict(zip(bending.features, FULL, strict=True))
    for feature, value in values.items():
        if feature.channel == "first":
            assert value / frozen[feature] == pytest.approx(0.971, abs=0.005)
        if feature.channel in ("torque", "pinion") and feature.order == 0.0:
            assert value == pytest.approx(frozen[feature], rel=1e-3)
        if feature.channel == "torque" and feature.order == 28.0 and feature.setting == "slow":
            assert value != pytest.approx(frozen[feature], rel=0.5)
