"""Margin, utilisation and verdict of every kind of rule."""

from typing import Literal

import pytest

from rigdesign.base.errors import NonFiniteResultError
from rigdesign.checks.rules import Rule, hold, not_applicable, overall, with_error
from rigdesign.records.solved_rig import worst


def rule(**changes: object) -> Rule:
    data: dict[str, object] = {
        "id": "x", "title": "x", "unit": "mm", "source": "test", "group": "clearances", "limit": 2.0
    }  # fmt: skip
    return Rule(**(data | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("comparison", "value", "margin", "utilisation", "verdict"),
    [
        ("<=", 1.0, 1.0, 0.5, "pass"),
        ("<=", 1.96, 0.04, 0.98, "warn"),
        ("<=", 3.0, -1.0, 1.5, "fail"),
        (">=", 4.0, 2.0, 0.5, "pass"),
        (">=", 1.0, -1.0, 2.0, "fail"),
        (">=", -1.0, -3.0, 2.5, "fail"),
    ],
)
def test_one_sided_rules(
    comparison: str, value: float, margin: float, utilisation: float, verdict: str
) -> None:
    check = hold(rule(comparison=comparison), value)
    assert check.margin == pytest.approx(margin)
    assert check.utilisation == pytest.approx(utilisation)
    assert check.verdict == verdict


@pytest.mark.parametrize(
    ("value", "margin", "verdict"), [(1.0, -1.0, "fail"), (3.0, 1.0, "pass"), (9.0, -4.0, "fail")]
)
def test_window(value: float, margin: float, verdict: str) -> None:
    check = hold(rule(comparison="within", upper_limit=5.0), value)
    assert check.margin == pytest.approx(margin)
    assert check.verdict == verdict


def test_a_temperature_counts_from_20_degc() -> None:
    """From a fixed temperature: (100 - 20)/(180 - 20), and only a hotter part uses more of its limit."""
    used = [hold(rule(unit="degC", limit=180.0), value).utilisation for value in (100.0, 101.0, 180.0)]
    assert used == pytest.approx([80.0 / 160.0, 81.0 / 160.0, 1.0])
    assert hold(rule(unit="degC", limit=180.0), 5.0).utilisation == 0.0


def test_a_lower_limit_of_zero_is_broken_below_zero_only() -> None:
    assert hold(rule(comparison=">=", limit=0.0), 0.1).verdict == "pass"
    assert hold(rule(comparison=">=", limit=0.0), -0.1).utilisation == pytest.approx(1.1)


def test_doubt_turns_a_pass_into_a_warning_and_leaves_a_fail() -> None:
    assert hold(rule(), 1.0, doubt="outside the regression").verdict == "warn"
    assert hold(rule(), 3.0, doubt="outside the regression").verdict == "fail"


def test_a_rule_of_good_practice_warns() -> None:
    assert hold(rule(advisory=True), 3.0).verdict == "warn"


def test_overall_is_the_worst_applicable_verdict() -> None:
    good, bad = hold(rule(), 1.0), hold(rule(), 3.0)
    skipped = not_applicable(rule(), "no such part")
    assert overall([good, skipped]) == "pass"
    assert overall([good, bad, skipped]) == "fail"


def test_a_rule_without_limit_is_refused() -> None:
    with pytest.raises(ValueError, match="has no limit"):
        hold(rule(limit=None), 1.0)


NOT_FINITE = [float("nan"), float("inf"), float("-inf")]


@pytest.mark.parametrize("value", NOT_FINITE)
@pytest.mark.parametrize("comparison", ["<=", ">=", "within"])
def test_a_value_that_is_no_number_is_no_verdict(
    comparison: Literal["<=", ">=", "within"], value: float
) -> None:
    with pytest.raises(NonFiniteResultError, match="value of check x = "):
        hold(rule(comparison=comparison, upper_limit=5.0), value)


@pytest.mark.parametrize("bad", NOT_FINITE)
def test_a_limit_or_an_error_that_is_no_number_is_no_verdict(bad: float) -> None:
    with pytest.raises(NonFiniteResultError, match="limit of check x = "):
        hold(rule(limit=bad), 1.0)
    with pytest.raises(NonFiniteResultError, match="upper limit of check x = "):
        hold(rule(comparison="within", upper_limit=bad), 3.0)
    with pytest.raises(NonFiniteResultError, match="discretisation error of check x"):
        with_error(hold(rule(), 1.0), bad)


@pytest.mark.parametrize("items", [[(1.0, "a"), (float("nan"), "b")], [(float("nan"), "b"), (1.0, "a")]])
@pytest.mark.parametrize("smallest", [True, False])
def test_the_worst_of_values_of_which_one_is_no_number_is_none(
    items: list[tuple[float, str]], smallest: bool
) -> None:
    with pytest.raises(NonFiniteResultError, match="b = nan"):
        worst(items, smallest=smallest)


@pytest.mark.parametrize(("value", "verdict"), [(2.0, "pass"), (1.96, "pass"), (2.1, "fail")])
def test_a_value_that_the_case_states_is_not_near_its_limit_but_on_it(value: float, verdict: str) -> None:
    stated = hold(rule(by_definition=True), value)
    assert (stated.by_definition, stated.verdict) == (True, verdict)
    assert not hold(rule(), value).by_definition
    assert not_applicable(rule(by_definition=True), "no limit").by_definition
