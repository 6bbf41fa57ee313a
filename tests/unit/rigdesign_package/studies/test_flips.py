"""Inputs that would turn the verdict: which checks count, and that the value found does turn them."""

from dataclasses import replace
from typing import cast

import pytest

from rigdesign import Case, load_case, run_case
from rigdesign.base.errors import NotConvergedError
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.report.reasons import searched
from rigdesign.results.check import Check, Checks
from rigdesign.results.result import FlipSearch, RunResult
from rigdesign.studies.verdict_sensitivity import Search, with_flips
from tests.builders.checks import check
from tests.builders.report import make_result

BROKEN = replace(
    check("specimen.root_stress_iso.test.pinion", "", "fail"), value=3.6, margin=-1.6, distance=-0.8
)
WORSE = replace(check("lateral.stability", "", "fail"), value=4.2, margin=-2.2, distance=-1.1)
HELD = check("clearance.backlash", "", "pass")


def result_of(*checks: Check) -> RunResult:
    return cast("RunResult", replace(make_result(), checks=Checks(checks)))


def test_what_takes_the_whole_run_again_is_named_as_not_looked_at() -> None:
    """Nothing was moved, and the sheet says so; it once said that no input turns the verdict."""
    looked = with_flips(cast("SolvedRig", None), result_of(WORSE, HELD))
    assert looked.flips == [] and looked.flip_search == FlipSearch(not_searched=("lateral.stability",))
    assert "Not looked at" in searched(looked) and "Moved" not in searched(looked)


def test_a_changed_case_is_solved_once() -> None:
    """By the search and by the look at what else breaks; also one without a result."""
    case, solved = load_case("loop_1to1"), []

    def solve(changed: Case) -> dict[str, Check]:
        solved.append(changed.schedule.test_torque)
        if changed.schedule.test_torque > 305.0:
            raise NotConvergedError("no state")
        return {BROKEN.id: replace(BROKEN, value=1.8), HELD.id: replace(HELD, margin=-0.4)}

    search = Search([BROKEN], [HELD], solve, final=True)
    for torque in (301.0, 310.0, 301.0, 310.0):
        changed = case.with_value("schedule.test_torque", f"{torque} N m")
        assert search.used(changed, BROKEN) == (0.9 if torque < 305.0 else None)
    found = search.broken(case.with_value("schedule.test_torque", "301 N m"))
    assert [check.id for check in found] == [HELD.id]
    assert solved == [301.0, 310.0]


@pytest.fixture(scope="module")
def stressed() -> tuple[Case, RunResult]:
    """The small loop with a window that its root stress is beyond by more than the error at quick."""
    case = load_case("loop_1to1").with_value("limits.specimen.root_stress_minimum", "50 MPa")
    case = case.with_value("limits.specimen.root_stress_maximum", "100 MPa")
    return case, run_case(case, fidelity="quick")


@pytest.mark.whole_run
def test_the_value_found_brings_the_broken_checks_to_their_limit(stressed: tuple[Case, RunResult]) -> None:
    """Solved again from its initial state: the temperatures that were held move the stress by less than 3 %."""
    case, result = stressed
    assert result.verdict == "fail"
    flips = {flip.path: flip for flip in result.flips}
    torque = flips["schedule.test_torque"]
    turned = run_case(case.with_value(torque.path, torque.needed), fidelity="quick")
    assert turned.checks[torque.check].distance == pytest.approx(0.0, abs=0.03)
    beyond = {check.id for check in turned.checks if check.distance is not None and check.distance < 0.0}
    others = beyond - {torque.check}
    assert torque.turns == (not others)
    assert (torque.holds, torque.stated) == (False, "300 N m")


@pytest.mark.whole_run
def test_the_limit_that_would_do_is_the_value_of_the_worst(stressed: tuple[Case, RunResult]) -> None:
    _, result = stressed
    limit = next(flip for flip in result.flips if not flip.path)
    value = result.checks[limit.check].value
    assert value is not None
    assert value <= float(limit.needed.removesuffix(" MPa")) < 1.001 * value
