"""Rules register once, each check finds its family, and what a family declares reaches its check."""

from dataclasses import replace

import pytest

from rigdesign import checks
from rigdesign.base.fidelity import Fidelity
from rigdesign.case import Case, load_case
from rigdesign.case.paths import known_paths
from rigdesign.checks.assumptions import depends
from rigdesign.checks.registry import LOADS, REGISTRY, Registry, RigRule, RuleFamily, Topic
from rigdesign.checks.rules import hold
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import NO_HOUSING, NO_LIMIT, NO_LOADS, Check, HandCalculation
from rigdesign.results.units import KELVIN, MICROMETRE, DisplayUnit
from rigdesign.rig.model import build_rig
from tests.builders.paths import CASES

PROTOTYPE = CASES / "uhcf_prototype"


@pytest.fixture(scope="module")
def case() -> Case:
    return load_case(PROTOTYPE)


@pytest.fixture(scope="module")
def solved(case: Case) -> SolvedRig:
    return SolvedRig(rig=build_rig(case, "quick"), points=())


def rule(**changes: object) -> RigRule:
    """A rule on two made-up temperature differences, 3 K and 5 K, below 10 K."""
    made = RigRule(
        key="temperature.difference", title="difference", unit=KELVIN, group="temperatures", source="a test",
        procedure="The larger of two numbers.",
        limit=lambda limits: 10.0, values=lambda solved: ((3.0, "first"), (5.0, "second")),
    )  # fmt: skip
    return replace(made, **changes)  # type: ignore[arg-type]


def test_the_worst_place_governs_by_the_sense_of_the_rule(solved: SolvedRig) -> None:
    check = rule().check(solved)
    assert (check.value, check.limit, check.reason, check.verdict) == (5.0, 10.0, "second", "pass")
    least = rule(comparison=">=").check(solved)
    assert (least.value, least.reason, least.verdict) == (3.0, "first", "fail")


def test_value_and_limit_are_shown_in_the_unit_of_the_rule(solved: SolvedRig) -> None:
    thin = rule(
        unit=MICROMETRE, limit=lambda limits: 1e-5, values=lambda solved: [(7e-6, "x")], comparison=">="
    )
    check = thin.check(solved)
    assert (check.value, check.limit, check.unit) == (pytest.approx(7.0), pytest.approx(10.0), "um")


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"limit": lambda limits: None}, NO_LIMIT),
        ({"values": lambda solved: (), "absent": "no such place"}, "no such place"),
        ({"values": lambda solved: (), "absent": lambda solved: solved.case.name}, "uhcf_prototype"),
    ],
)
def test_what_is_missing_is_the_reason_why_a_rule_does_not_apply(
    solved: SolvedRig, changes: dict[str, object], reason: str
) -> None:
    check = rule(**changes).check(solved)
    assert (check.verdict, check.reason) == ("not applicable", reason)


@pytest.mark.parametrize("changes", [{"needs": LOADS}, {"values": lambda solved: ()}])
def test_a_limit_whose_value_this_run_has_not_computed_is_open(
    solved: SolvedRig, changes: dict[str, object]
) -> None:
    """No loads, though the case has a drivetrain; no housing, though the limit is on one."""
    check = rule(**changes).check(solved)
    assert check.verdict == "open" and check.reason in (NO_LOADS, NO_HOUSING)


def test_a_key_is_registered_once() -> None:
    registry = Registry()
    registry.register(Topic(order=2, families=(rule(),), checks=lambda solved: ()))
    with pytest.raises(ValueError, match=r"temperature\.difference is registered twice"):
        registry.register(Topic(order=1, families=(rule(),), checks=lambda solved: ()))
    first = registry.register(Topic(order=1, families=(), checks=lambda solved: ()))
    assert registry.topics()[0] is first


def family(key: str) -> RuleFamily:
    return next(found for found in REGISTRY.families() if found.key == key)


def check_of(identity: str) -> Check:
    return hold(replace(rule().rule(10.0), id=identity), 1.0)


