"""What has no check and what the model leaves out is said, each where it applies."""

from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign import load_case
from rigdesign.checks.clearances import NO_PLAY, checks
from rigdesign.results.check import Check
from rigdesign.results.warm_gearbox import WarmGearbox, WarmShaft
from rigdesign.run.warnings import not_modelled
from tests.builders.paths import CASES
from tests.builders.twisting import twisting_rig

PROTOTYPE = CASES / "uhcf_prototype"


def axial_play(*plays: tuple[float, float]) -> Check:
    """The check for shafts with a play as drawn and warm [mm]."""
    shafts = tuple(
        WarmShaft(name=f"s{i}", front=0.0, rear=0.0, free=0.0, play_as_drawn=1e-3 * drawn, play=1e-3 * warm)
        for i, (drawn, warm) in enumerate(plays)
    )
    warm = WarmGearbox(gearbox="test", stage="test", shafts=shafts)
    solved: Any = SimpleNamespace(
        case=load_case(PROTOTYPE), warm=[warm], points=(), unexpanded=(), seal_amplitudes={}, no_clearances=""
    )
    return next(check for check in checks(solved) if check.id == "clearance.axial_play")


def test_a_shaft_without_a_stated_play_uses_none_up() -> None:
    check = axial_play((0.5, 0.4), (0.0, -0.1))
    assert (check.verdict, check.value) == ("pass", pytest.approx(0.4))
    none = axial_play((0.0, -0.1))
    assert (none.verdict, none.reason) == ("not applicable", NO_PLAY)


@pytest.mark.parametrize(("double", "named"), [(True, False), (False, True)])
def test_axial_forces_of_single_helical_gears_are_named(double: bool, named: bool) -> None:
    """The tilting moment is a load of the bearings, whose positions are known; their thrust faces are not rated."""
    case = load_case(PROTOTYPE).with_value("gearboxes.reference.meshes.main.double_helical", double)
    solved: Any = SimpleNamespace(case=case, rig=twisting_rig(case), run=object(), points=())
    items = not_modelled(solved)
    assert any("axial force of main on the thrust faces" in item for item in items) == named
    assert any("gearboxes.*.meshes.*.phase" in item for item in items)


@pytest.mark.parametrize("stated", [False, True])
def test_bodies_of_one_half_are_named_where_no_inertia_is_stated(stated: bool) -> None:
    at = "gearboxes.reference"
    inertias = {
        f"{at}.gears.{gear}.inertia": "1e-3 kg m2" if stated else None for gear in ("pinion", "wheel")
    }
    case = load_case(PROTOTYPE).with_values(inertias | {f"{at}.meshes.main.carrying_halves": 1})
    solved: Any = SimpleNamespace(case=case, rig=twisting_rig(case), run=object(), points=())
    (item,) = (item for item in not_modelled(solved) if "one half of the double-helical" in item)
    assert ("inertia and weight of pinion, wheel are those of one half" in item) == (not stated)
