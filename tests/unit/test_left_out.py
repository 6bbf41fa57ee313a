"""What has no check and what the model leaves out is said, each where it applies."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigdesign import load_case
from rigdesign.checks.thermal import NO_PLAY, _clearances
from rigdesign.results.result import Check
from rigdesign.rig.model import build_rig
from rigdesign.run.warnings import not_modelled

PROTOTYPE = Path(__file__).parents[2] / "cases" / "uhcf_prototype"


def axial_play(*plays: tuple[float, float]) -> Check:
    """The check for shafts with a cold and a hot play [mm]."""
    shafts = [
        {"shaft": f"s{i}", "axial_play_cold_mm": cold, "axial_play_hot_mm": hot}
        for i, (cold, hot) in enumerate(plays)
    ]
    expansion = [SimpleNamespace(gearbox="test", stage="test", gears=[], seal_gaps=[], shafts=shafts)]
    subject: Any = SimpleNamespace(case=load_case(PROTOTYPE), expansion=expansion, points=(), unexpanded=())
    return next(check for check in _clearances(subject) if check.id == "clearance.axial_play")


def test_a_shaft_without_a_stated_play_uses_none_up() -> None:
    check = axial_play((0.5, 0.4), (0.0, -0.1))
    assert (check.verdict, check.value) == ("pass", 0.4)
    none = axial_play((0.0, -0.1))
    assert (none.verdict, none.reason) == ("not applicable", NO_PLAY)


@pytest.mark.parametrize(("double", "told"), [(True, False), (False, True)])
def test_axial_forces_of_single_helical_gears_are_named(double: bool, told: bool) -> None:
    case = load_case(PROTOTYPE).with_value("gearboxes.reference.meshes.main.double_helical", double)
    subject: Any = SimpleNamespace(case=case, rig=build_rig(case, "quick"), run=object(), points=())
    items = not_modelled(subject)
    assert any("axial force of main and its tilting moment" in item for item in items) == told
    assert any("gearboxes.*.meshes.*.phase" in item for item in items)
