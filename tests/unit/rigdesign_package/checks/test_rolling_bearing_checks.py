"""Default limits of rolling bearings: clearance as they run, and static safety, of a case that states neither."""

from functools import cache
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign.case import load_case
from rigdesign.checks.rolling_bearings import RULES
from rigdesign.postprocessing import warm_gearbox
from rigdesign.postprocessing.solved_rig import SolvedRig
from rigdesign.results.check import Check
from rigdesign.rig.model import Rig, build_rig
from tests.builders.paths import CASES


@cache
def rig() -> Rig:
    """Cylindrical roller bearings in all places."""
    return build_rig(load_case(CASES / "fzg"), "quick")


def check(key: str, clearance: float = 20e-6, safety: float = 3.0) -> Check:
    """Of a rig at one held stage whose bearings run with this clearance [m] and static safety."""
    state = SimpleNamespace(life=SimpleNamespace(static_safety=safety))
    last = SimpleNamespace(
        bearings={"test.pinion_front": state},
        coupling_state=SimpleNamespace(
            bearing_clearance={"test.pinion_front": clearance, "test.wheel_rear": 25e-6}
        ),
    )
    points: Any = [SimpleNamespace(point=SimpleNamespace(stage="test"), last=last)]
    (rule,) = [rule for rule in RULES if rule.key == f"bearing.{key}"]
    return rule.check(SolvedRig(rig=rig(), points=points))


@pytest.mark.parametrize(("clearance", "verdict"), [(20e-6, "pass"), (-14.9e-6, "fail")])
def test_a_bearing_that_runs_without_clearance_fails(clearance: float, verdict: str) -> None:
    found = check("operating_clearance", clearance=clearance)
    assert (found.verdict, found.limit, found.value) == (verdict, 0.0, pytest.approx(1e6 * clearance))
    assert found.reason == "test.pinion_front, stage test"


def test_bearings_that_are_adjusted_axially_have_no_radial_clearance(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pair with contact angles is set on assembly; 20 um of the other bearing is the least."""
    pushed = SimpleNamespace(has_film=False, induced_axial_load=lambda load: load)
    free = SimpleNamespace(has_film=False, induced_axial_load=lambda load: 0.0)
    bearings = {"test.pinion_front": pushed, "test.wheel_rear": free}
    monkeypatch.setattr(Rig, "bearing", lambda self, name: bearings[name])
    assert check("operating_clearance", clearance=-50e-6).value == pytest.approx(25.0)


@pytest.mark.parametrize(("safety", "verdict"), [(3.0, "pass"), (1.2, "fail")])
def test_static_safety_has_a_limit(safety: float, verdict: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(warm_gearbox, "rolling_state", lambda state: state)
    found = check("static_safety", safety=safety)
    assert (found.verdict, found.limit, found.value) == (verdict, 1.5, safety)
