"""Which assumed inputs a check of the shipped case depends on, by the table of the checks."""

import json
import re
from pathlib import Path

import pytest

from rigdesign.case import Case, load_case
from rigdesign.checks.assumptions import depends, is_under, with_assumptions
from tests.builders.checks import check, limit_of, rule_ids
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"

NOTHING = (
    r"gearboxes\.reference\.seals\..*\.axial_travel",  # without a housing: no growth, no heat to split
    r"gearboxes\.reference\.heat_split\..*",
)
"""Assumed inputs of the shipped case that no check depends on."""


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(PROTOTYPE)


def test_every_assumed_input_decides_a_check_or_is_known_to_decide_none(case: Case) -> None:
    checks = [check(identity, limit_of(identity)) for identity in rule_ids(case)]
    behind = {path for one in checks for path in with_assumptions(case, one).assumptions}
    idle = [record.path for record in case.assumptions if record.path not in behind]
    assert all(any(re.fullmatch(one, path) for path in idle) for one in NOTHING)
    assert [path for path in idle if not any(re.fullmatch(one, path) for one in NOTHING)] == []


@pytest.mark.parametrize(
    ("identity", "path"),
    [
        ("clearance.backlash", "gearboxes.test.gears.pinion.tooth_thinning"),
        ("clearance.seal_gap", "gearboxes.test.seals.wheel.radial_gap"),
        ("clearance.bearing_clearance", "gearboxes.test.bearings.pinion_front.diametral_clearance"),
        ("bearing.minimum_film", "gearboxes.reference.bearing_oil.flow"),
        ("dynamics.lift_off.test", "gearboxes.test.gears.pinion.profile_shift"),
        ("specimen.load_cycles", "test_plan.time"),
        ("strength.root_safety_iso.reference.wheel", "limits.strength.root_safety_minimum"),
        ("temperature.gear_bulk", "gearboxes.test.housing.boundary.gear_rims.heat_transfer_coefficient"),
        ("bought_part.motor", "limits.bought_parts.motor.limit"),
    ],
)
def test_what_makes_a_value_is_listed_with_it(case: Case, identity: str, path: str) -> None:
    assert path in with_assumptions(case, check(identity)).assumptions


@pytest.mark.parametrize(
    ("identity", "path"),
    [
        ("dynamics.dynamic_factor.test", "drivetrain.motor.torque_limit"),
        ("dynamics.dynamic_factor.test", "drivetrain.bracing.spline_friction_coefficient"),
        ("dynamics.dynamic_factor.test", "gearboxes.test.gears.pinion.quality_grade"),
        ("specimen.root_stress_iso.test.pinion", "gearboxes.reference.gears.pinion.quality_grade"),
        ("oil.flow", "losses.chamber_density"),
    ],
)
def test_what_does_not_is_not(case: Case, identity: str, path: str) -> None:
    assert any(record.path == path for record in case.assumptions)
    assert path not in with_assumptions(case, check(identity)).assumptions


def test_the_limit_in_the_source_belongs_to_the_check(case: Case) -> None:
    source = "limits.bearing.film_thickness_minimum; film after ISO 7902-1"
    assert (
        "limits.bearing.film_thickness_minimum"
        in with_assumptions(case, check("bearing.specific_load", source)).assumptions
    )


def test_a_rule_that_does_not_apply_depends_on_nothing(case: Case) -> None:
    assert with_assumptions(case, check("clearance.backlash", verdict="not applicable")).assumptions == ()


def test_a_star_stands_for_one_name() -> None:
    assert is_under("gearboxes.test.gears.pinion.flank.tip_relief", "gearboxes.*.gears.*.flank")
    assert not is_under("gearboxes.test.housing.gears", "gearboxes.*.gears")
    assert not is_under("losses", "losses.friction")


def test_a_foot_without_a_joint_is_an_assumption(tmp_path: Path) -> None:
    """What a case leaves out and an idealisation replaces is listed, and the checks name it."""
    file = tmp_path / "case.toml"
    file.write_text(
        f'extends = "{(PROTOTYPE / "case.toml").as_posix()}"\nname = "bare"\n'
        '[gearboxes.test.housing]\nremove = ["foot_contact"]\n'
    )
    bare = load_case(file)
    path = "gearboxes.test.housing.foot_contact"
    foot = next(entry for entry in bare.assumptions if entry.path == path)
    assert foot.value == "perfect"
    assert "W/(m2 K)" in foot.reason
    hottest = with_assumptions(bare, check("temperature.housing", "limits.temperatures.housing_maximum"))
    assert foot.path in hottest.assumptions


@pytest.mark.parametrize("name", ["uhcf_prototype", "uhcf_main"])
def test_the_feet_of_the_shipped_housings_state_their_joint_with_a_range(name: str) -> None:
    shipped = {record.path: record for record in load_case(PROTOTYPE.parent / name).assumptions}
    assert "gearboxes.test.housing.foot_contact" not in shipped
    joint = shipped["gearboxes.test.housing.foot_contact.conductance"]
    assert joint.range == ("75 W/(m2 K)", "7000 W/(m2 K)")


SPEED_RULES = ("bearing.speed", "specimen.load_cycles", "ramp.test_torque")
"""Arithmetic of schedule and ratios."""


@pytest.mark.parametrize("rule", SPEED_RULES)
@pytest.mark.parametrize(
    ("path", "moves"),
    [
        ("schedule.test_speed", True),
        ("gearboxes.test.gears.pinion.teeth", True),
        ("gearboxes.test.gears.pinion.flank.roughness", False),
        ("gearboxes.test.gears.wheel.face_width", False),
        ("gearboxes.test.meshes.main.centre_distance", False),
        ("gearboxes.test.oil.sump_temperature", False),
        ("gearboxes.test.bearings.pinion_front.radial_clearance", False),
    ],
)
def test_a_rule_of_speeds_depends_on_what_it_reads(rule: str, path: str, moves: bool) -> None:
    assert depends(load_case(PROTOTYPE.parent / "fzg"), check(rule), path) is moves


@pytest.mark.parametrize(("key", "reads"), [("designation", True), ("axial_play", False)])
def test_the_speed_limit_of_a_bearing_is_that_of_its_catalogue(key: str, reads: bool) -> None:
    """NU 406 at 2250 rpm over 11 000 rpm: nothing but these two stands behind the value of the shipped rig."""
    path = f"gearboxes.test.bearings.pinion_front.{key}"
    assert depends(load_case(PROTOTYPE.parent / "fzg"), check("bearing.speed"), path) is reads
    shipped = json.loads((PROTOTYPE.parent / "fzg/expected.json").read_text(encoding="utf-8"))
    assert shipped["checks"]["bearing.speed"]["value"] == pytest.approx(2250 / 11_000, abs=5e-5)
