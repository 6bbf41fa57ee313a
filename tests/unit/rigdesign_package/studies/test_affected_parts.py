"""What is solved again of a case with changed inputs, and when the time run may be shifted instead of marched."""

import pytest

from rigdesign import Case, load_case
from rigdesign.case.fields import MODEL_PARTS
from rigdesign.studies.modified_rig import Reanalysis, reanalysis

INLET = "gearboxes.test.oil.inlet_temperature"


@pytest.fixture(scope="module")
def prototype() -> Case:
    return load_case("uhcf_prototype")


def test_heat_moves_all_parts_and_shifts_the_time_run(prototype: Case) -> None:
    assert reanalysis(prototype, [INLET]) == Reanalysis(prototype, MODEL_PARTS, "shifted")
    more = [INLET, "ambient.temperature", "limits.oil.flow_maximum"]
    assert reanalysis(prototype, more) == Reanalysis(prototype, MODEL_PARTS, "shifted")


def test_limits_move_checks_alone(prototype: Case) -> None:
    assert reanalysis(prototype, ["limits.oil.flow_maximum"]) == Reanalysis(prototype, (), "shifted")


def test_what_marches_the_run_marches_it_together_with_heat(prototype: Case) -> None:
    found = reanalysis(prototype, [INLET, "schedule.stages.run_up.duration"])
    assert found == Reanalysis(prototype, MODEL_PARTS, "marched")


@pytest.mark.parametrize(
    "path", ["schedule.test_torque", "gearboxes.test.gears.pinion.face_width", "losses.bearing_drag"]
)
def test_other_inputs_are_solved_in_full(prototype: Case, path: str) -> None:
    assert reanalysis(prototype, [INLET, path]) is None


def test_a_bracing_that_follows_the_oil_is_marched(prototype: Case) -> None:
    drifting = prototype.with_value("drivetrain.bracing.temperature_drift", 0.002)
    assert reanalysis(drifting, [INLET]) == Reanalysis(drifting, MODEL_PARTS, "marched")


def test_a_bracing_that_holds_its_twist_is_marched(prototype: Case) -> None:
    held = prototype.with_value("drivetrain.bracing.mode", "twist_held")
    assert reanalysis(held, [INLET]) == Reanalysis(held, MODEL_PARTS, "marched")


def test_a_constant_bearing_drag_is_part_of_the_drivetrain(prototype: Case) -> None:
    constant = prototype.with_value("losses.bearing_drag", "constant")
    assert reanalysis(constant, ["gearboxes.test.loss_factors.bearing"]) is None
    assert reanalysis(prototype, ["gearboxes.test.loss_factors.bearing"]) == Reanalysis(
        prototype, MODEL_PARTS, "shifted"
    )
