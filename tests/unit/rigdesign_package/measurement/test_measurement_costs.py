"""Costs of further sensors and points in measurement.toml: known items, above zero."""

from pathlib import Path

import pytest

from rigdesign.base.errors import MeasurementError
from rigdesign.case import load_case
from rigdesign.measurement import load_measurement
from tests.builders.motor_power_set import motor_power_set
from tests.builders.paths import CASES


def written(folder: Path, costs: str) -> Path:
    return motor_power_set(folder, first=f"costs = {costs}")


def test_costs_are_read(tmp_path: Path) -> None:
    read = load_measurement(
        written(tmp_path, "{ temperature = 150, reassembly = 800.0 }"), load_case(CASES / "loop_1to1")
    )
    assert read.costs == {"temperature": 150.0, "reassembly": 800.0}


@pytest.mark.parametrize(
    ("costs", "message"),
    [
        ("{ thermocouple = 150 }", "costs.*thermocouple.*no such sensor or point.*temperature"),
        ("{ torque = 0.0 }", "costs.torque.*greater than 0"),
    ],
)
def test_an_unknown_item_or_no_cost_is_a_fault(tmp_path: Path, costs: str, message: str) -> None:
    with pytest.raises(MeasurementError, match=message):
        load_measurement(written(tmp_path, costs), load_case(CASES / "loop_1to1"))
