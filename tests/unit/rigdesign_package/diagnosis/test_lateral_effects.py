"""Effects of shafts that bend: where they are evaluated, what they change, and that the model answers as a full run."""

import pickle
from functools import cache

import numpy as np
import pytest

from rigdesign.case import Case
from rigdesign.diagnosis.catalogue import effects_of
from rigdesign.diagnosis.catalogue.effects import Effect
from rigdesign.prediction.model import (
    MEASURED_AGAINST,
    OWN_MODEL,
    Channel,
    OperatingCondition,
    changed_case,
    measured_against,
)
from rigdesign.prediction.predict import Predictor, predict
from tests.builders.order import shipped

TORQUE = Channel(name="M", quantity="torque", place="wheel_side", orders=(0.0, 1.0))
FRONT = Channel(
    name="s", quantity="shaft_displacement", place="test.pinion_front", direction=(0.0, 1.0, 0.0), orders=(1.0, 28.0)
)  # fmt: skip
HOUSING = Channel(
    name="a", quantity="acceleration", place="test.pinion_rear", direction=(0.0, 0.0, 1.0), orders=(1.0,)
)
CHANNELS = (TORQUE, FRONT, HOUSING)
POINT = OperatingCondition(name="P01", speed=250.0, torque=300.0)
EXCITATIONS = ("unbalance:test_pinion", "shaft_bow:test_pinion", "flange_run_out:pinion_side")


@cache
def lateral() -> dict[str, Effect]:
    return {effect.name: effect for effect in effects_of(shipped("loop_1to1"), channels=CHANNELS)}


@cache
def predictor() -> Predictor:
    return Predictor(shipped("loop_1to1"), [POINT], CHANNELS, circuit=measured_against(CHANNELS))


def test_sets_without_lateral_channels_keep_their_catalogue() -> None:
    case = shipped("loop_1to1")
    without = effects_of(case, channels=[TORQUE])
    assert [effect.name for effect in without] == [effect.name for effect in effects_of(case)]
    assert not any(effect.bends for effect in without)
    assert measured_against([]) == MEASURED_AGAINST and measured_against(CHANNELS) == OWN_MODEL
    kinds = {effect.kind for effect in lateral().values() if effect.bends}
    assert kinds == {"unbalance", "shaft_bow", "flange_run_out", "flange_tilt", "bearing_clearance"}
    twisting = case.with_value("drivetrain.shaft_model", "torsional")
    assert not any(effect.bends for effect in effects_of(twisting, channels=CHANNELS))


def test_what_the_case_has_decides_which_bearing_entry_there_is() -> None:
    values: dict[str, object] = {
        "drivetrain.bearing_coefficients": "stated",
        "drivetrain.couplings.wheel_side.joint": "hooke",
        "gearboxes.test.bearings.pinion_front.support_stiffness": "5e8 N/m",
    }
    for box, entry in shipped("loop_1to1").gearboxes.items():
        values |= {f"gearboxes.{box}.bearings.{name}.radial_stiffness": "1e8 N/m" for name in entry.bearings}
    found = {
        effect.name: effect for effect in effects_of(shipped("loop_1to1").with_values(values), channels=None)
    }
    assert "bearing_stiffness:test.pinion_front" in found
    assert "bearing_clearance:test.pinion_front" not in found
    assert [name for name in found if name.startswith("support_stiffness")] == [
        "support_stiffness:test.pinion_front"
    ]
    changed = found["support_stiffness:test.pinion_front"].changes(
        shipped("loop_1to1"), (float(np.log(2.0)),)
    )
    assert changed == {"gearboxes.test.bearings.pinion_front.support_stiffness": pytest.approx(1e9)}
    assert "cross_joint_angle:wheel_side" in found


