"""Margin, distance, verdict and flags of every kind of rule."""

from typing import Literal

import pytest

from rigdesign.base.errors import NonFiniteResultError
from rigdesign.checks.rules import Rule, hold, not_applicable, not_evaluated, with_error, worst
from rigdesign.results.check import overall


def rule(**changes: object) -> Rule:
    data: dict[str, object] = {
        "id": "x", "title": "x", "unit": "mm", "source": "test", "group": "clearances", "limit": 2.0
    }  # fmt: skip
    return Rule(**(data | changes))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("comparison", "value", "margin", "distance", "verdict", "flags"),
    [
        ("<=", 1.0, 1.0, 0.5, "pass", ()),
        ("<=", 1.96, 0.04, 0.02, "pass", ("close",)),
        ("<=", 3.0, -1.0, -0.5, "fail", ()),
        (">=", 4.0, 2.0, 0.5, "pass", ()),
        (">=", 1.0, -1.0, -0.5, "fail", ()),
        (">=", -1.0, -3.0, -1.5, "fail", ()),
        ("within", 3.0, 1.0, 1.0 / 3.0, "pass", ()),
        ("within", 9.0, -4.0, -0.8, "fail", ()),
    ],
)
def test_every_comparison(
    comparison: str, value: float, margin: float, distance: float, verdict: str, flags: tuple[str, ...]
) -> None:
    check = hold(rule(comparison=comparison, upper_limit=5.0 if comparison == "within" else None), value)
    assert check.margin == pytest.approx(margin)
    assert check.distance == pytest.approx(distance)
    assert (check.verdict, check.flags) == (verdict, flags)


@pytest.mark.parametrize("limit", [2.0, 0.1, 0.0, -0.01, 180.0])
@pytest.mark.parametrize(("comparison", "sign"), [("<=", -1.0), (">=", 1.0)])
@pytest.mark.parametrize("unit", ["mm", "degC"])
def test_distance_rises_with_the_margin_through_zero_and_below(
    limit: float, comparison: str, sign: float, unit: str
) -> None:
    """A lower limit of 0.1 once gave 10,000 % used at 0.001, 200 % at zero and 223 % at -0.023."""
    margins = sorted([-300.0, -1.0, -0.123, -0.1, -0.099, -1e-6, 0.0, 1e-6, 0.01, 1.0, 50.0])
    stated = rule(limit=limit, comparison=comparison, unit=unit)
    checks = [hold(stated, limit + sign * margin) for margin in margins]
    distances = [check.distance or 0.0 for check in checks]
    assert distances == sorted(distances)
    assert [distance >= 0.0 for distance in distances] == [margin >= 0.0 for margin in margins]
    assert len({round(distance, 9) for distance in distances if distance < 0.0}) == 6


@pytest.mark.parametrize(
    ("value", "margin", "verdict"), [(1.0, -1.0, "fail"), (3.0, 1.0, "pass"), (9.0, -4.0, "fail")]
)
def test_window(value: float, margin: float, verdict: str) -> None:
    check = hold(rule(comparison="within", upper_limit=5.0), value)
    assert check.margin == pytest.approx(margin)
    assert check.verdict == verdict


def test_a_temperature_counts_from_20_degc() -> None:
    """From a fixed temperature: (100 - 20)/(180 - 20), and only a hotter part uses more of its limit."""
    left = [hold(rule(unit="degC", limit=180.0), value).distance for value in (100.0, 101.0, 180.0)]
    assert left == pytest.approx([80.0 / 160.0, 79.0 / 160.0, 0.0])


def test_a_lower_limit_of_zero_is_broken_below_zero_only() -> None:
    assert hold(rule(comparison=">=", limit=0.0), 0.1).verdict == "pass"
    assert hold(rule(comparison=">=", limit=0.0), -0.1).distance == pytest.approx(-0.1)


def test_an_upper_limit_of_zero_that_holds_has_nothing_less_to_reach() -> None:
    check = hold(rule(limit=0.0), 0.0)
    assert (check.verdict, check.distance, check.flags) == ("pass", 1.0, ())


def test_what_cannot_be_judged_is_open_and_a_doubt_stands_beside_the_verdict() -> None:
    beyond = hold(rule(), 1.0, "there", undecided="outside the regression")
    assert (beyond.verdict, beyond.reason) == ("open", "there; outside the regression")
    assert hold(rule(), 3.0, undecided="outside the regression").verdict == "fail"
    for value, verdict in ((1.0, "pass"), (3.0, "fail")):
        doubted = hold(rule(), value, doubt="two methods differ")
        assert (doubted.verdict, doubted.flags) == (verdict, ("doubt",))


def test_a_missed_limit_of_good_practice_is_advisory_and_does_not_bind() -> None:
    missed = hold(rule(advisory=True), 3.0)
    assert (missed.verdict, missed.flags, missed.status, missed.missed) == (
        "fail",
        ("advisory",),
        "advisory",
        True,
    )
    assert hold(rule(advisory=True), 1.0).status == "pass"
    assert overall([missed, hold(rule(), 1.0)]) == "pass"


@pytest.mark.parametrize("value", [1.9, 2.1])
def test_a_margin_below_its_error_is_open_in_both_directions(value: float) -> None:
    near = with_error(hold(rule(), value), 0.2)
    assert (near.verdict, near.error) == ("open", 0.2) and "more than the margin" in near.reason
    assert with_error(hold(rule(advisory=True), value), 0.2).status == "open"
    assert with_error(hold(rule(), value), 0.05).verdict == ("pass" if value < 2.0 else "fail")


def test_a_limit_that_the_model_does_not_answer_is_open() -> None:
    assert not_evaluated(rule(), "no housing").verdict == "open"
    assert not_evaluated(rule(limit=None), "no housing").verdict == "not applicable"


def test_overall_is_the_worst_applicable_verdict() -> None:
    good, bad, undecided = hold(rule(), 1.0), hold(rule(), 3.0), not_evaluated(rule(), "no housing")
    skipped = not_applicable(rule(), "no such part")
    assert overall([good, skipped]) == "pass"
    assert overall([good, undecided, skipped]) == "open"
    assert overall([good, undecided, bad, skipped]) == "fail"


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
    with pytest.raises(NonFiniteResultError, match="error of check x"):
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
