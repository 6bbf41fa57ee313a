"""The minimal case runs: from what its owner knows to a verdict, every default listed as an assumption."""

import pytest

from rigdesign.case import load_case
from rigdesign.case.defaults.rule import BY_THE_TOOL
from rigdesign.results.result import RunResult
from rigdesign.run.main import run_case
from tests.builders.minimal_case import MINIMAL, MOST_LINES, minimal_case

pytestmark = pytest.mark.whole_run
NUMERICS = """
[numerics]
curve_speeds = 2
curve_speed_start = "2200 rpm"
curve_speed_end = "2300 rpm"
[limits]
standard_set = true
bearing.start_torque_limit = "400 N m"
"""
"""The curve at its held speed, and no errors of checks at the lower speeds of its ramps."""


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> RunResult:
    assert len((MINIMAL + NUMERICS).splitlines()) <= MOST_LINES
    return run_case(load_case(minimal_case(tmp_path_factory.mktemp("minimal"), NUMERICS)), fidelity="quick")


def test_it_comes_to_a_verdict(result: RunResult) -> None:
    applied = {check.id for check in result.checks if check.verdict != "not applicable"}
    assert {
        "temperature.oil_outlet",
        "dynamics.dynamic_factor.test",
        "clearance.bearing_clearance",
    } <= applied
    assert len(applied) >= 20 and result.verdict in ("pass", "open", "fail")


def test_its_losses_are_those_of_the_hand_calculation(result: RunResult) -> None:
    """P H_V mu with H_V = 0.2 and mu = 0.05 to 0.065 of Schlenk: 880 to 1150 W of 87.8 kW."""
    mesh = [loss.power for loss in result.losses if loss.place.startswith("test") and loss.kind == "mesh"]
    assert max(mesh) == pytest.approx(1000.0, rel=0.2)


def test_every_default_is_an_assumption_of_the_report(result: RunResult) -> None:
    reasons = {record.path: record.reason for record in result.assumptions}
    for path in (
        "gearboxes.test.gears.pinion.tooth_thinning",
        "gearboxes.slave.meshes.main.damping_ratio",
        "drivetrain.motor.torque_limit",
        "losses.chamber_density",
        "numerics.sample_rate",
        "limits.strength.root_safety_minimum",
    ):
        assert reasons[path].startswith(BY_THE_TOOL), path