def test_a_check_finds_its_family_by_the_beginning_of_its_id(case: Case) -> None:
    for identity, key in (
        ("dynamics.lift_off.test.a", "dynamics.lift_off"),
        ("ramp.start_torque", "ramp.start_torque"),
        ("bought_part.motor", f"bought_part.{case.limits.bought_parts['motor'].quantity}"),
    ):
        assert REGISTRY.family_of(case, check_of(identity)) is family(key)
    with pytest.raises(KeyError, match="no rule is registered for check temperature_of_the_moon"):
        REGISTRY.family_of(case, check_of("temperature_of_the_moon.x"))


def test_an_influence_of_one_gearbox_stays_in_it(case: Case) -> None:
    grade = "gearboxes.reference.gears.pinion.quality_grade"
    assert depends(case, check_of("strength.root_safety_iso.reference.pinion"), grade)
    assert not depends(case, check_of("specimen.root_stress_iso.test.pinion"), grade)


def test_every_family_says_how_its_value_is_computed() -> None:
    for found in REGISTRY.families():
        assert found.procedure.endswith(".") and len(found.procedure) > 20, found.key


def test_every_rule_has_a_limit_that_the_case_may_state(case: Case) -> None:
    paths = set(known_paths(Case, case.model_dump(mode="python")))
    for found in REGISTRY.families():
        for one in found.rules(case):
            assert found.limits_of(one) and set(found.limits_of(one)) <= paths, one.id


def test_a_limit_of_zero_degrees_is_shown_as_such() -> None:
    assert DisplayUnit("degC", zero=273.15).shown(273.15) == 0.0


def failing(identity: str) -> Check:
    return hold(replace(rule().rule(10.0), id=identity), 12.0)


def test_a_failing_check_names_what_makes_its_value_doubtful(
    monkeypatch: pytest.MonkeyPatch, solved: SolvedRig
) -> None:
    """A source from memory, and a calculation by hand that does not agree; one that holds by far says neither."""
    scuffing, bulk = failing("flank.scuffing_safety.test"), failing("temperature.gear_bulk")
    held = hold(replace(rule().rule(10.0), id="temperature.housing"), 1.0)
    monkeypatch.setattr(checks, "estimated_checks", lambda solved: [scuffing, bulk, held])
    rows = [
        HandCalculation(quantity=quantity, computed=computed, by_hand=by_hand, unit="W", formula="")
        for quantity, computed, by_hand in (
            ("sliding loss, test.main", 176.0, 240.0),
            ("windage, test.main", 1.0, 2.0),
        )
    ]
    first, second, third = checks.all_checks(solved, rows)
    assert first.flags == second.flags == ("doubt",) and first.verdict == "fail"
    assert "from memory" in first.reason and "sliding loss, test.main: 176 W, by hand 240 W" in first.reason
    assert "by hand" in second.reason and "from memory" not in second.reason
    assert third.flags == () and third.reason == ""


@pytest.mark.parametrize(
    ("key", "fidelity", "value", "verdict"),
    [("strength.root_safety", "quick", 1.1, "open"), ("strength.root_safety", "standard", 1.1, "pass"),
     ("strength.root_safety", "quick", 1.2, "pass"), ("strength.root_safety", "standard", 0.97, "open"),
     ("flank.pitting_safety", "quick", 1.05, "open"), ("flank.pitting_safety", "standard", 1.05, "pass"),
     ("dynamics.resonance_distance", "quick", 1.01, "pass"), ("oil.flow", "quick", 1.01, "pass")],
)  # fmt: skip
def test_what_follows_the_load_over_the_face_carries_the_error_of_its_positions(
    key: str,
    fidelity: Fidelity,
    value: float,
    verdict: str,
    monkeypatch: pytest.MonkeyPatch,
    solved: SolvedRig,
) -> None:
    check = hold(replace(rule(comparison=">=").rule(1.0), id=f"{key}.test"), value)
    monkeypatch.setattr(checks, "held_checks", lambda solved: [check])
    own = replace(solved, rig=replace(solved.rig, fidelity=fidelity))
    assert checks.estimated_checks(own)[0].verdict == verdict
