"""Operating points of a rig with sumps: the temperature of the oil is that of the sump, and a sump has no flow."""

import pytest

from rigdesign.base.errors import UsageError
from rigdesign.case import load_case
from rigdesign.prediction import OperatingCondition
from rigdesign.prediction.full import case_at
from rigdesign.prediction.reduced_rig import moved_conditions
from tests.builders.paths import CASES

CASE = load_case(CASES / "fzg")
COLDER = 333.15


def point(**keys: object) -> OperatingCondition:
    return OperatingCondition(name="P", speed=200.0, torque=100.0, **keys)  # type: ignore[arg-type]


def test_the_sump_has_the_temperature_of_the_point() -> None:
    case = case_at(CASE, point(inlet_temperature={"test.gear_oil": COLDER}))
    sump = case.gearboxes["test"].sump
    assert sump is not None and sump.sump_temperature == COLDER
    assert case.gearboxes["test"].gear_oil_temperature == COLDER


def test_the_temperature_of_a_held_sump_is_an_input_of_the_point() -> None:
    moved, step = moved_conditions(CASE, point(inlet_temperature={"test.gear_oil": COLDER}))[
        "inlet_temperature", "test.gear_oil"
    ]
    assert moved.inlet_temperature["test.gear_oil"] == pytest.approx(COLDER + step) and step > 0.0


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"flow": {"test.gear_oil": 1e-5}}, r"flow of test.gear_oil, which has dip lubrication.*remove it"),
        ({"inlet_temperature": {"test.bearing_oil": 350.0}}, r"inlet temperature of test.bearing_oil"),
    ],
)
def test_what_a_rig_with_sumps_does_not_have_is_refused(keys: dict[str, object], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        case_at(CASE, point(**keys))
