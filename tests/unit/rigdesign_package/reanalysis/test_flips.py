"""Inputs that would turn the verdict: which checks count, and that the value found does turn them."""

from dataclasses import replace

import pytest

from rigdesign import Case, load_case, run_case
from rigdesign.base.errors import NotConvergedError
from rigdesign.reanalysis.flips import Search, governing
from rigdesign.results.check import Check
from rigdesign.results.result import RunResult
from tests.builders.checks import check

BROKEN = replace(check("specimen.root_stress_iso.test.pinion", "", "fail"), utilisation=1.8)
WORSE = replace(check("temperature.housing", "", "fail"), utilisation=2.1)
UNKNOWN = replace(check("dynamics.lift_off.test", "", "fail"), utilisation=1.1)
HELD = replace(check("clearance.backlash", "", "pass"), utilisation=0.7)
NEARER = replace(check("oil.flow", "", "pass"), utilisation=0.9)


def test_all_broken_checks_have_to_turn_the_worst_first() -> None:
    assert governing([BROKEN, HELD, WORSE]) == [WORSE, BROKEN]


def test_a_broken_check_that_is_not_looked_at_leaves_nothing_to_show() -> None:
    assert governing([BROKEN, UNKNOWN]) == []


def test_without_a_broken_check_the_nearest_one_counts() -> None:
    assert governing([HELD, replace(HELD, utilisation=0.3)]) == [HELD]
    assert governing([HELD, replace(NEARER, by_definition=True)]) == [HELD]


def test_a_nearer_check_that_is_not_looked_at_leaves_nothing_to_show() -> None:
    assert governing([HELD, NEARER]) == []


def test_a_changed_case_is_solved_once() -> None:
    """By the search and by the look at what else breaks; also one without a result."""
    case, solved = load_case("loop_1to1"), []

    def solve(changed: Case) -> dict[str, Check]:
        solved.append(changed.schedule.test_torque)
        if changed.schedule.test_torque > 305.0:
            raise NotConvergedError("no state")
        return {BROKEN.id: replace(BROKEN, utilisation=0.9), HELD.id: replace(HELD, utilisation=1.2)}

    search = Search([BROKEN], [HELD], solve)
    for torque in (301.0, 310.0, 301.0, 310.0):
        changed = case.with_value("schedule.test_torque", f"{torque} N m")
        assert search.utilisation(changed) == (0.9 if torque < 305.0 else None)
    found = search.broken(case.with_value("schedule.test_torque", "301 N m"))
    assert [check.id for check in found] == [HELD.id]
    assert solved == [301.0, 310.0]


@pytest.fixture(scope="module")
def stressed() -> tuple[Case, RunResult]:
    """The small loop with a window that its root stress is far beyond."""
    case = load_case("loop_1to1").with_value("limits.specimen.root_stress_maximum", "200 MPa")
    return case, run_case(case, fidelity="quick")


@pytest.mark.whole_run
def test_the_value_found_brings_the_broken_checks_to_their_limit(stressed: tuple[Case, RunResult]) -> None:
    """Solved again from its initial state: the temperatures that were held move the stress by less than 3 %."""
    case, result = stressed
    assert result.verdict == "fail"
    flips = {flip.path: flip for flip in result.flips}
    torque = flips["schedule.test_torque"]
    turned = run_case(case.with_value(torque.path, torque.needed), fidelity="quick")
    assert turned.checks[torque.check].utilisation == pytest.approx(1.0, abs=0.03)
    others = {check.id for check in turned.checks if check.verdict == "fail"} - {torque.check}
    assert torque.turns == (not others)
    assert (torque.holds, torque.stated) == (False, "300 N m")


@pytest.mark.whole_run
def test_the_limit_that_would_do_is_the_value_of_the_worst(stressed: tuple[Case, RunResult]) -> None:
    _, result = stressed
    limit = next(flip for flip in result.flips if not flip.path)
    value = result.checks[limit.check].value
    assert value is not None
    assert value <= float(limit.needed.removesuffix(" MPa")) < 1.001 * value
