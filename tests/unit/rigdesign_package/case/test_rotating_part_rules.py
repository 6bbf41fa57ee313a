"""Unbalance, bow, run-out and misalignment that cannot be: path, value, limit and remedy of every fault."""

from typing import Any

import pytest

from rigdesign.base.errors import CaseError
from rigdesign.case.loader import load_case
from rigdesign.case.rules.elastic_shafts import rotating_part_faults
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
SHAFT, COUPLING = "drivetrain.shafts.test_pinion", "drivetrain.couplings.wheel_side"


def changed(values: dict[str, Any]) -> Any:
    return load_case(PROTOTYPE).with_values(values)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (
            {f"{SHAFT}.unbalances": {"disc": {"position": "900 mm", "unbalance": "50 g mm"}}},
            (f"{SHAFT}.unbalances.disc.position", "900 mm", "beyond the end of the shaft at", "lies on it"),
        ),
        (
            {f"{SHAFT}.unbalances": {"disc": {"position": "100 mm", "unbalance": "50 g"}}},
            ("unbalance", "50 g mm"),
        ),
        (
            {f"{SHAFT}.bow.amplitude": "10 um", f"{SHAFT}.bow.position": "67.58 mm"},
            (f"{SHAFT}.bow.position", "is at a bearing, 67.58 mm", "between the bearings or beyond"),
        ),
        ({f"{SHAFT}.bow.angle": "10 deg"}, ("neither an amplitude nor a temperature difference",)),
        (
            {f"{SHAFT}.balance_speed": "0 rpm"},
            ("is not above 0 rpm", "leave it out for that of the schedule"),
        ),
        (
            {"drivetrain.shaft_model": "torsional", f"{SHAFT}.balance_grade": 2.5},
            (f"{SHAFT}.balance_grade", 'shaft_model = "torsional"', '"elastic"'),
        ),
        (
            {"drivetrain.shaft_model": "torsional", "drivetrain.balance_grade": 2.5},
            ("drivetrain.balance_grade", "only twist"),
        ),
        ({"drivetrain.shafts.ghost.balance_grade": 2.5}, ("ghost",)),
    ],
)
def test_a_part_that_cannot_be_is_refused(values: dict[str, Any], said: tuple[str, ...]) -> None:
    with pytest.raises(CaseError) as refused:
        changed(values)
    for words in said:
        assert words in str(refused.value)


@pytest.mark.parametrize(
    ("key", "value", "stiffness"),
    [
        ("flange_run_out", 20e-6, "radial_stiffness"),
        ("flange_tilt", 1e-4, "angular_stiffness"),
        ("cold_angle_lateral", 1e-3, "angular_stiffness"),
    ],
)
def test_an_offset_needs_a_coupling_that_resists_it(key: str, value: float, stiffness: str) -> None:
    case = load_case(PROTOTYPE)
    assert case.drivetrain is not None
    soft = case.drivetrain.couplings["wheel_side"].model_copy(update={key: value, stiffness: None})
    train = case.drivetrain.model_copy(update={"couplings": {"wheel_side": soft}})
    (fault,) = rotating_part_faults(case.model_copy(update={"drivetrain": train}))
    assert fault.path == f"{COUPLING}.{key}"
    assert f"states no {stiffness}" in fault.problem and f"add {stiffness}" in fault.remedy


def test_a_bow_needs_two_bearings() -> None:
    """A shaft on one bearing and a coupling has no line to bend away from."""
    whole = changed({f"{SHAFT}.bow.amplitude": "10 um"})
    boxes = whole.gearboxes["test"]
    one = {name: part for name, part in boxes.bearings.items() if name != "pinion_rear"}
    case = whole.model_copy(update={"gearboxes": {"test": boxes.model_copy(update={"bearings": one})}})
    (fault,) = rotating_part_faults(case)
    assert fault.path == f"{SHAFT}.bow"
    assert "1 at places of their own, must be 2" in str(fault)


def test_a_cross_joint_may_stand_at_an_angle_without_stiffness() -> None:
    case = changed({f"{COUPLING}.joint": "hooke", f"{COUPLING}.cold_angle_lateral": "20 mrad"})
    assert case.drivetrain is not None and case.drivetrain.couplings["wheel_side"].joint == "hooke"


def test_an_assumed_grade_is_listed_with_its_range() -> None:
    def listed(case: Any) -> list[Any]:
        return [one for one in case.assumptions if one.path == "drivetrain.balance_grade"]

    (found,) = listed(load_case(PROTOTYPE))
    assert (found.value, found.range) == ("2.5", ("1", "6.3"))
    assert listed(changed({"drivetrain.balance_grade": 1.0})) == []
    grades = {
        f"drivetrain.shafts.{name}.balance_grade": 1.0 for name in load_case(PROTOTYPE).drivetrain.shafts
    }
    assert listed(changed(grades)) == []
