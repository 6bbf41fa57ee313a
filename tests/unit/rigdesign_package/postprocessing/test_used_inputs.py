"""Inputs that were accepted and ignored: each moves a result now, or is refused."""

from pathlib import Path

import pytest

from rigdesign import load_case
from rigdesign.base.errors import CaseError
from rigdesign.base.part_name import MeshName
from rigdesign.case import Case
from rigdesign.postprocessing.curves import iso_factor
from rigdesign.rig.model import build_rig
from rigdesign.run import main as run
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"
SOFT = """
extends = "{base}"
[materials.soft]
title = "42CrMo4, through-hardened"
conductivity = "42 W/(m K)"
expansion_coefficient = "11.5e-6 1/K"
elastic_modulus = "206 GPa"
poisson_ratio = 0.3
density = "7830 kg/m3"
root_strength = "600 MPa"
flank_strength = "700 MPa"
treatment = "through_hardened"
[gearboxes.test.gears.wheel]
material = "soft"
"""


def test_a_soft_flank_runs_in_more(tmp_path: Path) -> None:
    """160 f / sigma_Hlim, at most 6400 / sigma_Hlim above 10 m/s, instead of 7.5 % (ISO 6336-1, 6.5.4)."""
    file = tmp_path / "case.toml"
    file.write_text(SOFT.format(base=(PROTOTYPE / "case.toml").as_posix()))
    hard, soft = (
        iso_factor(build_rig(case, "quick"), MeshName("test", "main"), 180.0, 1256.6)
        for case in (load_case(PROTOTYPE), load_case(file))
    )
    pitch = hard.f_pb_eff / 0.925
    assert hard.y_p == pytest.approx(0.075 * pitch)
    assert soft.y_p == pytest.approx(min(160.0 * pitch / 700.0, 6400.0 / 700.0), rel=1e-6)
    assert soft.K_V < hard.K_V


def test_a_schedule_for_simulation_only_marks_its_result() -> None:
    case = load_case(PROTOTYPE / "run_up_simulation.toml")
    (finding,) = run._doubts(case)
    assert finding.id == "simulation_only"
    assert "does not release the rig" in finding.text
    assert "exceeds the start torque" in run._case_record(case)["simulation_only"]
    shipped = load_case(PROTOTYPE)
    assert run._doubts(shipped) == []
    assert "simulation_only" not in run._case_record(shipped)


@pytest.mark.parametrize(
    "path",
    ["drivetrain.motor.power_limit", "drivetrain.bracing.actuator_force_limit", "test_plan.load_cycles"],
)
def test_keys_that_nothing_read_are_gone(path: str) -> None:
    """Their limits stand under limits.bought_parts and limits.specimen."""
    case: Case = load_case(PROTOTYPE)
    with pytest.raises(CaseError, match="no such path"):
        case.with_value(path, "1")