@pytest.mark.parametrize("name", [*EXCITATIONS, "flange_tilt:pinion_side"])
def test_parts_along_cosine_and_sine_add_up(name: str) -> None:
    """Twice half of it is all of it, beside what the case states already."""
    effect = lateral()[name]
    whole = (0.2 * effect.parameters[0].high, -0.1 * effect.parameters[0].high)
    half = (0.5 * whole[0], 0.5 * whole[1])
    case = shipped("loop_1to1").with_values(
        {
            "drivetrain.shafts.test_pinion.unbalances": {"key": {"position": "20 mm", "unbalance": "5 g mm"}},
            "drivetrain.shafts.test_pinion.bow": {
                "amplitude": "3 um",
                "position": "60 mm",
                "angle": "40 deg",
            },
        }
    )
    (effect,) = (one for one in effects_of(case, channels=CHANNELS) if one.name == name)
    once = changed_case(case, effect.changes(case, whole))
    assert (
        once.drivetrain is not None
        and once.drivetrain.shafts["test_pinion"].unbalances["key"].unbalance > 0.0
    )
    first = changed_case(case, effect.changes(case, half))
    (again,) = (one for one in effects_of(first, channels=CHANNELS) if one.name == name)
    twice = changed_case(first, again.changes(first, half))
    assert _numbers(twice) == pytest.approx(_numbers(once), rel=1e-9)


def _numbers(case: Case) -> list[float]:
    """Every number of the power circuit, in order."""
    assert case.drivetrain is not None
    pending: list[object] = [case.drivetrain.model_dump()]
    found: list[float] = []
    while pending:
        node = pending.pop()
        if isinstance(node, dict):
            pending += node.values()
        elif isinstance(node, list | tuple):
            pending += node
        elif isinstance(node, int | float):
            found.append(float(node))
    return found


def test_an_unbalance_that_is_found_leaves_the_balance_grade() -> None:
    """Stated unbalances take the place of the grade, the one found must not."""
    case = shipped("loop_1to1")
    found = case.with_values(lateral()["unbalance:test_pinion"].changes(case, (1e-5, 0.0)))
    assert found.drivetrain is not None
    assert found.drivetrain.shafts["test_pinion"].balance_grade == 2.5


@pytest.mark.parametrize("name", EXCITATIONS)
def test_answers_are_those_of_a_full_run(name: str) -> None:
    """The library takes the modes of the rig as it stands; a run of its own makes them anew."""
    effect = lateral()[name]
    assert effect.oscillates
    changes = effect.changes(shipped("loop_1to1"), (0.05 * effect.reach, 0.02 * effect.reach))
    answer = predictor().oscillating(changes) - predictor().base
    case = changed_case(shipped("loop_1to1"), changes)
    full = predict(case, [POINT], CHANNELS, circuit=OWN_MODEL).values - predictor().base
    shaft = [
        i for i, one in enumerate(predictor().features) if one.order == 1.0 and one.channel in ("s", "a")
    ]
    assert answer[shaft] == pytest.approx(full[shaft], abs=2e-3 * float(np.abs(full[shaft]).max()))
    assert float(np.abs(answer[shaft]).max()) > 0.0


def test_a_bearing_moves_what_its_shaft_passes_on_of_the_mesh() -> None:
    effect = lateral()["bearing_clearance:test.pinion_front"]
    tight = effect.changes(shipped("loop_1to1"), (-0.3,))
    moved = predictor().values(tight) - predictor().base
    of_mesh = [i for i, one in enumerate(predictor().features) if (one.channel, one.order) == ("s", 28.0)]
    base = predictor().base[of_mesh]
    assert 0.05 < np.linalg.norm(moved[of_mesh]) / np.linalg.norm(base) < 1.0


def test_entries_survive_the_way_to_another_core() -> None:
    for name in EXCITATIONS:
        again: Effect = pickle.loads(pickle.dumps(lateral()[name]))
        assert again.changes(shipped("loop_1to1"), (1e-6, 0.0)) == lateral()[name].changes(
            shipped("loop_1to1"), (1e-6, 0.0)
        )
